// From a section's bends to pixels of its diagram and back, and the lines of that picture.
import type {Bend, Frontier} from './frame';
import type {Pixel} from './svg';

const room = 1.22;   // of the envelope that is shown
const tick = 7;      // pixels of a hatch line
const pitch = 12;    // pixels between them

/** A frontier as it is drawn: its points, and lines on the side that its tendon forbids. */
export interface Drawn { points: Pixel[]; hatch: string }

export class Plane {
  /** @param limit of the envelope [rad] */
  constructor(readonly side: number, readonly limit: number) {}

  get reach(): number {
    return room * this.limit;
  }

  /** Pixels of a radian. */
  get scale(): number {
    return this.side / 2 / this.reach;
  }

  at([x, y]: Bend): Pixel {
    return [this.side / 2 + x * this.scale, this.side / 2 - y * this.scale];
  }

  bend([x, y]: Pixel): Bend {
    return [(x - this.side / 2) / this.scale, (this.side / 2 - y) / this.scale];
  }

  holds([x, y]: Pixel, by = 0): boolean {
    return x >= by && y >= by && x <= this.side - by && y <= this.side - by;
  }

  /** @param slack of its tendon at `point`, which tells the free side of a curve */
  frontier(of: Frontier, point: Bend, slack: number): Drawn | null {
    return 'curve' in of ? this.curve(of.curve, point, slack) : this.line(of.normal, of.offset);
  }

  private line([a, b]: [number, number], offset: number): Drawn | null {
    const size = Math.hypot(a, b), [x, y] = [(a * offset) / size ** 2, (b * offset) / size ** 2], [u, v] = [-b / size, a / size], {reach} = this;
    let [low, high] = [-Infinity, Infinity];
    for (const [place, way] of [[x, u], [y, v]] as const) {
      if (Math.abs(way) < 1e-12 && Math.abs(place) > reach) return null;
      if (Math.abs(way) < 1e-12) continue;
      const [first, second] = [(-reach - place) / way, (reach - place) / way];
      [low, high] = [Math.max(low, Math.min(first, second)), Math.min(high, Math.max(first, second))];
    }
    if (low >= high) return null;
    const from = this.at([x + low * u, y + low * v]), to = this.at([x + high * u, y + high * v]);
    return {points: [from, to], hatch: hatched([from, to], () => [-a / size, b / size])};
  }

  private curve(curve: Bend[], point: Bend, slack: number): Drawn | null {
    const points = curve.map((one) => this.at(one)), [x, y] = this.at(point);
    if (!points.some((one) => this.holds(one))) return null;
    const gaps = points.map(([a, b]) => Math.hypot(a - x, b - y)), near = gaps.indexOf(Math.min(...gaps)), [from, to] = [points[Math.max(0, near - 1)]!, points[Math.min(points.length - 1, near + 1)]!];
    const left = (to[0] - from[0]) * (y - from[1]) - (to[1] - from[1]) * (x - from[0]);
    if (Math.abs(left) < 1e-6 || slack === 0) return {points, hatch: ''};  // the point is on it and tells no side
    const sign = Math.sign(left) * Math.sign(slack);
    return {points, hatch: hatched(points.filter((one) => this.holds(one, -pitch)), ([u, v]) => [sign * v, -sign * u])};
  }
}

/** @param side of a direction along the line: which way the hatch goes */
function hatched(points: Pixel[], side: (along: Pixel) => Pixel): string {
  let [left, path] = [pitch / 2, ''];
  for (let i = 0; i + 1 < points.length; ++i) {
    const [[ax, ay], [bx, by]] = [points[i]!, points[i + 1]!], length = Math.hypot(bx - ax, by - ay);
    if (length === 0) continue;
    const [u, v] = [(bx - ax) / length, (by - ay) / length], [p, q] = side([u, v]);
    for (; left <= length; left += pitch) path += `M${(ax + left * u).toFixed(1)} ${(ay + left * v).toFixed(1)}l${(tick * p).toFixed(1)} ${(tick * q).toFixed(1)}`;
    left -= length;
  }
  return path;
}

/** What all tendons that are too short forbid together: where they lack least lies in its middle. A tendon that has slack there allows its side. */
export function emptyTriangle(frontiers: Frontier[], slack: number[], reach: number): Bend[] {
  let shape: Bend[] = [[-reach, -reach], [reach, -reach], [reach, reach], [-reach, reach]];
  frontiers.forEach((one, i) => {
    if ('curve' in one) return;
    const sign = slack[i]! < 0 ? 1 : -1, [a, b] = one.normal;
    shape = cut(shape, ([x, y]) => sign * (one.offset - a * x - b * y));
  });
  return shape;
}

/** What of a polygon is where `inside` is not less than 0. */
function cut(shape: Bend[], inside: (point: Bend) => number): Bend[] {
  return shape.flatMap((point, i) => {
    const next = shape[(i + 1) % shape.length]!, [here, there] = [inside(point), inside(next)], kept: Bend[] = here >= 0 ? [point] : [];
    if (here >= 0 === there >= 0) return kept;
    const part = here / (here - there);
    return [...kept, [point[0] + part * (next[0] - point[0]), point[1] + part * (next[1] - point[1])]];
  });
}
