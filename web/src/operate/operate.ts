// The screen Operate: the state of each section, its diagram, the arm, and what it may be made to do.
import {button, byId} from '../make';
import {isText, type Key} from '../keys';
import {toast} from '../toast';
import type {System} from '../units';
import {ArmView} from './arm_view';
import {Banner} from './banner';
import {Cards} from './cards';
import {clamped, isPolar, limitOf} from './coordinates';
import {Eye} from './eye';
import {type Bend, type DeviceInfo, type Entry, type Frame, kindOf, type SectionFrame} from './frame';
import {Gamepads} from './gamepad';
import {Live} from './live';
import {Log} from './log';
import {NumbersDialog} from './numbers';
import {isPhone} from './phone';
import {lengthOf, Readings} from './readings';
import {Sliders} from './sliders';
import type {Opened, Stand, Subject} from './subject';

export interface Screen {
  system(): System;
  guarded(task: () => Promise<unknown>, again?: () => unknown): Promise<void>;
  heard(): void;
  linked(): void;
}

const patience = 6000;  // ms that a refusal is shown

export class Operate {
  isShown = false;
  private readonly root = byId('operate');
  private readonly banner = new Banner(byId('op-banner'), () => this.live?.control.acknowledge());
  private readonly cards = new Cards(byId('op-cards'), {aim: (section, bend) => this.aim(section, bend), may: () => !!this.subject?.may(), chosen: () => undefined, type: (section) => this.type(section)}, () => this.changed());
  private readonly view = new ArmView(byId('op-arm'), () => this.changed());
  private readonly readings = new Readings(byId('op-tip'));
  private readonly log = new Log(byId('op-events'));
  private readonly numbers = new NumbersDialog(this.root);
  private readonly notice = byId('op-notice');
  private readonly eye = new Eye(byId('op-eye'), (is) => this.root.classList.toggle('has-camera', is), () => this.words(), (name) => this.snapped(name));
  private readonly stageButton = button('Stage…', () => this.typeStage(), 'where Move is to take the stage');
  private readonly gamepads = new Gamepads({
    tilt: (section, by) => this.tilt(section === 'last' ? (this.opened?.described.answer.sections.length ?? 1) - 1 : this.cards.chosen, by), choose: (by) => this.cards.choose(this.cards.chosen + by),
    hold: () => this.live?.hold(), move: (isHeld) => this.live?.move(isHeld),
  });
  private opened: Opened | null = null;
  private subject: Subject | null = null;
  private drawing = 0;
  private noticed = 0;
  private draws = 0;
  private alarmed = -1;

  /** @param info the device of the server @param isOfDevice whether it is the robot of an opened file */
  constructor(private readonly screen: Screen, private readonly info: DeviceInfo | null) {
    this.root.append(this.log.drawer);
    byId('op-tip').append(this.stageButton);
    document.addEventListener('keydown', (event) => this.keyDown(event), {capture: true});
    document.addEventListener('keyup', (event) => this.live?.keyUp(event.key.toLowerCase()), {capture: true});
    document.addEventListener('pointerdown', () => { this.notice.hidden = true; }, {capture: true});  // what is done next may say something else
    window.addEventListener('blur', () => this.live?.blur(false));
    window.addEventListener('pagehide', () => this.live?.blur(true));
    document.addEventListener('visibilitychange', () => document.hidden && this.live?.blur(true));
    isPhone.addEventListener('change', ({matches}) => matches && this.live?.control.giveBack());
    Object.assign((window as any).__sinew, {operate: this});
  }

  private get live(): Live | null {
    return this.isShown && this.subject instanceof Live ? this.subject : null;
  }

  get badge(): string {
    return this.subject?.badge ?? 'SLIDERS';
  }

  /** For tests: what is drawn. */
  get frame(): Frame | null {
    return this.subject?.frame ?? null;
  }

  /** Of the simulated arm, as the screen Design has them; null: a device has its own. */
  get inputs(): number[] | null {
    return this.subject instanceof Sliders ? this.subject.inputs : null;
  }

  toLink(link: URLSearchParams): void {
    link.set('screen', 'operate');
    if (this.subject instanceof Sliders && this.subject.slack.some((one) => one !== 0)) link.set('slack', this.subject.slack.join(','));
    if (this.cards.chosen > 0) link.set('section', String(this.cards.chosen));
  }

  /** Another robot, or another text of it. */
  use(opened: Opened, isOfDevice: boolean, link: URLSearchParams | null): void {
    const slack = link?.get('slack')?.split(',').map(Number).filter(Number.isFinite) ?? (this.subject instanceof Sliders ? this.subject.slack : []);
    this.subject?.close();
    this.opened = opened;
    this.log.clear();
    this.view.forget();
    const {sections} = opened.described.answer;
    this.subject = this.info && isOfDevice ? new Live(opened, this.info, this.stand, this.root) : new Sliders(opened, this.stand, slack);
    this.log.extra.replaceChildren(...(this.subject instanceof Live ? this.subject.extras() : []));
    this.stageButton.hidden = !(this.subject instanceof Live && this.info!.has_stage);
    this.root.dataset.source = this.subject instanceof Live ? 'device' : 'sliders';
    this.cards.begin(sections.length);
    const chosen = Number(link?.get('section'));
    if (link?.get('section') && Number.isInteger(chosen)) this.cards.choose(chosen);
    byId('op-bar').replaceChildren(this.subject.bar);
    if (this.isShown) this.subject.enter();
  }

  enter(inputs: number[]): void {
    if (this.isShown) return;
    this.isShown = true;
    void this.eye.search();
    if (this.subject instanceof Sliders) this.subject.use(inputs);
    this.subject?.enter();
    this.gamepads.begin();
    this.changed();
  }

  leave(): void {
    if (!this.isShown) return;
    this.gamepads.end();
    this.eye.close();
    this.view.full(false);
    this.log.toggle(false);
    this.subject?.leave();
    this.isShown = false;
  }

  paint(): void {
    this.view.paint();
    this.changed();
  }

  keys(): Key[] {
    const on = (keys: string[], says: string, go: (key: string) => void): Key => ({keys, says, go}), isLive = this.subject instanceof Live;
    return [
      ...(this.subject?.keys() ?? []),
      on(['1', '2', '3', '4', '5', '6', '7', '8', '9'], 'choose a section', (key) => this.cards.choose(Number(key) - 1, true)),
      {keys: ['← → ↑ ↓'], says: 'in a diagram: move the target by 0.1°, with Shift by 1°; Enter types numbers'},
      on(['v'], 'the arm from the side, above, the tip, as large as the page', () => this.view.next()),
      on(['f'], 'all of the arm in view', () => this.view.fit()),
      on(['l'], 'all events', () => this.log.toggle()),
      on(['p'], 'keep the picture of the tip camera', () => void this.eye.snapshot()),
      ...(isLive ? [] : [on(['Escape'], 'close what is on top', () => this.closeTop())]),
    ];
  }

  private closeTop(): void {
    if (this.log.isOpen) this.log.toggle(false);
    else if (this.view.isLarge) this.view.full(false);
  }

  /** Hold comes before all else that a key may mean; motions last as long as their key is down. */
  private keyDown(event: KeyboardEvent): void {
    const {live} = this, target = event.composedPath()[0] ?? null;
    if (!live) return;
    if (event.key === 'Escape') {
      if (!event.repeat) live.hold();
      if (!document.querySelector('dialog[open]')) this.closeTop();
      return;
    }
    if (isText(target) || event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === ' ') {
      event.preventDefault();
      event.stopPropagation();
      if (!event.repeat) live.hold();
    } else if (!document.querySelector('dialog[open]') && !event.repeat) live.keyDown(event.key.toLowerCase());
  }

  // What is wanted

  private aim(section: number, bend: Bend): void {
    this.subject?.aim(this.subject.targets().map((one, i) => (i === section ? bend : one)));
  }

  private tilt(section: number, by: Bend): void {
    const {subject} = this, from = subject?.targets()[section];
    if (!subject || !from || (subject instanceof Live && !subject.mayQuietly)) return;
    this.aim(section, clamped([from[0] + by[0], from[1] + by[1]], this.limit(section), this.isDisc(section)));
  }

  private type(section: number): void {
    const from = this.subject?.targets()[section], limit = this.limit(section);
    if (!from || !this.subject?.may()) return;
    const names = this.isDisc(section) ? ['θ cos φ', 'θ sin φ'] : ['β₁', 'β₂'];
    this.numbers.ask(`Target of S${section + 1}`, names.map((name, i) => ({name, unit: 'rad', value: from[i]!, low: -limit, high: limit})), this.screen.system(),
                     ([x, y]) => this.aim(section, clamped([x!, y!], limit, this.isDisc(section))));
  }

  private typeStage(): void {
    const {live} = this;
    if (!live?.frame || !live.may()) return;
    this.numbers.ask('Target of the stage', [{name: 'inserted', unit: 'm', value: live.frame.stage_target, low: 0, high: live.info.stage_limit}], this.screen.system(), ([stage]) => live.aimStage(stage!));
  }

  private limit(section: number): number {
    return this.subject?.frame?.sections[section]?.envelope?.limit ?? limitOf(this.opened!.described.answer.sections[section]);
  }

  private isDisc(section: number): boolean {
    return isPolar(this.opened!.described.answer.sections[section]);
  }

  // What is shown

  private readonly stand: Stand = {
    system: () => this.screen.system(), chosen: () => this.cards.chosen, changed: () => this.changed(), linked: () => this.screen.linked(), say: (why) => this.refuse(why),
    entry: (entry: Entry) => this.log.put(entry), forgetEntries: () => this.log.clear(), guarded: (task, again) => this.screen.guarded(task, again), heard: () => this.screen.heard(),
  };

  /** Once a picture, however much has changed. */
  private changed(): void {
    if (!this.isShown || this.drawing) return;
    this.drawing = requestAnimationFrame((now) => {
      this.drawing = 0;
      if (this.isShown) this.draw(now);
    });
  }

  private draw(now: number): void {
    const {subject} = this, {frame, shape, lost} = subject ?? {};
    if (!subject) return;
    subject.show();
    this.readings.show(subject.readings());
    this.root.classList.toggle('waiting', !frame);
    if (!frame) return;
    const sections = lost ? frame.sections.map((one): SectionFrame => ({...one, word: 'NO DATA'})) : frame.sections, age = subject.age(), system = this.screen.system();
    this.banner.show({...frame, sections}, lost ?? null, system);
    this.cards.show(sections, (i) => ({
      isDisc: this.isDisc(i), limit: this.limit(i), given: given(sections, i), age: kindOf(sections[i]!.word) === 'stale' ? age : '', tensionLimit: subject.tensionLimit, system,
    }), now);
    const inserted = subject instanceof Live && this.info!.has_stage ? `${lengthOf(frame.insertion, system)} in` : '';
    if (byId('op-inserted').textContent !== inserted) byId('op-inserted').textContent = inserted;
    if (isPhone.matches) this.follow(frame.alarm?.section ?? -1);
    if (shape) this.view.show(shape, subject.ghost, sections.map(({word}) => kindOf(word)), subject.isStale);
    document.documentElement.dataset.operated = String(++this.draws);  // what tests wait for
  }

  /** Where there is room for one section, it is the one with an alarm, until another one is chosen. */
  private follow(section: number): void {
    if (section === this.alarmed) return;
    this.alarmed = section;
    this.cards.choose(section);
  }

  private refuse(why: string): void {
    this.notice.textContent = why;
    this.notice.hidden = false;
    clearTimeout(this.noticed);
    this.noticed = window.setTimeout(() => { this.notice.hidden = true; }, patience);
  }

  /** What goes with a snapshot. */
  private words(): string {
    const {opened, subject} = this, robot = opened?.source.text ?? '';
    return [new Date().toISOString(), `set-points [rad]: ${JSON.stringify(subject?.targets())}`, `measured [rad]: ${JSON.stringify(subject?.frame?.sections.map(({measured, point}) => measured ?? point))}`, '', robot].join('\n');
  }

  private snapped(name: string): void {
    if (name) toast(`${name} is saved, with time, set-points and robot in it`);
    else this.refuse('no camera is shown: there is nothing to keep');
  }
}

/** The last section before this one on whose state its diagram depends. */
function given(sections: SectionFrame[], section: number): string {
  if (!sections[section]!.conditional) return '';
  for (let i = section - 1; i >= 0; --i) if (kindOf(sections[i]!.word) !== 'exact') return `S${i + 1}`;
  return '';
}

