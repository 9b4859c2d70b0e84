// Other solutions of what is asked, as small pictures. A click goes to one.
import {type Json, Lost, Refused, type Robot} from './client';
import type {Described} from './described';
import {button, make} from './make';
import {forward, inverse, plain, poseOf, shape} from './questions';
import {sketch} from './sketch';
import {numbersOf, type State} from './state';

const most = 12;       // pictures
const patience = 300;  // ms that a search may take to be made unasked

/** A pose, of an arm the curvatures of its parts, of a platform on arms both, with the inputs that belong to it. */
export interface Solution { inputs: number[]; pose: Json | null }

interface Found { solution: Solution; answer: Json; number: number; isShown: boolean }

/** Nearer than this a solution is the one that is shown; in metres and radians, or parts of a quaternion. */
const same = 1e-5;
/** Of arms, which are refined to what their tips need. */
const sameArm = 1e-3;

/** Those of rods with a platform are searched for where nothing else is kept waiting. */
const isSlow = ({isArm}: Described, {model}: State) => !isArm && model === 'rod';

/** Of an arm's parts [1/m], as a link holds them: where a search begins they need not be exact. */
const rounded = (curvatures: number[][]): number[][] => curvatures.map((part) => part.map((one) => (Math.abs(one) < 1e-4 ? 0 : Number(one.toPrecision(5)))));

export class Solutions {
  private readonly title = make('h3');
  private readonly list = make('div', {className: 'small-multiples'});
  private readonly search = button('Look for others', () => void this.look());
  private readonly stop = button('Cancel', () => this.cancel());
  private run = 0;
  private searching = new AbortController();
  private took = new Map<string, number>();  // by robot and question [ms]
  private asked: (() => Promise<void>) | null = null;

  constructor(box: HTMLElement, private readonly goTo: (solution: Solution) => void) {
    box.append(this.title, this.list, this.search, this.stop);
    this.clear();
  }

  clear(): void {
    this.old();
    this.asked = null;
    this.list.replaceChildren();
    this.title.textContent = 'Other solutions';
    this.search.hidden = this.stop.hidden = true;
  }

  /** They are of what was asked before: to be seen still, not to be gone to. */
  old(): void {
    ++this.run;
    this.searching.abort();
    this.searching = new AbortController();
    this.list.inert = this.search.hidden = this.stop.hidden = true;
  }

  /** @param pose that the page shows */
  async offer(robot: Robot, described: Described, state: State, pose: Json | null): Promise<void> {
    this.clear();
    const isInverse = state.asked === 'pose';
    const {isArm} = described, hasNone = described.isSerial || (isArm ? isInverse || state.path !== null : state.model !== described.answer.model || (isInverse && state.model === 'rod'));
    if (hasNone) return void (this.title.textContent = '');
    const shown = isInverse ? state.inputs : isArm && !described.hasArmLegs ? state.pose : pose ? numbersOf(pose) : [];
    const key = `${described.answer.robot} ${isInverse}`;
    this.asked = async () => {
      const begin = performance.now(), {run} = this;
      await this.find(robot, described, state, shown, run);
      if (run === this.run) this.took.set(key, performance.now() - begin);
    };
    this.search.hidden = false;
    const took = this.took.get(key) ?? (isSlow(described, state) ? Infinity : 0);
    if (took < patience) await this.look();
  }

  private async look(): Promise<void> {
    const {run} = this;
    this.search.hidden = true;
    this.stop.hidden = false;
    this.title.textContent = 'Other solutions: looking…';
    try {
      await this.asked?.();
    } catch (error) {
      const isExpected = error instanceof Refused || error instanceof Lost;
      if (run === this.run) this.rest(isExpected ? `Other solutions: ${error instanceof Refused && error.isBusy ? 'the server is busy' : error.message}` : 'Other solutions');
      if (!isExpected && !(error instanceof DOMException)) throw error;
    }
  }

  private cancel(): void {
    this.old();
    this.rest('Other solutions: not looked for to the end');
  }

  /** As it is when nothing is looked for. */
  private rest(title: string): void {
    this.title.textContent = title;
    this.stop.hidden = true;
    this.search.hidden = false;
  }

  private async find(robot: Robot, described: Described, state: State, shown: number[], run: number): Promise<void> {
    const isInverse = state.asked === 'pose', query = isInverse ? {...inverse(described, state), all: true} : {...forward(described, state), all: true};
    delete (query as Json).start;
    delete (query as Json).want;
    const [all] = await (isSlow(described, state) ? robot.work([query], this.searching.signal) : robot.ask([query])) as [Json];
    if (run !== this.run) return;
    const distance = ({inputs, pose}: Solution, answer: Json) => {
      const values = isInverse ? inputs : described.hasArmLegs ? numbersOf(plain(answer.pose)) : described.isArm ? poseOf(described, answer) ?? [] : pose ? numbersOf(pose) : [];
      return Math.max(...values.map((value, i) => Math.abs(value - (shown[i] ?? value))));
    };
    const solutions = ((all.solutions ?? []) as Json[]).map((answer, i) => ({answer, number: i + 1, solution: this.solutionOf(all, answer, state)}));
    const byDistance = solutions.map((one) => ({...one, far: distance(one.solution, one.answer)})).sort((a, b) => a.far - b.far);
    const few: Found[] = byDistance.slice(0, most).map((one, i) => ({...one, isShown: i === 0 && one.far < (described.isArm ? sameArm : same)})).sort((a, b) => a.number - b.number);
    const shapes = few.length < 2 ? [] : await robot.ask(few.map((one) => this.shapeOf(described, state, one.solution)));
    if (run !== this.run) return;
    this.show(described, all, few, shapes);
  }

  private solutionOf(all: Json, one: Json, state: State): Solution {
    if (one.curvatures && one.pose) return {inputs: state.inputs, pose: {pose: plain(one.pose), curvatures: one.curvatures.map(rounded)}};
    if (one.curvatures) return {inputs: state.inputs, pose: rounded(one.curvatures)};
    return {inputs: one.inputs ?? state.inputs, pose: one.pose ? plain(one.pose) : all.pose ? plain(all.pose) : null};
  }

  private shapeOf(described: Described, state: State, {inputs, pose}: Solution): Json {
    return shape(described, {...state, inputs, asked: 'inputs', samples: described.isArm ? 33 : 9}, pose ?? undefined);
  }

  private show(described: Described, all: Json, few: Found[], shapes: Json[]): void {
    const count: number = all.solutions?.length ?? 0, isLeast = all.complete === false;
    const isFree = (all.solutions ?? []).some((one: Json) => one.continuum);
    const found = `${isLeast ? 'at least ' : ''}${count}${count > few.length ? `; the nearest ${few.length} are drawn` : ''}`;
    this.stop.hidden = true;
    this.list.inert = false;
    this.title.textContent = count > 1 ? `Solutions (${found})` : `Other solutions: ${isFree ? 'beside it, to which it may move freely' : all.error || isLeast || count === 0 ? 'none found' : 'none'}`;
    this.list.replaceChildren(...(count > 1 ? few.map((one, i) => this.small(described, one, shapes[i]!)) : []));
  }

  private small(described: Described, {solution, answer, number, isShown}: Found, picture: Json): HTMLElement {
    const word = isShown ? 'shown' : answer.continuum ? 'may move freely' : answer.stable === false ? 'unstable' : answer.stable ? 'stable' : `no. ${number}`;
    const small = button('', () => this.goTo(solution), isShown ? 'this is shown' : `go to solution ${number}`);
    small.className = 'small';
    small.disabled = isShown;
    small.setAttribute('aria-label', `${small.title}, ${word}`);
    small.setAttribute('aria-current', String(isShown));
    if (picture.backbones) small.append(sketch(picture, described.isPlanar, {width: 84, height: 72}));
    small.append(make('span', {textContent: word}));
    return small;
  }
}
