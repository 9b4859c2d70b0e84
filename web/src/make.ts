// Elements with less ceremony.

export function make<K extends keyof HTMLElementTagNameMap>(tag: K, with_: Partial<HTMLElementTagNameMap[K]> = {}, ...children: (Node | string)[]): HTMLElementTagNameMap[K] {
  const element = Object.assign(document.createElement(tag), with_);
  element.append(...children);
  return element;
}

export function button(text: string, go: () => void, title = ''): HTMLButtonElement {
  const made = make('button', {type: 'button', textContent: text, title});
  made.addEventListener('click', go);
  return made;
}

export const byId = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
