// A tube along a polyline. Its buffers stay while the number of points does: a slider makes no garbage.
import {BufferAttribute, BufferGeometry, type Material, Mesh, Vector3} from 'three';

export class Tube extends Mesh {
  private count = 0;
  private sides = 0;
  private readonly at = new Vector3();
  private readonly ahead = new Vector3();
  private readonly side = new Vector3();
  private readonly across = new Vector3();
  private readonly turn = new Vector3();

  constructor(material: Material) {
    super(new BufferGeometry(), material);
  }

  /**
   * @param points of two or three coordinates [m]
   * @param radius [m]
   * @param end radius of the last point as a part of the others: 0 makes a point of it
   */
  set(points: number[][], radius: number, sides: number, end = 1): void {
    if (points.length !== this.count || sides !== this.sides) this.allocate(points.length, sides);
    const places = this.geometry.getAttribute('position') as BufferAttribute;
    const normals = this.geometry.getAttribute('normal') as BufferAttribute;
    this.side.set(0, 0, 0);
    for (let i = 0; i < points.length; ++i) {
      this.frame(points, i);
      const here = i === points.length - 1 ? end * radius : radius;
      for (let k = 0; k < sides; ++k) {
        const angle = (2 * Math.PI * k) / sides;
        this.turn.copy(this.side).multiplyScalar(Math.cos(angle)).addScaledVector(this.across, Math.sin(angle));
        normals.setXYZ(i * sides + k, this.turn.x, this.turn.y, this.turn.z);
        this.turn.multiplyScalar(here).add(this.at);
        places.setXYZ(i * sides + k, this.turn.x, this.turn.y, this.turn.z);
      }
    }
    places.needsUpdate = normals.needsUpdate = true;
  }

  /** Carries the frame on to a point: what is left of the last side is turned off the new tangent. */
  private frame(points: number[][], i: number): void {
    const before = points[Math.max(i - 1, 0)]!, after = points[Math.min(i + 1, points.length - 1)]!, here = points[i]!;
    this.at.set(here[0]!, here[1]!, here[2] ?? 0);
    this.ahead.set(after[0]! - before[0]!, after[1]! - before[1]!, (after[2] ?? 0) - (before[2] ?? 0));
    if (this.ahead.lengthSq() === 0) this.ahead.set(0, 0, 1);
    this.ahead.normalize();
    this.side.addScaledVector(this.ahead, -this.side.dot(this.ahead));
    if (this.side.lengthSq() < 1e-12) {
      this.side.set(Math.abs(this.ahead.x) < 0.9 ? 1 : 0, Math.abs(this.ahead.x) < 0.9 ? 0 : 1, 0);
      this.side.addScaledVector(this.ahead, -this.side.dot(this.ahead));
    }
    this.side.normalize();
    this.across.crossVectors(this.ahead, this.side);
  }

  private allocate(count: number, sides: number): void {
    this.count = count;
    this.sides = sides;
    this.geometry.dispose();
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute('position', new BufferAttribute(new Float32Array(count * sides * 3), 3));
    this.geometry.setAttribute('normal', new BufferAttribute(new Float32Array(count * sides * 3), 3));
    const index: number[] = [];
    for (let i = 0; i + 1 < count; ++i)
      for (let k = 0; k < sides; ++k) {
        const a = i * sides + k, b = i * sides + ((k + 1) % sides);
        index.push(a, b, a + sides, b, b + sides, a + sides);
      }
    this.geometry.setIndex(index);
  }
}
