// The pointer on a picture: names what it rests on, keeps a name that is clicked, and drags the platform.
import type {Json} from './client';
import type {Labels} from './labels';
import {isOnPlatform, partAt} from './pick';
import type {Part} from './picture';

const patience = 150;  // ms on a part until it is named

export interface Pointed {
  shape(): Json | null;
  project(point: number[]): [number, number];
  shift(right: number, down: number): number[];  ///< in metres, of a way in pixels in the plane of the screen
  label(part: Part): string;
  grabbed(position: number[], isEnd: boolean): void;
  hold(is: boolean): void;  ///< the camera stands still
}

/** Where the platform's reference point, or the tip, is. */
export const placeOf = (shape: Json): number[] | null => {
  const frame = shape.frames?.at(-1);
  return frame ? frame.position ?? [frame.x, frame.y, 0] : null;
};

export class Pointer {
  private timer = 0;
  private isPinned = false;
  private from: {x: number; y: number; place: number[]} | null = null;
  private next: number[] | null = null;

  constructor(private readonly box: HTMLElement, private readonly labels: Labels, private readonly picture: Pointed) {
    box.addEventListener('pointerdown', (event) => this.down(event), {capture: true});
    box.addEventListener('pointermove', (event) => this.move(event));
    box.addEventListener('pointerup', (event) => this.up(event));
    box.addEventListener('pointerleave', () => this.isPinned || this.unpin());
    box.addEventListener('click', (event) => this.name(event, true));
    box.addEventListener('keydown', (event) => event.key === 'Escape' && this.unpin());
  }

  unpin(): void {
    this.isPinned = false;
    clearTimeout(this.timer);
    this.labels.point('', 0, 0, false);
  }

  private at(event: MouseEvent): [number, number] {
    const {left, top} = this.box.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  }

  private name(event: MouseEvent, isClick: boolean): void {
    const shape = this.picture.shape(), [x, y] = this.at(event), part = shape && partAt(x, y, shape, (point) => this.picture.project(point));
    if (isClick) this.isPinned = !!part && !this.isPinned;
    this.labels.point(part && (this.isPinned || !isClick) ? this.picture.label(part) : '', x, y, this.isPinned);
  }

  private down(event: PointerEvent): void {
    const shape = this.picture.shape(), place = shape && placeOf(shape), [x, y] = this.at(event);
    if (!place || event.button !== 0 || !isOnPlatform(x, y, shape, place, (point) => this.picture.project(point))) return;
    this.from = {x, y, place};
    this.picture.hold(true);
    this.box.setPointerCapture(event.pointerId);
  }

  private move(event: PointerEvent): void {
    const [x, y] = this.at(event), shape = this.picture.shape();
    if (this.from) {
      const way = this.picture.shift(x - this.from.x, y - this.from.y), isFirst = !this.next;
      this.next = this.from.place.map((part, i) => part + (way[i] ?? 0));
      if (isFirst) requestAnimationFrame(() => this.tell());
      return;
    }
    const isHand = !!shape && isOnPlatform(x, y, shape, placeOf(shape), (point) => this.picture.project(point));
    this.box.style.cursor = isHand ? 'grab' : '';
    if (this.isPinned || event.buttons !== 0) return;
    clearTimeout(this.timer);
    this.labels.point('', 0, 0, false);
    this.timer = window.setTimeout(() => this.name(event, false), patience);
  }

  private tell(): void {
    if (this.next) this.picture.grabbed(this.next, false);
    this.next = null;
  }

  private up(event: PointerEvent): void {
    if (!this.from) return;
    const [x, y] = this.at(event), way = this.picture.shift(x - this.from.x, y - this.from.y), isMoved = Math.hypot(x - this.from.x, y - this.from.y) > 2;
    if (isMoved) this.picture.grabbed(this.from.place.map((part, i) => part + (way[i] ?? 0)), true);
    this.from = this.next = null;
    this.picture.hold(false);
  }
}
