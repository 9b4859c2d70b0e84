// Where an arm's tip was seen, for the force at it that explains this.
import {button, make} from './make';
import {parse, type System, unitName} from './units';

export class Sense {
  private readonly box = make('input', {id: 'sensed', autocomplete: 'off', ariaLabel: 'Where the tip was seen: x, y, z', placeholder: 'x, y, z'});
  private readonly unit = make('span', {className: 'unit'});
  private readonly why = make('span', {className: 'why'});
  private readonly row = make('div', {className: 'sense', hidden: true}, make('h2', {textContent: 'Force by where the tip was seen'}),
                              this.box, this.unit,
                              button('Sense', () => void this.go(), 'the force at the tip that explains it, tendons held as they are'), this.why);
  private system: System = 'mm';

  /** @param sensed of a place [m]: why it found none; empty: it did */
  constructor(panel: HTMLElement, private readonly sensed: (place: number[]) => Promise<string>) {
    this.why.setAttribute('role', 'alert');
    this.box.addEventListener('keydown', (event) => event.key === 'Enter' && void this.go());
    panel.append(this.row);
  }

  show(is: boolean): void {
    this.row.hidden = !is;
    this.say('');
  }

  use(system: System): void {
    this.system = system;
    this.unit.textContent = unitName('m', system);
  }

  private say(why: string): void {
    this.box.setAttribute('aria-invalid', String(why !== ''));
    this.why.textContent = why;
  }

  private async go(): Promise<void> {
    const parts = this.box.value.split(',').map((part) => parse(part, 'm', this.system)), wrong = parts.find((part): part is string => typeof part === 'string');
    if (this.box.value.trim() === '') return this.say('');
    if (parts.length !== 3) return this.say(`give three numbers, x, y, z; found ${parts.length}`);
    if (wrong !== undefined) return this.say(wrong);
    this.say(await this.sensed(parts as number[]));
  }
}
