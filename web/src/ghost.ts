// What the picture is compared with: a pose that was kept, or another robot at the same inputs.
import {type Json, Robot, robotText} from './client';
import {describe} from './described';
import {forward, isSolved, shape} from './questions';
import {type State, stateOf} from './state';

export interface Ghost { name: string; answer: Json; shape: Json }

/** Another robot where the first one is, as far as it has the same inputs; else at home. */
export async function ghostOf(name: string, state: State): Promise<Ghost | null> {
  const robot = await Robot.open(await robotText(name)), described = await describe(robot), own = stateOf(described);
  const at = own.inputs.length === state.inputs.length ? {...own, inputs: state.inputs} : own;
  const answers = await robot.ask([forward(described, at), shape(described, at)]) as [Json, Json];
  return isSolved(answers[0]) && answers[1].backbones ? {name, answer: answers[0], shape: answers[1]} : null;
}
