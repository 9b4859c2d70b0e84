// The calls of a device, and what it tells: frames, of which the newest counts, and its log.
import {type Json, Lost, Refused} from '../client';
import type {DeviceInfo, Entry, Frame} from './frame';

async function send(path: string, options: RequestInit): Promise<any> {
  let reply: Response;
  try {
    reply = await fetch(`/api/device/${path}`, {method: 'POST', ...options});
  } catch (error) {
    if (error instanceof TypeError) throw new Lost('no connection');
    throw error;
  }
  const text = await reply.text(), json = text.startsWith('{') ? JSON.parse(text) : {};
  if (!reply.ok) throw new Refused(reply.status, json);
  return json;
}

/** Beside the recording. @return the name of its file */
export const keepPicture = async (picture: Blob, words: string): Promise<string> => (await send(`snapshot?text=${encodeURIComponent(words)}`, {body: picture, headers: {'Content-Type': picture.type}})).name;

/** @param isLast sent even where the page is being closed */
const post = (call: string, body: object, signal?: AbortSignal, isLast = false): Promise<any> =>
  send(call, {body: JSON.stringify(body), headers: {'Content-Type': 'application/json'}, keepalive: isLast, ...(signal && {signal})});

/** What the server has at its other end; null where there is nothing, or an older server. */
export async function findDevice(): Promise<DeviceInfo | null> {
  const reply = await fetch('/api/device').catch(() => null);
  return reply?.ok ? (await reply.json()).device ?? null : null;
}

export interface Listener { frame(frame: Frame): void; entry(entry: Entry): void; again(): void; broken(): void }

export class Device {
  private events: EventSource | null = null;

  constructor(readonly info: DeviceInfo, private readonly listener: Listener) {}

  /** A feed that breaks is opened again by the browser. */
  listen(): void {
    if (this.events) return;
    const events = this.events = new EventSource('/api/device/events');
    events.addEventListener('open', () => this.listener.again());  // it begins with the last entries of its log
    events.addEventListener('frame', (event) => this.listener.frame(JSON.parse(event.data)));
    events.addEventListener('log', (event) => this.listener.entry(JSON.parse(event.data)));
    events.addEventListener('error', () => {
      this.listener.broken();
      if (events.readyState !== EventSource.CLOSED) return;
      this.deafen();
      setTimeout(() => this.listen(), 1000);  // a server that ended it for good
    });
  }

  deafen(): void {
    this.events?.close();
    this.events = null;
  }

  /** The plan that it has, as it was loaded. */
  async plan(): Promise<Json> {
    const reply = await fetch('/api/device/plan').catch(() => null);
    if (!reply) throw new Lost('no connection');
    return reply.ok ? reply.json() : {plan: null};
  }

  call(name: string, body: object = {}, signal?: AbortSignal, isLast = false): Promise<any> {
    return post(name, body, signal, isLast);
  }
}
