// How an arm bends and twists along its backbone, as a small plot.
import type {Json} from './client';
import type {Described} from './described';
import {make} from './make';
import {round} from './outline';
import {shapeOf} from './svg_pen';
import {format, shownValue, type System, unitName} from './units';

const [width, height] = [258, 92], [left, right, top, bottom] = [40, 6, 6, 18];  // [px], of the plot and beside it
const twisting = 1e-2;  // of the largest curvature: less is not drawn
const straight = 0.02;  // rad along the whole arm: of less the plot is as high

const textAt = (x: number, y: number, anchor: string, words: string): SVGElement => {
  const text = document.createElementNS('http://www.w3.org/2000/svg', 'text');
  for (const [key, value] of Object.entries({x, y, 'text-anchor': anchor, class: 'pf-word'})) text.setAttribute(key, String(value));
  text.textContent = words;
  return text;
};

/** @return null where the answer has no curvatures */
export function profile(answer: Json, described: Described, system: System): HTMLElement | null {
  const places: number[] | undefined = answer.places, curvatures: number[][] | undefined = answer.curvatures;
  if (!places || !curvatures) return null;
  const bends = curvatures.map(([x, y]) => Math.hypot(x!, y!)), twists = curvatures.map((one) => one[2]!), most = Math.max(...bends, ...twists.map(Math.abs));
  const hasTwist = twists.some((one) => Math.abs(one) > twisting * most), low = hasTwist ? Math.min(0, ...twists) : 0, high = Math.max(...bends, hasTwist ? Math.max(...twists) : 0, straight / described.answer.length);
  const x = (place: number) => left + ((width - left - right) * place) / described.answer.length, y = (value: number) => top + ((high - value) / (high - low)) * (height - top - bottom);
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg'), line = (kind: string, points: [number, number][]) =>
    svg.append(shapeOf('path', {class: `pf-${kind}`, d: `M${points.map(([a, b]) => `${a.toFixed(1)} ${b.toFixed(1)}`).join('L')}`}));
  const step = round((high - low) / 2), unit = unitName('1/m', system), length = unitName('m', system), whole = Number(shownValue(described.answer.length, 'm', system).toPrecision(4));
  for (let mark = Math.ceil(low / step - 1e-9) * step; mark <= high * (1 + 1e-9); mark += step) {
    line('grid', [[left, y(mark)], [width - right, y(mark)]]);
    svg.append(textAt(left - 4, Math.max(y(mark) + 4, 10), 'end', String(Number(shownValue(mark, '1/m', system).toPrecision(3)))));
  }
  let end = 0;
  for (const section of (described.answer.sections as Json[]).slice(0, -1)) line('end', [[x(end += section.length), top], [x(end), height - bottom]]);
  if (hasTwist) line('twist', places.map((place, i) => [x(place), y(twists[i]!)]));
  line('bend', places.map((place, i) => [x(place), y(bends[i]!)]));
  svg.append(textAt(left, height - 5, 'start', '0'), textAt(width - right, height - 5, 'end', `${whole} ${length}`));
  svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
  svg.setAttribute('role', 'img');
  svg.setAttribute('aria-label', `curvature from ${format(Math.min(...bends), '1/m', system)} to ${format(Math.max(...bends), '1/m', system)} ${unit} along the backbone`);
  const key = make('p', {className: 'pf-key'}, make('span', {className: 'bend', textContent: 'bending'}), ...(hasTwist ? [make('span', {className: 'twist', textContent: 'twist'})] : []));
  return make('div', {className: 'numbers profile'}, make('h3', {textContent: `Curvature along the arm [${unit}]`}), svg, ...(hasTwist ? [key] : []));
}
