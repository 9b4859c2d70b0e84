// The picture without WebGL: the same lines by SVG, turned by arrow keys and by dragging.
import {Labels} from './labels';
import {lengthName, round} from './outline';
import {type Drawing, type Layer, type Part, type Picture, shownAtFirst, type View} from './picture';
import {Pointer} from './pointer';
import {bounds, draw, flat, make, type Stroke, strokes} from './sketch';

const views: Record<View, [number, number]> = {side: [-Math.PI / 2, 0.1], top: [-Math.PI / 2, Math.PI / 2], front: [0, 0.1], tip: [-1, 0.35]};

export class PlainPicture implements Picture {
  readonly canvas = make();
  frames = 0;
  notScaled = true;
  labelOf: (part: Part) => string = () => '';
  grabbed: (position: number[], isEnd: boolean) => void = () => undefined;
  note: (text: string) => void = () => undefined;
  moved: () => void = () => undefined;
  private readonly labels: Labels;
  private readonly layers = new Set<Layer>(shownAtFirst);
  private drawing: Drawing | null = null;
  private azimuth = views.tip[0];
  private elevation = views.tip[1];
  private zoom = 1;
  private isHeld = false;
  private scale = 1;
  private middle = [0, 0];

  constructor(private readonly box: HTMLElement) {
    const banner = document.createElement('p');
    banner.className = 'simplified';
    banner.textContent = '3-D simplified: no WebGL';
    box.append(this.canvas, banner);
    this.labels = new Labels(box);
    new Pointer(box, this.labels, {
      shape: () => this.drawing?.shape ?? null, project: (point) => this.project(point), label: (part) => this.labelOf(part),
      shift: (right, down) => this.shift(right, down), grabbed: (position, isEnd) => this.grabbed(position, isEnd), hold: (is) => { this.isHeld = is; },
    });
    box.addEventListener('pointermove', (event) => event.buttons === 1 && !this.isHeld && this.turn(-event.movementX / 100, event.movementY / 100));
    box.addEventListener('keydown', (event) => this.key(event));
    box.addEventListener('dblclick', () => this.fit());
    new ResizeObserver(() => this.refresh()).observe(box);
  }

  get camera(): string {
    return [this.azimuth, this.elevation, this.zoom].map((part) => part.toFixed(4)).join(',');
  }

  set camera(text: string) {
    const numbers = text.split(',').map(Number);
    if (text !== '' && numbers.length === 3 && numbers.every(Number.isFinite)) [this.azimuth, this.elevation, this.zoom] = numbers as [number, number, number];
  }

  paint(): void {
    this.refresh();
  }

  clear(): void {
    this.drawing = null;
    this.canvas.replaceChildren();
  }

  draw(drawing: Drawing): void {
    this.drawing = drawing;
    this.refresh();
  }

  fit(view: View = 'tip'): void {
    [this.azimuth, this.elevation] = views[view];
    this.zoom = 1;
    this.moved();
    this.refresh();
  }

  show(layer: Layer, is: boolean): void {
    if (is) this.layers.add(layer);
    else this.layers.delete(layer);
    this.refresh();
  }

  toggleProjection(): void {
    this.note('without WebGL parallel lines stay parallel');
  }

  async save(): Promise<Blob> {
    return new Blob([new XMLSerializer().serializeToString(this.canvas)], {type: 'image/svg+xml'});
  }

  private key(event: KeyboardEvent): void {
    const turns: Record<string, [number, number]> = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]}, turn = turns[event.key];
    if (turn) this.turn(...turn);
    else if (event.key === '+' || event.key === '-') this.zoom *= event.key === '+' ? 1.1 : 1 / 1.1;
    else return;
    event.preventDefault();
    this.refresh();
  }

  private turn(azimuth: number, elevation: number): void {
    this.azimuth += azimuth;
    this.elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.elevation + elevation));
    this.moved();
    this.refresh();
  }

  private list(): Stroke[] {
    const {shape, isPlanar, ghost, isStale} = this.drawing!, list = strokes(shape, isPlanar).filter(({kind}) => kind !== 'rod' || this.layers.has('rods'));
    const other: Stroke[] = ghost && this.layers.has('ghost') ? strokes(ghost, isPlanar).map((one) => ({...one, kind: 'ghost'})) : [];
    return [...other, ...(isStale ? list.map((one): Stroke => ({...one, kind: 'ghost'})) : list)];
  }

  private refresh(): void {
    const {clientWidth: width, clientHeight: height} = this.box;
    this.canvas.setAttribute('width', String(width));
    this.canvas.setAttribute('height', String(height));
    if (!this.drawing || width === 0) return;
    const list = this.list(), project = flat(this.drawing.isPlanar, this.azimuth, this.elevation), box = bounds(list, project);
    this.scale = this.zoom * 0.8 * Math.min(width / Math.max(box.width, 1e-9), height / Math.max(box.height, 1e-9));
    this.middle = [box.x + box.width / 2, box.y + box.height / 2];
    draw(this.canvas, list, (point) => this.project(point), (kind) => (kind === 'rod' ? 3 : 1.5));
    const bar = round(120 / this.scale);
    this.labels.scale(bar * this.scale, lengthName(bar));
    ++this.frames;
  }

  private project(point: number[]): [number, number] {
    const [x, y] = flat(this.drawing!.isPlanar, this.azimuth, this.elevation)(point);
    return [this.box.clientWidth / 2 + this.scale * (x - this.middle[0]!), this.box.clientHeight / 2 + this.scale * (y - this.middle[1]!)];
  }

  private shift(right: number, down: number): number[] {
    const [x, y] = [right / this.scale, down / this.scale];
    if (this.drawing!.isPlanar) return [x, -y, 0];
    const [c, s, ce, se] = [Math.cos(this.azimuth), Math.sin(this.azimuth), Math.cos(this.elevation), Math.sin(this.elevation)];
    return [-s * x + se * c * y, c * x + se * s * y, -ce * y];
  }
}
