// A plan at a device: it waits for control, is loaded, and is followed while a button is held.
import type {Robot} from '../client';
import type {Control, Motion} from './control';
import type {Device} from './device';
import type {Frame} from './frame';
import type {PlanFrame} from './plan_buttons';
import {PlanWay, wayOfDevice} from './plan_way';

export class LivePlan {
  way: PlanWay | null = null;
  private number = -1;  // of the plan that is known
  private pending: PlanWay | null = null;
  private isSending = false;
  private isDown = false;

  /** @param changed its way is known */
  constructor(private readonly device: Device, private readonly control: Control, private readonly robot: Robot, private readonly sections: object[],
              private readonly guarded: (task: () => Promise<unknown>) => Promise<void>, private readonly changed: () => void) {}

  /** At once, or once this page has control. */
  load(way: PlanWay): void {
    this.pending = way;
    if (this.control.isMine) void this.send();
    else void this.control.take();
  }

  get isWaiting(): string | null {
    return this.pending && !this.isSending ? this.pending.name : null;
  }

  drop(): void {
    this.pending = null;
    void this.control.plan({});
  }

  /** Along it, or where the arm is not on it and may go there to its first step. */
  press(plan: PlanFrame, isBack: boolean): void {
    this.isDown = true;
    if (!isBack && plan.off_path?.to_first) void this.toFirst();
    else this.control.press(isBack ? 'back' : 'follow');
  }

  letGo(): void {
    this.isDown = false;
    const ours: (Motion | null)[] = ['follow', 'back', 'move'];
    if (ours.includes(this.control.held)) this.control.letGo();
  }

  /** What a frame says of it. */
  take({plan}: Frame): void {
    if (this.pending && this.control.isMine) void this.send();
    const number = plan?.number ?? -1;
    if (number === this.number) return;
    this.number = number;
    this.way = null;
    if (plan) void this.guarded(() => this.fetch(number));
    this.changed();
  }

  /** The target is known to the device before anything moves. */
  private async toFirst(): Promise<void> {
    const first = this.way?.steps[0];
    if (first && await this.control.target({bends: first.bends, stage: first.stage}) && this.isDown) this.control.press('move');
  }

  private async send(): Promise<void> {
    const {pending} = this;
    if (!pending || this.isSending) return;
    this.isSending = true;
    const {name, robot, steps, clearance} = pending, isFar = (value: number) => Number(value.toPrecision(12));
    await this.control.plan({name: name.slice(0, 50), robot, steps: steps.map(({bends, stage}) => ({bends: bends.map((pair) => pair.map(isFar)), stage: isFar(stage)})), ...(clearance && {clearance: clearance.map(isFar)})});
    if (this.pending === pending) this.pending = null;  // refused or not: it has said why
    this.isSending = false;
    this.changed();
  }

  private async fetch(number: number): Promise<void> {
    const {plan} = await this.device.plan();
    if (!plan || plan.number !== number || number !== this.number) return;
    const way = wayOfDevice(plan);
    await way.ask(this.robot, this.sections);
    if (number !== this.number) return;
    this.way = way;
    this.changed();
  }
}
