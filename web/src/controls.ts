// The left panel: what of a state people turn.
import type {Held} from './arm';
import {Bending} from './bending';
import type {Json} from './client';
import {bearsLoad, type Described} from './described';
import {button, byId, make} from './make';
import {ModelTab} from './model_tab';
import {signsOf} from './questions';
import {rubs} from './remembered';
import {Sense} from './sense';
import {Sliders} from './sliders';
import {homes, type Side, type State} from './state';
import type {System} from './units';

/** What the controls ask the page to do. */
export interface Wishes {
  turn(side: Side | 'load', index: number, value: number): void;  ///< one number
  change(part: Partial<State>): void;
  bend(bending: number[] | null): void;
  sense(place: number[]): Promise<string>;  ///< the force at an arm's tip that was seen there [m]; why there is none
  hold(held: Held[]): void;  ///< what holds each tendon of an arm
  goHome(): void;
  release(): void;  ///< a hand has let go
}

export class Controls {
  private readonly sides: Record<Side | 'load', Sliders>;
  private readonly bending: Bending;
  private readonly sense: Sense;
  private readonly model: ModelTab;
  private readonly gravity = make('input', {type: 'checkbox', id: 'gravity'});
  private readonly gravityChoice = make('label', {className: 'choice'}, this.gravity, 'Gravity as in the file');
  private readonly rubs = make('input', {type: 'checkbox', id: 'rubs'});
  private readonly rubsChoice = make('label', {className: 'choice'}, this.rubs, 'Friction remembered');
  private readonly anew = button('Forget the path', () => this.wishes.change({path: [], start: null}), 'the straight arm, free of tensions, is where the path begins again');
  private readonly remembers = make('div', {className: 'remembers', hidden: true, title: 'Where tendons rub, where the arm is depends on how it came there: every move is followed as a path. Links do not hold it.'}, this.rubsChoice, this.anew);
  private readonly note = make('p', {className: 'note'});
  private readonly ways = (['tension', 'change'] as Held[]).map((of): [Held, HTMLButtonElement] => [of, button(of === 'tension' ? 'Tensions' : 'Length changes', () => this.holdAll(of), `all tendons are held by ${of === 'tension' ? 'their tension' : 'the change of their length'}`)]);
  private readonly held = make('div', {className: 'holding', role: 'group', ariaLabel: 'What holds the tendons'}, 'Hold', ...this.ways.map(([, one]) => one));
  private described: Described | null = null;

  constructor(private readonly wishes: Wishes) {
    const sliders = (side: Side | 'load', home: HTMLButtonElement) => new Sliders(byId(side), home, {changed: (i, value) => wishes.turn(side, i, value), released: () => wishes.release(), switched: (i) => this.holdOther(i)});
    this.sides = {
      inputs: sliders('inputs', button('Home', () => wishes.goHome(), 'all inputs to their home (h)')),
      pose: sliders('pose', button('Home', () => wishes.goHome(), 'the home pose (h)')),
      load: sliders('load', button('Zero', () => this.zero(), 'no load')),
    };
    byId('inputs').prepend(this.held);
    byId('inputs').append(this.remembers);
    this.rubs.addEventListener('change', () => wishes.change({path: this.rubs.checked ? [] : null, start: null, ...(this.rubs.checked && {asked: 'inputs' as const})}));
    this.bending = new Bending(byId('pose'), (bending) => wishes.bend(bending));
    this.model = new ModelTab(byId('model'), (part) => wishes.change(part));
    this.gravity.addEventListener('change', () => wishes.change({gravity: this.gravity.checked}));
    byId('load').append(this.gravityChoice, this.note);
    this.sense = new Sense(byId('load'), (place) => wishes.sense(place));
  }

  /** All of them say what the state is. */
  show(described: Described, state: State): void {
    const {holding} = described, hasTip = described.isSerial || (described.isArm && !described.hasArmLegs);
    this.described = described;
    this.held.hidden = !holding;
    for (const [of, one] of this.ways) one.setAttribute('aria-pressed', String(!!holding && holding.held.every((each) => each === of)));
    this.sides.inputs.show(described.isSerial ? 'Bends (forward)' : described.isArm ? 'Tendons (forward)' : 'Inputs (forward)', described.inputs, state.inputs);
    this.sides.pose.show(hasTip ? 'Tip (inverse)' : 'Pose (inverse)', described.pose, state.pose);
    this.sides.load.show(described.hasArmLegs ? 'Load on platform and legs' : described.isArm ? 'Load on the tip, and at s' : 'Load on the platform', described.load, state.load);
    this.gravityChoice.hidden = !described.hasGravity;
    this.gravity.checked = state.gravity;
    this.remembers.hidden = !rubs(described);
    this.rubs.checked = state.path !== null;
    this.anew.hidden = state.path === null;
    this.sense.show(described.isArm && !described.hasArmLegs);
    const bears = bearsLoad(described, state.model);
    this.note.replaceChildren(...(bears ? [] : ['Links of this model bear no load. ', button('Take pseudo-rigid chains', () => this.wishes.change({model: 'prb'}))]));
    byId('load').classList.toggle('idle', !bears);
    this.model.show(described, state);
    this.mark(state.asked);
  }

  put(side: Side | 'load', values: number[]): void {
    this.sides[side].put(values);
  }

  /** The side that is not asked is the answer. */
  mark(asked: Side): void {
    this.sides.inputs.answered(asked === 'pose');
    this.sides.pose.answered(asked === 'inputs');
  }

  showBending(described: Described, state: State, answer: Json): void {
    this.bending.show(described.canBend ? signsOf(answer) : null, state.bending !== null);
  }

  use(system: System): void {
    for (const side of Object.values(this.sides)) side.use(system);
    this.sense.use(system);
  }

  private holdAll(of: Held): void {
    if (this.described?.holding) this.wishes.hold(this.described.holding.held.map(() => of));
  }

  private holdOther(tendon: number): void {
    const held = this.described?.holding?.held;
    if (held) this.wishes.hold(held.map((of, i) => (i !== tendon ? of : of === 'tension' ? 'change' : 'tension')));
  }

  private zero(): void {
    if (this.described) this.wishes.change({load: homes(this.described.load)});
  }
}
