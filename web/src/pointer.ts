// Pointer, wheel and keys on a picture: they move the camera, or take hold of the platform.
import type {Camera} from './camera';
import {isOnPlatform, reference} from './pick';
import type {Names} from './names';
import type {Drawing} from './picture';
import {plus, type Point} from './vector';

const slip = 4;  // pixels a pointer moves in a click

export interface Hand {
  drawing(): Drawing | null;
  grabbed(position: Point, isEnd: boolean): void;
  looked(isEnd: boolean): void;  ///< the camera has moved
  fit(): void;
}

type Mode = 'orbit' | 'pan' | 'grab' | 'none';

export class Pointer {
  private readonly down = new Map<number, {x: number; y: number}>();
  private mode: Mode = 'none';
  private from = {x: 0, y: 0};
  private place: Point = [];
  private isClick = false;
  private isTold = true;  // where the platform is dragged to
  private wheeled = 0;

  constructor(private readonly box: HTMLElement, private readonly camera: Camera, private readonly names: Names, private readonly hand: Hand) {
    box.style.touchAction = box.style.userSelect = 'none';
    box.addEventListener('pointerdown', (event) => this.press(event));
    box.addEventListener('pointermove', (event) => this.move(event));
    for (const end of ['pointerup', 'pointercancel'] as const) box.addEventListener(end, (event) => this.release(event));
    box.addEventListener('pointerleave', () => this.names.leave());
    box.addEventListener('contextmenu', (event) => event.preventDefault());
    box.addEventListener('wheel', (event) => this.wheel(event), {passive: false});
    box.addEventListener('dblclick', () => hand.fit());
    box.addEventListener('keydown', (event) => this.key(event));
  }

  private at(event: MouseEvent): {x: number; y: number} {
    const {left, top} = this.box.getBoundingClientRect();
    return {x: event.clientX - left, y: event.clientY - top};
  }

  private isOnPlatform({x, y}: {x: number; y: number}): boolean {
    const drawing = this.hand.drawing();
    return !!drawing && drawing.canGrab !== false && isOnPlatform(x, y, drawing.shape, (point) => this.camera.project(point));
  }

  private press(event: PointerEvent): void {
    const at = this.at(event);
    this.box.setPointerCapture(event.pointerId);
    this.down.set(event.pointerId, at);
    if (this.down.size > 1) {  // fingers
      if (this.mode === 'grab') this.letGo(at);
      this.isClick = false;
      this.mode = 'none';
      return;
    }
    const isPan = event.button !== 0 || event.shiftKey || event.ctrlKey || this.camera.isPlanar, place = this.isOnPlatform(at) && reference(this.hand.drawing()!.shape);
    this.from = at;
    this.isClick = event.button === 0;
    this.mode = event.button === 0 && place ? 'grab' : isPan ? 'pan' : 'orbit';
    if (place && this.mode === 'grab') this.place = place;
    this.names.leave();
  }

  private move(event: PointerEvent): void {
    const at = this.at(event), last = this.down.get(event.pointerId);
    if (!last) {
      this.box.style.cursor = this.isOnPlatform(at) ? 'grab' : '';
      this.names.rest(at.x, at.y);
      return;
    }
    if (this.down.size === 2) this.pinch(event.pointerId, last, at);
    this.down.set(event.pointerId, at);
    if (Math.hypot(at.x - this.from.x, at.y - this.from.y) > slip) this.isClick = false;
    if (this.mode === 'none' || this.isClick) return;
    this.box.style.cursor = 'grabbing';
    if (this.mode === 'grab') return this.drag();
    if (this.mode === 'pan') this.camera.pan(at.x - last.x, at.y - last.y);
    else this.camera.orbit(at.x - last.x, at.y - last.y);
    this.hand.looked(false);
  }

  /** Two fingers: apart and together zoom about their middle, both ways pan. */
  private pinch(id: number, last: {x: number; y: number}, at: {x: number; y: number}): void {
    const other = [...this.down].find(([key]) => key !== id)![1], gap = (of: {x: number; y: number}) => Math.max(Math.hypot(of.x - other.x, of.y - other.y), 1);
    this.camera.pan((at.x - last.x) / 2, (at.y - last.y) / 2);
    this.camera.zoom(gap(at) / gap(last), (at.x + other.x) / 2, (at.y + other.y) / 2);
    this.hand.looked(false);
  }

  /** Once a picture at most. */
  private drag(): void {
    if (!this.isTold) return;
    this.isTold = false;
    requestAnimationFrame(() => {
      const at = [...this.down.values()][0];
      if (!this.isTold && at && this.mode === 'grab') this.hand.grabbed(this.goal(at), false);
      this.isTold = true;
    });
  }

  private goal(at: {x: number; y: number}): Point {
    return plus(this.place, this.camera.shift(at.x - this.from.x, at.y - this.from.y)).slice(0, 3);
  }

  private letGo(at: {x: number; y: number}): void {
    this.isTold = true;
    if (!this.isClick) this.hand.grabbed(this.goal(at), true);
  }

  private release(event: PointerEvent): void {
    const at = this.at(event), {mode} = this;
    if (!this.down.delete(event.pointerId)) return;
    if (mode === 'grab') this.letGo(at);
    else if (!this.isClick) this.hand.looked(true);
    if (this.isClick && event.type === 'pointerup') this.names.click(at.x, at.y);
    this.mode = 'none';
    this.isClick = false;
    this.box.style.cursor = this.isOnPlatform(at) ? 'grab' : '';
  }

  private wheel(event: WheelEvent): void {
    const {x, y} = this.at(event), unit = event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1;
    event.preventDefault();
    this.camera.zoom(Math.exp(-event.deltaY * unit * (event.ctrlKey ? 0.01 : 0.0015)), x, y);
    this.hand.looked(false);
    clearTimeout(this.wheeled);
    this.wheeled = window.setTimeout(() => this.hand.looked(true), 150);  // a wheel says not when it ends
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const ways: Record<string, [number, number]> = {ArrowLeft: [12, 0], ArrowRight: [-12, 0], ArrowUp: [0, 12], ArrowDown: [0, -12]}, way = ways[event.key];
    if (event.key === 'Escape') return this.names.unpin();
    if (way) this.camera.isPlanar ? this.camera.pan(4 * way[0], 4 * way[1]) : this.camera.orbit(...way);
    else if (event.key === '+' || event.key === '-') this.camera.zoom(event.key === '+' ? 1.1 : 1 / 1.1);
    else return;
    event.preventDefault();
    this.hand.looked(true);
  }
}
