// How far one can still go: quantities over the range of the slider last touched, walked outwards from where it is.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import type {Json, Robot} from './client';
import {coordinates} from './answer';
import {type Described, type Row, subscript} from './described';
import {make} from './make';
import {changed, forward, hasVelocity, inputsOf, inverse, isSolved, plain, stability, velocity} from './questions';
import type {Side, State} from './state';
import {shownValue, type System, type Unit, unitName} from './units';
import {verdictOf} from './verdict';

export interface Touched { side: Side | 'load'; index: number }
interface Sample { at: number; answer: Json; isJump?: boolean }  // a jump: from the sample before it no path leads here

/** What samples are of. Both ends of the plot lie where the slider's do, or where its value is. */
interface Context { described: Described; state: State; touched: Touched; row: Row; low: number; high: number; now: number }

interface Band { from: number; to: number; word: string; isOver: boolean }

const steps = 40;  // to each side
const often = 400;  // ms between drawings of what is there so far
const usual = 8;   // samples of a request: between two of them a newer question may come in

/** A quantity of an answer: its name and how to find it. */
interface Quantity { name: string; unit: Unit; of: (answer: Json) => number | undefined }

/** Whether the inputs are what is answered. */
const isInverse = (state: State, side: Side | 'load') => side === 'pose' || (side === 'load' && state.asked === 'pose');

/** Of each tendon of an arm what it answers: its tension, or the change of its length. */
function answersOf({holding}: Described): Quantity[] {
  const {held, rows} = holding!;
  return held.map((of, i) => {
    const {name, unit} = rows[of === 'tension' ? 'change' : 'tension'][i]!;
    return {name, unit, of: (answer) => (of === 'tension' ? answer.changes : answer.tensions)?.flat()[i]};
  });
}

function quantitiesOf(described: Described, state: State, touched: Touched): Quantity[] {
  const list: Quantity[] = [];
  if (isInverse(state, touched.side)) {
    described.inputs.forEach((row, i) => list.push({name: row.name, unit: row.unit, of: (answer) => inputsOf(described, answer)?.[i]}));
  } else {
    const names = described.isPlanar ? ['x', 'y', 'φ'] : ['tilt', 'x', 'y', 'z', 'azimuth', 'torsion'];
    for (const name of names) {
      const find = (answer: Json) => coordinates(answer.pose ?? answer.tip ?? {}).find(([of]) => of === name);
      list.push({name, unit: name.length === 1 && name !== 'φ' ? 'm' : 'rad', of: (answer) => find(answer)?.[1]});
    }
  }
  if (!isInverse(state, touched.side) && hasVelocity(described, state)) list.push({name: 'conditioning', unit: '', of: (answer) => answer.indices?.condition_homogenised ?? answer.indices?.condition});
  if (described.isArm) {
    if (!described.hasArmLegs) list.push({name: 'buckling margin', unit: '', of: (answer) => answer.buckling_margin}, {name: 'least tension', unit: 'N', of: (answer) => answer.least_tension});
    if (!isInverse(state, touched.side)) list.push(...answersOf(described));
  } else if (state.model === 'rod') {
    list.push({name: 'fold margin', unit: '', of: (answer) => answer.margins?.fold}, {name: 'strain', unit: '', of: (answer) => answer.margins?.strain},
              {name: 'energy', unit: 'J', of: (answer) => answer.energy});
  }
  if (!described.isArm && state.model === 'prb') described.answer.legs.forEach((_: Json, i: number) =>
    list.push({name: `T${subscript(i + 1)}`, unit: 'N', of: (answer) => answer.legs?.[i]?.tensions && Math.max(...answer.legs[i].tensions)}));
  return list;
}

/** Numbers that change little where a solution is followed: all of the pose, or all of the inputs, with lengths over that of the robot. Products of a quaternion's parts are those of its negative, too. */
function solutionOf(described: Described, state: State, side: Side | 'load', answer: Json): number[] {
  const {legs, length} = described.answer, size: number = length || legs?.[0]?.link.length || Math.hypot(...(described.answer.home?.position ?? [])) || 0.1;
  if (isInverse(state, side)) return (inputsOf(described, answer) ?? []).map((value, i) => {
    const {unit, low, high} = described.inputs[i]!;
    return unit === 'm' ? value / size : unit === 'N' ? value / (high - low) : value;
  });
  const pose = answer.pose ?? answer.tip;
  if (!pose) return [];
  return pose.position ? [...pose.position.map((part: number) => part / size), ...((pose.quaternion ?? []) as number[]).flatMap((a, i, all) => all.slice(i).map((b) => a * b))] : [pose.x / size, pose.y / size, Math.cos(pose.phi), Math.sin(pose.phi)];
}

const apart = (a: number[], b: number[]) => Math.hypot(...a.map((value, i) => value - b[i]!));

const sudden = 5;  // times the steps beside it; at a fold, which is continuous, steps grow 2.4 times
const least = 2e-3;

/** Marks where the samples leave one solution for another one. */
function markJumps(samples: Sample[], numbers: (answer: Json) => number[]): void {
  const vectors = samples.map(({answer}) => (isSolved(answer) ? numbers(answer) : null));
  const step = (i: number) => (vectors[i - 1] && vectors[i] && vectors[i]!.length > 0 ? apart(vectors[i - 1]!, vectors[i]!) / Math.max(samples[i]!.at - samples[i - 1]!.at, 1e-12) : NaN);
  const steps = samples.map((_, i) => (i === 0 ? NaN : step(i)));
  samples.forEach((sample, i) => {
    const beside = [steps[i - 1], steps[i + 1]].filter((one): one is number => one !== undefined && !Number.isNaN(one)), size = steps[i]! * (sample.at - (samples[i - 1]?.at ?? sample.at));
    if (beside.length > 0 && size > least && steps[i]! > sudden * Math.max(...beside)) sample.isJump = true;
    else delete sample.isJump;
  });
}

function question(described: Described, state: State, side: Side | 'load', start: Json | string | undefined): Json {
  if (isInverse(state, side)) return {...inverse(described, state), ...(!described.isPlanar && !described.isSerial && {tilt: true}), ...(described.isArm && {want: stability(described)})};
  return hasVelocity(described, state) ? velocity(described, state, start) : forward(described, state, start);
}

export class Strip {
  private plot: uPlot | null = null;
  private readonly title = make('h2');
  private readonly choices = make('div', {className: 'choices'});
  private readonly box = make('div', {className: 'plot'});
  private readonly text = make('p', {className: 'sr'});
  private chosen = new Map<string, string[]>();  // by the kind of robot and side, so that a choice stays
  private samples: Sample[] = [];
  private context: Context | null = null;  // of the samples
  private system: System = 'mm';
  private run = 0;

  constructor(section: HTMLElement, private readonly goTo: (value: number) => void) {
    section.append(make('div', {className: 'head'}, this.title, this.choices), this.box, this.text);
    this.text.setAttribute('role', 'status');
    new ResizeObserver(() => this.draw()).observe(this.box);
  }

  /** What was asked before counts no more: it is pale until something newer comes. */
  cancel(): void {
    ++this.run;
    this.box.classList.add('old');
  }

  clear(): void {
    this.cancel();
    this.samples = [];
    this.context = null;
    this.draw();
  }

  /**
   * Samples both ways from the value of the state, each beginning where the one before it ended.
   * @param now the value that is asked, where that is another one: it may have no solution to begin with
   */
  async ask(robot: Robot, described: Described, state: State, touched: Touched, pose: Json | null, now = state[touched.side][touched.index]!): Promise<void> {
    const run = ++this.run, row = described[touched.side][touched.index]!, here = state[touched.side][touched.index]!;
    const low = Math.min(row.low, here, now), high = Math.max(row.high, here, now), context = {described, state, touched, row, low, high, now};
    // That an arm's tip cannot be somewhere takes seconds to find: nothing is asked beyond the first such place.
    const chunk = described.isArm && isInverse(state, touched.side) ? 1 : usual, found: Sample[] = [];
    let begin = performance.now();
    const show = () => {
      this.context = context;
      this.box.classList.remove('old');
      this.samples = [...found].sort((a, b) => a.at - b.at).filter(({at}, i, all) => i === 0 || at !== all[i - 1]!.at);
      markJumps(this.samples, (answer) => solutionOf(described, state, touched.side, answer));
      this.draw();
    };
    for (const end of [high, low]) {
      const width = (high - low) / (2 * steps), count = Math.max(0, Math.ceil(Math.abs(end - here) / width - 1e-9));
      let isGoing = end !== here || found.length === 0;
      for (let first = 0; isGoing && first <= count; first += chunk) {
        const values = Array.from({length: Math.min(chunk, count + 1 - first)}, (_, k) => (first + k === count ? end : here + Math.sign(end - here) * width * (first + k)));
        const start = (k: number) => (first + k === 0 ? pose ?? undefined : k === 0 ? found.at(-1)?.answer.pose && plain(found.at(-1)!.answer.pose) : 'last');
        const answers = await robot.ask(values.map((value, k) => question(described, changed(state, touched.side, touched.index, value), touched.side, described.isSerial ? undefined : described.isArm ? pose ?? undefined : start(k))));
        if (run !== this.run) return;
        values.forEach((at, k) => {
          if (!isGoing) return;
          found.push({at, answer: answers[k]!});
          isGoing = isSolved(answers[k]!);  // beyond it nothing was followed
        });
        if (performance.now() - begin < often) continue;  // of robots that take long it is seen how far it is
        begin = performance.now();
        show();
      }
    }
    show();
    this.tell();
  }

  use(system: System): void {
    this.system = system;
    this.draw();
  }

  /** How far the number can go to each side until something ends it: what, and the last value before. */
  room(): {word: string; to: number}[] {
    const {context, samples} = this, found: {word: string; to: number}[] = [];
    if (!context) return found;
    const {state, touched} = context, here = state[touched.side][touched.index]!, at = samples.findIndex((one) => one.at >= here);
    for (const way of [-1, 1]) {
      for (let i = at; samples[i] && samples[i + way]; i += way) {
        const next = samples[i + way]!, isJump = (way > 0 ? next : samples[i]!).isJump;
        if (!isJump && isSolved(next.answer)) continue;
        found.push({word: isJump ? 'JUMP' : verdictOf(next.answer).word, to: samples[i]!.at});
        break;
      }
    }
    return found;
  }

  /** The value nearest to one that has no solution. */
  nearest(value: number): number | null {
    const solved = this.samples.filter(({answer}) => isSolved(answer)).map(({at}) => at);
    if (solved.length === 0) return null;
    return solved.reduce((best, at) => (Math.abs(at - value) < Math.abs(best - value) ? at : best));
  }

  private key(): string {
    const {described, touched, state} = this.context!;
    return `${described.answer.kind} ${described.answer.space} ${state.model} ${isInverse(state, touched.side)}`;
  }

  private shownQuantities(): {all: Quantity[]; shown: Quantity[]} {
    const {described, state, touched} = this.context!, all = quantitiesOf(described, state, touched);
    const names = this.chosen.get(this.key()) ?? [all[0]!.name, (all.find(({name}) => ['conditioning', 'fold margin', 'buckling margin'].includes(name)) ?? all[1] ?? all[0]!).name];
    return {all, shown: all.filter(({name}) => names.includes(name)).slice(0, 2)};
  }

  private choose(name: string, shown: Quantity[]): void {
    const names = shown.map((one) => one.name);
    this.chosen.set(this.key(), names.includes(name) ? (names.length > 1 ? names.filter((one) => one !== name) : names) : [...names, name].slice(-2));
    this.draw();
  }

  private draw(): void {
    this.plot?.destroy();
    this.plot = null;
    this.choices.replaceChildren();
    const {context} = this, width = this.box.clientWidth, height = this.box.clientHeight;
    this.title.textContent = context ? `Response to ${context.row.name}` : 'Response';
    if (!context || this.samples.length === 0 || width < 50 || height < 30) return;
    const {all, shown} = this.shownQuantities();
    this.choices.replaceChildren(...all.map(({name}) => {
      const at = shown.findIndex((one) => one.name === name), choice = make('button', {type: 'button', className: `choice line-${at + 1}`, textContent: name});
      choice.setAttribute('aria-pressed', String(at >= 0));
      choice.disabled = at >= 0 && shown.length === 1;  // one is always drawn
      choice.addEventListener('click', () => this.choose(name, shown));
      return choice;
    }));
    this.plot = new uPlot(this.options(shown, width, height), this.data(shown), this.box);
    this.box.dataset.samples = String(this.samples.length);
    this.box.dataset.ends = `${context.low} ${context.high}`;
  }

  /** With a gap between two samples where the solution jumps, or an angle goes once round. */
  private data(shown: Quantity[]): uPlot.AlignedData {
    const {row} = this.context!, x: number[] = [], columns: (number | null)[][] = shown.map(() => []);
    let last: (number | undefined)[] = [];
    for (const {at, answer, isJump} of this.samples) {
      const values = shown.map(({of}) => (isSolved(answer) ? of(answer) : undefined));
      const isRound = values.map((value, k) => shown[k]!.unit === 'rad' && value !== undefined && last[k] !== undefined && Math.abs(value - last[k]!) > Math.PI);
      if (x.length > 0 && (isJump || isRound.some(Boolean))) {
        x.push((x.at(-1)! + shownValue(at, row.unit, this.system)) / 2);
        columns.forEach((column, k) => column.push(isJump || isRound[k] || values[k] === undefined || last[k] === undefined ? null : shownValue((values[k]! + last[k]!) / 2, shown[k]!.unit, this.system)));
      }
      x.push(shownValue(at, row.unit, this.system));
      columns.forEach((column, k) => column.push(values[k] === undefined ? null : shownValue(values[k]!, shown[k]!.unit, this.system)));
      last = values;
    }
    return [x, ...columns] as uPlot.AlignedData;
  }

  private options(shown: Quantity[], width: number, height: number): uPlot.Options {
    const {row, low: lowest, high: highest} = this.context!, style = getComputedStyle(document.documentElement), token = (name: string) => style.getPropertyValue(`--${name}`).trim();
    const colours = [token('tendon-1'), token('tendon-2')], grid = {stroke: token('line'), width: 1}, ticks = {...grid, size: 4}, font = '11px system-ui, sans-serif';
    // What does not change is a line in the middle, not rounding errors at full height.
    const range = (_: uPlot, low: number, high: number): uPlot.Range.MinMax => {
      const room = 0.1 * (high - low), least = 1e-6 * Math.max(1, Math.abs(low), Math.abs(high));
      return high - low < least ? [low - 1, high + 1] : [low - room, high + room];
    };
    const axis = (k: number): uPlot.Axis => ({
      scale: `y${k}`, side: k === 0 ? 3 : 1, stroke: colours[k]!, font, size: 56, grid: k === 0 ? grid : {show: false}, ticks, gap: 4,
      values: (_, marks) => marks.map((mark) => String(Number(mark.toPrecision(6)))),
    });
    const unit = (of: Unit) => (unitName(of, this.system) ? ` [${unitName(of, this.system)}]` : '');
    return {
      width, height, padding: [8, 8, 0, 8], legend: {show: false},
      cursor: {drag: {x: false, y: false}, points: {size: 6}},
      scales: {x: {time: false, range: [shownValue(lowest, row.unit, this.system), shownValue(highest, row.unit, this.system)]}, ...Object.fromEntries(shown.map((_, k) => [`y${k}`, {range}]))},
      axes: [{stroke: token('mute'), font, grid: {show: false}, ticks, gap: 4, size: 24, values: (_, marks) => marks.map((mark, i) => `${Number(mark.toPrecision(6))}${i === marks.length - 1 ? ` ${unitName(row.unit, this.system)}` : ''}`)},
             ...shown.map((_, k) => axis(k))],
      series: [{}, ...shown.map(({name, unit: of}, k) => ({label: name + unit(of), scale: `y${k}`, stroke: colours[k]!, width: 2, ...(k === 1 && {dash: [8, 4]}), points: {show: false}, spanGaps: false}))],
      hooks: {
        drawClear: [(plot) => this.bands(plot, token)], draw: [(plot) => this.present(plot, token), (plot) => this.words(plot, token)],
        ready: [(plot) => plot.over.addEventListener('click', (event) => this.goTo(this.valueAt(plot, event)))],
      },
    };
  }

  private valueAt(plot: uPlot, event: MouseEvent): number {
    const {row} = this.context!, left = event.clientX - plot.over.getBoundingClientRect().left;
    return plot.posToVal(left, 'x') / shownValue(1, row.unit, this.system);
  }

  private endsOf(): Band[] {
    const {low, high} = this.context!, solved = this.samples.filter(({answer}) => isSolved(answer)), bands: Band[] = [];
    const first = this.samples[0], last = this.samples.at(-1);
    const add = (sample: Sample | undefined, from: number, to: number) => {
      if (!sample || isSolved(sample.answer)) return;
      const {word, state} = verdictOf(sample.answer);
      bands.push({from, to, word, isOver: state !== 'slack'});
    };
    if (solved.length === 0) {
      add(first, low, high);
      return bands;
    }
    add(first, low, solved[0]!.at);
    add(last, solved.at(-1)!.at, high);
    this.samples.forEach(({at, isJump}, i) => isJump && bands.push({from: this.samples[i - 1]!.at, to: at, word: 'JUMP', isOver: false}));
    for (let i = 0; i < this.samples.length; ++i) {  // solved, but not as one would have it
      const {answer} = this.samples[i]!;
      if (answer.status !== 'unstable' && answer.status !== 'slack') continue;
      let end = i;
      while (this.samples[end + 1]?.answer.status === answer.status) ++end;
      bands.push({from: this.samples[i]!.at, to: this.samples[end]!.at, word: answer.status === 'slack' ? 'SLACK' : 'UNSTABLE', isOver: false});
      i = end;
    }
    return bands;
  }

  private bands(plot: uPlot, token: (name: string) => string): void {
    const {ctx} = plot, {top, height} = plot.bbox, ratio = devicePixelRatio;
    ctx.save();
    for (const {left, right, isOver} of this.placed(plot)) {
      ctx.globalAlpha = 0.14;
      ctx.fillStyle = ctx.strokeStyle = token(isOver ? 'over' : 'slack');
      ctx.fillRect(left, top, right - left, height);
      ctx.globalAlpha = 1;
      ctx.setLineDash([6 * ratio, 3 * ratio]);
      ctx.lineWidth = 1.5 * ratio;
      for (const edge of [left, right]) if (edge > plot.bbox.left + 1 && edge < plot.bbox.left + plot.bbox.width - 1) {
        ctx.beginPath();
        ctx.moveTo(edge, top);
        ctx.lineTo(edge, top + height);
        ctx.stroke();
      }
    }
    ctx.restore();
  }

  /** In pixels, from left to right. */
  private placed(plot: uPlot): (Band & {left: number; right: number})[] {
    const {row} = this.context!, x = (value: number) => plot.valToPos(shownValue(value, row.unit, this.system), 'x', true);
    return this.endsOf().sort((a, b) => a.from - b.from).map((band) => ({...band, left: x(band.from), right: x(band.to)}));
  }

  /** What the bands are, over lines and grid. */
  private words(plot: uPlot, token: (name: string) => string): void {
    const {ctx} = plot, {left: begin, top, width} = plot.bbox, ratio = devicePixelRatio, gap = 4 * ratio;
    ctx.save();
    ctx.font = `bold ${11 * ratio}px system-ui, sans-serif`;
    ctx.textBaseline = 'top';
    let free = -Infinity;  // of words before
    for (const {left, right, word, isOver} of this.placed(plot)) {
      const room = ctx.measureText(word).width, isLeft = (left + right) / 2 < begin + width / 2;
      const beside = room < right - left - 2 * gap ? (left + right - room) / 2 : isLeft ? right + gap : left - room - gap, at = Math.max(begin, Math.min(beside, begin + width - room));
      if (at < free) continue;
      ctx.globalAlpha = 0.7;
      ctx.fillStyle = token('panel');
      ctx.fillRect(at - gap / 2, top + gap / 2, room + gap, 13 * ratio);
      ctx.globalAlpha = 1;
      ctx.fillStyle = token(isOver ? 'over' : 'slack');
      ctx.fillText(word, at, top + gap);
      free = at + room + gap;
    }
    ctx.restore();
  }

  private present(plot: uPlot, token: (name: string) => string): void {
    const {row, now} = this.context!, {ctx} = plot, {top, height} = plot.bbox;
    const x = plot.valToPos(shownValue(now, row.unit, this.system), 'x', true);
    ctx.save();
    ctx.setLineDash([]);
    ctx.strokeStyle = token('text');
    ctx.lineWidth = 2 * devicePixelRatio;
    ctx.beginPath();
    ctx.moveTo(x, top);
    ctx.lineTo(x, top + height);
    ctx.stroke();
    ctx.restore();
  }

  /** The same for who does not see it. */
  private tell(): void {
    const {row} = this.context!, name = (value: number) => `${shownValue(value, row.unit, this.system).toPrecision(5)} ${unitName(row.unit, this.system)}`;
    this.text.textContent = this.endsOf().map(({from, to, word}) => `${word} from ${name(from)} to ${name(to)}`).join('; ') || `solved over the whole range of ${row.name}`;
  }
}
