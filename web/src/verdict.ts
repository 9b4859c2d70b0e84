// The right panel: a word with a shape, and the numbers of an answer.
import type {Json} from './client';
import {format, type System, type Unit, unitName} from './units';

interface Verdict { word: string; shape: string; state: string }

const verdicts: Record<string, Verdict> = {
  converged: {word: 'SOLVED', shape: '●', state: 'exact'},
  unstable: {word: 'SOLVED, UNSTABLE', shape: '▼', state: 'slack'},
  singular: {word: 'SINGULAR', shape: '▼', state: 'slack'},
  slack: {word: 'SLACK TENDON', shape: '▼', state: 'slack'},
  unreachable: {word: 'UNREACHABLE', shape: '▧', state: 'unreachable'},
  left_domain: {word: 'UNREACHABLE', shape: '▧', state: 'unreachable'},
  stalled: {word: 'STALLED', shape: '⊗', state: 'over'},
  iteration_limit: {word: 'LIMIT REACHED', shape: '⊗', state: 'over'},
};

function verdictOf(answer: Json): Verdict {
  if (answer.error) return {word: 'REFUSED', shape: '⊗', state: 'over'};
  const found = verdicts[answer.status] ?? {word: String(answer.status).toUpperCase(), shape: '⊗', state: 'over'};
  return answer.status === 'converged' && answer.stable === true ? {...found, word: 'SOLVED, STABLE'} : found;
}

/** `x 1.234 mm` for each coordinate of a pose, planar or in space. */
export function poseLines(pose: Json, system: System): [string, string][] {
  const line = (name: string, value: number, unit: Unit): [string, string] =>
    [name, `${format(value, unit, system)} ${unitName(unit, system)}`.trim()];
  if (pose.position) {
    const [x, y, z] = pose.position, names = ['w', 'x', 'y', 'z'];
    return [line('x', x, 'm'), line('y', y, 'm'), line('z', z, 'm'),
            ...(pose.quaternion as number[]).map((q, i) => line(`q ${names[i]}`, q, ''))];
  }
  return [line('x', pose.x, 'm'), line('y', pose.y, 'm'), line('φ', pose.phi, 'rad')];
}

/** How far to what would end the motion; numbers without units. */
function marginLines(answer: Json): [string, string][] {
  const {margins, velocity} = answer, lines: [string, string][] = [];
  if (margins?.fold !== undefined) lines.push(['to a fold', margins.fold.toFixed(4)]);
  if (margins?.strain !== undefined) lines.push(['bending strain', `${(100 * margins.strain).toFixed(3)} %`]);
  const condition = velocity?.indices?.condition_homogenised;
  if (condition !== undefined) lines.push(['condition number', condition.toFixed(2)]);
  if (velocity?.type_1?.length > 0) lines.push(['type I', `legs ${velocity.type_1.join(', ')}`]);
  if (velocity?.type_2) lines.push(['type II', velocity.type_2.singular ? `singular, ${velocity.type_2.class}` : 'no']);
  return lines;
}

export class Panel {
  constructor(private readonly box: HTMLElement) {}

  show(answer: Json, system: System): void {
    const {word, shape, state} = verdictOf(answer);
    const verdict = document.createElement('div'), mark = document.createElement('span'), text = document.createElement('strong');
    verdict.className = 'verdict';
    verdict.setAttribute('role', 'status');
    mark.className = `mark ${state}`;
    mark.textContent = shape;
    mark.ariaHidden = 'true';
    text.textContent = word;
    verdict.append(mark, text);
    const why = document.createElement('p');
    why.textContent = answer.error?.message ?? answer.message ?? '';
    const rows: [string, string][] = [];
    const pose = answer.pose ?? answer.tip;
    if (pose && !answer.error) rows.push(...poseLines(pose, system));
    if (answer.residual !== undefined) rows.push(['residual', answer.residual.toExponential(1)]);
    if (answer.iterations !== undefined) rows.push(['iterations', String(answer.iterations)]);
    this.box.replaceChildren(verdict, why, ...this.tables(rows, answer, system));
  }

  private tables(rows: [string, string][], answer: Json, system: System): HTMLElement[] {
    const tables = [this.table(answer.tip ? 'Tip' : 'Pose', rows)];
    if (answer.changes) {
      const lines = (answer.changes as number[][]).map((changes, m): [string, string] =>
        [`section ${m + 1}`, changes.map((change) => format(change, 'm', system)).join('  ')]);
      tables.push(this.table(`Tendon changes [${unitName('m', system)}]`, lines));
    }
    const margins = marginLines(answer);
    if (margins.length > 0) tables.push(this.table('Margins', margins));
    return tables;
  }

  private table(title: string, rows: [string, string][]): HTMLElement {
    const table = document.createElement('table'), caption = table.createCaption();
    caption.textContent = title;
    for (const [name, value] of rows) {
      const row = table.insertRow(), head = document.createElement('th');
      head.scope = 'row';
      head.textContent = name;
      row.append(head);
      row.insertCell().textContent = value;
    }
    return table;
  }
}
