// The worst of all states in one sentence: what it is, what was done about it, what to do next.
import {button, make} from '../make';
import type {System} from '../units';
import {type Frame, type Kind, kindOf, kinds, type SectionFrame} from './frame';
import {icon} from './mark';

const length = (metres: number, system: System) => (system === 'mm' ? `${(1e3 * metres).toFixed(2)} mm` : `${metres.toFixed(5)} m`);

/** By how much; where the advice says it all, nothing. */
export function amount({word, amount: by = 0, tension}: SectionFrame, system: System): string {
  const kind = kindOf(word);
  if ((kind === 'over' || kind === 'slack') && by > 0) return ` by ${length(by, system)}`;
  return kind === 'over' && tension?.length ? `, ${Math.max(...tension).toFixed(1)} N` : '';
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
    if (lost !== null) return this.say('stale', 'NO DATA', lost, 'The server does not answer, the picture is the last one. What was held stops by itself.', false);
    if (frame.recording?.error && kinds.indexOf(kindOf(alarm?.word ?? 'EXACT')) < kinds.indexOf('stale')) return this.unrecorded(frame.recording.error, frame.state === 'armed');
    if (!alarm) return this.quiet(frame);
    const section = sections[alarm.section]!, others = sections.flatMap((one, i) => (i !== alarm.section && kindOf(one.word) !== 'exact' ? [`S${i + 1} ${one.word.toLowerCase()}`] : []));
    const more = isBlind ? '' : alarm.more > 0 ? `${alarm.more} more: ${others.slice(0, 3).join(', ')}${others.length > 3 ? ', …' : ''}` : '';
    const since = alarm.since >= 1 ? `, ${alarm.since < 60 ? `${alarm.since.toFixed(0)} s` : `${Math.floor(alarm.since / 60)} min`}` : '';
    if (isBlind) return this.say('stale', 'NO DATA', since, [frame.message, alarm.did, alarm.next].map(asSentence).filter(Boolean).join(' '), !alarm.acknowledged);
    this.say(kindOf(alarm.word), `S${alarm.section + 1} ${alarm.word}${alarm.word === section.word ? amount(section, system) : ''}`, since, [alarm.did, alarm.next, frame.message, more].map(asSentence).filter(Boolean).join(' '), !alarm.acknowledged);
  }

  private unrecorded(why: string, isArmed: boolean): void {
    this.say('over', 'NOT RECORDED', '', `The recording failed: ${asSentence(why)} ${isArmed ? 'Motion is held. Make room on the disk, disarm, and arm again.' : 'Make room on the disk, and arm again.'}`, false);
  }

  private quiet({sections, message}: Frame): void {
    const near = sections.flatMap((one, i) => (one.near_limit ? [`S${i + 1}`] : []));
    this.say('exact', 'ALL SECTIONS EXACT', '', [near.length > 0 ? `${near.join(', ')} near the limit.` : '', asSentence(message)].filter(Boolean).join(' '), false);
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
