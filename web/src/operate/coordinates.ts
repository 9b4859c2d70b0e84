// A section's bend as its diagram has it, and as queries have it. Neutral backbones are asked by size and direction.
import type {Described} from '../described';
import {bySection} from '../questions';
import type {Bend} from './frame';

export const isPolar = (section: {type: string}): boolean => section.type !== 'tpcj';

/** @param inputs the robot's rows: a bend a section, of some an extension, too */
export function bendsOf(described: Described, inputs: number[]): Bend[] {
  return bySection(described, inputs).map(([a = 0, b = 0], i) => (isPolar(described.answer.sections[i]) ? [a * Math.cos(b), a * Math.sin(b)] : [a, b]));
}

/** @param before the rows so far: a straight section keeps its direction, and an extension stays as it is */
export function inputsOf(described: Described, bends: Bend[], before: number[]): number[] {
  return bySection(described, before).flatMap(([a = 0, b = 0, ...more], i) => {
    const [x, y] = bends[i] ?? [a, b];
    if (!isPolar(described.answer.sections[i])) return [x, y, ...more];
    const size = Math.hypot(x, y);
    return [size, size > 0 ? Math.atan2(y, x) : b, ...more];
  });
}

/** The largest bend of a section; of one that has none half a turn. */
export const limitOf = (section: {limit?: number}): number => section.limit ?? Math.PI;

/** What an envelope holds, nearest to a bend. */
export function clamped([x, y]: Bend, limit: number, isDisc: boolean): Bend {
  const size = Math.hypot(x, y), within = (value: number) => Math.min(limit, Math.max(-limit, value));
  if (!isDisc) return [within(x), within(y)];
  return size > limit ? [(x * limit) / size, (y * limit) / size] : [x, y];
}
