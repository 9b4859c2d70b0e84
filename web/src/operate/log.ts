// What has happened: the newest beside the arm, all of it in a drawer, and as a file.
import {download} from '../file';
import {button, make} from '../make';
import {type Entry, kindOfEntry} from './frame';
import {icon} from './mark';

const most = 1000;
const shown = 12;  // beside the arm
const words: [string, string][] = [['', 'all'], ['over', 'over-tensioned'], ['no_data', 'no data'], ['unreachable', 'unreachable'], ['slack', 'slack'], ['exact', 'exact'], ['info', 'all else']];

function row({clock, kind, text}: Entry): HTMLElement {
  const of = kindOfEntry(kind);
  return make('li', {title: text}, make('time', {textContent: clock}), of ? icon(of, 14) : make('span'), make('span', {textContent: text}));
}

const quoted = (text: string) => `"${text.replaceAll('"', '""')}"`;

export class Log {
  readonly drawer = make('section', {className: 'drawer', hidden: true});
  readonly extra = make('div', {className: 'extra'});  ///< what else is in the drawer
  private readonly list = make('ol');
  private readonly all = make('ol', {tabIndex: 0});
  private readonly filter = make('select', {ariaLabel: 'States'});
  private readonly entries: Entry[] = [];
  private readonly opener: HTMLButtonElement;

  constructor(box: HTMLElement) {
    const open = this.opener = button('Events', () => this.toggle(), 'all events (l)');
    open.append(make('kbd', {textContent: 'L'}));
    box.append(make('h2', {}, open), this.list);
    for (const [kind, word] of words) this.filter.add(new Option(word, kind));
    this.filter.addEventListener('change', () => this.fill());
    this.drawer.ariaLabel = 'Events';
    this.all.ariaLabel = 'All events';
    this.drawer.append(make('div', {className: 'head'}, make('h2', {textContent: 'Events'}), this.filter, button('CSV', () => this.save(), 'save what is shown'), button('Close', () => this.toggle(false))), this.all, this.extra);
  }

  get isOpen(): boolean {
    return !this.drawer.hidden;
  }

  put(entry: Entry): void {
    this.entries.unshift(entry);
    this.entries.length = Math.min(this.entries.length, most);
    this.list.prepend(row(entry));
    while (this.list.childElementCount > shown) this.list.lastElementChild!.remove();
    if (this.isOpen) this.fill();
  }

  clear(): void {
    this.entries.length = 0;
    this.list.replaceChildren();
    this.fill();
  }

  toggle(is = this.drawer.hidden): void {
    const hadFocus = this.drawer.contains(document.activeElement);
    this.drawer.hidden = !is;
    if (hadFocus && !is) this.opener.focus();
    if (is) this.fill();
    if (is) this.filter.focus();
  }

  private get chosen(): Entry[] {
    return this.entries.filter(({kind}) => this.filter.value === '' || kind === this.filter.value);
  }

  private fill(): void {
    this.all.replaceChildren(...this.chosen.map(row));
  }

  private save(): void {
    const rows = this.chosen.map(({time, clock, kind, text}) => [time.toFixed(3), clock, kind, quoted(text)].join(','));
    download('events.csv', ['time[s],clock,kind,text', ...rows.reverse(), ''].join('\n'), 'text/csv');
  }
}
