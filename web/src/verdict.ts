// The word of an answer, with its shape and what to try.
import type {Json} from './client';
import {button} from './make';

export type Way = [text: string, go: () => void];
export interface Verdict { word: string; shape: string; state: string; advice: string }

const verdicts: Record<string, Verdict> = {
  converged: {word: 'SOLVED', shape: '●', state: 'exact', advice: ''},
  unstable: {word: 'SOLVED, UNSTABLE', shape: '▼', state: 'slack', advice: 'It does not stay here by itself. Lower the load, or look at other solutions.'},
  singular: {word: 'SINGULAR', shape: '▼', state: 'slack', advice: 'Step back, or change another input first.'},
  slack: {word: 'SLACK TENDON', shape: '▼', state: 'slack', advice: 'A tendon cannot push: bend this leg more, or lower the load.'},
  unreachable: {word: 'UNREACHABLE', shape: '▧', state: 'unreachable', advice: 'It does not reach so far: go back towards the last pose that was solved.'},
  left_domain: {word: 'UNREACHABLE', shape: '▧', state: 'unreachable', advice: 'Go back within the limits.'},
  stalled: {word: 'STALLED', shape: '⊗', state: 'over', advice: 'Begin at Home and take smaller steps.'},
  iteration_limit: {word: 'LIMIT REACHED', shape: '⊗', state: 'over', advice: 'Raise the limit of iterations under Model.'},
  stopped: {word: 'STOPPED', shape: '■', state: 'stale', advice: 'It was ended before it was solved. Ask again, or take a smaller step.'},
  bad_input: {word: 'BAD INPUT', shape: '⊗', state: 'over', advice: 'These numbers do not fit this robot: go back, or Home.'},
  unsupported: {word: 'NOT AVAILABLE', shape: '⊗', state: 'over', advice: 'This robot does not answer this: the message says what it answers.'},
  // Of a plan
  clear: {word: 'CLEAR', shape: '●', state: 'exact', advice: ''},
  clear_if_taut: {word: 'CLEAR ONLY IF TAUT', shape: '▼', state: 'slack', advice: 'As planned it touches nothing; where tendons are slack or stretched, the robot sags or the model is off, it may.'},
  touches: {word: 'TOUCHES', shape: '⊗', state: 'over', advice: 'Press E for the steps where it does.'},
  limit_exceeded: {word: 'LIMIT EXCEEDED', shape: '⊗', state: 'over', advice: 'Press E for the steps where it is.'},
  checking: {word: 'CHECKING…', shape: '…', state: 'stale', advice: 'The steps are those of the file; what they touch is not known yet.'},
  recorded: {word: 'RECORDED', shape: '■', state: 'stale', advice: 'What was measured, in the axes of the base at stage 0. What it touched is not known.'},
  unknown_plan: {word: 'NO SUCH PLAN', shape: '?', state: 'stale', advice: ''},
  // The page's own words, where nobody has answered
  solving: {word: 'SOLVING…', shape: '…', state: 'stale', advice: 'The picture is still of the numbers before.'},
  not_answered: {word: 'NOT ANSWERED', shape: '?', state: 'stale', advice: 'The picture is of the numbers before.'},
  page_failed: {word: 'INTERNAL ERROR', shape: '⊗', state: 'over', advice: 'The page itself failed, not the robot and not the connection. Load it anew; should it come again, report the words above.'},
};

export function verdictOf(answer: Json): Verdict {
  if (answer.error?.code === 'too_slow') return verdicts.stopped!;
  if (answer.error) return {word: 'REFUSED', shape: '⊗', state: 'over', advice: ''};
  const found = verdicts[answer.status] ?? {word: String(answer.status).toUpperCase(), shape: '⊗', state: 'over', advice: ''};
  const isHeldSo = answer.status === 'stalled' || (answer.status === 'unreachable' && answer.query === 'forward');
  if (isHeldSo && answer.tensions) return {...found, advice: 'Pull less, or pay out the tendons on the other side.'};
  if (answer.status === 'converged' && answer.stable === false) return verdicts.unstable!;
  return answer.status === 'converged' && answer.stable === true ? {...found, word: 'SOLVED, STABLE'} : found;
}

/** The box with the word. Words are told to a screen reader as they change, the numbers beside them are not. */
export class VerdictBox {
  private readonly mark = document.createElement('span');
  private readonly word = document.createElement('strong');
  private readonly detail = document.createElement('span');
  private readonly why = document.createElement('p');
  private readonly advice = document.createElement('p');
  private readonly ways = document.createElement('div');
  private readonly cancel = document.createElement('button');
  private timers: number[] = [];

  constructor(private readonly box: HTMLElement, cancel: () => void) {
    const text = document.createElement('div');
    box.className = 'verdict';
    this.mark.className = 'mark';
    this.mark.ariaHidden = 'true';
    this.word.setAttribute('role', 'status');
    this.detail.className = 'detail';
    this.why.className = 'reason';
    this.advice.className = 'advice';
    this.ways.className = 'ways';
    this.cancel.type = 'button';
    this.cancel.textContent = 'Cancel';
    this.cancel.addEventListener('click', cancel);
    text.append(this.word, this.detail, this.why, this.advice, this.ways, this.cancel);
    box.append(this.mark, text);
    this.cancel.hidden = true;
  }

  /** @param ways out of it, as buttons */
  show(answer: Json, detail: string, ways: Way[] = []): void {
    const {word, shape, state, advice} = verdictOf(answer);
    if (answer.status !== 'solving') this.settle();
    this.mark.className = `mark ${state}`;
    this.mark.textContent = shape;
    if (this.word.textContent !== word) this.word.textContent = word;
    this.box.dataset.state = state;
    this.detail.textContent = detail;
    this.why.textContent = answer.error?.message ?? answer.message ?? '';
    this.advice.textContent = advice;
    this.offer(ways);
  }

  offer(ways: Way[]): void {
    this.ways.replaceChildren(...ways.map(([text, go]) => button(text, go)));
  }

  /** A question is on its way: a ring after 0.1 s, words and Cancel after a second. */
  wait(late: () => void): void {
    if (this.timers.length > 0) return;
    this.timers = [
      window.setTimeout(() => this.box.classList.add('waiting'), 100),
      window.setTimeout(() => {
        late();
        this.cancel.hidden = false;
      }, 1000),
    ];
  }

  settle(): void {
    this.timers.forEach(clearTimeout);
    this.timers = [];
    this.box.classList.remove('waiting');
    this.cancel.hidden = true;
  }
}
