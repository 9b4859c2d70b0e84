// The word of an answer, with its shape and what to try.
import type {Json} from './client';

export interface Verdict { word: string; shape: string; state: string; advice: string }

const verdicts: Record<string, Verdict> = {
  converged: {word: 'SOLVED', shape: '●', state: 'exact', advice: ''},
  unstable: {word: 'SOLVED, UNSTABLE', shape: '▼', state: 'slack', advice: 'It does not stay here by itself. Lower the load, or look at other solutions.'},
  singular: {word: 'SINGULAR', shape: '▼', state: 'slack', advice: 'Step back, or change another input first.'},
  slack: {word: 'SLACK TENDON', shape: '▼', state: 'slack', advice: 'A tendon cannot push: bend this leg more, or lower the load.'},
  unreachable: {word: 'UNREACHABLE', shape: '▧', state: 'unreachable', advice: 'The legs do not reach: go back towards the last pose that was solved.'},
  left_domain: {word: 'UNREACHABLE', shape: '▧', state: 'unreachable', advice: 'Go back within the limits.'},
  stalled: {word: 'STALLED', shape: '⊗', state: 'over', advice: 'Begin at Home and take smaller steps.'},
  iteration_limit: {word: 'LIMIT REACHED', shape: '⊗', state: 'over', advice: 'Raise the limit of iterations under Model.'},
};

export function verdictOf(answer: Json): Verdict {
  if (answer.error) return {word: 'REFUSED', shape: '⊗', state: 'over', advice: ''};
  const found = verdicts[answer.status] ?? {word: String(answer.status).toUpperCase(), shape: '⊗', state: 'over', advice: ''};
  return answer.status === 'converged' && answer.stable === true ? {...found, word: 'SOLVED, STABLE'} : found;
}

/** The box with the word. Words are told to a screen reader as they change, the numbers beside them are not. */
export class VerdictBox {
  private readonly mark = document.createElement('span');
  private readonly word = document.createElement('strong');
  private readonly detail = document.createElement('span');
  private readonly why = document.createElement('p');
  private readonly advice = document.createElement('p');
  private readonly way = document.createElement('button');
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
    this.way.type = this.cancel.type = 'button';
    this.cancel.textContent = 'Cancel';
    this.cancel.addEventListener('click', cancel);
    text.append(this.word, this.detail, this.why, this.advice, this.way, this.cancel);
    box.append(this.mark, text);
    this.offer('', () => undefined);
    this.cancel.hidden = true;
  }

  show(answer: Json, detail: string): void {
    const {word, shape, state, advice} = verdictOf(answer);
    this.settle();
    this.mark.className = `mark ${state}`;
    this.mark.textContent = shape;
    if (this.word.textContent !== word) this.word.textContent = word;
    this.box.dataset.state = state;
    this.detail.textContent = detail;
    this.why.textContent = answer.error?.message ?? answer.message ?? '';
    this.advice.textContent = advice;
    this.offer('', () => undefined);
  }

  /** A way out of what has no solution. */
  offer(text: string, go: () => void): void {
    this.way.hidden = text === '';
    this.way.textContent = text;
    this.way.onclick = go;
  }

  /** A question is on its way: a ring after 0.1 s, words and Cancel after a second. */
  wait(): void {
    if (this.timers.length > 0) return;
    this.timers = [
      window.setTimeout(() => this.box.classList.add('waiting'), 100),
      window.setTimeout(() => {
        this.detail.textContent = 'solving…';
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
