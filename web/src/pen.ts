// What draws a picture: lines of so many pixels, rods of so many metres, surfaces, dots, discs.
import type {Json} from './client';
import type {Point} from './vector';

export interface Look {
  colour: string;      ///< #RRGGBB
  width?: number;      ///< [px], of rods at least
  diameter?: number;   ///< [m], of rods, which are round
  dash?: number[];     ///< on, off, on, off [px]
  opacity?: number;
  isAbove?: boolean;   ///< seen through all that is in front
}

/** Between `begin` and `end` all of a picture is drawn anew. What is drawn later lies above where depth does not tell. */
export interface Pen {
  /** @param pixels of a metre */
  begin(isPlanar: boolean, pixels: number): void;
  line(points: Point[], look: Look, isClosed?: boolean): void;
  /** @param turn as much of the circle [rad] */
  circle(middle: Point, u: Point, v: Point, radius: number, look: Look, turn?: number): void;
  /** Wide at its beginning, pointed at its end. */
  head(from: Point, to: Point, look: Look): void;
  dot(point: Point, look: Look): void;
  /** The inside of an outline that bends nowhere inwards. */
  fill(points: Point[], look: Look): void;
  /** Of an answer to `shape`: the pose of its lower face, height and radius. @param hidden colour of what solids hide of it; none: it is hidden */
  disc(disc: Json, body: string, rim: string, hidden?: string): void;
  end(): void;
}

const parts = (colour: string) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));

/** A colour on the way from one to another. */
export const between = (from: string, to: string, part: number) => {
  const other = parts(to);
  return `#${parts(from).map((value, k) => Math.round(value + part * (other[k]! - value)).toString(16).padStart(2, '0')).join('')}`;
};

const known = new Map<string, number[]>();

/** Red, green and blue from 0 to 1. */
export function rgb(colour: string): number[] {
  let found = known.get(colour);
  if (!found) known.set(colour, found = parts(colour).map((value) => (Number.isFinite(value) ? value / 255 : 0.5)));
  return found;
}
