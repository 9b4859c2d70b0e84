// Numbers of the tip and of the line to the device, large enough to be read from where the arm is.
import {make} from '../make';
import type {System} from '../units';

export type Reading = [name: string, value: string, isBad?: boolean];

export const lengthOf = (metres: number, system: System): string => (system === 'mm' ? `${(1e3 * metres).toFixed(1)} mm` : `${metres.toFixed(4)} m`).replace(/^-(0\.?0* )/, '$1').replace('-', '−');

export class Readings {
  private readonly list = make('dl');
  private names = '';
  private values: HTMLElement[] = [];

  constructor(box: HTMLElement) {
    box.append(make('h2', {textContent: 'Tip'}), this.list);
  }

  show(rows: Reading[]): void {
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
