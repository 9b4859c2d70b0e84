// The dialog before anything moves: what has to hold, homing where it is wanted, and that this page is no emergency stop.
import {button, make} from '../make';
import type {Control} from './control';
import {type DeviceInfo, type Frame, kindOf, worstFirst} from './frame';
import {icon} from './mark';
import {heldButton, Labelled, slowButton} from './press';

const longEnough = 1000;  // ms that Arm has to be held

/** `isTried`: only arming tells whether it holds by now. */
interface Check { says: string; isMet: boolean; why: string; isTried?: boolean }

function checks(frame: Frame, info: DeviceInfo): Check[] {
  const at = worstFirst(frame.sections)[0], worst = at === undefined ? null : frame.sections[at]!, kind = worst ? kindOf(worst.word) : 'stale';
  return [
    {says: 'The firmware has the table of this robot', isMet: frame.link === 'ok', why: frame.message || 'the device does not answer'},
    {says: 'Homed: the zero of each tendon is known', isMet: frame.homed, why: info.has_tension ? 'hold Home until all tendons are done' : 'set the zeros by hand: its drives measure no tension'},
    {says: 'No state is worse than slack', isMet: kind === 'exact' || kind === 'slack', why: worst ? `S${at! + 1} is ${worst.word.toLowerCase()}` : ''},
    {says: 'What happens is recorded', isMet: !frame.recording?.error, why: `the last time: ${frame.recording?.error}; make room on the disk, then arm`, isTried: true},
  ];
}

export class ArmingDialog {
  private readonly dialog = make('dialog', {className: 'arming-dialog'});
  private readonly list = make('ul');
  private readonly home: Labelled;
  private readonly ticks = make('div', {className: 'ticks'});
  private readonly now = make('p', {className: 'now'});
  private readonly arm: HTMLButtonElement;
  private said = '';

  constructor(box: HTMLElement, private readonly control: Control, private readonly info: DeviceInfo) {
    this.home = new Labelled(heldButton(() => control.press('home'), () => control.held === 'home' && control.letGo()));
    this.home.element.classList.add('home');
    this.arm = slowButton('Hold 1 s to arm', longEnough, () => void control.arm());
    this.arm.classList.add('main');
    this.now.setAttribute('role', 'status');
    this.dialog.ariaLabel = 'Arm';
    this.dialog.append(make('h2', {textContent: 'Arm the device'}), this.list, make('div', {className: 'homing'}, this.home.element, this.ticks), this.now,
                       make('p', {className: 'warning'}, make('strong', {textContent: 'This page is not an emergency stop. '}), 'The stop is the hard-wired switch, and the firmware lets go by itself after 200 ms of silence. Know where the switch is.'),
                       make('div', {className: 'ends'}, button('Cancel', () => this.close()), this.arm));
    this.dialog.addEventListener('close', () => control.held === 'home' && control.letGo());
    box.append(this.dialog);
  }

  open(frame: Frame): void {
    this.show(frame);
    if (!this.dialog.open) this.dialog.showModal();
  }

  close(): void {
    this.dialog.close();
  }

  show(frame: Frame): void {
    if (this.dialog.open && (frame.state === 'armed' || !this.control.isMine)) return this.close();
    const all = checks(frame, this.info), said = JSON.stringify(all);
    if (said !== this.said) this.list.replaceChildren(...all.map((one) => row(one)));
    this.said = said;
    this.arm.disabled = all.some(({isMet, isTried}) => !isMet && !isTried);
    this.homing(frame);
  }

  private homing({homed, homing, homed_at: kept, activity}: Frame): void {
    const {sections, tendons, has_tension} = this.info, done = homing?.done ?? (homed ? sections * tendons : 0);
    this.home.element.hidden = !has_tension;
    this.home.say(homed ? 'Home anew' : 'Home', '', this.control.held === 'home' ? 'release to stop' : 'hold', false);
    if (this.ticks.childElementCount !== sections * tendons) this.ticks.replaceChildren(...Array.from({length: sections * tendons}, (_, i) => make('span', {title: `S${Math.floor(i / tendons) + 1} tendon ${(i % tendons) + 1}`})));
    [...this.ticks.children].forEach((one, i) => {
      one.className = `${i < done ? 'done' : homing && i === done ? 'at' : ''}${i > 0 && i % tendons === 0 ? ' first' : ''}`;
    });
    const text = activity === 'homing' && homing ? `S${homing.section + 1} tendon ${homing.tendon + 1}: ${homing.step}, ${homing.done} of ${homing.of} done`
      : kept ? `Homed ${kept.date} at ${kept.pretension.toFixed(1)} N${kept.error && `; not kept: ${kept.error}`}` : '';
    if (this.now.textContent !== text) this.now.textContent = text;
  }
}

function row({says, isMet, why}: Check): HTMLElement {
  return make('li', {className: isMet ? 'met' : 'unmet'}, icon(isMet ? 'exact' : 'over', 16), make('span', {}, says, make('span', {className: 'sr', textContent: isMet ? ': yes' : ': no'}), ...(isMet || !why ? [] : [make('small', {textContent: why})])));
}
