// What each tendon of a section has too much or lacks, and how hard it pulls.
import {make} from '../make';
import type {System} from '../units';
import type {SectionFrame} from './frame';
import {tagAlone} from './mark';

const least = 1e-3;  // of slack that a bar's half stands for [m]

/** With a sign, two decimals of a millimetre. */
export function signed(value: number, system: System): string {
  const shown = system === 'mm' ? (1e3 * value).toFixed(2) : value.toFixed(5), isZero = Number(shown) === 0;
  return `${isZero ? '' : value < 0 ? '−' : '+'}${isZero ? shown.replace('-', '') : shown.replace('-', '')} ${system}`.replace(/ SI$/, ' m');
}

interface Row { element: HTMLElement; fill: HTMLElement; value: HTMLElement; pull: HTMLElement; newtons: HTMLElement }

export class TendonBars {
  readonly element = make('div', {className: 'tendons'});
  private rows: Row[] = [];

  show({slack, changes, tension}: SectionFrame, limit: number, system: System): void {
    if (this.rows.length !== changes.length) this.build(changes.length);
    const most = Math.max(least, ...(slack ?? []).map(Math.abs));
    this.element.classList.toggle('pulls', !!tension?.length);
    this.rows.forEach(({fill, value, pull, newtons}, i) => {
      const own = slack?.[i], part = (50 * Math.abs(own ?? 0)) / most;
      value.textContent = own === undefined ? '–' : signed(own, system);
      fill.className = `fill ${(own ?? 0) < 0 ? 'over' : 'slack'}`;
      fill.style.width = `${part}%`;
      fill.style.left = `${(own ?? 0) < 0 ? 50 - part : 50}%`;
      const force = tension?.[i] ?? 0;
      newtons.textContent = tension?.length ? `${force.toFixed(1)} N` : '';
      pull.style.width = `${limit > 0 ? Math.min(100, (100 * force) / limit) : 0}%`;
      pull.classList.toggle('over', limit > 0 && force > limit);
    });
    if (tension?.length) this.element.title = limit > 0 ? `tension of at most ${limit.toFixed(0)} N` : '';
  }

  private build(count: number): void {
    this.rows = Array.from({length: count}, (_, i) => {
      const fill = make('span', {className: 'fill'}), pull = make('span', {className: 'fill'}), value = make('span', {className: 'value'}), newtons = make('span', {className: 'newtons'});
      const track = make('span', {className: 'track'}, fill), thin = make('span', {className: 'pull'}, pull), label = make('span', {className: 'sr', textContent: `tendon ${i + 1}`});
      return {element: make('div', {className: 'tendon'}, tagAlone(i), label, make('span', {className: 'both'}, track, thin), value, newtons), fill, value, pull, newtons};
    });
    this.element.replaceChildren(...this.rows.map(({element}) => element));
  }
}
