// What is drawn of an answer.
import {alongLegs, byTendons, canPlace, pointLoad} from './arm';
import type {Json} from './client';
import type {Described} from './described';
import {round} from './outline';
import type {Drawing} from './picture';
import {wrenchOf} from './questions';
import type {State} from './state';
import {plus, type Point} from './vector';

/** The file of an arm need not say how wide its discs are; they are drawn a little wider than its tendons lie. None says how thick; what has no thickness has no shade. */
const wider = 1.15, flat = 0.06;

function withDiscs({answer}: Described, shape: Json): Json {
  const usual = wider * Math.max(0, ...answer.tendons.flatMap(({routes}: Json) => routes.flatMap((route: Json) => [route.radius, route.end_radius ?? 0])));
  return {...shape, discs: (shape.discs ?? []).map((disc: Json) => {
    const radius = disc.radius || usual;
    return {...disc, radius, height: disc.height || flat * radius};
  })};
}

/** Where on a backbone so much of it lies before [m]. */
export function placeOn(shape: Json, place: number): Point {
  const places: number[] = shape.places, points: Point[] = shape.backbones[0], i = Math.max(1, places.findIndex((one) => one >= place)), [a, b] = [places[i - 1]!, places[i]!];
  const part = Math.min(1, Math.max(0, (place - a) / (b - a || 1)));
  return plus(plus([0, 0, 0], points[i - 1]!, 1 - part), points[i]!, part);
}

/** The same on the line of a leg so long, whose points lie evenly on it. */
function placeOnLeg(points: Point[], length: number, place: number): Point {
  const way = Math.min(1, Math.max(0, place / length)) * (points.length - 1), i = Math.min(points.length - 2, Math.floor(way)), part = way - i;
  return plus(plus([0, 0, 0], points[i]!, 1 - part), points[i + 1]!, part);
}

/** Where the forces on backbones act beside that at the tip; what acts along all legs is drawn in the middle of each. */
function loadsOn(described: Described, state: State, answer: Json): {at: Point; force: Point}[] {
  const point = pointLoad(described, state);
  if (!described.hasArmLegs) return point && answer.places ? [{at: placeOn(answer, point.place), force: point.force}] : [];
  const along = alongLegs(described, state), lengthOf = (leg: number): number => described.answer.legs[leg].link.length, legs: Point[][] = answer.backbones ?? [];
  const on = (leg: number, place: number, force: Point) => ({at: placeOnLeg(legs[leg]!, lengthOf(leg), place), force});
  return [...(point && legs[point.leg] ? [on(point.leg, point.place, point.force)] : []),
          ...(along ? legs.map((_, leg) => on(leg, lengthOf(leg) / 2, along.map((part) => part * lengthOf(leg)))) : [])];
}

/** The next of 1, 2, 4, 5 times a power of ten: colours stay the same while tensions change a little. */
const above = (value: number) => (value > 0 ? [1, 2, 2.5].map((step) => step * round(value)).find((most) => most >= value * (1 - 1e-9))! : 1);

function ofArm(described: Described, state: State, answer: Json): Partial<Drawing> {
  const {tensions, slack} = answer, loads = loadsOn(described, state, answer);
  let from = 0;
  const names = described.hasArmLegs ? [] : (described.answer.sections as Json[]).map(({length}, i) => ({text: `S${i + 1}`, at: placeOn(answer, (from += length) - length / 2)}));
  return {
    canGrab: canPlace(described), names, ...(tensions && {pulls: {tensions, slack, most: above(Math.max(...tensions.flat(), ...(answer.tensions_along ?? []).flat())), ...(answer.tensions_along && {along: byTendons(described.answer, answer.tensions_along as number[][])})}}),
    ...(loads.length > 0 && {loads}),
  };
}

/** @param answer that has a shape, too */
export function drawingOf(described: Described, state: State, answer: Json, shape: Json): Drawing {
  const legs: Json[] = described.answer.legs ?? [], two = answer.velocity?.type_2;
  return {
    shape: described.isArm ? withDiscs(described, shape) : shape, isPlanar: described.isPlanar, radius: described.isArm ? 0 : (legs.find((leg) => leg.link.diameter)?.link.diameter ?? 0.001) / 2,
    struts: legs.map((leg) => /strut/.test(leg.closure.type)), isStale: false, ghost: null, states: [], isUnstable: answer.status === 'unstable', directions: answer.unstable ?? [],
    meeting: two?.singular ? two.point ?? null : null, wrench: wrenchOf(described, state), ...(described.isArm && ofArm(described, state, answer)),
  };
}
