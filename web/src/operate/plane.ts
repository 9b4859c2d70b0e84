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

  frontier(of: Frontier): Drawn | null {
    return 'curve' in of ? this.curve(of.curve) : this.line(of.normal, of.offset);
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

  /** What its tendon forbids lies to the right of a curve; pixels count downwards. */
  private curve(curve: Bend[]): Drawn | null {
    const points = curve.map((one) => this.at(one));
    if (!points.some((one) => this.holds(one))) return null;
    return {points, hatch: hatched(points.filter((one) => this.holds(one, -pitch)), ([u, v]) => [-v, u])};
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
export function forbidden(frontiers: Frontier[], slack: number[], reach: number): Bend[] {
  let shape: Bend[] = [[-reach, -reach], [reach, -reach], [reach, reach], [-reach, reach]];
  frontiers.forEach((one, i) => {
    const sign = slack[i]! < 0 ? 1 : -1;
    for (const [[x, y], [u, v]] of 'curve' in one ? chords(one.curve) : [onLine(one.normal, one.offset)]) shape = cut(shape, ([a, b]) => sign * (v * (a - x) - u * (b - y)));
  });
  return shape;
}

/** A point and a direction of a line, which has what its tendon allows to the left. */
function onLine([a, b]: [number, number], offset: number): [Bend, Bend] {
  const size = a * a + b * b;
  return [[(a * offset) / size, (b * offset) / size], [b, -a]];
}

/** What a tendon forbids is convex: it lies to the right of each chord. */
const chords = (curve: Bend[]): [Bend, Bend][] => curve.slice(1).flatMap(([x, y], i): [Bend, Bend][] => {
  const [a, b] = curve[i]!;
  return x === a && y === b ? [] : [[[a, b], [x - a, y - b]]];
});

/** What of a polygon is where `inside` is not less than 0. */
function cut(shape: Bend[], inside: (point: Bend) => number): Bend[] {
  return shape.flatMap((point, i) => {
    const next = shape[(i + 1) % shape.length]!, [here, there] = [inside(point), inside(next)], kept: Bend[] = here >= 0 ? [point] : [];
    if (here >= 0 === there >= 0) return kept;
    const part = here / (here - there);
    return [...kept, [point[0] + part * (next[0] - point[0]), point[1] + part * (next[1] - point[1])]];
  });
}
