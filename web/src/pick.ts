// What of a picture is under the pointer, by distances on the screen.
import type {Json} from './client';
import {outline} from './outline';
import type {Part} from './picture';

type Project = (point: number[]) => [number, number];

function toSegment(x: number, y: number, [ax, ay]: [number, number], [bx, by]: [number, number]): number {
  const [dx, dy] = [bx - ax, by - ay], square = dx * dx + dy * dy;
  const t = square > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / square)) : 0;
  return Math.hypot(x - ax - t * dx, y - ay - t * dy);
}

function toLine(x: number, y: number, points: number[][], project: Project): number {
  const on = points.map(project);
  return on.slice(1).reduce((best, point, i) => Math.min(best, toSegment(x, y, on[i]!, point)), Infinity);
}

function isInside(x: number, y: number, points: [number, number][]): boolean {
  let inside = false;
  points.forEach(([ax, ay], i) => {
    const [bx, by] = points[(i + 1) % points.length]!;
    if (ay > y !== by > y && x < ((bx - ax) * (y - ay)) / (by - ay) + ax) inside = !inside;
  });
  return inside;
}

/** Whether the pointer is on the platform: in its outline, or near its reference point. */
export function isOnPlatform(x: number, y: number, shape: Json, place: number[] | null, project: Project): boolean {
  const plate: number[][] = shape.platform ?? [];
  if (plate.length > 2 && isInside(x, y, outline(plate).map(project))) return true;
  if (!place) return false;
  const [px, py] = project(place);
  return Math.hypot(px - x, py - y) < 14;
}

/** The part nearest to the pointer, within so many pixels. */
export function partAt(x: number, y: number, shape: Json, project: Project, reach = 7): Part | null {
  const found: {part: Part; distance: number}[] = [];
  const add = (part: Part, points: number[][]) => points.length > 1 && found.push({part, distance: toLine(x, y, points, project)});
  (shape.backbones as number[][][]).forEach((points, index) => add({kind: 'backbone', index}, points));
  ((shape.lines ?? []) as number[][][]).forEach((points, index) => add({kind: 'line', index}, points));
  ((shape.tendons ?? []) as number[][][][]).forEach((of, index) => of.forEach((points, tendon) => add({kind: 'tendon', index, tendon}, points)));
  const best = found.reduce<(typeof found)[number] | null>((least, one) => (!least || one.distance < least.distance ? one : least), null);
  if (best && best.distance < reach) return best.part;
  return (shape.platform?.length ?? 0) > 2 && isInside(x, y, outline(shape.platform).map(project)) ? {kind: 'platform', index: 0} : null;
}
