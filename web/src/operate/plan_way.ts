// A plan as it is driven: postures, between two of which stage and bends go straight, and where the tip then is. Tips and changes of
// tendons are answers of the server, which also says how far the drives have to go.
import type {Json, Robot} from '../client';
import type {Plan} from '../plan';
import type {Point} from '../vector';
import {isPolar} from './coordinates';
import type {Bend} from './frame';
import {inPlace} from './surround';

const forwards = 250;  // of a request

export interface Posture { bends: Bend[]; stage: number }

/** A point of the tip in the robot's own axes, with the stage that belongs to it. */
export interface TipPlace { tip: Point; stage: number }

export class PlanWay {
  tips: TipPlace[] = [];
  private lengths: number[] = [];  // [m] from each step to the next, of the drive that has farthest to go

  /** @param robot handle of its file @param clearance [m] of each step @param handle of the plan; empty: the server has it of a device */
  constructor(readonly name: string, readonly robot: string, readonly steps: Posture[], readonly clearance: number[] | null, readonly handle = '') {}

  get last(): number {
    return this.steps.length - 1;
  }

  at(place: number): Posture {
    const from = Math.min(Math.floor(place), this.last), share = place - from, a = this.steps[from]!, b = this.steps[Math.min(from + 1, this.last)]!;
    return {bends: a.bends.map(([x, y], i): Bend => [x + share * (b.bends[i]![0] - x), y + share * (b.bends[i]![1] - y)]), stage: a.stage + share * (b.stage - a.stage)};
  }

  /** The lesser of the two steps that it is between. */
  clearanceAt(place: number): number | null {
    return this.clearance && Math.min(this.clearance[Math.floor(place)]!, this.clearance[Math.ceil(place)]!);
  }

  /** How far one comes whose drives go `way` [m] at most. */
  gone(place: number, way: number, isBack: boolean): number {
    for (let left = way; left > 0 && (isBack ? place > 0 : place < this.last);) {
      const next = isBack ? Math.ceil(place) - 1 : Math.floor(place) + 1, step = (this.lengths[Math.min(next, Math.floor(place))] ?? 1e-3) * Math.abs(next - place);
      place = step <= left ? next : place + ((next - place) * left) / step;
      left -= step;
    }
    return place;
  }

  async ask(robot: Robot, sections: Json[]): Promise<void> {
    const tips: TipPlace[] = [], changes: number[][] = [];
    for (let first = 0; first < this.steps.length; first += forwards) {
      const steps = this.steps.slice(first, first + forwards);
      const answers = await robot.ask(steps.map(({bends}) => ({query: 'forward', model: 'lsk', configuration: bends.map(([x, y], i) => (isPolar(sections[i] as {type: string}) ? [Math.hypot(x, y), Math.atan2(y, x)] : [x, y]))})));
      answers.forEach((answer, i) => {
        tips.push({tip: answer.tip?.position ?? tips.at(-1)?.tip ?? [0, 0, 0], stage: steps[i]!.stage});
        changes.push((answer.changes ?? []).flat());
      });
    }
    this.tips = tips;
    this.lengths = changes.slice(1).map((now, k) => Math.max(Math.abs(tips[k + 1]!.stage - tips[k]!.stage), ...now.map((value, i) => Math.abs(value - (changes[k]![i] ?? value)))));
  }
}

/** Of the screen Trajectory. Distances beyond the reach of its check are not told apart. */
export const wayOf = (plan: Plan): PlanWay => new PlanWay(
  plan.title, plan.robot.robot, plan.steps.map(({stage, configuration}) => ({stage, bends: configuration.map(([a = 0, b = 0], i): Bend => (plan.isPolar(i) ? [a * Math.cos(b), a * Math.sin(b)] : [a, b]))})),
  plan.check && plan.check.steps.map(({clearance}) => clearance), plan.handle);

/** As a device has it. */
export const wayOfDevice = ({name, steps, clearance}: Json): PlanWay => new PlanWay(name, '', steps, clearance);

/** Where the tip goes, in the scene or at the arm's own base. */
export const trailOf = (tips: TipPlace[], scene: Json | null): Point[] =>
  tips.map(({tip, stage}) => inPlace({backbones: [], discs: [], tip: {position: tip, quaternion: [1, 0, 0, 0]}}, scene, stage).tip.position);
