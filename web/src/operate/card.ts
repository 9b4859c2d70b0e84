// The card of a section: its state in a word and a shape, its diagram, its tendons. The diagram takes targets from pointer and keys.
import {button, make} from '../make';
import type {System} from '../units';
import {TendonBars} from './bars';
import {clamped} from './coordinates';
import {described, Diagram, type View} from './diagram';
import {type Bend, kindOf, type SectionFrame} from './frame';
import {Grip} from './grip';
import {icon} from './mark';
import {Trail} from './trail';

export interface Hand {
  aim(section: number, bend: Bend): void;   ///< the target is to be there
  may(section: number): boolean;            ///< whether a target may be set; if not it says why
  chosen(section: number): void;
  type(section: number): void;              ///< numbers are to be typed
}

export interface Look { isDisc: boolean; limit: number; given: string[]; age: string; tensionLimit: number; system: System }

const degree = Math.PI / 180;

export class Card {
  readonly element = make('article', {className: 'section'});
  readonly diagram = new Diagram();
  readonly name: string;
  private readonly head = make('h2');
  private readonly plot = make('div', {className: 'plot-of', tabIndex: 0});
  private readonly bars = new TendonBars();
  private readonly trail = new Trail();
  private readonly digits = make('p', {className: 'digits'});
  private frame: SectionFrame | null = null;
  private look: Look | null = null;
  private over: Bend | null = null;
  private side = 0;
  private said = '';

  constructor(private readonly index: number, private readonly hand: Hand) {
    this.name = `S${index + 1}`;
    this.plot.setAttribute('role', 'application');
    this.plot.setAttribute('aria-roledescription', 'section diagram');
    this.plot.append(this.diagram.element);
    const numbers = button('…', () => hand.type(index), `numbers of ${this.name}`);
    numbers.className = 'type';
    numbers.ariaLabel = `numbers of ${this.name}`;
    this.element.append(this.head, this.plot, this.bars.element, this.digits, numbers);
    this.listen();
    new ResizeObserver(([entry]) => this.resize(entry!.contentRect)).observe(this.plot);
  }

  focus(): void {
    this.plot.focus();
  }

  /** @param now [ms] of the trail */
  show(frame: SectionFrame, look: Look, now: number): void {
    [this.frame, this.look] = [frame, look];
    if (kindOf(frame.word) === 'stale') this.trail.clear();  // where it was meanwhile nobody knows
    else if (frame.point) this.trail.put(frame.point, now);
    this.write();
    this.draw();
    this.bars.show(frame, look.tensionLimit, look.system);
  }

  forget(): void {
    this.trail.clear();
  }

  private write(): void {
    const {frame, look, name} = this, kind = kindOf(frame!.word), more = [frame!.near_limit && kind === 'exact' ? 'near limit' : '', look!.age].filter(Boolean).join(', ');
    const said = `${frame!.word} ${more}`;
    if (said === this.said) return;
    this.said = said;
    this.element.dataset.state = kind;
    this.head.replaceChildren(make('span', {className: 'name', textContent: name}), icon(kind), make('span', {className: 'word', textContent: frame!.word}), make('span', {className: 'more', textContent: more}));
  }

  private get view(): View {
    const {frame, look, over} = this;
    return {section: frame!, kind: kindOf(frame!.word), trail: this.trail.points(), over, isDisc: look!.isDisc, limit: look!.limit, given: look!.given};
  }

  private draw(): void {
    if (!this.frame || this.side <= 0) return;
    const {view} = this, degrees = (value: number) => `${(value / degree).toFixed(1)}°`;
    this.diagram.draw(view, this.side);
    this.plot.ariaLabel = described(view, this.name, degrees);
    const {point, target} = view.section;
    this.digits.textContent = (point ?? target).map(degrees).join('  ');
  }

  private resize({width, height}: DOMRectReadOnly): void {
    this.side = Math.floor(Math.min(width, height));
    this.draw();
  }

  // Where the target goes

  private listen(): void {
    const {plot} = this;
    plot.addEventListener('pointerdown', () => this.hand.chosen(this.index));
    this.head.addEventListener('click', () => this.hand.chosen(this.index));
    new Grip(plot, {
      may: () => !!this.frame && this.hand.may(this.index), bend: (event) => this.bendAt(event), target: () => this.frame!.target, limit: () => this.look!.limit, isDisc: () => this.look!.isDisc,
      aim: (to, over) => this.aim(to, over), letGo: () => this.pull(null),
    });
    plot.addEventListener('dblclick', () => this.hand.type(this.index));
    plot.addEventListener('keydown', (event) => this.key(event));
    plot.addEventListener('focus', () => this.hand.chosen(this.index));
  }

  private bendAt({clientX, clientY}: PointerEvent): Bend {
    const {left, top} = this.diagram.element.getBoundingClientRect();
    return this.diagram.plane.bend([clientX - left, clientY - top]);
  }

  private pull(over: Bend | null): void {
    this.over = over;
    this.draw();
  }

  private aim(to: Bend, over: Bend | null): void {
    this.over = over;
    this.frame = {...this.frame!, target: to};
    this.draw();
    this.hand.aim(this.index, to);
  }

  private key(event: KeyboardEvent): void {
    const ways: Record<string, Bend> = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}, way = ways[event.key];
    if (event.ctrlKey || event.altKey || event.metaKey || !this.frame || !this.look) return;
    if (!way && event.key !== 'Enter') return;
    event.preventDefault();  // else Enter would also send the dialog that it opens
    if (!way) return this.hand.type(this.index);
    if (!this.hand.may(this.index)) return;
    const by = (event.shiftKey ? 1 : 0.1) * degree, [x, y] = this.frame.target;
    this.aim(clamped([x + by * way[0], y + by * way[1]], this.look.limit, this.look.isDisc), null);
  }
}
