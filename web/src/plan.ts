// A plan of an insertion, as the server tells it: its steps, its check, and what of them stands out.
import type {Json} from './client';

export interface Step { stage: number; configuration: number[][]; limit: string | null; changes?: number[][] }  ///< changes: of tendons, where they were measured
export interface Checked { clearance: number; verdict: string; section?: number; solid?: number; on_robot?: number[]; on_solid?: number[] }
export interface Check { verdict: string; clearance: number; worst: number; allowed_share: number; off: {tendons: number; sag: number; model: number}; reach: number; steps: Checked[] }

/** Steps that do not pass, from the first to the last of a run. */
export interface Run { from: number; to: number; isLimit: boolean }

const prominence = 0.15;  // of the span of all clearances, that a minimum has to lie below what is around it
const mostSpots = 10;

export class Plan {
  readonly handle: string;
  readonly steps: Step[];
  readonly check: Check | null;
  readonly scene: Json;
  readonly files: {scene: string; plan: string};
  readonly robot: {name: string; text: string; robot: string};
  readonly title: string;
  readonly times: number[] | null;  ///< of a recording [s]: a plan has none
  readonly gaps: ReadonlySet<number>;  ///< of a recording: steps before which nothing is known
  private readonly angles: string[];  ///< of each section the name of its first
  readonly spots: number[];  ///< steps where it is tight, the tightest first
  readonly failed: Run[];

  constructor(handle: string, told: Json) {
    this.handle = handle;
    [this.steps, this.check, this.scene, this.files, this.robot] = [told.steps, told.check, told.scene, told.files, told.robot];
    this.angles = told.angles;
    this.title = told.name;
    this.times = told.times ?? null;
    this.gaps = new Set(told.gaps);
    this.spots = this.check ? tightSpots(this.check.steps.map(({clearance}) => clearance), this.check.reach) : [];
    this.failed = runs(this.steps, this.check);
  }

  get last(): number {
    return this.steps.length - 1;
  }

  /** Where a step is on the axis of the curves: its time, or which one it is. */
  placeOf(step: number): number {
    return this.times?.[step] ?? step;
  }

  /** The step nearest to a place. */
  stepAt(place: number): number {
    if (!this.times) return Math.round(place);
    const after = this.times.findIndex((time) => time >= place), before = Math.max(0, after - 1);
    return after < 0 ? this.last : place - this.times[before]! < this.times[after]! - place ? before : after;
  }

  /** As a status of an answer, so that it has a word and a shape. */
  get status(): string {
    if (this.times) return 'recorded';
    if (this.steps.some(({limit}) => limit)) return 'limit_exceeded';
    return this.check?.verdict ?? 'checking';
  }

  /** Of each section the symbols of its two angles: only bends of a neutral backbone are a size and a direction. */
  get anglesOf(): [string, string][] {
    return this.steps[0]!.configuration.map((_, section) => (this.isPolar(section) ? ['θ', 'φ'] : ['β₁', 'β₂']));
  }

  isPolar(section: number): boolean {
    return this.angles[section] === 'theta';
  }

  /** Checked, and nothing is wrong with it as it is planned. */
  get isGood(): boolean {
    return this.status === 'clear' || this.status === 'clear_if_taut';
  }

  isBad(step: number): boolean {
    return !!this.steps[step]!.limit || this.check?.steps[step]!.verdict === 'touches';
  }

  solid(index: number | undefined): string {
    return index === undefined ? 'nothing' : this.scene.solids[index].name;
  }

  /** `S3 to stator-1-03`; sections are counted from one, as everywhere on the page. */
  pair({section, solid}: Checked): string {
    return solid === undefined ? 'nothing within reach' : `S${(section ?? 0) + 1} to ${this.solid(solid)}`;
  }
}

/** Local minima that lie clearly below what is around them. */
export function tightSpots(values: number[], reach: number): number[] {
  const least = prominence * (Math.max(...values) - Math.min(...values)), found: number[] = [];
  /** How far it has to rise before it gets lower than here; at an end it rises no more. */
  const rise = (from: number, way: number) => {
    let top = values[from]!;
    for (let i = from + way; i >= 0 && i < values.length; i += way) {
      if (values[i]! < values[from]! || (values[i] === values[from] && way < 0)) return top - values[from]!;
      top = Math.max(top, values[i]!);
    }
    return Infinity;
  };
  for (let i = 0; i < values.length; ++i) {
    if (values[i]! >= reach || values[i]! > (values[i - 1] ?? Infinity) || values[i]! > (values[i + 1] ?? Infinity)) continue;
    if (Math.min(rise(i, -1), rise(i, 1)) >= least) found.push(i);
  }
  return found.sort((a, b) => values[a]! - values[b]!).slice(0, mostSpots);
}

function runs(steps: Step[], check: Check | null): Run[] {
  const found: Run[] = [];
  steps.forEach(({limit}, i) => {
    if (!limit && check?.steps[i]!.verdict !== 'touches') return;
    const last = found.at(-1), isLimit = !!limit;
    if (last && last.to === i - 1 && last.isLimit === isLimit) last.to = i;
    else found.push({from: i, to: i, isLimit});
  });
  return found;
}
