// A gamepad: its left stick jogs the chosen section, the right one the tip; a shoulder button is Move while it is down.
import type {Motion} from './control';
import type {Jog, JogFrame} from './jog';

const dead = 0.15;  // of a stick
const [hold, shoulder, up, down, left, right] = [1, 5, 12, 13, 14, 15];  // buttons of the standard layout
const held: [button: number, motion: Motion][] = [[shoulder, 'move'], [up, 'advance'], [down, 'retract']];
const sticks: [axis: number, frame: JogFrame][] = [[0, 'section'], [2, 'tip']];

export interface Player {
  choose(by: number): void;
  hold(): void;
  motion(motion: Motion, isHeld: boolean): void;
}

export class Gamepads {
  private readonly down = new Set<number>();
  private isOn = false;

  constructor(private readonly player: Player, private readonly jog: Jog) {
    window.addEventListener('gamepadconnected', () => this.begin());
  }

  begin(): void {
    if (this.isOn || !this.pad) return;
    this.isOn = true;
    requestAnimationFrame(() => this.look());
  }

  end(): void {
    for (const [button, motion] of held) if (this.down.delete(button)) this.player.motion(motion, false);
    for (const [, frame] of sticks) this.jog.push(`stick ${frame}`, frame, null);
    this.isOn = false;
  }

  /** A browser shows one only when a button of it has been pressed. */
  get isThere(): boolean {
    return this.pad !== null;
  }

  private get pad(): Gamepad | null {
    return [...navigator.getGamepads()].find((one) => one?.connected) ?? null;
  }

  private look(): void {
    const {pad} = this;
    if (!pad || !this.isOn) return this.end();
    this.edge(pad, hold, (is) => is && this.player.hold());
    this.edge(pad, left, (is) => is && this.player.choose(-1));
    this.edge(pad, right, (is) => is && this.player.choose(1));
    for (const [button, motion] of held) this.edge(pad, button, (is) => this.player.motion(motion, is));
    for (const [axis, frame] of sticks) this.stick(pad, axis, frame);
    requestAnimationFrame(() => this.look());
  }

  private edge(pad: Gamepad, button: number, turned: (is: boolean) => void): void {
    const is = pad.buttons[button]?.pressed ?? false;
    if (is === this.down.has(button)) return;
    if (is) this.down.add(button);
    else this.down.delete(button);
    turned(is);
  }

  private stick(pad: Gamepad, axis: number, frame: JogFrame): void {
    const [x, y] = [pad.axes[axis] ?? 0, -(pad.axes[axis + 1] ?? 0)];
    this.jog.push(`stick ${frame}`, frame, Math.hypot(x, y) > dead ? [x, y] : null);
  }
}
