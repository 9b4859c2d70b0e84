// Numbers of the tip and of the line to the device, large enough to be read from where the arm is.
import {make} from '../make';
import type {System} from '../units';
import type {PlanFrame} from './plan_buttons';

export type Reading = [name: string, value: string, isBad?: boolean];

export const lengthOf = (metres: number, system: System): string => (system === 'mm' ? `${(1e3 * metres).toFixed(1)} mm` : `${metres.toFixed(4)} m`).replace(/^-(0\.?0* )/, '$1').replace('-', '−');

/** Of a plan: how far along it the arm is, and what is then free around it. */
export function planReadings(plan: PlanFrame | null | undefined, system: System): Reading[] {
  if (!plan) return [];
  const {off_path: off, step, of, clearance} = plan;
  return [['plan step', off ? 'off path' : `${step} of ${of}`, !!off], ['clearance', off ? '–' : clearance === null ? 'not known' : lengthOf(clearance, system)]];
}

export class Readings {
  private readonly list = make('dl');
  private names = '';
  private values: HTMLElement[] = [];

  constructor(box: HTMLElement) {
    box.append(make('h2', {textContent: 'Tip'}), this.list);
  }

  show(rows: Reading[]): void {
    this.list.classList.toggle('many', rows.length > 7);
    const names = rows.map(([name]) => name).join();
    if (names !== this.names) {
      this.names = names;
      this.values = rows.map(() => make('dd'));
      this.list.replaceChildren(...rows.flatMap(([name], i) => [make('dt', {textContent: name}), this.values[i]!]));
    }
    rows.forEach(([, value, isBad], i) => {
      const cell = this.values[i]!;
      if (cell.textContent !== value) cell.textContent = value;
      cell.classList.toggle('bad', !!isBad);
    });
  }
}
