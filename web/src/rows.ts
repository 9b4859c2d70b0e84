// What the sliders of a robot are: its inputs, or of a serial robot its bends, with range and home.
import type {Json, Robot} from './client';
import type {Unit} from './units';

export interface Row { name: string; unit: Unit; low: number; high: number; home: number }

export interface Described {
  answer: Json;
  isSerial: boolean;
  isPlanar: boolean;
  rows: Row[];
  poseRows: Row[];  ///< what a pose is asked by
  loadRows: Row[];  ///< the wrench on the platform; empty where the legs bear none
}

/** Where nothing limits an input the slider covers this part of its home value to both sides. */
const share = 0.2;

function serialRows(answer: Json): Row[] {
  return answer.configuration.map((entry: Json) => {
    const index = Number(/\[(\d+)\]/.exec(entry.name)?.[1] ?? 0);
    const limit: number = answer.sections[index]?.limit ?? Math.PI;
    if (/\.phi$/.test(entry.name)) return {...entry, low: -Math.PI, high: Math.PI, home: 0};
    if (/\.theta$/.test(entry.name)) return {...entry, low: 0, high: limit, home: 0};
    if (entry.unit === 'rad') return {...entry, low: -limit, high: limit, home: 0};
    const [low, high] = entry.limits ?? [0, 1];
    return {...entry, low, high, home: low};
  });
}

function loadRows(answer: Json): Row[] {
  if (answer.model !== 'rod') return [];
  const row = (name: string, unit: Unit, reach: number): Row => ({name, unit, low: -reach, high: reach, home: 0});
  return [row('Fx', 'N', 5), row('Fy', 'N', 5), row('Fz', 'N', 20), row('Mx', 'N m', 0.5), row('My', 'N m', 0.5), row('Mz', 'N m', 0.5)];
}

/** Whether three actuators hold three independent coordinates of a platform in space, not its pose. */
function isHeldByFew(answer: Json): boolean {
  return answer.kind === 'parallel' && answer.space === 'spatial' && answer.freedoms.actuators < answer.freedoms.platform;
}

function atHome(answer: Json): Json {
  const {home} = answer;
  return isHeldByFew(answer) ? {independent: {z: home.position[2], e1: 0, e2: 0}} : {pose: home};
}

function poseRows(answer: Json): Row[] {
  const row = (name: string, unit: Unit, home: number, reach: number): Row =>
    ({name, unit, low: home - reach, high: home + reach, home});
  if (answer.kind === 'serial') {
    const length: number = answer.sections.reduce((sum: number, section: Json) => sum + (section.length ?? 0), 0);
    return [row('x', 'm', 0, length), row('y', 'm', 0, length), {...row('z', 'm', length, length), high: length, low: 0}];
  }
  if (answer.space === 'planar') {
    const reach = answer.legs[0].link.length / 2 || 0.1;
    return [row('x', 'm', answer.home.x, reach), row('y', 'm', answer.home.y, reach), row('phi', 'rad', answer.home.phi, 1)];
  }
  const [x, y, z] = answer.home.position, reach = 0.3 * z || 0.1;
  if (isHeldByFew(answer)) return [row('z', 'm', z, reach), row('e1', '', 0, 0.5), row('e2', '', 0, 0.5)];
  return [row('x', 'm', x, reach), row('y', 'm', y, reach), row('z', 'm', z, reach)];
}

/** The pose, and of rods whether it holds and by how much. */
export function forward(described: Described, at: Json): Json {
  return {query: 'forward', ...at, ...(described.loadRows.length > 0 && {want: ['stability', 'margins']})};
}

/** How near to a singularity a platform on legs without load is. */
export function velocities(described: Described, at: Json): Json[] {
  return described.isSerial || described.loadRows.length > 0 ? [] : [{query: 'velocity', ...at}];
}

/** The query for the inputs that bring the platform, or the tip, where the pose's sliders say. */
export function inverse(described: Described, values: number[], last: Json | null): Json {
  const {answer, poseRows: rows} = described, byName = Object.fromEntries(rows.map((row, i) => [row.name, values[i]!]));
  if (described.isSerial) return {query: 'inverse', position: values, ...(last?.configuration && {start: last.configuration})};
  if (described.isPlanar) return {query: 'inverse', pose: byName};
  if (isHeldByFew(answer)) return {query: 'inverse', independent: byName};
  const quaternion = last?.pose?.quaternion ?? answer.home.quaternion;
  return {query: 'inverse', pose: {position: values, quaternion}};
}

/** Where an answer has the platform, or the tip, in the words of the pose's sliders; nothing where it has none. */
export function poseOf(described: Described, answer: Json): number[] | null {
  const pose = answer.pose ?? answer.tip;
  if (!pose) return null;
  if (described.isPlanar) return [pose.x, pose.y, pose.phi];
  return isHeldByFew(described.answer) ? [pose.position[2], pose.quaternion[1], pose.quaternion[2]] : pose.position;
}

/** What an answer to `inverse` gives the sliders of the inputs; nothing where it has none. */
export function inputsOf(described: Described, answer: Json): number[] | null {
  const values = described.isSerial ? answer.configuration?.flat() : answer.inputs;
  return values?.length === described.rows.length ? values : null;
}

function parallelRows(answer: Json, home: number[]): Row[] {
  return answer.inputs.map((entry: Json, i: number) => {
    const value = home[i] ?? (entry.limits ? (entry.limits[0] + entry.limits[1]) / 2 : 0);
    const reach = Math.max(Math.abs(value) * share, entry.unit === 'rad' ? 0.5 : 0.01);
    const [low, high] = entry.limits ?? [value - reach, value + reach];
    return {name: entry.name, unit: entry.unit, low, high, home: value};
  });
}

export async function describe(robot: Robot): Promise<Described> {
  const answer = (await robot.ask([{query: 'describe'}]))[0]!;
  const isSerial = answer.kind === 'serial', isPlanar = answer.space === 'planar';
  if (isSerial) return {answer, isSerial, isPlanar, rows: serialRows(answer), poseRows: poseRows(answer), loadRows: []};
  const home = (await robot.ask([{query: 'inverse', ...atHome(answer)}]))[0]!;
  return {answer, isSerial, isPlanar, rows: parallelRows(answer, home.inputs ?? []), poseRows: poseRows(answer), loadRows: loadRows(answer)};
}

/** The values of the sliders as fields of a query. */
export function fields(described: Described, values: number[], last: Json | null): Json {
  if (!described.isSerial) return last?.pose ? {inputs: values, start: last.pose} : {inputs: values};
  const sections: number[][] = [];
  described.rows.forEach((row, i) => {
    const index = Number(/\[(\d+)\]/.exec(row.name)?.[1] ?? 0);
    (sections[index] ??= []).push(values[i]!);
  });
  return {configuration: sections};
}
