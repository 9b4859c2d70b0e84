// Whether the server is there. While it is not, the page says since when, and asks again, less and less often.
import {version} from './client';
import {byId} from './make';

const pauses = [500, 1000, 2000, 5000];  // ms

export class Connection {
  private lostAt = 0;
  private tries = 0;
  private clock = 0;
  private again: () => void = () => undefined;

  /** @param again what is done once it is back; of several the last */
  lost(again: () => void): void {
    this.again = again;
    if (this.lostAt !== 0) return;
    this.lostAt = performance.now();
    document.body.classList.add('lost');
    byId('lost').hidden = false;
    this.clock = window.setInterval(() => this.tell(), 1000);
    this.tell();
    this.tryLater();
  }

  private tell(): void {
    byId('since').textContent = `${((performance.now() - this.lostAt) / 1000).toFixed(0)} s`;
  }

  private tryLater(): void {
    setTimeout(() => void this.try(), pauses[Math.min(this.tries++, pauses.length - 1)]);
  }

  private async try(): Promise<void> {
    try {
      await version();
    } catch {
      return this.tryLater();
    }
    clearInterval(this.clock);
    this.lostAt = 0;
    document.body.classList.remove('lost');
    byId('lost').hidden = true;
    this.again();
  }

  /** It answers what is asked, not only that it is there: the next loss is a new one. */
  answered(): void {
    this.tries = 0;
  }
}
