// The worst of all states in one sentence: what it is, what was done about it, what to do next.
import {button, make} from '../make';
import type {System} from '../units';
import {type Alarm, type Frame, type Kind, kindOf, kinds, type SectionFrame, severity} from './frame';
import {icon} from './mark';

const degree = Math.PI / 180;
const length = (metres: number, system: System) => (system === 'mm' ? `${(1e3 * metres).toFixed(2)} mm` : `${metres.toFixed(5)} m`);

/** By how much; where its word says it all, nothing. */
export function amount({word, slack, over_tension, tension}: SectionFrame, system: System): string {
  const kind = kindOf(word), most = Math.max(0, ...(slack ?? []));
  if (kind === 'over' && (over_tension ?? 0) > 0) return ` by ${length(over_tension!, system)}`;
  if (kind === 'over' && tension?.length) return `, ${Math.max(...tension).toFixed(1)} N`;
  return kind === 'slack' && most > 0 ? ` by ${length(most, system)}` : '';
}

const numbers = (tendons: number[]) => {
  const names = tendons.map((i) => i + 1), last = names.pop();
  return `${tendons.length > 1 ? 'tendons' : 'tendon'} ${names.length > 0 ? `${names.join(', ')} and ` : ''}${last}`;
};

/** What a section asks for, in the words of a device. */
export function advice({word, slack = [], point, envelope}: SectionFrame, tolerance: number, system: System): string {
  const kind = kindOf(word), most = Math.max(0, ...slack.map(Math.abs)), which = (is: (value: number) => boolean) => slack.flatMap((value, i) => (is(value) ? [i] : []));
  if ((kind === 'slack' && !(most > tolerance)) || (kind === 'over' && !slack.some((value) => value < 0))) return '';  // what tensions say
  if (kind === 'slack') return `Take in ${numbers(which((value) => value > tolerance))} by ${length(most, system)}.`;
  if (kind === 'over') return `Pay out ${numbers(which((value) => value < 0))} by ${length(most, system)}.`;
  if (kind !== 'unreachable' || !point || !envelope) return '';
  const bend = envelope.kind === 'disc' ? Math.hypot(...point) : Math.max(...point.map(Math.abs));
  return `Asked for ${(bend / degree).toFixed(1)}°, limit ${(envelope.limit / degree).toFixed(1)}°.`;
}

/** Of answers to queries what a device says of itself. */
export function alarmOf(sections: SectionFrame[], tolerance: number, system: System): Alarm | null {
  const bad = sections.map((_, i) => i).filter((i) => kindOf(sections[i]!.word) !== 'exact').sort((a, b) => severity(sections[b]!) - severity(sections[a]!) || a - b), first = bad[0];
  if (first === undefined) return null;
  return {section: first, word: sections[first]!.word, since: 0, sentence: '', did: '', next: advice(sections[first]!, tolerance, system), more: bad.length - 1, acknowledged: true};
}

/** With a capital and a full stop. */
const asSentence = (text: string) => (text ? text[0]!.toUpperCase() + text.slice(1) + (/[.!?…]$/.test(text) ? '' : '.') : '');

export class Banner {
  private readonly shape = make('span', {className: 'shape'});
  private readonly word = make('strong');
  private readonly since = make('span', {className: 'since', ariaHidden: 'true'});
  private readonly next = make('p');
  private readonly acknowledge: HTMLButtonElement;
  private kind: Kind | '' = '';

  constructor(private readonly box: HTMLElement, acknowledge: () => void) {
    this.acknowledge = button('Acknowledge', acknowledge, 'seen: it pulses no more (a)');
    this.acknowledge.append(make('kbd', {textContent: 'A'}));
    const alert = make('div', {className: 'words'}, make('p', {className: 'headline'}, this.word, this.since), this.next);
    this.word.setAttribute('role', 'status');
    box.append(this.shape, alert, this.acknowledge);
  }

  /** @param lost why nothing is known; null: it is */
  show(frame: Frame, lost: string | null, system: System): void {
    const {alarm, sections} = frame, isBlind = sections.length > 0 && sections.every(({word}) => kindOf(word) === 'stale');
    if (lost !== null) return this.say('stale', 'NO DATA', lost, 'The picture is the last one. Check the cable; motion is held.', false);
    if (!alarm) return this.quiet(frame);
    const section = sections[alarm.section]!, others = sections.flatMap((one, i) => (i !== alarm.section && kindOf(one.word) !== 'exact' ? [`S${i + 1} ${one.word.toLowerCase()}`] : []));
    const more = isBlind ? '' : alarm.more > 0 ? `${alarm.more} more: ${others.slice(0, 3).join(', ')}${others.length > 3 ? ', …' : ''}` : '';
    const since = alarm.since >= 1 ? `, ${alarm.since < 60 ? `${alarm.since.toFixed(0)} s` : `${Math.floor(alarm.since / 60)} min`}` : '';
    if (isBlind) return this.say('stale', 'NO DATA', since, [frame.message, alarm.did, alarm.next].map(asSentence).filter(Boolean).join(' '), !alarm.acknowledged);
    this.say(kindOf(alarm.word), `S${alarm.section + 1} ${alarm.word}${alarm.word === section.word ? amount(section, system) : ''}`, since, [alarm.did, alarm.next, more].map(asSentence).filter(Boolean).join(' '), !alarm.acknowledged);
  }

  private quiet({sections}: Frame): void {
    const near = sections.flatMap((one, i) => (one.near_limit ? [`S${i + 1}`] : []));
    this.say('exact', 'ALL SECTIONS EXACT', '', near.length > 0 ? `${near.join(', ')} near the limit.` : '', false);
    this.box.classList.add('quiet');
  }

  private say(kind: Kind, word: string, since: string, next: string, isNew: boolean): void {
    this.box.classList.remove('quiet');
    if (kind !== this.kind) this.shape.replaceChildren(icon(kind, 34));
    this.kind = kind;
    this.box.dataset.state = kind;
    this.box.classList.toggle('new', isNew);
    this.acknowledge.hidden = !isNew;
    const role = kinds.indexOf(kind) >= kinds.indexOf('unreachable') ? 'alert' : 'status';
    if (this.word.getAttribute('role') !== role) this.word.setAttribute('role', role);
    if (this.word.textContent !== word) this.word.textContent = word;
    if (this.since.textContent !== since) this.since.textContent = since;
    if (this.next.textContent !== next) this.next.textContent = next;
  }
}
