// Copies text also where browsers keep their clipboard to themselves: at addresses that are neither this computer's nor secure.
import {button, make} from './make';
import {toast} from './toast';

/** The older way: what is selected is copied. It has to happen while a key or a click is dealt with. */
function selected(text: string): boolean {
  const area = make('textarea', {value: text, readOnly: true, className: 'sr'}), before = document.activeElement;
  document.body.append(area);
  area.select();
  const isCopied = document.execCommand('copy');
  area.remove();
  if (before instanceof HTMLElement) before.focus();
  return isCopied;
}

/** The last way: the text, selected, for the keys of the browser. */
function show(text: string): void {
  const area = make('textarea', {value: text, readOnly: true, rows: 6}), close = button('Close', () => dialog.close());
  const dialog = make('dialog', {className: 'copy'}, make('p', {textContent: 'This browser lets no page copy. Here it is, selected:'}), area, close);
  area.setAttribute('aria-label', 'text to copy');
  dialog.addEventListener('close', () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
  area.select();
}

/** @param says what was done, as people are told */
export async function copy(text: string, says: string): Promise<void> {
  const isCopied = navigator.clipboard ? await navigator.clipboard.writeText(text).then(() => true, () => selected(text)) : selected(text);
  if (isCopied) toast(says);
  else show(text);
}
