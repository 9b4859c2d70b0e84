// The right panel's numbers: pose, margins, forces or tensions. Words of an answer, put in order; nothing is computed.
import {sectionName} from './arm';
import {type Bar, filled, type Section, sectionOf, signed} from './bars';
import type {Json} from './client';
import {type Described, subscript} from './described';
import type {Ghost} from './ghost';
import {profile} from './profile';
import {loop} from './remembered';
import type {State} from './state';
import {isSlack} from './tendon_lines';
import {format, type System, type Unit, unitName} from './units';

export const withUnit = (value: number, unit: Unit, system: System): string =>
  `${format(value, unit, system)}${unit === 'rad' && system === 'mm' ? '°' : ` ${unitName(unit, system)}`}`.trim();

/** The coordinates of a pose as people read them. */
export function coordinates(pose: Json): [string, number, Unit][] {
  if (!pose.position) return [['x', pose.x, 'm'], ['y', pose.y, 'm'], ['φ', pose.phi, 'rad']];
  const [x, y, z] = pose.position, place: [string, number, Unit][] = [['x', x, 'm'], ['y', y, 'm'], ['z', z, 'm']];
  if (pose.tilt === undefined) return place;
  return [...place, ['tilt', pose.tilt, 'rad'], ['azimuth', pose.azimuth, 'rad'], ['torsion', pose.torsion, 'rad']];
}

function poseSection(answer: Json, ghost: Ghost | null, described: Described, system: System): Section {
  const pose = answer.pose ?? answer.tip, other = ghost?.answer.pose ?? ghost?.answer.tip, title = described.isSerial || (described.isArm && !described.hasArmLegs) ? 'Pose of the tip' : 'Pose of the platform';
  if (!pose) return {title, rows: [], bars: []};
  const others = other ? coordinates(other) : [];
  const isUpright = Math.abs(pose.tilt ?? 1) < 1e-7;  // it leans nowhere, so in no direction
  const rows = coordinates(pose).map(([name, value, unit]): [string, string] => {
    if (name === 'azimuth' && isUpright) return [name, '–'];
    const its = others.find(([of]) => of === name)?.[1], by = value - (its ?? value), far = unit === 'rad' ? by - 2 * Math.PI * Math.round(by / (2 * Math.PI)) : by;
    const beside = its === undefined ? '' : ` (${far < 0 ? '−' : '+'}${withUnit(Math.abs(far), unit, system)})`;
    return [name, withUnit(value, unit, system) + beside];
  });
  return {title: other ? `${title} (from the ghost${ghost!.says && `, ${ghost!.says}`})` : title, rows, bars: []};
}

/** Decades up to this one are drawn as a bar. */
const worst = 1000;

function conditioning(condition: number): Bar {
  const state = condition > worst ? 'over' : condition > 100 ? 'slack' : undefined;
  return filled('conditioning', 1 - Math.log10(Math.max(condition, 1)) / Math.log10(worst), condition.toPrecision(3), state,
                'condition number of the velocity equations, lengths over the platform\'s radius; 1 is best');
}

/** The input nearest to one of its limits. */
function limitBar(described: Described, state: State): Bar | null {
  let found: {name: string; part: number} | null = null;
  described.inputs.forEach((row, i) => {
    const {low, high} = row.limits, value = state.inputs[i]!, middle = (row.low + row.high) / 2;
    const below = low ? (value - row.low) / (middle - row.low) : Infinity, above = high ? (row.high - value) / (row.high - middle) : Infinity, part = Math.min(1, below, above);
    if ((low || high) && (!found || part < found.part)) found = {name: row.name, part};
  });
  if (!found) return null;
  const {name, part} = found as {name: string; part: number};
  return filled('to a limit', part, `${Math.max(0, 100 * part).toFixed(0)} % ${name}`, part < 0.05 ? 'slack' : undefined,
                'of the way from the middle of its range, the input that is nearest to a limit');
}

/** Elastic strain that spring steel and nitinol bear without a mark lies above this. */
const strainLimit = 0.01;

function marginBars(answer: Json, described: Described, state: State): Bar[] {
  const {margins, velocity, reach} = answer, bars: (Bar | null)[] = [limitBar(described, state)];
  if (margins?.fold !== undefined) bars.push(filled('to a fold', Math.sqrt(Math.max(margins.fold, 0)), margins.fold.toPrecision(3), margins.fold < 1e-3 ? 'slack' : undefined,
    'smallest over largest pivot of the platform\'s stiffness; 0 at a fold'));
  if (margins?.strain !== undefined) bars.push(filled('strain', margins.strain / strainLimit, `${(100 * margins.strain).toFixed(3)} %`, margins.strain > strainLimit ? 'over' : undefined,
    'largest bending strain of a rod; the bar ends at 1 %'));
  if (answer.buckling_margin !== undefined) bars.push(filled('to buckling', answer.buckling_margin, Math.max(answer.buckling_margin, 0).toPrecision(3), answer.buckling_margin < 0.05 ? 'slack' : undefined,
    'of the arm\'s stiffness: about 1 without load, 0 where it buckles'));
  if (reach?.load !== undefined) bars.push(filled(reach.why === 'limit' ? 'more load' : `load to ${reach.why}`, reach.load / reach.limit, `${reach.why === 'limit' ? '> ' : ''}${reach.load.toPrecision(3)} ×`,
    reach.load < 0.25 ? 'slack' : undefined, 'how many times this load can be added'));
  if (velocity?.indices?.condition_homogenised !== undefined) bars.push(conditioning(velocity.indices.condition_homogenised));
  return bars.filter((bar) => bar !== null);
}

/** How far an arm's tendons are from slack: the least tension, and by how much too long they are. */
function slackRows({least_tension: least, slack, tensions}: Json, system: System): [string, string][] {
  if (least === undefined) return [];
  const most = largest(tensions.flat()), count = tensions.flat().filter((one: number) => isSlack(one, {most})).length, longest = Math.max(...slack.flat());
  if (count === 0) return [['to slack', withUnit(least, 'N', system)]];
  return [['slack', `${count} of ${tensions.flat().length} tendons`], ...(longest > 0 ? [['slack by at most', withUnit(longest, 'm', system)] as [string, string]] : [])];
}

function marginRows(answer: Json, system: System): [string, string][] {
  const {velocity, typeTwo, room} = answer, rows: [string, string][] = slackRows(answer, system);
  for (const {name, by, unit, word} of room ?? []) rows.push([`${name} ${by < 0 ? '−' : '+'}${withUnit(Math.abs(by), unit, system)}`, word]);
  if (velocity?.type_1?.length > 0) rows.push(['type I', `leg ${velocity.type_1.map((leg: number) => leg + 1).join(', ')}`]);
  if (velocity?.type_2?.singular) rows.push(['type II', velocity.type_2.class ?? 'singular']);
  else if (typeTwo) rows.push([`type II by ${typeTwo.name}`, `after ${withUnit(typeTwo.distance, typeTwo.unit, system)}`]);
  return rows;
}

const largest = (values: number[]) => Math.max(0, ...values.map(Math.abs));

/** @param isOneSided for what is never negative */
function barSection(title: string, unit: Unit, system: System, named: [string, number][], isOneSided = false): Section {
  const ends = largest(named.map(([, value]) => value)), most = Number.parseFloat(format(ends, unit, system)) === 0 ? 0 : ends; // bars of what reads 0 would be noise
  const bar = (name: string, value: number) => {
    const text = format(value, unit, system);
    return isOneSided ? filled(name, most > 0 ? value / most : 0, text) : signed(name, value, most, text);
  };
  return {title: `${title} [${unitName(unit, system)}]`, rows: [], bars: named.map(([name, value]) => bar(name, value))};
}

/** What an arm's tendons do, how it bends and what its tip yields. */
function ofArm({tensions, changes, compliance}: Json, described: Described, system: System): Section[] {
  const named = (lists: number[][]) => lists.flatMap((of, m) => of.map((value, j): [string, number] => [`${sectionName(described.answer, m)} ${j + 1}`, value]));
  const pulls = barSection('Tensions', 'N', system, named(tensions), true);
  pulls.bars.forEach((bar, i) => { if (isSlack(named(tensions)[i]![1], {most: largest(tensions.flat())})) bar.text = 'slack'; });
  return [pulls, barSection('Tendon changes', 'm', system, named(changes)),
          ...(compliance ? [barSection(`Compliance of the ${described.hasArmLegs ? 'platform' : 'tip'}`, 'm/N', system, (described.isPlanar ? ['x', 'y'] : ['x', 'y', 'z']).map((name, k) => [name, compliance[k][k]]), true)] : [])];
}

/** What pulls: forces of rods, tensions of chains, changes of a serial robot's tendons; of arcs how they bend. */
function effort(answer: Json, system: System): Section | null {
  const legs: Json[] = answer.legs ?? [];
  if (answer.changes) {
    const named = (answer.changes as number[][]).flatMap((of, m) => of.map((change, j): [string, number] => [`S${m + 1} ${j + 1}`, change]));
    return barSection('Tendon changes', 'm', system, named);
  }
  const name = (i: number) => `leg ${i + 1}`;
  if (legs[0]?.tensions) {
    const named = legs.flatMap((leg, i) => leg.tensions.map((tension: number, k: number): [string, number] => [`T${subscript(k + 1)} leg ${i + 1}`, tension]));
    return barSection('Tensions', 'N', system, named, true);
  }
  if (legs.some((leg) => leg.force)) {
    const named = legs.map((leg, i): [string, number] => [name(i), leg.force ? Math.hypot(...leg.force) : 0]);
    return barSection('Forces on the legs', 'N', system, named, true);
  }
  if (legs[0]?.curvature !== undefined) return barSection('Curvatures', '1/m', system, legs.map((leg, i) => [name(i), leg.curvature]));
  return null;
}

export class AnswerPanel {
  constructor(private readonly box: HTMLElement) {}

  /** @param answer of `forward`, with those of other queries as `velocity`, `reach`, `typeTwo` and `room` in it */
  show(answer: Json, described: Described, state: State, ghost: Ghost | null, system: System, input = 0): void {
    const sections = [poseSection(answer, ghost, described, system)];
    const margins: Section = {title: 'Margins', rows: marginRows(answer, system), bars: marginBars(answer, described, state)};
    if (margins.rows.length + margins.bars.length > 0) sections.push(margins);
    const pulls = described.isArm ? null : effort(answer, system), curve = described.isArm && !described.hasArmLegs && profile(answer, described, system), way = described.isArm && !described.hasArmLegs && loop(answer, described, state, input, system);
    if (pulls) sections.push(pulls);
    this.box.replaceChildren(...sections.map(sectionOf), ...(way ? [way] : []), ...(curve ? [curve] : []), ...(described.isArm && answer.tensions ? ofArm(answer, described, system).map(sectionOf) : []));
  }

  clear(): void {
    this.box.replaceChildren();
  }
}
