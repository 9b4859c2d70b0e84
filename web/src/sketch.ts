// Small pictures of robots, beside numbers and on the start screen: few strokes, coloured by the page's classes.
import {Camera} from './camera';
import type {Json} from './client';
import {extent} from './compose';
import {outline, ring} from './outline';
import {makeSvg, path, shapeOf} from './svg_pen';
import type {Point} from './vector';

const room = 7;  // pixels between the robot and the edges

export function sketch(shape: Json, isPlanar: boolean, {width, height}: {width: number; height: number}): SVGElement {
  const svg = makeSvg(), camera = new Camera(), isSmall = Math.min(width, height) < 100, rod = isSmall ? 1.6 : 2;
  const base: Point[] = shape.base ?? [], plate: Point[] = shape.platform ?? [], backbones = (shape.backbones as Point[][]).filter((points) => points.length > 1);
  camera.isPlanar = isPlanar;
  camera.margin = room;
  camera.resize(width, height);
  camera.fit(extent(shape), undefined, [0, 0, 1]);
  const stroke = (kind: string, points: Point[], pixels: number, isClosed = false) =>
    svg.append(shapeOf('path', {class: `sk-${kind}`, d: path(points.map((point) => camera.project(point)), isClosed), 'stroke-width': pixels.toFixed(2), 'stroke-linejoin': 'round'}));
  svg.setAttribute('width', String(width));
  svg.setAttribute('height', String(height));
  if (base.length > 1) stroke('base', isPlanar ? outline(base) : ring(base), 1, true);
  const radius = Math.max(0, ...(shape.discs ?? []).map((disc: Json) => disc.radius));
  if (radius > 0) for (const points of backbones) stroke('body', points, Math.max(2 * radius * camera.pixels, 2 * rod));
  const hasRoom = !isSmall && (radius === 0 || 2 * radius * camera.pixels > 20);  // else tendons run together
  if (hasRoom) for (const points of ((shape.tendons ?? []) as Point[][][]).flat()) if (points.length > 1) stroke('tendon', points, 0.8);
  for (const points of (shape.lines ?? []) as Point[][]) stroke(isRigid(shape, points) ? 'rod' : 'tendon', points, isRigid(shape, points) ? rod : 0.8);
  for (const points of backbones) stroke('rod', points, rod);
  if (plate.length > 1) stroke('plate', outline(plate), 1.5, true);
  for (const point of base) {
    const [cx, cy] = camera.project(point);
    svg.append(shapeOf('circle', {class: 'sk-point', cx: cx.toFixed(2), cy: cy.toFixed(2), r: isSmall ? 1.8 : 2.5, 'stroke-width': 1.2}));
  }
  return svg;
}

/** A line that goes on where a backbone ends is a strut: it is drawn as the rod it is. */
function isRigid({backbones}: Json, [a]: Point[]): boolean {
  return (backbones as Point[][]).some((points) => points.length > 1 && points.at(-1)!.every((part, k) => Math.abs(part - a![k]!) < 1e-9));
}
