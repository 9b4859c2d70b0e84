// Buttons that act while they are held down, by pointer or by Enter, and buttons that have to be held for a while.
import {button, make} from '../make';

/** @param down it was pressed; up: released, or the pointer was lost */
export function heldButton(down: () => void, up: () => void): HTMLButtonElement {
  const made = button('', () => undefined);
  let isDown = false;
  const press = () => {
    if (isDown || made.disabled) return;
    isDown = true;
    down();
  };
  const release = () => {
    if (!isDown) return;
    isDown = false;
    up();
  };
  made.classList.add('held');
  made.addEventListener('pointerdown', (event) => {
    if (event.button !== 0) return;
    made.setPointerCapture(event.pointerId);
    press();
  });
  for (const end of ['pointerup', 'pointercancel', 'lostpointercapture', 'blur'] as const) made.addEventListener(end, release);
  made.addEventListener('keydown', (event) => event.key === 'Enter' && (event.preventDefault(), event.repeat || press()));
  made.addEventListener('keyup', (event) => event.key === 'Enter' && release());
  made.addEventListener('contextmenu', (event) => event.preventDefault());
  window.addEventListener('blur', release);
  return made;
}

/** Does something once it has been held for so long [ms]; a bar shows how far it is. @param end it was released @param may it be begun? */
export function slowButton(text: string, after: number, go: () => void, end: () => void = () => undefined, may: () => boolean = () => true): HTMLButtonElement {
  let timer = 0;
  const made = heldButton(() => {
    if (!may()) return;
    made.classList.add('filling');
    timer = window.setTimeout(() => {
      made.classList.remove('filling');
      go();
    }, after);
  }, () => {
    clearTimeout(timer);
    made.classList.remove('filling');
    end();
  });
  made.classList.add('slow');
  made.append(make('span', {textContent: text}));
  return made;
}

/** Two lines: what it does, and how, or why it is locked. */
export class Labelled {
  private readonly word = make('strong');
  private readonly note = make('small');

  constructor(readonly element: HTMLButtonElement) {
    element.replaceChildren(this.word, this.note);
  }

  say(word: string, key: string, note: string, isLocked: boolean): void {
    const said = `${word}|${key}|${note}`;
    if (this.element.dataset.said !== said) {
      this.element.dataset.said = said;
      this.word.replaceChildren(word, ...(key ? [' ', make('kbd', {textContent: key})] : []));
      this.note.textContent = note;
    }
    // aria-disabled, not disabled: a locked button says why, and keeps the focus
    this.element.ariaDisabled = String(isLocked);
  }

  get isLocked(): boolean {
    return this.element.ariaDisabled === 'true';
  }
}
