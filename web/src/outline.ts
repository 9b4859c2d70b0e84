// Shapes of a picture that come from its points: the platform's outline, the base's ring, lines made longer, round lengths.
import {centre, cross, dot, length, minus, plus, type Point, scaled} from './vector';

/** Two directions in the plane of points around their centre; null where they lie in one line. */
function plane(points: Point[], middle: Point): [Point, Point] | null {
  const arms = points.map((point) => minus(point, middle)), first = arms.reduce((best, arm) => (length(arm) > length(best) ? arm : best));
  if (length(first) === 0) return null;
  const u = scaled(first, 1 / length(first)), rests = arms.map((arm) => minus(arm, scaled(u, dot(arm, u))));
  const second = rests.reduce((best, arm) => (length(arm) > length(best) ? arm : best));
  if (length(second) < 1e-9 * length(first)) return null;
  const v = scaled(second, 1 / length(second));
  return cross(u, v)[2]! < 0 ? [u, scaled(v, -1)] : [u, v];
}

/** The points in the order of their angle around their centre: an outline that does not cross itself. */
export function outline(points: Point[]): Point[] {
  const middle = centre(points), axes = plane(points, middle);
  if (!axes) return points;
  const angle = (point: Point) => Math.atan2(dot(minus(point, middle), axes[1]), dot(minus(point, middle), axes[0]));
  return [...points].sort((a, b) => angle(a) - angle(b));
}

const ringSteps = 72;

/** The circle that points lie on, as a polyline; their outline where they lie on none. */
export function ring(points: Point[]): Point[] {
  const middle = centre(points), axes = plane(points, middle), radius = length(minus(points[0]!, middle));
  if (!axes || points.some((point) => Math.abs(length(minus(point, middle)) - radius) > 0.02 * radius)) return outline(points);
  return Array.from({length: ringSteps}, (_, i) => {
    const angle = (2 * Math.PI * i) / ringSteps;
    return plus(plus(middle, axes[0], radius * Math.cos(angle)), axes[1], radius * Math.sin(angle));
  });
}

/** A segment made longer at both ends; null where it has no length and so no direction. */
export function longer([a, b]: Point[], by: number): [Point, Point] | null {
  const along = minus(b!, a!), size = length(along);
  return size < 1e-9 ? null : [plus(a!, along, -by / size), plus(b!, along, by / size)];
}

/** The largest of 1, 2, 5 times a power of ten that is not above. */
export function round(most: number): number {
  const decade = 10 ** Math.floor(Math.log10(most)), part = most / decade;
  return decade * (part >= 5 ? 5 : part >= 2 ? 2 : 1);
}

/** `100 mm`, `2 m` */
export const lengthName = (metres: number) => (metres >= 1 ? `${Number(metres.toPrecision(3))} m` : `${Number((1000 * metres).toPrecision(3))} mm`);
