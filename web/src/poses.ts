// Where the robot of a plan is at each step: shapes and tips as the server answers them, moved to where the stage has the base.
// One request at a time: first for the step that is looked at, then for all tips, then for the steps around.
import {type Json, Robot} from './client';
import type {Plan} from './plan';
import {axesOf, plus, type Point} from './vector';

const shapes = 8;     // of a request: as many as are there before a hand has moved on
const forwards = 250; // of a request
const most = 2000;    // shapes that are kept
const samples = 3;    // points of a joint

/** Of a step, in the axes of the scene. */
export interface Pose { shape: Json; tip: {position: Point; direction: Point} }

/** Of all steps: where the tip is, and how the tendons have changed; null where there is no answer. */
export interface Tips { position: Point; changes: number[][] | null }

export class Poses {
  readonly tips: (Tips | null)[] = [];
  private readonly kept = new Map<number, Pose | null>();
  private robot: Robot | null = null;
  private wanted = 0;
  private isBusy = false;
  private isOver = false;

  /** @param came another step has its shape, or all have their tips @param guarded tells what goes wrong */
  constructor(private readonly plan: Plan, private readonly came: (step: number | null) => void,
              private readonly guarded: (task: () => Promise<unknown>, again?: () => unknown) => Promise<void>) {}

  of(step: number): Pose | null | undefined {
    return this.kept.get(step);
  }

  get hasTips(): boolean {
    return this.tips.length === this.plan.steps.length;
  }

  /** This step is looked at. */
  want(step: number): void {
    this.wanted = step;
    if (this.isBusy || this.isOver) return;
    this.isBusy = true;
    void this.guarded(() => this.work(), () => this.want(this.wanted)).finally(() => { this.isBusy = false; });
  }

  forget(): void {
    this.kept.clear();
  }

  /** Nothing more is wanted. */
  end(): void {
    this.isOver = true;
    this.robot?.cancel();
  }

  private async work(): Promise<void> {
    this.robot ??= await Robot.open(this.plan.robot.text);
    while (!this.isOver) {
      const next = this.next();
      if (this.kept.has(this.wanted) && !this.hasTips) await this.askTips(this.robot);
      else if (next.length > 0) await this.askShapes(this.robot, next);
      else return;
    }
  }

  /** Steps without a shape, those nearest to what is looked at first. */
  private next(): number[] {
    const {last} = this.plan, found: number[] = [], few = this.kept.has(this.wanted) ? shapes : 1;
    for (let away = 0; away <= Math.min(last, most / 2) && found.length < few; ++away)
      for (const step of away === 0 ? [this.wanted] : [this.wanted + away, this.wanted - away]) if (step >= 0 && step <= last && !this.kept.has(step)) found.push(step);
    return found.slice(0, few);
  }

  private async askShapes(robot: Robot, steps: number[]): Promise<void> {
    const answers = await robot.ask(steps.map((step) => ({query: 'shape', configuration: this.plan.steps[step]!.configuration, samples})));
    steps.forEach((step, i) => {
      this.kept.set(step, placed(answers[i]!, this.plan.scene as Place, this.plan.steps[step]!.stage));
      this.came(step);
    });
    for (const step of [...this.kept.keys()].sort((a, b) => Math.abs(b - this.wanted) - Math.abs(a - this.wanted)).slice(0, Math.max(0, this.kept.size - most))) this.kept.delete(step);
  }

  private async askTips(robot: Robot): Promise<void> {
    const first = this.tips.length, steps = this.plan.steps.slice(first, first + forwards);
    const answers = await robot.ask(steps.map(({configuration}) => ({query: 'forward', configuration})));
    answers.forEach((answer, i) => this.tips.push(answer.tip ? {position: mover(this.plan.scene as Place, steps[i]!.stage)(answer.tip.position), changes: steps[i]!.changes ?? answer.changes ?? null} : null));
    if (this.hasTips) this.came(null);
  }
}

/** Where a robot is: its base where the stage is at 0, and the way of the stage. */
export interface Place { base: {position: Point; quaternion: number[]}; axis: Point }

/** From the axes of the robot to those of the scene, where the stage is so far. */
function mover({base, axis}: Place, stage: number): (point: Point) => Point {
  const [u, v, w] = axesOf(base), at = plus(base.position, axis, stage);
  return ([x, y, z = 0]) => plus(plus(plus(at, u, x!), v, y!), w, z);
}

/** Tendons, which make most of an answer, are left out. */
export function placed(answer: Json, place: Place, stage: number): Pose | null {
  if (answer.error || !answer.backbones) return null;
  const move = mover(place, stage), turn = place.base.quaternion, [, , along] = axesOf(answer.tip), [u, v, w] = axesOf(place.base);
  return {
    shape: {
      backbones: (answer.backbones as Point[][]).map((points) => points.map(move)),
      discs: (answer.discs ?? []).map((disc: Json) => ({...disc, pose: {position: move(disc.pose.position), quaternion: product(turn, disc.pose.quaternion)}})),
    },
    tip: {position: move(answer.tip.position), direction: plus(plus(plus([0, 0, 0], u, along[0]!), v, along[1]!), w, along[2]!)},
  };
}

/** Of two turns, first the second. */
function product([a, b, c, d]: number[], [w, x, y, z]: number[]): number[] {
  return [a! * w! - b! * x! - c! * y! - d! * z!, a! * x! + b! * w! + c! * z! - d! * y!, a! * y! - b! * z! + c! * w! + d! * x!, a! * z! + b! * y! - c! * x! + d! * w!];
}
