// Words over a picture: letters of frames, numbers of legs, values of loads, what the pointer is on, the length of the bar.
import {PullScale} from './pull_scale';
import type {Point} from './vector';

interface Label { element: HTMLElement; point: Point }

export class Labels {
  private readonly labels: Label[] = [];
  private used = 0;
  readonly pulls: PullScale;
  private readonly bar = document.createElement('div');
  private readonly tip = document.createElement('div');

  constructor(private readonly box: HTMLElement) {
    this.bar.className = 'scale-bar';
    this.tip.className = 'tip';
    this.tip.hidden = true;
    this.pulls = new PullScale(box);
    box.append(this.bar, this.tip);
  }

  begin(): void {
    this.used = 0;
  }

  /** @param kind classes of its own: `axis`, `leg`, `load`, `state`, `stale` */
  put(text: string, point: Point, kind: string): void {
    let label = this.labels[this.used];
    if (!label) {
      label = {element: document.createElement('span'), point};
      label.element.ariaHidden = 'true';
      this.box.append(label.element);
      this.labels.push(label);
    }
    label.point = point;
    if (label.element.className !== `label ${kind}`) label.element.className = `label ${kind}`;
    if (label.element.textContent !== text) label.element.textContent = text;
    ++this.used;
  }

  end(): void {
    this.labels.forEach(({element}, i) => { if (element.hidden !== i >= this.used) element.hidden = i >= this.used; });
  }

  /** @param project a point of the picture in pixels of the box */
  place(project: (point: Point) => [number, number]): void {
    for (let i = 0; i < this.used; ++i) {
      const {element, point} = this.labels[i]!, [x, y] = project(point);
      element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
    }
  }

  scale(pixels: number, text: string): void {
    this.bar.style.width = `${pixels.toFixed(2)}px`;
    if (this.bar.textContent !== text) this.bar.textContent = text;
  }

  /** What the pointer is on, beside it and inside the box. An empty text is none. */
  point(text: string, x: number, y: number, isPinned: boolean): void {
    if (this.tip.hidden !== (text === '')) this.tip.hidden = text === '';
    if (text === '') return;
    if (this.tip.textContent !== text) this.tip.textContent = text;
    this.tip.classList.toggle('pinned', isPinned);
    const right = this.box.clientWidth - this.tip.offsetWidth - 4, low = this.box.clientHeight - this.tip.offsetHeight - 4;
    this.tip.style.transform = `translate(${Math.max(4, Math.min(x + 12, right)).toFixed(1)}px, ${Math.max(4, Math.min(y - 32, low)).toFixed(1)}px)`;
  }

  /** The words on a picture that is saved, as they look in the page. */
  paint(context: CanvasRenderingContext2D, ratio: number): void {
    const from = this.box.getBoundingClientRect();
    context.save();
    context.scale(ratio, ratio);
    context.translate(-from.left, -from.top);
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    const word = (element: HTMLElement) => {
      const at = element.getBoundingClientRect(), style = getComputedStyle(element);
      if (style.borderTopWidth !== '0px') {
        context.fillStyle = style.backgroundColor;
        context.fillRect(at.left, at.top, at.width, at.height);
      }
      context.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
      context.fillStyle = style.color;
      context.fillText(element.textContent ?? '', at.left + at.width / 2, at.top + at.height / 2);
    };
    for (const {element} of this.labels.slice(0, this.used)) word(element);
    if (!this.tip.hidden) word(this.tip);
    const bar = this.bar.getBoundingClientRect(), style = getComputedStyle(this.bar);
    context.textAlign = 'left';
    context.font = `${style.fontSize} ${style.fontFamily}`;
    context.fillStyle = style.color;
    context.fillText(this.bar.textContent ?? '', bar.left, bar.top + bar.height / 2 - 1);
    context.fillRect(bar.left, bar.bottom - 2, bar.width, 2);
    this.pulls.paint(context);
    context.restore();
  }
}
