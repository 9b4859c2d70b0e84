// What the picture is compared with: a pose that was kept, or another robot at the same inputs.
import {type Json, Robot, robotText} from './client';
import {describe, type Described, holding} from './described';
import {everything, isSolved, told} from './questions';
import {type State, stateOf} from './state';

export interface Ghost { says: string; answer: Json; shape: Json }

/** Another robot, which goes where the first one is as far as it has the same inputs; else it stays at home. */
export class Rival {
  private constructor(readonly name: string, private readonly robot: Robot, private readonly described: Described) {}

  static async open(name: string): Promise<Rival> {
    const robot = await Robot.open(await robotText(name));
    return new Rival(name, robot, await describe(robot));
  }

  /** @return null where it has no solution there */
  async at(first: Described, state: State): Promise<Ghost | null> {
    const {name} = this, described = holding(this.described, state.held), own = stateOf(described), isAlike = (side: 'inputs' | 'load') =>
      first.isSerial === described.isSerial && first.isArm === described.isArm && first[side].length === described[side].length && first[side].every(({unit}, i) => unit === described[side][i]!.unit);
    const at = {
      ...own, ...(isAlike('inputs') && {inputs: state.inputs}), ...(isAlike('load') && {load: state.load}), gravity: state.gravity,
      ...(described.models.includes(state.model) && {model: state.model}),
    };
    const [found] = await this.robot.ask([everything(described, {...at, asked: 'inputs'})]) as [Json], answer = told(found);
    return isSolved(answer) && answer.backbones ? {says: isAlike('inputs') ? name : `${name} at home`, answer, shape: answer} : null;
  }
}
