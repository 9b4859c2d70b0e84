// The source DEVICE: what it tells ten times as often as one can read, and what may be done with it from this page.
import {type Json, Newest, version} from '../client';
import type {Key} from '../keys';
import {button, make} from '../make';
import {Actions} from './actions';
import {ArmingDialog} from './arming';
import {isPolar} from './coordinates';
import {Control, type Motion} from './control';
import {Device} from './device';
import {type Bend, type DeviceInfo, type Frame, kindOf} from './frame';
import {isPhone} from './phone';
import {LivePlan} from './plan_live';
import {PlanButtons} from './plan_buttons';
import type {PlanWay, Posture, TipPlace} from './plan_way';
import {heldButton} from './press';
import {lengthOf, planReadings, type Reading} from './readings';
import {RelaxAll} from './relax_all';
import {configurationOf, samplesOf} from './simulated';
import type {Opened, Stages, Stand, Subject} from './subject';

const keys: Record<string, Motion> = {m: 'move', r: 'retract', w: 'advance', b: 'back'};  // that act while they are down
const late = 500;         // ms without a frame: ten of them, so that a busy browser alone makes no alarm
const owned = 1000;       // ms that a target set here is shown, though the device does not say it yet
const apart = Math.PI / 360;  // rad between target and arm, from which on the target is drawn

export class Live implements Subject {
  get badge(): string {
    return isPhone.matches ? 'VIEW ONLY' : 'DEVICE · LIVE';
  }

  readonly bar: HTMLElement;
  readonly control: Control;
  readonly tensionLimit: number;
  frame: Frame | null = null;
  shape: Json | null = null;
  ghost: Json | null = null;
  private readonly device: Device;
  private readonly actions: Actions;
  private readonly dialog: ArmingDialog;
  private readonly plan: LivePlan;
  private readonly shapes = new Newest();
  private received = -Infinity;
  private goal: Bend[] | null = null;
  private goalAt = -Infinity;
  private asked = '';
  private degreesOfMillimetre = 0;
  private clock = 0;

  constructor(private readonly opened: Opened, readonly info: DeviceInfo, private readonly stand: Stand, box: HTMLElement) {
    this.tensionLimit = info.tension_limit;
    this.device = new Device(info, {frame: (frame) => this.take(frame), entry: (entry) => stand.entry(entry), again: () => stand.forgetEntries(), broken: () => void stand.guarded(version)});
    this.control = new Control(this.device, (why) => stand.say(why), () => stand.changed());
    this.dialog = new ArmingDialog(box, this.control, info);
    this.plan = new LivePlan(this.device, this.control, opened.robot, opened.described.answer.sections, (task) => stand.guarded(task), () => stand.changed());
    const buttons = new PlanButtons({press: (isBack) => this.frame?.plan && this.plan.press(this.frame.plan, isBack), letGo: () => this.plan.letGo(), drop: () => this.plan.drop(), say: (why) => stand.say(why.startsWith('off path') ? this.frame?.plan?.off_path?.message ?? why : why)});
    this.actions = new Actions(this.control, info, {hold: () => this.hold(), arm: () => this.frame && this.dialog.open(this.frame), say: (why) => stand.say(why)}, buttons, () => this.degreesOfMillimetre);
    this.bar = this.actions.element;
  }

  keys(): Key[] {
    const on = (keys: string[], says: string, go?: (key: string) => void): Key => ({keys, says, ...(go && {go})});
    return [
      on([' ', 'Escape'], 'hold: freeze where it is, always'), on(['m'], 'while held: move to the target; with a plan along it'), on(['b'], 'while held: back along the plan'), on(['r'], 'while held: retract along the way in'), on(['w'], 'while held: advance, follow the leader'),
      on(['x'], 'disarm', () => this.control.disarm()), on(['a'], 'acknowledge the alarm', () => this.control.acknowledge()),
      on(['-', '+', '='], 'slower, faster', (key) => this.actions.faster(key === '-' ? -1 : 1)),
    ];
  }

  /** Keys that act while they are down. @return whether this is one of them */
  keyDown(key: string): boolean {
    const motion = keys[key];
    if (motion && !isPhone.matches) this.actions.press(motion);
    return !!motion;
  }

  keyUp(key: string): void {
    const motion = keys[key];
    if (motion) this.motion(motion, false);
  }

  /** Why a motion is not to be had; null: it is. */
  locked(motion: Motion): string | null {
    return this.actions.locked(motion);
  }

  hold(): void {
    this.control.hold();
  }

  /** By the pad, a key or a gamepad. */
  motion(motion: Motion, isHeld: boolean): void {
    if (isHeld) return this.actions.press(motion);
    if (motion === 'move') this.plan.letGo();
    if (this.control.held === motion) void this.control.letGo();
  }

  /** The window has lost the focus: nothing here can be seen to move any more. */
  blur(isGone: boolean): void {
    if (this.control.held || this.frame?.state === 'armed') this.control.disarm(true);
    if (isGone) this.control.giveBack(true);
  }

  readings(): Reading[] {
    const {frame, info} = this, system = this.stand.system();
    if (!frame) return [['device', 'waiting']];
    const [x = 0, y = 0, z = 0] = frame.tip, {recording} = frame, isBad = frame.link !== 'ok';
    return [
      ['x', lengthOf(x, system)], ['y', lengthOf(y, system)], ['z', lengthOf(z, system)],
      ...(info.has_stage ? [['inserted', lengthOf(frame.insertion, system)] as Reading] : []),
      ...planReadings(frame.plan, system), ...(this.plan.isWaiting !== null && !frame.plan ? [['plan', 'waits for control'] as Reading] : []),
      ['device', isBad ? frame.link.replace('_', ' ') : `${frame.rate.toFixed(0)} Hz, ${(1e3 * frame.round_trip).toFixed(0)} ms`, isBad],
      ['wire errors', frame.errors > 0 ? String(frame.errors) : 'none', frame.errors > 0],
      ['recording', recording?.error ? 'failed' : recording ? `${recording.rows} rows` : 'off', !!recording?.error],
    ];
  }

  /** What else the drawer holds: any section relaxed, faults of a demonstration. */
  extras(): HTMLElement[] {
    const relax = this.opened.described.answer.sections.map((_: Json, section: number) => {
      const one = heldButton(() => this.control.press('relax', {section}), () => this.motion('relax', false));
      one.textContent = `Relax S${section + 1}`;
      return one;
    });
    const all = new RelaxAll(this.control, () => this.frame);
    const found = [make('h3', {textContent: 'Relax, while held'}), make('div', {className: 'buttons'}, ...relax), all.element];
    if (!this.info.faults) return found;
    const faults = ['cut 3 1', 'mend', 'stick 2 1', 'free', 'noise 0.01', 'noise 0', 'unplug', 'plug', 'reset'];
    return [...found, make('h3', {textContent: 'Faults of the demonstration'}), make('div', {className: 'buttons'}, ...faults.map((line) => button(line, () => void this.control.fault(line))))];
  }

  load(way: PlanWay): void {
    this.plan.load(way);
    this.stand.changed();
  }

  get tips(): TipPlace[] {
    return this.plan.way?.tips ?? [];
  }

  get stages(): Stages | null {
    const {frame, info} = this;
    return !info.has_stage ? null : {now: frame?.stage ?? 0, goal: this.goalOfPlan?.stage ?? frame?.stage_target ?? 0};
  }

  get isStale(): boolean {
    return this.lost !== null || !this.frame || this.frame.link === 'gone' || this.frame.link === 'silent';
  }

  get lost(): string | null {
    const waited = performance.now() - this.received;
    return waited > late && this.frame ? `, ${(waited / 1000).toFixed(0)} s` : null;
  }

  age(): string {
    const {frame} = this;
    if (!frame || !this.isStale) return '';
    return `${((frame.age ?? 0) + (performance.now() - this.received) / 1000).toFixed(1)} s old`;
  }

  targets(): Bend[] {
    return this.goal ?? this.frame?.sections.map(({target}) => target) ?? [];
  }

  may(): boolean {
    const why = isPhone.matches ? 'a phone looks on and holds' : this.control.isMine ? '' : 'take control to set a target';
    if (why) this.stand.say(why);
    return !why;
  }

  get mayQuietly(): boolean {
    return !isPhone.matches && this.control.isMine;
  }

  aim(bends: Bend[]): void {
    [this.goal, this.goalAt] = [bends, performance.now()];
    this.control.aim({bends});
    this.stand.changed();
  }

  aimStage(stage: number): void {
    this.control.aim({stage});
  }

  show(): void {
    if (!this.frame) return;
    this.actions.show(this.frame, this.stand.chosen(), this.lost !== null);
    this.dialog.show(this.frame);
    this.bar.parentElement?.classList.toggle('lost', this.isStale);
  }

  enter(): void {
    this.device.listen();
    this.clock = window.setInterval(() => this.isStale && this.stand.changed(), 250);
    void this.stand.guarded(() => this.measureTurn());
  }

  leave(): void {
    this.control.giveBack();
    this.dialog.close();
    clearInterval(this.clock);
    this.device.deafen();
    this.stand.forgetEntries();
  }

  close(): void {
    this.leave();
  }

  private take(frame: Frame): void {
    [this.frame, this.received] = [frame, performance.now()];
    if (this.goal && performance.now() - this.goalAt > owned) this.goal = null;
    if (this.goal) frame.sections.forEach((one, i) => { one.target = this.goal![i] ?? one.target; });
    this.plan.take(frame);
    this.stand.heard();
    this.stand.changed();
    this.ask(frame);
  }

  /** The arm where it is measured, and where it is to go if that is elsewhere. */
  private ask({sections, model = 'lsk'}: Frame): void {
    if (sections.some(({word}) => kindOf(word) === 'stale') && this.shape) return;
    const changes = sections.map((one) => one.changes.map((value) => Number(value.toFixed(6)))), targets = this.goalOfPlan?.bends ?? this.targets(), {robot, described, inputs} = this.opened;
    const isElsewhere = sections.some(({point, measured}, i) => Math.hypot(targets[i]![0] - (measured ?? point ?? targets[i]!)[0], targets[i]![1] - (measured ?? point ?? targets[i]!)[1]) > apart);
    const samples = samplesOf(described.answer.sections), now = {query: 'shape', changes, model, samples}, to = {query: 'shape', configuration: configurationOf(described, targets, inputs), samples};
    const asked = JSON.stringify([changes, model, isElsewhere && to]);
    if (asked === this.asked) return;
    this.asked = asked;
    this.shapes.put(() => this.stand.guarded(async () => {
      const [shape, ghost] = await robot.ask(isElsewhere ? [now, to] : [now]) as [Json, Json?];
      if (shape.backbones) this.shape = shape;
      this.ghost = ghost?.backbones ? ghost : null;
      this.stand.changed();
    }));
  }

  /** Where a plan leads: to its end, or first to its beginning. */
  private get goalOfPlan(): Posture | null {
    const {way} = this.plan, {frame} = this;
    return way && frame?.plan ? (frame.plan.off_path ? way.steps[0]! : way.steps[way.last]!) : null;
  }

  /** How far a section turns by a millimetre of its tendons. */
  private async measureTurn(): Promise<void> {
    const {robot, described} = this.opened, {sections} = described.answer, small = Math.PI / 180;
    const [answer] = await robot.ask([{query: 'forward', model: 'lsk', configuration: [[small, 0, ...(isPolar(sections[0]) && described.inputs.length > 2 * sections.length ? [0] : [])]]}]) as [Json];
    const most = Math.max(...(answer.changes?.[0] ?? [0]).map(Math.abs));
    this.degreesOfMillimetre = most > 0 ? 1e-3 / most : 0;
  }
}
