// What a picture of a robot consists of, whichever pen draws it.
import type {Json} from './client';
import type {Labels} from './labels';
import {longer, outline, ring, round} from './outline';
import {between, type Look, type Pen} from './pen';
import type {Drawing, Layer, Pulls} from './picture';
import {surroundings, tubeAround} from './surroundings';
import {bowed, lookOf} from './tendon_lines';
import {across, axesOf, centre, length, minus, placeOf, plus, type Point, scaled} from './vector';

export const tokens = ['rod', 'mute', 'line', 'accent', 'ghost', 'slack', 'text', 'card', 'scene', 'axis-x', 'axis-y', 'axis-z', 'robot', 'robot-rim', 'hidden', 'over', 'exact', 'tendon-1', 'tendon-2', 'tendon-3', 'tendon-4', 'pull-0', 'pull-1', 'pull-2', 'pull-3'] as const;
export type Colours = Record<(typeof tokens)[number], string>;
export const leastRod = 3;  // pixels of the thinnest

const dashes: (number[] | undefined)[] = [undefined, [8, 4], [2, 4], [10, 3, 2, 3]];  // of tendons [px]
const states: Record<string, string> = {'●': 'exact', '▼': 'slack', '⊗': 'over', '▧': 'unreachable'};
const axes = ['x', 'y', 'z'] as const;

export interface Setting {
  shown: ReadonlySet<Layer>;
  colours: Colours;
  pixels: number;  ///< of a metre
  side: number;    ///< narrower one of the picture [px]
}

/** Draws once; what of it is the same in all parts is kept here. */
class Composition {
  private readonly shape: Json;
  private readonly place: Point | null;
  private readonly metres: number;  // of a pixel

  constructor(private readonly drawing: Drawing, private readonly pen: Pen, private readonly labels: Labels, private readonly setting: Setting) {
    const last = drawing.shape.frames?.at(-1);
    this.shape = drawing.shape;
    this.place = last ? placeOf(last) : null;
    this.metres = 1 / setting.pixels;
  }

  all(): void {
    const {shown} = this.setting, {ghost, shape, around, tube} = this.drawing;
    if (shown.has('grid')) this.grid();
    if (around) surroundings(around, this.pen, this.labels, this.setting);
    if (tube) tubeAround(tube, this.pen, this.labels, this.setting);
    this.base();
    if (ghost && shown.has('ghost')) this.ghost(ghost);
    if (shown.has('discs')) for (const disc of shape.discs ?? []) this.pen.disc(disc, this.colour(around ? 'robot' : 'line'), this.colour(around ? 'robot-rim' : 'mute'), around && this.colour('hidden'));
    if (shown.has('tendons')) this.tendons();
    if (shown.has('rods')) this.rods();
    if (shown.has('lines')) this.lines('mute', 1);
    this.platform();
    this.points();
    if (shown.has('frames')) this.frames();
    this.meeting();
    this.directions();
    this.wrench();
    this.states();
    if (shown.has('labels')) this.names();
  }

  /** Faded where what is asked has no solution. */
  private colour(token: keyof Colours): string {
    const {colours} = this.setting;
    return this.drawing.isStale ? between(colours.ghost, colours.scene, 0.35) : colours[token];
  }

  private get backbones(): Point[][] {
    return this.shape.backbones;
  }

  private get legs(): Point[][] {
    return this.shape.lines ?? [];
  }

  private grid(): void {
    const step = round(80 * this.metres), count = 6, end = count * step, look: Look = {colour: this.setting.colours.line, width: 0.8};
    for (let i = -count; i <= count; ++i) {
      this.pen.line([[i * step, -end], [i * step, end]], look);
      this.pen.line([[-end, i * step], [end, i * step]], look);
    }
  }

  private base(): void {
    const {isPlanar} = this.drawing, base: Point[] = this.shape.base ?? [];
    if (base.length < 2) return;
    const edge = isPlanar ? outline(base) : ring(base);
    if (!isPlanar && edge.length > 2) this.pen.fill(edge, {colour: this.setting.colours.card, opacity: 0.4});
    this.pen.line(edge, {colour: this.colour('mute'), width: 1.2}, true);
  }

  private ghost(ghost: Json): void {
    const look: Look = {colour: this.setting.colours.ghost, width: 1.4, dash: [5, 4]}, plate: Point[] = ghost.platform ?? [];
    for (const points of [...ghost.backbones, ...(ghost.lines ?? [])] as Point[][]) if (points.length > 1) this.pen.line(points, look);
    if (plate.length > 1) this.pen.line(outline(plate), look, true);
  }

  private tendons(): void {
    const {pulls} = this.drawing;
    if (pulls) return this.pulling(pulls);
    for (const of of (this.shape.tendons ?? []) as Point[][][])
      of.forEach((points, i) => {
        const dash = dashes[i % 4];
        if (points.length > 1) this.pen.line(points, {colour: this.colour(`tendon-${i % 4 + 1}` as keyof Colours), width: 1.5, ...(dash && {dash})});
      });
  }

  private pulling(pulls: Pulls): void {
    const sections: Point[][][] = this.shape.tendons ?? [], all = sections.flat();
    sections.forEach((of, section) => of.forEach((points, i) => {
      const spans = pulls.along?.[section]?.[i]?.slice(1);  // without what is between motor and base
      if (spans && spans.length === points.length - 1) {
        spans.forEach((tension, k) => this.pen.line(points.slice(k, k + 2), lookOf(tension, pulls, (token) => this.colour(token))));
        return;
      }
      const look = lookOf(pulls.tensions[section]?.[i] ?? 0, pulls, (token) => this.colour(token));
      if (points.length > 1) this.pen.line(bowed(points, all, pulls.slack[section]?.[i] ?? 0), look);
    }));
  }

  private rods(): void {
    const {radius, struts} = this.drawing, rod: Look = {colour: this.colour('rod'), width: leastRod, diameter: 2 * radius};
    for (const points of this.backbones) if (points.length > 1) this.pen.line(points, rod);
    this.legs.forEach((points, leg) => struts[leg] && this.pen.line(points, {...rod, diameter: 1.6 * radius}));
  }

  /** The lines along which legs pull, made long. */
  private lines(token: keyof Colours, width: number): void {
    for (const points of this.legs) {
      const long = longer(points, 800 * this.metres);
      if (long) this.pen.line(long, {colour: this.colour(token), width, dash: [12, 5]});
    }
  }

  private platform(): void {
    const plate: Point[] = this.shape.platform ?? [], {isUnstable} = this.drawing, colour = this.colour('accent');
    if (plate.length < 2) return;
    const edge = outline(plate);
    if (edge.length > 2) this.pen.fill(edge, {colour, opacity: 0.25});
    this.pen.line(edge, {colour, width: 2, ...(isUnstable && {dash: [8, 6]})}, true);
  }

  /** Where legs begin and end, and where struts are hinged to the rest. */
  private points(): void {
    const {struts} = this.drawing, dot = (point: Point, colour: string, width: number) => this.pen.dot(point, {colour, width});
    for (const point of (this.shape.base ?? []) as Point[]) {
      dot(point, this.colour('rod'), 9);
      dot(point, this.setting.colours.card, 6);
    }
    this.backbones.forEach((points, leg) => struts[leg] && points.length > 1 && dot(points.at(-1)!, this.colour('rod'), 6));
    for (const point of (this.shape.platform ?? []) as Point[]) dot(point, this.colour('accent'), 6);
  }

  private arrow(from: Point, way: Point, pixels: number, look: Look): Point {
    const size = length(way), tip = plus(from, way, (pixels * this.metres) / size), neck = plus(from, way, ((pixels - 4 * look.width!) * this.metres) / size);
    this.pen.line([from, neck], look);
    this.pen.head(neck, tip, {...look, width: 3.2 * look.width!});
    return plus(from, way, ((pixels + 9) * this.metres) / size);
  }

  /** Round an axis, with a head where it ends, or at both ends. @return where its name goes */
  private arc(middle: Point, axis: Point, pixels: number, look: Look, hasBoth: boolean): Point {
    const [u, v] = across(scaled(axis, 1 / length(axis))), radius = pixels * this.metres, turn = 1.5 * Math.PI;
    this.pen.circle(middle, u, v, radius, look, turn);
    const head = (angle: number, sign: number) => {
      const on = plus(plus(middle, u, radius * Math.cos(angle)), v, radius * Math.sin(angle)), along = plus(scaled(u, -sign * Math.sin(angle)), v, sign * Math.cos(angle));
      this.pen.head(on, plus(on, along, 4.5 * look.width! * this.metres), {...look, width: 3.2 * look.width!});
    };
    head(turn, 1);
    if (hasBoth) head(0, -1);
    return plus(plus(middle, u, -0.8 * radius), v, 0.9 * radius);
  }

  private frames(): void {
    const {isPlanar} = this.drawing, list: Json[] = this.shape.frames ?? [], part = Math.min(1, this.setting.side / 480), [long, short] = [44 * part, 26 * part];
    const one = (place: Point, ways: Point[], pixels: number, isNamed: boolean) => axes.slice(0, isPlanar ? 2 : 3).forEach((name, k) => {
      const at = this.arrow(place, ways[k]!, pixels, {colour: this.colour(`axis-${name}`), width: 2, isAbove: true});
      if (isNamed) this.label(name, at, `axis axis-${name}`);
    });
    one([0, 0, 0], [[1, 0, 0], [0, 1, 0], [0, 0, 1]], long, true);
    list.forEach((frame, i) => one(placeOf(frame), axesOf(frame), i === list.length - 1 ? long : short, i === list.length - 1));
  }

  /** A type II: the legs' lines, and the point that they have in common. */
  private meeting(): void {
    const {meeting} = this.drawing;
    if (!meeting) return;
    this.lines('slack', 1.6);
    for (const [token, width] of [['scene', 16], ['slack', 14], ['scene', 9], ['slack', 5]] as const) this.pen.dot(meeting, {colour: this.colour(token), width, isAbove: true});
  }

  /** To both sides along what an unstable platform moves by: a shift, or a turn, or both. */
  private directions(): void {
    const {directions, isPlanar} = this.drawing, {place} = this, look: Look = {colour: this.colour('slack'), width: 2.5, isAbove: true};
    if (!place) return;
    const plate: Point[] = this.shape.platform ?? [], radius = plate.length > 0 ? length(minus(plate[0]!, centre(plate))) : 0;
    for (const twist of directions) {
      const shift = isPlanar ? twist.slice(0, 2) : twist.slice(0, 3), turn = isPlanar ? [0, 0, twist[2] ?? 0] : twist.slice(3);
      const [moves, turns] = [length(shift), turn.length > 2 ? length(turn) * radius : 0], most = Math.max(moves, turns);
      if (!(most > 0)) continue;
      if (moves > 0.2 * most) for (const sign of [1, -1]) this.arrow(place, scaled(shift, sign), 70, look);
      if (turns > 0.2 * most) this.arc(place, turn, 46, look, true);
    }
  }

  private wrench(): void {
    const {wrench, isPlanar, loads} = this.drawing, {place} = this, look: Look = {colour: this.colour('text'), width: 2.5, isAbove: true}, number = (way: Point) => String(Number(length(way).toPrecision(3)));
    for (const {at, force} of loads ?? []) this.label(`${number(force)} N`, this.arrow(at, force, 70, look), 'load');
    if (!wrench || !place) return;
    const force = isPlanar ? wrench.slice(0, 2) : wrench.slice(0, 3), moment = isPlanar ? [0, 0, wrench[2] ?? 0] : wrench.slice(3);
    if (length(force) > 0) this.label(`${number(force)} N`, this.arrow(place, force, 90, look), 'load');
    if (length(moment) > 0) this.label(`${number(moment)} N m`, this.arc(place, moment, 58, look, false), 'load');
  }

  private states(): void {
    this.drawing.states.forEach((mark, i) => {
      const end = this.backbones[i]?.at(-1);
      if (end) this.label(mark, end, `state ${states[mark] ?? ''}`);
    });
  }

  /** Legs by numbers, outside of where they begin; sections in their middle. */
  private names(): void {
    const base: Point[] = this.shape.base ?? [], middle = base.length > 1 ? centre(base) : null, {names} = this.drawing;
    if (names) return names.forEach(({text, at}) => this.label(text, at, 'leg'));
    if (!middle) return this.backbones.forEach((points, i) => this.label(`S${i + 1}`, points[Math.floor(points.length / 2)]!, 'leg'));
    base.forEach((point, i) => {
      const out = minus(point, middle), size = length(out);
      this.label(String(i + 1), size > 0 ? plus(point, out, (18 * this.metres) / size) : point, 'leg');
    });
  }

  private label(text: string, at: Point, kind: string): void {
    this.labels.put(text, at, this.drawing.isStale ? `${kind} stale` : kind);
  }
}

/** Draws all that is shown. */
export function compose(drawing: Drawing, pen: Pen, labels: Labels, setting: Setting): void {
  pen.begin(drawing.isPlanar, setting.pixels);
  labels.begin();
  labels.pulls.show(setting.shown.has('tendons') ? drawing.pulls ?? null : null);
  new Composition(drawing, pen, labels, setting).all();
  pen.end();
  labels.end();
}

/** What a fit has in view. */
export function extent(shape: Json): Point[] {
  const points: Point[] = [...shape.backbones, ...(shape.lines ?? [])].flat();
  for (const disc of shape.discs ?? []) {
    const middle: Point = disc.pose.position;
    for (const way of axesOf(disc.pose).slice(0, 2)) points.push(plus(middle, way, disc.radius), plus(middle, way, -disc.radius));
  }
  const base: Point[] = shape.base ?? [];
  return [...points, ...(shape.platform ?? []), ...(base.length > 1 && (base[0]!.length ?? 0) > 2 ? ring(base) : base)];
}
