// What a picture of a robot is made of, and what it can do, whether WebGL or SVG draws it.
import type {Json} from './client';

export type View = 'side' | 'top' | 'front' | 'tip';
export const layerNames = ['rods', 'tendons', 'discs', 'frames', 'lines', 'labels', 'ghost', 'grid'] as const;
export type Layer = (typeof layerNames)[number];
export const shownAtFirst: Layer[] = ['rods', 'tendons', 'discs', 'frames', 'ghost'];

/** A part that the pointer can be on: `backbone` of a leg or section, `platform`, ... */
export interface Part { kind: 'backbone' | 'platform' | 'tendon' | 'line' | 'disc' | 'frame'; index: number; tendon?: number }

/** What each tendon pulls [N] and how much too long it is [m], a list a section; and to where the scale of tensions goes [N]. */
export interface Pulls {
  tensions: number[][];
  slack: number[][];
  most: number;
  along?: number[][][];  ///< where tendons rub: between motor and base, then from guide to guide [N]
}

export interface Drawing {
  shape: Json;             ///< an answer to `shape`
  isPlanar: boolean;
  radius: number;          ///< of the rods [m]
  struts: boolean[];       ///< whether the line of a leg is a strut, drawn as the rod it is
  isStale: boolean;        ///< the last solved one, while what is asked has no solution
  ghost: Json | null;      ///< another answer to `shape`, to compare with
  states: string[];        ///< the shape of each section's state (●▼⊗▧), at its end; empty of platforms
  isUnstable: boolean;
  directions: number[][];  ///< unstable ones: twists [v, ω]
  meeting: number[] | null;  ///< where the legs' lines meet at a type II
  around?: Around;           ///< of a robot that goes in
  tube?: Tube;               ///< through which its base goes
  wrench: number[] | null;   ///< on the platform [N, N m]; planar [fx, fy, m]
  loads?: {at: number[]; force: number[]}[];  ///< forces elsewhere [m, N]
  pulls?: Pulls;             ///< of an arm
  names?: {text: string; at: number[]}[];     ///< of parts that have no line of their own
  canGrab?: boolean;         ///< false: the hand cannot take the platform anywhere
}

/** A straight tube from one end to the other, and how far a shaft comes out of it [m]. */
export interface Tube { from: number[]; to: number[]; shaft: number[]; axis: number[]; radius: number }

/** What is around a robot that goes in, in the axes of the scene [m]. */
export interface Around {
  trail: number[][][];     ///< the way of the tip, in pieces where something of it is not known
  target: {tip: number[]; direction: number[] | null; tolerance: number} | null;
  port: {position: number[]; radius: number} | null;
  axis: number[];          ///< in which it goes in
  tip: {position: number[]; direction: number[]};  ///< here
  base?: number[];         ///< where solids are cut, if it is nearer to the eye than the tip
  near: {from: number[]; to: number[]; says: string; isBad: boolean; solid: number} | null;  ///< where robot and solids are nearest
  extent: number[][];      ///< what a fit has in view
}

/** Closed surfaces, one after the other: `counts` triangles of each. */
export interface Solids { positions: Float32Array; indices: Uint32Array; counts: number[] }

export interface Picture {
  readonly canvas: Element;
  frames: number;                          ///< drawn so far
  labelOf: (part: Part) => string;         ///< name and value of what the pointer is on
  grabbed: (position: number[], isEnd: boolean) => void;  ///< the platform is dragged: where its reference point is to go [m]
  note: (text: string) => void;            ///< something to say once, such as that details were left out
  moved: () => void;                       ///< the camera has moved
  paint(style: CSSStyleDeclaration): void;  ///< colours are the page's tokens
  clear(): void;
  draw(drawing: Drawing): void;
  fit(view?: View): void;                  ///< all of it in view
  show(layer: Layer, is: boolean): void;
  solids(solids: Solids | null): void;
  isCut: boolean;                          ///< of solids what lies before the tip is left out
  toggleProjection(): void;                ///< orthographic or perspective
  camera: string;                          ///< short text for a link. Once set, the next drawing is seen so; empty: it is fitted
  notScaled: boolean;                      ///< rods are drawn thicker than they are
  save(command: string): Promise<Blob>;    ///< PNG of twice the size, the command in its metadata
}
