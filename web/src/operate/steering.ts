// How the last section has to bend so that the tip turns to a side of its own: the server's answer for where the target is.
import {type Json, Newest} from '../client';
import {configurationOf} from './simulated';
import type {Bend} from './frame';
import type {Opened} from './subject';

export class Steering {
  private readonly newest = new Newest();
  private asked = '';
  private matrix: number[][] | null = null;
  isNone = false;  ///< no bend turns it to every side

  constructor(private readonly guarded: (task: () => Promise<unknown>) => Promise<void>) {}

  /** The newest that is known; of another target, the one before, until the answer comes. */
  at({robot, described, inputs}: Opened, targets: Bend[]): number[][] | null {
    const configuration = configurationOf(described, targets, inputs), asked = `${robot.handle} ${JSON.stringify(configuration)}`;
    if (asked !== this.asked) this.newest.put(() => this.guarded(async () => {
      const [answer] = await robot.ask([{query: 'velocity', configuration}]) as [Json];
      if (asked !== this.asked) return;
      this.matrix = answer.steering ?? null;
      this.isNone = !this.matrix;
    }));
    this.asked = asked;
    return this.matrix;
  }

  forget(): void {
    [this.asked, this.matrix, this.isNone] = ['', null, false];
  }
}
