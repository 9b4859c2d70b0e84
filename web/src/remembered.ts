// Friction of an arm's tendons as the operator moves it: the way from where it was switched on is kept point by point, and asked as one path.
import {heldBy, loads} from './arm';
import type {Json} from './client';
import type {Described} from './described';
import {make} from './make';
import {round} from './outline';
import type {State} from './state';
import {shapeOf} from './svg_pen';
import {format, shownValue, type System, type Unit, unitName} from './units';

/** Where a path turns, as `track` takes its points; the last one is where the arm is. */
export type Path = Json[];

/** So many are solved anew at every move. */
export const most = 40;
export const steps = 4;  // to each point: a loop that is seen, and still quick

export const rubs = ({isArm, answer}: Described): boolean => isArm && answer.kind === 'arm' && answer.tendons.some((tendon: Json) => tendon.friction > 0);

/** What holds the arm now, as a point of its path. All loads are told, also those that are none: a point says nothing of what stays. */
export function here(described: Described, state: State): Json {
  return {wrench: [0, 0, 0, 0, 0, 0], loads: [], ...heldBy(described, state.inputs), ...loads(described, state)};
}

const numbersOf = (value: unknown): number[] => (typeof value === 'number' ? [value] : Array.isArray(value) ? value.flatMap(numbersOf) : value && typeof value === 'object' ? Object.values(value).flatMap(numbersOf) : []);

/** Whether from a over b to c it goes straight on: then b is no turn, and the way is the same without it. */
function isStraight(a: Json, b: Json, c: Json): boolean {
  const bare = ([a, b, c] as Json[]).map((one) => JSON.stringify(one, (_, value) => (typeof value === 'number' ? 0 : value)));
  if (bare[0] !== bare[1] || bare[1] !== bare[2]) return false;  // something else holds it
  const [from, over, to] = [a, b, c].map(numbersOf) as [number[], number[], number[]], first = over.map((value, i) => value - from[i]!), second = to.map((value, i) => value - over[i]!);
  const dot = (p: number[], q: number[]) => p.reduce((sum, value, i) => sum + value * q[i]!, 0), [ff, ss, fs] = [dot(first, first), dot(second, second), dot(first, second)];
  return fs >= 0 && fs * fs >= (1 - 1e-18) * ff * ss;
}

/** The path with what is asked now at its end. */
export function walked(path: Path, point: Json): Path {
  const [before, last] = path.slice(-2) as [Json, Json];
  if (JSON.stringify(path.at(-1)) === JSON.stringify(point)) return path;
  return path.length > 1 && isStraight(before, last, point) ? [...path.slice(0, -1), point] : [...path, point];
}

/** The question of a path. */
export const trackOf = (path: Path): Json => ({query: 'track', points: path, steps});

const [width, height] = [258, 110], [left, right, top, bottom] = [44, 8, 8, 20];  // [px]

const textAt = (x: number, y: number, anchor: string, words: string): SVGElement => {
  const text = document.createElementNS('http://www.w3.org/2000/svg', 'text');
  for (const [key, value] of Object.entries({x, y, 'text-anchor': anchor, class: 'pf-word'})) text.setAttribute(key, String(value));
  text.textContent = words;
  return text;
};

/**
 * How far the tip is from where the straight arm has it, over one input, along the path: where tendons rub a loop.
 * @return null where the answer is no path
 */
export function loop(answer: Json, described: Described, state: State, index: number, system: System): HTMLElement | null {
  const rows: Json[] | undefined = answer.rows, row = described.inputs[index], held = described.holding?.held[index];
  if (!rows || !row || !held || answer.query !== 'track') return null;
  const straight = [0, 0, described.answer.length], points = rows.map((one): [number, number] => [
    (held === 'tension' ? one.tensions : one.changes).flat()[index], Math.hypot(...(one.tip.position as number[]).map((part, i) => part - straight[i]!))]);
  const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)], [x0, x1] = [Math.min(0, ...xs), Math.max(0, ...xs)], y1 = Math.max(...ys, described.answer.length / 100);
  const x = (value: number) => left + ((width - left - right) * (value - x0)) / (x1 - x0 || 1), y = (value: number) => height - bottom - (value / y1) * (height - top - bottom);
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg'), line = (kind: string, of: [number, number][]) =>
    svg.append(shapeOf('path', {class: `pf-${kind}`, d: `M${of.map(([a, b]) => `${a.toFixed(1)} ${b.toFixed(1)}`).join('L')}`}));
  const step = round(y1 / 2), number = (value: number, unit: Unit) => String(Number(shownValue(value, unit, system).toPrecision(3)));
  for (let mark = 0; mark <= y1 * (1 + 1e-9); mark += step) {
    line('grid', [[left, y(mark)], [width - right, y(mark)]]);
    svg.append(textAt(left - 4, Math.max(y(mark) + 4, 10), 'end', number(mark, 'm')));
  }
  line('bend', points.map(([a, b]) => [x(a), y(b)]));
  const [a, b] = points.at(-1)!;
  svg.append(shapeOf('circle', {class: 'pf-here', cx: x(a).toFixed(1), cy: y(b).toFixed(1), r: '3'}));
  svg.append(textAt(left, height - 5, 'start', number(x0, row.unit)), textAt(width - right, height - 5, 'end', `${number(x1, row.unit)} ${unitName(row.unit, system)}`));
  svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
  svg.setAttribute('role', 'img');
  const moves = state.path?.length ?? 0;
  svg.setAttribute('aria-label', `the tip is ${format(b, 'm', system)} ${unitName('m', system)} from straight at ${row.name} = ${format(a, row.unit, system)} ${unitName(row.unit, system)}, after ${moves} ${moves === 1 ? 'move' : 'moves'}`);
  return make('div', {className: 'numbers profile loop'}, make('h3', {textContent: `Tip from straight [${unitName('m', system)}] over ${row.name}, along the path`}), svg);
}
