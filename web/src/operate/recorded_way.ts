// A recording as the screen Trajectory shows a way: each measurement is a step, in the robot's own axes, and nothing of it is checked.
import type {Json} from '../client';
import {Plan, type Step} from '../plan';
import {isPolar} from './coordinates';
import type {Recording} from './recording';

const alone = {name: '', base: {position: [0, 0, 0], quaternion: [1, 0, 0, 0]}, axis: [0, 0, 1], port: null, target: null, margins: {clearance: 0}, solids: []};

/** Steps before which rows are missing, or were left out. */
const gapsOf = ({gaps}: Recording, rows: number[]) => rows.flatMap((row, step) => (step > 0 && (gaps.has(row) || row !== rows[step - 1]! + 1) ? [step] : []));

/** @param handle of a link, empty: of a file of this computer; null: its zeros were never set, so nothing is known of its bends */
export function recordedWay(recording: Recording, sections: {type: string}[], handle: string): Plan | null {
  const stages = recording.column('measured_stage'), rows = Array.from({length: recording.rows}, (_, row) => row).filter((row) => recording.isHomed(row));
  const steps = rows.map((row): Step => ({
    stage: stages[row] || 0, limit: null, changes: sections.map((_, i) => recording.ofTendons(row, i, 'change')), configuration: sections.map((one, i) => {
      const [x, y] = recording.bend(row, i, 'measured_beta');
      return isPolar(one) ? [Math.hypot(x, y), Math.atan2(y, x)] : [x, y];
    }),
  }));
  const told: Json = {name: recording.name, steps, times: rows.map((row) => recording.times[row]!), gaps: gapsOf(recording, rows), check: null, scene: alone, files: {scene: '', plan: ''}, robot: {name: recording.robot, text: recording.text, robot: ''}, angles: sections.map((one) => (isPolar(one) ? 'theta' : 'beta_1'))};
  return steps.length > 0 ? new Plan(handle, told) : null;
}
