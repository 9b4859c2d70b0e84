// The robot's file: checked a moment after the last key. While it has errors the picture stays that of the last good one.
import {type Json, Refused, Robot} from './client';

const patience = 300;  // ms after the last key

export class FileTab {
  private readonly area = document.createElement('textarea');
  private readonly numbers = document.createElement('pre');
  private readonly errors = document.createElement('ol');
  private readonly note = document.createElement('p');
  private timer = 0;

  constructor(panel: HTMLElement, private readonly opened: (robot: Robot) => Promise<void>) {
    const editor = document.createElement('div');
    editor.className = 'editor';
    this.area.spellcheck = false;
    this.area.setAttribute('aria-label', 'Robot file');
    this.numbers.ariaHidden = 'true';
    this.note.setAttribute('role', 'status');
    this.area.addEventListener('input', () => this.typed());
    this.area.addEventListener('scroll', () => { this.numbers.scrollTop = this.area.scrollTop; });
    editor.append(this.numbers, this.area);
    panel.replaceChildren(editor, this.note, this.errors);
  }

  show(text: string): void {
    clearTimeout(this.timer);
    if (this.area.value !== text) this.area.value = text;
    this.count();
    this.errors.replaceChildren();
    this.note.textContent = '';
  }

  private typed(): void {
    this.count();
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.check(), patience);
  }

  private count(): void {
    const lines = this.area.value.split('\n').length;
    this.numbers.textContent = Array.from({length: lines}, (_, i) => i + 1).join('\n');
  }

  private async check(): Promise<void> {
    const text = this.area.value;
    try {
      const robot = await Robot.open(text);
      if (text === this.area.value) await this.opened(robot);
    } catch (error) {
      if (!(error instanceof Refused) || !error.answer.errors) throw error;
      this.note.textContent = 'The picture shows the last valid file.';
      this.errors.replaceChildren(...error.answer.errors.map((one: Json) => this.error(one)));
    }
  }

  private error(one: Json): HTMLElement {
    const item = document.createElement('li'), go = document.createElement('button');
    go.type = 'button';
    go.textContent = one.line ? `${one.line}:${one.column ?? 1}` : one.where;
    go.addEventListener('click', () => this.goTo(one.line ?? 1, one.column ?? 1));
    item.append(go, ` ${one.message}`);
    return item;
  }

  private goTo(line: number, column: number): void {
    const before = this.area.value.split('\n').slice(0, line - 1).join('\n').length + (line > 1 ? 1 : 0);
    this.area.focus();
    this.area.setSelectionRange(before + column - 1, before + column);
  }
}
