// Shapes of states: a disc, a triangle, an octagon with a cross, a square with a slash, a dotted ring. Colours come from the style sheet.
import type {Kind} from './frame';
import {type Pixel, svg, text} from './svg';

const corners = (count: number, radius: number, x: number, y: number, from: number): Pixel[] =>
  Array.from({length: count}, (_, i) => {
    const angle = from + (2 * Math.PI * i) / count;
    return [x + radius * Math.cos(angle), y + radius * Math.sin(angle)];
  });

export function mark(kind: Kind, x: number, y: number, radius: number): SVGGElement {
  const group = svg('g', {class: `mark-of ${kind}`}), r = radius;
  if (kind === 'exact') group.append(svg('circle', {class: 'body', cx: x, cy: y, r: 0.9 * r}));
  if (kind === 'slack') group.append(svg('polygon', {class: 'body', points: text([[x - r, y - 0.8 * r], [x + r, y - 0.8 * r], [x, y + 0.95 * r]])}));
  if (kind === 'over') group.append(svg('polygon', {class: 'body', points: text(corners(8, 1.06 * r, x, y, Math.PI / 8))}), cross(x, y, 0.42 * r));
  if (kind === 'unreachable') {
    const h = 0.85 * r;
    group.append(svg('rect', {class: 'body', x: x - h, y: y - h, width: 2 * h, height: 2 * h}), svg('line', {class: 'body', x1: x - h, y1: y + h, x2: x + h, y2: y - h}));
  }
  if (kind === 'stale') group.append(svg('circle', {class: 'body', cx: x, cy: y, r: 0.95 * r}), svg('text', {x, y: y + 0.48 * r, 'font-size': 1.35 * r, 'text-anchor': 'middle'}, '?'));
  return group;
}

const cross = (x: number, y: number, h: number): SVGPathElement => svg('path', {class: 'cross', d: `M${x - h} ${y - h}L${x + h} ${y + h}M${x - h} ${y + h}L${x + h} ${y - h}`});

/** Alone, beside a word that says the same. */
export function icon(kind: Kind, size = 18): SVGSVGElement {
  return svg('svg', {class: 'icon', width: size, height: size, viewBox: `0 0 ${size} ${size}`, 'aria-hidden': 'true'}, mark(kind, size / 2, size / 2, size / 2 - 1.5));
}

/** A tendon's number in its colour. */
export function tag(tendon: number, x: number, y: number, radius: number): SVGGElement {
  return svg('g', {class: `tag tendon-${(tendon % 4) + 1}`}, svg('circle', {cx: x, cy: y, r: radius}), svg('text', {x, y: y + 4, 'text-anchor': 'middle'}, String(tendon + 1)));
}

export const tagAlone = (tendon: number): SVGSVGElement => svg('svg', {class: 'icon', width: 18, height: 18, viewBox: '0 0 18 18', 'aria-hidden': 'true'}, tag(tendon, 9, 9, 8));
