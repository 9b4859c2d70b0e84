// To which side each leg bends at a pose: plus, minus, or as it comes.
import {button, make} from './make';

export class Bending {
  private readonly list = make('div', {className: 'bending'});
  private readonly box: HTMLElement;
  private signs: number[] | null = null;

  constructor(panel: HTMLElement, private readonly changed: (bending: number[] | null) => void) {
    const title = make('h2', {textContent: 'Bending of the legs'}), free = button('Nearest', () => changed(null), 'the solution nearest to the last inputs');
    this.box = make('div', {}, make('div', {className: 'head'}, title, free), this.list);
    panel.append(this.box);
  }

  /** @param signs of the legs as they bend now; null: this robot has nothing to choose */
  show(signs: number[] | null, isChosen: boolean): void {
    this.box.hidden = !signs;
    if (!signs) return;
    if (signs.length !== this.signs?.length) this.list.replaceChildren(...signs.map((_, i) => this.leg(i)));
    this.signs = signs;
    this.list.classList.toggle('chosen', isChosen);
    signs.forEach((sign, i) => this.list.children[i]!.querySelectorAll('button').forEach((one, k) =>
      one.setAttribute('aria-pressed', String(sign === (k === 0 ? 1 : -1)))));
  }

  private leg(i: number): HTMLElement {
    const to = (sign: number) => {
      const made = button(sign > 0 ? '+' : '−', () => this.changed(this.signs!.map((old, k) => (k === i ? sign : old))));
      made.setAttribute('aria-label', `leg ${i + 1} bends ${sign > 0 ? 'plus' : 'minus'}`);
      return made;
    };
    return make('div', {className: 'pair'}, `leg ${i + 1}`, to(1), to(-1));
  }
}
