// What is open: a name, the text that the name stands for, and how the robot that is shown differs from it.
import {type Changed, type Json, Refused, Robot} from './client';
import type {Change} from './yaml';

/** Short and the same for the same text. */
export function hash(text: string): string {
  let sum = 0x811c9dc5;
  for (let i = 0; i < text.length; ++i) sum = Math.imul(sum ^ text.charCodeAt(i), 0x01000193);
  return (sum >>> 0).toString(36);
}

export class Source {
  /** @param changes of the file in the robot; null: more than `--set` can say */
  constructor(readonly name: string, readonly base: string, readonly text: string, private readonly changes: Change[] | null) {}

  /** Another robot than the name says. */
  get isModified(): boolean {
    return this.changes === null || this.changes.length > 0;
  }

  /** No command has this robot but with the text in a file. */
  get needsFile(): boolean {
    return this.changes === null;
  }

  get label(): string {
    return this.isModified ? `${this.name} (modified)` : this.name;
  }

  /** A name for files: where it is to be saved. */
  get stem(): string {
    return this.name.replace(/^.*\//, '').replace(/\.ya?ml$/, '') + (this.isModified ? '-modified' : '');
  }

  /** What a command calls it. */
  get word(): string {
    return this.needsFile ? `${this.stem}.yaml` : this.name;
  }

  get sets(): string[] {
    return (this.changes ?? []).map(([path, value]) => `${path}=${value}`);
  }

  /** The changes in a link. */
  toLink(link: URLSearchParams): void {
    for (const set of this.sets) link.append('set', set);
    if (this.needsFile) link.set('modified', hash(this.text));
  }

  /** By this a kept text and a link know each other. */
  get key(): string {
    const link = new URLSearchParams();
    this.toLink(link);
    return keyOf(link);
  }
}

export const keyOf = (link: URLSearchParams): string => (link.get('modified') ?? '') + link.getAll('set').join('\n');

const changeOf = (set: string): Change => {
  const at = set.indexOf('=');
  return [set.slice(0, at), set.slice(at + 1)];
};
export const changesIn = (link: URLSearchParams): Change[] => link.getAll('set').map(changeOf);

/** A value as a query has it. */
const valueOf = (text: string): string | number | boolean => (text === 'true' || text === 'false' ? text === 'true' : text.trim() !== '' && Number.isFinite(Number(text)) ? Number(text) : text);

/** Whether the changes of the file, as a command has them, give this robot: the server is asked. */
async function isSaid(base: string, changes: Change[], description: Json): Promise<boolean> {
  try {
    const robot = await Robot.open(base), [answer] = await robot.ask([{query: 'describe', set: Object.fromEntries(changes.map(([path, value]) => [path, valueOf(value)]))}]) as [Json];
    return JSON.stringify(answer) === JSON.stringify(description);
  } catch (error) {
    if (error instanceof Refused && !error.isBusy) return false;  // the file on disk is no robot
    throw error;
  }
}

/**
 * @param description of the robot that the text is of
 * @param changed what the server knows of changes of this file
 */
export async function sourceOf(name: string, base: string, text: string, description: Json, changed: Changed | null = null): Promise<Source> {
  if (text === base) return new Source(name, base, text, []);
  if (text === changed?.text) return new Source(name, base, text, changed.set.map(changeOf));
  const {changesOf} = await import('./editor.js'), changes = changesOf(base, text);
  return new Source(name, base, text, changes && (changes.length === 0 || await isSaid(base, changes, description)) ? changes : null);
}

/** An edited file that is kept in this browser. */
export interface Draft {
  base: string;   ///< the file as it was
  text: string;   ///< as it stands in the editor, errors and all
  shown: string;  ///< the last of its texts that was a robot
  key: string;    ///< of the link to that
}

const place = (name: string) => `sinew draft ${name}`;

/** Browsers may refuse to keep anything: then nothing is kept. */
export const drafts = {
  of(name: string): Draft | null {
    try {
      return JSON.parse(localStorage.getItem(place(name)) ?? 'null');
    } catch {
      return null;
    }
  },
  /** @return whether it is kept */
  keep(name: string, draft: Draft | null): boolean {
    try {
      if (draft) localStorage.setItem(place(name), JSON.stringify(draft));
      else localStorage.removeItem(place(name));
      return true;
    } catch {
      return false;
    }
  },
};
