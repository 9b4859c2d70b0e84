// Recordings that the server has, and the dialog in which one is chosen.
import {type Json, Lost, Refused} from '../client';
import {button, make} from '../make';
import {kindOf} from './frame';
import {icon} from './mark';

const most = 20_000;  // rows that are asked for; of more one in so many
const usual = 700;    // bytes of a row, where nobody has counted them

async function get(path: string): Promise<Response> {
  let reply: Response;
  try {
    reply = await fetch(path);
  } catch {
    throw new Lost('no connection');
  }
  if (reply.ok) return reply;
  const text = await reply.text();
  throw new Refused(reply.status, text.startsWith('{') ? JSON.parse(text) : {});
}

/** Null: an older server, which has none. */
export async function listRecordings(): Promise<Json[] | null> {
  const reply = await fetch('/api/recordings').catch(() => null);
  return reply?.ok ? (await reply.json()).recordings ?? null : null;
}

const path = (name: string) => `/api/recordings/${encodeURIComponent(name)}`;

/** Its text, and one row in how many that is. */
export async function recordingText(name: string): Promise<{text: string; every: number}> {
  const known = (await listRecordings())?.find((one) => one.name === name), rows = known?.rows ?? (known?.bytes ?? 0) / usual, every = Math.max(1, Math.ceil(rows / most));
  return {text: await (await get(path(name) + (every > 1 ? `?every=${every}` : ''))).text(), every};
}

export const pictureOf = (name: string, number: string): string => `${path(name)}/snapshots/${number}`;
export const picture = async (name: string, number: string): Promise<Blob> => (await get(pictureOf(name, number))).blob();

const lasted = (seconds: number | null) => (seconds === null ? '…' : seconds < 100 ? `${seconds.toFixed(1)} s` : `${(seconds / 60).toFixed(1)} min`);

export class RecordingsDialog {
  private readonly dialog = make('dialog', {className: 'recordings-dialog'});

  /** @param chosen by its name @param file one of this computer is to be opened */
  constructor(private readonly chosen: (name: string) => void, private readonly file: () => void) {
    this.dialog.ariaLabel = 'Recordings';
    document.body.append(this.dialog);
  }

  show(list: Json[]): void {
    const rows = list.map((one) => {
      const worst = make('span', {className: 'worst'}, ...(one.worst ? [icon(kindOf(one.worst), 16), one.worst] : ['–']));
      const open = make('button', {type: 'button'}, make('strong', {textContent: one.robot}), make('span', {textContent: String(one.start).slice(0, 19).replace('T', ' ')}), make('span', {textContent: lasted(one.duration)}), worst);
      open.title = `${one.name}: ${one.rows ?? '…'} rows, ${one.snapshots ?? '…'} snapshots, table ${one.table}`;
      open.addEventListener('click', () => {
        this.dialog.close();
        this.chosen(one.name);
      });
      return make('li', {}, open);
    });
    const empty = list.length > 0 ? [] : [make('p', {textContent: 'There is none yet: one begins when a device is armed.'})];
    this.dialog.replaceChildren(make('h2', {textContent: 'Recordings'}), ...empty, make('ol', {}, ...rows),
      make('div', {className: 'ends'}, button('A file of this computer…', () => { this.dialog.close(); this.file(); }), button('Close', () => this.dialog.close())));
    this.dialog.showModal();
  }

  /** A file that cannot be replayed. */
  refuse(why: string): void {
    this.dialog.replaceChildren(make('h2', {textContent: 'This cannot be replayed'}), make('p', {className: 'why', textContent: why}), make('div', {className: 'ends'}, button('Close', () => this.dialog.close())));
    if (!this.dialog.open) this.dialog.showModal();
  }
}
