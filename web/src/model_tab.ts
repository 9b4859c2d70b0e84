// The model of the links, and how finely it is computed and drawn.
import type {Described} from './described';
import {make} from './make';
import type {State} from './state';

const meanings: Record<string, string> = {
  cc: 'constant curvature', prb: 'pseudo-rigid chains, which bear load', rod: 'elastic rods, which bear load', rigid: 'rigid links',
  pcc: 'piecewise constant curvature, exact', lsk: 'linearised, as controllers compute it',
};

const ofArms: Record<string, string> = {
  rod: 'one elastic rod a section, without its discs', subsegment_rod: 'elastic rods from disc to disc', subsegment_cc: 'an arc from disc to disc', cc: 'an arc a section',
  prb: 'joints with springs from disc to disc',
};

type Count = 'joints' | 'samples' | 'iterations';
const counts: {key: Count; name: string; least: number; most: number; hint: string}[] = [
  {key: 'joints', name: 'Joints of a chain', least: 1, most: 32, hint: 'as in the file'},
  {key: 'samples', name: 'Points of a curve', least: 2, most: 200, hint: 'as usual'},
  {key: 'iterations', name: 'Iterations at most', least: 1, most: 100_000, hint: 'as usual'},
];

export class ModelTab {
  private state: State | null = null;

  constructor(private readonly panel: HTMLElement, private readonly changed: (part: Partial<State>) => void) {}

  show(described: Described, state: State): void {
    this.state = state;
    const models = make('fieldset', {}, make('legend', {textContent: described.isArm ? 'Model of the backbone' : 'Model of the links'}), ...described.models.map((model) => this.model(model, described.isArm ? ofArms : meanings)));
    const rows = counts.filter(({key}) => key !== 'joints' || state.model === 'prb').map((count) => this.count(described.isArm && count.key === 'joints' ? {...count, name: 'Joints between two discs', most: 10} : count));
    this.panel.replaceChildren(models, make('h2', {textContent: 'Numbers'}), ...rows, ...(described.isArm ? [make('p', {className: 'note', textContent: 'Operate and Trajectory show serial robots that are given as bends; an arm that is pulled and loaded is shown here.'})] : []), this.facts(described));
  }

  private model(model: string, says: Record<string, string>): HTMLElement {
    const choice = make('input', {type: 'radio', name: 'model', value: model, checked: model === this.state!.model});
    choice.addEventListener('change', () => this.changed({model}));
    return make('label', {className: 'choice'}, choice, make('span', {}, make('strong', {textContent: model}), ` ${says[model] ?? ''}`));
  }

  private count({key, name, least, most, hint}: (typeof counts)[number]): HTMLElement {
    const value = this.state![key], box = make('input', {id: `model-${key}`, inputMode: 'numeric', value: value > 0 ? String(value) : '', placeholder: hint});
    const why = make('span', {className: 'why'});
    why.setAttribute('role', 'alert');
    box.addEventListener('change', () => {
      const text = box.value.trim(), number = text === '' ? 0 : Number(text), isGood = text === '' || (Number.isInteger(number) && number >= least && number <= most);
      box.setAttribute('aria-invalid', String(!isGood));
      why.textContent = isGood ? '' : `give a whole number from ${least} to ${most}, or nothing`;
      if (isGood) this.changed({[key]: number});
    });
    return make('div', {className: 'count'}, make('label', {htmlFor: box.id, textContent: name}), box, why);
  }

  private facts({answer}: Described): HTMLElement {
    const rows: [string, string][] = [['Geometry', answer.geometry === 'inferred' ? 'inferred from a paper' : 'given']];
    if (answer.tolerance !== undefined) rows.push(['Tolerance of tendons', `${(1000 * answer.tolerance).toPrecision(3)} mm`]);
    if (answer.versions) rows.push(['Computed by', `sinew ${answer.versions.sinew}`]);
    return make('dl', {className: 'facts'}, ...rows.flatMap(([name, value]) => [make('dt', {textContent: name}), make('dd', {textContent: value})]));
  }
}
