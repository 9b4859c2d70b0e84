// The editor of a robot's file. It lives in a root of its own: its styles come as sheets that are adopted, which the
// content policy lets, not as elements, which it does not.
import {defaultKeymap, history, historyKeymap, undo} from '@codemirror/commands';
import {yaml} from '@codemirror/lang-yaml';
import {HighlightStyle, syntaxHighlighting} from '@codemirror/language';
import {type Diagnostic, lintGutter, setDiagnostics} from '@codemirror/lint';
import {EditorState, type Extension, RangeSetBuilder, type Text} from '@codemirror/state';
import {Decoration, type DecorationSet, EditorView, keymap, lineNumbers, ViewPlugin, type ViewUpdate} from '@codemirror/view';
import {tags} from '@lezer/highlight';

export {changesOf, withChanges} from './yaml';

const theme = EditorView.theme({
  '&': {height: '100%', color: 'var(--text)', backgroundColor: 'var(--card)', fontSize: '12.5px'},
  '.cm-scroller': {fontFamily: 'ui-monospace, monospace', lineHeight: '18px'},
  '.cm-content': {caretColor: 'var(--text)'},
  '.cm-cursor': {borderLeftColor: 'var(--text)'},
  '.cm-gutters': {backgroundColor: 'var(--card)', color: 'var(--mute)', borderRight: '1px solid var(--line)'},
  '.cm-changed': {boxShadow: 'inset 3px 0 var(--accent)'},
  '.cm-selectionBackground, &.cm-focused .cm-selectionBackground': {backgroundColor: 'var(--select) !important'},
  '&.cm-focused': {outline: '2px solid var(--accent)', outlineOffset: '-2px'},
});

const highlight = HighlightStyle.define([
  {tag: [tags.propertyName, tags.definition(tags.propertyName)], color: 'var(--accent)'},
  {tag: tags.comment, color: 'var(--mute)', fontStyle: 'italic'},
]);

/** The lines that differ from the file as it was: all between what both begin and end with, of equally many the unlike ones. */
function changedLines(now: Text, was: string[]): number[] {
  const count = now.lines, line = (i: number) => now.line(i + 1).text, found: number[] = [];
  if (count === was.length) {
    for (let i = 0; i < count; ++i) if (line(i) !== was[i]) found.push(i + 1);
    return found;
  }
  let head = 0, tail = 0;
  while (head < Math.min(count, was.length) && line(head) === was[head]) ++head;
  while (tail < Math.min(count, was.length) - head && line(count - 1 - tail) === was[was.length - 1 - tail]) ++tail;
  for (let i = head; i < count - tail; ++i) found.push(i + 1);
  return found;
}

/** Browsers that replace a selection write styles into elements, which the content policy does not let. */
function typedOver(event: InputEvent, view: EditorView): boolean {
  if (event.inputType !== 'insertText' || !event.data || event.isComposing || view.state.selection.main.empty) return false;
  view.dispatch(view.state.replaceSelection(event.data), {userEvent: 'input.type', scrollIntoView: true});
  event.preventDefault();
  return true;
}

export class Editor {
  private readonly view: EditorView;
  private readonly extensions: Extension[];
  private original: string[] = [];

  constructor(box: HTMLElement, private readonly typed: () => void) {
    const root = box.attachShadow({mode: 'open'}), changed = () => this.original;
    const marks = ViewPlugin.fromClass(class {
      decorations: DecorationSet;
      constructor(view: EditorView) { this.decorations = this.find(view); }
      update(update: ViewUpdate) { this.decorations = this.find(update.view); }
      find(view: EditorView): DecorationSet {
        const builder = new RangeSetBuilder<Decoration>(), mark = Decoration.line({class: 'cm-changed'});
        for (const line of changedLines(view.state.doc, changed())) builder.add(view.state.doc.line(line).from, view.state.doc.line(line).from, mark);
        return builder.finish();
      }
    }, {decorations: (value) => value.decorations});
    this.extensions = [
      lineNumbers(), history(), keymap.of([...defaultKeymap, ...historyKeymap]), yaml(), syntaxHighlighting(highlight), lintGutter(), theme, marks,
      EditorView.contentAttributes.of({'aria-label': 'Robot file', spellcheck: 'false'}),
      EditorView.updateListener.of((update) => update.docChanged && this.typed()),
      EditorView.domEventHandlers({pointerdown: (event, view) => this.grab(event, view), beforeinput: typedOver}),
    ];
    this.view = new EditorView({root, state: EditorState.create({extensions: this.extensions})});
    this.view.scrollDOM.tabIndex = 0;  // so that keys scroll it
    root.append(this.view.dom);
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  /**
   * @param original the file, from which lines that differ are marked
   * @param isOther another file: undo leads not back to the one before
   */
  open(text: string, original: string, isOther: boolean): void {
    this.original = original.split('\n');
    if (isOther) return this.view.setState(EditorState.create({doc: text, extensions: this.extensions}));
    if (this.text !== text) this.view.dispatch({changes: {from: 0, to: this.view.state.doc.length, insert: text}});
  }

  /** The text is as it is, the file another one. */
  compare(original: string): void {
    this.original = original.split('\n');
    this.view.dispatch({});
  }

  /** @return whether there was something to undo */
  undo(): boolean {
    return undo(this.view);
  }

  mark(errors: {line: number; column: number; message: string}[]): void {
    const {doc} = this.view.state;
    const diagnostics: Diagnostic[] = errors.filter(({line}) => line >= 1 && line <= doc.lines).map(({line, column, message}) => {
      const of = doc.line(line), from = Math.min(of.from + Math.max(0, column - 1), of.to), word = /^[^\s,:}\]]+/.exec(of.text.slice(from - of.from));
      return {from, to: Math.min(of.to, from + (word?.[0].length ?? 1)), severity: 'error', message};
    });
    this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
  }

  goTo(line: number, column: number): void {
    const {doc} = this.view.state, of = doc.line(Math.min(Math.max(line, 1), doc.lines)), at = Math.min(of.from + column - 1, of.to);
    this.view.dispatch({selection: {anchor: at, head: Math.min(at + 1, of.to)}, scrollIntoView: true});
    this.view.focus();
  }

  /** With Alt held a number is a slider: four pixels are one of its last digit. */
  private grab(event: PointerEvent, view: EditorView): boolean {
    const at = event.altKey ? view.posAtCoords({x: event.clientX, y: event.clientY}) : null;
    if (at === null) return false;
    const line = view.state.doc.lineAt(at), numbers = [...line.text.matchAll(/-?\d+(\.\d+)?/g)];
    const found = numbers.find((one) => at - line.from >= one.index && at - line.from <= one.index + one[0].length);
    if (!found) return false;
    const decimals = found[1] ? found[1].length - 1 : 0, from = line.from + found.index, begin = event.clientX;
    let length = found[0].length;
    const move = (moved: PointerEvent) => {
      const text = (Number(found[0]) + Math.round((moved.clientX - begin) / 4) * 10 ** -decimals).toFixed(decimals);
      view.dispatch({changes: {from, to: from + length, insert: text}, userEvent: 'input.drag'});
      length = text.length;
    };
    const end = () => window.removeEventListener('pointermove', move);
    window.addEventListener('pointermove', move);
    window.addEventListener('pointerup', end, {once: true});
    event.preventDefault();
    return true;
  }
}
