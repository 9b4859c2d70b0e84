// The bar below the curves: play, one step, how quickly, and a slider over the steps with marks where it is tight or fails.
import {button, make} from './make';
import type {Plan} from './plan';
import type {System} from './units';
import {withUnit} from './answer';

const speeds = [0.25, 0.5, 1, 2, 4, 8];
const rate = 20;  // steps a second at the usual speed: a plan has no times

export class Transport {
  isPlaying = false;
  private readonly play = button('▶ Play', () => this.toggle(), 'play or pause (Space)');
  private readonly speed = make('select', {title: 'how quickly (J slower, L faster)'});
  private readonly slider = make('input', {type: 'range', min: '0', step: '1', value: '0'});
  private readonly marks = make('div', {className: 'marks'});
  private readonly text = make('span', {className: 'time'});
  private plan: Plan | null = null;
  private system: System = 'mm';
  private step = 0;
  private since = 0;  // when the last step was played [ms]

  /** @param isThere whether the picture of a step is */
  constructor(section: HTMLElement, private readonly go: (step: number) => void, private readonly isThere: () => boolean) {
    for (const speed of speeds) this.speed.add(new Option(`${speed}×`, String(speed)));
    this.speed.value = '1';
    this.speed.setAttribute('aria-label', 'Speed');
    this.slider.setAttribute('aria-label', 'Step');
    this.slider.addEventListener('input', () => this.go(Number(this.slider.value)));
    this.play.classList.add('main');
    const back = button('|◀', () => this.by(-1), 'one step back (,)'), forth = button('▶|', () => this.by(1), 'one step on (.)');
    back.ariaLabel = 'one step back';
    forth.ariaLabel = 'one step on';
    section.append(back, this.play, forth, this.speed, make('div', {className: 'time-line'}, this.marks, this.slider), this.text);
  }

  show(plan: Plan, system: System): void {
    [this.plan, this.system] = [plan, system];
    this.slider.max = String(plan.last);
    const place = (step: number) => `calc(8px + (100% - 16px) * ${(step / Math.max(plan.last, 1)).toFixed(5)})`;
    const failed = plan.failed.map(({from, to, isLimit}) => {
      const mark = make('span', {className: 'failed', textContent: '×', title: isLimit ? 'limit exceeded' : 'touches'});
      mark.style.left = place(from);
      mark.style.width = `calc((100% - 16px) * ${((to - from) / Math.max(plan.last, 1)).toFixed(5)})`;
      return mark;
    });
    const tight = plan.spots.filter((step) => !plan.isBad(step)).map((step) => {
      const mark = make('span', {className: 'tight', title: 'tight spot'});
      mark.style.left = place(step);
      return mark;
    });
    this.marks.replaceChildren(...tight, ...failed);
    this.at(this.step);
  }

  at(step: number): void {
    this.step = step;
    this.slider.value = String(step);
    if (!this.plan) return;
    const stage = `stage ${withUnit(this.plan.steps[step]!.stage, 'm', this.system)}`, {times, last} = this.plan, count = times ? `${times[step]!.toFixed(2)} / ${times[last]!.toFixed(2)} s` : `step ${step} / ${last}`;
    this.slider.setAttribute('aria-valuetext', `${count}, ${stage}`);
    this.text.replaceChildren(make('strong', {textContent: count}), make('span', {textContent: stage}));
  }

  by(steps: number): void {
    this.pause();
    this.go(this.step + steps);
  }

  toggle(): void {
    if (this.isPlaying || !this.plan) return this.pause();
    if (this.step === this.plan.last) this.go(0);
    this.isPlaying = true;
    this.say();
    this.since = performance.now();
    requestAnimationFrame(() => this.tick());
  }

  pause(): void {
    this.isPlaying = false;
    this.say();
  }

  faster(by: number): void {
    const at = speeds.indexOf(Number(this.speed.value));
    this.speed.value = String(speeds[Math.min(speeds.length - 1, Math.max(0, at + by))]!);
  }

  private say(): void {
    this.play.textContent = this.isPlaying ? '❚❚ Pause' : '▶ Play';
  }

  /** Steps whose picture is not there yet are waited for. */
  private tick(): void {
    if (!this.isPlaying || !this.plan) return;
    const now = performance.now(), passed = ((now - this.since) / 1000) * Number(this.speed.value), {plan, step} = this;
    const steps = plan.times ? plan.stepAt(plan.placeOf(step) + passed) - step : Math.floor(passed * rate);
    if (!this.isThere()) this.since = now;
    else if (steps > 0) {
      this.since = now;
      this.go(Math.min(this.plan.last, this.step + steps));
    }
    if (this.step === this.plan.last) return this.pause();
    requestAnimationFrame(() => this.tick());
  }
}
