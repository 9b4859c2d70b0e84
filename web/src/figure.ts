// What pictures have in common, by WebGL or by SVG: what is drawn, what of it is shown, from where it is seen, its words, its pointer.
import {Camera} from './camera';
import {type Colours, compose, extent, leastRod, tokens} from './compose';
import {Labels} from './labels';
import {Names} from './names';
import {lengthName, round} from './outline';
import type {Pen} from './pen';
import {type Drawing, type Layer, type Part, type Picture, shownAtFirst, type Solids, type View} from './picture';
import {Pointer} from './pointer';
import {axesOf} from './vector';

const wayIn: [number, number] = [-75, 48];  // from where a way in is seen at first, cut open before the tip [deg]

export abstract class Figure implements Picture {
  abstract readonly canvas: Element;
  frames = 0;
  notScaled = false;
  isCut = false;
  labelOf: (part: Part) => string = () => '';
  grabbed: (position: number[], isEnd: boolean) => void = () => undefined;
  note: (text: string) => void = () => undefined;
  moved: () => void = () => undefined;
  protected readonly lookout = new Camera();
  protected readonly labels: Labels;
  protected colours = Object.fromEntries(tokens.map((name) => [name, '#808080'])) as Colours;
  private readonly shown = new Set<Layer>(shownAtFirst);
  private readonly names: Names;
  protected drawing: Drawing | null = null;
  private isFitted = false;
  private isComposed = false;  // what is drawn is as it is to be; only the camera may have turned
  private composedAt = 0;      // pixels of a metre
  private asked = 0;           // when a picture was asked for that is not drawn yet [ms]; 0: none is

  protected abstract readonly pen: Pen;
  protected readonly isFlat: boolean = false;  // where the camera turns all has to be composed anew

  constructor(protected readonly box: HTMLElement) {
    this.labels = new Labels(box);
    this.names = new Names(this.labels, this.lookout, this.shown, () => this.drawing, (part) => this.labelOf(part));
    new Pointer(box, this.lookout, this.names, {
      drawing: () => this.drawing, grabbed: (position, isEnd) => this.grabbed(position, isEnd), fit: () => this.fit(), looked: (isEnd) => this.looked(isEnd),
    });
    new ResizeObserver(() => this.resize()).observe(box);
  }

  get camera(): string {
    return this.isFitted ? this.lookout.text : '';
  }

  set camera(text: string) {
    this.isFitted = this.lookout.put(text);
    this.change();
  }

  paint(style: CSSStyleDeclaration): void {
    for (const name of tokens) this.colours[name] = style.getPropertyValue(`--${name}`).trim();
    this.change();
  }

  clear(): void {
    this.drawing = null;
    this.names.unpin();
    this.change();
  }

  draw(drawing: Drawing): void {
    this.drawing = drawing;
    this.lookout.isPlanar = drawing.isPlanar;
    this.notScaled = 2 * drawing.radius * this.lookout.pixels < leastRod;
    if (!this.isFitted) this.fit();
    this.change();
  }

  fit(view?: View): void {
    if (!this.drawing) return;
    const {shape, around} = this.drawing, last = shape.frames?.at(-1);
    if (around) [this.lookout.margin, this.lookout.from] = [Math.min(62, 0.12 * this.lookout.height), wayIn];
    else this.lookout.margin = Math.min(62, 0.14 * this.lookout.height);  // a small picture is for the robot
    this.lookout.fit(around?.extent ?? extent(shape), view, around?.tip.direction ?? (last ? axesOf(last)[2] : [0, 0, 1]));
    this.isFitted = true;
    this.change();
    this.moved();
  }

  show(layer: Layer, is: boolean): void {
    if (is) this.shown.add(layer);
    else this.shown.delete(layer);
    this.change();
  }

  toggleProjection(): void {
    this.lookout.toggle();
    this.looked(true);
  }

  abstract save(command: string): Promise<Blob>;

  /** What has no depth leaves them out. */
  solids(_solids: Solids | null): void {}

  /** What has been composed, on the screen. */
  protected abstract render(): void;

  /** A picture is done. @param asked when it was asked for [ms] */
  protected drawn(_asked: number): void {}

  /** Now, not at the next frame. */
  protected now(): void {
    const {lookout, drawing, asked} = this;
    this.asked = 0;
    if (this.isFlat || !this.isComposed || lookout.pixels !== this.composedAt) this.compose();
    this.render();
    if (drawing) {
      const bar = round(120 / lookout.pixels);
      this.notScaled = 2 * drawing.radius * lookout.pixels < leastRod;
      this.labels.place((point) => lookout.project(point));
      this.labels.scale(bar * lookout.pixels, lengthName(bar) + (this.notScaled ? ' · rods not to scale' : ''));
      this.names.follow();
    }
    ++this.frames;
    if (asked > 0) this.drawn(asked);
  }

  /** What is drawn is another one. */
  protected change(): void {
    this.isComposed = false;
    this.ask();
  }

  protected resize(): void {
    const {clientWidth: width, clientHeight: height} = this.box;
    if (width === 0 || height === 0) return;
    this.lookout.resize(width, height);
    this.change();
    this.now();  // an emptied canvas would be seen
  }

  private compose(): void {
    const {drawing, lookout, pen, labels} = this;
    this.isComposed = true;
    this.composedAt = lookout.pixels;
    if (drawing) return compose(drawing, pen, labels, {shown: this.shown, colours: this.colours, pixels: lookout.pixels, side: Math.min(lookout.width, lookout.height)});
    pen.begin(false, lookout.pixels);
    pen.end();
    labels.begin();
    labels.pulls.show(null);
    labels.end();
  }

  private looked(isEnd: boolean): void {
    if (isEnd) this.lookout.snap();
    this.ask();
    if (isEnd) this.moved();
  }

  private ask(): void {
    if (this.asked > 0) return;
    this.asked = performance.now();
    requestAnimationFrame(() => { if (this.asked > 0) this.now(); });
  }
}
