// The bar of the simulated arm: what tendons have too much or lack, straight, and the command for the numbers.
import {copy} from '../clipboard';
import {button, make} from '../make';
import {signed} from './bars';
import type {PlanButtons} from './plan_buttons';
import type {System} from '../units';

const most = 1;  // mm of slack

export interface Wishes { straighten(): void; slacken(section: number, slack: number): void; command(): string }

export class SlidersBar {
  readonly element = make('div', {className: 'actions-of sliders'});
  private readonly slider = make('input', {type: 'range', min: String(-most), max: String(most), step: '0.01', value: '0', id: 'slack-of'});
  private readonly label = make('label', {htmlFor: 'slack-of'});
  private readonly text = make('output', {htmlFor: 'slack-of'} as object);
  private readonly command = make('code');
  private chosen = 0;

  constructor(plan: PlanButtons, wishes: Wishes) {
    const straight = button('Straighten', () => wishes.straighten(), 'all bends to zero, no slack'), zero = button('0', () => wishes.slacken(this.chosen, 0), 'neither slack nor tight');
    straight.classList.add('wide');
    zero.ariaLabel = 'no slack';
    this.slider.addEventListener('input', () => wishes.slacken(this.chosen, Number(this.slider.value) / 1e3));
    const copier = button('Copy', () => this.copy(wishes), 'copy the command (Ctrl+C)');
    this.element.append(straight, plan.pair, make('div', {className: 'speed'}, this.label, this.slider, this.text, zero), plan.follow.element, make('div', {className: 'as-command'}, make('span', {textContent: 'No device: the target acts at once'}), this.command, copier));
  }

  copy(wishes: Wishes): void {
    void copy(wishes.command(), 'command copied');
  }

  show(chosen: number, slack: number, command: string, system: System): void {
    this.chosen = chosen;
    const label = `Slack of S${chosen + 1}, all tendons`, said = signed(slack, system);
    if (this.label.textContent !== label) this.label.textContent = label;
    if (Math.abs(Number(this.slider.value) - 1e3 * slack) > 1e-9) this.slider.value = String(1e3 * slack);
    if (this.text.textContent !== said) this.text.textContent = said;
    this.slider.setAttribute('aria-valuetext', said);
    if (this.command.textContent !== command) this.command.textContent = command;
    this.command.title = command;
  }
}
