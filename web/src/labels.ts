// Words over a picture: letters of frames, numbers of legs, values of loads, what the pointer is on, the length of the bar.

interface Label { element: HTMLElement; point: number[]; isShown: boolean }

export class Labels {
  private readonly labels: Label[] = [];
  private used = 0;
  readonly bar = document.createElement('div');
  readonly tip = document.createElement('div');

  constructor(private readonly box: HTMLElement) {
    this.bar.className = 'scale-bar';
    this.tip.className = 'tip';
    this.tip.hidden = true;
    box.append(this.bar, this.tip);
  }

  begin(): void {
    this.used = 0;
  }

  /** @param kind a class of its own: `axis`, `leg`, `load`, `state` */
  put(text: string, point: number[], kind: string): void {
    let label = this.labels[this.used];
    if (!label) {
      label = {element: document.createElement('span'), point, isShown: true};
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
    this.labels.forEach((label, i) => { label.element.hidden = i >= this.used; });
  }

  /** @param project a point of the picture in pixels of the box */
  place(project: (point: number[]) => [number, number]): void {
    for (const {element, point} of this.labels.slice(0, this.used)) {
      const [x, y] = project(point);
      element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
    }
  }

  scale(pixels: number, text: string): void {
    this.bar.style.width = `${pixels.toFixed(2)}px`;
    if (this.bar.textContent !== text) this.bar.textContent = text;
  }

  point(text: string, x: number, y: number, isPinned: boolean): void {
    this.tip.hidden = text === '';
    this.tip.textContent = text;
    this.tip.classList.toggle('pinned', isPinned);
    this.tip.style.transform = `translate(${Math.min(x + 12, this.box.clientWidth - 180)}px, ${Math.max(4, y - 32)}px)`;
  }

  /** The words on a picture that is saved. */
  paint(context: CanvasRenderingContext2D, ratio: number, colour: string): void {
    const from = this.box.getBoundingClientRect();
    context.font = `${12 * ratio}px system-ui, sans-serif`;
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    context.fillStyle = context.strokeStyle = colour;
    for (const {element} of this.labels.slice(0, this.used)) {
      const at = element.getBoundingClientRect();
      context.fillText(element.textContent ?? '', (at.left + at.width / 2 - from.left) * ratio, (at.top + at.height / 2 - from.top) * ratio);
    }
    const bar = this.bar.getBoundingClientRect(), [x, y] = [(bar.left - from.left) * ratio, (bar.bottom - from.top) * ratio];
    context.lineWidth = 2 * ratio;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + bar.width * ratio, y);
    context.stroke();
    context.fillText(this.bar.textContent ?? '', x + (bar.width / 2) * ratio, y - 10 * ratio);
  }
}
