// One row an input: a number box with its unit, and a slider.
import type {Row} from './rows';
import {format, parse, type System, unitName} from './units';

export class Sliders {
  values: number[] = [];
  private rows: Row[] = [];
  private boxes: HTMLInputElement[] = [];
  private ranges: HTMLInputElement[] = [];

  constructor(private readonly panel: HTMLElement, private readonly changed: () => void, private system: System) {}

  /** Values from elsewhere: nobody is told. */
  put(values: number[]): void {
    this.values = values;
    this.write();
  }


  show(rows: Row[], values: number[] | null): void {
    this.rows = rows;
    this.values = values ?? rows.map((row) => row.home);
    this.boxes = [];
    this.ranges = [];
    const home = document.createElement('button');
    home.type = 'button';
    home.textContent = 'Home';
    home.addEventListener('click', () => this.goHome());
    this.panel.replaceChildren(...rows.map((row, i) => this.row(row, i)), home);
    this.write();
  }

  use(system: System): void {
    this.system = system;
    this.panel.querySelectorAll('.unit').forEach((unit, i) => {
      unit.textContent = unitName(this.rows[i]!.unit, system);
    });
    this.write();
  }

  goHome(): void {
    this.values = this.rows.map((row) => row.home);
    this.write();
    this.changed();
  }

  private row(row: Row, i: number): HTMLElement {
    const line = document.createElement('div'), label = document.createElement('label'), box = document.createElement('input'),
          unit = document.createElement('span'), range = document.createElement('input'), why = document.createElement('span');
    line.className = 'row';
    label.textContent = row.name;
    label.htmlFor = box.id = `${this.panel.id}-${i}`;
    unit.className = 'unit';
    unit.textContent = unitName(row.unit, this.system);
    why.className = 'why';
    why.setAttribute('role', 'alert');
    range.type = 'range';
    range.min = String(row.low);
    range.max = String(row.high);
    range.step = 'any';
    range.setAttribute('aria-label', row.name);
    range.addEventListener('input', () => this.set(i, range.valueAsNumber));
    range.addEventListener('keydown', (event) => this.key(event, i));
    box.addEventListener('change', () => this.typed(i, box, why));
    box.inputMode = 'decimal';
    this.boxes.push(box);
    this.ranges.push(range);
    line.append(label, box, unit, range, why);
    return line;
  }

  private typed(i: number, box: HTMLInputElement, why: HTMLElement): void {
    const value = parse(box.value, this.rows[i]!.unit, this.system);
    box.setAttribute('aria-invalid', String(typeof value === 'string'));
    why.textContent = typeof value === 'string' ? value : '';
    if (typeof value === 'number') this.set(i, value);
  }

  /** Arrows are a hundredth of the range, with Shift ten times as much, with Alt a tenth. */
  private key(event: KeyboardEvent, i: number): void {
    const row = this.rows[i]!, step = (row.high - row.low) / 100 * (event.shiftKey ? 10 : event.altKey ? 0.1 : 1);
    const way = ({ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1} as Record<string, number>)[event.key];
    if (way !== undefined) this.set(i, Math.min(row.high, Math.max(row.low, this.values[i]! + way * step)));
    else if (event.key === '0') this.set(i, row.home);
    else return;
    event.preventDefault();
  }

  private set(i: number, value: number): void {
    this.values[i] = value;
    this.writeOne(i);
    this.changed();
  }

  private write(): void {
    this.rows.forEach((_, i) => this.writeOne(i));
  }

  private writeOne(i: number): void {
    const value = this.values[i]!, row = this.rows[i]!;
    this.boxes[i]!.value = format(value, row.unit, this.system);
    this.ranges[i]!.value = String(value);
    this.ranges[i]!.setAttribute('aria-valuetext', `${format(value, row.unit, this.system)} ${unitName(row.unit, this.system)}`);
  }
}
