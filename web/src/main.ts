// The shell: what is open, what the sliders say, and who is told when an answer comes.
import './app.css';
import {type Json, Newest, Refused, Robot, robots, robotText, version} from './client';
import {command} from './command';
import {Connection} from './connection';
import {FileTab} from './file';
import {describe, type Described, fields, forward, inputsOf, inverse, poseOf, velocities} from './rows';
import {Scene, type View} from './scene';
import {Sliders} from './sliders';
import {Tabs} from './tabs';
import {type System, unitName} from './units';
import {Panel} from './verdict';

const byId = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;
const themes = ['auto', 'day', 'dark'];
const protocol = 1;

class Page {
  private robot: Robot | null = null;
  private described: Described | null = null;
  private name = '';
  private system: System = 'mm';
  private last: Json | null = null;
  private lastShape: Json | null = null;
  private count = 0;
  private linked = 0;
  private readonly newest = new Newest();
  private readonly connection = new Connection((text) => this.say(text), () => this.robot ? this.ask() : location.reload());
  private readonly scene = new Scene(byId('view'));
  private readonly panel = new Panel(byId('answer'));
  private readonly sliders = new Sliders(byId('inputs'), () => this.ask(), this.system);
  private readonly poses = new Sliders(byId('pose'), () => this.askInverse(), this.system);
  private readonly loads = new Sliders(byId('load'), () => this.ask(), this.system);
  private readonly tabs = new Tabs(byId('tabs'), ['inputs', 'pose', 'load', 'file'].map((id) => byId(id)), (id) => this.turnTo(id));
  private readonly file = new FileTab(byId('file'), (robot) => this.use(robot, this.sliders.values));
  private readonly picker = byId<HTMLSelectElement>('robot');

  async start(): Promise<void> {
    Object.assign(window, {__sinew: {scene: this.scene}});  // frames are counted in tests
    this.listen();
    this.paint();
    const says = await version();
    if (says.protocol !== protocol)
      return this.say(`page and program differ (protocol ${protocol}, ${says.protocol}): reload`);
    const {robots: shipped, opened} = await robots();
    for (const {name, title} of shipped) this.picker.add(new Option(title, name));
    if (opened && !shipped.some((one) => one.name === opened.name)) this.picker.add(new Option(opened.name, ''));
    const link = new URLSearchParams(location.hash.slice(1)), values = link.get('inputs')?.split(',').map(Number);
    const wanted = link.get('robot');
    if (opened && (!wanted || wanted === opened.name)) await this.open(opened.name, opened.text, values ?? null);
    else await this.choose(wanted ?? shipped[0]!.name, values ?? null);
  }

  private listen(): void {
    this.picker.addEventListener('change', () => void this.choose(this.picker.value, null));
    byId('units').addEventListener('click', () => this.toggleUnits());
    byId('theme').addEventListener('click', () => this.nextTheme());
    byId('copy').addEventListener('click', () => void navigator.clipboard.writeText(byId('command').textContent ?? ''));
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.paint());
    document.addEventListener('keydown', (event) => this.key(event));
    window.addEventListener('dragover', (event) => event.preventDefault());
    window.addEventListener('drop', (event) => {
      event.preventDefault();
      const file = event.dataTransfer?.files[0];
      if (file) void file.text().then((text) => this.open(file.name, text, null));
    });
  }

  private key(event: KeyboardEvent): void {
    if (event.target instanceof HTMLInputElement || event.target instanceof HTMLTextAreaElement || event.ctrlKey || event.metaKey || event.altKey) return;
    const views: Record<string, View> = {1: 'side', 2: 'top', 3: 'front', 4: 'tip'};
    const view = views[event.key];
    if (event.key === 'u') this.toggleUnits();
    else if (event.key === 'd') this.nextTheme();
    else if (event.key === 'f') this.scene.fit(this.described?.isPlanar ?? false);
    else if (event.key === '/') this.picker.focus();
    else if (view && this.described && !this.described.isPlanar) this.scene.fit(false, view);
    else return;
    event.preventDefault();
  }

  private async choose(name: string, values: number[] | null): Promise<void> {
    await this.guarded(async () => this.open(name, await robotText(name), values));
  }

  private async open(name: string, text: string, values: number[] | null): Promise<void> {
    await this.guarded(async () => {
      const robot = await Robot.open(text);
      this.name = name;
      this.picker.value = [...this.picker.options].some((option) => option.value === name) ? name : '';
      await this.use(robot, values);
    });
  }

  /** The robot of the page from now on; values of another number of inputs are not its. */
  private async use(robot: Robot, values: number[] | null): Promise<void> {
    const described = await describe(robot);
    [this.robot, this.described, this.last, this.lastShape] = [robot, described, null, null];
    this.scene.clear();
    this.sliders.show(described.rows, values?.length === described.rows.length ? values : null);
    this.poses.show(described.poseRows, null);
    this.loads.show(described.loadRows, null);
    this.tabs.offer('load', described.loadRows.length > 0);
    this.file.show(robot.text);
    this.ask();
  }

  private ask(): void {
    const values = [...this.sliders.values];
    this.newest.put(() => this.guarded(() => this.answer(values)));
  }

  /** The pose begins where the inputs have brought the robot. */
  private turnTo(tab: string): void {
    const pose = this.described && this.last && poseOf(this.described, this.last);
    if (tab === 'pose' && pose) this.poses.put(pose);
  }

  private load(): Json {
    return this.loads.values.some((part) => part !== 0) ? {wrench: this.loads.values} : {};
  }

  private askInverse(): void {
    const values = [...this.poses.values];
    this.newest.put(() => this.guarded(() => this.answerInverse(values)));
  }

  /** Inputs for a pose; where there are none the last solved shape stays and the panel says why. */
  private async answerInverse(values: number[]): Promise<void> {
    const {robot, described} = this;
    if (!robot || !described) return;
    const [answer] = await robot.ask([{...inverse(described, values, this.last), ...this.load()}]), inputs = inputsOf(described, answer!);
    if (robot !== this.robot) return;
    const solved = (answer!.status === 'converged' || answer!.status === 'unstable') && inputs;
    if (solved) {
      this.last = {...this.last, ...answer};
      this.sliders.put(inputs);
      return this.answer(inputs);
    }
    this.panel.show(answer!, this.system);
    if (this.lastShape) this.draw(described, this.lastShape, false);
    this.told(answer!);
  }

  private told(answer: Json, took?: number): void {
    byId('link').className = 'dot on';
    document.documentElement.dataset.answers = String(++this.count);  // what tests wait for
    const time = took === undefined ? '' : ` · ${took.toFixed(0)} ms`;
    this.say(`${answer.status ?? 'refused'}${time} · ${this.count} answers`);
  }

  private async answer(values: number[]): Promise<void> {
    const {robot, described} = this;
    if (!robot || !described) return;
    const begin = performance.now(), at = {...fields(described, values, this.last), ...this.load()};
    const [answer, shape, velocity] = await robot.ask([forward(described, at), {query: 'shape', ...at}, ...velocities(described, at)]);
    if (robot !== this.robot) return;
    const solved = answer!.status === 'converged' || answer!.status === 'unstable';
    if (solved) this.last = answer!;
    this.draw(described, shape!, solved);
    if (velocity && !velocity.error) Object.assign(answer!, {velocity});
    this.panel.show(answer!, this.system);
    byId('command').textContent = command(this.name, described, values, this.loads.values);
    const took = performance.now() - begin;
    clearTimeout(this.linked);  // browsers slow down pages that write their address all the time
    this.linked = window.setTimeout(() => history.replaceState(null, '', `#robot=${encodeURIComponent(this.name)}&inputs=${values.join(',')}`), 200);
    this.told(answer!, took);
  }

  /** What is not solved is never drawn as if it were: the last solved shape stays, faded. */
  private draw(described: Described, shape: Json, solved: boolean): void {
    const isFirst = !this.lastShape;
    if (solved && shape.backbones) this.lastShape = shape;
    if (!this.lastShape) return;
    const legs: Json[] = described.answer.legs ?? [], radius = (legs[0]?.link.diameter ?? 0.001) / 2;
    const struts = legs.map((leg) => /strut/.test(leg.closure.type));
    this.scene.draw(this.lastShape, radius, struts, !solved);
    if (!isFirst) return;
    this.scene.fit(described.isPlanar);  // which says how thin a rod may be drawn
    this.scene.draw(this.lastShape, radius, struts, !solved);
  }

  private async guarded(task: () => Promise<void>): Promise<void> {
    try {
      await task();
    } catch (error) {
      if (error instanceof Refused) return this.say(error.message);
      if (!(error instanceof TypeError)) throw error;  // fetch says so where nobody answers
      byId('link').className = 'dot lost';
      this.connection.lost();
    }
  }

  private say(text: string): void {
    byId('status').textContent = text;
  }

  private toggleUnits(): void {
    this.system = this.system === 'mm' ? 'SI' : 'mm';
    byId('units').textContent = `${unitName('m', this.system)}, ${unitName('rad', this.system)}`;
    this.sliders.use(this.system);
    this.poses.use(this.system);
    this.loads.use(this.system);
    if (this.last) this.panel.show(this.last, this.system);
  }

  private nextTheme(): void {
    const button = byId('theme');
    button.textContent = themes[(themes.indexOf(button.textContent ?? '') + 1) % themes.length]!;
    this.paint();
  }

  private paint(): void {
    const chosen = byId('theme').textContent;
    const isDark = chosen === 'dark' || (chosen === 'auto' && matchMedia('(prefers-color-scheme: dark)').matches);
    document.documentElement.dataset.theme = isDark ? 'dark' : 'day';
    this.scene.paint(getComputedStyle(document.documentElement));
    if (this.described && this.lastShape) this.draw(this.described, this.lastShape, true);
  }
}

void new Page().start();
