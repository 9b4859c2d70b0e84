// What is around every screen: units, theme, panels, help, the status line.
import {button, byId, make} from './make';
import {type System, unitName} from './units';

const themes = ['auto', 'day', 'dark'];

export class Shell {
  system: System = 'mm';

  /** @param changed units or colours are others now */
  constructor(private readonly changed: () => void) {
    byId('units').addEventListener('click', () => this.toggleUnits());
    byId('theme').addEventListener('click', () => this.nextTheme());
    byId('drawer').addEventListener('click', () => this.toggleDrawer());
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.paint());
    this.theme();
  }

  say(text: string): void {
    byId('status').textContent = text;
  }

  /** Why there is nothing to be seen, where everybody sees it: a phone has no status line. */
  refuse(text: string): void {
    this.say(text);
    byId('lost').before(make('p', {className: 'plate', role: 'alert'}, text, ' ', button('Reload', () => location.reload())));
  }

  connected(is: boolean): void {
    byId('link').className = `dot ${is ? 'on' : 'lost'}`;
    byId('link').setAttribute('aria-label', is ? 'connected' : 'no connection');
  }

  help(): void {
    byId<HTMLDialogElement>('keys').showModal();
  }

  toggleLeft(): void {
    document.body.classList.toggle('no-left');
  }

  toggleDrawer(is = !document.body.classList.contains('answer')): void {
    document.body.classList.toggle('answer', is);
    byId('drawer').setAttribute('aria-expanded', String(is));
  }

  toggleUnits(): void {
    this.system = this.system === 'mm' ? 'SI' : 'mm';
    byId('units').textContent = `${unitName('m', this.system)} · ${unitName('rad', this.system)}`;
    this.changed();
  }

  nextTheme(): void {
    const theme = byId('theme');
    theme.textContent = themes[(themes.indexOf(theme.textContent ?? '') + 1) % themes.length]!;
    this.paint();
  }

  private theme(): void {
    const chosen = byId('theme').textContent;
    const isDark = chosen === 'dark' || (chosen === 'auto' && matchMedia('(prefers-color-scheme: dark)').matches);
    document.documentElement.dataset.theme = isDark ? 'dark' : 'day';
  }

  private paint(): void {
    this.theme();
    this.changed();
  }
}
