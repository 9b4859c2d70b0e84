// What of a picture is under the pointer, by distances on the screen. What is not shown, and ghosts, are never found.
import type {Json} from './client';
import {leastRod} from './compose';
import {outline} from './outline';
import type {Drawing, Layer, Part} from './picture';
import {placeOf, plus, type Point} from './vector';

type Project = (point: Point) => [number, number];

/** A part, and where along it: where its name is pinned. */
export interface Found { part: Part; along: number }

const reach = 7;  // pixels beside a thin line that are still on it

/** Distance to a polyline, and where along it, as a count of points. */
function toLine(x: number, y: number, points: Point[], project: Project): [number, number] {
  let best: [number, number] = [Infinity, 0], [ax, ay] = project(points[0]!);
  for (let i = 1; i < points.length; ++i) {
    const [bx, by] = project(points[i]!), [dx, dy] = [bx - ax, by - ay], square = dx * dx + dy * dy;
    const t = square > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / square)) : 0, distance = Math.hypot(x - ax - t * dx, y - ay - t * dy);
    if (distance < best[0]) best = [distance, i - 1 + t];
    [ax, ay] = [bx, by];
  }
  return best;
}

function isInside(x: number, y: number, points: [number, number][]): boolean {
  let inside = false;
  points.forEach(([ax, ay], i) => {
    const [bx, by] = points[(i + 1) % points.length]!;
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) inside = !inside;
  });
  return inside;
}

/** Where the platform's reference point, or the tip, is. */
export function reference(shape: Json): Point | null {
  const last = shape.frames?.at(-1);
  return last ? placeOf(last) : null;
}

/** Whether the pointer is on the platform: in its outline, or near its reference point. */
export function isOnPlatform(x: number, y: number, shape: Json, project: Project): boolean {
  const plate: Point[] = shape.platform ?? [], place = reference(shape);
  if (plate.length > 2 && isInside(x, y, outline(plate).map(project))) return true;
  if (!place) return false;
  const [px, py] = project(place);
  return Math.hypot(px - x, py - y) < 14;
}

function lineOf({shape}: Drawing, {kind, index, tendon}: Part): Point[] | undefined {
  return kind === 'backbone' ? shape.backbones[index] : kind === 'line' ? shape.lines?.[index] : kind === 'tendon' ? shape.tendons?.[index]?.[tendon ?? 0] : undefined;
}

/** The part nearest to the pointer. @param pixels of a metre */
export function partAt(x: number, y: number, drawing: Drawing, shown: ReadonlySet<Layer>, project: Project, pixels: number): Found | null {
  const {shape, struts, radius} = drawing, thick = Math.max(reach, radius * pixels + leastRod);
  const body = shown.has('discs') ? Math.max(0, ...(shape.discs ?? []).map((disc: Json) => disc.radius * pixels)) : 0;
  let best: (Found & {beyond: number}) | null = null;
  const add = (part: Part, within: number) => {
    const points = lineOf(drawing, part);
    if (!points || points.length < 2) return;
    const [distance, along] = toLine(x, y, points, project), beyond = distance / within;
    if (distance <= within && (!best || beyond < best.beyond)) best = {part, along, beyond};
  };
  shape.backbones.forEach((_: Point[], index: number) => shown.has('rods') && add({kind: 'backbone', index}, Math.max(thick, body)));
  (shape.lines ?? []).forEach((_: Point[], index: number) => (shown.has('lines') || (struts[index] && shown.has('rods'))) && add({kind: 'line', index}, thick));
  (shape.tendons ?? []).forEach((of: Point[][], index: number) => shown.has('tendons') && of.forEach((_, tendon) => add({kind: 'tendon', index, tendon}, reach)));
  if (best) return best;
  return (shape.platform?.length ?? 0) > 2 && isInside(x, y, outline(shape.platform).map(project)) ? {part: {kind: 'platform', index: 0}, along: 0} : null;
}

/** Where what was found is now; null where the drawing has no such part. */
export function pointOf(drawing: Drawing, {part, along}: Found): Point | null {
  if (part.kind === 'platform') return reference(drawing.shape);
  const points = lineOf(drawing, part), i = Math.min(Math.floor(along), (points?.length ?? 0) - 2);
  if (!points || i < 0) return null;
  const [a, b] = [points[i]!, points[i + 1]!], t = Math.min(along - i, 1);
  return plus(plus([0, 0, 0], a, 1 - t), b, t);
}
