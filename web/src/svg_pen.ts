// The pen of SVG: shapes in the order they are drawn, without depth.
import type {Json} from './client';
import type {Look, Pen} from './pen';
import {axesOf, plus, type Point} from './vector';

const space = 'http://www.w3.org/2000/svg';
type Project = (point: Point) => [number, number];

export function makeSvg(): SVGSVGElement {
  const svg = document.createElementNS(space, 'svg');
  svg.setAttribute('aria-hidden', 'true');
  return svg;
}

/** With two places after the point: SVG of a robot is read often, and never nearer. */
export const path = (points: [number, number][], isClosed: boolean) => `M${points.map(([x, y]) => `${x.toFixed(2)} ${y.toFixed(2)}`).join('L')}${isClosed ? 'Z' : ''}`;

export function shapeOf(name: 'path' | 'circle' | 'rect', attributes: Record<string, string | number>): SVGElement {
  const shape = document.createElementNS(space, name);
  for (const [key, value] of Object.entries(attributes)) shape.setAttribute(key, String(value));
  return shape;
}

export class SvgPen implements Pen {
  private shapes: SVGElement[] = [];
  private pixels = 1;

  constructor(private readonly svg: SVGSVGElement, private readonly project: Project) {}

  begin(_isPlanar: boolean, pixels: number): void {
    this.shapes = [];
    this.pixels = pixels;
  }

  line(points: Point[], look: Look, isClosed = false): void {
    this.add(points, isClosed, {fill: 'none', ...this.stroke(look)});
  }

  circle(middle: Point, u: Point, v: Point, radius: number, look: Look, turn = 2 * Math.PI): void {
    this.add(this.round(middle, u, v, radius, turn), false, {fill: 'none', ...this.stroke(look)});
  }

  head(from: Point, to: Point, {colour, width = 1}: Look): void {
    const [[ax, ay], [bx, by]] = [this.project(from), this.project(to)], size = Math.hypot(bx - ax, by - ay) || 1, [x, y] = [(-(by - ay) * width) / size / 2, ((bx - ax) * width) / size / 2];
    this.shapes.push(shapeOf('path', {d: path([[ax + x, ay + y], [bx, by], [ax - x, ay - y]], true), fill: colour}));
  }

  dot(point: Point, {colour, width = 1}: Look): void {
    const [cx, cy] = this.project(point);
    this.shapes.push(shapeOf('circle', {cx: cx.toFixed(2), cy: cy.toFixed(2), r: width / 2, fill: colour}));
  }

  fill(points: Point[], {colour, opacity = 1}: Look): void {
    this.add(points, true, {fill: colour, 'fill-opacity': opacity});
  }

  disc({pose, height, radius}: Json, body: string, rim: string): void {
    const [u, v, w] = axesOf(pose);
    for (const middle of [pose.position, plus(pose.position, w, height)])
      this.add(this.round(middle, u, v, radius, 2 * Math.PI), true, {fill: body, stroke: rim, 'stroke-width': 1});
  }

  end(): void {
    this.svg.replaceChildren(...this.shapes);
  }

  private round(middle: Point, u: Point, v: Point, radius: number, turn: number): Point[] {
    return Array.from({length: 25}, (_, i) => plus(plus(middle, u, radius * Math.cos((turn * i) / 24)), v, radius * Math.sin((turn * i) / 24)));
  }

  private stroke({colour, width = 1, diameter = 0, dash, opacity = 1}: Look): Record<string, string | number> {
    return {
      stroke: colour, 'stroke-width': Math.max(width, diameter * this.pixels).toFixed(2), 'stroke-linejoin': 'round', 'stroke-linecap': dash ? 'butt' : 'round',
      ...(dash && {'stroke-dasharray': dash.join(' ')}), ...(opacity < 1 && {'stroke-opacity': opacity}),
    };
  }

  private add(points: Point[], isClosed: boolean, attributes: Record<string, string | number>): void {
    this.shapes.push(shapeOf('path', {d: path(points.map(this.project), isClosed), ...attributes}));
  }
}
