// Elastic arms: what of them is turned, asked and answered where it differs from other robots. Each tendon is held by a tension or by
// a change of its length; the other one is the answer.
import type {Json, Robot} from './client';
import {type Described, free, none, platformRows, type Row, subscript} from './described';
import {round} from './outline';
import type {State} from './state';

export type Held = 'tension' | 'change';
export interface Holding { held: Held[]; rows: Record<Held, Row[]> }

/** Of a load: so many numbers are the wrench on the tip or the platform. Then of a platform the leg, counted from one; the place of a second force and its parts; and of a platform a force along all legs. */
export const wrenchParts = ({hasArmLegs, isPlanar}: {hasArmLegs: boolean; isPlanar: boolean}) => (hasArmLegs && isPlanar ? 3 : 6);

/** Sliders go to where a tendon alone bends its arm by about so much [rad]; a number box takes more. */
const bend = 2;

interface Tendon { name: string; path: string; section: number; radius: number; pretension: number }

function tendonsOf(answer: Json): Tendon[] {
  const counts: number[] = answer.sections.map(() => 0);
  return answer.tendons.map(({section, routes, pretension}: Json, i: number) => ({
    name: `${sectionName(answer, section)} ${subscript(counts[section] = counts[section]! + 1)}`, path: answer.inputs[i].name, section, pretension,
    radius: Math.max(...routes.map((route: Json) => Math.max(route.radius, route.end_radius ?? 0))),
  }));
}

/** `S1`; of a platform on arms with its leg before it, `L2 S1`. */
export function sectionName({sections}: Json, section: number): string {
  const {leg} = sections[section];
  return leg === undefined ? `S${section + 1}` : `L${leg + 1} S${section - sections.findIndex((one: Json) => one.leg === leg) + 1}`;
}

const sectionsTo = ({sections}: Json, section: number): Json[] => sections.slice(0, section + 1).filter(({leg}: Json) => leg === sections[section].leg);
const lengthTo = (answer: Json, section: number): number => sectionsTo(answer, section).reduce((sum: number, one: Json) => sum + one.length, 0);
const stiffnessTo = (answer: Json, section: number): number => Math.min(...sectionsTo(answer, section).map((one: Json) => Math.min(...one.backbone.bending)));

function rowsOf(answer: Json): Record<Held, Row[]> {
  const tendons = tendonsOf(answer), row = (name: string, one: Tendon) => ({name: one.name.replace(/ (?=\S+$)/, ` ${name}`), path: one.path, limits: none});
  return {
    tension: tendons.map((one) => {
      const most = round((bend * stiffnessTo(answer, one.section)) / (one.radius * lengthTo(answer, one.section)));
      return {...row('T', one), unit: 'N', low: 0, high: Math.max(most, 2 * one.pretension), home: one.pretension, other: 'hold the change of its length instead'};
    }),
    change: tendons.map((one) => ({...row('Δ', one), unit: 'm', low: -round(bend * one.radius / 2), high: round(bend * one.radius / 2), home: 0, other: 'hold its tension instead'})),
  };
}

/** The tip of one section is turned, that of more is placed. */
const isTurned = (answer: Json) => answer.sections.length === 1;

function poseRows(answer: Json, tip: Json | undefined): Row[] {
  const {length} = answer, [x, y, z] = tip?.position ?? [0, 0, length];
  if (isTurned(answer)) return [{...free('tilt', 'rad', tip?.tilt ?? 0, 0), low: 0, high: 2}, free('azimuth', 'rad', tip?.azimuth ?? 0, Math.PI)];
  return [['x', x], ['y', y], ['z', z]].map(([name, home]) => ({...free(name, 'm', home, 0), low: Math.min(home, -length), high: Math.max(home, length)}));
}

function loadRows(answer: Json): Row[] {
  const last = answer.sections.length - 1, stiffness = stiffnessTo(answer, last), {length} = answer, force = round((4 * stiffness) / length ** 2), moment = round((2 * stiffness) / length);
  const place: Row = {name: 's', path: 'place of a second force, from the base along the backbone', unit: 'm', low: length / 100, high: length, home: length / 2, limits: none};
  return [...['Fx', 'Fy', 'Fz'].map((name) => ({...free(name, 'N', 0, force), path: 'force at the tip'})), ...['Mx', 'My', 'Mz'].map((name) => ({...free(name, 'N m', 0, moment), path: 'moment at the tip'})),
          place, ...['Px', 'Py', 'Pz'].map((name) => ({...free(name, 'N', 0, force), path: 'force at s'}))];
}

export async function armDescribed(robot: Robot, answer: Json): Promise<Described> {
  const rows = rowsOf(answer), held: Held[] = rows.tension.map(() => 'tension'), tensions = byTendons(answer, rows.tension.map(({home}) => home));
  const [home] = await robot.ask([{query: 'forward', tensions, tilt: true}]) as [Json];
  return {
    answer, isSerial: false, isArm: true, hasArmLegs: false, isPlanar: false, isHeldByFew: false, models: answer.models, canBend: false,
    hasGravity: (answer.gravity ?? []).some((part: number) => part !== 0),
    inputs: rows.tension, pose: poseRows(answer, home.tip?.position?.every(Number.isFinite) ? home.tip : undefined), load: loadRows(answer), holding: {held, rows},
  };
}

/** A platform on arms: its tendons are those of an arm, its pose and its load those of a platform. */
export function armLegsDescribed(described: Json): Described {
  const legs: Json[] = described.legs, counts = legs.map(({link}) => link.sections.length as number), first = (leg: number) => counts.slice(0, leg).reduce((sum, count) => sum + count, 0);
  const answer: Json = {
    ...described, length: Math.max(...legs.map(({link}) => link.length)), sections: legs.flatMap(({link}, leg) => link.sections.map((one: Json) => ({...one, leg}))),
    tendons: legs.flatMap(({link}, leg) => link.tendons.map((one: Json) => ({...one, section: first(leg) + one.section}))),
  };
  const isPlanar = answer.space === 'planar', [forces, moments] = isPlanar ? [['Fx', 'Fy'], ['M']] : [['Fx', 'Fy', 'Fz'], ['Mx', 'My', 'Mz']];
  const rows = rowsOf(answer), one = round((4 * stiffnessTo(answer, 0)) / answer.length ** 2), force = round((legs.length * 4 * stiffnessTo(answer, 0)) / answer.length ** 2), {length} = answer;
  const axes = isPlanar ? ['x', 'y'] : ['x', 'y', 'z'], onLegs: Row[] = [
    {name: 'leg', path: 'leg that a second force acts on, from 1', unit: '', low: 1, high: legs.length, home: 1, step: 1, limits: none},
    {name: 's', path: 'place of the second force, from the base along the leg, at most at its end', unit: 'm', low: length / 100, high: length, home: length / 2, limits: none},
    ...axes.map((axis) => ({...free(`P${axis}`, 'N', 0, one), path: 'force at s of the leg'})), ...axes.map((axis) => ({...free(`q${axis}`, 'N/m', 0, round(one / length)), path: 'force along all legs, by their length'})),
  ];
  return {
    answer, isSerial: false, isArm: true, hasArmLegs: true, isPlanar, isHeldByFew: false, models: answer.models, canBend: false,
    hasGravity: (answer.gravity ?? []).some((part: number) => part !== 0),
    inputs: rows.tension, pose: platformRows(answer), holding: {held: rows.tension.map(() => 'tension'), rows},
    load: [...forces.map((name) => free(name, 'N', 0, force)), ...moments.map((name) => free(name, 'N m', 0, round((force * answer.length) / 4))), ...onLegs],
  };
}

/** A list of each tendon as a list a section. */
export function byTendons<T>(answer: Json, values: T[]): T[][] {
  const lists: T[][] = answer.sections.map(() => []);
  answer.tendons.forEach(({section}: Json, i: number) => lists[section]!.push(values[i]!));
  return lists;
}

const pick = <T>({answer, holding}: Described, values: T[], of: Held): (T | null)[][] => byTendons(answer, values.map((value, i) => (holding!.held[i] === of ? value : null)));

/** What holds the tendons, as a question takes it. */
export function heldBy(described: Described, values: number[]): Json {
  const {held} = described.holding!, has = (of: Held) => held.includes(of);
  return {...(has('tension') && {tensions: pick(described, values, 'tension')}), ...(has('change') && {changes: pick(described, values, 'change')})};
}

/** Of an answer what holds its tendons; null where it says nothing of it. */
export function heldIn({holding}: Described, answer: Json): number[] | null {
  const values: Record<Held, number[] | undefined> = {tension: answer.tensions?.flat(), change: answer.changes?.flat()};
  const found = holding!.held.map((of, i) => values[of]?.[i]);
  return found.every((value) => typeof value === 'number') ? found as number[] : null;
}

/** Where the tip is to be, or where it is to point. */
export function tipField({answer}: Described, values: number[]): Json {
  if (!isTurned(answer)) return {position: values};
  const [tilt = 0, azimuth = 0] = values;
  return {direction: [Math.sin(tilt) * Math.cos(azimuth), Math.sin(tilt) * Math.sin(azimuth), Math.cos(tilt)]};
}

/** In the words of the pose's rows. */
export const tipOf = ({answer}: Described, tip: Json): number[] => (isTurned(answer) ? [tip.tilt ?? 0, tip.azimuth ?? 0] : tip.position);

/** Whether the tip can be dragged to a place. */
export const canPlace = ({isArm, hasArmLegs, answer}: Described) => !isArm || hasArmLegs || !isTurned(answer);

/** A force on the backbone beside that at the tip; of a platform on a leg, from 0. */
export function pointLoad(described: Described, {load}: State): {leg: number; place: number; force: number[]} | null {
  if (!described.isArm) return null;
  const {hasArmLegs, isPlanar} = described, [first, ...rest] = load.slice(wrenchParts(described)) as [number, ...number[]], size = hasArmLegs && isPlanar ? 2 : 3;
  const [place, ...force] = hasArmLegs ? rest : [first, ...rest];
  const parts = force.slice(0, size), leg = hasArmLegs ? Math.round(first) - 1 : 0;
  // the slider goes to the end of the longest leg; beyond that, or of no leg, the answer says so
  const end: number = hasArmLegs && place! <= described.answer.length ? described.answer.legs[leg]?.link.length ?? Infinity : Infinity;
  return parts.some((part) => part !== 0) ? {leg, place: Math.min(place!, end), force: parts} : null;
}

/** Of a platform a force along all legs, in space three numbers, by their length; null where there is none. */
export function alongLegs(described: Described, {load}: State): number[] | null {
  if (!described.hasArmLegs) return null;
  const size = described.isPlanar ? 2 : 3, force = load.slice(wrenchParts(described) + 2 + size);
  return force.some((part) => part !== 0) ? [...force, 0].slice(0, 3) : null;
}

/** Of a solved platform on arms where a search for it begins: the pose, and of each leg the curvatures of equal parts, which need not be exact. */
export function fromShape({pose, curvatures: legs}: Json, parts = 16): Json | null {
  if (!pose || !legs?.every((samples: unknown[]) => samples.length > 1)) return null;
  const {tilt: _t, azimuth: _a, torsion: _s, ...place} = pose;
  const at = (samples: (number | number[])[], share: number): number[] => {
    const way = share * (samples.length - 1), i = Math.min(samples.length - 2, Math.floor(way)), part = way - i;
    const [a, b] = [samples[i]!, samples[i + 1]!].map((one) => (Array.isArray(one) ? one : [0, one, 0])) as [number[], number[]];  // in the plane it is that about the second axis
    return a.map((value, k) => Number((value + part * (b[k]! - value)).toPrecision(5)));
  };
  return {pose: place, curvatures: legs.map((samples: (number | number[])[]) => Array.from({length: parts}, (_, k) => at(samples, (k + 0.5) / parts)))};
}

/** Loads of a question to an arm. */
export function loads(described: Described, state: State): Json {
  const wrench = state.load.slice(0, wrenchParts(described)), point = pointLoad(described, state), distributed = alongLegs(described, state);
  const moment = point?.force.length === 2 ? [0] : [0, 0, 0];
  return {
    ...(wrench.some((part) => part !== 0) && {wrench}), ...(distributed && {distributed}),
    ...(point && {loads: [{...(described.hasArmLegs && {leg: point.leg}), place: point.place, wrench: [...point.force, ...moment]}]}),
  };
}
