// A recording of a device: its text read into columns. It stands alone: robot, table and date are in its comments.
import {type Bend, type Entry, kindOf, kindOfEntry} from './frame';

const version = 1;
const first = '# sinew recording, version ';
const known = new Set(['EXACT', 'SLACK', 'PARTLY SLACK', 'OVER-TENSIONED', 'UNREACHABLE', 'NO DATA']);
const shown = 20;  // of wrong lines, in words
const usual = 3;     // times between two measurements that are no gap yet,
const least = 0.15;  // nor is what the server calls no data only after it [s]

/** Why a file is no recording that can be replayed: place, what was found, the rule, the way out. */
export class Unreadable extends Error {}

export interface Happened extends Entry { picture: string }  ///< its file's number, of a snapshot

/** A section had a state for a while. */
export interface Stretch { section: number; word: string; from: number; to: number }

type Column = Float64Array;

export class Recording {
  duration = 0;
  readonly events: Happened[] = [];
  readonly stretches: Stretch[] = [];  ///< by their beginning
  readonly wrong: string[] = [];       ///< rows that were left out, the first few in words
  leftOut = 0;
  hasStage = false;
  hasTension = false;
  times: Column = new Float64Array();
  readonly gaps = new Set<number>();  ///< rows before which measurements are missing
  private columns = new Map<string, Column>();
  private readonly ofSection: Stretch[][] = [];

  private constructor(readonly name: string, private readonly facts: Map<string, string>, readonly text: string, readonly sections: number, readonly tendons: number) {}

  get robot(): string { return this.facts.get('robot') ?? '?'; }
  get table(): string { return this.facts.get('table') ?? '?'; }
  get model(): 'lsk' | 'pcc' { return this.facts.get('model') === 'pcc' ? 'pcc' : 'lsk'; }
  get date(): string { return this.facts.get('date') ?? ''; }
  get tensionLimit(): number { return Number(this.facts.get('tension limit [N]')) || 0; }
  get rows(): number { return this.times.length; }
  get alarms(): Stretch[] { return this.stretches.filter(({word}) => kindOf(word) !== 'exact'); }

  /** @param name of its file @throws Unreadable */
  static read(name: string, text: string): Recording {
    const lines = text.split('\n'), found = (line: string) => `“${line.slice(0, 60)}${line.length > 60 ? '…' : ''}”`;
    const head = lines[0]!.replace('\r', ''), isOne = head.startsWith(first), of = Number(head.slice(first.length));
    if (!isOne) throw new Unreadable(`${name}, line 1: found ${found(head)}; a recording begins with “${first}${version}”: choose a file that sinew serve has recorded`);
    if (of !== version) throw new Unreadable(`${name}, line 1: found version ${head.slice(first.length)}; this page reads version ${version}: open it with the sinew that wrote it, or a newer one`);
    let at = 1;
    const facts = new Map<string, string>(), robot: string[] = [];
    for (let isFile = false; lines[at]?.startsWith('#'); ++at) {
      const line = lines[at]!.replace('\r', ''), [, key, value] = /^# ([^:]+): (.*)$/.exec(line) ?? [];
      if (isFile) robot.push(line.slice(4));
      else if (line === '# file:') isFile = true;
      else if (key) facts.set(key, value!);
    }
    const names = (lines[at] ?? '').replace('\r', '').split(','), plain = names.map((one) => one.replace(/\[.*\]$/, ''));
    const count = (is: (i: number) => string) => { let i = 0; while (plain.includes(is(i))) ++i; return i; };
    const sections = count((i) => `S${i}_state`), tendons = count((i) => `S0_change_${i + 1}`);
    const wanted = ['time', 'stage', 'measured_stage', 'homed', 'event', 'text', ...Array.from({length: sections}, (_, m) => [1, 2].flatMap((i) => [`S${m}_beta_${i}`, `S${m}_measured_beta_${i}`]).concat(Array.from({length: tendons}, (_one, i) => ['set_change', 'change', 'tension'].map((what) => `S${m}_${what}_${i + 1}`)).flat())).flat()];
    const missing = wanted.find((one) => !plain.includes(one));
    if (missing || sections === 0 || tendons === 0 || plain.at(-1) !== 'text')
      throw new Unreadable(`${name}, line ${at + 1}: ${missing ? `column ${missing} is missing` : `found ${found(lines[at] ?? '')}`}; the line after the comments names the columns: copy the file anew from the server`);
    if (robot.join('').trim() === '') throw new Unreadable(`${name}, line ${at + 1}: found no robot; the lines below “# file:” are its file: copy the file anew from the server`);
    const made = new Recording(name, facts, robot.join('\n') + '\n', sections, tendons);
    made.fill(lines.slice(at + 1), at + 2, plain);
    if (made.rows === 0) throw new Unreadable(`${name}: found no row of measurements in ${lines.length} lines${made.wrong[0] ? `, and ${made.wrong[0]}` : ''}; there is nothing to replay: choose another one`);
    return made;
  }

  private fill(lines: string[], number: number, names: string[]): void {
    const size = names.length, time = names.indexOf('time'), event = names.indexOf('event'), states = Array.from({length: this.sections}, (_, m) => names.indexOf(`S${m}_state`));
    const numeric = names.map((one, i) => (/_state$|^event$|^text$/.test(one) ? -1 : i)).filter((i) => i >= 0), rows: string[][] = [];
    let before = 0;
    lines.forEach((raw, i) => {
      const line = raw.replace('\r', '');
      if (line === '' && i === lines.length - 1) return;
      const fields = split(line, size), now = fields ? Number(fields[time]) : NaN, words = fields ? states.map((at) => fields[at]!) : [];
      const why = !fields ? `${line.split(',').length} fields, not ${size}` : !(fields[time] !== '' && now >= 0 && now < 1e9) ? `time “${fields[time]!.slice(0, 20)}”, no number from 0 on` : now < before ? `time ${now} after ${before}`
        : words.some((one) => !known.has(one)) ? `state “${words.find((one) => !known.has(one))!.slice(0, 20)}”` : numeric.some((at) => fields[at] !== '' && !Number.isFinite(Number(fields[at]))) ? `“${fields[numeric.find((at) => fields[at] !== '' && !Number.isFinite(Number(fields[at])))!]!.slice(0, 20)}”, no number` : '';
      if (why) return this.leave(i === lines.length - 1 ? `line ${number + i} is cut off (${why}): the recording ends there` : `line ${number + i}: found ${why}`);
      before = now;
      this.see(now, words);
      if (fields![event] !== '') this.events.push(happened(now, this.clock(now), fields![event]!, fields![size - 1]!));
      else rows.push(fields!);
    });
    this.duration = before;
    for (const own of this.ofSection) if (own.length > 0) own.at(-1)!.to = before;
    for (const at of numeric) this.columns.set(names[at]!, Float64Array.from(rows, (fields) => (fields[at] === '' ? NaN : Number(fields[at]))));
    this.times = this.column('time');
    this.findGaps();
    this.hasStage = this.column('measured_stage').some(Number.isFinite);
    this.hasTension = this.column('S0_tension_1').some(Number.isFinite);
  }

  /** Where no data began, or much longer passed than between others, as in a thinned one, nothing is known of the time between two rows. */
  private findGaps(): void {
    const {times} = this, waits = times.slice(1).map((time, i) => time - times[i]!).sort(), most = Math.max(least, usual * (waits[waits.length >> 1] ?? 0));
    const blind = this.stretches.filter(({word}) => kindOf(word) === 'stale').map(({from}) => from);
    for (let row = 1; row < this.rows; ++row)
      if (times[row]! - times[row - 1]! > most || blind.some((from) => from > times[row - 1]! && from <= times[row]!)) this.gaps.add(row);
  }

  private leave(why: string): void {
    if (++this.leftOut <= shown) this.wrong.push(why);
  }

  private see(now: number, words: string[]): void {
    words.forEach((word, section) => {
      const own = (this.ofSection[section] ??= []), last = own.at(-1);
      if (last?.word === word) return;
      if (last) last.to = now;
      own.push({section, word, from: now, to: now});
      this.stretches.push(own.at(-1)!);
    });
  }

  column(name: string): Column {
    return this.columns.get(name) ?? new Float64Array(this.rows).fill(NaN);
  }

  /** The last measurement until then; before the first one that. */
  rowAt(time: number): number {
    return lastUntil(this.rows, (i) => this.times[i]!, time);
  }

  /** The state of a section then. */
  stateAt(section: number, time: number): Stretch {
    const own = this.ofSection[section]!;
    return own[lastUntil(own.length, (i) => own[i]!.from, time)]!;
  }

  /** What the log said of a state when it came, with what helps; empty: nothing. */
  said({section, word, from}: Stretch): string {
    return this.events.find(({time, kind, text}) => kindOfEntry(kind) && time === from && text.startsWith(`S${section + 1} ${word}`))?.text ?? '';
  }

  /** How many events there were until then. */
  eventsUntil(time: number): number {
    const {events} = this, last = lastUntil(events.length, (i) => events[i]!.time, time);
    return events.length > 0 && events[last]!.time <= time ? last + 1 : 0;
  }

  bend(row: number, section: number, what: 'beta' | 'measured_beta'): Bend {
    return [this.column(`S${section}_${what}_1`)[row]!, this.column(`S${section}_${what}_2`)[row]!];
  }

  ofTendons(row: number, section: number, what: 'change' | 'set_change' | 'tension'): number[] {
    return Array.from({length: this.tendons}, (_, i) => this.column(`S${section}_${what}_${i + 1}`)[row]!);
  }

  isHomed(row: number): boolean {
    return this.column('homed')[row] === 1;
  }

  /** Time of day, where the recording was made. */
  clock(time: number): string {
    const [, h, m, s] = /T(\d\d):(\d\d):(\d\d)/.exec(this.date) ?? [], two = (value: number) => String(Math.floor(value)).padStart(2, '0');
    if (!h) return `${time.toFixed(1)} s`;
    const all = Number(h) * 3600 + Number(m) * 60 + Number(s) + time;
    return `${two((all / 3600) % 24)}:${two((all / 60) % 60)}:${two(all % 60)}`;
  }
}

/** The last of some, in the order of their times, that is not later; else the first. */
function lastUntil(count: number, at: (i: number) => number, time: number): number {
  let [low, high] = [0, count];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (at(middle) <= time) low = middle + 1;
    else high = middle;
  }
  return Math.max(0, low - 1);
}

/** Only the last field is in quotes, and may have commas. */
function split(line: string, size: number): string[] | null {
  const fields: string[] = [];
  let from = 0;
  for (let i = 0; i < size - 1; ++i) {
    const comma = line.indexOf(',', from);
    if (comma < 0) return null;
    fields.push(line.slice(from, comma));
    from = comma + 1;
  }
  const last = line.slice(from);
  if (last === '') return [...fields, ''];
  if (!/^"(?:[^"]|"")*"$/.test(last)) return null;
  return [...fields, last.slice(1, -1).replaceAll('""', '"')];
}

const happened = (time: number, clock: string, kind: string, text: string): Happened =>
  ({time, clock, kind, text, picture: kind === 'snapshot' ? /^[^,]*-(\d{3})\.(?:jpg|png), /.exec(text)?.[1] ?? '' : ''});
