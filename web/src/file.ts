// The robot's file: checked a moment after the last key. While it has errors the picture stays that of the last good one.
import {type Json, Refused, Robot} from './client';
import {copy} from './clipboard';
import type {Editor} from './editor';
import {button, make} from './make';
import {type Draft, drafts, type Source} from './source';
import {toast} from './toast';

const patience = 300;  // ms after the last key

/** What the page does for the file. */
export interface Owner {
  opened(robot: Robot): Promise<void>;                        ///< another text of the file is a robot
  based(base: string): Promise<void>;                         ///< the file itself has another text, the robot is as it was
  guarded(task: () => Promise<void>, again: () => void): Promise<void>;
}

/** Gives a text to the browser as a file. */
export function download(name: string, text: string, type = 'text/yaml'): void {
  const url = URL.createObjectURL(new Blob([text], {type}));
  make('a', {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

export class FileTab {
  private readonly errors = make('ol');
  private readonly note = make('p');
  private readonly disk = make('p', {className: 'disk', hidden: true});
  private readonly box = make('div', {className: 'editor'});
  private editor: Editor | null = null;
  private timer = 0;
  private source: Source | null = null;
  private base = '';    // the file as it is on disk
  private written = '';  // as it stands in the editor
  private isOpening = false;

  constructor(panel: HTMLElement, private readonly owner: Owner) {
    this.note.setAttribute('role', 'status');
    this.disk.setAttribute('role', 'status');
    panel.append(this.box, this.disk, this.note, this.errors, make('div', {className: 'actions'},
      button('Copy YAML', () => void copy(this.text, 'file copied'), 'the whole file'),
      button('Undo', () => this.editor?.undo() || toast('nothing more to undo here'), 'the last change of the text'),
      button('Reload', () => this.reload(), 'the file as it was opened'),
      button('Save…', () => this.save(), 'download the file')));
  }

  get text(): string {
    return this.written;
  }

  /** The editor comes when it is wanted: pictures need not wait for it. */
  async load(): Promise<void> {
    const {Editor} = await import('./editor.js');
    if (this.editor) return;
    this.editor = new Editor(this.box, () => this.typed());
    this.fill(true);
  }

  private fill(isOther: boolean): void {
    this.isOpening = true;
    this.editor?.open(this.written, this.base, isOther);
    this.isOpening = false;
  }

  /**
   * The file of a robot that is shown already.
   * @param draft what was written in it before, where that goes on
   * @param other what was written in it before, where the robot is not of it: it may be taken up again
   */
  show(source: Source, draft: Draft | null, other: Draft | null): void {
    clearTimeout(this.timer);
    this.source = source;
    this.base = source.base;
    this.written = draft?.text ?? source.text;
    this.fill(true);
    this.quiet();
    if (other) this.offer('changes of an earlier visit are kept: ', button('Take them', () => this.replace(other.text)), button('Drop them', () => {
      drafts.keep(source.name, null);
      this.disk.hidden = true;
    }));
    if (this.written !== source.text) void this.check();
  }

  /** The robot that is shown is of this text from now on. */
  shown(source: Source): void {
    this.source = source;
    this.keep();
  }

  /** The same file has another text on disk. */
  changedOnDisk(text: string): void {
    if (text === this.base) return;
    this.base = text;
    this.editor?.compare(text);
    this.offer('changed on disk: ', button('Reload', () => this.reload()), button('Keep mine', () => { this.disk.hidden = true; }));
    void this.owner.guarded(() => this.owner.based(text), () => undefined);
  }

  private offer(...parts: (Node | string)[]): void {
    this.disk.replaceChildren(...parts);
    this.disk.hidden = false;
  }

  private reload(): void {
    this.replace(this.base);
  }

  private replace(text: string): void {
    clearTimeout(this.timer);
    this.written = text;
    this.fill(false);
    this.quiet();
    this.keep();
    void this.check();
  }

  private save(): void {
    const {source, text} = this;
    if (source) download(`${text === this.base ? source.stem.replace(/-modified$/, '') : source.stem.replace(/(-modified)?$/, '-modified')}.yaml`, text);
  }

  /** What is written outlives the page. */
  private keep(): void {
    const {source, base, written} = this;
    if (!source) return;
    const isKept = drafts.keep(source.name, written === base && !source.isModified ? null : {base, text: written, shown: source.text, key: source.key});
    if (!isKept) toast('this browser keeps no drafts: save the file');
  }

  private quiet(): void {
    this.errors.replaceChildren();
    this.note.textContent = '';
    this.disk.hidden = true;
    this.editor?.mark([]);
  }

  private typed(): void {
    if (this.isOpening) return;
    this.written = this.editor!.text;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.check(), patience);
    this.keep();
  }

  private check(): Promise<void> {
    const {text, source} = this, isOld = () => text !== this.text || source?.name !== this.source?.name;
    return this.owner.guarded(async () => {
      try {
        const robot = await Robot.open(text);
        if (isOld()) return;
        this.quiet();
        await this.owner.opened(robot);
      } catch (error) {
        if (isOld()) return;
        if (!(error instanceof Refused) || error.isBusy || !error.answer.errors) {
          this.note.textContent = 'Not checked yet: the picture shows the last valid file.';
          throw error;
        }
        this.tell(error.answer.errors);
      }
    }, () => void this.check());
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
