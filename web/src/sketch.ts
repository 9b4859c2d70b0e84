// A picture by SVG: small ones beside numbers.
import type {Json} from './client';
import {outline, ring} from './outline';

const space = 'http://www.w3.org/2000/svg';

/** From the side and a little from above; planar ones from above. */
export const flat = (isPlanar: boolean, azimuth = -1.0, elevation = 0.35) => {
  const [c, s, ce, se] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(elevation), Math.sin(elevation)];
  return (point: number[]): [number, number] => {
    const [x, y, z] = [point[0]!, point[1]!, point[2] ?? 0];
    return isPlanar ? [x, -y] : [-s * x + c * y, se * (c * x + s * y) - ce * z];
  };
};

export interface Stroke { kind: 'rod' | 'plate' | 'base' | 'tendon' | 'ghost'; points: number[][]; isClosed: boolean }

/** The lines of a picture, those behind first. */
export function strokes(shape: Json, isPlanar: boolean): Stroke[] {
  const list: Stroke[] = [], base = shape.base as number[][] | undefined, plate = shape.platform as number[][] | undefined;
  if (base && base.length > 1) list.push({kind: 'base', points: isPlanar ? outline(base) : ring(base), isClosed: true});
  for (const points of (shape.lines ?? []) as number[][][]) list.push({kind: 'tendon', points, isClosed: false});
  for (const points of shape.backbones as number[][][]) if (points.length > 1) list.push({kind: 'rod', points, isClosed: false});
  if (plate && plate.length > 1) list.push({kind: 'plate', points: outline(plate), isClosed: true});
  return list;
}

export function draw(svg: SVGElement, list: Stroke[], project: (point: number[]) => [number, number], width: (kind: Stroke['kind']) => number): void {
  svg.replaceChildren(...list.map(({kind, points, isClosed}) => {
    const path = document.createElementNS(space, 'path');
    path.setAttribute('d', `M${points.map((point) => project(point).map((part) => part.toPrecision(5)).join(' ')).join('L')}${isClosed ? 'Z' : ''}`);
    path.setAttribute('class', `sk-${kind}`);
    path.setAttribute('stroke-width', String(width(kind)));
    path.setAttribute('stroke-linejoin', 'round');
    if (kind === 'ghost') path.setAttribute('stroke-dasharray', '4 3');
    return path;
  }));
}

/** The window of the drawing that holds all points, with some room. */
export function bounds(list: Stroke[], project: (point: number[]) => [number, number]): {x: number; y: number; width: number; height: number} {
  const all = list.flatMap(({points}) => points.map(project)), xs = all.map(([x]) => x), ys = all.map(([, y]) => y);
  const [x, y] = [Math.min(...xs), Math.min(...ys)];
  return {x, y, width: Math.max(...xs) - x, height: Math.max(...ys) - y};
}

export function make(): SVGElement {
  const svg = document.createElementNS(space, 'svg');
  svg.setAttribute('aria-hidden', 'true');
  return svg;
}

/** A small picture of a robot. */
export function sketch(shape: Json, isPlanar: boolean, {width, height}: {width: number; height: number}): SVGElement {
  const svg = make(), project = flat(isPlanar), list = strokes(shape, isPlanar), box = bounds(list, project), room = 6;
  const scale = Math.min((width - 2 * room) / Math.max(box.width, 1e-9), (height - 2 * room) / Math.max(box.height, 1e-9));
  const at = (point: number[]): [number, number] => {
    const [x, y] = project(point);
    return [width / 2 + scale * (x - box.x - box.width / 2), height / 2 + scale * (y - box.y - box.height / 2)];
  };
  svg.setAttribute('width', String(width));
  svg.setAttribute('height', String(height));
  draw(svg, list, at, (kind) => (kind === 'rod' ? 1.8 : kind === 'plate' ? 1.4 : 0.8));
  return svg;
}
