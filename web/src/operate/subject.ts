// What the screen Operate is about: an arm of sliders, or a device. The screen asks it for what is drawn and tells it what is wanted.
import type {Json, Robot} from '../client';
import type {Described} from '../described';
import type {Key} from '../keys';
import type {Source} from '../source';
import type {System} from '../units';
import type {Motion} from './control';
import type {Bend, Entry, Frame} from './frame';
import type {PlanWay, TipPlace} from './plan_way';
import type {Reading} from './readings';

export interface Opened { robot: Robot; described: Described; source: Source; inputs: number[] }

/** What a subject has of its screen. */
export interface Stand {
  system(): System;
  chosen(): number;
  changed(): void;                ///< draw it: soon, and once for all that has changed
  linked(): void;                 ///< the address is another one
  turned(): void;                 ///< so is the badge
  say(why: string): void;         ///< why something was refused, or did not go
  entry(entry: Entry): void;
  forgetEntries(): void;
  guarded(task: () => Promise<unknown>, again?: () => unknown): Promise<void>;
  heard(): void;
}

/** How far the arm is inserted, and its ghost [m]. */
export interface Stages { now: number; goal: number }

export interface Subject {
  readonly badge: string;
  readonly bar: HTMLElement;
  readonly tensionLimit: number;
  frame: Frame | null;
  shape: Json | null;
  ghost: Json | null;
  readonly tips: TipPlace[];      ///< of the plan that it has
  readonly stages: Stages | null; ///< null: it has none
  isStale: boolean;               ///< what is drawn is not as it is
  lost: string | null;            ///< why nothing is known of the arm; null: it is
  keys(): Key[];
  readings(): Reading[];
  targets(): Bend[];
  may(): boolean;                 ///< whether targets may be set; if not it says why
  aim(bends: Bend[]): void;
  load(way: PlanWay, place?: number): void;  ///< a plan to follow, from its first step or where a link was
  keyDown(key: string): boolean;  ///< of keys that act while they are down: whether it is one
  keyUp(key: string): void;
  motion(motion: Motion, isHeld: boolean): void;  ///< as its key does
  age(): string;                  ///< of what is drawn, where it is old
  show(): void;                   ///< its bar
  enter(): void;
  leave(): void;
  close(): void;                  ///< another robot comes
}
