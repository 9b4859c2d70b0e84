// The command that gives the numbers of the page, for a shell.
import {heldBy, loads, tipField} from './arm';
import type {Json} from './client';
import type {Described} from './described';
import {bySection, everything, forward, wrenchOf} from './questions';
import type {Source} from './source';
import type {State} from './state';

const short = (value: number) => String(Number(value.toPrecision(12)));
const quoted = (word: string) => (/["$`\\!']/.test(word) ? `'${word.replaceAll("'", "'\\''")}'` : `"${word}"`);
const list = (values: number[]) => `"${values.map(short).join(', ')}"`;

/** A list a section, as the command has it. */
const lists = (values: (number | null)[][]) => `"${values.map((of) => of.map((value) => (value === null ? 'null' : short(value))).join(', ')).join('; ')}"`;

function askedOfArm(described: Described, state: State): string {
  const fields: Json = state.asked === 'inputs' ? heldBy(described, state.inputs) : described.hasArmLegs ? {pose: state.pose} : tipField(described, state.pose);
  return Object.entries(fields).map(([name, values]) => `--${name} ${Array.isArray(values[0]) ? lists(values) : list(values)}`).join(' ');
}

function asked(described: Described, state: State, bending: number[] | null): string {
  if (described.isArm) return askedOfArm(described, state);
  if (described.isSerial && state.asked === 'inputs') {
    const sections = bySection(described, state.inputs);
    return `--configuration "${sections.map((pair) => pair.map(short).join(', ')).join('; ')}"`;
  }
  if (state.asked === 'inputs') return `--inputs ${list(state.inputs)}`;
  if (described.isSerial) return `--position ${list(state.pose)}`;
  const signs = bending ? ` --bending "${bending.map((sign) => (sign < 0 ? '-' : '+')).join(',')}"` : '';
  return `--${described.isHeldByFew ? 'independent' : 'pose'} ${list(state.pose)}${signs}`;
}

/** Rz(azimuth) Ry(tilt) Rz(torsion − azimuth), as the command takes an orientation. */
function quaternionOf([tilt = 0, azimuth = 0, torsion = 0]: number[]): number[] {
  const [c, s] = [Math.cos(tilt / 2), Math.sin(tilt / 2)], half = azimuth - torsion / 2;
  return [c * Math.cos(torsion / 2), -s * Math.sin(half), s * Math.cos(half), c * Math.sin(torsion / 2)];
}

/** A path, and the start of a platform on arms, are of the protocol: the command takes the question in one line. */
function commandOfQuestion(source: Source, asked: Json): string {
  const set = Object.fromEntries(source.sets.map((one) => [one.slice(0, one.indexOf('=')), one.slice(one.indexOf('=') + 1)]));
  const question = {...asked, ...(source.sets.length > 0 && {set})};
  return `echo '${JSON.stringify(question).replaceAll("'", "'\\''")}' | sinew query ${/^[\w./-]+$/.test(source.word) ? source.word : quoted(source.word)}`;
}

/** @param start where the search has to begin so that it ends at this solution, as `--start` has it; else null */
export function command(source: Source, described: Described, state: State, start: number[] | null): string {
  if (state.path && state.asked === 'inputs') return commandOfQuestion(source, everything(described, state));
  if (start && described.hasArmLegs) return commandOfQuestion(source, forward(described, state, state.start!));
  const isPose = state.asked === 'pose' && !described.isSerial && (!described.isArm || described.hasArmLegs) && !described.isPlanar && !described.isHeldByFew, robot = source.word;
  const told = isPose ? {...state, pose: [...state.pose.slice(0, 3), ...quaternionOf(state.pose.slice(3))]} : state;
  const words = ['sinew', state.asked === 'pose' ? 'inverse' : 'forward', /^[\w./-]+$/.test(robot) ? robot : quoted(robot),
                 asked(described, told, described.canBend ? state.bending : null)];
  if (start) words.push(`--start ${described.isArm ? lists(Array.from({length: start.length / 3}, (_, k) => start.slice(3 * k, 3 * k + 3))) : list(start)}`);
  if (state.model !== described.answer.model) words.push(`--model ${state.model}`);
  const wrench = wrenchOf(described, state), {loads: more, distributed} = described.isArm ? loads(described, state) : {} as Json;
  if (wrench) words.push(`--wrench ${list(wrench)}`);
  if (distributed) words.push(`--distributed ${list(distributed)}`);
  if (more) words.push(`--loads '${JSON.stringify(more)}'`);
  if (described.hasGravity && !state.gravity) words.push('--gravity "0, 0, 0"');
  if (state.iterations > 0) words.push(`--max-iterations ${state.iterations}`);
  for (const set of source.sets) words.push(`--set ${quoted(set)}`);
  if (described.isArm && state.model === 'prb' && state.joints > 0) words.push(`--elements ${state.joints}`);
  else if (state.model === 'prb' && state.joints > 0)
    described.answer.legs.forEach((_: unknown, i: number) => words.push(`--set "legs[${i}].link.joints=${state.joints}"`));
  return words.join(' ');
}
