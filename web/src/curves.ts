// Curves over the steps of a plan, one below the other, with one cursor. A title changes what its curve shows; dragging scrubs.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import {withUnit} from './answer';
import {clearance} from './checks';
import {make} from './make';
import type {Plan} from './plan';
import type {Tips} from './poses';
import {format, shownValue, type System, type Unit, unitName} from './units';

type Kind = 'clearance' | 'joint angles' | 'stage' | 'tendon changes';
const kinds: Kind[] = ['clearance', 'joint angles', 'stage', 'tendon changes'];
const kindsOf = (plan: Plan | null) => kinds.filter((kind) => kind !== 'clearance' || !plan?.times);
const units: Record<Kind, Unit> = {clearance: 'm', 'joint angles': 'rad', stage: 'm', 'tendon changes': 'm'};
const colours = ['tendon-1', 'tendon-2', 'tendon-3', 'tendon-4', 'section-5'];
const dashes = [[], [6, 3], [2, 3], [8, 3, 2, 3]];
const axisWidth = 48, edge = 12, font = '11px system-ui, sans-serif';

interface Line { values: (number | null)[]; colour: string; dash: number[]; name: string }

interface Panel { kind: Kind; box: HTMLElement; title: HTMLButtonElement; unit: HTMLElement; note: HTMLElement; value: HTMLElement; plotBox: HTMLElement; plot: uPlot | null; lines: Line[] }

/** With one value more before each gap. */
const broken = <T>(values: T[], gaps: ReadonlySet<number>, between: (step: number) => T): T[] => values.flatMap((value, step) => (gaps.has(step) ? [between(step), value] : [value]));

export class Curves {
  private readonly panels: Panel[];
  private readonly cursor = make('div', {className: 'cursor'});
  private plan: Plan | null = null;
  private tips: (Tips | null)[] = [];
  private system: System = 'mm';
  private step = 0;

  /** @param go to a step */
  constructor(private readonly section: HTMLElement, private readonly go: (step: number) => void) {
    this.panels = (['clearance', 'joint angles', 'stage'] as Kind[]).map((kind) => this.panel(kind));
    section.append(...this.panels.map(({box}) => box), this.cursor);
    section.addEventListener('pointerdown', (event) => this.press(event));
    section.addEventListener('pointermove', (event) => section.hasPointerCapture(event.pointerId) && this.drag(event));
    new ResizeObserver(() => this.draw()).observe(section);
  }

  show(plan: Plan, tips: (Tips | null)[], system: System): void {
    if (!!plan.times !== !!this.plan?.times) this.panels.forEach((panel, i) => { panel.kind = kindsOf(plan)[i]!; });
    [this.plan, this.tips, this.system] = [plan, tips, system];
    this.draw();
  }

  at(step: number): void {
    this.step = step;
    this.place();
    for (const panel of this.panels) this.tell(panel);
  }

  private panel(kind: Kind): Panel {
    const title = make('button', {type: 'button', title: 'show something else'}), [unit, note, value] = [make('span', {className: 'unit'}), make('span', {className: 'legend'}), make('span', {className: 'value'})];
    const plotBox = make('div', {className: 'plot'}), box = make('div', {className: 'curve'}, make('div', {className: 'about'}, make('div', {}, title, ' ', unit), value, note), plotBox);
    const panel: Panel = {kind, box, title, unit, note, value, plotBox, plot: null, lines: []};
    title.addEventListener('click', () => this.change(panel));
    return panel;
  }

  /** The next of what no other curve shows. */
  private change(panel: Panel): void {
    const free = kindsOf(this.plan).filter((kind) => kind === panel.kind || this.panels.every((one) => one.kind !== kind));
    panel.kind = free[(free.indexOf(panel.kind) + 1) % free.length]!;
    this.draw();
  }

  private lines({kind}: Panel): Line[] {
    const plan = this.plan!, {steps, check} = plan, shown = (value: number) => shownValue(value, units[kind], this.system);
    const sections = steps[0]!.configuration.length, colour = (section: number) => colours[section % colours.length]!;
    if (kind === 'clearance') return check ? [{values: check.steps.map(({clearance: value}) => shown(value)), colour: 'tendon-1', dash: [], name: ''}] : [];
    if (kind === 'stage') return [{values: steps.map(({stage}) => shown(stage)), colour: 'tendon-1', dash: [], name: ''}];
    if (kind === 'joint angles') {
      const names = plan.anglesOf;
      return Array.from({length: 2 * sections}, (_, i) => ({values: steps.map(({configuration}) => shown(configuration[i >> 1]![i & 1]!)), colour: colour(i >> 1), dash: dashes[i & 1]!, name: `S${(i >> 1) + 1} ${names[i >> 1]![i & 1]!}`}));
    }
    const first = this.tips.find((tip) => tip?.changes)?.changes ?? [];
    return first.flatMap((of, section) => of.map((_, tendon) => ({values: steps.map((_step, k) => {
      const value = this.tips[k]?.changes?.[section]?.[tendon];
      return value === undefined ? null : shown(value);
    }), colour: colour(section), dash: dashes[tendon % 4]!, name: `S${section + 1}.${tendon + 1}`})));
  }

  private draw(): void {
    const {plan} = this;
    if (!plan) return;
    const style = getComputedStyle(document.documentElement), token = (name: string) => style.getPropertyValue(`--${name}`).trim();
    this.panels.forEach((panel, i) => {
      const {kind, plotBox} = panel, width = plotBox.clientWidth, height = plotBox.clientHeight, sections = plan.steps[0]!.configuration.length;
      panel.plot?.destroy();
      panel.plot = null;
      panel.title.textContent = kind;
      panel.unit.textContent = `[${unitName(units[kind], this.system)}]`;
      panel.lines = this.lines(panel);
      panel.note.classList.toggle('wanted', kind === 'clearance');
      panel.note.replaceChildren(...(kind === 'clearance' ? [`wanted ${withUnit(plan.scene.margins.clearance, 'm', this.system)} - -`] : []), ...(kind === 'joint angles' || kind === 'tendon changes' ? Array.from({length: sections}, (_, section) => {
        const name = make('span', {textContent: `S${section + 1} `});
        name.style.color = `var(--${colours[section % colours.length]!})`;
        return name;
      }) : []), ...(kind === 'joint angles' ? [`${plan.anglesOf[0]![1]} - -`] : []));
      if (width > 50 && height > 20 && panel.lines.length > 0)
        panel.plot = new uPlot(this.options(panel, width, height, token, i === this.panels.length - 1), [broken(plan.steps.map((_, k) => plan.placeOf(k)), plan.gaps, (k) => (plan.placeOf(k - 1) + plan.placeOf(k)) / 2), ...panel.lines.map(({values}) => broken(values, plan.gaps, () => null))] as uPlot.AlignedData, plotBox);
    });
    this.place();
    this.at(this.step);
  }

  private options({lines, kind}: Panel, width: number, height: number, token: (name: string) => string, isLast: boolean): uPlot.Options {
    const line = {stroke: token('line'), width: 1}, plan = this.plan!;
    const range = (_: uPlot, low: number, high: number): uPlot.Range.MinMax => {
      const [from, to] = kind === 'clearance' ? [Math.min(0, low), high] : [low, high], room = 0.08 * (to - from) || 1;
      return [from < 0 || kind !== 'clearance' ? from - room : 0, to + room];
    };
    return {
      width, height, padding: [6, edge, isLast ? 0 : 6, 0], legend: {show: false}, cursor: {show: false},
      scales: {x: {time: false, range: [this.low, this.low + this.reach]}, y: {range}},
      axes: [{show: isLast, stroke: token('mute'), font, grid: {show: false}, ticks: {...line, size: 3}, gap: 2, size: 18, ...(plan.times && {values: (_: uPlot, marks: number[]) => marks.map((mark) => `${mark} s`)}), incrs: [...(plan.times ? [0.1, 0.2, 0.5] : []), 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000]},
             {stroke: token('mute'), font, size: axisWidth, grid: line, ticks: {...line, size: 3}, gap: 3, space: 16, values: (_, marks) => marks.map((mark) => String(Number(mark.toPrecision(6))))}],
      series: [{}, ...lines.map(({colour, dash}) => ({stroke: token(colour), width: 1.5, dash, points: {show: false}, spanGaps: false}))],
      hooks: {drawClear: [(plot) => this.marks(plot, kind, token)]},
    };
  }

  /** Steps that fail as bands, and below which clearance none is wanted. */
  private marks(plot: uPlot, kind: Kind, token: (name: string) => string): void {
    const {ctx, bbox: {left, top, width, height}} = plot, plan = this.plan!, x = (step: number) => plot.valToPos(step, 'x', true);
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top, width, height);
    ctx.clip();
    ctx.globalAlpha = 0.2;
    ctx.fillStyle = token('over');
    for (const {from, to} of plan.failed) ctx.fillRect(x(from - 0.5), top, x(to + 0.5) - x(from - 0.5), height);
    ctx.globalAlpha = 1;
    if (kind === 'clearance') {
      const y = plot.valToPos(shownValue(plan.scene.margins.clearance, 'm', this.system), 'y', true), ratio = devicePixelRatio;
      ctx.strokeStyle = token('over');
      ctx.setLineDash([5 * ratio, 4 * ratio]);
      ctx.lineWidth = ratio;
      ctx.beginPath();
      ctx.moveTo(left, y);
      ctx.lineTo(left + width, y);
      ctx.stroke();
    }
    ctx.restore();
  }

  /** What the lines are at the cursor: of many the largest. */
  private tell({kind, lines, value}: Panel): void {
    if (lines.length === 0) return void (value.textContent = kind === 'clearance' ? 'being checked' : '…');
    if (kind === 'clearance') return void (value.textContent = clearance(this.plan!.check!.steps[this.step]!.clearance, this.plan!.check!.reach, this.system));
    const best = lines.reduce((found, line) => (Math.abs(line.values[this.step] ?? 0) > Math.abs(found.values[this.step] ?? 0) ? line : found)), number = best.values[this.step];
    const factor = shownValue(1, units[kind], this.system), unit = unitName(units[kind], this.system);
    value.textContent = number === null || number === undefined ? '…' : `${best.name} ${format(number / factor, units[kind], this.system)} ${unit}`.trim();
  }

  /** Where the plots have their steps, from the left of the section [px]. */
  private get span(): {left: number; width: number} | null {
    const box = this.panels.find(({plot}) => plot)?.plotBox;
    if (!box) return null;
    return {left: box.getBoundingClientRect().left - this.section.getBoundingClientRect().left + axisWidth, width: box.clientWidth - axisWidth - edge};
  }

  /** Of the axis that all of them have. */
  private get low(): number {
    return this.plan!.placeOf(0);
  }

  private get reach(): number {
    return Math.max(this.plan!.placeOf(this.plan!.last) - this.low, 1e-3);
  }

  private place(): void {
    const {span} = this;
    this.cursor.hidden = !span;
    if (span && this.plan) this.cursor.style.transform = `translateX(${(span.left + (span.width * (this.plan.placeOf(this.step) - this.low)) / this.reach).toFixed(1)}px)`;
  }

  private press(event: PointerEvent): void {
    if (event.button !== 0 || !(event.target as Element).closest('.plot')) return;
    event.preventDefault();
    this.section.setPointerCapture(event.pointerId);
    this.drag(event);
  }

  private drag(event: PointerEvent): void {
    const {span, plan} = this;
    if (!span || !plan) return;
    const part = (event.clientX - this.section.getBoundingClientRect().left - span.left) / span.width;
    this.go(plan.stepAt(this.low + Math.min(1, Math.max(0, part)) * this.reach));
  }
}
