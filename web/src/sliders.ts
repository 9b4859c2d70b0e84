// One row a number: a box with its unit, steps for fingers, and a slider.
import type {Row} from './described';
import {button, make} from './make';
import {format, parse, type System, unitName} from './units';

const ways: Record<string, number> = {ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1};

interface Line { box: HTMLInputElement; range: HTMLInputElement; unit: HTMLElement; why: HTMLElement }

interface Told {
  changed(index: number, value: number): void;
  released(): void;
  switched(index: number): void;  ///< the other quantity of a row that has two
}

export class Sliders {
  private values: number[] = [];
  private rows: Row[] = [];
  private lines: Line[] = [];
  private readonly list = make('div');
  private readonly title = make('h2');
  private system: System = 'mm';
  private readonly id: string;

  /** @param home the button that puts all rows back */
  constructor(panel: HTMLElement, home: HTMLButtonElement, private readonly told: Told) {
    const head = make('div', {className: 'head'}, this.title, home);
    panel.append(head, this.list);
    this.id = panel.id;
  }

  show(title: string, rows: Row[], values: number[]): void {
    this.title.textContent = title;
    this.rows = rows;
    this.lines = [];
    this.list.replaceChildren(...rows.map((row, i) => this.row(row, i)));
    this.put(values);
  }

  /** Values from elsewhere: nobody is told. */
  put(values: number[]): void {
    this.values = [...values];
    this.rows.forEach((_, i) => {
      if (!this.lines[i]!.range.matches(':active')) this.span(i, true);
      this.write(i);
    });
  }

  /** These numbers are the answer, not the question, until one of them is touched. */
  answered(is: boolean): void {
    this.list.classList.toggle('answered', is);
  }

  use(system: System): void {
    this.system = system;
    this.lines.forEach(({unit}, i) => { unit.textContent = unitName(this.rows[i]!.unit, system); });
    this.put(this.values);
  }

  private row(row: Row, i: number): HTMLElement {
    const id = `${this.id}-${i}`, marks = make('datalist', {id: `${id}-marks`});
    const box = make('input', {id, inputMode: 'decimal', autocomplete: 'off'}), unit = row.other ? button('', () => this.told.switched(i), row.other) : make('span');
    const range = make('input', {type: 'range', min: String(row.low), max: String(row.high), step: String(row.step ?? 'any')}), why = make('span', {className: 'why'});
    const label = make('label', {htmlFor: id, title: row.path}, row.name);
    for (const mark of new Set([row.low, row.home, row.high])) marks.append(make('option', {value: String(mark)}));
    range.setAttribute('aria-label', row.name);
    range.setAttribute('list', marks.id);
    unit.className = 'unit';
    unit.textContent = unitName(row.unit, this.system);
    if (row.other) unit.ariaLabel = `${row.name}: ${row.other}`;
    why.setAttribute('role', 'alert');
    range.addEventListener('input', () => this.set(i, range.valueAsNumber));
    range.addEventListener('change', () => this.release(i));
    range.addEventListener('keydown', (event) => this.key(event, i));
    box.addEventListener('change', () => this.typed(i));
    box.addEventListener('focus', () => box.select());
    box.addEventListener('input', () => { box.dataset.typed = ''; });
    box.addEventListener('blur', () => { delete box.dataset.typed; });
    this.lines.push({box, range, unit, why});
    const step = (way: number) => button(way < 0 ? '−' : '+', () => this.step(i, way), `${row.name} ${way < 0 ? 'less' : 'more'}`);
    const steps = [step(-1), step(1)];
    for (const one of steps) {
      one.classList.add('step');
      one.tabIndex = -1;  // the slider has arrows
    }
    return make('div', {className: 'row'}, label, steps[0]!, box, unit, steps[1]!, range, marks, why);
  }

  private typed(i: number): void {
    const {box, why} = this.lines[i]!, value = parse(box.value, this.rows[i]!.unit, this.system), isWrong = typeof value === 'string';
    delete box.dataset.typed;
    box.setAttribute('aria-invalid', String(isWrong));
    why.textContent = isWrong ? value : '';
    if (!isWrong) this.set(i, value);
  }

  private step(i: number, hundredths: number): void {
    const {low, high, step} = this.rows[i]!, value = this.values[i]!, by = step ? Math.sign(hundredths) * step : hundredths * (high - low) / 100;
    this.set(i, Math.min(Math.max(high, value), Math.max(Math.min(low, value), value + by)));
  }

  /** Arrows are a hundredth of the range, with Shift ten times as much, with Alt a tenth. A digit opens the box. */
  private key(event: KeyboardEvent, i: number): void {
    if (event.ctrlKey || event.metaKey) return;
    const way = ways[event.key];
    if (way !== undefined) this.step(i, way * (event.shiftKey ? 10 : event.altKey ? 0.1 : 1));
    else if (event.key === '0') this.set(i, this.rows[i]!.home);
    else if (/^[1-9.-]$/.test(event.key) && !event.altKey) this.open(i, event.key);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** A hand has let go: the range is that of the robot again, but for a value beyond it. */
  private release(i: number): void {
    this.span(i, true);
    this.told.released();
  }

  private span(i: number, isNew: boolean): void {
    const {low, high} = this.rows[i]!, {range} = this.lines[i]!, value = this.values[i]!, [least, most] = isNew ? [low, high] : [Number(range.min), Number(range.max)];
    range.min = String(Math.min(least, low, value));
    range.max = String(Math.max(most, high, value));
  }

  private open(i: number, digit: string): void {
    const {box} = this.lines[i]!;
    box.focus();
    box.value = digit;
    box.dataset.typed = '';
    box.setSelectionRange(1, 1);
  }

  private set(i: number, given: number): void {
    const {step} = this.rows[i]!, value = step ? step * Math.round(given / step) : given;
    this.values[i] = value;
    this.write(i);
    this.told.changed(i, value);
  }

  private write(i: number): void {
    const value = this.values[i]!, {unit, step} = this.rows[i]!, {box, range, why} = this.lines[i]!, text = step ? String(value) : format(value, unit, this.system);
    if (box.dataset.typed === undefined) {  // else somebody is writing there
      box.value = text;
      box.removeAttribute('aria-invalid');
      why.textContent = '';
    }
    this.span(i, false);
    range.value = String(value);
    range.setAttribute('aria-valuetext', `${text} ${unitName(unit, this.system)}`);
  }
}
