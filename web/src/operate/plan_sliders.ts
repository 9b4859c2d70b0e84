// A plan on the arm of sliders: while a button is held the arm goes along it, its drives at one speed.
import type {PlanFrame} from './plan_buttons';
import type {Posture, PlanWay} from './plan_way';

const speed = 10e-3;  // m/s of the drive that has farthest to go
const period = 50;    // ms between postures that are asked for

export class SlidersPlan {
  held: 'follow' | 'back' | null = null;
  private timer = 0;
  private since = 0;

  /** @param go to a posture of it @param place in steps */
  constructor(readonly way: PlanWay, private readonly go: (posture: Posture) => void, private place: number) {}

  toLink(link: URLSearchParams): void {
    link.set('plan', this.way.handle);
    link.set('step', String(Number(this.place.toFixed(3))));
  }

  get posture(): Posture {
    return this.way.at(this.place);
  }

  get frame(): PlanFrame {
    const {name, last} = this.way, step = Math.floor(this.place);
    return {name, number: 1, step, of: last, fraction: this.place - step, clearance: this.way.clearanceAt(this.place), done: this.place >= last, off_path: null};
  }

  press(isBack: boolean): void {
    this.letGo();
    this.held = isBack ? 'back' : 'follow';
    this.since = performance.now();
    this.timer = window.setInterval(() => this.step(isBack), period);
    this.go(this.posture);
  }

  letGo(): void {
    clearInterval(this.timer);
    this.held = null;
  }

  private step(isBack: boolean): void {
    const now = performance.now();
    this.place = this.way.gone(this.place, (speed * Math.min(200, now - this.since)) / 1000, isBack);
    this.since = now;
    this.go(this.posture);
  }
}
