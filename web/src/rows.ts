// What the sliders of a robot are: its inputs, or of a serial robot its bends, with range and home.
import type {Json, Robot} from './client';
import type {Unit} from './units';

export interface Row { name: string; unit: Unit; low: number; high: number; home: number }

export interface Described {
  answer: Json;
  isSerial: boolean;
  isPlanar: boolean;
  rows: Row[];
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

/** The home pose in the words of an inverse query: three rods hold three independent coordinates, not a pose. */
function atHome(answer: Json): Json {
  const {home, freedoms} = answer;
  const isHeldByFew = answer.model === 'rod' && freedoms.actuators < freedoms.platform;
  return isHeldByFew ? {independent: {z: home.position[2], e1: 0, e2: 0}} : {pose: home};
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
  if (isSerial) return {answer, isSerial, isPlanar, rows: serialRows(answer)};
  const home = (await robot.ask([{query: 'inverse', ...atHome(answer)}]))[0]!;
  return {answer, isSerial, isPlanar, rows: parallelRows(answer, home.inputs ?? [])};
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
