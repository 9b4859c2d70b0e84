// No robot yet: those that ship, as pictures with names. One click opens.
import {Robot, robotText, type Shipped} from './client';
import {describe, type Described} from './described';
import {drawingOf} from './drawn';
import {make} from './make';
import {shape} from './questions';
import {sketch} from './sketch';
import {type State, stateOf} from './state';

/** At home; a straight arm shows nothing of itself, so it is bent half-way. */
function posed(described: Described): State {
  const state = stateOf(described);
  if (described.isArm) return {...state, inputs: described.inputs.map(({home, high}, i) => (i % 4 === 0 ? (home + high) / 2 : home))};
  if (!described.isSerial) return state;
  return {...state, inputs: described.inputs.map((row, i) => (row.limits.high && i % 2 === 0 ? (row.home + row.high) / 2 : row.home))};
}

export class Start {
  private isFilled = false;

  /** @param guarded tells what goes wrong, and does the last again when there is hope */
  constructor(private readonly box: HTMLElement, private readonly open: (name: string) => void,
              private readonly guarded: (task: () => Promise<void>, again: () => void) => Promise<void>) {}

  show(shipped: Shipped[]): void {
    this.box.hidden = false;
    if (this.isFilled) return;
    this.isFilled = true;
    const list = make('div', {className: 'robots'}), cards = shipped.map((one) => this.card(one));
    list.append(...cards);
    this.box.replaceChildren(make('h1', {textContent: 'Robots that bend'}), make('p', {textContent: 'Choose one, or drop a robot file anywhere on the page.'}), list);
    const draw = (): void => void this.guarded(() => this.draw(shipped, cards), () => this.box.hidden ? (this.isFilled = false) : draw());
    draw();
  }

  get isShown(): boolean {
    return !this.box.hidden;
  }

  hide(): void {
    this.box.hidden = true;
  }

  private card({name, title, kind, space}: Shipped): HTMLElement {
    const card = make('button', {type: 'button', className: 'robot'}, make('span', {className: 'picture'}),
                      make('strong', {textContent: title}), make('span', {className: 'kind', textContent: `${kind === 'arm' ? 'elastic arm' : kind}, ${space === 'planar' ? 'in the plane' : 'in space'}`}));
    card.addEventListener('click', () => this.open(name));
    return card;
  }

  /** One after the other: the first are seen before the last are there. */
  private async draw(shipped: Shipped[], cards: HTMLElement[]): Promise<void> {
    for (const [i, {name}] of shipped.entries()) {
      if (cards[i]!.firstElementChild!.hasChildNodes()) continue;
      if (this.box.hidden) {
        this.isFilled = false;  // a page that comes back goes on
        return;
      }
      const robot = await Robot.open(await robotText(name)), described = await describe(robot), state = posed(described), [picture] = await robot.ask([shape(described, state)]);
      if (picture?.backbones) cards[i]!.firstElementChild!.append(sketch(drawingOf(described, state, picture, picture).shape, described.isPlanar, {width: 168, height: 112}));
    }
  }
}
