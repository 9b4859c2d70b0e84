// The time line of a recording: play, scrub, how quickly, the next alarm; what happened is marked above it.
import {button, make} from '../make';
import {kindOf, kindOfEntry} from './frame';
import type {Recording} from './recording';

const speeds = [0.1, 0.25, 0.5, 1, 2, 4, 8, 16];

export interface Wishes {
  go(time: number): void;
  next(): void;
  way(): void;              ///< on the screen Trajectory
  report(): void;
  close(): void;
  isThere(): boolean;       ///< what was asked last is shown
  turned(): void;           ///< another speed
  hold: (() => void) | null;  ///< of a device that is there, too
}

export class ReplayBar {
  isPlaying = false;
  readonly element = make('div', {className: 'replay-of'});
  private readonly play = button('▶ Play', () => this.toggle(), 'play or pause (Space)');
  private readonly speedBox = make('select', {title: 'how quickly (− slower, + faster)', ariaLabel: 'Speed'});
  private readonly slider = make('input', {type: 'range', min: '0', step: 'any', value: '0', ariaLabel: 'Time'});
  private readonly marks = make('div', {className: 'marks', ariaHidden: 'true'});
  private readonly text = make('span', {className: 'time'});
  private readonly reporter = button('Report', () => this.wishes.report(), 'one page with all of it, to keep or to print');
  private time = 0;
  private since = 0;  // ms of the last picture

  constructor(private readonly recording: Recording, private readonly wishes: Wishes) {
    for (const speed of speeds) this.speedBox.add(new Option(`${speed}×`, String(speed)));
    this.speedBox.value = '1';
    this.speedBox.addEventListener('change', () => wishes.turned());
    this.slider.max = String(recording.duration);
    this.slider.addEventListener('input', () => this.jump(Number(this.slider.value)));
    this.slider.addEventListener('keydown', (event) => ['ArrowLeft', 'ArrowRight'].includes(event.key) && (event.preventDefault(), this.by(event.key === 'ArrowLeft' ? -1 : 1)));
    this.play.classList.add('main');
    const hold = wishes.hold ? [button('HOLD', wishes.hold, 'of the device: freeze where it is (Esc)')] : [], next = button('Next alarm', () => wishes.next(), 'jump there (n)');
    for (const one of hold) one.className = 'hold';
    const way = button('Trajectory', () => wishes.way(), 'the way of its tip, and bends over time');
    way.classList.add('to-way');
    next.append(make('kbd', {textContent: 'N'}));
    this.element.append(...hold, this.play, this.speedBox, make('div', {className: 'time-line'}, this.marks, this.slider), this.text, next, way, this.reporter, button('Close', () => wishes.close(), 'back to where it was opened'));
    this.mark();
  }

  get speed(): number {
    return Number(this.speedBox.value);
  }

  set isReporting(is: boolean) {
    this.reporter.disabled = is;
  }

  at(time: number): void {
    this.time = time;
    const {duration} = this.recording, clock = this.recording.clock(time), said = `${time.toFixed(2)} / ${duration.toFixed(2)} s`;
    if (Number(this.slider.value) !== time) this.slider.value = String(time);
    this.slider.setAttribute('aria-valuetext', `${time.toFixed(2)} s of ${duration.toFixed(2)} s, ${clock}`);
    this.text.replaceChildren(make('strong', {textContent: clock}), make('span', {textContent: said}));
  }

  /** By a hand: it plays no more. */
  jump(time: number): void {
    this.pause();
    this.wishes.go(time);
  }

  by(rows: number): void {
    const {recording} = this, row = recording.rowAt(this.time), to = Math.min(recording.rows - 1, Math.max(0, row + rows));
    this.jump(rows < 0 && this.time > recording.times[row]! + 1e-9 && rows === -1 ? recording.times[row]! : recording.times[to]!);
  }

  toggle(): void {
    if (this.isPlaying) return this.pause();
    if (this.time >= this.recording.duration) this.wishes.go(0);
    this.isPlaying = true;
    this.say();
    this.since = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  pause(): void {
    this.isPlaying = false;
    this.say();
  }

  faster(by: number): void {
    const at = speeds.indexOf(this.speed);
    this.speedBox.value = String(speeds[Math.min(speeds.length - 1, Math.max(0, at + by))]!);
    this.wishes.turned();
  }

  private say(): void {
    this.play.textContent = this.isPlaying ? '❚❚ Pause' : '▶ Play';
  }

  /** What is not there yet is waited for: time stands still, and nothing is passed over unseen. */
  private tick(now: number): void {
    if (!this.isPlaying) return;
    if (!this.element.isConnected) return this.pause();
    const passed = Math.max(0, now - this.since) / 1000;
    if (this.wishes.isThere()) this.wishes.go(Math.min(this.recording.duration, this.time + passed * this.speed));
    this.since = Math.max(now, this.since);
    if (this.time >= this.recording.duration) return this.pause();
    requestAnimationFrame((then) => this.tick(then));
  }

  private mark(): void {
    const {duration, alarms, events} = this.recording, part = (time: number) => time / Math.max(duration, 1e-9), left = (time: number) => `calc(8px + (100% - 16px) * ${part(time).toFixed(5)})`;
    const bands = alarms.map(({section, word, from, to}) => {
      const band = make('span', {className: `band ${kindOf(word)}`, title: `S${section + 1} ${word}, ${(to - from).toFixed(1)} s`});
      band.style.left = left(from);
      band.style.width = `calc((100% - 16px) * ${part(to - from).toFixed(5)})`;
      return band;
    });
    const ticks = events.filter(({kind}) => !kindOfEntry(kind)).map(({time, kind, text}) => {
      const one = make('span', {className: kind === 'snapshot' ? 'snap' : 'happened', title: text});
      one.style.left = left(time);
      return one;
    });
    this.marks.replaceChildren(...bands, ...ticks);
  }
}
