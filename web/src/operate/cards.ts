// The row of section cards. Where there are many they are smaller, and of more than ten the worst are shown, the rest as chips.
import {button, make} from '../make';
import {Card, type Hand, type Look} from './card';
import {kindOf, type SectionFrame, worstFirst} from './frame';
import {icon} from './mark';

const most = 10;

export class Cards {
  chosen = 0;
  private cards: Card[] = [];
  private readonly row = make('div', {className: 'row-of'});
  private readonly chips = make('div', {className: 'chips'});
  private chipButtons: HTMLButtonElement[] = [];
  private said: string[] = [];

  /** @param turned another section is chosen */
  constructor(private readonly box: HTMLElement, private readonly hand: Hand, private readonly turned: () => void) {
    this.chips.setAttribute('role', 'toolbar');
    this.chips.ariaLabel = 'Sections';
    box.append(this.chips, this.row);
  }

  begin(count: number): void {
    if (count === this.cards.length) return this.cards.forEach((card) => card.forget());
    this.cards = Array.from({length: count}, (_, i) => new Card(i, {...this.hand, chosen: (section) => this.choose(section)}));
    this.chipButtons = this.cards.map(({name}, i) => button(name, () => this.choose(i), `section ${i + 1}`));
    this.said = [];
    this.row.replaceChildren(...this.cards.map(({element}) => element));
    this.chips.replaceChildren(...this.chipButtons);
    this.box.dataset.size = count <= 5 ? 'large' : count <= most ? 'small' : 'many';
    this.box.dataset.count = String(count);
    this.row.style.setProperty('--count', String(Math.min(count, 5)));
    this.choose(0);
  }

  show(sections: SectionFrame[], look: (section: number) => Look, now: number): void {
    const worst = new Set(worstFirst(sections).slice(0, most));
    sections.forEach((section, i) => {
      const {element} = this.cards[i]!, isShown = sections.length <= most || worst.has(i);
      if (element.hidden === isShown) element.hidden = !isShown;
      this.cards[i]!.show(section, look(i), now);
      this.chip(i, section, isShown && sections.length > most);
    });
  }

  /** By a digit, a click, a gamepad. */
  choose(section: number, hasFocus = false): void {
    if (section < 0 || section >= this.cards.length) return;
    this.chosen = section;
    this.cards.forEach(({element}, i) => element.classList.toggle('chosen', i === section));
    this.chipButtons.forEach((one, i) => { one.ariaPressed = String(i === section); });
    if (hasFocus) this.cards[section]!.focus();
    this.turned();
  }

  private chip(i: number, {word}: SectionFrame, isCard: boolean): void {
    const one = this.chipButtons[i]!, kind = kindOf(word);
    if (one.classList.contains('is-card') !== isCard) one.classList.toggle('is-card', isCard);
    if (this.said[i] === word) return;
    this.said[i] = word;
    one.replaceChildren(make('span', {textContent: `S${i + 1}`}), icon(kind, 18), make('span', {className: 'sr', textContent: word}));
    one.dataset.state = kind;
  }
}
