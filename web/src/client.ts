// The server's calls. At most one request is on its way; of those that wait only the newest is put.

export type Json = Record<string, any>;
export interface Shipped { name: string; title: string; kind: string; space: string }

export class Refused extends Error {
  /** @param wait what the server says to wait before the next try [s] */
  constructor(readonly status: number, readonly answer: Json, readonly wait = 0) {
    super(answer.error?.message ?? answer.errors?.[0]?.message ?? `the server answered ${status}`);
  }

  /** Too much at once: the same question may be answered later. */
  get isBusy(): boolean {
    return this.status === 429 || this.status === 503;
  }
}

/** Nobody answers. */
export class Lost extends Error {}

const breath = 150;  // ms before a second try

/** A server may close a connection that it kept open, or that a question held too long: one more try tells this from one that is gone. */
async function reach<T>(path: string, options: RequestInit, reading: (reply: Response) => Promise<T>): Promise<{reply: Response; read: T}> {
  for (let isFirst = true;; isFirst = false) {
    try {
      const reply = await fetch(path, options);
      return {reply, read: await reading(reply)};
    } catch (error) {
      if (!(error instanceof TypeError)) throw error;  // so fetch says that nobody answered
      if (!isFirst) throw new Lost('no connection');
      await new Promise((done) => setTimeout(done, breath));
    }
  }
}

async function call(path: string, body?: string, type = 'application/json', signal?: AbortSignal): Promise<string> {
  const {reply, read} = await reach(path, body === undefined ? {} : {method: 'POST', body, headers: {'Content-Type': type}, ...(signal && {signal})}, (of) => of.text());
  if (reply.ok) return read;
  throw refusal(reply, read);
}

function refusal(reply: Response, text: string): Refused {
  let answer: Json = {};
  try {
    answer = JSON.parse(text);
  } catch {
    answer = {error: {message: text}};
  }
  return new Refused(reply.status, answer, Number(reply.headers.get('Retry-After')) || 0);
}

export const version = async (): Promise<Json> => JSON.parse(await call('/api/version'));
/** How the command line of the server changes the file: the text of that, and its `--set`. */
export interface Changed { text: string; set: string[] }
/** The file that the server was started with. */
export interface Opened { name: string; text: string; changed?: Changed }
export const robots = async (): Promise<{robots: Shipped[]; opened: Opened | null}> => JSON.parse(await call('/api/robots'));
export const robotText = (name: string): Promise<string> => call(`/api/robots/${encodeURIComponent(name)}`);

export const plans = async (): Promise<{plans: Json[]}> => JSON.parse(await call('/api/plans'));
export const plan = async (handle: string): Promise<Json> => JSON.parse(await call(`/api/plans/${encodeURIComponent(handle)}`));

/** The solids of a plan's scene: corners, then triangles. */
export async function meshes(handle: string): Promise<ArrayBuffer> {
  const {reply, read} = await reach(`/api/plans/${encodeURIComponent(handle)}/meshes`, {}, (of) => of.arrayBuffer());
  if (!reply.ok) throw refusal(reply, new TextDecoder().decode(read));
  return read;
}

/** A robot of the server; a server that was started anew gets its text again. */
export class Robot {
  private waiting = new AbortController();

  private constructor(readonly text: string, public handle: string) {}

  static async open(text: string): Promise<Robot> {
    return new Robot(text, JSON.parse(await call('/api/robot', text, 'text/yaml')).robot);
  }

  /** What is on its way is waited for no more: it ends as an AbortError. */
  cancel(): void {
    this.waiting.abort();
    this.waiting = new AbortController();
  }

  async ask(queries: Json[]): Promise<Json[]> {
    return this.known((robot) => call(`/api/query?robot=${robot}`, JSON.stringify(queries), 'application/json', this.waiting.signal));
  }

  /** As `ask`, of what takes long: it keeps no other question waiting, and the server stops where `signal` says so. */
  async work(queries: Json[], signal: AbortSignal): Promise<Json[]> {
    const {job} = await this.known((robot) => call('/api/jobs', JSON.stringify({robot, queries})));
    const end = () => {
      void fetch(`/api/jobs/${job}`, {method: 'DELETE'}).catch(() => undefined);  // nobody listens: it ends by itself
      return new DOMException('cancelled', 'AbortError');
    };
    if (signal.aborted) throw end();  // while the job was made
    const events = new EventSource(`/api/jobs/${job}/events`), answers: Json[] = [];
    return new Promise<Json[]>((done, failed) => {
      signal.addEventListener('abort', () => failed(end()));
      events.addEventListener('error', () => events.readyState === EventSource.CLOSED && failed(new Lost('no connection')));
      events.addEventListener('answers', (event) => {
        const {first, answers: some} = JSON.parse(event.data);
        some.forEach((one: Json, i: number) => { answers[first + i] = one; });
      });
      events.addEventListener('done', () => done(answers));
      events.addEventListener('cancelled', () => failed(new DOMException('cancelled', 'AbortError')));
      events.addEventListener('failed', (event) => failed(new Refused(500, JSON.parse(event.data))));
    }).finally(() => events.close());
  }

  /** A server that was started anew does not know the robot. */
  private async known(put: (handle: string) => Promise<string>): Promise<any> {
    try {
      return JSON.parse(await put(this.handle));
    } catch (error) {
      if (!(error instanceof Refused) || error.status !== 404) throw error;
      this.handle = JSON.parse(await call('/api/robot', this.text, 'text/yaml')).robot;
      return JSON.parse(await put(this.handle));
    }
  }
}

/** Runs the newest of the tasks given to it, one at a time. */
export class Newest {
  private busy = false;
  private waiting: (() => Promise<void>) | null = null;

  get isBusy(): boolean {
    return this.busy;
  }

  put(task: () => Promise<void>): void {
    this.waiting = task;
    if (!this.busy) void this.run();
  }

  /** What waits is not done. */
  drop(): void {
    this.waiting = null;
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
