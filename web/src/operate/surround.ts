// What is around an arm: the scene of a plan for it, where the server has one; else the straight tube that guides its base.
import {type Json, meshes, plan as planOf} from '../client';
import {Plan} from '../plan';
import type {Solids, Tube} from '../picture';
import {solidsOf} from '../trajectory';
import {placed, type Place, type Pose} from '../poses';
import {plus, type Point} from '../vector';

const upright: Place = {base: {position: [0, 0, 0], quaternion: [1, 0, 0, 0]}, axis: [0, 0, 1]};
const [wider, part] = [1.3, 0.2];  // of the widest disc; of the arm's length

export interface Scene { scene: Json; solids: Solids }

/** @param name of the robot @param plans of the server */
export async function findScene(name: string, plans: Json[]): Promise<Scene | null> {
  const handle = plans.find(({robot}) => robot === name)?.plan;
  if (!handle) return null;
  const told = await planOf(handle);
  return {scene: told.scene, solids: solidsOf(new Plan(handle, told), await meshes(handle))};
}

/** An arm where its stage has it. */
export const inPlace = (shape: Json, scene: Json | null, stage: number): Pose => placed(shape, (scene as Place | null) ?? upright, stage)!;

/** The tube ends where the base is when the stage is at 0; from there on a straight shaft reaches to where it is. */
export function tubeOf(shape: Json, scene: Json | null, stage: number): Tube {
  const {base, axis} = (scene as Place | null) ?? upright, radius = wider * Math.max(...(shape.discs ?? []).map((disc: Json) => disc.radius), 1e-3);
  const length = shape.backbones.flat().reduce((sum: number, point: Point, i: number, all: Point[]) => sum + (i > 0 ? Math.hypot(...point.map((value, k) => value - all[i - 1]![k]!)) : 0), 0);
  return {from: plus(base.position, axis, -part * length), to: base.position, shaft: plus(base.position, axis, stage), axis, radius};
}
