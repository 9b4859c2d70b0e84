// Where a section has been in the last seconds.
import type {Bend} from './frame';

const kept = 5000;      // ms
const least = 1e-3;     // rad between two points

export class Trail {
  private readonly list: {at: number; bend: Bend}[] = [];

  put(bend: Bend, now: number): void {
    if (this.list.length > 0 && this.list.at(-1)!.at > now) this.clear();  // a recording was wound back
    const last = this.list.at(-1)?.bend;
    if (!last || Math.hypot(last[0] - bend[0], last[1] - bend[1]) > least) this.list.push({at: now, bend});
    while (this.list.length > 0 && this.list[0]!.at < now - kept) this.list.shift();
  }

  points(): Bend[] {
    return this.list.map(({bend}) => bend);
  }

  clear(): void {
    this.list.length = 0;
  }
}
