// The robot's file: checked a moment after the last key. While it has errors the picture stays that of the last good one.
import {type Json, Refused, Robot} from './client';
import type {Editor} from './editor';
import {button, make} from './make';
import {toast} from './toast';

const patience = 300;  // ms after the last key

export class FileTab {
  private readonly errors = make('ol');
  private readonly note = make('p');
  private readonly disk = make('p', {className: 'disk', hidden: true});
  private readonly box = make('div', {className: 'editor'});
  private editor: Editor | null = null;
  private timer = 0;
  private name = '';
  private saved = '';  // the file as it was opened
  private isOpening = false;

  constructor(panel: HTMLElement, private readonly opened: (robot: Robot) => Promise<void>) {
    this.note.setAttribute('role', 'status');
    this.disk.setAttribute('role', 'status');
    panel.append(this.box, this.disk, this.note, this.errors, make('div', {className: 'actions'},
      button('Copy YAML', () => void navigator.clipboard.writeText(this.text).then(() => toast('copied')), 'the whole file'),
      button('Undo', () => this.editor?.undo(), 'the last change of the text'),
      button('Reload', () => this.reload(this.saved), 'the file as it was opened'),
      button('Save…', () => this.save(), 'download the file')));
  }

  get text(): string {
    return this.editor?.text ?? this.saved;
  }

  /** The editor comes when it is wanted: pictures need not wait for it. */
  async load(): Promise<void> {
    const {Editor} = await import('./editor.js');
    if (this.editor) return;
    this.editor = new Editor(this.box, () => this.typed());
    this.fill();
  }

  private fill(): void {
    this.isOpening = true;
    this.editor?.open(this.saved);
    this.isOpening = false;
  }

  /** The file of a robot that is shown already. */
  show(name: string, text: string): void {
    clearTimeout(this.timer);
    this.name = name;
    this.saved = text;
    this.fill();
    this.quiet();
  }

  /** The same file has another text on disk. */
  changedOnDisk(text: string): void {
    if (text === this.saved) return;
    this.disk.replaceChildren('changed on disk: ', button('Reload', () => this.reload(text)), button('Keep mine', () => {
      this.saved = text;
      this.disk.hidden = true;
    }));
    this.disk.hidden = false;
  }

  private reload(text: string): void {
    this.show(this.name, text);
    void this.check();
  }

  private save(): void {
    const url = URL.createObjectURL(new Blob([this.text], {type: 'text/yaml'}));
    make('a', {href: url, download: `${this.name.replace(/^.*\//, '').replace(/\.yaml$/, '')}.yaml`}).click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
  }

  private quiet(): void {
    this.errors.replaceChildren();
    this.note.textContent = '';
    this.disk.hidden = true;
    this.editor?.mark([]);
  }

  private typed(): void {
    if (this.isOpening) return;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.check(), patience);
  }

  private async check(): Promise<void> {
    const {text} = this;
    try {
      const robot = await Robot.open(text);
      if (text !== this.text) return;
      this.quiet();
      await this.opened(robot);
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      if (text === this.text) this.tell(error.answer.errors ?? [{message: error.message, where: 'file'}]);
    }
  }

  private tell(errors: Json[]): void {
    this.note.textContent = 'The picture shows the last valid file.';
    this.editor?.mark(errors.map(({line = 0, column = 1, message}) => ({line, column, message})));
    this.errors.replaceChildren(...errors.map(({line, column, where, message}) => {
      const go = button(line ? `${line}:${column ?? 1}` : where, () => this.editor?.goTo(line ?? 1, column ?? 1));
      return make('li', {}, go, ` ${message}`);
    }));
  }
}
