// Who may move the device, and what moves it now. One button at a time is held down: while it is, the server is told so
// ten times a second; a release, a lost focus or a lost lease ends it, and the server ends it by itself where nothing is heard.
import {Refused} from '../client';
import type {Device} from './device';
import type {Bend} from './frame';
import {isPhone} from './phone';

const beat = 100;  // ms

export type Motion = 'move' | 'straighten' | 'retract' | 'advance' | 'relax' | 'home' | 'follow' | 'back';

/** Back along a plan is its call, too. */
const callOf = (motion: Motion) => (motion === 'back' ? 'follow' : motion);

export class Control {
  number = 0;  ///< of the lease; 0: none
  held: Motion | null = null;
  private lease = '';
  private renewing = 0;
  private body: object = {};
  private over: ((isDone: boolean) => void) | null = null;
  private beating = 0;
  private presses = 0;
  private flight: AbortController | null = null;  // of the heartbeat that is on its way
  private goal: {bends?: Bend[]; stage?: number} | null = null;
  private isAiming = false;
  private wanted: number | null = null;  // speed that waits
  private isSetting = false;

  /** @param says why something was refused @param changed lease or button are others now */
  constructor(private readonly device: Device, private readonly says: (why: string) => void, private readonly changed: () => void) {}

  /** That is relaxed while its button is held. */
  get section(): number {
    return (this.body as {section?: number}).section ?? -1;
  }

  get isMine(): boolean {
    return this.lease !== '';
  }

  async take(): Promise<void> {
    if (isPhone.matches) return this.says('a phone looks on and holds');
    await this.try(async () => {
      const {lease, number} = await this.device.call('lease');
      [this.lease, this.number] = [lease, number];
      this.changed();
      this.renewLater();
    });
  }

  giveBack(isLast = false): void {
    void this.letGo(isLast);
    if (!this.isMine) return;
    void this.device.call('release', {lease: this.lease}, undefined, isLast).catch(() => undefined);
    this.lose();
  }

  arm(): Promise<boolean> {
    return this.ask('arm');
  }

  /** @param isLast the window has lost the focus, or is being closed */
  disarm(isLast = false): void {
    void this.letGo(isLast);
    if (this.isMine) void this.device.call('disarm', {lease: this.lease}, undefined, isLast).catch(() => undefined);
  }

  /** By anyone, armed or not. */
  hold(): void {
    void this.letGo();
    void this.try(() => this.device.call('hold'));
  }

  /** As of targets: several at once would come in any order. */
  speed(tendon: number): void {
    this.wanted = tendon;
    if (!this.isSetting) void this.sendSpeeds();
  }

  private async sendSpeeds(): Promise<void> {
    this.isSetting = true;
    while (this.wanted !== null) {
      const tendon = this.wanted;
      this.wanted = null;
      await this.ask('speed', {tendon});
    }
    this.isSetting = false;
  }

  acknowledge(): void {
    void this.try(() => this.device.call('acknowledge'));
  }

  fault(line: string): Promise<boolean> {
    if (isPhone.matches) return Promise.resolve(false);
    return this.try(() => this.device.call('fault', {line}));
  }

  /** The newest one counts: while one is on its way, others wait and are overtaken. */
  aim(goal: {bends?: Bend[]; stage?: number}): void {
    this.goal = {...this.goal, ...goal};
    if (!this.isAiming) void this.sendGoals();
  }

  private async sendGoals(): Promise<void> {
    this.isAiming = true;
    while (this.goal) {
      const goal = this.goal;
      this.goal = null;
      await this.ask('target', goal);
    }
    this.isAiming = false;
  }

  /** Until the device has it. */
  target(goal: {bends: Bend[]; stage: number}): Promise<boolean> {
    return this.ask('target', goal);
  }

  /** A plan to be followed; an empty one drops it. */
  plan(body: object): Promise<boolean> {
    return this.ask('plan', body);
  }

  // What is held

  /** @param over it ended, and nobody let go: it is done, or refused */
  press(motion: Motion, body: object = {}, over: (isDone: boolean) => void = () => undefined): void {
    if (this.held) return over(false);
    if (!this.isMine) {
      this.says('take control first');
      return over(false);
    }
    const press = ++this.presses;  // by which words that come late are known
    [this.held, this.body, this.over] = [motion, {...body, ...(motion === 'back' && {back: true}), press}, over];
    this.changed();
    void this.tell();
    this.beating = window.setInterval(() => void this.tell(), beat);
  }

  /** The last thing that is said of it: a heartbeat that is on its way is called back, and the end is told twice. */
  async letGo(isLast = false): Promise<void> {
    const {held, body, lease} = this;
    if (!held) return;
    clearInterval(this.beating);
    this.flight?.abort();
    [this.held, this.flight, this.over] = [null, null, null];
    const end = () => this.device.call(callOf(held), {...body, lease, held: false}, undefined, isLast).catch(() => undefined);
    if (!isLast) setTimeout(() => this.held === held || void end(), beat);
    this.changed();
    await end();
  }

  private async tell(): Promise<void> {
    const {held} = this;
    if (!held || this.flight) return;
    const flight = this.flight = new AbortController();
    try {
      await this.device.call(callOf(held), {...this.body, lease: this.lease, held: true}, flight.signal);
    } catch (error) {
      if (flight.signal.aborted) return;
      const isDone = error instanceof Refused && error.answer.error?.code === 'done', {over} = this;
      if (!isDone) this.refused(error);
      void this.letGo().then(() => over?.(isDone));
    } finally {
      if (this.flight === flight) this.flight = null;
    }
  }

  // The lease

  private renewLater(): void {
    clearTimeout(this.renewing);
    this.renewing = window.setTimeout(() => void this.renew(), beat);
  }

  private async renew(): Promise<void> {
    if (!this.isMine) return;
    try {
      await this.device.call('lease', {lease: this.lease});
      this.renewLater();
    } catch (error) {
      if (!this.isMine) return;
      this.says(error instanceof Refused ? `control is lost: ${error.message}` : 'control is lost: no connection');
      this.lose();
    }
  }

  private lose(): void {
    clearTimeout(this.renewing);
    [this.lease, this.number] = ['', 0];
    clearInterval(this.beating);
    this.flight?.abort();
    const {over} = this;
    [this.held, this.flight, this.over] = [null, null, null];
    over?.(false);
    this.changed();
  }

  private ask(call: string, body: object = {}): Promise<boolean> {
    if (!this.isMine) {
      this.says('take control first');
      return Promise.resolve(false);
    }
    return this.try(() => this.device.call(call, {...body, lease: this.lease}));
  }

  private async try(task: () => Promise<unknown>): Promise<boolean> {
    try {
      await task();
      return true;
    } catch (error) {
      this.refused(error);
      return false;
    }
  }

  private refused(error: unknown): void {
    this.says(error instanceof Error ? error.message : String(error));
  }
}
