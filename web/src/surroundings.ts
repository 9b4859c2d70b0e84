// What is around a robot that goes in: its port, its target, the way of its tip, where it is nearest to a solid.
import type {Setting} from './compose';
import type {Labels} from './labels';
import type {Look, Pen} from './pen';
import type {Around, Tube} from './picture';
import {across, length, minus, plus, scaled} from './vector';

const leastRing = 7;  // pixels of the target's radius
const beside = 44;    // pixels from a tube to the middle of its name

export function surroundings({trail, target, port, axis, near}: Around, pen: Pen, labels: Labels, {colours, pixels}: Setting): void {
  const metres = 1 / pixels, target_look = {colour: colours.exact, width: 2, isAbove: true};
  if (port) {
    const [u, v] = across(axis);
    pen.circle(port.position, u, v, port.radius, {colour: colours.text, width: 1.5, isAbove: true});
  }
  for (const piece of trail) if (piece.length > 1) pen.line(piece, {colour: colours.accent, width: 1.6, dash: [2, 4], isAbove: true});
  if (target) aimedAt(target, axis, pen, metres, target_look);
  if (!near) return;
  const colour = near.isBad ? colours.over : colours.text;
  if (length(minus(near.from, near.to)) > 0) pen.line([near.from, near.to], {colour, width: 2.5, isAbove: true});
  pen.dot(near.to, {colour: colours.card, width: 9, isAbove: true});
  pen.dot(near.to, {colour, width: 7, isAbove: true});
  labels.put(near.says, near.to, near.isBad ? 'near bad' : 'near');
}

function aimedAt(target: NonNullable<Around['target']>, axis: number[], pen: Pen, metres: number, target_look: Look): void {
  const [u, v] = across(target.direction ?? axis), radius = Math.max(target.tolerance, leastRing * metres);
  pen.circle(target.tip, u, v, radius, target_look);
  for (const way of [u, v]) for (const sign of [1, -1]) pen.line([plus(target.tip, way, 0.4 * sign * radius), plus(target.tip, way, 1.6 * sign * radius)], target_look);
  if (target.direction) {
    const end = plus(target.tip, target.direction, 30 * metres);
    pen.line([target.tip, end], target_look);
    pen.head(end, plus(end, target.direction, 8 * metres), {...target_look, width: 8});
  }
}

/** Rings at its ends, and lines along it. */
export function tubeAround({from, to, shaft, axis, radius}: Tube, pen: Pen, labels: Labels, {colours, pixels}: Setting): void {
  const [u, v] = across(axis), sides = 12;
  for (const [end, width] of [[from, 1], [to, 2]] as const) pen.circle(end, u, v, radius, {colour: colours.mute, width});
  for (let i = 0; i < sides; ++i) {
    const way = plus(scaled(u, radius * Math.cos((2 * Math.PI * i) / sides)), v, radius * Math.sin((2 * Math.PI * i) / sides));
    pen.line([plus(from, way), plus(to, way)], {colour: colours.line, width: 1});
  }
  pen.line([from, shaft], {colour: colours.mute, width: 3});
  labels.put('guide tube', plus(scaled(plus(from, to), 0.5), v, -(radius + beside / pixels)), 'tube');
}
