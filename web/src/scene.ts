// The picture of a robot by WebGL. It is drawn when something has changed, not all the time.
import {AmbientLight, Camera as Eye, Color, DirectionalLight, HemisphereLight, Scene as World, WebGLRenderer} from 'three';
import {Figure} from './figure';
import {GlPen} from './gl_pen';
import {Pace} from './pace';
import type {Solids} from './picture';
import {withText} from './png';
import {Surfaces} from './surfaces';
import {dot, length, minus, plus} from './vector';
import {webgl} from './webgl';

const deep = 20;  // sizes of the picture that are drawn, before and behind the target

export class Scene extends Figure {
  protected readonly pen = new GlPen();
  private readonly renderer: WebGLRenderer;
  private readonly world = new World();
  private readonly eye = new Eye();
  private readonly lamp = new DirectionalLight(0xffffff, 1.4);
  private readonly pace = new Pace();
  private surfaces: Surfaces | null = null;

  constructor(box: HTMLElement) {
    super(box);
    const isSlow = webgl() === 'software';
    this.renderer = new WebGLRenderer({antialias: !isSlow});
    this.renderer.setPixelRatio(isSlow ? 1 : Math.min(window.devicePixelRatio, 2));
    box.prepend(this.canvas);
    this.eye.matrixAutoUpdate = false;
    this.world.add(new AmbientLight(0xffffff, 1.2), new HemisphereLight(0xffffff, 0x8090a0, 0.6), this.lamp, this.pen.group);
    this.canvas.addEventListener('webglcontextrestored', () => this.change());
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  override paint(style: CSSStyleDeclaration): void {
    super.paint(style);
    this.surfaces?.paint(style);
    this.world.background = new Color(this.colours.scene);
  }

  override solids(solids: Solids | null): void {
    if (this.surfaces) this.world.remove(this.surfaces);
    this.surfaces?.free();
    this.surfaces = solids && new Surfaces(solids);
    this.renderer.localClippingEnabled = !!solids;
    if (this.surfaces) this.world.add(this.surfaces);
    this.surfaces?.paint(getComputedStyle(document.documentElement));
    this.change();
  }

  async save(command: string): Promise<Blob> {
    const {width, height} = this.lookout, ratio = this.renderer.getPixelRatio(), large = document.createElement('canvas');
    [large.width, large.height] = [2 * width, 2 * height];
    const context = large.getContext('2d')!;
    this.renderer.setPixelRatio(2);
    this.now();
    context.drawImage(this.canvas, 0, 0, large.width, large.height);
    this.labels.paint(context, 2);
    this.renderer.setPixelRatio(ratio);
    this.now();
    const picture = await new Promise<Blob | null>((done) => large.toBlob(done, 'image/png'));
    return withText(picture!, 'sinew', command);
  }

  protected override resize(): void {
    this.renderer.setSize(Math.max(this.box.clientWidth, 1), Math.max(this.box.clientHeight, 1));
    super.resize();
  }

  protected render(): void {
    const {lookout, eye, renderer} = this;
    this.pen.resize(lookout.width, lookout.height, renderer.getPixelRatio(), lookout.pixels, this.aim());
    const around = this.drawing?.around;
    if (this.surfaces && around) {
      this.surfaces.mark(around.near?.isBad ? around.near.solid : -1);
      const {tip, base = tip.position} = around, {back} = lookout;
      this.surfaces.cut(this.isCut ? (dot(base, back) > dot(tip.position, back) ? base : tip.position) : null, back);
    }
    renderer.render(this.world, eye);
  }

  protected override drawn(asked: number): void {
    if (!this.pace.isSlow(asked, performance.now()) || this.pen.isCoarse) return;
    this.pen.isCoarse = true;
    this.renderer.setPixelRatio(1);
    this.note('drawn with fewer details: this browser draws slowly');
    this.change();
  }

  /** @return depth of a pixel at the target */
  private aim(): number {
    const {lookout, eye} = this, {right, up, back, at, width, height, pixels, isLens} = lookout, size = Math.max(width, height) / pixels;
    const away = isLens ? lookout.away : deep * size, place = plus(at, back, away), far = away + deep * Math.max(size, length(minus(at, [0, 0, 0])));
    eye.matrix.set(right[0]!, up[0]!, back[0]!, place[0]!, right[1]!, up[1]!, back[1]!, place[1]!, right[2]!, up[2]!, back[2]!, place[2]!, 0, 0, 0, 1);
    eye.matrixWorldNeedsUpdate = true;
    const near = isLens ? 0.02 * away : 0, part = isLens ? near / away : 1, [x, y] = [(part * width) / pixels / 2, (part * height) / pixels / 2];
    if (isLens) eye.projectionMatrix.makePerspective(-x, x, y, -y, near, far);
    else eye.projectionMatrix.makeOrthographic(-x, x, y, -y, near, far);
    eye.projectionMatrixInverse.copy(eye.projectionMatrix).invert();
    this.lamp.position.set(...(plus(plus(back, right, 0.3), up, 0.5) as [number, number, number]));
    return (isLens ? near / away ** 2 : 1 / far) / pixels;
  }
}
