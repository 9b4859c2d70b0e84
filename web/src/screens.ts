// Screens of the page, and the buttons that lead to them. They are there where there is more than one.
import {button, byId} from './make';

export type ScreenName = 'design' | 'trajectory';
const titles: Record<ScreenName, string> = {design: 'Design', trajectory: 'Trajectory'};

export class Screens {
  shown: ScreenName = 'design';
  private readonly buttons: Record<ScreenName, HTMLButtonElement>;

  /** @param turned another one is shown now */
  constructor(private readonly turned: (name: ScreenName, isAsWas: boolean) => void) {
    const to = (name: ScreenName, key: string) => button(titles[name], () => this.show(name), `${titles[name]} (${key})`);
    this.buttons = {design: to('design', 'Alt+1'), trajectory: to('trajectory', 'Alt+4')};
    byId('screens').append(...Object.values(this.buttons));
    this.mark();
  }

  offer(): void {
    byId('screens').hidden = false;
    document.body.classList.add('has-plan');
  }

  /** @param isAsWas as it was left; else a link says what is in it */
  show(name: ScreenName, isAsWas = true): void {
    if (name === this.shown) return;
    this.shown = name;
    this.mark();
    this.turned(name, isAsWas);
  }

  private mark(): void {
    document.body.dataset.screen = this.shown;
    for (const [name, one] of Object.entries(this.buttons)) {
      byId(name).hidden = name !== this.shown;
      one.ariaCurrent = name === this.shown ? 'page' : null;
    }
  }
}
