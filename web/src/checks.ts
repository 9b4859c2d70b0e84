// The panel of a plan: its verdict, what was checked, where it is tight, and what is so at the step that is looked at.
import {withUnit} from './answer';
import {button, make} from './make';
import type {Plan} from './plan';
import type {Tips} from './poses';
import {format, type System, unitName} from './units';
import {VerdictBox, verdictOf, type Way} from './verdict';

interface Row { is: 'clear' | 'clear_if_taut' | 'touches' | 'checking'; name: string; value: string }

/** Of a run the step with the least clearance. */
function tightest({check}: Plan, {from, to}: {from: number; to: number}): number {
  let best = from;
  for (let step = from; step <= to; ++step) if (check!.steps[step]!.clearance < check!.steps[best]!.clearance) best = step;
  return best;
}

const named = ({from, to}: {from: number; to: number}) => (from === to ? `step ${from}` : `steps ${from} to ${to}`);

export class Checks {
  private readonly verdict: VerdictBox;
  private readonly list = make('ul', {className: 'checked'});
  private readonly spots = make('ol', {className: 'spots'});
  private readonly head = make('h2');
  private readonly here = make('dl', {className: 'facts'});
  private readonly title = make('h2', {textContent: 'Checks'});
  private readonly spotsHead = make('h2', {textContent: 'Tight spots'});
  private plan: Plan | null = null;

  /** @param go to a step */
  constructor(verdict: HTMLElement, panel: HTMLElement, private readonly go: (step: number) => void) {
    this.verdict = new VerdictBox(verdict, () => undefined);
    panel.append(this.title, this.list, this.spotsHead, this.spots, this.head, this.here);
  }

  /** Nothing to check. */
  none(message: string, ways: Way[]): void {
    this.plan = null;
    this.verdict.show({status: 'unknown_plan', message}, '', ways);
    for (const box of [this.list, this.spots, this.here]) box.replaceChildren();
  }

  show(plan: Plan, system: System, tip: Tips | null | undefined): void {
    const {check} = plan, length = (value: number) => withUnit(value, 'm', system), worst = check?.steps[check.worst];
    this.plan = plan;
    const limit = plan.steps.findIndex((step) => step.limit), touched = plan.failed.find(({isLimit}) => !isLimit);
    const message = plan.status === 'limit_exceeded' ? `step ${limit}: ${plan.steps[limit]!.limit}` : plan.status === 'touches' ? `${named(touched!)}: ${plan.pair(check!.steps[tightest(plan, touched!)]!)}` : '';
    this.verdict.show({status: plan.status, message}, check ? `${clearance(worst!.clearance, check.reach, system)} at step ${check.worst}, stage ${length(plan.steps[check.worst]!.stage)}, ${plan.pair(worst!)}` : '');
    this.list.replaceChildren(...this.rows(plan, system, tip).map(({is, name, value}) => {
      const {shape, state} = verdictOf({status: is}), mark = make('span', {className: `mark ${state}`, textContent: shape});
      mark.ariaHidden = 'true';
      return make('li', {}, mark, make('strong', {textContent: name}), make('span', {className: 'value', textContent: value}));
    }));
    this.title.hidden = !!plan.times;
    this.spotsHead.hidden = plan.spots.length === 0;
    this.spots.replaceChildren(...plan.spots.map((step) => {
      const at = check!.steps[step]!, {shape, state} = verdictOf({status: at.verdict === 'touches' ? 'touches' : at.clearance < plan.scene.margins.clearance ? 'clear_if_taut' : 'clear'});
      const spot = button('', () => this.go(step), plan.pair(at)), mark = make('span', {className: `mark ${state}`, textContent: shape});
      mark.ariaHidden = 'true';
      spot.dataset.step = String(step);
      spot.append(mark, make('strong', {textContent: clearance(at.clearance, check!.reach, system)}), make('span', {className: 'where', textContent: `step ${step}`}));
      return make('li', {}, spot);
    }));
  }

  /** @param tip where it is, once it is known */
  at(step: number, system: System, tip: Tips | null | undefined): void {
    if (!this.plan) return;
    const {plan} = this, {stage, limit} = plan.steps[step]!, checked = plan.check?.steps[step], facts: [string, string][] = [['stage', withUnit(stage, 'm', system)]];
    if (tip) facts.push(['tip x, y, z', `${tip.position.map((part) => format(part, 'm', system)).join(', ')} ${unitName('m', system)}`]);
    if (checked) facts.push(['clearance', clearance(checked.clearance, plan.check!.reach, system)], ['nearest', plan.pair(checked)], ['verdict', verdictOf({status: checked.verdict}).word]);
    if (tip?.changes) facts.push(['largest tendon change', largest(tip.changes, system)]);
    if (limit) facts.push(['limit exceeded', limit]);
    this.head.textContent = plan.times ? `At ${plan.times[step]!.toFixed(2)} s` : `At step ${step} of ${plan.last}`;
    this.here.replaceChildren(...facts.flatMap(([name, value]) => [make('dt', {textContent: name}), make('dd', {textContent: value})]));
    for (const spot of this.spots.querySelectorAll('button')) spot.setAttribute('aria-current', String(Number(spot.dataset.step) === step));
  }

  private rows(plan: Plan, system: System, tip: Tips | null | undefined): Row[] {
    const {check, steps, scene, failed} = plan, length = (value: number) => withUnit(value, 'm', system), rows: Row[] = [];
    if (plan.times) return rows;
    const touching = failed.filter(({isLimit}) => !isLimit), count = check?.steps.filter(({verdict}) => verdict === 'touches').length ?? 0, limits = steps.filter(({limit}) => limit).length;
    if (check) {
      const off = check.off.tendons + check.off.sag + check.off.model;
      rows.push({is: count > 0 ? 'touches' : 'clear', name: 'as planned', value: count > 0 ? `${touching.slice(0, 2).map(named).join(', ')}${touching.length > 2 ? ', …' : ''}` : `all ${steps.length} steps clear`});
      rows.push({is: count > 0 ? 'touches' : check.verdict === 'clear' ? 'clear' : 'clear_if_taut', name: 'slack, sag, model',
                 value: count > 0 ? 'not clear' : check.verdict === 'clear' ? `clear, tip off by ${length(off)}` : `clear with ${(100 * check.allowed_share).toFixed(1)} % of ${length(off)}`});
      rows.push({is: check.clearance >= scene.margins.clearance ? 'clear' : count > 0 ? 'touches' : 'clear_if_taut', name: 'clearance', value: `${clearance(check.clearance, check.reach, system)}, wanted ${length(scene.margins.clearance)}`});
    } else rows.push({is: 'checking', name: 'collision', value: 'being checked'});
    rows.push({is: limits > 0 ? 'touches' : 'clear', name: 'bends and stage', value: limits > 0 ? `limit exceeded in ${limits} ${limits === 1 ? 'step' : 'steps'}` : 'within their limits'});
    if (tip) {
      const off = Math.hypot(...tip.position.map((part, k) => part - scene.target.tip[k]));
      rows.push({is: off <= scene.target.tolerance ? 'clear' : 'clear_if_taut', name: 'target', value: `tip ends ${length(off)} from it`});
    }
    return rows;
  }
}

/** Beyond the reach of a check distances are not told apart. */
export const clearance = (value: number, reach: number, system: System) => `${value >= reach ? '≥ ' : ''}${withUnit(value, 'm', system)}`;

function largest(changes: number[][], system: System): string {
  let best = {section: 0, tendon: 0, value: 0};
  changes.forEach((of, section) => of.forEach((value, tendon) => { if (Math.abs(value) > Math.abs(best.value)) best = {section, tendon, value}; }));
  return `S${best.section + 1}.${best.tendon + 1} ${withUnit(best.value, 'm', system)}`;
}
