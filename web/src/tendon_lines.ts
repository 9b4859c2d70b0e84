// Tendons as they are drawn where it is known how they pull: by colour and width, and what is slack bowed between its guides.
import type {Colours} from './compose';
import {between, type Look} from './pen';
import type {Pulls} from './picture';
import {centre, dot, length, minus, plus, type Point, scaled} from './vector';

const steps = 6;  // of a bow
const [thin, thick] = [1.5, 3];  // [px]
export const slackDash = [3, 4];
const ramp = ['pull-0', 'pull-1', 'pull-2', 'pull-3'] as const;

/** Whether a tendon pulls: next to nothing, beside what others pull, is what is left of an iteration. */
export const isSlack = (tension: number, {most}: {most: number}) => tension <= 1e-6 * most;

export function lookOf(tension: number, pulls: Pulls, colour: (token: keyof Colours) => string): Look {
  if (isSlack(tension, pulls)) return {colour: colour('mute'), width: 1.2, dash: slackDash};
  const part = Math.min(1, tension / pulls.most), at = part * (ramp.length - 1), i = Math.min(Math.floor(at), ramp.length - 2);
  return {colour: between(colour(ramp[i]!), colour(ramp[i + 1]!), at - i), width: thin + (thick - thin) * part};
}

/**
 * Between each two guides an arc of the slack that falls to it, away from the other tendons. A chord d and a shallow arc longer by e are
 * √(3de/8) apart in their middle.
 */
export function bowed(points: Point[], all: Point[][], slack: number): Point[] {
  const gaps = points.length - 1, whole = points.reduce((sum, point, i) => (i > 0 ? sum + length(minus(point, points[i - 1]!)) : 0), 0);
  if (!(slack > 0) || gaps < 1 || !(whole > 0)) return points;
  const middles = points.map((_, i) => centre(all.filter((one) => one.length > i).map((one) => one[i]!)));
  return points.flatMap((a, i) => {
    const b = points[i + 1];
    if (!b) return [a];
    const along = minus(b, a), chord = length(along), middle = plus(scaled(a, 0.5), b, 0.5), out = minus(middle, plus(scaled(middles[i]!, 0.5), middles[i + 1]!, 0.5));
    const aside = chord > 0 ? minus(out, scaled(along, dot(out, along) / chord ** 2)) : [0, 0, 0], size = length(aside);
    if (size < 1e-9) return [a];
    const rise = Math.sqrt((3 * chord * (slack * chord / whole)) / 8);
    return Array.from({length: steps}, (_, k) => plus(plus(a, along, k / steps), aside, (4 * rise * (k / steps) * (1 - k / steps)) / size));
  });
}
