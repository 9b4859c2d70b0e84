// Curves of a report: SVG that needs neither script nor page.
import {svg} from './svg';

export interface Line { name: string; values: ArrayLike<number>; looks: string }

const width = 720, height = 132, left = 52, right = 10, top = 8, bottom = 20;
const points = 600;  // of a line; of more the least and the largest of each stretch

/** Round numbers between two, about so many. */
function ticks(low: number, high: number, about: number): number[] {
  const raw = (high - low) / about, power = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 5, 10].map((one) => one * power).find((one) => one >= raw)!;
  return Array.from({length: Math.floor(high / step) - Math.ceil(low / step) + 1}, (_, i) => Number(((Math.ceil(low / step) + i) * step).toPrecision(12)));
}

/** Where there is nothing, and at gaps, the line is broken. */
function path(times: ArrayLike<number>, values: ArrayLike<number>, gaps: ReadonlySet<number>, x: (time: number) => number, y: (value: number) => number): string {
  const size = Math.max(1, Math.ceil((2 * times.length) / points));
  let [text, isDown] = ['', false];
  const to = (i: number) => {
    const value = values[i]!;
    if (!Number.isFinite(value)) return void (isDown = false);
    text += `${isDown ? 'L' : 'M'}${x(times[i]!).toFixed(1)} ${y(value).toFixed(1)}`;
    isDown = true;
  };
  for (let from = 0, end = 0; from < times.length; from = end) {
    if (gaps.has(from)) isDown = false;
    let [least, most] = [from, from];
    for (end = from; end < Math.min(times.length, from + size) && (end === from || !gaps.has(end)); ++end) {
      if (!(values[end]! >= values[least]!)) least = end;
      if (!(values[end]! <= values[most]!)) most = end;
    }
    to(Math.min(least, most));
    if (least !== most) to(Math.max(least, most));
  }
  return text;
}

/** @param gaps rows before which measurements are missing @param bands stretches of time with a look @returns null where no line has a value */
export function chart(title: string, times: ArrayLike<number>, gaps: ReadonlySet<number>, lines: Line[], duration: number, bands: {from: number; to: number; looks: string}[]): SVGSVGElement | null {
  const all = lines.flatMap(({values}) => Array.from(values).filter(Number.isFinite));
  if (all.length === 0) return null;
  let [low, high] = all.reduce(([a, b], value) => [Math.min(a, value), Math.max(b, value)], [0, 0]);
  if (high - low < 1e-9) [low, high] = [low - 1, high + 1];
  const room = 0.06 * (high - low), end = Math.max(duration, 1e-3);
  [low, high] = [low - room, high + room];
  const x = (time: number) => left + ((width - left - right) * time) / end, y = (value: number) => height - bottom - ((height - top - bottom) * (value - low)) / (high - low);
  const grid = ticks(low, high, 4).flatMap((value) => [svg('line', {class: 'grid', x1: left, x2: width - right, y1: y(value), y2: y(value)}), svg('text', {class: 'tick', x: left - 5, y: y(value) + 4, 'text-anchor': 'end'}, String(value))]);
  const foot = ticks(0, end, 8).map((time) => svg('text', {class: 'tick', x: x(time), y: height - 5, 'text-anchor': 'middle'}, `${time} s`));
  const shade = bands.map(({from, to, looks}) => svg('rect', {class: `band ${looks}`, x: x(from), width: Math.max(1, x(to) - x(from)), y: top, height: height - top - bottom}));
  return svg('svg', {class: 'chart', viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': title}, ...shade, ...grid, ...foot,
             ...lines.map(({values, looks}) => svg('path', {class: `curve ${looks}`, d: path(times, values, gaps, x, y)})), svg('rect', {class: 'box', x: left, y: top, width: width - left - right, height: height - top - bottom}));
}
