// Solids by WebGL: shaded, with their edges, and cut open before the tip, so that one sees the robot between them. Where a solid
// is cut its inside is drawn in one colour, without light: so it looks full.
import {BackSide, BufferAttribute, BufferGeometry, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, Plane} from 'three';
import type {Solids} from './picture';
import {dot, type Point} from './vector';

const sharp = 25;              // angle from which an edge is drawn [deg]
const mostForEdges = 100_000;  // triangles: finding edges takes a second of so many

export class Surfaces extends Group {
  private readonly plane = new Plane();
  private readonly outside = new MeshLambertMaterial({flatShading: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2});
  private readonly inside = new MeshBasicMaterial({side: BackSide});
  private readonly marking = new MeshLambertMaterial({flatShading: true, polygonOffset: true, polygonOffsetFactor: 0.5, polygonOffsetUnits: 1});
  private readonly lines = new LineBasicMaterial();
  private readonly all: BufferGeometry;
  private readonly marked: Mesh<BufferGeometry, MeshLambertMaterial>;
  private readonly back: Mesh;
  private readonly firsts: number[] = [];  // triangle of each solid

  constructor(private readonly solids: Solids) {
    super();
    const {positions, indices, counts} = solids, geometry = () => {
      const made = new BufferGeometry();
      made.setAttribute('position', places);
      made.setIndex(corners);
      return made;
    }, places = new BufferAttribute(positions, 3), corners = new BufferAttribute(indices, 1);
    counts.reduce((sum, count) => (this.firsts.push(sum), sum + count), 0);
    this.all = geometry();
    this.marked = new Mesh(geometry(), this.marking);
    this.back = new Mesh(this.all, this.inside);
    this.add(new Mesh(this.all, this.outside), this.back, this.marked);
    if (indices.length / 3 <= mostForEdges) this.add(new LineSegments(new EdgesGeometry(this.all, sharp), this.lines));
    for (const child of this.children) [child.frustumCulled, child.renderOrder] = [false, -2];  // first: what of a robot they hide is drawn pale
  }

  paint(style: CSSStyleDeclaration): void {
    const token = (name: string) => style.getPropertyValue(`--${name}`).trim();
    this.outside.color.set(token('solid'));
    this.inside.color.set(token('cut'));
    this.lines.color.set(token('edge'));
    this.marking.color.set(token('bad-solid'));
  }

  /** The one that is touched; −1: none. */
  mark(solid: number): void {
    this.marked.visible = solid >= 0;
    if (solid >= 0) this.marked.geometry.setDrawRange(3 * this.firsts[solid]!, 3 * this.solids.counts[solid]!);
  }

  /** What lies nearer to the eye than a point is left out. @param back towards the eye; null: nothing is cut */
  cut(at: Point | null, back: Point): void {
    this.back.visible = !!at;
    for (const material of [this.outside, this.inside, this.marking, this.lines]) material.clippingPlanes = at ? [this.plane] : null;
    if (!at) return;
    this.plane.normal.set(-back[0]!, -back[1]!, -(back[2] ?? 0));
    this.plane.constant = dot(at, back);
  }

  free(): void {
    for (const child of this.children) (child as Mesh).geometry.dispose();
    for (const material of [this.outside, this.inside, this.marking, this.lines]) material.dispose();
  }
}
