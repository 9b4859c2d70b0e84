// A camera at the arm's tip, one of this computer's. Its pictures go nowhere but beside the server's recording, those that are kept.
import {button, make} from '../make';
import {withText} from '../png';

const key = 'sinew-camera-turn';  // of this browser: how the camera sits in the arm
const step = 15;                  // degrees
const quality = 0.92;             // of a JPEG

const longest = 200;              // of what is written to a picture

export interface Keeper {
  words(): string;  ///< that go into a picture that is saved here
  keep(picture: Blob, words: string): Promise<string>;  ///< beside the recording; empty: nothing is recorded
  took(name: string, isKept: boolean): void;
}

export class Eye {
  private readonly video = make('video', {muted: true, playsInline: true, autoplay: true});
  private readonly arrow = make('div', {className: 'up-arrow', ariaHidden: 'true'});
  private readonly note = make('p', {className: 'eye-note'});
  private readonly start = button('Show the camera', () => void this.open());
  private readonly tools = make('div', {className: 'eye-tools', hidden: true});
  private readonly says = make('input', {placeholder: 'words to it', ariaLabel: 'words to a snapshot', maxLength: longest, autocomplete: 'off'});
  /** How far +β₂ is turned clockwise from up, in the picture [deg]. */
  turn = Number(localStorage.getItem(key)) || 0;

  /** @param found whether there is one */
  constructor(private readonly box: HTMLElement, private readonly found: (is: boolean) => void, private readonly keeper: Keeper) {
    const turning = (by: number) => button(by < 0 ? '↺' : '↻', () => this.by(by), 'turn the arrow to where +β₂ is in the picture');
    const [left, right] = [turning(-step), turning(step)], snapshot = button('Snapshot', () => void this.snapshot(), 'keep the picture, with time, set-points and robot in it (p)');
    left.ariaLabel = 'turn the arrow left';
    right.ariaLabel = 'turn the arrow right';
    snapshot.append(make('kbd', {textContent: 'P'}));
    this.tools.append(this.says, left, right, snapshot);
    this.video.ariaLabel = 'picture of the tip camera';
    this.note.setAttribute('role', 'status');
    box.append(this.video, make('div', {className: 'cross-hair', ariaHidden: 'true'}), this.arrow, make('h2', {textContent: 'Tip camera'}), this.note, this.start, this.tools);
    this.by(0);
    navigator.mediaDevices?.addEventListener('devicechange', () => void this.search());
  }

  /** Whether there is a camera at all; which one is asked for only by a click. */
  async search(): Promise<void> {
    const all = await navigator.mediaDevices?.enumerateDevices().catch(() => []) ?? [];
    this.found(all.some(({kind}) => kind === 'videoinput'));
  }

  async snapshot(): Promise<void> {
    const {videoWidth: width, videoHeight: height} = this.video;
    if (!width) return this.keeper.took('', false);
    const canvas = make('canvas', {width, height});
    canvas.getContext('2d')!.drawImage(this.video, 0, 0);
    const as = (type: string) => new Promise<Blob>((done) => canvas.toBlob((blob) => done(blob!), type, quality)), says = this.says.value.trim();
    const kept = await this.keeper.keep(await as('image/jpeg'), says);
    this.says.value = '';
    if (kept) return this.keeper.took(kept, true);
    const url = URL.createObjectURL(await withText(await as('image/png'), 'sinew', [says, this.keeper.words()].filter(Boolean).join('\n'))), name = `snapshot-${new Date().toISOString().slice(0, 19).replace(/[:T]/g, '-')}.png`;
    make('a', {href: url, download: name}).click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
    this.keeper.took(name, false);
  }

  close(): void {
    for (const track of (this.video.srcObject as MediaStream | null)?.getTracks() ?? []) track.stop();
    this.video.srcObject = null;
    this.tools.hidden = true;
    this.start.hidden = false;
    this.box.classList.remove('on');
  }

  private async open(): Promise<void> {
    try {
      this.video.srcObject = await navigator.mediaDevices.getUserMedia({video: true, audio: false});
      await this.video.play();
      this.note.textContent = '';
      this.box.classList.add('on');
      [this.tools.hidden, this.start.hidden] = [false, true];
    } catch (error) {
      this.note.textContent = error instanceof DOMException && error.name === 'NotAllowedError' ? 'the browser was not allowed to use a camera' : 'no picture comes from the camera';
    }
  }

  private by(degrees: number): void {
    this.turn = (this.turn + degrees + 360) % 360;
    if (degrees !== 0) localStorage.setItem(key, String(this.turn));
    this.arrow.style.transform = `rotate(${this.turn}deg)`;
    this.arrow.textContent = '↑ +β₂';
  }
}
