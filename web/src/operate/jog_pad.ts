// A pad for gloves and touch: it jogs the target of a section, or of the tip as its camera sees it, as a gamepad does.
import {button, make} from '../make';
import type {Motion} from './control';
import type {Jog, JogFrame, Way} from './jog';
import {heldButton, Labelled} from './press';

const openKey = 'sinew-jog-pad', frameKey = 'sinew-jog-frame';  // of this browser
const patience = 300;  // ms after which a tap is a push

type Side = 'up' | 'left' | 'right' | 'down';
const ways: Record<Side, Way> = {up: [0, 1], left: [-1, 0], right: [1, 0], down: [0, -1]};
const arrows: Record<Side, string> = {up: '↑', left: '←', right: '→', down: '↓'};
const keys: Record<string, Side> = {ArrowUp: 'up', ArrowLeft: 'left', ArrowRight: 'right', ArrowDown: 'down'};

export interface Pushed {
  may(): boolean;                                  ///< whether a target may be set; if not it says why
  choose(by: number): void;
  motion(motion: Motion, isHeld: boolean): void;
  turned(): void;                                  ///< it was folded, or has another frame
}

/** What it shows. `locked`: why a motion is not to be had; undefined: there is no stage */
export interface Shown { section: string; tip: string; names: [string, string]; held: Motion | null; hasGamepad: boolean; locked?: (motion: Motion) => string | null }

export class JogPad {
  frame: JogFrame = localStorage.getItem(frameKey) === 'tip' ? 'tip' : 'section';
  isOpen = localStorage.getItem(openKey) === 'open';
  private readonly title = make('h2');
  private readonly frames: [JogFrame, HTMLButtonElement][];
  private readonly sides: [Side, HTMLButtonElement][];
  private readonly middle = button('', () => this.pushed.choose(1));
  private readonly advance = this.motion('advance');
  private readonly retract = this.motion('retract');
  private readonly fold = button('Fold', () => this.toggle(false), 'fold the pad (j)');
  private readonly opener = button('Jog pad', () => this.toggle(true), 'a pad that moves the target (j)');
  private readonly timers = new Map<Side, number>();

  /** @param place where the button that opens it is */
  constructor(private readonly box: HTMLElement, place: HTMLElement, private readonly jog: Jog, private readonly pushed: Pushed) {
    this.frames = (['section', 'tip'] as const).map((frame) => [frame, button(frame === 'section' ? 'Section' : 'Tip', () => this.use(frame), frame === 'section' ? 'along the axes of its diagram' : 'as the camera in the tip sees it: the last section bends')]);
    this.sides = (Object.keys(ways) as Side[]).map((side) => [side, heldButton(() => this.begin(side), () => this.end(side))]);
    for (const [side, one] of this.sides) one.classList.add(side);
    this.opener.className = 'jog-opener';
    this.opener.append(make('kbd', {textContent: 'J'}));
    this.fold.append(make('kbd', {textContent: 'J'}));
    this.middle.className = 'middle';
    place.append(this.opener);
    const cross = make('div', {className: 'cross'}, ...this.sides.map(([, one]) => one), this.middle), switching = make('div', {className: 'switching'}, ...this.frames.map(([, one]) => one), this.fold);
    box.append(this.title, switching, cross, make('div', {className: 'along'}, this.advance.element, this.retract.element));
    box.addEventListener('keydown', (event) => this.key(event, true));
    box.addEventListener('keyup', (event) => this.key(event, false));
    for (const end of ['blur', 'pagehide'] as const) window.addEventListener(end, () => this.endAll());
    this.mark();
  }

  toggle(is = !this.isOpen): void {
    const hadFocus = this.box.contains(document.activeElement);
    this.isOpen = is;
    localStorage.setItem(openKey, is ? 'open' : '');
    this.endAll();
    this.mark();
    if (hadFocus && !is) this.opener.focus();
    this.pushed.turned();
  }

  /** Nothing is pushed any more. */
  endAll(): void {
    for (const side of Object.keys(ways) as Side[]) this.end(side);
  }

  show({section, tip, names: [x, y], held, hasGamepad, locked}: Shown): void {
    const isTip = this.frame === 'tip', said: Record<Side, string> = isTip ? {up: 'up', left: 'left', right: 'right', down: 'down'} : {up: `+${y}`, left: `−${x}`, right: `+${x}`, down: `−${y}`};
    put(this.title, `${isTip ? `Jog the tip: ${tip}, as its camera sees` : `Jog ${section}: its target`} · ${hasGamepad ? 'gamepad' : 'no gamepad'}`);
    this.title.title = hasGamepad ? 'its sticks move the target, its shoulder is Move' : 'to use a gamepad press one of its buttons';
    put(this.middle, isTip ? tip : section);
    this.middle.disabled = isTip;
    this.middle.title = isTip ? '' : 'the next section';
    this.sides.forEach(([side, one]) => {
      if (one.dataset.said === said[side]) return;
      one.dataset.said = said[side];
      one.replaceChildren(make('strong', {textContent: arrows[side]}), make('small', {textContent: said[side]}));
      one.ariaLabel = `target ${said[side]}`;
    });
    this.box.classList.toggle('has-stage', !!locked);
    for (const [of, word, key, motion, note] of [[this.advance, 'Advance', 'W', 'advance', 'on its path'], [this.retract, 'Back', 'R', 'retract', 'the way back']] as const) {
      const why = locked?.(motion) ?? null;
      of.say(word, key, why ?? note, !!why);
      of.element.classList.toggle('pressed', held === motion);
    }
  }

  private motion(motion: Motion): Labelled {
    return new Labelled(heldButton(() => this.pushed.motion(motion, true), () => this.pushed.motion(motion, false)));
  }

  private use(frame: JogFrame): void {
    this.endAll();
    this.frame = frame;
    localStorage.setItem(frameKey, frame);
    this.mark();
    this.pushed.turned();
  }

  private begin(side: Side): void {
    if (this.timers.has(side) || !this.pushed.may()) return;
    this.jog.tap(this.frame, ways[side]);
    this.timers.set(side, window.setTimeout(() => this.jog.push(`pad ${side}`, this.frame, ways[side]), patience));
  }

  private end(side: Side): void {
    clearTimeout(this.timers.get(side));
    this.timers.delete(side);
    this.jog.push(`pad ${side}`, this.frame, null);
  }

  private key(event: KeyboardEvent, isDown: boolean): void {
    const side = keys[event.key];
    if (!side || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    if (!isDown) this.end(side);
    else if (!event.repeat) this.begin(side);
  }

  private mark(): void {
    this.box.hidden = !this.isOpen;
    this.opener.hidden = this.isOpen;
    for (const [frame, one] of this.frames) one.ariaPressed = String(frame === this.frame);
  }
}

function put(element: HTMLElement, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}
