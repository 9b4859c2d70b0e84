// The picture of a robot by WebGL. It is drawn when something has changed, not all the time.
import {AmbientLight, Box3, Color, DirectionalLight, HemisphereLight, Scene as World, Vector3, WebGLRenderer} from 'three';
import {Camera} from './camera';
import {Labels} from './labels';
import {lengthName, longer, outline, ring, round} from './outline';
import {type Look, Parts} from './parts';
import {type Drawing, type Layer, layerNames, type Part, type Picture, shownAtFirst, type View} from './picture';
import {placeOf, Pointer} from './pointer';
import {withText} from './png';

const dashes: [number, number][] = [[1, 0], [8, 4], [2, 4], [10, 3]];  // of tendons, in pixels
const tokens = {rod: 'rod', line: 'mute', plate: 'accent', ghost: 'ghost', alarm: 'over', x: 'axis-x', y: 'axis-y', z: 'axis-z', text: 'text'} as const;
const states: Record<string, string> = {'●': 'exact', '▼': 'slack', '⊗': 'over', '⧄': 'unreachable'};
const least = 25;        // pictures a second that a browser should draw
const enough = 2000;     // ms of fewer until details are left out

/** Whether the browser draws without a graphics card: smooth edges would cost it most of its time. */
function isSoftware(): boolean {
  const probe = document.createElement('canvas').getContext('webgl2'), info = probe?.getExtension('WEBGL_debug_renderer_info');
  const name = info ? String(probe?.getParameter(info.UNMASKED_RENDERER_WEBGL)) : '';
  probe?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

export class Scene implements Picture {
  frames = 0;
  notScaled = false;
  labelOf: (part: Part) => string = () => '';
  grabbed: (position: number[], isEnd: boolean) => void = () => undefined;
  note: (text: string) => void = () => undefined;
  moved: () => void = () => undefined;
  private readonly renderer: WebGLRenderer;
  private readonly world = new World();
  private readonly lookout: Camera;
  private readonly layers = Object.fromEntries(layerNames.map((name) => [name, new Parts()])) as Record<Layer, Parts>;
  private readonly always = new Parts();  // platform, base, loads
  private readonly labels: Labels;
  private readonly shown = new Set<Layer>(shownAtFirst);
  private drawing: Drawing | null = null;
  private isAsked = false;
  private drawnAt = 1;  // pixels of a metre
  private isFitted = false;
  private colours = Object.fromEntries(Object.keys(tokens).map((name) => [name, '#808080'])) as Record<keyof typeof tokens, string>;
  private tendons = ['#808080', '#808080', '#808080', '#808080'];
  private readonly spare = new Vector3();
  private slowSince = 0;
  private drawnSince = 0;
  private lastDrawn = 0;

  constructor(private readonly box: HTMLElement) {
    const isSlow = isSoftware(), lamp = new DirectionalLight(0xffffff, 1.4);
    this.renderer = new WebGLRenderer({antialias: !isSlow});
    this.renderer.setPixelRatio(isSlow ? 1 : Math.min(window.devicePixelRatio, 2));
    box.append(this.renderer.domElement);
    this.labels = new Labels(box);
    this.lookout = new Camera(box, this.canvas, lamp, () => this.lookAgain(), () => this.moved());
    lamp.position.set(0.3, 0.5, 1);
    this.world.add(new AmbientLight(0xffffff, 1.2), new HemisphereLight(0xffffff, 0x8090a0, 0.6), ...this.lookout.objects, this.always.group);
    for (const name of layerNames) {
      this.layers[name].group.visible = this.shown.has(name);
      this.world.add(this.layers[name].group);
    }
    new Pointer(box, this.labels, {
      shape: () => this.drawing?.shape ?? null, project: (point) => this.lookout.project(point, this.spare), label: (part) => this.labelOf(part),
      shift: (right, down) => this.lookout.shift(right, down), grabbed: (position, isEnd) => this.grabbed(position, isEnd),
      hold: (is) => { this.lookout.controls.enabled = !is; },
    });
    box.addEventListener('dblclick', () => this.fit());
    new ResizeObserver(() => this.resize()).observe(box);
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  get camera(): string {
    return this.isFitted ? this.lookout.text : '';
  }

  set camera(text: string) {
    this.lookout.text = text;
    this.isFitted = false;
  }

  paint(style: CSSStyleDeclaration): void {
    const token = (name: string) => style.getPropertyValue(`--${name}`).trim();
    this.world.background = new Color(token('scene'));
    for (const [name, of] of Object.entries(tokens)) this.colours[name as keyof typeof tokens] = token(of);
    this.tendons = [1, 2, 3, 4].map((i) => token(`tendon-${i}`));
    this.refresh();
  }

  clear(): void {
    this.drawing = null;
    for (const parts of [...Object.values(this.layers), this.always]) parts.clear();
    this.labels.begin();
    this.labels.end();
    this.ask();
  }

  draw(drawing: Drawing): void {
    this.drawing = drawing;
    this.refresh();
    if (!this.isFitted) this.fit();
  }

  fit(view?: View): void {
    if (!this.drawing) return;
    const box = new Box3(), {shape, isPlanar} = this.drawing;
    const add = (points: number[][]) => points.forEach((point) => box.expandByPoint(this.spare.set(point[0]!, point[1]!, point[2] ?? 0)));
    for (const points of [...shape.backbones, ...(shape.lines ?? []), shape.platform ?? [], shape.base ?? []]) add(points);
    for (const disc of shape.discs ?? []) add([disc.pose.position]);
    this.isFitted = true;
    this.lookout.fit(box.getCenter(new Vector3()), Math.max(box.getSize(new Vector3()).length(), 1e-6), isPlanar, view);
    this.refresh();
    if (view) this.moved();
  }

  show(layer: Layer, is: boolean): void {
    if (is) this.shown.add(layer);
    else this.shown.delete(layer);
    this.layers[layer].group.visible = is;
    this.refresh();
  }

  toggleProjection(): void {
    this.lookout.toggleProjection();
    this.moved();
    this.ask();
  }

  async save(command: string): Promise<Blob> {
    const {width, height} = this.box.getBoundingClientRect(), ratio = this.renderer.getPixelRatio(), large = document.createElement('canvas');
    [large.width, large.height] = [2 * Math.round(width), 2 * Math.round(height)];
    const context = large.getContext('2d')!;
    this.renderer.setPixelRatio(2);
    this.renderer.setSize(width, height);
    this.render();
    context.drawImage(this.canvas, 0, 0, large.width, large.height);
    this.labels.paint(context, 2, this.colours.text);
    this.renderer.setPixelRatio(ratio);
    this.resize();
    const picture = await new Promise<Blob | null>((done) => large.toBlob(done, 'image/png'));
    return withText(picture!, 'sinew', command);
  }

  /** What is some pixels wide is made so again where the camera came nearer. */
  private lookAgain(): void {
    if (Math.abs(this.lookout.pixels / this.drawnAt - 1) > 0.02) this.refresh();
    this.ask();
  }

  /** Pixels as metres. */
  private pixels(count: number): number {
    return count / this.lookout.pixels;
  }

  private refresh(): void {
    const {drawing} = this;
    if (!drawing) return;
    this.drawnAt = this.lookout.pixels;
    const all = [...Object.values(this.layers), this.always];
    for (const parts of all) parts.begin();
    this.labels.begin();
    this.drawRods(drawing);
    this.drawTendons(drawing);
    this.drawPlatform(drawing);
    this.drawFrames(drawing);
    this.drawLines(drawing);
    this.drawLoad(drawing);
    if (this.shown.has('labels')) this.name(drawing);
    if (drawing.ghost && this.shown.has('ghost')) this.haunt(drawing);
    if (this.shown.has('grid')) this.drawGrid();
    for (const parts of all) parts.end();
    this.labels.end();
    this.ask();
  }

  private look(colour: string, {isStale}: Drawing): Look {
    return isStale ? {colour: this.colours.ghost, opacity: 0.4} : {colour};
  }

  private drawRods(drawing: Drawing): void {
    const {shape, radius, struts, states: marks} = drawing, thin = this.pixels(1.5), rods = this.layers.rods, look = this.look(this.colours.rod, drawing);
    this.notScaled = radius < thin;
    for (const points of shape.backbones as number[][][]) if (points.length > 1) rods.tube(points, Math.max(radius, thin), look);
    ((shape.lines ?? []) as number[][][]).forEach((points, leg) => {
      if (struts[leg]) rods.tube(points, Math.max(0.8 * radius, thin), look);
    });
    for (const disc of shape.discs ?? []) this.layers.discs.roll(disc, this.look(this.colours.line, drawing));
    marks.forEach((mark, i) => this.labels.put(mark, shape.backbones[i]?.at(-1) ?? [0, 0, 0], `state ${states[mark] ?? ''}`));
  }

  private drawTendons(drawing: Drawing): void {
    for (const of of (drawing.shape.tendons ?? []) as number[][][][])
      of.forEach((points, i) => {
        const [on, off] = dashes[i % 4]!, look = this.look(this.tendons[i % 4]!, drawing);
        if (points.length > 1) this.layers.tendons.line(points, off > 0 ? {...look, dash: [this.pixels(on), this.pixels(off)]} : look);
      });
  }

  private drawPlatform(drawing: Drawing): void {
    const {shape, isPlanar, isUnstable} = drawing, plate: number[][] = shape.platform ?? [], base: number[][] = shape.base ?? [];
    const edge = this.look(this.colours.plate, drawing), ground = this.look(this.colours.line, drawing);
    if (plate.length > 2) {
      const edges = outline(plate), closed = [...edges, edges[0]!];
      this.always.plate(edges, {...edge, opacity: 0.22});
      if (isUnstable) this.always.line(closed, {...edge, dash: [this.pixels(8), this.pixels(6)]});
      else this.always.tube(closed, this.pixels(1), edge);
    }
    if (base.length > 1) this.always.loop(isPlanar ? outline(base) : ring(base), ground);
    for (const point of base) this.always.dot(point, this.pixels(3.5), ground);
    for (const point of plate) this.always.dot(point, this.pixels(3), edge);
  }

  private drawFrames(drawing: Drawing): void {
    const {shape, isPlanar} = drawing, frames = this.layers.frames, length = this.pixels(48), isShown = this.shown.has('frames');
    const names = ['x', 'y', 'z'] as const, turn = (q: number[], v: Vector3) => v.applyQuaternion({x: q[1]!, y: q[2]!, z: q[3]!, w: q[0]!} as never);
    const one = (place: number[], axis: (k: number) => number[], isNamed: boolean) => names.slice(0, isPlanar ? 2 : 3).forEach((name, k) => {
      const along = axis(k), tip = place.map((part, i) => part + length * (along[i] ?? 0));
      frames.arrow(place, tip, this.pixels(1), this.pixels(9), this.look(this.colours[name], drawing));
      if (isNamed && isShown) this.labels.put(name, place.map((part, i) => part + 1.22 * length * (along[i] ?? 0)), `axis axis-${name}`);
    });
    one([0, 0, 0], (k) => [0, 1, 2].map((i) => (i === k ? 1 : 0)), true);
    (shape.frames ?? []).forEach((frame: Record<string, any>, i: number) => {
      if (frame.position) one(frame.position, (k) => turn(frame.quaternion, this.spare.set(k === 0 ? 1 : 0, k === 1 ? 1 : 0, k === 2 ? 1 : 0)).toArray(), i === shape.frames.length - 1);
      else one([frame.x, frame.y, 0], (k) => [Math.cos(frame.phi + (k * Math.PI) / 2), Math.sin(frame.phi + (k * Math.PI) / 2), 0], true);
    });
  }

  /** The lines along which legs pull, made long; where they meet is a type II. */
  private drawLines(drawing: Drawing): void {
    const {shape, meeting} = drawing, dash: [number, number] = [this.pixels(12), this.pixels(5)];
    ((shape.lines ?? []) as number[][][]).forEach((points) => {
      const long = longer(points, this.pixels(800));
      if (long) this.layers.lines.line(long, {...this.look(this.colours.line, drawing), dash});
      if (long && meeting) this.always.line(long, {...this.look(this.colours.alarm, drawing), dash});
    });
    if (meeting) this.always.dot(meeting, this.pixels(6), {colour: this.colours.alarm});
  }

  private drawLoad(drawing: Drawing): void {
    const {shape, wrench, directions, isPlanar} = drawing, place = placeOf(shape);
    if (!place) return;
    const long = this.pixels(110), to = (way: number[], by: number) => place.map((part, i) => part + (by * (way[i] ?? 0)) / Math.hypot(...way));
    const arrow = (from: number[], tip: number[]) => this.always.arrow(from, tip, this.pixels(1.6), this.pixels(14), this.look(this.colours.alarm, drawing));
    for (const twist of directions) {
      const moves = twist.slice(0, isPlanar ? 2 : 3), way = Math.hypot(...moves) > 1e-6 ? moves : twist.slice(3);
      if (way.length === 0 || Math.hypot(...way) < 1e-9) continue;
      for (const sign of [0.5, -0.5]) arrow(place, to(way, sign * long));
    }
    if (!wrench) return;
    const force = isPlanar ? wrench.slice(0, 2) : wrench.slice(0, 3), moment = isPlanar ? [0, 0, wrench[2]!] : wrench.slice(3);
    if (Math.hypot(...force) > 0) {
      arrow(place, to(force, long));
      this.labels.put(`${Number(Math.hypot(...force).toPrecision(3))} N`, to(force, 1.15 * long), 'load');
    }
    if (Math.hypot(...moment) > 0) {
      arrow(place, to(moment, 0.8 * long));
      arrow(place, to(moment, 0.7 * long));  // two heads: a moment
      this.labels.put(`${Number(Math.hypot(...moment).toPrecision(3))} N m`, to(moment, 0.92 * long), 'load');
    }
  }

  private name({shape}: Drawing): void {
    const isArm = (shape.base ?? []).length === 0;
    (shape.backbones as number[][][]).forEach((points, i) => {
      const at = points[isArm ? Math.floor(points.length / 2) : 0] ?? shape.base?.[i];
      if (at) this.labels.put(isArm ? `S${i + 1}` : String(i + 1), at, 'leg');
    });
  }

  private haunt({ghost, isPlanar}: Drawing): void {
    const look: Look = {colour: this.colours.ghost, dash: [this.pixels(6), this.pixels(4)]}, plate: number[][] = ghost!.platform ?? [];
    for (const points of [...ghost!.backbones, ...(ghost!.lines ?? [])] as number[][][]) if (points.length > 1) this.layers.ghost.line(points, look);
    if (plate.length > 1) this.layers.ghost.line([...outline(plate), outline(plate)[0]!], look);
    if (isPlanar) return;
    for (const disc of ghost!.discs ?? []) this.layers.ghost.dot(disc.pose.position, this.pixels(2), look);
  }

  private drawGrid(): void {
    const step = round(this.pixels(80)), count = 6, look: Look = {colour: this.colours.line, opacity: 0.35};
    for (let i = -count; i <= count; ++i) {
      this.layers.grid.line([[i * step, -count * step, 0], [i * step, count * step, 0]], look);
      this.layers.grid.line([[-count * step, i * step, 0], [count * step, i * step, 0]], look);
    }
  }

  private resize(): void {
    const {clientWidth: width, clientHeight: height} = this.box;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    this.lookout.resize();
    this.refresh();
    this.ask();
  }

  private ask(): void {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      this.render();
    });
  }

  private render(): void {
    const {lookout} = this, bar = round(120 / lookout.pixels);
    this.renderer.render(this.world, lookout.now);
    this.labels.place((point) => lookout.project(point, this.spare));
    this.labels.scale(bar * lookout.pixels, lengthName(bar) + (this.notScaled ? ' · rods not to scale' : ''));
    ++this.frames;
    this.pace();
  }

  /** Where a browser draws slowly all the time, details are left out. */
  private pace(): void {
    const now = performance.now(), isGoing = now - this.lastDrawn < 250;
    if (!isGoing) [this.slowSince, this.drawnSince] = [now, this.frames];
    this.lastDrawn = now;
    const time = now - this.slowSince, isSlow = (1000 * (this.frames - this.drawnSince)) / time < least;
    if (time < enough) return;
    [this.slowSince, this.drawnSince] = [now, this.frames];
    if (!isSlow || this.layers.rods.sides === 6) return;
    for (const parts of [...Object.values(this.layers), this.always]) {
      parts.sides = 6;
      parts.hasCaps = false;
    }
    this.layers.discs.clear();
    this.note('drawn with fewer details: this browser draws slowly');
    this.refresh();
  }
}
