// The page: what is open, what is asked of it, and who is told when an answer comes.
import './app.css';
import './operate/operate.css';
import {AnswerPanel, withUnit} from './answer';
import {canPlace, fromShape, type Held, heldIn} from './arm';
import {type Changed, type Json, Lost, Newest, type Opened, Refused, Robot, plan as planOf, plans, robots, robotText, type Shipped, version} from './client';
import {copy} from './clipboard';
import {command} from './command';
import {Connection} from './connection';
import {Controls} from './controls';
import {bearsLoad, describe, type Described, holding} from './described';
import {download, FileTab} from './file';
import {Rival} from './ghost';
import {fillHelp, type Key, listen} from './keys';
import {byId} from './make';
import {margins, startOf} from './margins';
import {everything, inputsOf, isSolved, plain, poseOf, sensing, told} from './questions';
import {here, most as mostTurns, walked} from './remembered';
import {type ScreenName, Screens} from './screens';
import {findDevice} from './operate/device';
import type {DeviceInfo} from './operate/frame';
import {Operate} from './operate/operate';
import {isPhone} from './operate/phone';
import {wayOf} from './operate/plan_way';
import {Recording, Unreadable} from './operate/recording';
import {listRecordings, recordingText, RecordingsDialog} from './operate/recordings';
import {Plan} from './plan';
import {makeSheet} from './sheet';
import {Shell} from './shell';
import {type Solution, Solutions} from './solutions';
import {changesIn, drafts, keyOf, Source, sourceOf} from './source';
import {type Shown, Stage, views} from './stage';
import {Start} from './start';
import {fromLink, heldByLink, History, numbersOf, type Side, type State, stateOf, toLink} from './state';
import {Strip, type Touched} from './strip';
import {Tabs} from './tabs';
import {toast} from './toast';
import {shownValue, unitName} from './units';
import {Trajectory} from './trajectory';
import {VerdictBox, verdictOf, type Way} from './verdict';

const protocol = 1;
const rest = 100;  // ms without a change, after which the slower questions are asked
const farthest = 3;  // standard deviations by which what was seen may differ from what a force explains
const longest = 16;  // s between tries of a server that is busy

class Page {
  private shipped: Shipped[] = [];
  private robot: Robot | null = null;
  private described: Described | null = null;
  private source: Source | null = null;
  private state!: State;
  private shown: Shown | null = null;
  private rival: Rival | null = null;
  private touched: Touched = {side: 'inputs', index: 0};
  private opening = 0;   // how often a robot was asked for: only the last of them is shown
  private question = 0;  // how often the state has changed
  private answered = 0;  // the question that was answered last
  private leaps = 0;     // how often it was not the next step from where it was: then older answers lead nowhere
  private tries = 0;     // of a server that is busy
  private count = 0;
  private timer = 0;
  private trying = 0;
  private linked = 0;
  private readonly history = new History();
  private readonly newest = new Newest();
  private readonly later = new Newest();
  private readonly shell = new Shell(() => this.paint());
  private readonly stage = new Stage(() => this.link(), () => this.save());
  private readonly controls = new Controls({
    turn: (side, index, value) => this.turn(side, index, value), change: (part) => this.change(part), bend: (bending) => this.bend(bending), hold: (held) => this.hold(held), sense: (place) => this.sense(place), goHome: () => this.goHome(),
    release: () => this.history.end(),
  });
  private readonly connection = new Connection();
  private readonly rivals = new Newest();
  private readonly verdict = new VerdictBox(byId('verdict'), () => this.cancel());
  private readonly numbers = new AnswerPanel(byId('numbers'));
  private readonly tabs = new Tabs(byId('tabs'), ['inputs', 'pose', 'load', 'model', 'file', 'answer'].map((id) => byId(id)), (id) => this.turnTo(id));
  private readonly file = new FileTab(byId('file'), {
    opened: (robot) => this.edit(robot), based: (base) => this.rebase(base), guarded: (task, again) => this.guarded(task, again),
  });
  private readonly strip = new Strip(byId('strip'), (value) => this.turn(this.touched.side, this.touched.index, value));
  private readonly solutions = new Solutions(byId('solutions'), (solution) => this.jump(solution));
  private readonly start = new Start(byId('start'), (name) => void this.choose(name), (task, again) => this.guarded(task, again));
  private way: Trajectory | null = null;
  private panel!: Operate;
  private device: DeviceInfo | null = null;
  private readonly recordings = new RecordingsDialog((name) => void this.replay(name), () => byId<HTMLInputElement>('chooser').click());
  private replaying = 0;  // how often a recording was asked for
  private opened: Opened | null = null;  // the file that the server was started with
  private readonly screens = new Screens((name, isAsWas, before) => this.turnScreen(name, isAsWas, before));
  private readonly picker = byId<HTMLSelectElement>('robot');
  private readonly against = byId<HTMLSelectElement>('against');

  async begin(): Promise<void> {
    Object.assign(window, {__sinew: {scene: this.stage.picture, file: this.file, answer: () => this.shown?.answer}});  // for tests
    this.listen();
    this.paint();
    await this.guarded(() => this.enter(), () => location.reload());
  }

  private async enter(): Promise<void> {
    const link = new URLSearchParams(location.hash.slice(1) || location.search), wanted = link.get('robot');
    const [says, {robots: shipped, opened}, {plans: listed}, device, recorded] = await Promise.all([version(), robots(), plans(), findDevice(), listRecordings()]);
    if (says.protocol !== protocol) return this.shell.refuse(`page and program differ (protocol ${protocol}, ${says.protocol}): reload`);
    [this.shipped, this.device, this.opened] = [shipped, device, opened];
    this.panel = new Operate({system: () => this.shell.system, guarded: (task, again) => this.guarded(task, again), heard: () => this.heard(), linked: () => this.link(), turned: () => this.turnSource(), plans: () => listed, way: (plan, to) => this.showRecorded(plan, to)}, device);
    byId('recordings').hidden = !recorded || (recorded.length === 0 && !device);
    for (const {name, title} of shipped) for (const list of [this.picker, this.against]) list.add(new Option(title, name));
    this.against.add(new Option('nothing', ''), 0);
    this.against.value = this.picker.value = '';
    if (listed.length > 0) this.offerPlans(listed);
    if (link.has('recording')) {
      if (opened) await this.open(opened.name, opened.text, new URLSearchParams({screen: 'design'}));
      return this.replay(link.get('recording')!, link);
    }
    if (this.isOfSliders(link)) return this.resume(link);
    if (this.way && (link.has('plan') || (!wanted && !opened))) return this.showPlan(link);
    if (link.has('plan')) this.shell.say('the link shows a plan: start sinew serve with --scene and --plan');
    if (opened && (!wanted || wanted === opened.name)) return this.open(opened.name, opened.text, link);
    if (this.ships(wanted)) return this.choose(wanted!, link);
    const draft = wanted ? drafts.of(wanted) : null;
    if (draft && draft.key === keyOf(link)) return this.open(wanted!, draft.base, link);
    if (wanted) this.shell.say(`the link shows ${wanted}: open its file`);
    this.start.show(shipped);
  }

  /** Those of the screen that is shown. */
  private keys(): Key[] {
    const on = (keys: string[], says: string, go: (key: string) => void): Key => ({keys, says, go}), isDesign = this.screens.shown === 'design', {offered} = this.screens;
    return [
      ...(isDesign ? this.designKeys() : this.screens.shown === 'operate' ? this.panel.keys() : this.way!.keys()),
      ...(Object.keys(offered).length > 0 ? [on(Object.keys(offered), `the screens ${Object.values(offered).join(', ')}`, (key) => this.screens.show(offered[key]!))] : []),
      on(['Ctrl+c'], 'copy the command, where nothing is selected', () => this.copyCommand()),
      on(['u'], 'units', () => this.shell.toggleUnits()),
      on(['d'], 'day or dark', () => this.shell.nextTheme()),
      on(['?'], 'these keys', () => this.help()),
      ...(isDesign ? [{keys: ['← →'], says: 'in a slider 1 % of its range, with Shift 10 %, with Alt 0.1 %; Home and End its limits, 0 its home, a digit opens the number box'}] : []),
      {keys: ['← → ↑ ↓', '+ −'], says: 'in the picture: turn it, zoom'},
    ];
  }

  private help(): void {
    fillHelp(byId('keys'), this.keys());
    this.shell.help();
  }

  private designKeys(): Key[] {
    const on = (keys: string[], says: string, go: (key: string) => void): Key => ({keys, says, go});
    const {picture} = this.stage;
    return [
      on(['/'], 'choose a robot', () => this.picker.focus()),
      on(['h'], 'home', () => this.goHome()),
      on(['g'], 'keep this pose as a ghost, or let it go', () => this.keep()),
      on(['Ctrl+z'], 'undo', () => this.back(this.history.undo(this.state))),
      on(['Ctrl+Shift+z', 'Ctrl+y'], 'redo', () => this.back(this.history.redo(this.state))),
      on(['c'], 'copy the pose', () => this.copyPose()),
      on(['f'], 'all in view', () => picture.fit()),
      on(views.map(([key]) => key), 'from the side, above, the front, the tip', (key) => this.stage.view(views.find(([of]) => of === key)![1])),
      on(['o'], 'parallel lines stay parallel, or not', () => picture.toggleProjection()),
      on(['p'], 'save the picture', () => this.save()),
      on(['['], 'the panel of what is asked', () => this.shell.toggleLeft()),
      on([']'], 'the panel of the answer', () => this.shell.toggleDrawer()),
      on(['Escape'], 'close what is on top', () => this.start.isShown && this.robot ? this.start.hide() : this.shell.toggleDrawer(false)),
    ];
  }

  private listen(): void {
    const chooser = byId<HTMLInputElement>('chooser');
    listen(() => this.keys());
    byId('help').addEventListener('click', () => this.help());
    makeSheet(byId('left'), byId('handle'));
    this.stage.picture.grabbed = (position, isEnd) => this.drag(position, isEnd);
    this.picker.addEventListener('change', () => void this.choose(this.picker.value));
    this.against.addEventListener('change', () => this.compare(this.against.value));
    const clicks: Record<string, () => void> = {
      brand: () => this.start.isShown && this.robot ? this.start.hide() : this.start.show(this.shipped), open: () => chooser.click(), copy: () => this.copyCommand(), 'copy-pose': () => this.copyPose(),
      recordings: () => void this.guarded(async () => this.recordings.show(await listRecordings() ?? [])),
      keep: () => this.keep(), home: () => this.goHome(), undo: () => this.back(this.history.undo(this.state)), needs: () => this.saveFile(),
    };
    for (const [id, go] of Object.entries(clicks)) byId(id).addEventListener('click', go);
    chooser.addEventListener('change', () => {
      this.openFile(chooser.files?.[0]);
      chooser.value = '';  // the same file again is a change, too
    });
    window.addEventListener('focus', () => void this.guarded(() => this.look()));
    window.addEventListener('error', ({error}) => error && this.failed(error));
    window.addEventListener('unhandledrejection', ({reason}) => this.failed(reason));
    window.addEventListener('hashchange', (event) => void this.follow(new URL(event.newURL).hash));
    window.addEventListener('dragover', (event) => event.preventDefault());
    window.addEventListener('drop', (event) => {
      event.preventDefault();
      this.openFile(event.dataTransfer?.files[0]);
    });
  }

  // Screens

  private offerPlans(listed: Json[]): void {
    this.way = this.makeWay(listed);
    this.screens.offer('trajectory');
  }

  private makeWay(listed: Json[]): Trajectory {
    return new Trajectory(listed, {
      system: () => this.shell.system, say: (text) => this.shell.say(text), heard: () => this.heard(), guarded: (task, again) => this.guarded(task, again),
      changed: () => {
        this.command();
        this.link();
      },
      save: (picture, name) => this.stage.give(picture, name),
      whyNot: (plan) => this.whyNotDriven(plan), drive: (plan) => void this.guarded(() => this.drive(plan)),
    });
  }

  private showRecorded(plan: Plan, link: URLSearchParams): void {
    this.way ??= this.makeWay([]);
    this.screens.offer('trajectory');
    this.screens.show('trajectory', false);
    this.way.openRecorded(plan, link);
    this.badge();
    this.entitle();
  }

  private showPlan(link: URLSearchParams): void {
    this.screens.show('trajectory', false);
    this.way!.open(link);
  }

  /** @param isAsWas as it was left; else a link says what is in it */
  private turnScreen(name: ScreenName, isAsWas: boolean, before: ScreenName): void {
    if (before === 'trajectory') this.way!.leave();
    if (before === 'operate') this.leavePanel();
    if (name === 'operate') this.panel.enter(this.state?.inputs ?? []);
    if (isAsWas && name === 'design' && !this.robot) this.start.show(this.shipped);
    if (isAsWas && name === 'trajectory' && !this.way!.isOpen) this.way!.open(new URLSearchParams());
    this.badge();
    this.entitle();
    this.command();
    this.link();
  }

  /** A plan moves the device that is the same robot; where there is none the arm of sliders. */
  private whyNotDriven(plan: Plan): string {
    const {device} = this;
    if (plan.times) return 'a recording is no plan';
    if (!device) return '';
    if (plan.robot.robot !== device.robot && plan.robot.robot !== device.file) return `the device is another robot than ${plan.robot.name}, of which the plan is: start sinew serve with that`;
    if (isPhone.matches) return 'a phone looks on and holds';
    return plan.status === 'checking' ? 'the plan is being checked: wait until it is' : plan.isGood ? '' : 'the plan touches, or exceeds a limit: see Checks';
  }

  private async drive(plan: Plan): Promise<void> {
    const opened = this.device ? (await robots()).opened : null, {name, text} = opened ?? plan.robot;
    if (this.source?.name !== name || (this.source.isModified && this.source.text !== opened?.changed?.text)) await this.open(name, text, new URLSearchParams({screen: 'operate'}));
    this.screens.show('operate');
    this.panel.load(wayOf(plan));
  }

  /** Of the arm of sliders with a plan. */
  private isOfSliders(link: URLSearchParams): boolean {
    return !this.device && link.get('screen') === 'operate' && !!this.way?.has(link.get('plan'));
  }

  private async resume(link: URLSearchParams): Promise<void> {
    const handle = link.get('plan')!, plan = new Plan(handle, await planOf(handle));
    await this.open(plan.robot.name, plan.robot.text, link);
    this.panel.load(wayOf(plan), Number(link.get('step')));
  }

  private badge(): void {
    const {shown} = this.screens, of = byId('source');
    of.classList.toggle('is-log', shown === 'operate' && !!this.panel.replayed);
    of.title = shown === 'operate' ? this.panel.badge : '';
    of.textContent = shown === 'design' ? 'SLIDERS' : shown === 'operate' ? this.panel.badge : this.way!.badge;
  }

  /** Targets that were set there are the inputs here. */
  private leavePanel(): void {
    const {inputs} = this.panel;
    this.panel.leave();
    if (inputs && inputs.some((value, i) => value !== this.state.inputs[i])) this.change({inputs, asked: 'inputs', bending: null});
  }

  // Recordings

  /** The screen Operate shows another source now. */
  private turnSource(): void {
    const has = !!this.described?.isSerial || !!this.panel?.replayed;
    this.screens.offer('operate', has);
    this.badge();
    this.entitle();
    this.link();
    if (!has && !this.described) this.start.show(this.shipped);
  }

  private async replay(name: string, link: URLSearchParams | null = null): Promise<void> {
    const run = ++this.replaying;
    await this.guarded(async () => {
      try {
        const {text, every} = await recordingText(name);
        if (run === this.replaying) await this.showRecording(name, text, {name, isOnServer: true, every}, link);
      } catch (error) {
        if (!(error instanceof Refused) || error.isBusy) throw error;
        this.recordings.refuse(`${name}: ${error.message}`);
      }
      if (!this.described && !this.panel.replayed) this.start.show(this.shipped);
    }, () => void this.replay(name, link));
  }

  private async showRecording(name: string, text: string, where: {name: string; isOnServer: boolean; every: number}, link: URLSearchParams | null): Promise<void> {
    try {
      if (this.panel.busy) throw new Unreadable(this.panel.busy);
      await this.panel.replay(Recording.read(name, text), where, link);
    } catch (error) {
      if (error instanceof Lost || (error instanceof Refused && error.isBusy)) throw error;
      return this.recordings.refuse(error instanceof Refused ? `${name}, below “# file:”: ${error.message}` : (error as Error).message);
    }
    this.start.hide();
    this.screens.show('operate', false);
    if (link?.get('screen') === 'trajectory') this.panel.showWay(link);
  }

  /** The screen Operate has every serial robot: that of the device, or a simulated one. */
  private offerPanel(link: URLSearchParams | null): void {
    const {robot, described, source, state, screens} = this;
    if (described!.isSerial) {
      const isOfDevice = !!this.device && (robot!.handle === this.device.robot || (source!.name === this.opened?.name && !source!.isModified));
      this.panel.use({robot: robot!, described: described!, source: source!, inputs: [...state.inputs]}, isOfDevice, link);
      screens.offer('operate');
      if (link?.get('screen') === 'operate' || (isOfDevice && link && !link.has('screen') && !link.has('inputs'))) screens.show('operate', false);
    } else {
      screens.offer('operate', false);
      if (link?.get('screen') === 'operate') toast(`Operate shows serial robots that are given as bends; ${source!.label} is shown in Design`);
    }
    if (screens.shown === 'operate' && link?.has('screen') && link.get('screen') !== 'operate') screens.show('design', false);
    this.badge();
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
    const run = ++this.opening;
    await this.guarded(async () => {
      try {
        const opened = this.ships(name) ? {name, text: await robotText(name)} : (this.opened = (await robots()).opened), draft = drafts.of(name);
        if (run !== this.opening) return;
        if (opened?.name === name) await this.open(name, opened.text, link);
        else if (name === this.source?.name) await this.open(name, this.source.base, link);
        else if (draft) await this.open(name, draft.base, link);
        else this.shell.say(`${name} is not here any more: open its file`);
      } finally {
        this.entitle();
      }
    }, () => void this.choose(name, link));
  }

  private openFile(file: File | undefined): void {
    if (!file) return;
    if (/\.csv$/i.test(file.name)) return this.openRecording(file);
    const name = this.ships(file.name) ? `./${file.name}` : file.name, again = (): void => void this.guarded(async () => {
      await this.open(name, await file.text(), new URLSearchParams());
    }, again);
    again();
  }

  private openRecording(file: File): void {
    const run = ++this.replaying, name = file.name.replace(/\.csv$/i, ''), again = (): void => void this.guarded(async () => {
      const text = await file.text();
      if (run === this.replaying) await this.showRecording(file.name, text, {name, isOnServer: false, every: 1}, null);
    }, again);
    again();
  }

  /** @param text of the file, which a link and what was written here before may have changed */
  private async open(name: string, text: string, link: URLSearchParams): Promise<void> {
    const changed = this.changedOf(name, text);
    if (changed && !link.has('set') && !link.has('modified')) for (const set of changed.set) link.append('set', set);
    const run = ++this.opening, draft = drafts.of(name), isGoing = draft?.key === keyOf(link) && (draft.base === text || link.has('modified'));
    const shown = isGoing ? draft.shown : changed && keyOf(link) === changed.set.join('\n') ? changed.text : await this.textOf(text, link);
    if (run !== this.opening) return;
    if (shown === null) {
      this.shell.say(`the link shows another ${name} than is here: open its file`);
      return this.start.show(this.shipped);
    }
    const robot = await Robot.open(shown), described = await describe(robot), source = await sourceOf(name, text, shown, described.answer, changed);
    if (run !== this.opening) return;
    if (![...this.picker.options].some((option) => option.value === name)) this.picker.add(new Option(name, name));
    [this.stage.ghost, this.rival] = [null, null];
    this.haunt();
    this.history.clear();
    this.use(source, robot, described, link);
    this.file.show(source, isGoing ? draft : null, isGoing ? null : draft);
  }

  /** How the server's command line changes this file, if it does. */
  private changedOf(name: string, base: string): Changed | null {
    const {opened} = this;
    return opened?.name === name && opened.text === base ? opened.changed ?? null : null;
  }

  /** The robot's text that a link means; null where it is not to be had. */
  private async textOf(text: string, link: URLSearchParams): Promise<string | null> {
    const changes = changesIn(link);
    if (link.has('modified') || changes.length === 0) return link.has('modified') ? null : text;
    const {withChanges} = await import('./editor.js');
    return withChanges(text, changes);
  }

  /** Another text of the same file: its state stays. */
  private async edit(robot: Robot): Promise<void> {
    const {opening} = this, {name, base} = this.source!, described = await describe(robot), source = await sourceOf(name, base, robot.text, described.answer, this.changedOf(name, base));
    if (opening !== this.opening || robot.text !== this.file.text) return;  // another robot, or more was written
    this.use(source, robot, described, null);
    this.file.shown(source);
  }

  /** The file itself has another text now; the robot that is shown has not. */
  private async rebase(base: string): Promise<void> {
    const {opening} = this, {name, text} = this.source!, source = await sourceOf(name, base, text, this.described!.answer, this.changedOf(name, base));
    if (opening !== this.opening || text !== this.source!.text) return;
    this.source = source;
    this.file.shown(source);
    this.entitle();
    this.command();
    this.link();
  }

  /** The robot of the page from now on. @param link null: another text of the same file, so its state stays */
  private use(source: Source, robot: Robot, known: Described, link: URLSearchParams | null): void {
    const before = this.described, described = link ? heldByLink(link, known) : holding(known, this.state.held), fits = before && (['inputs', 'pose', 'load'] as const).every((side) => before[side].length === described[side].length) && before.isArm === described.isArm;
    this.robot?.cancel();
    [this.source, this.robot, this.described, this.shown] = [source, robot, described, null];
    this.state = link ? fromLink(link, described) : fits ? {...this.state, start: null} : stateOf(described);
    if (!link && !fits) this.history.clear();
    ++this.leaps;
    byId('hint').hidden = true;
    if (!described.models.includes(this.state.model)) this.state.model = described.answer.model;
    this.touched = {side: this.state.asked, index: 0};
    this.start.hide();
    this.entitle();
    this.strip.clear();
    this.solutions.clear();
    this.stage.clear(link ? link.get('camera') ?? '' : null, described.isPlanar);
    this.numbers.clear();
    if (link) this.stage.fromLink(link);
    this.tabs.offer('load', described.load.length > 0);
    this.spread();
    this.offerPanel(link);
    this.ask();
  }

  /** All that names the robot names the one that is shown. */
  private entitle(): void {
    const {source} = this;
    for (const option of this.picker.options) {
      const title = this.shipped.find(({name}) => name === option.value)?.title ?? option.value;
      option.textContent = source?.isModified && option.value === source.name ? `${title} (modified)` : title;
    }
    this.picker.value = source?.name ?? '';
    const isDesign = this.screens.shown === 'design', title = this.screens.shown === 'trajectory' ? this.way?.title : this.screens.shown === 'operate' && this.panel.replayed ? this.panel.replayed.name : source?.label;
    document.title = title ? `${title} – sinew` : 'sinew';
    byId('needs').hidden = !isDesign || !source?.needsFile;
    if (source) byId('needs').textContent = `save ${source.word} first:`;
  }

  private saveFile(): void {
    if (this.source) download(this.source.word, this.source.text);
  }

  /** The opened file may have changed on disk. */
  private async look(): Promise<void> {
    if (!this.source || this.ships(this.source.name)) return;
    const {opened} = await robots();
    if (opened?.name !== this.source?.name) return;
    this.opened = opened;
    this.file.changedOnDisk(opened!.text);
  }

  /** A link that was put into the address by hand; what the page writes there may have come between. */
  private async follow(hash: string): Promise<void> {
    const link = new URLSearchParams(hash.slice(1));
    clearTimeout(this.linked);
    const name = link.get('robot');
    if (this.isOfSliders(link)) return this.guarded(() => this.resume(link), () => void this.follow(hash));
    if (this.way && link.has('plan')) return this.showPlan(link);
    if (link.has('recording')) return this.replay(link.get('recording')!, link);
    if (name && this.screens.shown === 'trajectory') this.screens.show('design', false);
    if (this.ships(name) || (name && name === this.source?.name)) await this.choose(name!, link);
    else if (name) this.shell.say(`the link shows ${name}: open its file`);
  }

  // What is asked

  private turn(side: Side | 'load', index: number, value: number): void {
    const values = [...this.state[side]];
    values[index] = value;
    if (!this.described?.[side][index]?.step) this.touched = {side, index};  // over a count there is no curve
    this.change({[side]: values, ...(side !== 'load' && {asked: side}), ...(side === 'inputs' && {bending: null})}, false, `${side} ${index}`);
    this.controls.put(side, values);
  }

  /**
   * @param isWhole whether all of the controls have to be written anew
   * @param by the control that does it, if it does it bit by bit
   */
  private change(part: Partial<State>, isWhole = true, by = ''): void {
    if (!this.described) return;
    this.history.keep(this.state, by);
    if ('start' in part) ++this.leaps;
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
    this.change({...(this.state.asked === 'pose' ? {pose} : {inputs}), bending: null, start: null});
  }

  private bend(bending: number[] | null): void {
    this.change({bending, asked: 'pose', start: null});  // another branch: nothing of this one is a start
  }

  /** @param isChange whether undo leads back from there */
  private back(state: State | null, isChange = false): void {
    if (!state) return toast('nothing more to undo or redo');
    if (isChange) this.history.keep(this.state);
    this.history.end();
    ++this.leaps;
    this.state = state;
    this.described = this.described && holding(this.described, state.held);
    this.spread();
    this.ask();
  }

  /** Other inputs of an arm, which is where it was: those of what is shown. */
  private hold(held: Held[]): void {
    if (!this.described) return;
    const {shown, state} = this, described = holding(this.described, held), now = shown && heldIn(described, shown.answer);
    const inputs = held.map((of, i) => (of === state.held?.[i] ? state.inputs[i]! : now?.[i] ?? described.inputs[i]!.home));
    this.described = described;
    this.change({held, inputs});
  }

  /** The force that takes an arm's tip to where it was seen becomes its load. */
  private async sense(place: number[]): Promise<string> {
    const {robot, described} = this, state = structuredClone(this.state), {system} = this.shell;
    let why = 'not answered';
    if (robot && described) await this.guarded(async () => {
      const [found] = await robot.ask([sensing(described, state, place)]) as [Json], {wrench, misfit, covariance} = found;
      if (robot !== this.robot) return;
      why = found.error?.message ?? (found.status === 'converged' && misfit < farthest ? '' : `no force at the tip explains it: ${found.message ?? (misfit === undefined ? found.status : `what stays is ${misfit.toPrecision(3)} standard deviations`)}`);
      if (why) return;
      const deviation = Math.sqrt(covariance[0][0] + covariance[1][1] + covariance[2][2]);
      this.change({asked: 'inputs', load: [...wrench, ...state.load.slice(wrench.length)]});
      toast(`${Math.hypot(...wrench.slice(0, 3)).toPrecision(3)} N at the tip, ± ${deviation.toPrecision(2)} N where it is seen to ${withUnit(5e-4, 'm', system)}`);
    });
    return why;
  }

  private jump({inputs, pose}: Solution): void {
    this.change({start: pose, ...(this.state.asked === 'pose' && {inputs, bending: null})});
    toast('jumped to another solution: no path was followed there');
  }

  /** Where the hand drags the platform is the pose that is asked. */
  private drag(position: number[], isEnd: boolean): void {
    const {described, state} = this;
    if (!described || !canPlace(described)) return;
    const pose = [...state.pose], held = described.isHeldByFew ? [position[2]!] : position.slice(0, described.isPlanar ? 2 : 3);
    held.forEach((value, i) => { pose[i] = value; });
    if (pose.some((value, i) => value !== state.pose[i])) {
      this.touched = {side: 'pose', index: 0};
      this.change({pose, asked: 'pose'}, false, 'hand');
      this.controls.put('pose', pose);
    }
    if (isEnd) this.history.end();
  }

  private ask(): void {
    ++this.question;
    clearTimeout(this.timer);
    clearTimeout(this.trying);
    this.strip.cancel();
    this.solutions.old();
    this.wait();
    this.newest.put(() => this.guarded(() => this.answer(), () => this.ask()));
  }

  /** After a while without an answer what is shown is not taken for one. */
  private wait(): void {
    this.verdict.wait(() => this.behind({status: 'solving'}));
  }

  private cancel(): void {
    this.newest.drop();
    this.robot?.cancel();
    clearTimeout(this.timer);
    this.unanswered('cancelled');
    this.shell.say('cancelled');
  }

  private async answer(): Promise<void> {
    const {robot, described, question, leaps} = this, state = structuredClone(this.state), begin = performance.now();
    if (!robot || !described) return;
    this.wait();
    const point = state.path && state.asked === 'inputs' ? here(described, state) : null, path = point && walked(state.path!, point);
    if (path && path.length > mostTurns)
      return this.unsolved({status: 'iteration_limit', message: `the path has ${mostTurns} turns, and as many are followed: forget it to begin anew`}, question, begin);
    const [found] = await robot.ask([everything(described, state, state.start ?? undefined)]) as [Json], answer = told(found);
    if (robot !== this.robot) return;
    if (path) state.path = path;
    const inputs = state.asked === 'pose' ? inputsOf(described, answer) : state.inputs;
    if (!isSolved(answer) || !answer.backbones || !inputs) return this.unsolved(answer, question, begin);
    state.inputs = inputs;
    this.solved(answer, answer, state, question, leaps === this.leaps, begin);
  }

  /** @param isNear whether what is asked by now goes on from here */
  private solved(answer: Json, picture: Json, state: State, question: number, isNear: boolean, begin: number): void {
    const described = this.described!, pose = poseOf(described, answer), {rival} = this;
    if (answer.pose && !described.isArm) state.start = plain(answer.pose);
    if (described.hasArmLegs && state.start) state.start = fromShape(answer) ?? state.start;  // a solution that was chosen is followed
    if (isNear) this.state.start = state.start;
    if (isNear && this.state.path && state.path) this.state.path = structuredClone(state.path);
    if (state.asked === 'inputs' && pose) state.pose = pose;
    this.shown = {described, state, answer, shape: picture, isStale: false, start: undefined};
    if (isNear && state.asked === this.state.asked) {  // else the other side was touched in the meantime
      if (state.asked === 'pose') this.controls.put('inputs', this.state.inputs = [...state.inputs]);
      else if (pose) this.controls.put('pose', this.state.pose = pose);
    }
    byId('hint').hidden = true;
    if (rival) this.meet(rival, this.shown);
    this.tell(answer, question, begin);
    this.rest((now) => this.more(now));
  }

  private unsolved(answer: Json, question: number, begin: number): void {
    if (question !== this.question) return void (this.answered = question);  // something newer is on its way
    if (this.shown) this.shown.isStale = true;
    const {shown} = this, ways: Way[] = [shown ? ['Back to the last solved pose', () => this.back(structuredClone(shown.state), true)] : ['Home', () => this.goHome()]];
    if (verdictOf(answer).state === 'stale') ways.unshift(['Ask again', () => this.ask()]);
    this.tell(answer, question, begin, ways);
    this.hint(answer);
    this.rest((now) => this.wayOut(now, ways));
  }

  /** Nobody has answered what is asked. What is shown is not taken for an answer: the picture and the numbers fade, and a word says so. */
  private behind(answer: Json, ways: Way[] = []): void {
    if (this.question === this.answered || !this.described) return;
    if (this.shown) this.shown.isStale = true;
    this.stage.draw(this.shown);
    this.verdict.show(answer, '', ways);
    this.hint(answer);
    this.write();
    this.command();
    this.link();
  }

  private unanswered(why: string): void {
    this.behind({status: 'not_answered', message: why}, [['Ask again', () => this.ask()]]);
  }

  private hint(answer: Json): void {
    const hint = byId('hint'), why = answer.error?.message ?? answer.message;
    hint.textContent = verdictOf(answer).word + (why ? `: ${why}` : '');
    hint.hidden = false;
  }

  /** @param then is given the number of the question that was answered */
  private rest(then: (question: number) => Promise<void>): void {
    const {count, answered: question} = this, again = () => {
      if (question === this.question) this.rest(then);
    };
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.later.put(() => this.guarded(async () => {
      if (question !== this.question) return;
      await then(question);
      document.documentElement.dataset.rests = String(count);  // what tests wait for
    }, again)), rest);
  }

  /** The slower questions, when nothing moves. */
  private async more(question: number): Promise<void> {
    const {robot, described, shown, touched} = this, isOld = () => question !== this.question || shown !== this.shown;
    if (!robot || !described || !shown || isOld()) return;
    const {state} = shown, start = await startOf(robot, described, state, shown.answer);
    if (isOld()) return;
    shown.start = start;
    this.command();
    this.link();
    if (state.path) return this.strip.clear();  // what it follows does not rub
    await this.strip.ask(robot, described, state, touched, state.start);
    if (isOld()) return;
    const found = await margins(robot, described, state, shown.answer, touched.side === 'inputs' ? touched.index : 0);
    if (isOld()) return;
    const {name, unit} = described[touched.side][touched.index]!, here = state[touched.side][touched.index]!;
    Object.assign(shown.answer, found, {room: this.strip.room().map(({word, to}) => ({name, unit, word, by: to - here}))});
    this.write();
    await this.solutions.offer(robot, described, state, described.hasArmLegs ? plain(shown.answer.pose) : state.start);
  }

  /** The value nearest to what has no solution, as a button. */
  private async wayOut(question: number, ways: Way[]): Promise<void> {
    const {robot, described, shown, state, touched: {side, index}} = this, row = described?.[side][index];
    if (!robot || !described || !shown || !row || state.path) return;
    const from = shown.state[side][index] ?? row.home, values = state[side].map((value, i) => (i === index ? from : value));
    await this.strip.ask(robot, described, {...structuredClone(state), [side]: values}, this.touched, shown.state.start, state[side][index]!);
    if (question !== this.question) return;
    const value = this.strip.nearest(state[side][index]!);
    if (value !== null) this.verdict.offer([[`Go to ${row.name} = ${withUnit(value, row.unit, this.shell.system)}`, () => this.turn(side, index, value)], ...ways]);
  }

  // What is shown

  private tell(answer: Json, question: number, begin: number, ways: Way[] = []): void {
    const parts: string[] = [];
    if (answer.residual !== undefined) parts.push(`residual ${answer.residual.toExponential(1)}${this.residualUnit(answer)}`);
    if (answer.resolution !== undefined) parts.push(`resolution ${shownValue(answer.resolution, 'm', this.shell.system).toExponential(1)} ${unitName('m', this.shell.system)}`);
    if (answer.iterations !== undefined) parts.push(`${answer.iterations} ${answer.iterations === 1 ? 'iteration' : 'iterations'}`);
    this.answered = question;
    this.tries = 0;
    this.stage.draw(this.shown);
    this.verdict.show(answer, parts.join(' · '), ways);
    this.write();
    this.command();
    this.link();
    this.heard();
    document.documentElement.dataset.answers = String(++this.count);  // what tests wait for
    this.shell.say(`${answer.status ?? 'refused'} · ${(performance.now() - begin).toFixed(0)} ms · ${this.count} ${this.count === 1 ? 'answer' : 'answers'}`);
  }

  /** Arms are solved for moments, then for where the tip is. */
  private residualUnit(answer: Json): string {
    if (!this.described?.isArm || this.described.hasArmLegs) return '';
    return answer.query === 'inverse' ? ' of the length, or rad' : ' EI/L';
  }

  private heard(): void {
    this.shell.connected(true);
    this.connection.answered();
  }

  private write(): void {
    const {described, shown, state} = this;
    if (!described || !shown) return;
    byId('answer').classList.toggle('stale', shown.isStale);
    this.numbers.show(shown.answer, described, shown.state, this.stage.ghost, this.shell.system, this.touched.side === 'inputs' ? this.touched.index : 0);
    this.controls.showBending(described, state, shown.answer);
  }

  /** Where a search has to begin so that it ends here: as long as nobody knows whether it has to, it does. */
  private startOf(state: State, known: number[] | null | undefined): number[] | null {
    if (known !== undefined || this.described!.isSerial) return known ?? null;
    if (state.asked === 'inputs') return state.start && numbersOf(state.start);
    return bearsLoad(this.described!, state.model) ? null : state.inputs;
  }

  /** The start of what is asked: known where it is what is shown. */
  private get started(): number[] | null {
    const {shown} = this;
    return this.startOf(this.state, shown && !shown.isStale && this.question === this.answered ? shown.start : undefined);
  }

  private command(): void {
    if (this.screens.shown === 'trajectory') byId('command').textContent = this.way!.command();
    else if (!this.described) byId('command').textContent = '';
    else byId('command').textContent = command(this.source!, this.described, this.state, this.started);
  }

  /** The address says what is shown; browsers slow down pages that write it all the time. */
  private link(): void {
    clearTimeout(this.linked);
    this.linked = window.setTimeout(() => {
      const way = this.screens.shown === 'trajectory' && this.way!.toLink();
      if (way) return this.address(way);
      if (this.screens.shown === 'operate' && this.panel.replayed) {
        const link = new URLSearchParams();
        this.panel.toLink(link);
        if (link.has('recording')) return this.address(link);
      }
      if (!this.described || this.screens.shown === 'trajectory') return;
      const isPanel = this.screens.shown === 'operate', state: State = isPanel ? {...this.state, asked: 'inputs', inputs: this.panel.inputs ?? this.state.inputs} : this.state;
      const link = toLink(this.source!.name, state, this.described, this.started);
      this.source!.toLink(link);
      if (isPanel) this.panel.toLink(link);
      else this.stage.toLink(link);
      this.address(link);
    }, 200);
  }

  private address(link: URLSearchParams): void {
    history.replaceState(null, '', `${location.pathname}#${link.toString().replaceAll('%2C', ',')}`);
  }

  private paint(): void {
    const {system} = this.shell;
    this.stage.paint(system);
    this.controls.use(system);
    this.strip.use(system);
    this.write();
    this.way?.paint();
    this.panel?.paint();
  }

  private keep(): void {
    if (!this.shown) return toast('no pose is shown yet');
    const isKept = !!this.stage.ghost && !this.rival;
    this.rival = null;
    this.stage.ghost = isKept ? null : {says: '', answer: this.shown.answer, shape: this.shown.shape};
    this.haunt();
    toast(isKept ? 'the ghost is gone' : 'this pose is kept as a ghost');
  }

  private compare(name: string): void {
    [this.rival, this.stage.ghost] = [null, null];
    this.stage.draw();
    this.write();
    if (!name) return this.haunt();
    void this.guarded(async () => {
      const rival = await Rival.open(name);
      if (this.against.value !== name) return;
      this.rival = rival;
      this.haunt();
      if (this.shown) this.meet(rival, this.shown);
    }, () => this.compare(name));
  }

  /** The ghost of another robot goes where this one has gone; until it is there, there is none. */
  private meet(rival: Rival, shown: Shown): void {
    this.stage.ghost = null;
    this.rivals.put(() => this.guarded(async () => {
      const ghost = await rival.at(shown.described, shown.state);
      if (rival !== this.rival || shown !== this.shown) return;
      this.stage.ghost = ghost;
      if (!ghost) this.shell.say(`${rival.name} has no solution here to compare with`);
      this.haunt();
    }, () => this.rival === rival && this.shown && this.meet(rival, this.shown)));
  }

  /** The ghost is another one now. */
  private haunt(): void {
    this.against.value = this.rival?.name ?? '';
    byId('keep').setAttribute('aria-pressed', String(!!this.stage.ghost && !this.rival));
    this.stage.draw();
    this.write();
  }

  private copyCommand(): void {
    const {described, source} = this;
    if (this.screens.shown === 'trajectory') return void copy(byId('command').textContent ?? '', 'command copied, for where the server was started');
    if (!described) return toast('no robot is open yet');
    void copy(byId('command').textContent ?? '', source!.needsFile ? `command copied; it needs ${source!.word}, to be saved` : 'command copied');
  }

  private copyPose(): void {
    const pose = this.shown?.answer.pose ?? this.shown?.answer.tip;
    if (pose) void copy(JSON.stringify(plain(pose)), `${this.shown!.isStale ? 'last solved pose' : 'pose'} copied, in metres and radians`);
    else toast('no pose is shown yet');
  }

  /** With the command of what is drawn, be it what is asked or not; and with the robot, where no command names it. */
  private save(): void {
    const {shown, source} = this;
    if (!shown || !source) return toast('nothing is drawn yet');
    const text = command(source, shown.described, shown.state, this.startOf(shown.state, shown.start));
    void this.guarded(() => this.stage.save(source.stem.replace(/\W+/g, '-'), source.needsFile ? `${text}\n\n# ${source.word}\n${source.text}` : text));
  }

  // What goes wrong

  /** @param again does it once more, when there is hope */
  private async guarded(task: () => Promise<unknown>, again?: () => unknown): Promise<void> {
    try {
      await task();
    } catch (error) {
      if (error instanceof DOMException && error.name === 'AbortError') return;
      if (error instanceof Lost) {
        this.shell.connected(false);
        this.unanswered(error.message);
        return this.connection.lost(() => this.question === this.answered || !this.robot || this.screens.shown !== 'design' ? again?.() : this.ask());
      }
      if (!(error instanceof Refused)) return this.failed(error);
      if (!error.isBusy || !again) {
        this.unanswered(error.message);
        return this.shell.say(error.message);
      }
      const wait = Math.max(error.wait, Math.min(2 ** this.tries++, longest)), why = `the server is busy, asked again in ${wait} s`;
      clearTimeout(this.trying);
      this.trying = window.setTimeout(() => again(), 1000 * wait);
      this.unanswered(why);
      this.shell.say(why);
    }
  }

  /** A mistake of the page is called one. */
  private failed(error: unknown): void {
    const message = error instanceof Error ? `${error.name}: ${error.message}` : String(error);
    console.error(error);
    this.shell.say(`internal error: ${message}`);
    this.behind({status: 'page_failed', message}, [['Load anew', () => location.reload()]]);
  }
}

void new Page().begin();
