// The pen of WebGL. Its objects are used again at the next drawing: a slider that moves makes little garbage.
import {BufferGeometry, CylinderGeometry, DoubleSide, DynamicDrawUsage, Float32BufferAttribute, GreaterDepth, Group, InstancedMesh, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, Quaternion, Vector3} from 'three';
import type {Json} from './client';
import {Ink, uniforms} from './ink';
import type {Look, Pen} from './pen';
import {axesOf, plus, type Point} from './vector';

const around = 2 * Math.PI;

export class GlPen implements Pen {
  readonly group = new Group();
  isCoarse = false;
  private readonly shared = uniforms();
  private readonly ink = new Ink(this.shared);
  private readonly above = new Ink(this.shared);
  private readonly plates: Mesh<BufferGeometry, MeshBasicMaterial>[] = [];
  private plateCount = 0;
  private discs = this.makeDiscs(1);
  private ghosts = this.makeGhosts();  // the discs again, where solids hide them
  private discCount = 0;
  private readonly matrix = new Matrix4();
  private readonly place = new Vector3();
  private readonly turn = new Quaternion();
  private readonly size = new Vector3();

  constructor() {
    this.above.material.depthTest = false;
    this.above.material.depthWrite = false;
    this.ink.renderOrder = 1;
    this.above.renderOrder = 3;
    this.group.add(this.ink, this.above);
  }

  /** @param ratio dots of the screen a pixel @param scale pixels a metre @param behind depth of a pixel */
  resize(width: number, height: number, ratio: number, scale: number, behind: number): void {
    this.shared.size.value.set(width, height);
    this.shared.ratio.value = ratio;
    this.shared.scale.value = scale;
    this.shared.behind.value = behind;
  }

  begin(isPlanar: boolean, pixels: number): void {
    for (const plate of this.plates) plate.renderOrder = isPlanar ? 0 : 2;
    this.ink.material.depthTest = !isPlanar;  // in a plane what is drawn later lies above
    this.ink.tolerance = this.isCoarse ? 0.6 : 0.15;
    this.ink.begin(pixels);
    this.above.begin(pixels);
    this.plateCount = this.discCount = 0;
  }

  line(points: Point[], look: Look, isClosed = false): void {
    this.of(look).line(points, look, isClosed);
  }

  circle(middle: Point, u: Point, v: Point, radius: number, look: Look, turn = around): void {
    this.of(look).circle(middle, u, v, radius, look, turn);
  }

  head(from: Point, to: Point, look: Look): void {
    this.of(look).head(from, to, look);
  }

  dot(point: Point, look: Look): void {
    this.of(look).dot(point, look, 6);
  }

  fill(points: Point[], {colour, opacity = 1}: Look): void {
    const plate = this.plates[this.plateCount++] ?? this.makePlate(), count = points.length, places = plate.geometry.getAttribute('position');
    plate.visible = true;
    plate.material.color.set(colour);
    plate.material.opacity = opacity;
    if (places?.count !== count) {
      plate.geometry.dispose();
      plate.geometry.setIndex(Array.from({length: count - 2}, (_, i) => [0, i + 1, i + 2]).flat());
      plate.geometry.setAttribute('position', new Float32BufferAttribute(points.flatMap(([x, y, z = 0]) => [x!, y!, z]), 3));
      return;
    }
    points.forEach(([x, y, z = 0], i) => places.setXYZ(i, x!, y!, z));
    places.needsUpdate = true;
  }

  disc({pose, height, radius}: Json, body: string, rim: string, hidden?: string): void {
    const axes = axesOf(pose), look: Look = {colour: rim, width: 1};
    this.ink.circle(pose.position, axes[0], axes[1], radius, look, around);
    this.ink.circle(plus(pose.position, axes[2], height), axes[0], axes[1], radius, look, around);
    if (this.isCoarse) return;
    if (this.discCount >= this.discs.instanceMatrix.count) this.growDiscs();
    const [w, x, y, z] = pose.quaternion;
    this.discs.material.color.set(body);
    this.matrix.compose(this.place.fromArray(pose.position), this.turn.set(x, y, z, w), this.size.set(radius, radius, height));
    this.ghosts.visible = hidden !== undefined;
    if (hidden) this.ghosts.material.color.set(hidden);
    this.discs.setMatrixAt(this.discCount++, this.matrix);
  }

  end(): void {
    this.ink.end();
    this.above.end();
    this.plates.forEach((plate, i) => { plate.visible = i < this.plateCount; });
    this.discs.count = this.discCount;
    this.discs.visible = this.discCount > 0;
    this.discs.instanceMatrix.needsUpdate = true;
    this.ghosts.count = this.discCount;
    this.ghosts.visible &&= this.discCount > 0;
  }

  private of(look: Look): Ink {
    return look.isAbove ? this.above : this.ink;
  }

  /** Behind what lies in it: an outline is not to fight with its inside. */
  private makePlate(): Mesh<BufferGeometry, MeshBasicMaterial> {
    const plate = new Mesh(new BufferGeometry(), new MeshBasicMaterial({transparent: true, side: DoubleSide, depthWrite: false, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4}));
    plate.frustumCulled = false;
    plate.renderOrder = this.ink.material.depthTest ? 2 : 0;
    this.plates.push(plate);
    this.group.add(plate);
    return plate;
  }

  private makeDiscs(count: number): InstancedMesh<CylinderGeometry, MeshLambertMaterial> {
    const shape = new CylinderGeometry(1, 1, 1, 24);
    shape.rotateX(Math.PI / 2);
    shape.translate(0, 0, 0.5);
    const discs = new InstancedMesh(shape, new MeshLambertMaterial({polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4}), count);
    discs.instanceMatrix.setUsage(DynamicDrawUsage);
    discs.frustumCulled = false;
    this.group.add(discs);
    return discs;
  }

  /** They are drawn after solids and before the discs, so that discs themselves hide none. */
  private makeGhosts(): InstancedMesh<CylinderGeometry, MeshBasicMaterial> {
    const ghosts = new InstancedMesh(this.discs.geometry, new MeshBasicMaterial({depthFunc: GreaterDepth, depthWrite: false}), 0);
    ghosts.instanceMatrix = this.discs.instanceMatrix;
    [ghosts.frustumCulled, ghosts.renderOrder, ghosts.visible] = [false, -1, false];
    this.group.add(ghosts);
    return ghosts;
  }

  private growDiscs(): void {
    const old = this.discs;
    this.discs = this.makeDiscs(2 * this.discCount);
    this.discs.instanceMatrix.array.set(old.instanceMatrix.array);
    this.group.remove(old);
    old.geometry.dispose();
    old.material.dispose();
    old.dispose();
    this.group.remove(this.ghosts);
    this.ghosts.material.dispose();
    this.ghosts = this.makeGhosts();
  }
}
