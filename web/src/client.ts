// The server's calls. At most one request is on its way; of those that wait only the newest is put.

export type Json = Record<string, any>;
export interface Shipped { name: string; title: string; kind: string; space: string }

export class Refused extends Error {
  constructor(readonly status: number, readonly answer: Json) {
    super(answer.error?.message ?? answer.errors?.[0]?.message ?? `the server answered ${status}`);
  }
}

async function call(path: string, body?: string, type = 'application/json'): Promise<string> {
  const reply = await fetch(path, body === undefined ? {} : {method: 'POST', body, headers: {'Content-Type': type}});
  const text = await reply.text();
  if (reply.ok) return text;
  let answer: Json = {};
  try {
    answer = JSON.parse(text);
  } catch {
    answer = {error: {message: text}};
  }
  throw new Refused(reply.status, answer);
}

export const version = async (): Promise<Json> => JSON.parse(await call('/api/version'));
export const robots = async (): Promise<{robots: Shipped[]; opened: {name: string; text: string} | null}> =>
  JSON.parse(await call('/api/robots'));
export const robotText = (name: string): Promise<string> => call(`/api/robots/${encodeURIComponent(name)}`);

/** A robot of the server; a server that was started anew gets its text again. */
export class Robot {
  private constructor(readonly text: string, private handle: string) {}

  static async open(text: string): Promise<Robot> {
    return new Robot(text, JSON.parse(await call('/api/robot', text, 'text/yaml')).robot);
  }

  async ask(queries: Json[]): Promise<Json[]> {
    const put = () => call(`/api/query?robot=${this.handle}`, JSON.stringify(queries));
    try {
      return JSON.parse(await put());
    } catch (error) {
      if (!(error instanceof Refused) || error.status !== 404) throw error;
      this.handle = JSON.parse(await call('/api/robot', this.text, 'text/yaml')).robot;
      return JSON.parse(await put());
    }
  }
}

/** Runs the newest of the tasks given to it, one at a time. */
export class Newest {
  private busy = false;
  private waiting: (() => Promise<void>) | null = null;

  put(task: () => Promise<void>): void {
    this.waiting = task;
    if (!this.busy) void this.run();
  }

  private async run(): Promise<void> {
    this.busy = true;
    while (this.waiting) {
      const task = this.waiting;
      this.waiting = null;
      await task();
    }
    this.busy = false;
  }
}
