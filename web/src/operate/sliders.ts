// The source SLIDERS: a simulated arm, whose target acts at once.
import {copy} from '../clipboard';
import {type Json, Newest} from '../client';
import type {Key} from '../keys';
import type {Motion} from './control';
import {bendsOf, inputsOf} from './coordinates';
import {type Bend, type Frame, kindOf} from './frame';
import {PlanButtons} from './plan_buttons';
import {SlidersPlan} from './plan_sliders';
import type {PlanWay, Posture, TipPlace} from './plan_way';
import {lengthOf, planReadings, type Reading} from './readings';
import {command, simulate} from './simulated';
import {SlidersBar} from './sliders_bar';
import type {Opened, Stages, Stand, Subject} from './subject';

const kinds = {exact: 'exact', slack: 'slack', over: 'over', unreachable: 'unreachable', stale: 'no_data'} as const;

export class Sliders implements Subject {
  readonly badge = 'SLIDERS';
  readonly tensionLimit = 0;
  frame: Frame | null = null;
  shape: Json | null = null;
  readonly ghost = null;
  isStale = false;
  readonly lost = null;
  slack: number[];
  private bends: Bend[];
  private changes: number[][] = [];
  private words: string[] = [];
  private isOver = false;
  private readonly newest = new Newest();
  private plan: SlidersPlan | null = null;
  private readonly buttons = new PlanButtons({press: (isBack) => this.plan?.press(isBack), letGo: () => this.letGo(), drop: () => this.drop(), say: (why) => this.stand.say(why)});
  private readonly sliders = new SlidersBar(this.buttons, {straighten: () => this.straighten(), slacken: (section, slack) => this.slacken(section, slack), command: () => this.command()});
  readonly bar = this.sliders.element;

  constructor(private readonly opened: Opened, private readonly stand: Stand, slack: number[]) {
    this.bends = bendsOf(opened.described, opened.inputs);
    this.slack = this.bends.map((_, i) => slack[i] ?? 0);
  }

  keys(): Key[] {
    return [
      {keys: ['m'], says: 'while held: along the plan'}, {keys: ['b'], says: 'while held: back along the plan'},
      {keys: ['-', '+', '='], says: 'less slack of the chosen section, more', go: (key) => this.slacken(this.stand.chosen(), (this.slack[this.stand.chosen()] ?? 0) + (key === '-' ? -1e-4 : 1e-4))},
      {keys: ['Ctrl+c'], says: 'copy the command, where nothing is selected', go: () => void copy(this.command(), 'command copied')},
    ];
  }

  /** The robot's rows, as the screen Design has them. */
  get inputs(): number[] {
    return inputsOf(this.opened.described, this.bends, this.opened.inputs);
  }

  use(inputs: number[]): void {
    this.bends = bendsOf(this.opened.described, inputs);
  }

  readings(): Reading[] {
    const [x = 0, y = 0, z = 0] = this.frame?.tip ?? [], system = this.stand.system(), worst = this.frame?.sections.filter(({word}) => kindOf(word) !== 'exact').length ?? 0;
    return [['x', lengthOf(x, system)], ['y', lengthOf(y, system)], ['z', lengthOf(z, system)], ['sections', String(this.bends.length)], ['not exact', String(worst)], ['model', 'LSK'],
            ...(this.plan ? [['inserted', lengthOf(this.plan.posture.stage, system)] as Reading, ...planReadings(this.plan.frame, system)] : [])];
  }

  toLink(link: URLSearchParams): void {
    if (this.slack.some((one) => one !== 0)) link.set('slack', this.slack.join(','));
    this.plan?.toLink(link);
  }

  targets(): Bend[] {
    return this.bends;
  }

  may(): boolean {
    return true;
  }

  load(way: PlanWay, place?: number): void {
    this.letGo();
    this.plan = new SlidersPlan(way, (posture) => this.go(posture), Math.min(way.last, Math.max(0, place || 0)));
    if (place === undefined) this.go(this.plan.posture);
    void this.stand.guarded(async () => {
      await way.ask(this.opened.robot, this.opened.described.answer.sections);
      this.stand.changed();
    });
  }

  get tips(): TipPlace[] {
    return this.plan?.way.tips ?? [];
  }

  get stages(): Stages | null {
    const now = this.plan?.posture.stage ?? 0;
    return this.plan && {now, goal: now};
  }

  /** Keys that act while they are down. @return whether this is one of them */
  keyDown(key: string): boolean {
    if (this.plan && (key === 'm' || key === 'b')) this.buttons.press(key === 'b');
    return !!this.plan && (key === 'm' || key === 'b');
  }

  keyUp(key: string): void {
    if (key === 'm' || key === 'b') this.letGo();
  }

  motion(motion: Motion, isHeld: boolean): void {
    if (!isHeld) this.letGo();
    else if (this.plan && (motion === 'move' || motion === 'back')) this.buttons.press(motion === 'back');
  }

  letGo(): void {
    this.plan?.letGo();
    this.stand.changed();
  }

  private drop(): void {
    this.letGo();
    this.plan = null;
    this.stand.linked();
    this.stand.changed();
  }

  private go({bends}: Posture): void {
    const {plan} = this, isAtEnd = plan?.held && (plan.held === 'follow' ? plan.frame.done : plan.frame.step === 0 && plan.frame.fraction === 0);
    this.aim(bends);
    if (isAtEnd) this.letGo();
  }

  aim(bends: Bend[]): void {
    this.bends = bends;
    this.stand.linked();
    this.ask();
  }

  age(): string {
    return '';
  }

  /** For tests: an answer is still to come. */
  get isAsking(): boolean {
    return this.newest.isBusy;
  }

  show(): void {
    const chosen = this.stand.chosen();
    if (this.plan) {
      const {frame} = this.plan;
      this.buttons.show(frame, {follow: frame.done ? 'at its end' : null, back: frame.step === 0 && frame.fraction === 0 ? 'at its first step' : null}, this.plan.held);
    } else this.buttons.hide();
    this.sliders.show(chosen, this.slack[chosen] ?? 0, this.command(), this.stand.system());
  }

  enter(): void {
    this.ask();
  }

  leave(): void {
    this.letGo();
    this.newest.drop();
  }

  close(): void {
    this.isOver = true;
    this.plan?.letGo();
    this.newest.drop();
  }

  command(): string {
    const {source} = this.opened;
    return this.changes.length > 0 ? command(source.word, source.sets, this.stand.chosen(), this.changes) : '';
  }

  private straighten(): void {
    this.slack = this.slack.map(() => 0);
    this.aim(this.bends.map(() => [0, 0]));
  }

  private slacken(section: number, slack: number): void {
    this.slack[section] = Math.min(1e-3, Math.max(-1e-3, Number(slack.toFixed(6))));
    this.stand.linked();
    this.stand.changed();
    this.ask();
  }

  private ask(): void {
    this.newest.put(() => this.stand.guarded(async () => {
      const {opened: {robot, described, inputs}, bends} = this, slack = [...this.slack], found = await simulate(robot, described, {bends, inputs, slack});
      if (this.isOver) return;
      this.stand.heard();
      this.isStale = typeof found === 'string';
      if (typeof found === 'string') return this.failed(found);
      [this.frame, this.shape, this.changes] = [found.frame, found.shape, found.changes];
      this.tell(found.frame);
      this.stand.changed();
    }, () => this.ask()));
  }

  private failed(why: string): void {
    this.stand.say(why);
    this.stand.changed();
  }

  private tell({sections, time}: Frame): void {
    sections.forEach(({word}, i) => {
      if (this.words[i] !== undefined && this.words[i] !== word) this.stand.entry({time, clock: new Date().toTimeString().slice(0, 8), kind: kinds[kindOf(word)], text: `S${i + 1} ${word.toLowerCase()}`});
      this.words[i] = word;
    });
  }
}
