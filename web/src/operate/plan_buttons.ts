// The buttons of a plan: along it and back while they are held, and without it again.
import {button, make} from '../make';
import {heldButton, Labelled} from './press';

/** What is told of a plan: how far along it the arm is, of a device as its frames have it. */
export interface PlanFrame {
  name: string; number: number; step: number; of: number; fraction: number; clearance: number | null; done: boolean;
  off_path: {bend: number | null; section: number; stage: number | null; to_first: boolean; message: string} | null;
}

export interface PlanOrders { press(isBack: boolean): void; letGo(): void; drop(): void; say(why: string): void }

/** What each button says where it may not be pressed; null: it may. */
export interface PlanLocks { follow: string | null; back: string | null }

export class PlanButtons {
  readonly follow: Labelled;
  readonly pair = make('div', {className: 'pair-of plan-pair'});
  private readonly back: Labelled;
  private readonly drop: Labelled;
  private locks: PlanLocks = {follow: null, back: null};

  constructor(private readonly orders: PlanOrders) {
    const held = (isBack: boolean) => new Labelled(heldButton(() => this.press(isBack), () => orders.letGo()));
    [this.follow, this.back, this.drop] = [held(false), held(true), new Labelled(button('', () => orders.drop(), 'without the plan again'))];
    this.follow.element.classList.add('move', 'follow');
    this.follow.element.dataset.motion = 'follow';
    this.back.element.dataset.motion = 'back';
    this.drop.element.classList.add('drop');
    this.pair.append(this.back.element, this.drop.element);
    this.hide();
  }

  /** By a button or a key. */
  press(isBack: boolean): void {
    const why = isBack ? this.locks.back : this.locks.follow;
    if (why) this.orders.say(why);
    else this.orders.press(isBack);
  }

  hide(): void {
    for (const one of [this.pair, this.follow.element]) one.hidden = true;
  }

  /** @param held which of them is down */
  show(plan: PlanFrame, locks: PlanLocks, held: 'follow' | 'back' | null, isAllowed = true): void {
    this.locks = locks;
    this.pair.hidden = false;
    this.follow.element.hidden = !isAllowed;
    const isToFirst = !!plan.off_path?.to_first, goes = `hold: step ${plan.step} of ${plan.of}`;
    this.follow.say(isToFirst ? 'MOVE' : 'FOLLOW PLAN', 'M', locks.follow ?? (held === 'follow' ? 'release to stop' : isToFirst ? 'hold: to the first step' : plan.done ? 'at its end' : goes), !!locks.follow);
    this.back.say('Back', 'B', locks.back ?? (held === 'back' ? 'release to stop' : 'hold'), !!locks.back);
    this.drop.say('Drop plan', '', plan.name, false);
    this.follow.element.classList.toggle('pressed', held === 'follow');
    this.back.element.classList.toggle('pressed', held === 'back');
  }
}
