// A small dialog in which numbers are typed.
import {make} from '../make';
import {format, parse, type System, type Unit, unitName} from '../units';

export interface Field { name: string; unit: Unit; value: number; low: number; high: number }

export class NumbersDialog {
  private readonly dialog = make('dialog', {className: 'numbers-dialog'});

  constructor(box: HTMLElement) {
    this.dialog.ariaLabel = 'Numbers';
    box.append(this.dialog);
  }

  ask(title: string, fields: Field[], system: System, done: (values: number[]) => void): void {
    if (this.dialog.open) return;
    const rows = fields.map((field, i) => {
      const input = make('input', {id: `typed-${i}`, value: format(field.value, field.unit, system), autocomplete: 'off'}), why = make('span', {className: 'why'});
      why.setAttribute('role', 'alert');
      return {field, input, why, row: make('div', {className: 'row'}, make('label', {htmlFor: input.id, textContent: field.name}), input, make('span', {className: 'unit', textContent: unitName(field.unit, system)}), why)};
    });
    const read = rows.map(({field, input, why}) => () => {
      const value = parse(input.value, field.unit, system), limit = (of: number) => `${format(of, field.unit, system)} ${unitName(field.unit, system)}`;
      const wrong = typeof value === 'string' ? value : value < field.low - 1e-12 || value > field.high + 1e-12 ? `it goes from ${limit(field.low)} to ${limit(field.high)}` : '';
      why.textContent = wrong;
      input.ariaInvalid = String(wrong !== '');
      return wrong ? null : (value as number);
    });
    const form = make('form', {method: 'dialog'}, make('h2', {textContent: title}), ...rows.map(({row}) => row),
                      make('div', {className: 'ends'}, make('button', {type: 'button', textContent: 'Cancel', onclick: () => this.dialog.close()}), make('button', {type: 'submit', className: 'main', textContent: 'Set'})));
    form.addEventListener('submit', (event) => {
      const values = read.map((one) => one());
      if (values.some((value) => value === null)) return event.preventDefault();
      done(values as number[]);
    });
    this.dialog.replaceChildren(form);
    this.dialog.showModal();
    rows[0]!.input.select();
  }
}
