// Keys of the page, in one list: what they do and what help says of them.
import {make} from './make';

export interface Key {
  keys: string[];  ///< `Ctrl+z`, `Shift+?` without the Shift that the character needs
  says: string;
  go?: (key: string) => void;  ///< none: said here, done where the focus is
}

/** Where Shift makes another character of comma and full stop, which one depends on the keyboard. */
const isShifted = ({shiftKey, code, key}: KeyboardEvent) => shiftKey && (code === 'Comma' || code === 'Period') && '<>;:'.includes(key);

const nameOf = (event: KeyboardEvent) => isShifted(event) ? `Shift+${event.code === 'Comma' ? ',' : '.'}` :
  `${event.ctrlKey || event.metaKey ? 'Ctrl+' : ''}${event.altKey ? 'Alt+' : ''}${event.shiftKey && event.key.length > 1 || (event.ctrlKey && event.shiftKey) ? 'Shift+' : ''}${event.key.length === 1 ? event.key.toLowerCase() : event.key}`;

/** Where letters are written, or choose in a list: there they are nothing else. */
export const isText = (target: EventTarget | null) => target instanceof HTMLElement &&
  (target.isContentEditable || (target instanceof HTMLInputElement && !['range', 'radio', 'checkbox'].includes(target.type)) || target instanceof HTMLTextAreaElement);
const isList = (target: EventTarget | null) => target instanceof HTMLSelectElement;

/** Where the focus is, also in the editor's own root. */
function focused(event: Event): EventTarget | null {
  return event.composedPath()[0] ?? event.target;
}

/** What Space presses by itself. */
const isPressed = (target: EventTarget | null) => target instanceof HTMLElement && target.matches('button, summary, input[type="checkbox"], input[type="radio"]');

/** @param keys those of the screen that is shown */
export function listen(keys: () => Key[]): void {
  document.addEventListener('keydown', (event) => {
    const name = nameOf(event), target = focused(event);
    if (document.querySelector('dialog[open]')) return;  // it closes itself at Esc
    if (event.isComposing || isText(target) || (isList(target) && name.length === 1)) return;
    if (name === ' ' && isPressed(target)) return;
    if (name === 'Ctrl+c' && !getSelection()?.isCollapsed) return;
    const found = keys().find((key) => key.go && key.keys.includes(name));
    if (!found) return;
    event.preventDefault();
    found.go!(name);
  });
}

const shown: Record<string, string> = {'Ctrl+Shift+z': 'Ctrl+Shift+Z', 'Ctrl+z': 'Ctrl+Z', 'Ctrl+c': 'Ctrl+C', Escape: 'Esc', ' ': 'Space', 'Shift+,': 'Shift ,', 'Shift+.': 'Shift .'};

export function fillHelp(dialog: HTMLElement, keys: Key[]): void {
  const rows = keys.flatMap(({keys: names, says}) => [make('dt', {}, ...names.map((name) => make('kbd', {textContent: shown[name] ?? name}))), make('dd', {textContent: says})]);
  dialog.replaceChildren(make('h2', {textContent: 'Keys'}), make('dl', {}, ...rows),
    make('p', {textContent: 'A number box takes 12, 12 mm, 0.012 m, 1/2 in.'}), make('form', {method: 'dialog'}, make('button', {textContent: 'Close'})));
}
