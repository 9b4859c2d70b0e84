// Relaxes section after section, the most tense first, for as long as its button is held.
import {make} from '../make';
import type {Control} from './control';
import type {Frame, SectionFrame} from './frame';
import {slowButton} from './press';

const longEnough = 1000;  // ms that the button has to be held before anything moves

/** What pulls hardest; where that is not measured, what lacks most. */
export function mostTense(sections: SectionFrame[], left: ReadonlySet<number>): number | undefined {
  const pull = ({tension}: SectionFrame) => Math.max(0, ...(tension ?? [])), lack = ({slack}: SectionFrame) => -Math.min(Infinity, ...(slack ?? []));
  return [...left].sort((a, b) => pull(sections[b]!) - pull(sections[a]!) || lack(sections[b]!) - lack(sections[a]!) || a - b)[0];
}

export class RelaxAll {
  readonly element: HTMLElement;
  private readonly now = make('span', {className: 'now'});
  private left = new Set<number>();
  private isHeld = false;

  constructor(private readonly control: Control, private readonly frame: () => Frame | null) {
    const all = slowButton('Relax all', longEnough, () => this.begin(), () => this.end());
    all.title = 'hold 1 s: pays out section after section, the most tense first, until all are slack';
    this.now.setAttribute('role', 'status');
    this.element = make('div', {className: 'relax-all'}, all, this.now);
  }

  private begin(): void {
    this.isHeld = true;
    this.left = new Set(this.frame()?.sections.keys() ?? []);
    this.next();
  }

  private next(): void {
    if (!this.isHeld) return;
    const section = mostTense(this.frame()?.sections ?? [], this.left);
    if (section === undefined) return this.say('all are slack');
    this.left.delete(section);
    this.say(`S${section + 1}, then ${this.left.size} more`);
    this.control.press('relax', {section}, (isDone) => (isDone ? this.next() : this.end()));
  }

  private end(): void {
    if (!this.isHeld) return;
    this.isHeld = false;
    if (this.control.held === 'relax') void this.control.letGo();
    if (this.left.size > 0) this.say(`stopped with ${this.left.size} to go`);
  }

  private say(text: string): void {
    this.now.textContent = text;
  }
}
