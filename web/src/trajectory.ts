// The screen of a plan: the robot on its way in, the checks, and curves over all steps.
import {Checks, clearance} from './checks';
import {type Json, meshes, plan as planOf, Refused} from './client';
import {Curves} from './curves';
import type {Key} from './keys';
import {button, byId} from './make';
import {isPhone} from './operate/phone';
import {type Around, type Drawing, type Picture, type Solids} from './picture';
import {makePicture} from './picture_of';
import {Plan} from './plan';
import {type Pose, Poses, type Tips} from './poses';
import {views} from './stage';
import {toast} from './toast';
import {Transport} from './transport';
import type {System} from './units';
import {minus, plus, type Point} from './vector';

const patience = 150;  // ms without the picture of a step, after which the one before fades
const pause = 300;     // ms between looks for a check that is not there yet

export interface Screen {
  system(): System;
  changed(): void;  ///< the address or the command is another one
  say(text: string): void;
  heard(): void;    ///< the server has answered
  guarded(task: () => Promise<unknown>, again?: () => unknown): Promise<void>;
  save(blob: Blob, name: string): void;
  whyNot(plan: Plan): string;  ///< why it cannot be driven; empty: it can
  drive(plan: Plan): void;
}

/** Where the tip was, in one piece as far as that is known. */
function pieces(tips: (Tips | null)[], gaps: ReadonlySet<number>): Point[][] {
  const found: Point[][] = [[]];
  tips.forEach((tip, step) => {
    if (!tip || gaps.has(step)) found.push([]);
    if (tip) found.at(-1)!.push(tip.position);
  });
  return found;
}

export class Trajectory {
  private readonly picker = byId<HTMLSelectElement>('plan');
  private readonly checks = new Checks(byId('plan-verdict'), byId('plan-checks'), (step) => this.jump(step));
  private readonly curves = new Curves(byId('curves'), (step) => this.jump(step));
  private readonly transport = new Transport(byId('transport'), (step) => this.go(step), () => this.drawn === this.step || this.poses?.of(this.step) === null);
  private readonly cutter = button('Clip', () => this.cut(), 'leave out what lies before the tip (k)');
  private readonly follower = button('Follow', () => this.follow(), 'keep the tip where it is in the picture (t)');
  private readonly tabs = ['Curves', 'Checks'].map((name) => button(name, () => this.turnTo(name.toLowerCase())));
  private readonly driver = button('Drive…', () => this.drive());
  private picture: Picture | null = null;
  private plan: Plan | null = null;
  private poses: Poses | null = null;
  private step = 0;
  private drawn = -1;     // the step whose picture is shown
  private shown: Pose | null = null;
  private opening = 0;
  private isFollowing = false;
  private isFresh = true;  // seen from where it is seen at first
  private fading = 0;
  private looking = 0;

  constructor(private readonly listed: Json[], private readonly screen: Screen) {
    for (const {plan, name, scene} of listed) this.picker.add(new Option(scene ? `${name} (${scene})` : name, plan));
    this.picker.hidden = listed.length === 0;
    this.picker.addEventListener('change', () => this.open(new URLSearchParams({plan: this.picker.value})));
    byId('way-tabs').append(...this.tabs);
    this.turnTo('curves');
    byId('way-tools').append(button('Fit', () => this.fit(), 'all of the way in view (f)'), ...views.map(([key, view]) => button(view[0]!.toUpperCase() + view.slice(1), () => this.view(key), `view (${key})`)),
                             this.cutter, this.follower, button('Save', () => this.save(), 'save the picture (p)'));
    const placeDriver = () => byId(isPhone.matches ? 'way-tabs' : 'way-tools').append(this.driver);
    placeDriver();
    isPhone.addEventListener('change', placeDriver);
    Object.assign((window as any).__sinew, {way: this});
  }

  get isOpen(): boolean {
    return !!this.plan;
  }

  get badge(): string {
    return this.plan?.times ? `LOG ${this.plan.title}` : 'PLAN';
  }

  get title(): string {
    return this.plan?.times ? this.plan.title : this.listed.find(({plan}) => plan === this.plan?.handle)?.name ?? 'plan';
  }

  has(handle: string | null): boolean {
    return this.listed.some(({plan}) => plan === handle);
  }

  keys(): Key[] {
    const on = (keys: string[], says: string, go: (key: string) => void): Key => ({keys, says, go}), {transport} = this;
    return [
      on([' '], 'play or pause', () => transport.toggle()),
      on([',', '.'], 'one step back, on', (key) => transport.by(key === ',' ? -1 : 1)),
      on(['Shift+,', 'Shift+.'], 'ten steps', (key) => transport.by(key === 'Shift+,' ? -10 : 10)),
      on(['n'], 'the next tight spot', () => this.next(this.plan?.spots ?? [], 'no spot is tight')),
      on(['e'], 'the next step that fails a check', () => this.next(this.plan?.failed.map(({from}) => from) ?? [], 'no step fails')),
      on(['j', 'l'], 'slower, faster', (key) => transport.faster(key === 'j' ? -1 : 1)),
      on(['k'], 'leave out what lies before the tip, or not', () => this.cut()),
      on(['t'], 'keep the tip where it is in the picture, or not', () => this.follow()),
      on(['f'], 'all of the way in view', () => this.fit()),
      on(views.map(([key]) => key), 'from the side, above, the front, the tip', (key) => this.view(key)),
      on(['o'], 'parallel lines stay parallel, or not', () => this.picture?.toggleProjection()),
      on(['p'], 'save the picture', () => this.save()),
      on(['v'], 'drive it: the screen Operate with this plan', () => this.drive()),
      on(['/'], 'choose a plan', () => this.picker.focus()),
    ];
  }

  /** The plan of a link, or the first of the server. */
  open(link: URLSearchParams): void {
    const handle = link.get('plan') || this.listed[0]!.plan, run = ++this.opening, isHere = () => run === this.opening;
    clearTimeout(this.looking);
    this.transport.pause();
    void this.screen.guarded(async () => {
      let told: Json;
      try {
        told = await planOf(handle);
      } catch (error) {
        if (error instanceof Refused && error.status === 404 && isHere()) return this.unknown();
        throw error;
      }
      if (!isHere()) return;
      this.use(new Plan(handle, told), link);
      const solids = solidsOf(this.plan!, await meshes(handle));
      if (!isHere()) return;
      this.picture!.solids(solids);
    }, () => isHere() && this.open(link));
  }

  /** A recording. */
  openRecorded(plan: Plan, link: URLSearchParams): void {
    ++this.opening;
    clearTimeout(this.looking);
    this.transport.pause();
    this.use(plan, link);
  }

  paint(): void {
    this.picture?.paint(getComputedStyle(document.documentElement));
    if (this.plan) this.write();
  }

  /** The address of what is shown. */
  toLink(): URLSearchParams | null {
    if (!this.plan?.handle) return null;
    const {handle, times} = this.plan, link = new URLSearchParams({...(times ? {screen: 'trajectory', recording: handle} : {plan: handle}), step: String(this.step)});
    if (this.picture?.camera) link.set('camera', this.picture.camera);
    if (!this.picture?.isCut) link.set('clip', 'off');
    return link;
  }

  /** For a shell where the server was started. */
  command(): string {
    const word = (text: string) => (/^[\w./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);
    return this.plan && !this.plan.times ? `sinew plan ${word(this.plan.files.scene)} --check ${word(this.plan.files.plan)}` : '';
  }

  /** Another screen is shown. */
  leave(): void {
    this.transport.pause();
  }

  /** For tests: shapes are asked anew. */
  forgetShapes(): void {
    this.poses!.forget();
  }

  private unknown(): void {
    this.forget();
    this.screen.heard();
    this.screen.say('');
    byId('trajectory').classList.add('empty');
    this.checks.none('the link shows a plan that this server does not have', this.listed.map(({plan, name}) => [`Open ${name}`, () => this.open(new URLSearchParams({plan}))]));
    this.picker.value = '';
    this.screen.changed();
  }

  private forget(): void {
    this.poses?.end();
    [this.plan, this.poses, this.shown, this.drawn] = [null, null, null, -1];
    this.picture?.solids(null);
    this.picture?.clear();
    delete document.documentElement.dataset.drawn;
  }

  private use(plan: Plan, link: URLSearchParams): void {
    this.forget();
    this.plan = plan;
    byId('trajectory').classList.remove('empty');
    this.picker.value = plan.handle;
    this.begin();
    this.picture!.camera = link.get('camera') ?? '';
    this.isFresh = !link.get('camera');
    this.cut(link.get('clip') !== 'off');
    this.poses = new Poses(plan, (step) => this.came(step), (task, again) => this.screen.guarded(task, again));
    this.step = -1;
    this.write();
    this.say(plan);
    const wanted = link.get('step'), step = Number(wanted);
    this.go(wanted !== null && Number.isInteger(step) ? step : plan.times ? 0 : plan.last);
    if (!plan.check && !plan.times) this.look(plan);
  }

  private say(plan: Plan): void {
    if (plan.times) return this.screen.say(`${plan.steps.length} measurements of ${plan.robot.name}`);
    const triangles = plan.scene.solids.reduce((sum: number, one: Json) => sum + one.triangles, 0);
    this.screen.say(`${plan.steps.length} steps of ${plan.robot.name} · ${plan.scene.solids.length} solids, ${triangles} triangles${plan.check ? '' : ' · being checked'}`);
  }

  /** A check that runs is there after a while. */
  private look(plan: Plan): void {
    this.looking = window.setTimeout(() => void this.screen.guarded(async () => {
      const told = await planOf(plan.handle);
      if (this.plan !== plan) return;
      if (!told.check) return this.look(plan);
      const checked = new Plan(plan.handle, told);
      this.plan = checked;
      this.write();
      this.say(checked);
      this.draw();
    }, () => this.plan === plan && this.look(plan)), pause);
  }

  /** The picture is made when it is first needed: it takes a context of WebGL. */
  private begin(): void {
    if (this.picture) return;
    const picture = this.picture = makePicture(byId('way-view'));
    picture.isCut = true;
    for (const layer of ['frames', 'tendons', 'ghost'] as const) picture.show(layer, false);
    picture.labelOf = ({index}) => `section ${index + 1}`;
    picture.note = toast;
    picture.moved = () => this.screen.changed();
    picture.paint(getComputedStyle(document.documentElement));
  }

  /** By a hand: it plays no more. */
  private jump(step: number): void {
    this.transport.pause();
    this.go(step);
  }

  private go(step: number): void {
    const {plan} = this;
    if (!plan) return;
    const to = Math.min(plan.last, Math.max(0, step));
    if (to === this.step) return;
    this.step = to;
    this.transport.at(to);
    this.curves.at(to);
    this.checks.at(to, this.screen.system(), this.poses!.tips[to]);
    this.poses!.want(to);
    this.draw();
    this.screen.changed();
  }

  /** The next of some steps after this one; after the last the first. */
  private next(steps: number[], none: string): void {
    const sorted = [...steps].sort((a, b) => a - b), found = sorted.find((step) => step > this.step) ?? sorted[0];
    if (found === undefined) return toast(none);
    this.jump(found);
  }

  private came(step: number | null): void {
    this.screen.heard();
    if (step !== null && step !== this.step) return;
    if (step === null) this.write();
    this.draw();
    if (step === null && this.isFresh) this.fit();  // now that the way is known
    if (step === null) this.isFresh = false;
  }

  private write(): void {
    const plan = this.plan!, system = this.screen.system(), tips = this.poses?.tips ?? [];
    this.checks.show(plan, system, tips[plan.last]);
    this.transport.show(plan, system);
    this.curves.show(plan, tips, system);
    const why = this.screen.whyNot(plan);
    this.driver.ariaDisabled = String(why !== '');
    this.driver.title = why || 'on the screen Operate: along this plan, while a button is held';
    if (this.step >= 0) this.checks.at(this.step, system, tips[this.step]);
  }

  /** What is drawn is the step that is asked; while its shape is on its way the last one, which soon fades. */
  private draw(): void {
    const {plan, poses, picture, step} = this, pose = poses?.of(step);
    if (!plan || !poses || !picture || step < 0) return;
    clearTimeout(this.fading);
    if (pose) {
      const before = this.shown;
      [this.shown, this.drawn] = [pose, step];
      if (before && this.isFollowing) this.shift(before.tip.position, pose.tip.position);
      picture.draw(this.drawing(plan, pose, step, false));
      document.documentElement.dataset.drawn = String(step);
    } else if (this.shown) {
      const {shown, drawn} = this;
      this.fading = window.setTimeout(() => this.shown === shown && this.plan === plan && picture.draw(this.drawing(plan, shown, drawn, true)), patience);
    }
  }

  private drawing(plan: Plan, pose: Pose, step: number, isStale: boolean): Drawing {
    return {
      shape: pose.shape, isPlanar: false, radius: 0.0005, struts: [], isStale, ghost: null, states: [], isUnstable: false, directions: [], meeting: null, wrench: null,
      around: this.around(plan, pose, step),
    };
  }

  private around(plan: Plan, pose: Pose, step: number): Around {
    const {scene, check} = plan, tips = this.poses!.tips, at = check?.steps[step], trail = this.poses!.hasTips ? pieces(tips, plan.gaps) : [], points = trail.flat();
    const {on_robot: from, on_solid: to} = at ?? {}, extent: Point[] = [...(points.length > 0 ? points : [pose.tip.position]), scene.target?.tip ?? scene.base.position];
    if (scene.port) extent.push(plus(scene.port.position, scene.axis, scene.port.radius), plus(scene.port.position, scene.axis, -scene.port.radius));
    return {
      trail, target: scene.target, port: scene.port, axis: scene.axis, tip: pose.tip, extent,
      near: at && from && to ? {from, to, says: clearance(at.clearance, check!.reach, this.screen.system()), isBad: plan.isBad(step) || at.clearance < scene.margins.clearance, solid: at.solid!} : null,
    };
  }

  private fit(): void {
    this.picture?.fit();
  }

  private view(key: string): void {
    this.picture?.fit(views.find(([of]) => of === key)![1]);
  }

  private cut(is = !this.picture?.isCut): void {
    if (this.picture) this.picture.isCut = is;
    this.cutter.setAttribute('aria-pressed', String(is));
    this.draw();
    this.screen.changed();
  }

  private follow(): void {
    this.isFollowing = !this.isFollowing;
    this.follower.setAttribute('aria-pressed', String(this.isFollowing));
  }

  /** The camera goes along with the tip. */
  private shift(from: Point, to: Point): void {
    const parts = this.picture!.camera.split(','), by = minus(to, from);
    if (parts.length < 6) return;
    for (const k of [0, 1, 2]) parts[3 + k] = String(Number(parts[3 + k]) + by[k]!);
    this.picture!.camera = parts.join(',');
  }

  /** On a phone there is room for one of them. */
  private turnTo(tab: string): void {
    document.body.dataset.way = tab;
    for (const one of this.tabs) one.setAttribute('aria-pressed', String(one.textContent!.toLowerCase() === tab));
  }

  private drive(): void {
    const {plan} = this, why = plan ? this.screen.whyNot(plan) : 'no plan is open';
    if (why) toast(why);
    else this.screen.drive(plan!);
  }

  private save(): void {
    const {picture, plan} = this;
    if (!picture || !plan || this.drawn < 0) return toast('nothing is drawn yet');
    void this.screen.guarded(async () => this.screen.save(await picture.save(`${this.command()}  # step ${this.drawn}`), `${this.title}-${this.drawn}`.replace(/\W+/g, '-')));
  }
}

/** The server sends the solids one after the other, in the order of the scene. */
export function solidsOf(plan: Plan, bytes: ArrayBuffer): Solids {
  const all: Json[] = plan.scene.solids, corners = all.reduce((sum, {vertices}) => sum + vertices, 0);
  return {positions: new Float32Array(bytes, 0, 3 * corners), indices: new Uint32Array(bytes, 12 * corners), counts: all.map(({triangles}) => triangles)};
}
