// The picture of a robot, drawn from an answer to `shape`. It is drawn when something has changed, not all the time.
import {
  AmbientLight, Box3, BufferGeometry, Color, CylinderGeometry, DirectionalLight, DoubleSide, Float32BufferAttribute, Group,
  Line, LineBasicMaterial, LineDashedMaterial, LineLoop, Mesh, MeshLambertMaterial, OrthographicCamera, Quaternion, Scene as World,
  Vector3, WebGLRenderer,
} from 'three';
import {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
import type {Json} from './client';
import {Tube} from './tube';

export type View = 'side' | 'top' | 'front' | 'tip';

const dashes: [number, number][] = [[1, 0], [8, 4], [2, 4], [10, 3]];
const from: Record<View, [number, number, number]> =
  {side: [0, -1, 0.35], top: [0, 0, 1], front: [1, 0, 0.15], tip: [0.7, -0.7, 0.6]};

/** Whether the browser draws without a graphics card: smooth edges would cost it most of its time. */
function isSoftware(): boolean {
  const probe = document.createElement('canvas').getContext('webgl2'), info = probe?.getExtension('WEBGL_debug_renderer_info');
  const name = info ? String(probe?.getParameter(info.UNMASKED_RENDERER_WEBGL)) : '';
  probe?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

export class Scene {
  readonly renderer: WebGLRenderer;
  frames = 0;
  private readonly world = new World();
  private readonly camera = new OrthographicCamera();
  private readonly controls: OrbitControls;
  private readonly lamp = new DirectionalLight(0xffffff, 1.6);
  private readonly parts = new Group();
  private tubes: Tube[] = [];
  private lines: Line[] = [];
  private discs: Mesh[] = [];
  private isAsked = false;
  private isPlanar = false;
  private size = 1;
  private colours = {backbone: '#0072B2', line: '#566172', plate: '#0072B2', tendons: ['#0072B2', '#00795A', '#1B2430', '#4C6A92']};

  constructor(private readonly box: HTMLElement) {
    const isSlow = isSoftware();
    this.renderer = new WebGLRenderer({antialias: !isSlow});
    this.renderer.setPixelRatio(isSlow ? 1 : Math.min(window.devicePixelRatio, 2));
    box.append(this.renderer.domElement);
    this.camera.up.set(0, 0, 1);
    this.world.add(new AmbientLight(0xffffff, 1.4), this.camera, this.parts);
    this.camera.add(this.lamp);
    this.lamp.position.set(0.3, 0.5, 1);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.ask());
    new ResizeObserver(() => this.resize()).observe(box);
  }

  /** Colours are the page's tokens. */
  paint(style: CSSStyleDeclaration): void {
    const token = (name: string) => style.getPropertyValue(name).trim();
    this.world.background = new Color(token('--scene'));
    this.colours = {
      backbone: token('--exact'), line: token('--mute'), plate: token('--accent'),
      tendons: [1, 2, 3, 4].map((i) => token(`--tendon-${i}`)),
    };
    this.clear();
  }

  clear(): void {
    for (const part of [...this.parts.children]) this.parts.remove(part);
    for (const mesh of [...this.tubes, ...this.discs, ...this.lines]) mesh.geometry.dispose();
    this.tubes = [];
    this.discs = [];
    this.lines = [];
  }

  /** Legs pull along lines; where these are struts they are drawn as what is there. */
  draw(shape: Json, radius: number, struts: boolean[], isGhost: boolean): void {
    const least = this.size / 250;  // thin rods stay visible
    let next = 0;
    for (const backbone of shape.backbones as number[][][])
      if (backbone.length > 1) this.tube(next++).set(backbone, Math.max(radius, least));
    this.drawDiscs(shape.discs ?? []);
    let line = 0;
    const plate = shape.platform as number[][] | undefined, base = shape.base as number[][] | undefined;
    if (plate && plate.length > 1) this.line(line++, this.colours.plate, 0, true, plate);
    if (base && base.length > 1) this.line(line++, this.colours.line, 0, true, base);
    ((shape.lines ?? []) as number[][][]).forEach((pull, leg) => {
      if (struts[leg]) this.tube(next++).set(pull, Math.max(radius, least) * 0.8);
      else this.line(line++, this.colours.line, 1, false, pull);
    });
    for (const of of (shape.tendons ?? []) as number[][][][])
      of.forEach((tendon, i) => {
        if (tendon.length > 1) this.line(line++, this.colours.tendons[i % 4]!, i % 4, false, tendon);
      });
    for (const tube of this.tubes) (tube.material as MeshLambertMaterial).opacity = isGhost ? 0.3 : 1;
    this.ask();
  }

  private tube(i: number): Tube {
    return (this.tubes[i] ??= this.add(new Tube(new MeshLambertMaterial({color: this.colours.backbone, transparent: true}))));
  }

  private add<T extends Mesh | Line>(part: T): T {
    this.parts.add(part);
    return part;
  }

  private line(i: number, colour: string, dash: number, isClosed: boolean, points: number[][]): void {
    const [on, off] = dashes[dash]!, scale = this.size / 400;
    const make = () => dash === 0 ? new LineBasicMaterial({color: colour})
                                  : new LineDashedMaterial({color: colour, dashSize: on * scale, gapSize: off * scale});
    let line = this.lines[i];
    if (!line) {
      line = this.add(isClosed ? new LineLoop(new BufferGeometry(), make()) : new Line(new BufferGeometry(), make()));
      line.frustumCulled = false;
      this.lines[i] = line;
    }
    const flat = points.flatMap((p) => [p[0]!, p[1]!, p[2] ?? 0]);
    const old = line.geometry.getAttribute('position');
    if (old && old.count === points.length) {
      (old.array as Float32Array).set(flat);
      old.needsUpdate = true;
    } else {
      line.geometry.setAttribute('position', new Float32BufferAttribute(flat, 3));
    }
    if (dash !== 0) line.computeLineDistances();
  }

  private drawDiscs(discs: Json[]): void {
    discs.forEach((disc, i) => {
      let mesh = this.discs[i];
      if (!mesh) {
        const shape = new CylinderGeometry(disc.radius, disc.radius, disc.height, 20);
        shape.rotateX(Math.PI / 2);
        shape.translate(0, 0, disc.height / 2);
        mesh = this.discs[i] = this.add(new Mesh(shape, new MeshLambertMaterial({color: this.colours.line, side: DoubleSide})));
      }
      const [w, x, y, z] = disc.pose.quaternion;
      mesh.position.set(disc.pose.position[0], disc.pose.position[1], disc.pose.position[2]);
      mesh.setRotationFromQuaternion(new Quaternion(x, y, z, w));
    });
  }

  /** A camera that sees all of it. */
  fit(isPlanar: boolean, view: View = isPlanar ? 'top' : 'tip'): void {
    const box = new Box3().setFromObject(this.parts), middle = box.getCenter(new Vector3());
    this.size = Math.max(box.getSize(new Vector3()).length(), 1e-6);
    this.isPlanar = isPlanar;
    this.controls.enableRotate = !isPlanar;
    const [x, y, z] = from[view];
    this.camera.up.set(0, view === 'top' ? 1 : 0, view === 'top' ? 0 : 1);
    this.camera.position.copy(middle).add(new Vector3(x, y, z).normalize().multiplyScalar(3 * this.size));
    this.camera.zoom = 1;
    this.controls.target.copy(middle);
    this.resize();
    this.controls.update();
  }

  private resize(): void {
    const {clientWidth: width, clientHeight: height} = this.box;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    const half = (this.isPlanar ? 0.5 : 0.55) * this.size, ratio = width / height;
    this.camera.left = -half * Math.max(ratio, 1);
    this.camera.right = half * Math.max(ratio, 1);
    this.camera.top = half / Math.min(ratio, 1);
    this.camera.bottom = -half / Math.min(ratio, 1);
    this.camera.near = 0.01 * this.size;
    this.camera.far = 10 * this.size;
    this.camera.updateProjectionMatrix();
    this.ask();
  }

  private ask(): void {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      this.renderer.render(this.world, this.camera);
      ++this.frames;
    });
  }
}
