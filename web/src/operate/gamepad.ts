// A gamepad: its left stick moves the target of the chosen section, the right one that of the last, a shoulder button is Move.
import type {Bend} from './frame';

const [dead, fastest] = [0.15, (10 * Math.PI) / 180];  // of a stick; rad/s
const [hold, shoulder, left, right] = [1, 5, 14, 15];  // buttons of the standard layout

export interface Player {
  tilt(section: 'chosen' | 'last', by: Bend): void;
  choose(by: number): void;
  hold(): void;
  move(isHeld: boolean): void;
}

export class Gamepads {
  private readonly down = new Set<number>();
  private last = 0;
  private isOn = false;

  constructor(private readonly player: Player) {
    window.addEventListener('gamepadconnected', () => this.begin());
  }

  begin(): void {
    if (this.isOn || !this.pad) return;
    this.isOn = true;
    this.last = performance.now();
    requestAnimationFrame((now) => this.look(now));
  }

  end(): void {
    if (this.down.delete(shoulder)) this.player.move(false);
    this.isOn = false;
  }

  private get pad(): Gamepad | null {
    return [...navigator.getGamepads()].find((one) => one?.connected) ?? null;
  }

  private look(now: number): void {
    const {pad} = this, seconds = Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    if (!pad || !this.isOn) return this.end();
    this.edge(pad, hold, () => this.player.hold());
    this.edge(pad, left, () => this.player.choose(-1));
    this.edge(pad, right, () => this.player.choose(1));
    this.edge(pad, shoulder, () => this.player.move(true), () => this.player.move(false));
    this.stick(pad, 0, 'chosen', seconds);
    this.stick(pad, 2, 'last', seconds);
    requestAnimationFrame((next) => this.look(next));
  }

  private edge(pad: Gamepad, button: number, pressed: () => void, released: () => void = () => undefined): void {
    const is = pad.buttons[button]?.pressed ?? false, was = this.down.has(button);
    if (is === was) return;
    if (is) this.down.add(button);
    else this.down.delete(button);
    (is ? pressed : released)();
  }

  private stick(pad: Gamepad, axis: number, section: 'chosen' | 'last', seconds: number): void {
    const [x, y] = [pad.axes[axis] ?? 0, -(pad.axes[axis + 1] ?? 0)];
    if (Math.hypot(x, y) > dead) this.player.tilt(section, [x * fastest * seconds, y * fastest * seconds]);
  }
}
