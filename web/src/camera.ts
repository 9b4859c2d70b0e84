// Where a picture is seen from: round a point, parallel lines staying parallel or not, as a short text and back.
// It knows neither WebGL nor SVG, so both see the same.
import type {View} from './picture';
import {dot, length, minus, type Point} from './vector';

const degree = Math.PI / 180;
const angles: Record<Exclude<View, 'tip'>, [number, number]> = {side: [-90, 0], top: [-90, 90], front: [0, 0]};  // azimuth, elevation [deg]
const usual: [number, number] = [-62, 20];
const lens = 30;       // height of a picture seen through a lens [deg]
const [nearest, farthest] = [1e-5, 1e4];  // widths in view [m]

export class Camera {
  isLens = false;
  isPlanar = false;
  from = usual; // where it is seen from, if no view says else
  margin = 62;  // pixels between what is fitted and the edges
  width = 1;   // of the box [px]
  height = 1;
  private azimuth = usual[0];
  private elevation = usual[1];
  private reach = 1;  // what the narrower side of the box shows, at the target [m]
  private target: Point = [0, 0, 0];
  right: Point = [1, 0, 0];
  up: Point = [0, 1, 0];
  back: Point = [0, 0, 1];  // from the target to the camera

  constructor() {
    this.aim();
  }

  /** Pixels of a metre, at the target. */
  get pixels(): number {
    return Math.min(this.width, this.height) / this.reach;
  }

  /** From the target to a lens [m]. */
  get away(): number {
    return this.height / this.pixels / (2 * Math.tan((lens / 2) * degree));
  }

  get at(): Point {
    return this.target;
  }

  /** Azimuth and elevation [deg], the narrower side of the picture [m], the target [m]. */
  get text(): string {
    return [this.azimuth, this.elevation, this.reach, ...this.target].map(String).join(',') + (this.isLens ? ',lens' : '');
  }

  /** @return whether the text is one */
  put(text: string): boolean {
    const parts = text.split(','), numbers = parts.slice(0, 6).map(Number), [azimuth, elevation, reach] = numbers as [number, number, number];
    if (parts.length < 6 || parts.some((part) => part === '') || !numbers.every(Number.isFinite) || reach < nearest || reach > farthest) return false;
    [this.azimuth, this.elevation, this.reach, this.target, this.isLens] = [azimuth, elevation, reach, numbers.slice(3), parts[6] === 'lens'];
    this.snap();
    return true;
  }

  resize(width: number, height: number): void {
    [this.width, this.height] = [Math.max(width, 1), Math.max(height, 1)];
  }

  /** All of the points in view, from where they are usually seen, or else. @param axis of the tip, which a view from there looks along */
  fit(points: Point[], view: View | undefined, axis: Point): void {
    const tip: [number, number] = [length([axis[0]!, axis[1]!]) > 1e-3 ? Math.atan2(axis[1]!, axis[0]!) / degree : -90, Math.asin(Math.min(1, Math.max(-1, axis[2]!))) / degree];
    [this.azimuth, this.elevation] = this.isPlanar ? angles.top : view === 'tip' ? tip : view ? angles[view] : this.from;
    this.aim();
    const middle = (way: Point) => {
      let [low, high] = [Infinity, -Infinity];
      for (const point of points) [low, high] = [Math.min(low, dot(point, way)), Math.max(high, dot(point, way))];
      return [(low + high) / 2, high - low] as const;
    };
    const [x, wide] = middle(this.right), [y, high] = middle(this.up), [z, deep] = middle(this.back);
    const {margin} = this, metres = Math.max(wide / Math.max(this.width - 2 * margin, this.width / 2), high / Math.max(this.height - 2 * margin, this.height / 2), 1e-9);
    this.target = [0, 1, 2].map((k) => x * this.right[k]! + y * this.up[k]! + z * this.back[k]!);
    this.reach = metres * Math.min(this.width, this.height);
    if (this.isLens) this.reach *= 1 + deep / 2 / this.away;
    this.snap();
  }

  /** By so many pixels of a pointer. */
  orbit(right: number, down: number): void {
    this.azimuth -= 0.5 * right;
    this.elevation = Math.min(90, Math.max(-90, this.elevation + 0.5 * down));
    this.aim();
  }

  pan(right: number, down: number): void {
    this.target = minus(this.target, this.shift(right, down));
  }

  /** About a point of the picture [px]. */
  zoom(by: number, x = this.width / 2, y = this.height / 2): void {
    const reach = Math.min(farthest, Math.max(nearest, this.reach / by)), part = 1 - reach / this.reach;
    this.pan(-part * (x - this.width / 2), -part * (y - this.height / 2));
    this.reach = reach;
  }

  toggle(): void {
    this.isLens = !this.isLens;
  }

  /** A way on the screen in metres, at the target's depth. */
  shift(right: number, down: number): Point {
    const unit = 1 / this.pixels;
    return [0, 1, 2].map((k) => unit * (right * this.right[k]! - down * this.up[k]!));
  }

  /** Pixels from the left and from the top. */
  project(point: Point): [number, number] {
    const from = minus(point, this.target), near = this.isLens ? this.away / Math.max(this.away - dot(from, this.back), 0.02 * this.away) : 1, unit = this.pixels * near;
    return [this.width / 2 + unit * dot(from, this.right), this.height / 2 - unit * dot(from, this.up)];
  }

  /** To what a link says, so that it shows the same to the pixel. */
  snap(): void {
    const digits = Math.min(12, Math.max(0, 5 - Math.floor(Math.log10(this.reach)))), turn = ((this.azimuth % 360) + 540) % 360 - 180;
    [this.azimuth, this.elevation, this.reach] = [Number(turn.toFixed(2)), Number(this.elevation.toFixed(2)), Number(this.reach.toPrecision(5))];
    this.target = this.target.map((part) => Number(part.toFixed(digits)) + 0);
    this.aim();
  }

  private aim(): void {
    const [a, e] = [this.azimuth * degree, this.elevation * degree], [c, s, ce, se] = [Math.cos(a), Math.sin(a), Math.cos(e), Math.sin(e)];
    this.right = [-s, c, 0];
    this.up = [-se * c, -se * s, ce];
    this.back = [ce * c, ce * s, se];
  }
}
