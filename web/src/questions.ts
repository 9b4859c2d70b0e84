// Queries of a state, and what their answers say of it. The one place that knows how each kind of robot is asked.
import {heldBy, heldIn, loads, tipField, tipOf, wrenchParts} from './arm';
import type {Json} from './client';
import {bearsLoad, type Described, indexOf} from './described';
import {here, trackOf, walked} from './remembered';
import type {Side, State} from './state';

/** The wrench on the platform, or on an arm's tip; null where there is none, or the links bear none. */
export function wrenchOf(described: Described, state: State): number[] | null {
  const wrench = described.isArm ? state.load.slice(0, wrenchParts(described)) : state.load;
  return bearsLoad(described, state.model) && wrench.some((part) => part !== 0) ? wrench : null;
}

/** What all queries of a state have in common. */
function common(described: Described, state: State): Json {
  const {answer} = described, query: Json = {};
  if (state.model !== answer.model) query.model = state.model;
  if (described.isArm) Object.assign(query, loads(described, state), state.model === 'prb' && state.joints > 0 && {elements: state.joints});
  else if (state.model === 'prb' && state.joints > 0)
    query.set = Object.fromEntries(answer.legs.map((_: Json, i: number) => [`legs[${i}].link.joints`, state.joints]));
  const wrench = wrenchOf(described, state);
  if (wrench) query.wrench = wrench;
  if (described.hasGravity && !state.gravity) query.gravity = [0, 0, 0];
  if (state.iterations > 0) query.max_iterations = state.iterations;
  return query;
}

/** The numbers of a serial robot's rows, a list a section. */
export function bySection(described: Described, values: number[]): number[][] {
  const sections: number[][] = [];
  described.inputs.forEach((row, i) => (sections[indexOf(row.path)] ??= []).push(values[i]!));
  return sections;
}

/** Inputs, and where a search for the pose begins: a pose, of an arm the curvatures of its parts, of a platform on arms both, `last`, or at home. */
export function given(described: Described, state: State, start?: Json | string): Json {
  if (described.isArm) return {...heldBy(described, state.inputs), ...((Array.isArray(start) || (start as Json | undefined)?.curvatures) && {start}), ...common(described, state)};
  if (described.isSerial) return {configuration: bySection(described, state.inputs), ...common(described, state)};
  return {inputs: state.inputs, ...(start && {start}), ...common(described, state)};
}

const withTilt = (described: Described) => (described.isPlanar ? {} : {tilt: true});

/** Whether answers say if what is solved holds by itself, and by how much. */
const hasStability = ({isArm}: Described, state: State) => isArm || state.model === 'rod';

/** What is told of it. */
export const stability = ({hasArmLegs}: Described) => (hasArmLegs ? ['stability'] : ['stability', 'margins']);

/** The pose of the inputs; of rods and arms also whether it holds and by how much. */
export function forward(described: Described, state: State, start?: Json | string): Json {
  const wants = hasStability(described, state) ? {want: stability(described)} : {};
  return {query: 'forward', ...given(described, state, start), ...withTilt(described), ...wants};
}

/** Of a serial robot points are those of each joint: few long joints need more of them to look round. */
const fewestOfSection = 40;

function samplesOf({answer}: Described, state: State): number {
  if (state.samples > 0 || answer.kind !== 'serial') return state.samples;
  return Math.max(5, Math.ceil(fewestOfSection / Math.min(...answer.sections.map((one: Json) => one.segments))));
}

/** Chains are drawn joint by joint. */
const hasSamples = ({isArm}: Described, {model}: State) => isArm || model !== 'prb';

export function shape(described: Described, state: State, start?: Json | string): Json {
  const {max_iterations: _, ...at} = given(described, state, start), samples = samplesOf(described, state);
  return {query: 'shape', ...at, ...(samples > 0 && hasSamples(described, state) && {samples})};
}

/** Velocity equations tell how near a singularity is. Of rods `margins` do; chains at a load have none. */
export const hasVelocity = (described: Described, state: State) => !bearsLoad(described, state.model);

export function velocity(described: Described, state: State, start?: Json | string): Json {
  return {query: 'velocity', ...given(described, state, start), ...withTilt(described)};
}

/** What is drawn and told of a configuration, asked with it: it is solved once. */
function inFull(described: Described, state: State): Json {
  const samples = samplesOf(described, state);
  return {
    ...withTilt(described), ...(samples > 0 && hasSamples(described, state) && {samples}),
    want: ['shape', ...(hasVelocity(described, state) ? ['velocity'] : []), ...(hasStability(described, state) ? stability(described) : []), ...(described.isArm ? ['stiffness'] : [])],
  };
}

/** The way of an arm whose tendons rub, to what is asked now. */
function alongPath(described: Described, state: State): Json {
  const {wrench: _w, loads: _l, ...rest} = common(described, state), samples = samplesOf(described, state);
  return {...trackOf(walked(state.path!, here(described, state))), ...rest, ...withTilt(described), ...(samples > 0 && hasSamples(described, state) && {samples}), want: ['shape']};
}

/** All that is shown of the side that is given. */
export function everything(described: Described, state: State, start?: Json | string): Json {
  if (state.path && state.asked === 'inputs') return alongPath(described, state);
  return {...(state.asked === 'pose' ? inverse(described, state) : forward(described, state, start)), ...inFull(described, state)};
}

function poseField(described: Described, values: number[]): Json {
  const byName = Object.fromEntries(described.pose.map((row, i) => [row.path, values[i]!]));
  if (described.isArm && !described.hasArmLegs) return tipField(described, values);
  if (described.isSerial) return {position: values};
  if (described.isPlanar) return {pose: byName};
  if (described.isHeldByFew) return {independent: byName};
  const {tilt, azimuth, torsion} = byName;
  return {pose: {position: values.slice(0, 3), tilt, azimuth, torsion}};
}

/** The inputs of the pose. Of several solutions that of `bending`, else the one nearest to the inputs so far. */
export function inverse(described: Described, state: State): Json {
  const query: Json = {query: 'inverse', ...poseField(described, state.pose), ...common(described, state)};
  if (described.isArm) return query;
  if (described.isSerial) return {...query, start: bySection(described, state.inputs)};
  if (bearsLoad(described, state.model)) return state.bending && described.canBend ? {...query, bending: state.bending} : query;
  return state.bending && described.canBend ? {...query, bending: state.bending} : {...query, start: state.inputs};
}

/** The force at an arm's tip by where that was seen [m]; what is at the tip so far is not known. */
export function sensing(described: Described, state: State, position: number[]): Json {
  const {wrench: _, ...query} = given(described, state);
  return {query: 'statics', ...query, position};
}

/** Where an answer has the platform, or the tip, in the words of the pose's rows; null where it says nothing of it. */
export function poseOf(described: Described, answer: Json): number[] | null {
  const pose = answer.pose ?? answer.tip;
  if (!pose) return null;
  if (described.isArm && !described.hasArmLegs) return tipOf(described, pose);
  if (described.isPlanar) return [pose.x, pose.y, pose.phi];
  if (described.isHeldByFew) return [pose.position[2], pose.quaternion[1], pose.quaternion[2]];
  return described.isSerial ? pose.position : [...pose.position, pose.tilt ?? 0, pose.azimuth ?? 0, pose.torsion ?? 0];
}

/** The inputs in an answer to `inverse`; null where it has none. */
export function inputsOf(described: Described, answer: Json): number[] | null {
  if (described.isArm) return heldIn(described, answer);
  const values = described.isSerial ? answer.configuration?.flat() : answer.inputs;
  return values?.length === described.inputs.length ? values : null;
}

/** Of each leg the side to which it bends. */
export const signsOf = (answer: Json): number[] | null =>
  answer.legs?.every((leg: Json) => typeof leg.curvature === 'number') ? answer.legs.map((leg: Json) => (leg.curvature < 0 ? -1 : 1)) : null;

/** A state with one number of it changed, as a slider does. */
export function changed(state: State, side: Side | 'load', index: number, value: number): State {
  const values = [...state[side]];
  values[index] = value;
  return {...state, ...(side !== 'load' && {asked: side}), [side]: values};
}

/** An answer that may be drawn and walked on from. `unstable` and `slack` are solved too, and their words say what is wrong. */
export const isSolved = (answer: Json) => !answer.error && ['converged', 'unstable', 'slack'].includes(answer.status);

/** An answer to `everything`, with its velocity equations by themselves: at a singularity these are what has no answer, and the pose is solved. */
export function told(answer: Json): Json {
  return answer.J ? {...answer, ...(answer.status === 'singular' && {status: 'converged'}), velocity: answer} : answer;
}

/** A pose as a question takes it: its orientation once. */
export function plain(pose: Json): Json {
  const {tilt: _t, azimuth: _a, torsion: _s, ...rest} = pose;
  return rest;
}
