// Screens of the page, and the buttons that lead to them. They are there where there is more than one.
import {button, byId} from './make';

export type ScreenName = 'design' | 'operate' | 'trajectory';
const titles: Record<ScreenName, [title: string, key: string]> = {design: ['Design', 'Alt+1'], operate: ['Operate', 'Alt+2'], trajectory: ['Trajectory', 'Alt+4']};

export class Screens {
  shown: ScreenName = 'design';
  private readonly buttons: Record<ScreenName, HTMLButtonElement>;

  /** @param turned another one is shown now */
  constructor(private readonly turned: (name: ScreenName, isAsWas: boolean, before: ScreenName) => void) {
    const to = (name: ScreenName) => button(titles[name][0], () => this.show(name), `${titles[name][0]} (${titles[name][1]})`);
    this.buttons = {design: to('design'), operate: to('operate'), trajectory: to('trajectory')};
    byId('screens').append(...Object.values(this.buttons));
    for (const name of ['operate', 'trajectory'] as const) this.buttons[name].hidden = true;
    this.mark();
  }

  /** Those that there are, by their keys. */
  get offered(): Record<string, ScreenName> {
    const names = (Object.keys(titles) as ScreenName[]).filter((name) => !this.buttons[name].hidden);
    return names.length > 1 ? Object.fromEntries(names.map((name) => [titles[name][1], name])) : {};
  }

  offer(name: ScreenName, is = true): void {
    this.buttons[name].hidden = !is;
    const hasMore = Object.keys(this.offered).length > 0;
    byId('screens').hidden = !hasMore;
    document.body.classList.toggle('has-screens', hasMore);
    if (!is && this.shown === name) this.show('design');
  }

  /** @param isAsWas as it was left; else a link says what is in it */
  show(name: ScreenName, isAsWas = true): void {
    if (name === this.shown) return;
    const before = this.shown;
    this.shown = name;
    this.mark();
    this.turned(name, isAsWas, before);
  }

  private mark(): void {
    document.body.dataset.screen = this.shown;
    for (const [name, one] of Object.entries(this.buttons)) {
      byId(name).hidden = name !== this.shown;
      one.ariaCurrent = name === this.shown ? 'page' : null;
    }
  }
}
