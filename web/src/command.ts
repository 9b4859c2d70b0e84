// The command that gives the numbers of the page.
import {bearsLoad, type Described} from './described';
import {bySection} from './questions';
import type {State} from './state';

const short = (value: number) => String(Number(value.toPrecision(12)));
const list = (values: number[]) => `"${values.map(short).join(', ')}"`;

function asked(described: Described, state: State, bending: number[] | null): string {
  if (described.isSerial && state.asked === 'inputs') {
    const sections = bySection(described, state.inputs);
    return `--configuration "${sections.map((pair) => pair.map(short).join(', ')).join('; ')}"`;
  }
  if (state.asked === 'inputs') return `--inputs ${list(state.inputs)}`;
  if (described.isSerial) return `--position ${list(state.pose)}`;
  const signs = bending ? ` --bending "${bending.map((sign) => (sign < 0 ? '-' : '+')).join(',')}"` : '';
  return `--${described.isHeldByFew ? 'independent' : 'pose'} ${list(state.pose)}${signs}`;
}

/**
 * @param robot a name or a file
 * @param start where the search has to begin so that it ends at this solution, as `--start` has it; else null
 * @param quaternion the orientation of a pose that is asked, which the command takes in place of its tilt
 */
export function command(robot: string, described: Described, state: State, start: number[] | null, quaternion: number[] | null): string {
  const isPose = state.asked === 'pose' && !described.isSerial && !described.isPlanar && !described.isHeldByFew;
  const told = isPose && quaternion ? {...state, pose: [...state.pose.slice(0, 3), ...quaternion]} : state;
  const words = ['sinew', state.asked === 'pose' ? 'inverse' : 'forward', /^[\w./-]+$/.test(robot) ? robot : `'${robot}'`,
                 asked(described, told, described.canBend ? state.bending : null)];
  if (start) words.push(`--start ${list(start)}`);
  if (state.model !== described.answer.model) words.push(`--model ${state.model}`);
  if (bearsLoad(state.model) && state.load.some((part) => part !== 0)) words.push(`--wrench ${list(state.load)}`);
  if (described.hasGravity && !state.gravity) words.push('--gravity "0, 0, 0"');
  if (state.iterations > 0) words.push(`--max-iterations ${state.iterations}`);
  if (state.model === 'prb' && state.joints > 0)
    described.answer.legs.forEach((_: unknown, i: number) => words.push(`--set "legs[${i}].link.joints=${state.joints}"`));
  return words.join(' ');
}
