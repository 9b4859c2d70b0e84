// What the colours of tendons mean: a bar from nothing to the end of the scale, and what is dashed.
import {make} from './make';
import type {Pulls} from './picture';
import {isSlack} from './tendon_lines';

const stops = ['--pull-0', '--pull-1', '--pull-2', '--pull-3'];

export class PullScale {
  private readonly ramp = make('span', {className: 'ramp'});
  private readonly most = make('span');
  private readonly loose = make('span', {className: 'loose', textContent: 'slack'});
  private readonly title = make('span', {textContent: 'Tension'});
  private readonly low = make('span', {textContent: '0'});
  private readonly box = make('div', {className: 'pulls', hidden: true, ariaHidden: 'true'}, this.title, this.ramp, make('span', {className: 'ends'}, this.low, this.most), this.loose);

  constructor(picture: HTMLElement) {
    picture.append(this.box);
  }

  /** @param pulls null: no tendon is drawn by what it pulls */
  show(pulls: Pulls | null): void {
    this.box.hidden = !pulls;
    if (!pulls) return;
    this.most.textContent = `${Number(pulls.most.toPrecision(3))} N`;
    this.loose.hidden = !pulls.tensions.flat().some((one) => isSlack(one, pulls));
  }

  /** On a picture that is saved, in pixels of the window. */
  paint(context: CanvasRenderingContext2D): void {
    if (this.box.hidden) return;
    const colours = getComputedStyle(document.documentElement), style = getComputedStyle(this.box), {left, top, width, height} = this.ramp.getBoundingClientRect(), shade = context.createLinearGradient(left, 0, left + width, 0);
    stops.forEach((name, i) => shade.addColorStop(i / (stops.length - 1), colours.getPropertyValue(name).trim()));
    context.fillStyle = shade;
    context.fillRect(left, top, width, height);
    context.textAlign = 'left';
    context.font = `${style.fontSize} ${style.fontFamily}`;
    context.fillStyle = style.color;
    for (const word of [this.title, this.low, this.most, ...(this.loose.hidden ? [] : [this.loose])]) {
      const at = word.getBoundingClientRect(), text = word.textContent ?? '';
      const isLeft = word === this.title || word === this.low;  // what is dashed has its dashes before it
      context.fillText(text, isLeft ? at.left : at.right - context.measureText(text).width, at.top + at.height / 2);
    }
    if (this.loose.hidden) return;
    const at = this.loose.getBoundingClientRect();
    context.strokeStyle = style.color;
    context.setLineDash([3, 3]);
    context.beginPath();
    context.moveTo(at.left, at.top + at.height / 2);
    context.lineTo(at.left + 24, at.top + at.height / 2);
    context.stroke();
    context.setLineDash([]);
  }
}
