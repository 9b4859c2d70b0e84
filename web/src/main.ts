// The page: what is open, what is asked of it, and who is told when an answer comes.
import './app.css';
import {AnswerPanel, withUnit} from './answer';
import {type Json, Newest, Refused, Robot, robots, robotText, type Shipped, version} from './client';
import {command} from './command';
import {Connection} from './connection';
import {Controls} from './controls';
import {describe, type Described} from './described';
import {FileTab} from './file';
import {ghostOf} from './ghost';
import {fillHelp, type Key, listen} from './keys';
import {byId} from './make';
import {margins, startOf} from './margins';
import {forward, hasVelocity, inputsOf, inverse, isSolved, plain, poseOf, shape, velocity} from './questions';
import {makeSheet} from './sheet';
import {Shell} from './shell';
import {type Solution, Solutions} from './solutions';
import {type Shown, Stage, views} from './stage';
import {Start} from './start';
import {fromLink, History, type Side, type State, stateOf, toLink} from './state';
import {Strip, type Touched} from './strip';
import {Tabs} from './tabs';
import {toast} from './toast';
import {VerdictBox, verdictOf} from './verdict';

const protocol = 1;
const rest = 100;  // ms without a change, after which the slower questions are asked

class Page {
  private shipped: Shipped[] = [];
  private robot: Robot | null = null;
  private described: Described | null = null;
  private name = '';
  private state!: State;
  private shown: Shown | null = null;
  private pose: Json | null = null;  // of the platform, last solved: where searches begin
  private touched: Touched = {side: 'inputs', index: 0};
  private count = 0;
  private timer = 0;
  private linked = 0;
  private readonly history = new History();
  private readonly newest = new Newest();
  private readonly later = new Newest();
  private readonly shell = new Shell(() => this.paint());
  private readonly stage = new Stage(() => this.link(), () => this.save());
  private readonly controls = new Controls({
    turn: (side, index, value) => this.turn(side, index, value), change: (part) => this.change(part), bend: (bending) => this.bend(bending), goHome: () => this.goHome(),
  });
  private readonly connection = new Connection(() => this.robot ? this.ask() : location.reload());
  private readonly verdict = new VerdictBox(byId('verdict'), () => this.cancel());
  private readonly numbers = new AnswerPanel(byId('numbers'));
  private readonly tabs = new Tabs(byId('tabs'), ['inputs', 'pose', 'load', 'model', 'file', 'answer'].map((id) => byId(id)), (id) => this.turnTo(id));
  private readonly file = new FileTab(byId('file'), (robot) => this.use(robot, null));
  private readonly strip = new Strip(byId('strip'), (value) => this.turn(this.touched.side, this.touched.index, value));
  private readonly solutions = new Solutions(byId('solutions'), (solution) => this.jump(solution));
  private readonly start = new Start(byId('start'), (name) => void this.choose(name));
  private readonly picker = byId<HTMLSelectElement>('robot');
  private readonly against = byId<HTMLSelectElement>('against');

  async begin(): Promise<void> {
    Object.assign(window, {__sinew: {scene: this.stage.picture, file: this.file, answer: () => this.shown?.answer}});  // for tests
    this.listen();
    this.paint();
    await this.guarded(async () => {
      const link = new URLSearchParams(location.hash.slice(1)), wanted = link.get('robot');
      const [says, {robots: shipped, opened}] = await Promise.all([version(), robots()]);
      if (says.protocol !== protocol) return this.shell.say(`page and program differ (protocol ${protocol}, ${says.protocol}): reload`);
      this.shipped = shipped;
      for (const {name, title} of shipped) for (const list of [this.picker, this.against]) list.add(new Option(title, name));
      this.against.add(new Option('nothing', ''), 0);
      this.against.value = '';
      if (opened && (!wanted || wanted === opened.name)) return this.open(opened.name, opened.text, link);
      if (this.ships(wanted)) return this.choose(wanted!, link);
      if (wanted) this.shell.say(`the link shows ${wanted}: open its file`);
      this.start.show(shipped);
    });
  }

  private keys(): Key[] {
    const on = (keys: string[], says: string, go: (key: string) => void): Key => ({keys, says, go});
    const {picture} = this.stage;
    return [
      on(['/'], 'choose a robot', () => this.picker.focus()),
      on(['h'], 'home', () => this.goHome()),
      on(['g'], 'keep this pose as a ghost, or let it go', () => this.keep()),
      on(['Ctrl+z'], 'undo', () => this.back(this.history.undo(this.state))),
      on(['Ctrl+Shift+z', 'Ctrl+y'], 'redo', () => this.back(this.history.redo(this.state))),
      on(['Ctrl+c'], 'copy the command, where nothing is selected', () => this.copyCommand()),
      on(['c'], 'copy the pose', () => this.copyPose()),
      on(['f'], 'all in view', () => picture.fit()),
      on(views.map(([key]) => key), 'from the side, above, the front, the tip', (key) => this.stage.view(views.find(([of]) => of === key)![1])),
      on(['o'], 'parallel lines stay parallel, or not', () => picture.toggleProjection()),
      on(['p'], 'save the picture', () => this.save()),
      on(['u'], 'units', () => this.shell.toggleUnits()),
      on(['d'], 'day or dark', () => this.shell.nextTheme()),
      on(['['], 'the panel of what is asked', () => this.shell.toggleLeft()),
      on([']'], 'the panel of the answer', () => this.shell.toggleDrawer()),
      on(['Alt+1'], 'this screen', () => this.tabs.open('inputs')),
      on(['?'], 'these keys', () => this.shell.help()),
      on(['Escape'], 'close what is on top', () => this.shell.toggleDrawer(false)),
      {keys: ['← →'], says: 'in a slider 1 % of its range, with Shift 10 %, with Alt 0.1 %; Home and End its limits, 0 its home, a digit opens the number box'},
      {keys: ['← → ↑ ↓', '+ −'], says: 'in the picture: turn it, zoom'},
    ];
  }

  private listen(): void {
    const keys = this.keys(), chooser = byId<HTMLInputElement>('chooser');
    listen(keys);
    fillHelp(byId('keys'), keys);
    makeSheet(byId('left'), byId('handle'));
    this.stage.picture.grabbed = (position) => this.drag(position);
    this.picker.addEventListener('change', () => void this.choose(this.picker.value));
    this.against.addEventListener('change', () => void this.guarded(() => this.compare(this.against.value)));
    const clicks: Record<string, () => void> = {
      brand: () => this.start.show(this.shipped), open: () => chooser.click(), copy: () => this.copyCommand(), 'copy-pose': () => this.copyPose(),
      keep: () => this.keep(), home: () => this.goHome(), undo: () => this.back(this.history.undo(this.state)),
    };
    for (const [id, go] of Object.entries(clicks)) byId(id).addEventListener('click', go);
    chooser.addEventListener('change', () => this.openFile(chooser.files?.[0]));
    window.addEventListener('focus', () => void this.guarded(() => this.look()));
    window.addEventListener('hashchange', (event) => void this.follow(new URL(event.newURL).hash));
    window.addEventListener('dragover', (event) => event.preventDefault());
    window.addEventListener('drop', (event) => {
      event.preventDefault();
      this.openFile(event.dataTransfer?.files[0]);
    });
  }

  // What is open

  private turnTo(tab: string): void {
    document.body.dataset.tab = tab;
    if (tab === 'file') void this.guarded(() => this.file.load());
  }

  private ships(name: string | null): boolean {
    return this.shipped.some((one) => one.name === name);
  }

  private async choose(name: string, link = new URLSearchParams()): Promise<void> {
    await this.guarded(async () => {
      const opened = this.ships(name) ? {name, text: await robotText(name)} : (await robots()).opened;
      if (opened) await this.open(opened.name, opened.text, link);
    });
  }

  private openFile(file: File | undefined): void {
    if (file) void file.text().then((text) => this.open(file.name, text, new URLSearchParams()));
  }

  private async open(name: string, text: string, link: URLSearchParams): Promise<void> {
    await this.guarded(async () => {
      const robot = await Robot.open(text);
      if (![...this.picker.options].some((option) => option.value === name)) this.picker.add(new Option(name, name));
      this.picker.value = this.name = name;
      this.stage.ghost = null;
      this.against.value = '';
      this.history.clear();
      this.file.show(name, text);
      await this.use(robot, link);
    });
  }

  /** The robot of the page from now on. @param link null: another text of the same file, so its state stays */
  private async use(robot: Robot, link: URLSearchParams | null): Promise<void> {
    const described = await describe(robot), before = this.described;
    const fits = before && (['inputs', 'pose', 'load'] as const).every((side) => before[side].length === described[side].length);
    [this.robot, this.described, this.shown, this.pose] = [robot, described, null, null];
    this.state = link ? fromLink(link, described) : fits ? this.state : stateOf(described);
    if (!described.models.includes(this.state.model)) this.state.model = described.answer.model;
    this.touched = {side: this.state.asked, index: 0};
    this.start.hide();
    this.strip.clear();
    this.solutions.clear();
    this.stage.clear(link ? link.get('camera') ?? '' : null);
    if (link) this.stage.fromLink(link);
    this.tabs.offer('load', described.load.length > 0);
    this.spread();
    this.ask();
  }

  /** The opened file may have changed on disk. */
  private async look(): Promise<void> {
    if (!this.robot || this.ships(this.name)) return;
    const {opened} = await robots();
    if (opened?.name === this.name) this.file.changedOnDisk(opened.text);
  }

  /** A link that was put into the address by hand; what the page writes there may have come between. */
  private async follow(hash: string): Promise<void> {
    const link = new URLSearchParams(hash.slice(1));
    clearTimeout(this.linked);
    if (this.ships(link.get('robot'))) await this.choose(link.get('robot')!, link);
  }

  // What is asked

  private turn(side: Side | 'load', index: number, value: number): void {
    const values = [...this.state[side]];
    values[index] = value;
    this.touched = {side, index};
    this.change({[side]: values, ...(side !== 'load' && {asked: side}), ...(side === 'inputs' && {bending: null})}, false);
    this.controls.put(side, values);
  }

  /** @param isWhole whether all of the controls have to be written anew */
  private change(part: Partial<State>, isWhole = true): void {
    if (!this.described) return;
    this.history.keep(this.state);
    Object.assign(this.state, part);
    if (isWhole) this.spread();
    this.controls.mark(this.state.asked);
    this.ask();
  }

  private spread(): void {
    if (this.described) this.controls.show(this.described, this.state);
  }

  private goHome(): void {
    if (!this.described) return;
    const {pose, inputs} = stateOf(this.described);
    this.pose = null;
    this.change({...(this.state.asked === 'pose' ? {pose} : {inputs}), bending: null});
  }

  private bend(bending: number[] | null): void {
    this.pose = null;  // another branch: nothing of this one is a start
    this.change({bending, asked: 'pose'});
  }

  private back(state: State | null): void {
    if (!state) return toast('nothing more to undo or redo');
    this.state = state;
    this.spread();
    this.ask();
  }

  private jump({inputs, pose}: Solution): void {
    this.pose = pose;
    this.change(this.state.asked === 'pose' ? {inputs, bending: null} : {});
    toast('jumped to another solution: no path was followed there');
  }

  /** Where the hand drags the platform is the pose that is asked. */
  private drag(position: number[]): void {
    const {described, state} = this;
    if (!described) return;
    const pose = [...state.pose], held = described.isHeldByFew ? [position[2]!] : position.slice(0, described.isPlanar ? 2 : 3);
    held.forEach((value, i) => { pose[i] = value; });
    if (pose.every((value, i) => value === state.pose[i])) return;
    this.touched = {side: 'pose', index: 0};
    this.change({pose, asked: 'pose'}, false);
    this.controls.put('pose', pose);
  }

  private ask(): void {
    clearTimeout(this.timer);
    this.strip.cancel();
    this.newest.put(() => this.guarded(() => this.answer()));
  }

  private cancel(): void {
    this.newest.drop();
    this.robot?.cancel();
    this.verdict.settle();
    this.shell.say('cancelled');
  }

  private async answer(): Promise<void> {
    const {robot, described} = this, state = structuredClone(this.state), begin = performance.now();
    if (!robot || !described) return;
    this.verdict.wait();
    let start = this.pose ?? undefined;
    if (state.asked === 'pose') {
      const [found] = await robot.ask([inverse(described, state)]) as [Json], inputs = inputsOf(described, found);
      if (robot !== this.robot) return;
      if (!isSolved(found) || !inputs) return this.unsolved(found, begin);
      state.inputs = inputs;
      start = found.pose;
    }
    // Where the first of them ended. Rods come to rest in more ways than a pose can tell: they go the same way again.
    const there = start && (state.model === 'rod' ? start : 'last');
    const queries = [forward(described, state, start), shape(described, state, there), ...(hasVelocity(state) ? [velocity(described, state, there)] : [])];
    const [answer, picture, speed] = await robot.ask(queries) as [Json, Json, Json?];
    if (robot !== this.robot) return;
    if (!isSolved(answer) || !picture.backbones) return this.unsolved(picture.error && !answer.error ? picture : answer, begin);
    this.solved({...answer, ...(speed && !speed.error && {velocity: speed})}, picture, state, begin);
  }

  private solved(answer: Json, picture: Json, state: State, begin: number): void {
    const described = this.described!, pose = poseOf(described, answer);
    this.pose = answer.pose ? plain(answer.pose) : null;
    this.shown = {described, state, answer, shape: picture, isStale: false};
    if (state.asked === this.state.asked) {  // else the other side was touched in the meantime
      if (state.asked === 'pose') this.controls.put('inputs', this.state.inputs = state.inputs);
      else if (pose) this.controls.put('pose', this.state.pose = pose);
    }
    byId('hint').hidden = true;
    this.tell(answer, begin);
    this.link();
    this.rest((now) => this.more(now));
  }

  /** What is not solved is never drawn as if it were: the last solved picture stays, faded. */
  private unsolved(answer: Json, begin: number): void {
    const hint = byId('hint');
    if (this.shown) this.shown.isStale = true;
    this.tell(answer, begin);
    hint.textContent = `${verdictOf(answer).word}: ${answer.error?.message ?? answer.message ?? ''}`;
    hint.hidden = false;
    this.rest((now) => this.wayOut(now));
  }

  private rest(then: (state: State) => Promise<void>): void {
    const {count} = this;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.later.put(() => this.guarded(async () => {
      await then(structuredClone(this.state));
      document.documentElement.dataset.rests = String(count);  // what tests wait for
    })), rest);
  }

  /** The slower questions, when nothing moves. */
  private async more(state: State): Promise<void> {
    const {robot, described, shown, touched} = this;
    if (!robot || !described || !shown) return;
    await this.strip.ask(robot, described, state, touched, this.pose);
    const found = await margins(robot, described, state, shown.answer, touched.side === 'inputs' ? touched.index : 0);
    if (shown !== this.shown) return;
    const {name, unit} = described[touched.side][touched.index]!, here = state[touched.side][touched.index]!;
    Object.assign(shown.answer, found, {room: this.strip.room().map(({word, to}) => ({name, unit, word, by: to - here}))});
    this.write();
    const start = await startOf(robot, described, state, shown.answer);
    if (shown !== this.shown) return;
    this.command(start);
    await this.solutions.offer(robot, described, state, this.pose);
  }

  /** The value nearest to what has no solution, as a button. */
  private async wayOut(state: State): Promise<void> {
    const {robot, described, shown, touched: {side, index}} = this, row = described?.[side][index];
    if (!robot || !described || !shown || !row) return;
    const from = shown.state[side][index] ?? row.home, values = state[side].map((value, i) => (i === index ? from : value));
    await this.strip.ask(robot, described, {...state, [side]: values}, this.touched, this.pose);
    const value = this.strip.nearest(state[side][index]!);
    if (value !== null) this.verdict.offer(`Go to ${row.name} = ${withUnit(value, row.unit, this.shell.system)}`, () => this.turn(side, index, value));
  }

  // What is shown

  private tell(answer: Json, begin: number): void {
    const parts: string[] = [];
    if (answer.residual !== undefined) parts.push(`residual ${answer.residual.toExponential(1)}`);
    if (answer.iterations !== undefined) parts.push(`${answer.iterations} ${answer.iterations === 1 ? 'iteration' : 'iterations'}`);
    this.stage.draw(this.shown);
    this.verdict.show(answer, parts.join(' · '));
    this.write();
    this.command(null);
    this.shell.connected(true);
    document.documentElement.dataset.answers = String(++this.count);  // what tests wait for
    this.shell.say(`${answer.status ?? 'refused'} · ${(performance.now() - begin).toFixed(0)} ms · ${this.count} answers`);
  }

  private write(): void {
    const {described, shown, state} = this;
    if (!described || !shown) return;
    byId('answer').classList.toggle('stale', shown.isStale);
    this.numbers.show(shown.answer, described, shown.state, this.stage.ghost?.answer ?? null, this.shell.system);
    this.controls.showBending(described, state, shown.answer);
  }

  private command(start: number[] | null): void {
    byId('command').textContent = command(this.name, this.described!, this.state, start, this.shown?.answer.pose?.quaternion ?? null);
  }

  /** The address says what is shown; browsers slow down pages that write it all the time. */
  private link(): void {
    clearTimeout(this.linked);
    this.linked = window.setTimeout(() => {
      if (!this.described) return;
      const link = toLink(this.name, this.state, this.described);
      this.stage.toLink(link);
      history.replaceState(null, '', `#${link.toString().replaceAll('%2C', ',')}`);
    }, 200);
  }

  private paint(): void {
    const {system} = this.shell;
    this.stage.paint(system);
    this.controls.use(system);
    this.strip.use(system);
    this.write();
  }

  private keep(): void {
    if (!this.shown) return;
    const isKept = this.stage.ghost?.name === '';
    this.stage.ghost = isKept ? null : {name: '', answer: this.shown.answer, shape: this.shown.shape};
    this.haunt();
    toast(isKept ? 'the ghost is gone' : 'this pose is kept as a ghost');
  }

  private async compare(name: string): Promise<void> {
    this.stage.ghost = name ? await ghostOf(name, this.state) : null;
    if (name && !this.stage.ghost) this.shell.say(`${name} has no solution here to compare with`);
    this.haunt();
  }

  /** The ghost is another one now. */
  private haunt(): void {
    this.against.value = this.stage.ghost?.name ?? '';
    byId('keep').setAttribute('aria-pressed', String(this.stage.ghost?.name === ''));
    this.stage.draw();
    this.write();
  }

  private copyCommand(): void {
    void navigator.clipboard.writeText(byId('command').textContent ?? '').then(() => toast('command copied'));
  }

  private copyPose(): void {
    const pose = this.shown?.answer.pose ?? this.shown?.answer.tip;
    if (pose) void navigator.clipboard.writeText(JSON.stringify(plain(pose))).then(() => toast('pose copied, in metres and radians'));
  }

  private save(): void {
    void this.stage.save(this.name, byId('command').textContent ?? '');
  }

  private async guarded(task: () => Promise<unknown>): Promise<void> {
    try {
      await task();
    } catch (error) {
      this.verdict.settle();
      if (error instanceof DOMException && error.name === 'AbortError') return;
      if (error instanceof Refused) return this.shell.say(error.message);
      if (!(error instanceof TypeError)) throw error;  // fetch says so where nobody answers
      this.shell.connected(false);
      this.connection.lost();
    }
  }
}

void new Page().begin();
