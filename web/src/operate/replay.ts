// The source LOG: a recording as it was at a time. What was measured then is in the file; diagrams and pictures are answers to queries.
import {type Json, Newest} from '../client';
import type {Key} from '../keys';
import {make} from '../make';
import {toast} from '../toast';
import {limitOf} from './coordinates';
import {type Bend, type Frame, type SectionFrame, kindOf} from './frame';
import {lengthOf, type Reading} from './readings';
import type {TipPlace} from './plan_way';
import type {Recording} from './recording';
import {pictureOf} from './recordings';
import {ReplayBar} from './replay_bar';
import {alarmOf, configurationOf, samplesOf} from './simulated';
import type {Opened, Stages, Stand, Subject} from './subject';

const apart = Math.PI / 360;  // rad between set-point and arm, from which on the set-point is drawn
const patience = 150;         // ms without an answer, after which the last picture fades
const listed = 300;           // events that are shown before a time

/** What it is: a name of the server's, or a file that was dropped here. */
export interface Where { name: string; isOnServer: boolean; every: number; other: string }

export class Replay implements Subject {
  readonly bar: HTMLElement;
  readonly lost = null;
  readonly tips: TipPlace[] = [];
  frame: Frame | null = null;
  shape: Json | null = null;
  ghost: Json | null = null;
  readonly picture = make('figure', {className: 'kept-picture', hidden: true});
  private readonly line: ReplayBar;
  private readonly newest = new Newest();
  private time = 0;
  private told = 0;       // events that are in the list
  private row = -1;       // that is shown
  private wanted = -1;
  private asked = '';
  private waiting = 0;
  private isLate = false;
  private pictured = '';
  private isOver = false;

  constructor(readonly opened: Opened, readonly recording: Recording, readonly where: Where, private readonly stand: Stand, orders: {way(): void; report(): void; close(): void; hold: (() => void) | null}) {
    this.line = new ReplayBar(recording, {
      go: (time) => this.go(time), next: () => this.next(), isThere: () => this.row === this.wanted, turned: () => stand.turned(), ...orders,
    });
    this.bar = this.line.element;
  }

  get badge(): string {
    return `LOG ${this.where.name} ×${this.line.speed}`;
  }

  get tensionLimit(): number {
    return this.recording.tensionLimit;
  }

  /** Of the trail: as time went then. */
  get now(): number {
    return 1000 * this.time;
  }

  get at(): number {
    return this.time;
  }

  set isReporting(is: boolean) {
    this.line.isReporting = is;
  }

  keys(): Key[] {
    const on = (keys: string[], says: string, go: (key: string) => void): Key => ({keys, says, go}), {line} = this;
    return [
      on([' '], 'play or pause', () => line.toggle()), on([',', '.'], 'one row back, on', (key) => line.by(key === ',' ? -1 : 1)), on(['Shift+,', 'Shift+.'], 'ten rows', (key) => line.by(key === 'Shift+,' ? -10 : 10)),
      on(['n'], 'the next alarm', () => this.next()), on(['-', '+', '='], 'slower, faster', (key) => line.faster(key === '-' ? -1 : 1)),
    ];
  }

  readings(): Reading[] {
    const {recording, where} = this, system = this.stand.system(), [x = 0, y = 0, z = 0] = this.frame?.tip ?? [], stage = recording.column('measured_stage')[Math.max(0, this.row)]!;
    return [
      ['x', lengthOf(x, system)], ['y', lengthOf(y, system)], ['z', lengthOf(z, system)], ...(Number.isFinite(stage) ? [['inserted', lengthOf(stage, system)] as Reading] : []),
      ['recorded', recording.date.slice(0, 10)], ['table', recording.table, where.other !== ''], ['rows', where.every > 1 ? `${recording.rows}, 1 in ${where.every}` : String(recording.rows)],
      ...(recording.leftOut > 0 ? [['left out', String(recording.leftOut), true] as Reading] : []),
    ];
  }

  /** What is wrong with the file, and whose it is. */
  extras(): HTMLElement[] {
    const {recording, where} = this, said = [`${recording.robot}, table ${recording.table}, model ${recording.model}, ${recording.date}`, ...(where.other ? [where.other] : []),
      ...(where.every > 1 ? [`one measurement in ${where.every}, besides all events and changes of state`] : [])];
    const wrong = recording.leftOut > 0 ? [make('h3', {textContent: `${recording.leftOut} lines were left out`}), make('ul', {className: 'wrong'}, ...recording.wrong.map((why) => make('li', {textContent: why}))),
      make('p', {textContent: 'A row has a field for each column, times that do not go back, states by their words: copy the file anew, if it is whole elsewhere.'})] : [];
    return [make('h3', {textContent: 'Recording'}), ...said.map((textContent) => make('p', {textContent})), ...wrong];
  }

  get isStale(): boolean {
    return this.isLate || !this.frame || !this.recording.isHomed(Math.max(0, this.row)) || this.frame.sections.every(({word}) => kindOf(word) === 'stale');
  }

  age(): string {
    return `${Math.max(0, this.time - (this.recording.times[Math.max(0, this.row)] ?? 0)).toFixed(1)} s old`;
  }

  targets(): Bend[] {
    return this.frame?.sections.map(({target}) => target) ?? [];
  }

  may(): boolean {
    this.stand.say('this is a recording: Close it to set targets');
    return false;
  }

  aim(): void {}

  load(): void {}

  motion(): void {}

  keyDown(): boolean {
    return false;
  }

  keyUp(): void {}

  get stages(): Stages | null {
    const {frame, recording} = this;
    return recording.hasStage ? {now: frame?.insertion ?? 0, goal: frame?.stage_target ?? 0} : null;
  }

  show(): void {
    this.line.at(this.time);
  }

  enter(): void {
    this.tell();
    this.ask();
  }

  leave(): void {
    this.line.pause();
    this.newest.drop();
    clearTimeout(this.waiting);
  }

  close(): void {
    this.isOver = true;
    this.leave();
  }

  go(time: number): void {
    this.time = Math.min(this.recording.duration, Math.max(0, Number.isFinite(time) ? time : 0));
    this.line.at(this.time);
    this.tell();
    this.ask();
    this.stand.linked();
    this.stand.changed();
  }

  private next(): void {
    const starts = this.recording.alarms.map(({from}) => from), to = starts.find((from) => from > this.time + 1e-6) ?? starts[0];
    if (to === undefined) return toast('there is no alarm in this recording');
    this.line.jump(to);
  }

  /** Events until now: more of them, or less. */
  private tell(): void {
    const {events} = this.recording, until = this.recording.eventsUntil(this.time + 1e-9);
    if (until < this.told) {
      this.stand.forgetEntries();
      this.told = 0;
    }
    for (const event of events.slice(Math.max(this.told, until - listed), until)) this.stand.entry(event);
    this.told = until;
    this.hang(events.slice(0, until).filter(({picture}) => picture).at(-1)?.picture ?? '');
  }

  /** The picture that was kept last. */
  private hang(number: string): void {
    const key = this.where.isOnServer ? number : '';
    if (key === this.pictured) return;
    this.pictured = key;
    this.picture.hidden = !key;
    this.picture.closest('#operate')?.classList.toggle('has-picture', !!key);
    const event = this.recording.events.find(({picture}) => picture === key);
    this.picture.replaceChildren(...(key ? [make('img', {src: pictureOf(this.where.name, key), alt: event!.text}), make('figcaption', {textContent: `${event!.clock} ${event!.text}`})] : []));
  }

  /** The newest one counts. */
  private ask(): void {
    this.wanted = this.recording.rowAt(this.time);
    const key = `${this.wanted} ${this.words().join()} ${this.stand.system()}`;
    if (key === this.asked) return;
    this.asked = key;
    clearTimeout(this.waiting);
    this.waiting = window.setTimeout(() => { this.isLate = this.row !== this.wanted; this.stand.changed(); }, patience);
    this.newest.put(() => this.stand.guarded(() => this.answer(this.time), () => { this.asked = ''; this.ask(); }));
  }

  private words(): string[] {
    return Array.from({length: this.recording.sections}, (_, i) => this.recording.stateAt(i, this.time).word);
  }

  private async answer(time: number): Promise<void> {
    const {recording, opened: {robot, described, inputs}} = this, {sections} = described.answer, row = recording.rowAt(time), {model} = recording, samples = samplesOf(sections);
    const changes = sections.map((_: Json, i: number) => recording.ofTendons(row, i, 'change')) as number[][], set = sections.map((_: Json, i: number) => recording.bend(row, i, 'beta')) as Bend[];
    const measured = sections.map((_: Json, i: number) => recording.bend(row, i, 'measured_beta')) as Bend[], isElsewhere = set.some(([x, y], i) => Math.hypot(x - measured[i]![0], y - measured[i]![1]) > apart);
    const diagrams = recording.isHomed(row) ? sections.map((_: Json, i: number) => diagramQuery(recording, described.answer.sections, row, i)) : [];
    const [shape, ...more] = await robot.ask([{query: 'shape', changes, model, samples}, ...diagrams, ...(isElsewhere ? [{query: 'shape', configuration: configurationOf(described, set, inputs), samples}] : [])]) as [Json, ...Json[]];
    if (this.isOver) return;
    this.stand.heard();
    if (shape.error) return this.stand.say(`no picture of row ${row + 1}: ${shape.error.message}`);
    const told = sections.map((_: Json, i: number): SectionFrame => {
      const state = recording.stateAt(i, time), {word} = state, diagram = diagrams.length > 0 && !more[i]!.error ? more[i]! : {};
      return {
        ...asTold(diagram, word, recording.said(state)), word, commanded: set[i]!, target: set[i]!, measured: measured[i]!,
        changes: changes[i]!, set: recording.ofTendons(row, i, 'set_change'), tension: recording.hasTension ? recording.ofTendons(row, i, 'tension') : null,
      };
    });
    const ghost = isElsewhere ? more.at(-1)! : null;
    [this.row, this.shape, this.ghost, this.isLate] = [row, shape, ghost?.backbones ? ghost : null, false];
    this.frame = this.frameOf(time, row, told, shape.tip?.position ?? [0, 0, 0]);
    this.stand.changed();
  }

  private frameOf(time: number, row: number, sections: SectionFrame[], tip: number[]): Frame {
    const {recording} = this, alarm = alarmOf(sections), stage = recording.column('measured_stage')[row]!, isBlind = sections.every(({word}) => kindOf(word) === 'stale');
    if (alarm) alarm.since = time - recording.stateAt(alarm.section, time).from;
    return {
      time, age: time - recording.times[row]!, link: isBlind ? 'silent' : 'ok', message: isBlind ? 'no measurement came' : '', round_trip: 0, rate: 0, errors: 0, control: {holder: null, since: ''}, state: 'view_only', activity: 'rest',
      armed_left: 0, why: '', homed: recording.isHomed(row), homing: null, stage: stage || 0, insertion: Math.max(0, stage || 0), stage_target: recording.column('stage')[row]! || 0, speed: 0, recording: null, tip, sections, alarm,
    };
  }
}

/** Where tensions said something else then than the diagram, what helps is what the log said. */
const asTold = ({amount, ...diagram}: Json, word: string, said: string): Json => (diagram.word === word ? {...diagram, amount} : {...diagram, advice: said.split(': ').slice(1).join(': ')});

/** The diagram of a section as it was measured then. */
export const diagramQuery = (recording: Recording, sections: Json[], row: number, section: number): Json => ({
  query: 'diagram', section, model: recording.model, changes: Array.from({length: section + 1}, (_, i) => recording.ofTendons(row, i, 'change')), ...(sections[section]!.limit === undefined && {limit: limitOf(sections[section] as {limit?: number})}),
});
