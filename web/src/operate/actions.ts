// The bar of what a device can be made to do. What is locked says why, in its place.
import {button, make} from '../make';
import type {Control, Motion} from './control';
import {type DeviceInfo, type Frame, kindOf} from './frame';
import type {PlanButtons} from './plan_buttons';
import {heldButton, Labelled, slowButton} from './press';

const [slowest, fastest, step] = [0.5, 20, 0.5];  // mm/s

const relaxAfter = 1000;  // ms
const takeFirst = 'take control first';

export interface Orders { hold(): void; arm(): void; say(why: string): void }

export class Actions {
  readonly element = make('div', {className: 'actions-of'});
  private readonly hold = new Labelled(button('', () => this.orders.hold(), 'freeze where it is, from every page (Space, Esc)'));
  private readonly advance = this.motion('advance');
  private readonly retract = this.motion('retract');
  private readonly straighten = this.motion('straighten');
  private readonly relax = new Labelled(slowButton('', relaxAfter, () => this.press('relax'), () => this.letGo('relax'), () => this.may('relax')));
  private readonly move = this.motion('move');
  private readonly lease = new Labelled(button('', () => this.turnLease()));
  private readonly arm = new Labelled(button('', () => this.turnArm()));
  private readonly slider = make('input', {type: 'range', min: String(slowest), max: String(fastest), step: String(step), value: '2', id: 'jog-speed'});
  private readonly speedText = make('output', {htmlFor: 'jog-speed'} as object);
  private readonly turnText = make('span', {className: 'turn'});
  private speedSetAt = -Infinity;
  private frame: Frame | null = null;
  private chosen = 0;
  private isLost = false;

  constructor(private readonly control: Control, info: DeviceInfo, private readonly orders: Orders, private readonly plan: PlanButtons, private readonly degreesOfMillimetre: () => number) {
    this.hold.element.classList.add('hold');
    this.move.element.classList.add('move');
    this.slider.addEventListener('input', () => this.setSpeed(Number(this.slider.value)));
    const label = make('label', {htmlFor: 'jog-speed'}, 'Jog speed ', make('kbd', {textContent: '−'}), ' / ', make('kbd', {textContent: '+'}));
    this.element.append(this.hold.element, ...(info.has_stage ? [make('div', {className: 'pair-of'}, this.advance.element, this.retract.element)] : []), this.straighten.element, this.plan.pair, this.relax.element,
                        make('div', {className: 'speed'}, label, this.slider, this.speedText, this.turnText), make('div', {className: 'arming'}, this.move.element, this.plan.follow.element, this.arm.element, this.lease.element));
  }

  private motion(motion: Motion): Labelled {
    const labelled: Labelled = new Labelled(heldButton(() => this.press(motion), () => this.letGo(motion)));
    labelled.element.dataset.motion = motion;
    return labelled;
  }

  private letGo(motion: Motion): void {
    if (this.control.held === motion) void this.control.letGo();
  }

  /** Where it may not, it says why. */
  private may(motion: Motion): boolean {
    const why = this.locked(motion);
    if (why) this.orders.say(why);
    return !why;
  }

  /** By a button or a key. */
  press(motion: Motion): void {
    if (motion === 'back' || (motion === 'move' && this.frame?.plan)) return this.frame?.plan ? this.plan.press(motion === 'back') : undefined;
    if (this.may(motion)) this.control.press(motion, motion === 'relax' ? {section: this.relaxed} : {});
  }

  faster(by: number): void {
    this.setSpeed(Math.min(fastest, Math.max(slowest, Number(this.slider.value) + by * step)));
  }

  /** @param isLost frames do not come any more: who controls it now is not known */
  show(frame: Frame, chosen: number, isLost: boolean): void {
    [this.frame, this.chosen, this.isLost] = [frame, chosen, isLost];
    const {control} = this, isMine = this.isMine, isArmed = isMine && frame.state === 'armed', isBusy = (motion: Motion) => control.held === motion;
    this.hold.say('HOLD', 'Space', frame.activity === 'holding' ? 'held' : '', false);
    this.put(this.advance, 'Advance', 'W', 'advance', 'on its path');
    this.put(this.retract, 'Retract', 'R', 'retract', 'the way back');
    this.put(this.straighten, 'Straighten', '', 'straighten', 'hold: all bends to zero');
    this.put(this.relax, `Relax S${this.relaxed + 1}`, '', 'relax', this.payOut);
    this.relax.element.classList.toggle('wanted', this.isOver);
    this.put(this.move, 'MOVE', 'M', 'move', isBusy('move') ? 'release to stop' : 'hold: to the target');
    this.move.element.hidden = !isArmed || !!frame.plan;
    this.straighten.element.hidden = !!frame.plan;
    this.showPlan(frame, isArmed);
    this.arm.element.hidden = !isMine;
    if (isArmed) this.arm.say('Disarm', 'X', `armed ${frame.armed_left.toFixed(0)} s`, false);
    else this.arm.say(this.isOver ? `DISARMED by S${this.over + 1}` : 'Arm…', '', this.isOver ? 'clear the alarm, then arm' : frame.why ? `disarmed: ${frame.why}` : 'nothing moves before', this.isOver);
    this.lease.element.hidden = isArmed;
    const taken = !isMine && frame.control.holder !== null;
    if (isMine) this.lease.say('Release', '', 'control', false);
    else if (isLost) this.lease.say('VIEW ONLY', '', 'no connection', true);
    else this.lease.say(taken ? 'VIEW ONLY' : 'Take control', '', taken ? `another page controls since ${frame.control.since}` : 'one page at a time may move it', taken);
    this.element.dataset.state = isArmed ? 'armed' : isMine ? 'control' : 'view';
    this.speed(frame);
  }

  private showPlan({plan}: Frame, isArmed: boolean): void {
    if (!plan) return this.plan.hide();
    const {off_path: off} = plan, {held} = this.control, lost = off && !off.to_first ? 'off path: retract' : null, isFirst = plan.step === 0 && plan.fraction === 0;
    const follow = this.locked('follow') ?? lost, back = this.locked('back') ?? (off ? 'off path' : isFirst ? 'at its first step' : null);
    this.plan.show(plan, {follow, back}, held === 'back' ? 'back' : held === 'follow' || (held === 'move' && off) ? 'follow' : null, isArmed);
  }

  private put(of: Labelled, word: string, key: string, motion: Motion, note: string): void {
    const why = this.locked(motion);
    of.say(word, key, why === takeFirst ? 'view only' : why ?? note, !!why);
    of.element.classList.toggle('pressed', this.control.held === motion && (motion !== 'relax' || this.control.section === this.relaxed));
  }

  private get isMine(): boolean {
    return this.control.isMine && this.frame?.control.holder === this.control.number;
  }

  private get over(): number {
    return this.frame!.sections.findIndex(({word}) => kindOf(word) === 'over');
  }

  private get isOver(): boolean {
    return this.over >= 0;
  }

  private get payOut(): string {
    const lacks = this.frame!.sections[this.relaxed]?.amount ?? 0;
    return this.isOver && lacks > 0 ? `hold 1 s: pays out ${(1e3 * lacks).toFixed(2)} mm` : 'hold 1 s: until slack';
  }

  /** What is over-tensioned comes first. */
  private get relaxed(): number {
    return this.isOver ? this.over : this.chosen;
  }

  /** Why a motion is not to be had; null: it is. The server knows better, and says so where it does. */
  locked(motion: Motion): string | null {
    const {frame} = this;
    if (!frame || !this.isMine) return takeFirst;
    if (frame.link === 'gone' || frame.link === 'silent' || frame.link === 'wrong_table') return 'no data';
    if (motion === 'relax') return null;
    if (this.isOver) return `locked: S${this.over + 1}`;
    if (motion === 'home') return null;
    if (!frame.homed) return 'not homed';
    if (motion === 'straighten' && frame.insertion > 5e-4) return `locked: ${(1e3 * frame.insertion).toFixed(0)} mm in`;
    if (motion === 'advance' && frame.plan) return 'drop the plan first';
    if (frame.state !== 'armed') return 'arm first';
    return frame.recording?.error ? 'recording failed' : null;
  }

  private turnLease(): void {
    if (this.control.isMine) this.control.giveBack();
    else if (!this.lease.isLocked) void this.control.take();
    else this.orders.say(this.isLost ? 'no connection: who controls it is not known' : `another page controls since ${this.frame?.control.since}; Hold works from here, too`);
  }

  private turnArm(): void {
    if (this.frame?.state === 'armed') this.control.disarm();
    else if (this.arm.isLocked) this.orders.say(`clear the alarm of S${this.over + 1} first: hold Relax S${this.over + 1}`);
    else this.orders.arm();
  }

  // Speed

  private setSpeed(value: number): void {
    this.slider.value = String(value);
    this.tell(value);
    this.speedSetAt = performance.now();
    this.control.speed(value / 1e3);
  }

  /** What the device says, unless the slider was moved just now. */
  private speed({speed}: Frame): void {
    if (performance.now() - this.speedSetAt < 1000) return;
    this.slider.value = String(1e3 * speed);
    this.tell(1e3 * speed);
  }

  private tell(millimetres: number): void {
    const turn = this.degreesOfMillimetre(), said = `${Number(millimetres.toFixed(1))} mm/s`, degrees = turn > 0 ? `≈ ${(turn * millimetres).toFixed(0)} °/s` : '';
    if (this.speedText.textContent !== said) this.speedText.textContent = said;
    if (this.turnText.textContent !== degrees) this.turnText.textContent = degrees;
    this.slider.setAttribute('aria-valuetext', `${said} ${degrees}`);
  }
}
