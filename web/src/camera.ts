// The camera: round the picture, parallel or not, as a short text and back.
import {MOUSE, OrthographicCamera, PerspectiveCamera, type Object3D, Spherical, TOUCH, Vector3} from 'three';
import {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
import type {View} from './picture';

const from: Record<View, [number, number, number]> = {side: [0, -1, 0.1], top: [0, 0, 1], front: [1, 0, 0.1], tip: [0.45, -0.85, 0.4]};
const angle = 30;  // of view [deg]

export class Camera {
  readonly controls: OrbitControls;
  private readonly parallel = new OrthographicCamera();
  private readonly lens = new PerspectiveCamera(angle);
  private isLens = false;
  private isPlanar = false;
  private size = 1;
  private width = 1;   // of the box [px], asked once: browsers lay out the page to say it
  private height = 1;
  private wanted = '';

  /** @param lamp goes where the camera goes */
  constructor(private readonly box: HTMLElement, canvas: HTMLElement, lamp: Object3D, changed: () => void, moved: () => void) {
    for (const camera of [this.parallel, this.lens]) camera.up.set(0, 0, 1);
    this.parallel.add(lamp);
    this.controls = new OrbitControls(this.parallel, canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', changed);
    this.controls.addEventListener('end', () => {
      this.snap();
      moved();
    });
    box.addEventListener('keydown', (event) => this.key(event, moved));
  }

  get now(): OrthographicCamera | PerspectiveCamera {
    return this.isLens ? this.lens : this.parallel;
  }

  get objects(): Object3D[] {
    return [this.parallel, this.lens];
  }

  /** Two angles, the height of the picture in metres, and the target. */
  get text(): string {
    if (this.wanted) return this.wanted;
    const {phi, theta} = this.round(), {x, y, z} = this.controls.target, height = this.height / this.pixels;
    return [phi, theta, height, x, y, z].map((part) => String(Number(part.toPrecision(6)))).join(',') + (this.isLens ? ',lens' : '');
  }

  /** For the next time that all is fitted. */
  set text(text: string) {
    this.wanted = text.split(',').slice(0, 6).map(Number).every((part) => text !== '' && Number.isFinite(part)) && text.split(',').length >= 6 ? text : '';
  }

  /** All of a sphere in view. */
  fit(middle: Vector3, size: number, isPlanar: boolean, view: View = isPlanar ? 'top' : 'tip'): void {
    const {controls} = this, [x, y, z] = from[view];
    this.size = size;
    this.isPlanar = isPlanar;
    controls.enableRotate = !isPlanar;
    controls.mouseButtons = {LEFT: isPlanar ? MOUSE.PAN : MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN};
    controls.touches = {ONE: isPlanar ? TOUCH.PAN : TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN};
    const up = view === 'top' ? [0, 1, 0] : [0, 0, 1], far = this.isLens ? (0.55 * size) / Math.tan((angle * Math.PI) / 360) : 3 * size;
    this.now.up.set(up[0]!, up[1]!, up[2]!);
    this.now.position.copy(middle).add(new Vector3(x, y, z).normalize().multiplyScalar(far));
    this.parallel.zoom = 1;
    controls.target.copy(middle);
    this.resize();
    this.follow();
    const wanted = this.wanted || this.text;
    this.wanted = '';
    this.apply(wanted);
  }

  resize(): void {
    [this.width, this.height] = [Math.max(this.box.clientWidth, 1), Math.max(this.box.clientHeight, 1)];
    const ratio = this.width / this.height;
    const half = (this.isPlanar ? 0.5 : 0.55) * this.size;
    this.parallel.left = -half * Math.max(ratio, 1);
    this.parallel.right = half * Math.max(ratio, 1);
    this.parallel.top = half / Math.min(ratio, 1);
    this.parallel.bottom = -half / Math.min(ratio, 1);
    this.lens.aspect = ratio;
    for (const camera of [this.parallel, this.lens]) {
      camera.near = 0.01 * this.size;
      camera.far = 20 * this.size;
      camera.updateProjectionMatrix();
    }
  }

  /** Pixels of a metre, at the target. */
  get pixels(): number {
    const {height} = this;
    if (!this.isLens) return (height * this.parallel.zoom) / (this.parallel.top - this.parallel.bottom);
    return height / (2 * this.round().radius * Math.tan((angle * Math.PI) / 360));
  }

  toggleProjection(): void {
    const {position, quaternion, up} = this.now, {height, pixels} = this;
    this.isLens = !this.isLens;
    this.now.up.copy(up);
    this.now.quaternion.copy(quaternion);
    this.now.position.copy(position);
    this.controls.object = this.now;
    if (this.isLens) {
      const away = position.clone().sub(this.controls.target).normalize();
      this.lens.position.copy(this.controls.target).addScaledVector(away, height / pixels / (2 * Math.tan((angle * Math.PI) / 360)));
    } else {
      this.parallel.zoom = (pixels * (this.parallel.top - this.parallel.bottom)) / height;
      this.parallel.updateProjectionMatrix();
    }
    this.follow();
    this.snap();
  }

  /** A way on the screen in metres, at the target's depth. */
  shift(right: number, down: number): number[] {
    const {elements: m} = this.now.matrixWorld, unit = 1 / this.pixels;
    return [0, 1, 2].map((k) => unit * (right * m[k]! - down * m[4 + k]!));
  }

  project(point: number[], into: Vector3): [number, number] {
    into.set(point[0]!, point[1]!, point[2] ?? 0).project(this.now);
    return [((into.x + 1) / 2) * this.width, ((1 - into.y) / 2) * this.height];
  }

  /** Of the camera from the target; the angles of three's controls have +y up, here it is +z. */
  private round(): Spherical {
    const away = this.now.position.clone().sub(this.controls.target);
    return new Spherical().setFromCartesianCoords(away.y, away.z, away.x);
  }

  private apply(text: string): void {
    const [phi, theta, height, x, y, z] = text.split(',').map(Number) as [number, number, number, number, number, number];
    if (text.endsWith(',lens') !== this.isLens) this.toggleProjection();
    const away = new Vector3().setFromSpherical(new Spherical(this.isLens ? height / (2 * Math.tan((angle * Math.PI) / 360)) : 3 * this.size, Math.min(Math.max(phi, 1e-4), Math.PI), theta));
    this.controls.target.set(x, y, z);
    this.now.up.set(0, phi > 1e-3 ? 0 : 1, phi > 1e-3 ? 1 : 0);
    this.now.position.set(x + away.z, y + away.x, z + away.y);
    this.parallel.zoom = (this.parallel.top - this.parallel.bottom) / height;
    this.now.updateProjectionMatrix();
    this.follow();
  }

  private key(event: KeyboardEvent, moved: () => void): void {
    const turns: Record<string, [number, number]> = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}, turn = turns[event.key];
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (turn) this.isPlanar ? this.pan(...turn) : this.turn(...turn);
    else if (event.key === '+' || event.key === '-') this.zoom(event.key === '+' ? 1.1 : 1 / 1.1);
    else return;
    this.follow();
    this.snap();
    moved();
    event.preventDefault();
  }

  private turn(right: number, up: number): void {
    const at = this.round();
    if (this.now.up.z === 0) this.now.up.set(0, 0, 1);  // it looked down
    at.theta += 0.1 * right;
    at.phi = Math.min(Math.PI - 0.01, Math.max(0.01, at.phi - 0.1 * up));
    const away = new Vector3().setFromSpherical(at);
    this.now.position.set(away.z, away.x, away.y).add(this.controls.target);
  }

  private pan(right: number, up: number): void {
    const [x, y] = this.shift(-40 * right, 40 * up) as [number, number];
    for (const place of [this.now.position, this.controls.target]) place.set(place.x - x, place.y - y, place.z);
  }

  private zoom(by: number): void {
    if (this.isLens) this.lens.position.sub(this.controls.target).divideScalar(by).add(this.controls.target);
    else this.parallel.zoom *= by;
    this.now.updateProjectionMatrix();
  }

  /** To what a link can say, so that it shows the same. */
  private snap(): void {
    this.apply(this.text);
  }

  private follow(): void {
    this.controls.update();
    this.now.updateMatrixWorld();
  }
}
