// What the screen Operate shows of an arm: frames of a device, or answers to queries put into the same form.
import type {PlanFrame} from './plan_buttons';

/** In the plane of a section's diagram [rad]: β₁, β₂ of a joint, or θ cos φ, θ sin φ of a neutral backbone. */
export type Bend = [number, number];

/** A tendon allows the side that a normal points to, or what lies to the left of a curve. */
export type Frontier = {normal: [number, number]; offset: number} | {curve: Bend[]};

export interface SectionFrame {
  class?: 'exact' | 'indeterminate' | 'inconsistent' | 'unreachable';  ///< none: no diagram, as before homing
  partial?: boolean;
  near_limit?: boolean;
  word: string;
  locked?: boolean;
  commanded?: Bend; target: Bend; measured?: Bend | null;
  changes: number[];
  set?: number[];
  tension?: number[] | null;  ///< [N]
  slack?: number[];
  amount?: number;            ///< by how much it is what its word says [m]; unreachable: what it is asked for [rad]
  point?: Bend;
  frontiers?: Frontier[];
  polygon?: Bend[];
  boundary?: Bend[];
  envelope?: {kind: string; limit: number};
  conditional?: boolean;
  outline?: Bend[];
  no_outline?: 'previous_over_tensioned' | 'over_tensioned' | 'beyond_envelope' | 'exact_model';  ///< why there is none
  advice?: string;
}

export interface Alarm {
  section: number; word: string; since: number;  ///< [s] ago
  sentence: string; did: string; next: string; more: number; acknowledged: boolean;
}

export interface Frame {
  time: number;
  age: number | null;
  link: 'ok' | 'silent' | 'wrong_table' | 'bad_checksum' | 'gone';
  message: string;
  round_trip: number; rate: number; errors: number;
  model?: 'lsk' | 'pcc';  ///< by which changes are of bends
  control: {holder: number | null; since: string};
  state: 'view_only' | 'control' | 'armed';
  activity: 'rest' | 'moving' | 'straighten' | 'retract' | 'advance' | 'relax' | 'homing' | 'holding' | 'follow' | 'follow_back';
  armed_left: number;
  why: string;
  homed: boolean;
  homing: {section: number; tendon: number; step: string; done: number; of: number} | null;
  homed_at?: {date: string; pretension: number; file: string; error: string} | null;  ///< by this server
  stage: number; insertion: number; stage_target: number;
  speed: number;
  recording: {name: string; rows: number; error: string} | null;
  tip: number[];
  sections: SectionFrame[];
  alarm: Alarm | null;
  plan?: PlanFrame | null;      ///< none: an older server
}

export interface DeviceInfo {
  source: 'demo' | 'port'; name: string; robot: string; file: string; sections: number; tendons: number;
  has_tension: boolean; tension_limit: number; has_stage: boolean; stage_limit: number; faults: boolean;
}

export interface Entry { time: number; clock: string; kind: string; text: string }

/** A state as it is shown: a shape and a colour. Of two the later one is the more severe. */
export const kinds = ['exact', 'slack', 'unreachable', 'stale', 'over'] as const;
export type Kind = (typeof kinds)[number];

const ofWords: Record<string, Kind> =
  {EXACT: 'exact', SLACK: 'slack', 'PARTLY SLACK': 'slack', 'OVER-TENSIONED': 'over', UNREACHABLE: 'unreachable', 'NO DATA': 'stale'};
export const kindOf = (word: string): Kind => ofWords[word] ?? 'stale';

/** Of a log entry; what is no state has no shape. */
export const kindOfEntry = (kind: string): Kind | null => kind === 'no_data' ? 'stale' : (kinds as readonly string[]).includes(kind) ? kind as Kind : null;

export const severity = ({word, near_limit}: SectionFrame): number => 2 * kinds.indexOf(kindOf(word)) + (near_limit ? 1 : 0);

/** Sections by their numbers, the worst first. */
export const worstFirst = (sections: SectionFrame[]): number[] => sections.map((_, i) => i).sort((a, b) => severity(sections[b]!) - severity(sections[a]!) || a - b);
