// Names what the pointer rests on, and keeps a name that is clicked: it then follows its part.
import type {Camera} from './camera';
import type {Labels} from './labels';
import {type Found, partAt, pointOf} from './pick';
import type {Drawing, Layer, Part} from './picture';

const patience = 150;  // ms on a part until it is named

export class Names {
  private timer = 0;
  private pinned: Found | null = null;
  private rested: [number, number] | null = null;  // where what is named now is under the pointer

  constructor(private readonly labels: Labels, private readonly camera: Camera, private readonly shown: ReadonlySet<Layer>,
              private readonly drawing: () => Drawing | null, private readonly label: (part: Part) => string) {}

  /** The pointer has come here. */
  rest(x: number, y: number): void {
    this.leave();
    if (!this.pinned) this.timer = window.setTimeout(() => this.name(this.find(x, y), ...(this.rested = [x, y])), patience);
  }

  leave(): void {
    clearTimeout(this.timer);
    this.rested = null;
    if (!this.pinned) this.name(null, 0, 0);
  }

  click(x: number, y: number): void {
    this.leave();
    this.pinned = this.pinned ? null : this.find(x, y);
    this.name(this.pinned, x, y);
  }

  unpin(): void {
    this.pinned = null;
    this.leave();
  }

  /** The picture is another one: names say what is so now, and one that is kept goes where its part is. */
  follow(): void {
    const drawing = this.drawing();
    if (this.rested) this.name(this.find(...this.rested), ...this.rested);
    if (!this.pinned) return;
    const point = drawing && pointOf(drawing, this.pinned);
    if (!point) return this.unpin();
    this.name(this.pinned, ...this.camera.project(point));
  }

  private find(x: number, y: number): Found | null {
    const drawing = this.drawing();
    return drawing && partAt(x, y, drawing, this.shown, (point) => this.camera.project(point), this.camera.pixels);
  }

  private name(found: Found | null, x: number, y: number): void {
    this.labels.point(found ? this.label(found.part) : '', x, y, !!this.pinned);
  }
}
