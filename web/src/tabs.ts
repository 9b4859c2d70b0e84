// Tabs over panels: arrows go along them, as people with a screen reader expect.

export class Tabs {
  private readonly buttons: HTMLButtonElement[];

  constructor(list: HTMLElement, private readonly panels: HTMLElement[], private readonly chosen: (id: string) => void) {
    this.buttons = panels.map((panel, i) => {
      const button = document.createElement('button');
      button.type = 'button';
      button.setAttribute('role', 'tab');
      button.setAttribute('aria-controls', panel.id);
      button.textContent = panel.getAttribute('aria-label');
      button.id = `tab-${panel.id}`;
      panel.setAttribute('aria-labelledby', button.id);
      button.addEventListener('click', () => this.choose(i));
      button.addEventListener('keydown', (event) => this.key(event, i));
      return button;
    });
    list.replaceChildren(...this.buttons);
    this.mark(0);
  }

  /** A tab that this robot has no use for is not there. */
  offer(id: string, is: boolean): void {
    const i = this.panels.findIndex((panel) => panel.id === id);
    this.buttons[i]!.hidden = !is;
    if (!is && !this.panels[i]!.hidden) this.choose(0);
  }

  choose(i: number): void {
    this.mark(i);
    this.chosen(this.panels[i]!.id);
  }

  open(id: string): void {
    this.choose(this.panels.findIndex((panel) => panel.id === id));
  }

  private mark(chosen: number): void {
    this.panels.forEach((panel, i) => {
      panel.hidden = i !== chosen;
      this.buttons[i]!.setAttribute('aria-selected', String(i === chosen));
      this.buttons[i]!.tabIndex = i === chosen ? 0 : -1;
    });
  }

  private key(event: KeyboardEvent, i: number): void {
    const way = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
    if (way === 0) return;
    const count = this.buttons.length;
    let next = (i + way + count) % count;
    while (this.buttons[next]!.hidden) next = (next + way + count) % count;
    this.choose(next);
    this.buttons[next]!.focus();
  }
}
