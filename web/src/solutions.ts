// Other solutions of what is asked, as small pictures. A click goes to one.
import type {Json, Robot} from './client';
import type {Described} from './described';
import {button, make} from './make';
import {forward, inverse, plain, shape} from './questions';
import {sketch} from './sketch';
import type {State} from './state';

const most = 12;       // pictures
const patience = 300;  // ms that a search may take to be made unasked

/** A pose with the inputs that belong to it. */
export interface Solution { inputs: number[]; pose: Json | null; curvature: number[] | null }

interface Found { solution: Solution; answer: Json; picture: Json }

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
    ++this.run;
    this.searching.abort();
    this.searching = new AbortController();
    this.list.replaceChildren();
    this.title.textContent = 'Other solutions';
    this.search.hidden = this.stop.hidden = true;
  }

  /** @param pose that the page shows */
  async offer(robot: Robot, described: Described, state: State, pose: Json | null): Promise<void> {
    this.clear();
    const isInverse = state.asked === 'pose';
    if (described.isSerial || (state.model !== described.answer.model) || (isInverse && state.model === 'rod')) return void (this.title.textContent = '');
    const shown = isInverse ? state.inputs : numbersOf(pose);
    const key = `${described.answer.robot} ${isInverse}`;
    this.asked = async () => {
      const begin = performance.now(), run = this.run;
      await this.find(robot, described, state, shown, run);
      if (run === this.run) this.took.set(key, performance.now() - begin);
    };
    this.search.hidden = false;
    const took = this.took.get(key) ?? (state.model === 'rod' ? Infinity : 0);
    if (took < patience) await this.look();
  }

  private async look(): Promise<void> {
    this.search.hidden = true;
    this.stop.hidden = false;
    this.title.textContent = 'Other solutions: looking…';
    try {
      await this.asked?.();
    } catch (error) {
      if (!(error instanceof DOMException)) throw error;  // cancelled
    }
  }

  private cancel(): void {
    this.clear();
    this.search.hidden = false;
  }

  private async find(robot: Robot, described: Described, state: State, shown: number[], run: number): Promise<void> {
    const isInverse = state.asked === 'pose', query = isInverse ? {...inverse(described, state), all: true} : {...forward(described, state), all: true};
    delete (query as Json).start;
    delete (query as Json).want;
    const [all] = await (state.model === 'rod' ? robot.work([query], this.searching.signal) : robot.ask([query])) as [Json];
    if (run !== this.run) return;
    const solutions: Json[] = all.solutions ?? [], few = solutions.slice(0, most);
    const shapes = few.length === 0 ? [] : await robot.ask(few.map((one) => this.shapeOf(described, state, all, one)));
    if (run !== this.run) return;
    this.show(described, all, few.map((one, i) => ({solution: this.solutionOf(all, one, state), answer: one, picture: shapes[i]!})), solutions.length, shown, isInverse);
  }

  private solutionOf(all: Json, one: Json, state: State): Solution {
    return {inputs: one.inputs ?? state.inputs, pose: one.pose ? plain(one.pose) : plain(all.pose), curvature: one.legs?.map((leg: Json) => leg.curvature) ?? null};
  }

  private shapeOf(described: Described, state: State, all: Json, one: Json): Json {
    const {inputs, pose} = this.solutionOf(all, one, state);
    return {...shape(described, {...state, inputs, asked: 'inputs', samples: 9}, pose!)};
  }

  private show(described: Described, all: Json, found: Found[], count: number, shown: number[], isInverse: boolean): void {
    this.stop.hidden = true;
    const isLeast = all.complete === false || count > most, distance = (one: Found) => {
      const values = isInverse ? one.solution.inputs : numbersOf(one.solution.pose);
      return Math.max(...values.map((value, i) => Math.abs(value - (shown[i] ?? value))));
    };
    const nearest = found.length > 0 ? found.reduce((best, one) => (distance(one) < distance(best) ? one : best)) : null;
    this.title.textContent = found.length < 2 ? `Other solutions: ${all.error || found.length === 0 ? 'none found' : isLeast ? 'none found' : 'none'}` : `Solutions (${isLeast ? 'at least ' : ''}${count})`;
    this.list.replaceChildren(...(found.length < 2 ? [] : found.map((one, i) => this.small(described, one, i, one === nearest))));
  }

  private small(described: Described, {solution, answer, picture}: Found, i: number, isShown: boolean): HTMLElement {
    const word = isShown ? 'shown' : answer.stable === false ? 'unstable' : answer.stable ? 'stable' : `no. ${i + 1}`;
    const small = button('', () => this.goTo(solution), isShown ? 'this is shown' : `go to solution ${i + 1}`);
    small.className = 'small';
    small.setAttribute('aria-label', `${small.title}, ${word}`);
    small.setAttribute('aria-current', String(isShown));
    if (picture.backbones) small.append(sketch(picture, described.isPlanar, {width: 84, height: 72}));
    small.append(make('span', {textContent: word}));
    return small;
  }
}

const numbersOf = (pose: Json | null): number[] => (!pose ? [] : pose.position ? [...pose.position, ...(pose.quaternion ?? [])] : [pose.x, pose.y, pose.phi]);

