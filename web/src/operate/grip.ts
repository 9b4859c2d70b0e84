// How pointers and fingers take hold of a target in a diagram: one drags it, two turn it about the middle of a disc.
import {clamped} from './coordinates';
import type {Bend} from './frame';

const resistance = 0.25;  // of the way beyond the envelope that a pull is drawn
const pause = 120;        // ms that a finger waits for a second one, where two turn the target
const slip = 6;           // pixels that it moves in a pause

export interface Gripped {
  may(): boolean;                ///< whether a target may be set; if not it says why
  bend(event: PointerEvent): Bend;
  target(): Bend;
  limit(): number;
  isDisc(): boolean;
  aim(to: Bend, over: Bend | null): void;  ///< `over`: where it is pulled beyond the envelope
  letGo(): void;
}

export class Grip {
  private readonly down = new Map<number, PointerEvent>();
  private dragging = -1;                     // the pointer
  private waiting = 0;                       // for a second finger
  private twist: {angle: number; target: Bend} | null = null;  // as it began

  constructor(private readonly plot: HTMLElement, private readonly gripped: Gripped) {
    plot.addEventListener('pointerdown', (event) => this.press(event));
    plot.addEventListener('pointermove', (event) => this.move(event));
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture'] as const) plot.addEventListener(end, (event) => this.release(event));
    plot.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  private press(event: PointerEvent): void {
    if (event.button !== 0 || !this.gripped.may()) return;
    this.plot.setPointerCapture(event.pointerId);
    this.down.set(event.pointerId, event);
    if (this.down.size === 1) this.take(event);
    else if (this.down.size === 2 && this.gripped.isDisc()) this.beginTwist();
  }

  private take(event: PointerEvent): void {
    this.dragging = event.pointerId;
    if (event.pointerType === 'touch' && this.gripped.isDisc()) this.waiting = window.setTimeout(() => this.begin(), pause);
    else this.drag(event);
  }

  /** No second finger has come. */
  private begin(): void {
    const event = this.down.get(this.dragging);
    clearTimeout(this.waiting);
    this.waiting = 0;
    if (event) this.drag(event);
  }

  private move(event: PointerEvent): void {
    const from = this.down.get(event.pointerId);
    if (!from) return;
    if (this.waiting && Math.hypot(event.clientX - from.clientX, event.clientY - from.clientY) < slip) return;
    this.down.set(event.pointerId, event);
    if (this.twist) this.turn(this.twist);
    else if (event.pointerId === this.dragging) this.begin();
  }

  private drag(event: PointerEvent): void {
    const wanted = this.gripped.bend(event), to = clamped(wanted, this.gripped.limit(), this.gripped.isDisc()), isBeyond = Math.hypot(to[0] - wanted[0], to[1] - wanted[1]) > 1e-9;
    this.gripped.aim(to, isBeyond ? [to[0] + resistance * (wanted[0] - to[0]), to[1] + resistance * (wanted[1] - to[1])] : null);
  }

  private beginTwist(): void {
    clearTimeout(this.waiting);
    [this.waiting, this.dragging, this.twist] = [0, -1, {angle: this.angle, target: this.gripped.target()}];
  }

  /** Of the line from the first finger to the second, counted as φ is. */
  private get angle(): number {
    const [a, b] = [...this.down.values()] as [PointerEvent, PointerEvent];
    return Math.atan2(a.clientY - b.clientY, b.clientX - a.clientX);
  }

  private turn({angle, target: [x, y]}: {angle: number; target: Bend}): void {
    const by = this.angle - angle, [c, s] = [Math.cos(by), Math.sin(by)];
    this.gripped.aim([c * x - s * y, s * x + c * y], null);
  }

  /** After a twist the finger that is left drags nothing. */
  private release(event: PointerEvent): void {
    if (!this.down.has(event.pointerId)) return;
    if (this.waiting && event.pointerId === this.dragging && event.type === 'pointerup') this.begin();  // a tap
    clearTimeout(this.waiting);
    this.waiting = 0;
    this.down.delete(event.pointerId);
    if (event.pointerId === this.dragging) this.dragging = -1;
    if (this.down.size < 2) this.twist = null;
    this.gripped.letGo();
  }
}
