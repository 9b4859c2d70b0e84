// Points and ways as lists of two or three numbers; a third that is not there is 0.

export type Point = number[];

export const dot = (a: Point, b: Point) => a[0]! * b[0]! + a[1]! * b[1]! + (a[2] ?? 0) * (b[2] ?? 0);
export const cross = (a: Point, b: Point): Point => [a[1]! * b[2]! - a[2]! * b[1]!, a[2]! * b[0]! - a[0]! * b[2]!, a[0]! * b[1]! - a[1]! * b[0]!];
export const length = (a: Point) => Math.hypot(a[0]!, a[1]!, a[2] ?? 0);
/** a + by b */
export const plus = (a: Point, b: Point, by = 1): Point => [a[0]! + by * b[0]!, a[1]! + by * b[1]!, (a[2] ?? 0) + by * (b[2] ?? 0)];
export const minus = (a: Point, b: Point): Point => plus(a, b, -1);
export const scaled = (a: Point, by: number): Point => [by * a[0]!, by * a[1]!, by * (a[2] ?? 0)];
export const centre = (points: Point[]): Point => scaled(points.reduce((sum, point) => plus(sum, point), [0, 0, 0]), 1 / points.length);

/** Two directions square to a third and to each other, the three right-handed. */
export function across(along: Point): [Point, Point] {
  const [x, y, z] = along.map(Math.abs) as [number, number, number], least = x <= y && x <= z ? [1, 0, 0] : y <= z ? [0, 1, 0] : [0, 0, 1];
  const u = cross(along, least), first = scaled(u, 1 / length(u));
  return [first, scaled(cross(along, first), 1 / length(along))];
}

/** The axes of a pose, planar or not. */
export function axesOf(pose: Record<string, any>): [Point, Point, Point] {
  if (!pose.quaternion) {
    const [c, s] = [Math.cos(pose.phi), Math.sin(pose.phi)];
    return [[c, s, 0], [-s, c, 0], [0, 0, 1]];
  }
  const [w, x, y, z] = pose.quaternion;
  return [[1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
          [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]];
}

export const placeOf = (pose: Record<string, any>): Point => pose.position ?? [pose.x, pose.y, 0];
