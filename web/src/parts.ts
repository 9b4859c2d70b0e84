// Parts of a picture that are used again at the next drawing: a slider that moves makes no garbage.
import {
  type BufferGeometry, CylinderGeometry, DoubleSide, Float32BufferAttribute, Group, Line, LineBasicMaterial, LineDashedMaterial, LineLoop, Mesh, MeshBasicMaterial,
  MeshLambertMaterial, type Object3D, Quaternion, SphereGeometry, BufferGeometry as Geometry,
} from 'three';
import type {Json} from './client';
import {Tube} from './tube';

export interface Look { colour: string; opacity?: number; dash?: [number, number] }

/** Objects of one kind in the order they are drawn; those that a drawing does not need are hidden. */
class Pool<T extends Object3D & {geometry: BufferGeometry}> {
  private readonly all: T[] = [];
  private used = 0;

  constructor(private readonly group: Group, private readonly make: () => T) {}

  begin(): void {
    this.used = 0;
  }

  next(): T {
    let one = this.all[this.used++];
    if (!one) {
      one = this.make();
      one.frustumCulled = false;
      this.all.push(one);
      this.group.add(one);
    }
    one.visible = true;
    return one;
  }

  end(): void {
    this.all.slice(this.used).forEach((one) => { one.visible = false; });
  }

  clear(): void {
    for (const one of this.all) {
      this.group.remove(one);
      one.geometry.dispose();
    }
    this.all.length = 0;
  }
}

const flatten = (points: number[][]) => points.flatMap((point) => [point[0]!, point[1]!, point[2] ?? 0]);

function put(geometry: BufferGeometry, points: number[][]): void {
  const old = geometry.getAttribute('position');
  if (old?.count === points.length) {
    (old.array as Float32Array).set(flatten(points));
    old.needsUpdate = true;
  } else {
    geometry.setAttribute('position', new Float32BufferAttribute(flatten(points), 3));
  }
}

/** What a layer of a picture consists of. */
export class Parts {
  readonly group = new Group();
  sides = 12;
  hasCaps = true;
  private readonly tubes = new Pool(this.group, () => new Tube(new MeshLambertMaterial({transparent: true})));
  private readonly lines = new Pool(this.group, () => new Line(new Geometry(), new LineBasicMaterial({transparent: true})));
  private readonly dashed = new Pool(this.group, () => new Line(new Geometry(), new LineDashedMaterial({transparent: true})));
  private readonly loops = new Pool(this.group, () => new LineLoop(new Geometry(), new LineBasicMaterial({transparent: true})));
  private readonly plates = new Pool(this.group, () => new Mesh(new Geometry(), new MeshBasicMaterial({transparent: true, side: DoubleSide, depthWrite: false})));
  private readonly discs = new Pool(this.group, () => new Mesh(this.disc(), new MeshLambertMaterial({transparent: true, side: DoubleSide})));
  private readonly dots = new Pool(this.group, () => new Mesh(new SphereGeometry(1, 12, 8), new MeshBasicMaterial()));
  private readonly pools = [this.tubes, this.lines, this.dashed, this.loops, this.plates, this.discs, this.dots];

  begin(): void {
    for (const pool of this.pools) pool.begin();
  }

  end(): void {
    for (const pool of this.pools) pool.end();
  }

  clear(): void {
    for (const pool of this.pools) pool.clear();
  }

  tube(points: number[][], radius: number, {colour, opacity = 1}: Look): void {
    const tube = this.tubes.next(), material = tube.material as MeshLambertMaterial;
    material.color.set(colour);
    material.opacity = opacity;
    tube.set(points, radius, this.sides);
  }

  line(points: number[][], {colour, opacity = 1, dash}: Look): void {
    const line = dash ? this.dashed.next() : this.lines.next();
    line.material.color.set(colour);
    line.material.opacity = opacity;
    put(line.geometry, points);
    if (!dash) return;
    [(line.material as LineDashedMaterial).dashSize, (line.material as LineDashedMaterial).gapSize] = dash;
    line.computeLineDistances();
  }

  loop(points: number[][], {colour, opacity = 1}: Look): void {
    const loop = this.loops.next();
    loop.material.color.set(colour);
    loop.material.opacity = opacity;
    put(loop.geometry, points);
  }

  /** The inside of an outline that bends nowhere inwards. */
  plate(points: number[][], {colour, opacity = 1}: Look): void {
    const plate = this.plates.next(), count = points.length;
    plate.material.color.set(colour);
    plate.material.opacity = opacity;
    if (plate.geometry.getAttribute('position')?.count !== count)
      plate.geometry.setIndex(Array.from({length: count - 2}, (_, i) => [0, i + 1, i + 2]).flat());
    put(plate.geometry, points);
  }

  dot(point: number[], radius: number, {colour}: Look): void {
    const dot = this.dots.next();
    dot.material.color.set(colour);
    dot.position.set(point[0]!, point[1]!, point[2] ?? 0);
    dot.scale.setScalar(radius);
  }

  /** Of an answer to `shape`: the pose of its lower face, height and radius. */
  roll({pose, height, radius}: Json, {colour, opacity = 1}: Look): void {
    const disc = this.discs.next(), [w, x, y, z] = pose.quaternion;
    disc.material.color.set(colour);
    disc.material.opacity = opacity;
    disc.position.set(pose.position[0], pose.position[1], pose.position[2]);
    disc.setRotationFromQuaternion(new Quaternion(x, y, z, w));
    disc.scale.set(radius, radius, height);
  }

  /** A line with a head. @param length of the head */
  arrow(from: number[], to: number[], radius: number, head: number, look: Look): void {
    const way = to.map((part, i) => part - (from[i] ?? 0)), size = Math.hypot(...way);
    if (size < 1e-12) return;
    const neck = to.map((part, i) => part - (way[i]! * Math.min(head, 0.6 * size)) / size), cone = this.tubes.next();
    this.tube([from, neck], radius, look);
    (cone.material as MeshLambertMaterial).color.set(look.colour);
    (cone.material as MeshLambertMaterial).opacity = look.opacity ?? 1;
    cone.set([neck, to], 3.2 * radius, this.sides, 0);
  }

  private disc(): CylinderGeometry {
    const shape = new CylinderGeometry(1, 1, 1, 20, 1, !this.hasCaps);
    shape.rotateX(Math.PI / 2);
    shape.translate(0, 0, 0.5);
    return shape;
  }
}
