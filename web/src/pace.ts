// How soon a browser draws what it is asked to draw.

const patience = 2000;  // ms of slow drawing until details are left out
const slowest = 40;     // ms a picture: 25 a second
const pause = 250;      // ms without a picture after which drawing has begun anew
const least = 8;        // pictures: a tab that was hidden is not slow

export class Pace {
  private since = 0;
  private last = 0;
  private waited = 0;
  private count = 0;

  /** A picture is done. @param asked when it was asked for [ms] @return whether all of the last ones were slow */
  isSlow(asked: number, now: number): boolean {
    if (asked - this.last > pause) this.begin(asked);
    this.last = now;
    this.waited += now - asked;
    ++this.count;
    if (now - this.since < patience || this.count < least) return false;
    const isSlow = this.waited > slowest * this.count;
    this.begin(now);
    return isSlow;
  }

  private begin(at: number): void {
    [this.since, this.waited, this.count] = [at, 0, 0];
  }
}
