// One thing that was done, said for six seconds. Never an error.
import {byId} from './make';

let timer = 0;

export function toast(text: string): void {
  const box = byId('toast');
  box.textContent = text;
  box.hidden = false;
  clearTimeout(timer);
  timer = window.setTimeout(() => { box.hidden = true; }, 6000);
}
