// What the page asks: all that a link holds and that undo brings back.
import {type Held, wrenchParts} from './arm';
import type {Json} from './client';
import {type Described, holding, type Row} from './described';

export type Side = 'inputs' | 'pose';  ///< which of them is given; the other one is the answer

export interface State {
  asked: Side;
  inputs: number[];
  pose: number[];
  load: number[];
  held: Held[] | null;  ///< of an arm what each of its inputs is
  bending: number[] | null;  ///< of each leg at the pose: 1 or -1; null: as near to the last as can be
  gravity: boolean;
  model: string;
  joints: number;      ///< of each pseudo-rigid chain; 0: as the file says
  samples: number;     ///< points of each curve; 0: as many as is usual
  iterations: number;  ///< at most; 0: as many as is usual
  path: Json[] | null;  ///< of an arm whose tendons rub: how it came here, point by point; null: as if they did not rub
  start: Json | null;  ///< the pose near which that of the inputs is looked for, the last solved or a chosen one, of an arm the curvatures of its parts in a chosen one, of a platform on arms both; null: home
}

export const homes = (rows: Row[]) => rows.map((row) => row.home);

export function stateOf(described: Described): State {
  return {
    asked: 'inputs', inputs: homes(described.inputs), pose: homes(described.pose), load: homes(described.load), held: described.holding?.held ?? null, bending: null,
    gravity: true, model: described.answer.model, joints: 0, samples: 0, iterations: 0, path: null, start: null,
  };
}

const numbers = (text: string | null) => text?.split(',').map(Number);

/** A pose, or the curvatures of an arm's parts, or of a platform on arms both, as a list, as links and commands have it. */
export const numbersOf = (pose: Json): number[] => (Array.isArray(pose) ? pose.flat() : pose.curvatures ? [...numbersOf(pose.pose), ...pose.curvatures.flat(2)] : pose.position ? [...pose.position, ...(pose.quaternion ?? [])] : [pose.x, pose.y, pose.phi]);

function poseOf(values: number[] | undefined, isPlanar: boolean): Json | null {
  if (values?.length !== (isPlanar ? 3 : 7) || !values.every(Number.isFinite)) return null;
  const [x, y, phi] = values;
  return isPlanar ? {x, y, phi} : {position: values.slice(0, 3), quaternion: values.slice(3)};
}

/** Curvatures of an arm's parts, three numbers each. */
function partsOf(values: number[] | undefined): Json | null {
  if (!values || values.length === 0 || values.length % 3 !== 0 || !values.every(Number.isFinite)) return null;
  return Array.from({length: values.length / 3}, (_, k) => values.slice(3 * k, 3 * k + 3));
}

/** Of a platform on arms its pose, then the curvatures of each leg's parts. */
function ofLegs(values: number[] | undefined, legs: number, isPlanar: boolean): Json | null {
  const size = isPlanar ? 3 : 7, pose = poseOf(values?.slice(0, size), isPlanar), parts = partsOf(values?.slice(size)), each = (parts?.length ?? 0) / legs;
  if (!pose || !parts || !Number.isInteger(each)) return null;
  return {pose, curvatures: Array.from({length: legs}, (_, leg) => parts.slice(leg * each, (leg + 1) * each))};
}

/** `tc`: what holds the first tendon of an arm is a tension, of the second a change of its length. */
const letters = (held: Held[]) => held.map((one) => one[0]).join('');

/** The robot with the inputs that a link means. */
export function heldByLink(link: URLSearchParams, described: Described): Described {
  const word = link.get('held') ?? '';
  return /^[tc]+$/.test(word) ? holding(described, [...word].map((letter): Held => (letter === 't' ? 'tension' : 'change'))) : described;
}

/** Whether something of the load is not as it is at home. */
export const isLoaded = (described: Described, {load}: State) => load.some((part, i) => part !== (described.load[i]?.home ?? 0));

/** The state of a link, of which what does not fit the robot is left out. */
export function fromLink(link: URLSearchParams, described: Described): State {
  const state = stateOf(described);
  const take = (key: 'inputs' | 'pose' | 'load') => {
    const values = numbers(link.get(key));
    const isShort = key === 'load' && described.hasArmLegs && values?.length === wrenchParts(described);  // of older links
    if ((values?.length === state[key].length || isShort) && values?.every(Number.isFinite)) state[key] = [...values, ...state[key].slice(values.length)];
  };
  take('inputs');
  take('pose');
  take('load');
  if (link.get('asked') === 'pose') state.asked = 'pose';
  if (described.models.includes(link.get('model') ?? '')) state.model = link.get('model')!;
  const bending = numbers(link.get('bending'));
  if (bending?.length === described.answer.legs?.length && bending?.every((sign) => Math.abs(sign) === 1)) state.bending = bending;
  const start = numbers(link.get('start'));
  state.start = described.isSerial ? null : described.hasArmLegs ? ofLegs(start, described.answer.legs.length, described.isPlanar) : described.isArm ? partsOf(start) : poseOf(start, described.isPlanar);
  state.gravity = link.get('gravity') !== 'off';
  for (const key of ['joints', 'samples', 'iterations'] as const) state[key] = Math.max(0, Math.floor(Number(link.get(key)) || 0));
  return state;
}

/**
 * What of the state is not as it is at home. Inputs are there always: the link of a picture is to show it for ever.
 * @param start near which the pose has to be looked for; null where it is found from home
 */
export function toLink(robot: string, state: State, described: Described, start: number[] | null): URLSearchParams {
  const link = new URLSearchParams({robot});
  link.set('inputs', state.inputs.join(','));
  if (start && state.asked === 'inputs') link.set('start', start.join(','));  // else the inputs are where it starts
  if (state.asked === 'pose') {
    link.set('asked', 'pose');
    link.set('pose', state.pose.join(','));
  }
  if (state.held?.includes('change')) link.set('held', letters(state.held));
  if (isLoaded(described, state)) link.set('load', state.load.join(','));
  if (state.bending) link.set('bending', state.bending.join(','));
  if (!state.gravity) link.set('gravity', 'off');
  if (state.model !== described.answer.model) link.set('model', state.model);
  for (const key of ['joints', 'samples', 'iterations'] as const) if (state[key] > 0) link.set(key, String(state[key]));
  return link;
}

/** States that undo goes back to. What one control changes without a pause, or without letting go, is one step. */
export class History {
  private before: State[] = [];
  private after: State[] = [];
  private last = -Infinity;
  private by = '';

  constructor(private readonly pause = 700) {}

  clear(): void {
    this.before = [];
    this.after = [];
    this.end();
  }

  /** Call before a change. @param by the control that makes it; of none each change is a step */
  keep(state: State, by = ''): void {
    const now = performance.now();
    if (by === '' || by !== this.by || now - this.last > this.pause) this.before.push(structuredClone(state));
    this.last = now;
    this.by = by;
    this.after = [];
    if (this.before.length > 200) this.before.shift();
  }

  /** The control was let go. */
  end(): void {
    this.by = '';
  }

  undo(state: State): State | null {
    return this.step(this.before, this.after, state);
  }

  redo(state: State): State | null {
    return this.step(this.after, this.before, state);
  }

  private step(from: State[], to: State[], state: State): State | null {
    const found = from.pop();
    if (!found) return null;
    to.push(structuredClone(state));
    this.end();
    return found;
  }
}
