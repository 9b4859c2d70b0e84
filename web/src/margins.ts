// What takes longer to say than where the robot is: asked when nothing moves.
import type {Json, Robot} from './client';
import {bearsLoad, type Described} from './described';
import {forward, given, inverse, plain, wrenchOf} from './questions';
import {numbersOf, type State} from './state';

/** How far the platform can go the way an input moves it before it meets a type II singularity. */
async function typeTwo(robot: Robot, described: Described, state: State, answer: Json, index: number): Promise<Json | null> {
  const U: number[][] | undefined = answer.velocity?.U, along = U?.map((row) => row[index]!), row = described.inputs[index]!;
  if (!along || along.every((part) => Math.abs(part) < 1e-12)) return null;
  const ways = await robot.ask([1, -1].map((way) => ({query: 'velocity', ...given(described, state, plain(answer.pose)), along: along.map((part) => way * part)})));
  const found = ways.map((one) => one.type_2_distance).filter((one) => one?.found).map((one) => one.distance as number);
  return found.length > 0 ? {name: row.name, unit: row.unit, distance: Math.min(...found)} : null;
}

/** How many times the load can be added before the robot gives way. */
async function reach(robot: Robot, described: Described, state: State, answer: Json): Promise<Json | null> {
  const limit = 10, start = described.isArm ? state.start ?? undefined : plain(answer.pose);
  const [found] = await robot.ask([{...forward(described, state, start), until: {wrench: wrenchOf(described, state), limit}}]) as [Json];
  return found.load === undefined ? null : {load: found.load, why: found.why, limit};
}

/** @param input the one last touched */
export async function margins(robot: Robot, described: Described, state: State, answer: Json, input: number): Promise<Json> {
  const found: Json = {};
  if (described.isSerial || !(answer.pose ?? answer.tip)) return found;
  if (bearsLoad(described, state.model)) {
    const far = wrenchOf(described, state) && state.asked === 'inputs' && answer.status === 'converged' ? await reach(robot, described, state, answer) : null;
    return far ? {reach: far} : found;
  }
  const two = await typeTwo(robot, described, state, answer, input);
  return two ? {typeTwo: two} : found;
}

const isSame = (a: number[], b: number[]) => a.every((value, i) => Math.abs(value - b[i]!) < 1e-7);

/**
 * Where the command has to start its search so that it ends where the page is; null where it does so from home.
 * @param answer of `forward`
 */
export async function startOf(robot: Robot, described: Described, state: State, answer: Json): Promise<number[] | null> {
  if (described.isArm) {  // its search begins at rest, or at a shape that was chosen
    if (!state.start || state.asked === 'pose') return null;
    const [plainly] = await robot.ask([forward(described, state)]) as [Json];
    if (described.hasArmLegs) return plainly.pose && isSame(numbersOf(plainly.pose), numbersOf(answer.pose)) ? null : numbersOf(state.start);
    return plainly.tip && isSame(plainly.tip.position, answer.tip.position) ? null : numbersOf(state.start);
  }
  if (state.asked === 'inputs') {
    if (described.isSerial || !answer.pose) return null;
    const [plainly] = await robot.ask([forward(described, state)]) as [Json], here = numbersOf(answer.pose);
    return plainly.pose && isSame(numbersOf(plainly.pose), here) ? null : here;
  }
  const {start: _, ...query} = inverse(described, state), [plainly] = await robot.ask([query]) as [Json];
  const inputs: number[] | undefined = described.isSerial ? plainly.configuration?.flat() : plainly.inputs;
  return inputs && isSame(inputs, state.inputs) ? null : state.inputs;
}
