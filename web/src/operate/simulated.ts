// An arm without a device: the target acts at once. Every number is an answer of the server.
import type {Json, Robot} from '../client';
import type {Described} from '../described';
import {inputsOf, limitOf} from './coordinates';
import {type Alarm, type Bend, type Frame, kindOf, type SectionFrame, worstFirst} from './frame';

/** What is asked of the simulated arm. */
export interface Wish {
  bends: Bend[];
  inputs: number[];  ///< rows of the robot of which the bends are new
  slack: number[];   ///< of each section, that all its tendons have beyond what the bends need [m]
}

/** Points of each joint, so that few long joints look round. */
export const samplesOf = (sections: Json[]): number => Math.max(5, Math.ceil(40 / Math.min(...sections.map((one) => one.segments))));

/** Configurations of the robot from its rows. */
export function configurationOf(described: Described, bends: Bend[], inputs: number[]): number[][] {
  const sections = described.answer.sections as Json[], rows = inputsOf(described, bends, inputs), size = rows.length / sections.length;
  return sections.map((_, i) => rows.slice(i * size, (i + 1) * size));
}

export interface Simulated { frame: Frame; shape: Json; changes: number[][] }

export async function simulate(robot: Robot, described: Described, wish: Wish): Promise<Simulated | string> {
  const {sections} = described.answer, configuration = configurationOf(described, wish.bends, wish.inputs);
  const [forward] = await robot.ask([{query: 'forward', configuration, model: 'lsk', ...(wish.slack.some((one) => one !== 0) && {slack: wish.slack})}]) as [Json];
  if (!forward.changes) return forward.error?.message ?? forward.message ?? String(forward.status);
  const changes = forward.changes as number[][];
  const diagrams = sections.map((one: Json, section: number) => ({query: 'diagram', section, changes: changes.slice(0, section + 1), ...(one.limit === undefined && {limit: limitOf(one)})}));
  const [shape, ...answers] = await robot.ask([{query: 'shape', changes, model: 'lsk', samples: samplesOf(sections)}, ...diagrams]) as [Json, ...Json[]];
  const bad = [shape, ...answers].find((one) => one.error);
  if (bad) return bad.error.message;
  const told = answers.map((answer, i) => ({...answer, target: wish.bends[i]!, measured: null, changes: changes[i]!}) as unknown as SectionFrame);
  return {frame: frameOf(told, shape.tip.position), shape, changes};
}

/** The worst of all. Nothing watches a simulated arm, or one of long ago: nobody is to be alarmed, and its states have no age. */
export function alarmOf(sections: SectionFrame[]): Alarm | null {
  const [worst] = worstFirst(sections), {word, advice} = sections[worst ?? 0]!;
  if (worst === undefined || kindOf(word) === 'exact') return null;
  return {section: worst, word, since: 0, sentence: '', did: '', next: advice ?? '', more: sections.filter((one) => kindOf(one.word) !== 'exact').length - 1, acknowledged: true};
}

function frameOf(sections: SectionFrame[], tip: number[]): Frame {
  return {
    time: performance.now() / 1000, age: 0, link: 'ok', message: '', round_trip: 0, rate: 0, errors: 0, control: {holder: null, since: ''}, state: 'control', activity: 'rest',
    armed_left: 0, why: '', homed: true, homing: null, stage: 0, insertion: 0, stage_target: 0, speed: 0, recording: null, tip, sections, alarm: alarmOf(sections),
  };
}

/** For a shell: the diagram of one section, after those before it. */
export function command(word: string, sets: string[], section: number, changes: number[][]): string {
  const list = changes.slice(0, section + 1).map((one) => one.map((value) => String(Number(value.toPrecision(12)))).join(', ')).join('; ');
  return ['sinew', 'diagram', /^[\w./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`, '--section', String(section), '--changes', `"${list}"`, ...sets.map((set) => `--set '${set}'`)].join(' ');
}

