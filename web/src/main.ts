// The shell: what is open, what the sliders say, and who is told when an answer comes.
import './app.css';
import {type Json, Newest, Refused, Robot, robots, robotText, version} from './client';
import {command} from './command';
import {describe, type Described, fields} from './rows';
import {Scene, type View} from './scene';
import {Sliders} from './sliders';
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
  private readonly scene = new Scene(byId('view'));
  private readonly panel = new Panel(byId('answer'));
  private readonly sliders = new Sliders(byId('inputs'), () => this.ask(), this.system);
  private readonly picker = byId<HTMLSelectElement>('robot');

  async start(): Promise<void> {
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
    if (event.target instanceof HTMLInputElement || event.ctrlKey || event.metaKey || event.altKey) return;
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
      const robot = await Robot.open(text), described = await describe(robot);
      [this.robot, this.described, this.name, this.last, this.lastShape] = [robot, described, name, null, null];
      this.picker.value = [...this.picker.options].some((option) => option.value === name) ? name : '';
      this.scene.clear();
      this.sliders.show(described.rows, values?.length === described.rows.length ? values : null);
      this.ask();
    });
  }

  private ask(): void {
    const values = [...this.sliders.values];
    this.newest.put(() => this.guarded(() => this.answer(values)));
  }

  private async answer(values: number[]): Promise<void> {
    const {robot, described} = this;
    if (!robot || !described) return;
    const begin = performance.now(), at = fields(described, values, this.last);
    const [answer, shape] = await robot.ask([{query: 'forward', ...at}, {query: 'shape', ...at}]);
    if (robot !== this.robot) return;
    const solved = answer!.status === 'converged' || answer!.status === 'unstable';
    if (solved) this.last = answer!;
    this.draw(described, shape!, solved);
    this.panel.show(answer!, this.system);
    byId('command').textContent = command(this.name, described, values);
    this.say(`${answer!.status ?? 'refused'} · ${(performance.now() - begin).toFixed(0)} ms · ${++this.count} answers`);
    byId('link').className = 'dot on';
    clearTimeout(this.linked);  // browsers slow down pages that write their address all the time
    this.linked = window.setTimeout(() => history.replaceState(null, '', `#robot=${encodeURIComponent(this.name)}&inputs=${values.join(',')}`), 200);
    document.documentElement.dataset.answers = String(this.count);  // what tests wait for
    Object.assign(window, {__sinew: {answer, scene: this.scene}});
  }

  /** What is not solved is never drawn as if it were: the last solved shape stays, faded. */
  private draw(described: Described, shape: Json, solved: boolean): void {
    const isFirst = !this.lastShape;
    if (solved && shape.backbones) this.lastShape = shape;
    if (!this.lastShape) return;
    const link = described.answer.legs?.[0]?.link;
    this.scene.draw(this.lastShape, (link?.diameter ?? 0.001) / 2, !solved);
    if (isFirst) {
      this.scene.fit(described.isPlanar);
      this.scene.draw(this.lastShape, (link?.diameter ?? 0.001) / 2, !solved);
    }
  }

  private async guarded(task: () => Promise<void>): Promise<void> {
    try {
      await task();
    } catch (error) {
      byId('link').className = error instanceof Refused ? 'dot on' : 'dot lost';
      this.say(error instanceof Refused ? error.message : `NO CONNECTION: ${String(error)}`);
    }
  }

  private say(text: string): void {
    byId('status').textContent = text;
  }

  private toggleUnits(): void {
    this.system = this.system === 'mm' ? 'SI' : 'mm';
    byId('units').textContent = `${unitName('m', this.system)}, ${unitName('rad', this.system)}`;
    this.sliders.use(this.system);
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
