// What a robot lets be asked of it: rows for its inputs, its pose and its load, each with a range and a home.
import {armDescribed, armLegsDescribed, type Held, type Holding} from './arm';
import type {Json, Robot} from './client';
import type {Unit} from './units';

export interface Row {
  name: string;   ///< short, as it is shown
  path: string;   ///< what the robot's file calls it
  unit: Unit;
  low: number;
  high: number;
  home: number;
  limits: {low: boolean; high: boolean};  ///< whether these are limits of the robot, not only ends of the slider
  step?: number;   ///< of a count: it has no values between
  other?: string;  ///< what a click on the unit does: the row has two quantities
}

export interface Described {
  answer: Json;  ///< to `describe`
  isSerial: boolean;
  isArm: boolean;        ///< an elastic arm: its tendons are pulled, it bears loads, and its tip is what is placed
  hasArmLegs: boolean;   ///< of these: a platform on several, which is what is placed and loaded
  isPlanar: boolean;
  isHeldByFew: boolean;  ///< three actuators hold three coordinates of a platform in space, not its pose
  canBend: boolean;      ///< whether the sign of each leg's curvature chooses among solutions
  hasGravity: boolean;
  models: string[];
  inputs: Row[];
  pose: Row[];
  load: Row[];
  holding: Holding | null;  ///< of an arm: what holds each tendon, of which the inputs are
}

/** Whether links of this model yield to a load. */
export const bearsLoad = ({isArm}: {isArm: boolean}, model: string) => isArm || model === 'rod' || model === 'prb';

/** The same with other inputs: tensions or length changes of an arm's tendons. */
export function holding(described: Described, held: Held[] | null): Described {
  const {holding: known} = described;
  if (!known || !held || held.length !== known.held.length) return described;
  return {...described, holding: {...known, held}, inputs: held.map((one, i) => known.rows[one][i]!)};
}

export const none = {low: false, high: false};
const both = {low: true, high: true};

/** Where nothing limits an input the slider covers this part of its home value to both sides. */
const share = 0.2;

const symbols: Record<string, string> = {
  tendon_1: 'ℓ', slide: 's', length: 'L', theta: 'θ', beta_1: 'β₁', beta_2: 'β₂', phi: 'φ', extension: 'Δ',
};

const digits = '₀₁₂₃₄₅₆₇₈₉';
export const subscript = (number: number) => [...String(number)].map((digit) => digits[Number(digit)]).join('');

/** `ℓ₁` of `legs[0].tendon_1`, `S1 β₁` of `sections[0].beta_1`; people count from one. */
function shortName(path: string, ordinal: number): string {
  const [owner = '', field = ''] = path.split('.'), symbol = symbols[field] ?? field;
  if (!owner.startsWith('sections')) return symbol + subscript(ordinal);
  return `S${indexOf(path) + 1} ${symbol}`;
}

/** The number in the first brackets of a path. */
export const indexOf = (path: string) => Number(/\[(\d+)\]/.exec(path)?.[1] ?? 0);

function named(entries: Json[]): {name: string; path: string; unit: Unit}[] {
  const counts = new Map<string, number>();
  return entries.map((entry) => {
    const field = String(entry.name).split('.')[1] ?? '';
    counts.set(field, (counts.get(field) ?? 0) + 1);
    return {name: shortName(entry.name, counts.get(field)!), path: entry.name, unit: entry.unit};
  });
}

function serialInputs(answer: Json): Row[] {
  return named(answer.configuration).map((row, i) => {
    const limit: number = answer.sections[indexOf(row.path)]?.limit ?? Math.PI, field = row.path.split('.')[1];
    if (field === 'phi') return {...row, low: -Math.PI, high: Math.PI, home: 0, limits: none};
    if (field === 'theta') return {...row, low: 0, high: limit, home: 0, limits: {low: false, high: true}};
    if (row.unit === 'rad') return {...row, low: -limit, high: limit, home: 0, limits: both};
    const [low, high] = answer.configuration[i].limits ?? [0, 1];
    return {...row, low, high, home: low, limits: both};
  });
}

function parallelInputs(answer: Json, home: number[]): Row[] {
  return named(answer.inputs).map((row, i) => {
    const limits: number[] | undefined = answer.inputs[i].limits;
    const value = home[i] ?? (limits ? (limits[0]! + limits[1]!) / 2 : 0);
    const reach = Math.max(Math.abs(value) * share, row.unit === 'rad' ? 0.5 : 0.01);
    return {...row, low: limits?.[0] ?? value - reach, high: limits?.[1] ?? value + reach, home: value, limits: limits ? both : none};
  });
}

export const free = (name: string, unit: Unit, home: number, reach: number): Row =>
  ({name, path: name, unit, low: home - reach, high: home + reach, home, limits: none});

function poseRows(answer: Json, isHeldByFew: boolean): Row[] {
  if (answer.kind === 'serial') {
    const length: number = answer.length;
    return [free('x', 'm', 0, length), free('y', 'm', 0, length), {...free('z', 'm', length, 0), low: 0}];
  }
  if (answer.space === 'planar') {
    const reach = answer.legs[0].link.length / 2 || 0.1, {x, y, phi} = answer.home;
    return [free('x', 'm', x, reach), free('y', 'm', y, reach), {...free('φ', 'rad', phi, 1), path: 'phi'}];
  }
  const [, , z] = answer.home.position, reach = 0.3 * z || 0.1;
  if (isHeldByFew) return [free('z', 'm', z, reach), {...free('e₁', '', 0, 0.5), path: 'e1'}, {...free('e₂', '', 0, 0.5), path: 'e2'}];
  return platformRows(answer);
}

/** Of a platform that is free to be anywhere. */
export function platformRows({home, length}: Json): Row[] {
  if (home.position === undefined) return [free('x', 'm', home.x, 0.3 * length), free('y', 'm', home.y, 0.3 * length), free('phi', 'rad', home.phi, 1)];
  const [x, y, z] = home.position, reach = 0.3 * z || 0.1;
  return [free('x', 'm', x, reach), free('y', 'm', y, reach), free('z', 'm', z, reach), {...free('tilt', 'rad', 0, 0), high: 1},
          free('azimuth', 'rad', 0, Math.PI), free('torsion', 'rad', 0, 1)];
}

/** Sliders reach as far as links of usual size bear; a number box takes any load. */
function loadRows(answer: Json): Row[] {
  if (!answer.models.some((model: string) => bearsLoad({isArm: false}, model))) return [];
  const isRod = answer.model === 'rod', force = isRod ? 5 : 0.05, moment = isRod ? 0.5 : 0.005;
  if (answer.space === 'planar') return [free('Fx', 'N', 0, force), free('Fy', 'N', 0, force), free('M', 'N m', 0, moment)];
  return [free('Fx', 'N', 0, force), free('Fy', 'N', 0, force), free('Fz', 'N', 0, (isRod ? 4 : 1) * force),
          free('Mx', 'N m', 0, moment), free('My', 'N m', 0, moment), free('Mz', 'N m', 0, moment)];
}

const homeOf = (answer: Json, isHeldByFew: boolean): Json =>
  isHeldByFew ? {independent: {z: answer.home.position[2], e1: 0, e2: 0}} : {pose: answer.home};

export async function describe(robot: Robot): Promise<Described> {
  const [answer] = await robot.ask([{query: 'describe'}]) as [Json];
  if (answer.kind === 'arm') return armDescribed(robot, answer);
  if (answer.kind === 'arm_legs') return armLegsDescribed(answer);
  const isSerial = answer.kind === 'serial', isPlanar = answer.space === 'planar';
  const isHeldByFew = !isSerial && !isPlanar && answer.freedoms.actuators < answer.freedoms.platform;
  const [home] = isSerial ? [] : await robot.ask([{query: 'inverse', ...homeOf(answer, isHeldByFew)}]);
  return {
    answer, isSerial, isArm: false, hasArmLegs: false, isPlanar, isHeldByFew, models: answer.models, holding: null,
    canBend: answer.model === 'cc',
    hasGravity: (answer.gravity ?? []).some((part: number) => part !== 0),
    inputs: isSerial ? serialInputs(answer) : parallelInputs(answer, home?.inputs ?? []),
    pose: poseRows(answer, isHeldByFew),
    load: isSerial ? [] : loadRows(answer),
  };
}
