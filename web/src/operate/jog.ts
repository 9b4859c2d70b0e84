// Jogging: the target changes for as long as something pushes it, a pad on the screen or a stick of a gamepad. It moves nothing.
import type {Bend} from './frame';

export type JogFrame = 'section' | 'tip';

/** To the right and up, each from −1 to 1: in a section's diagram, or in the picture of a camera in the tip. */
export type Way = [right: number, up: number];

export interface Jogged {
  tilt(section: 'chosen' | 'last', by: Bend): void;
  steering(): number[][] | null;  ///< the server's, of the last section; null: not known, or there is none
  turn(): number;                 ///< of the camera in the tip: how far +β₂ is turned clockwise from up [deg]
}

const degree = Math.PI / 180;
const fastest = 10 * degree;  // rad/s
const step = 0.1 * degree;    // of a tap

export class Jog {
  private readonly pushes = new Map<string, {frame: JogFrame; way: Way}>();  // by who pushes
  private last = 0;

  constructor(private readonly jogged: Jogged) {}

  /** @param way null: it pushes no more */
  push(who: string, frame: JogFrame, way: Way | null): void {
    if (!way) return void this.pushes.delete(who);
    const isFirst = this.pushes.size === 0;
    this.pushes.set(who, {frame, way});
    if (!isFirst) return;
    this.last = performance.now();
    requestAnimationFrame((now) => this.go(now));
  }

  tap(frame: JogFrame, way: Way): void {
    this.by(frame, way, step);
  }

  private go(now: number): void {
    const seconds = Math.min(0.1, Math.max(0, (now - this.last) / 1000));
    this.last = now;
    for (const {frame, way} of this.pushes.values()) this.by(frame, way, fastest * seconds);
    if (this.pushes.size > 0) requestAnimationFrame((next) => this.go(next));
  }

  private by(frame: JogFrame, [right, up]: Way, angle: number): void {
    if (frame === 'section') return this.jogged.tilt('chosen', [angle * right, angle * up]);
    const matrix = this.jogged.steering(), [x, y] = inTip([right, up], this.jogged.turn() * degree);
    if (matrix) this.jogged.tilt('last', matrix.map(([a, b]) => angle * (a! * x + b! * y)) as Bend);
  }
}

/** From the picture to the tip's own x and y: its camera looks along z, so where +y is up, +x is to the left. */
export const inTip = ([right, up]: Way, turn: number): [number, number] =>
  [-right * Math.cos(turn) + up * Math.sin(turn), right * Math.sin(turn) + up * Math.cos(turn)];
