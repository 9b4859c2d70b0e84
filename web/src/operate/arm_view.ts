// The arm in three dimensions, beside its diagrams: from the side, from above, from the tip, or as large as the page.
import type {Json} from '../client';
import {button, byId, make} from '../make';
import type {Around, Picture, View} from '../picture';
import {makePicture} from '../picture_of';
import {toast} from '../toast';
import {axesOf, plus, type Point} from '../vector';
import type {Kind} from './frame';
import {type TipPlace, trailOf} from './plan_way';

const views: View[] = ['side', 'top', 'tip'];
const shapes: Record<Kind, string> = {exact: '●', slack: '▼', over: '⊗', unreachable: '⧄', stale: '?'};

export class ArmView {
  private picture: Picture | null = null;
  private readonly buttons: HTMLButtonElement[];
  private view: View = 'side';
  private isFull = false;
  private shape: Json | null = null;
  private ghost: Json | null = null;
  private drawn = '';
  private tips: TipPlace[] = [];

  /** @param turned it is small or large now */
  constructor(private readonly box: HTMLElement, private readonly turned: () => void) {
    this.buttons = [...views.map((view) => button(view[0]!.toUpperCase() + view.slice(1), () => this.look(view), `from the ${view} (v)`)), button('Full', () => this.full(!this.isFull), 'as large as the page (v)')];
    const tools = make('div', {className: 'view-tools'}, ...this.buttons, make('kbd', {textContent: 'V'}));
    tools.setAttribute('role', 'toolbar');
    tools.ariaLabel = 'Views of the arm';
    box.append(tools);
    this.mark();
  }

  /** Side, top, tip, as large as the page, and the side again. */
  next(): void {
    const at = views.indexOf(this.view);
    if (this.isFull) {
      this.full(false);
      this.look('side');
    } else if (at === views.length - 1) this.full(true);
    else this.look(views[at + 1]!);
  }

  get isLarge(): boolean {
    return this.isFull;
  }

  full(is: boolean): void {
    this.isFull = is;
    document.body.classList.toggle('arm-full', is);
    this.mark();
    this.turned();
    requestAnimationFrame(() => this.picture?.fit(this.view));
  }

  fit(): void {
    this.picture?.fit(this.view);
  }

  /** @param ghost where it is to go @param tips of a plan @param stages of arm and ghost [m] */
  show(shape: Json, ghost: Json | null, kinds: Kind[], isStale: boolean, tips: TipPlace[], stages: {now: number; goal: number}): void {
    const isFirst = !this.shape || tips !== this.tips && (tips.length > 0) !== (this.tips.length > 0), drawn = `${kinds.join()}${isStale} ${stages.now} ${stages.goal}`;
    if (shape === this.shape && ghost === this.ghost && tips === this.tips && this.drawn === drawn) return;
    [this.shape, this.ghost, this.tips, this.drawn] = [shape, ghost, tips, drawn];
    const picture = this.begin(), around = tips.length > 0 ? wayAround(shape, tips, stages.now) : null;
    picture.draw({shape, isPlanar: false, radius: 0.0005, struts: [], isStale, ghost: ghost && moved(ghost, stages.goal - stages.now), states: kinds.map((kind) => shapes[kind]), isUnstable: false, directions: [], meeting: null, wrench: null, ...(around && {around})});
    if (isFirst) picture.fit(this.view);
  }

  forget(): void {
    [this.shape, this.ghost, this.tips, this.drawn] = [null, null, [], ''];
    this.picture?.clear();
  }

  paint(): void {
    this.picture?.paint(getComputedStyle(document.documentElement));
  }

  /** Made when it is first needed: it takes a context of WebGL. */
  private begin(): Picture {
    if (this.picture) return this.picture;
    const picture = this.picture = makePicture(byId('op-view'));
    for (const layer of ['frames', 'tendons'] as const) picture.show(layer, false);
    picture.labelOf = ({index}) => `section ${index + 1}`;
    picture.note = toast;
    this.paint();
    return picture;
  }

  private look(view: View): void {
    this.view = view;
    this.mark();
    this.picture?.fit(view);
  }

  private mark(): void {
    this.buttons.forEach((one, i) => { one.ariaPressed = String(i === views.length ? this.isFull : views[i] === this.view); });
    this.box.dataset.view = this.view;
  }
}

/** A shape whose base is farther along the stage. */
function moved(shape: Json, by: number): Json {
  if (by === 0) return shape;
  const to = (point: Point) => plus(point, [0, 0, 1], by);
  return {...shape, backbones: (shape.backbones as Point[][]).map((points) => points.map(to)), discs: (shape.discs ?? []).map((disc: Json) => ({...disc, pose: {...disc.pose, position: to(disc.pose.position)}})),
          ...(shape.tip && {tip: {...shape.tip, position: to(shape.tip.position)}})};
}

/** The way of the tip, and its end. */
function wayAround(shape: Json, tips: TipPlace[], stage: number): Around {
  const trail = trailOf(tips, stage), [, , along] = axesOf(shape.tip);
  return {trail, target: {tip: trail.at(-1)!, direction: null, tolerance: 0}, port: null, axis: [0, 0, 1], tip: {position: shape.tip.position, direction: along}, near: null, extent: [...trail, [0, 0, 0], shape.tip.position]};
}
