// The arm in three dimensions, beside its diagrams: from the side, from above, from the tip, or as large as the page; with the tube
// that guides its base, or the scene that it goes into.
import type {Json} from '../client';
import {extent} from '../compose';
import {button, byId, make} from '../make';
import type {Around, Picture, Tube, View} from '../picture';
import {makePicture} from '../picture_of';
import type {Pose} from '../poses';
import {toast} from '../toast';
import {plus, type Point} from '../vector';
import type {Kind} from './frame';
import {type TipPlace, trailOf} from './plan_way';
import type {Stages} from './subject';
import {inPlace, type Scene, tubeOf} from './surround';

const views: View[] = ['side', 'top', 'tip'];
const shapes: Record<Kind, string> = {exact: '●', slack: '▼', over: '⊗', unreachable: '▧', stale: '?'};
const far = 2e-3;  // m that the stage goes before all is put in view again

/** An arm as the server has it, where it is to go, its tip on the way of a plan, how its sections are. */
export interface Seen { shape: Json; ghost: Json | null; tips: TipPlace[]; stages: Stages | null; kinds: Kind[]; isStale: boolean }

export class ArmView {
  private picture: Picture | null = null;
  private readonly buttons: HTMLButtonElement[];
  private view: View = 'side';
  private isFull = false;
  private seen: Seen | null = null;
  private drawn = '';
  private scene: Scene | null = null;
  private fitted = {camera: '', stage: 0};

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
    requestAnimationFrame(() => this.fit());
  }

  fit(): void {
    this.picture?.fit(this.view);
    this.fitted = {camera: this.picture?.camera ?? '', stage: this.seen?.stages?.now ?? 0};
  }

  show(seen: Seen): void {
    const {shape, ghost, tips, ...rest} = seen, drawn = JSON.stringify(rest), isFirst = !this.seen || (tips.length > 0) !== (this.seen.tips.length > 0);
    if (shape === this.seen?.shape && ghost === this.seen?.ghost && tips === this.seen?.tips && drawn === this.drawn) return;
    [this.seen, this.drawn] = [seen, drawn];
    this.draw();
    const isAsFitted = this.picture!.camera === this.fitted.camera && Math.abs((seen.stages?.now ?? 0) - this.fitted.stage) > far;
    if (isFirst || isAsFitted) this.fit();
  }

  /** What is around it; null: nothing that the server knows of. */
  surround(scene: Scene | null): void {
    this.scene = scene;
    this.picture?.solids(scene?.solids ?? null);
    if (!this.seen) return;
    this.draw();
    this.fit();
  }

  forget(): void {
    this.seen = null;
    this.surround(null);
    this.picture?.clear();
  }

  paint(): void {
    this.picture?.paint(getComputedStyle(document.documentElement));
  }

  private draw(): void {
    const {seen, scene} = this, {shape, ghost, tips, stages, kinds, isStale} = seen!, where = scene?.scene ?? null, {now, goal} = stages ?? {now: 0, goal: 0}, pose = inPlace(shape, where, now), picture = this.begin();
    const tube = stages && tubeOf(shape, where, now);
    picture.draw({
      shape: pose.shape, isPlanar: false, radius: 0.0005, struts: [], isStale, ghost: ghost && inPlace(ghost, where, goal).shape, states: kinds.map((kind) => shapes[kind]), isUnstable: false, directions: [],
      meeting: null, wrench: null, ...(tube && {tube}), around: around(pose, where, tube, trailOf(tips, where)),
    });
  }

  /** Made when it is first needed: it takes a context of WebGL. */
  private begin(): Picture {
    if (this.picture) return this.picture;
    const picture = this.picture = makePicture(byId('op-view'));
    for (const layer of ['frames', 'tendons'] as const) picture.show(layer, false);
    picture.labelOf = ({index}) => `section ${index + 1}`;
    picture.note = toast;
    picture.isCut = true;
    if (this.scene) picture.solids(this.scene.solids);
    this.paint();
    return picture;
  }

  private look(view: View): void {
    this.view = view;
    this.mark();
    this.fit();
  }

  private mark(): void {
    this.buttons.forEach((one, i) => { one.ariaPressed = String(i === views.length ? this.isFull : views[i] === this.view); });
    this.box.dataset.view = this.view;
  }
}

/** @param trail of a plan's tip, which ends where it leads to */
function around({shape, tip}: Pose, scene: Json | null, tube: Tube | null, trail: Point[]): Around {
  const points: Point[] = [...extent(shape), ...trail], port = scene?.port ?? null, end = trail.at(-1), target = scene?.target ?? (end ? {tip: end, direction: null, tolerance: 0} : null), axis: Point = scene?.axis ?? [0, 0, 1];
  if (target) points.push(target.tip);
  if (port) points.push(plus(port.position, axis, port.radius), plus(port.position, axis, -port.radius));
  if (tube) for (const sign of [1, -1]) points.push(plus(tube.from, [sign, sign, 0], tube.radius));
  return {trail: [trail], target, port, axis, tip, base: shape.backbones[0]?.[0] ?? tip.position, near: null, extent: points};
}
