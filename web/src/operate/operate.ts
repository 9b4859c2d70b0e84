// The screen Operate: the state of each section, its diagram, the arm, and what it may be made to do.
import {type Json, Robot} from '../client';
import {describe} from '../described';
import {download} from '../file';
import {isText, type Key} from '../keys';
import {button, byId} from '../make';
import type {Plan} from '../plan';
import {sourceOf} from '../source';
import {toast} from '../toast';
import type {System} from '../units';
import {ArmView} from './arm_view';
import {Banner} from './banner';
import {Cards} from './cards';
import type {Motion} from './control';
import {clamped, isPolar, limitOf} from './coordinates';
import {Device, keepPicture} from './device';
import {given} from './diagram';
import {Eye} from './eye';
import {type Bend, type DeviceInfo, type Entry, type Frame, kindOf, type SectionFrame} from './frame';
import {Gamepads} from './gamepad';
import {Jog} from './jog';
import {JogPad} from './jog_pad';
import {Live} from './live';
import {Log} from './log';
import {NumbersDialog} from './numbers';
import {isPhone} from './phone';
import {lengthOf, Readings} from './readings';
import {recordedWay} from './recorded_way';
import {type Recording} from './recording';
import {Replay, type Where} from './replay';
import {reportOf} from './report';
import {Sliders} from './sliders';
import type {PlanWay} from './plan_way';
import {Steering} from './steering';
import type {Opened, Stand, Subject} from './subject';
import {findScene} from './surround';

export interface Screen {
  system(): System;
  guarded(task: () => Promise<unknown>, again?: () => unknown): Promise<void>;
  heard(): void;
  linked(): void;
  turned(): void;  ///< another source is shown
  plans(): Json[];  ///< of the server
  way(plan: Plan, link: URLSearchParams): void;  ///< on the screen Trajectory
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
  private readonly eye = new Eye(byId('op-eye'), (is) => this.root.classList.toggle('has-camera', is), {words: () => this.words(), keep: (picture, words) => this.keep(picture, words), took: (name, isKept) => this.snapped(name, isKept)});
  private readonly stageButton = button('Stage…', () => this.typeStage(), 'where Move is to take the stage');
  private readonly steering = new Steering((task) => this.screen.guarded(task));
  private readonly jog = new Jog({tilt: (section, by) => this.tilt(section, by), steering: () => this.steer(), turn: () => this.eye.turn});
  private readonly pushed = {may: () => !!this.subject?.may(), choose: (by: number) => this.choose(by), hold: () => this.live?.hold(), motion: (motion: Motion, isHeld: boolean) => this.isShown && this.subject?.motion(motion, isHeld), turned: () => this.changed()};
  private readonly pad = new JogPad(byId('op-jog'), byId('op-arm'), this.jog, this.pushed);
  private readonly gamepads = new Gamepads(this.pushed, this.jog);
  private opened: Opened | null = null;
  private own: {opened: Opened; isOfDevice: boolean} | null = null;  // what there is beside a recording
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
    document.addEventListener('keyup', (event) => this.isShown && this.subject?.keyUp(event.key.toLowerCase()), {capture: true});
    document.addEventListener('pointerdown', () => { this.notice.hidden = true; }, {capture: true});  // what is done next may say something else
    window.addEventListener('blur', () => (this.live ? this.live.blur(false) : this.subject?.motion('move', false)));
    window.addEventListener('pagehide', () => this.live?.blur(true));
    for (const turned of ['gamepadconnected', 'gamepaddisconnected'] as const) window.addEventListener(turned, () => this.changed());
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

  /** The recording that is replayed; null: none is. */
  get replayed(): Recording | null {
    return this.subject instanceof Replay ? this.subject.recording : null;
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
    if (this.subject instanceof Replay && this.subject.where.isOnServer) {
      link.set('recording', this.subject.where.name);
      link.set('t', String(Number(this.subject.at.toFixed(3))));
    }
    if (this.subject instanceof Sliders) this.subject.toLink(link);
    if (this.cards.chosen > 0) link.set('section', String(this.cards.chosen));
  }

  /** Another robot, or another text of it. */
  use(opened: Opened, isOfDevice: boolean, link: URLSearchParams | null): void {
    const slack = link?.get('slack')?.split(',').map(Number).filter(Number.isFinite) ?? (this.subject instanceof Sliders ? this.subject.slack : []);
    this.own = {opened, isOfDevice};
    this.change(opened, () => (this.info && isOfDevice ? new Live(opened, this.info, this.stand, this.root) : new Sliders(opened, this.stand, slack)), link);
  }

  /** Why no recording can be shown now; empty: one can. */
  get busy(): string {
    return this.live?.control.isMine ? 'this page controls the device: Release it, then open the recording' : '';
  }

  /** @throws Refused where its robot is none here */
  async replay(recording: Recording, where: Omit<Where, 'other'>, link: URLSearchParams | null): Promise<void> {
    const robot = await Robot.open(recording.text), described = await describe(robot), {text} = recording;
    if (!described.isSerial || described.answer.sections.length !== recording.sections) throw new Error(`${where.name}: it has ${recording.sections} sections, the robot in it ${described.isSerial ? described.answer.sections.length : 'is none of sections'}: copy the file anew`);
    const source = await sourceOf(recording.robot, text, text, described.answer), opened: Opened = {robot, described, source, inputs: described.inputs.map(({home}) => home)};
    const orders = {way: () => this.showWay(null), report: () => void this.report(), close: () => this.endReplay(), hold: this.info ? () => void this.holdDevice() : null}, other = this.otherThan(recording);
    this.change(opened, () => new Replay(opened, recording, {...where, other}, this.stand, orders), link);
    if (this.subject instanceof Replay) this.subject.go(Number(link?.get('t') ?? 0));
    const notes = [other, recording.leftOut > 0 ? `${recording.leftOut} lines were left out: ${recording.wrong[0]}` : '', where.every > 1 ? `one measurement in ${where.every} is shown` : ''].filter(Boolean);
    if (notes.length > 0) this.refuse(notes.join(' · '));
  }

  /** What is replayed, on the screen Trajectory. */
  showWay(link: URLSearchParams | null): void {
    const {subject, opened} = this;
    if (!(subject instanceof Replay) || !opened) return;
    const {recording, where} = subject, way = recordedWay(recording, opened.described.answer.sections, where.isOnServer ? where.name : '');
    if (way) this.screen.way(way, link ?? new URLSearchParams({step: String(way.stepAt(subject.at))}));
    else this.refuse('its zeros were not set: nothing is known of its bends');
  }

  /** Whose it is, where that is another one than is open. */
  private otherThan({robot, table, text}: Recording): string {
    const own = this.own?.opened.source;
    if (!own || own.text.trim() === text.trim()) return '';
    return this.own!.isOfDevice ? `recorded of another robot than the device that is here: ${robot}, table ${table}` : own.name === robot || own.text.includes(`name: ${robot}\n`) ? `recorded with another file of ${robot} than the one that is open, table ${table}` : '';
  }

  private endReplay(): void {
    const {own} = this;
    if (own) return this.use(own.opened, own.isOfDevice, null);
    this.subject?.close();
    [this.subject, this.opened] = [null, null];
    this.root.classList.add('waiting');
    this.screen.turned();
  }

  private async report(): Promise<void> {
    const {subject, opened} = this;
    if (!(subject instanceof Replay) || !opened) return;
    subject.isReporting = true;
    await this.screen.guarded(async () => {
      const {recording, where} = subject, name = where.name.replace(/[^\w.-]+/g, '-');
      download(`${name}-report.html`, await reportOf(opened, recording, where.isOnServer ? where.name : ''), 'text/html');
      toast(`${name}-report.html is saved`);
    });
    subject.isReporting = false;
  }

  /** Of the device beside a recording. */
  private async holdDevice(): Promise<void> {
    await new Device(this.info!, {frame() {}, entry() {}, again() {}, broken() {}}).call('hold').then(() => toast('the device is held'), (error) => this.refuse(error.message));
  }

  private change(opened: Opened, make: () => Subject, link: URLSearchParams | null): void {
    this.subject?.close();
    this.opened = opened;
    this.log.clear();
    this.view.forget();
    this.steering.forget();
    void this.screen.guarded(() => this.lookAround(opened));
    const subject = this.subject = make();
    this.log.extra.replaceChildren(...(subject instanceof Live || subject instanceof Replay ? subject.extras() : []));
    this.stageButton.hidden = !(subject instanceof Live && this.info!.has_stage);
    this.root.dataset.source = subject instanceof Live ? 'device' : subject instanceof Replay ? 'log' : 'sliders';
    this.root.classList.remove('has-picture');
    byId('op-eye').querySelector('.kept-picture')?.remove();
    if (subject instanceof Replay) byId('op-eye').append(subject.picture);
    this.cards.begin(opened.described.answer.sections.length);
    const chosen = Number(link?.get('section'));
    if (link?.get('section') && Number.isInteger(chosen)) this.cards.choose(chosen);
    byId('op-bar').replaceChildren(subject.bar);
    if (this.isShown) subject.enter();
    this.screen.turned();
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

  /** A plan to follow, by the device or by the arm of sliders. @param place where a link has the arm already */
  load(way: PlanWay, place?: number): void {
    if (this.replayed) this.endReplay();
    this.subject?.load(way, place);
  }

  leave(): void {
    if (!this.isShown) return;
    this.gamepads.end();
    this.pad.endAll();
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
      ...(this.replayed ? [] : [on(['j'], 'the jog pad, or not; in it arrows push the target', () => this.pad.toggle())]),
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
    if (event.key === 'Escape' && this.isShown && this.info && this.subject instanceof Replay && !event.repeat) void this.holdDevice();
    if (!live) return this.simulatedKeyDown(event);
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

  private simulatedKeyDown(event: KeyboardEvent): void {
    const isMeant = this.isShown && !event.repeat && !event.ctrlKey && !event.altKey && !event.metaKey && !isText(event.composedPath()[0] ?? null) && !document.querySelector('dialog[open]');
    if (isMeant) this.subject?.keyDown(event.key.toLowerCase());
  }

  // What is wanted

  private aim(section: number, bend: Bend): void {
    this.subject?.aim(this.subject.targets().map((one, i) => (i === section ? bend : one)));
  }

  private tilt(which: 'chosen' | 'last', by: Bend): void {
    const {subject} = this, section = which === 'last' ? (this.opened?.described.answer.sections.length ?? 1) - 1 : this.cards.chosen, from = subject?.targets()[section];
    if (!subject || !from || (subject instanceof Live && !subject.mayQuietly)) return;
    this.aim(section, clamped([from[0] + by[0], from[1] + by[1]], this.limit(section), this.isDisc(section)));
  }

  /** The next section, or the one before; after the last the first. */
  private choose(by: number): void {
    const count = this.opened?.described.answer.sections.length ?? 1;
    this.cards.choose((this.cards.chosen + by + count) % count);
  }

  private steer(): number[][] | null {
    const {opened, subject, steering} = this, matrix = opened && subject?.frame ? steering.at(opened, subject.targets()) : null;
    if (!matrix && steering.isNone) this.refuse('the tip cannot be steered where its section is bent by half a turn: jog the section');
    return matrix;
  }

  private async lookAround(opened: Opened): Promise<void> {
    const scene = await findScene(opened.described.answer.robot, this.screen.plans());
    if (this.opened === opened && scene) this.view.surround(scene);
  }

  private type(section: number): void {
    const from = this.subject?.targets()[section], limit = this.limit(section);
    if (!from || !this.subject?.may()) return;
    this.numbers.ask(`Target of S${section + 1}`, this.names(section).map((name, i) => ({name, unit: 'rad', value: from[i]!, low: -limit, high: limit})), this.screen.system(),
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

  /** Of the axes of its diagram. */
  private names(section: number): [string, string] {
    return this.isDisc(section) ? ['θ cos φ', 'θ sin φ'] : ['β₁', 'β₂'];
  }

  private isDisc(section: number): boolean {
    return isPolar(this.opened!.described.answer.sections[section]);
  }

  // What is shown

  private readonly stand: Stand = {
    system: () => this.screen.system(), chosen: () => this.cards.chosen, changed: () => this.changed(), linked: () => this.screen.linked(), turned: () => this.screen.turned(), say: (why) => this.refuse(why),
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
      isDisc: this.isDisc(i), limit: this.limit(i), given: given(sections[i]!, i), age: kindOf(sections[i]!.word) === 'stale' ? age : '', tensionLimit: subject.tensionLimit, system,
    }), subject instanceof Replay ? subject.now : now);
    const inserted = (subject instanceof Live && this.info!.has_stage) || (subject instanceof Replay && subject.recording.hasStage) ? `${lengthOf(frame.insertion, system)} in` : '';
    if (byId('op-inserted').textContent !== inserted) byId('op-inserted').textContent = inserted;
    if (isPhone.matches) this.follow(frame.alarm?.section ?? -1);
    if (shape) this.view.show({shape, ghost: subject.ghost, tips: subject.tips, stages: subject.stages, kinds: sections.map(({word}) => kindOf(word)), isStale: subject.isStale});
    this.drawPad(sections.length, subject instanceof Live && this.info!.has_stage);
    document.documentElement.dataset.operated = String(++this.draws);  // what tests wait for
  }

  private drawPad(count: number, hasStage: boolean): void {
    const {live, pad, root} = this, {chosen} = this.cards;
    root.classList.toggle('has-jog', pad.isOpen && !this.replayed);
    pad.show({section: `S${chosen + 1}`, tip: `S${count}`, names: this.names(chosen), held: live?.control.held ?? null, hasGamepad: this.gamepads.isThere, ...(hasStage && live && {locked: (motion) => live.locked(motion)})});
    if (pad.isOpen && pad.frame === 'tip') this.steering.at(this.opened!, this.subject!.targets());
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

  /** Beside the recording, where one is made. @return its name; empty: nothing is recorded */
  private async keep(picture: Blob, words: string): Promise<string> {
    const {live} = this;
    if (!live?.frame?.recording || live.frame.recording.error) return '';
    try {
      return await keepPicture(picture, words);
    } catch (error) {
      this.refuse(`the server did not keep it, it is saved here: ${(error as Error).message}`);
      return '';
    }
  }

  private snapped(name: string, isKept = false): void {
    if (isKept) toast(`${name} is kept beside the recording`);
    else if (name) toast(`${name} is saved, with time, set-points and robot in it`);
    else this.refuse('no camera is shown: there is nothing to keep');
  }
}
