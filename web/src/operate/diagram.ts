// The diagram of a section: which bends its tendons leave it, where it is, and where it is to go.
import {type Bend, type Kind, type SectionFrame} from './frame';
import {inset} from './inset';
import {mark, tag} from './mark';
import {forbidden, Plane} from './plane';
import {type Pixel, svg, text} from './svg';

export interface View {
  section: SectionFrame;
  kind: Kind;
  isDisc: boolean;      ///< of a neutral backbone
  limit: number;        ///< of its envelope [rad]
  trail: Bend[];
  given: string[];      ///< lines that say on what it depends
  over: Bend | null;    ///< where a pointer pulls beyond the envelope
}

const radius = 8;  // pixels of the state's shape
let count = 0;     // of clips, whose names have to differ

export class Diagram {
  readonly element = svg('svg', {class: 'diagram'});
  plane = new Plane(200, 1);
  private readonly clip = `clip-${++count}`;
  private drawn = '';

  /** @param side in pixels */
  draw(view: View, side: number): void {
    const key = JSON.stringify([view, side]);
    if (key === this.drawn) return;
    this.drawn = key;
    this.plane = new Plane(side, view.limit);
    for (const name of ['width', 'height']) this.element.setAttribute(name, String(side));
    this.element.setAttribute('viewBox', `0 0 ${side} ${side}`);
    const inside = svg('g', {'clip-path': `url(#${this.clip})`}, ...this.ground(view), ...this.free(view), ...this.frontiers(view), ...this.places(view));
    this.element.replaceChildren(svg('clipPath', {id: this.clip}, svg('rect', {width: side, height: side, rx: 4})), svg('rect', {class: 'sheet', width: side, height: side, rx: 4}), inside,
                                 svg('rect', {class: 'frame', x: 0.5, y: 0.5, width: side - 1, height: side - 1, rx: 4}), ...this.words(view), ...this.large(view));
    this.element.setAttribute('class', `diagram ${view.kind}`);
  }

  private ground({isDisc, limit}: View): Node[] {
    const {side, scale} = this.plane, half = side / 2, reach = limit * scale;
    const envelope = isDisc ? svg('circle', {class: 'envelope', cx: half, cy: half, r: reach}) : svg('rect', {class: 'envelope', x: half - reach, y: half - reach, width: 2 * reach, height: 2 * reach});
    const rings = isDisc ? [1, 2].map((third) => svg('circle', {class: 'ring', cx: half, cy: half, r: (third * reach) / 3})) : [];
    return [envelope, svg('path', {class: 'axes', d: `M0 ${half}H${side}M${half} 0V${side}`}), ...rings];
  }

  /** What the tendons leave it. */
  private free({section, kind}: View): Node[] {
    const {plane} = this, outline = section.conditional && section.outline?.length ? [svg('polygon', {class: 'outline', points: this.line(section.outline)})] : [];
    const polygon = freeOf(section);
    if (kind === 'over') return [...outline, svg('polygon', {class: 'empty', points: this.line(this.triangle(section))})];
    if (kind === 'exact' || polygon.length === 0) return outline;
    if (polygon.length === 2) return [...outline, svg('polyline', {class: 'taut', points: this.line(polygon)})];
    return [...outline, svg('polygon', {class: 'free', points: polygon.map((one) => plane.at(one).map((part) => part.toFixed(1)).join(',')).join(' ')})];
  }

  private triangle({frontiers, slack}: SectionFrame): Bend[] {
    return forbidden(frontiers ?? [], slack ?? [], 3 * this.plane.reach);
  }

  private frontiers({section}: View): Node[] {
    return (section.frontiers ?? []).flatMap((of, i) => {
      const drawn = this.plane.frontier(of);
      return drawn ? [svg('g', {class: `frontier tendon-${(i % 4) + 1}`}, svg('path', {class: 'hatch', d: drawn.hatch}), svg('polyline', {class: 'line', points: text(drawn.points)}))] : [];
    });
  }

  private places({section, trail, kind, over}: View): Node[] {
    const {plane} = this, nodes: Node[] = [], {point, target, measured} = section, here = point ? plane.at(point) : null;
    const isApart = (place: Pixel, by: number) => !here || Math.hypot(place[0] - here[0], place[1] - here[1]) > by;
    if (trail.length > 1) nodes.push(svg('polyline', {class: 'trail', points: this.line(trail)}));
    const goal = plane.at(target);
    if (over) nodes.push(svg('path', {class: 'pull', d: `M${goal.join(' ')}L${plane.at(over).join(' ')}`}));
    if (isApart(goal, 4)) nodes.push(...crossHair(goal));
    const [x, y] = measured ? plane.at(measured) : [0, 0];
    if (measured && isApart([x, y], 4)) nodes.push(svg('path', {class: 'measured', d: `M${x} ${y - 6}L${x + 6} ${y}L${x} ${y + 6}L${x - 6} ${y}Z`}));
    if (here) nodes.push(svg('circle', {class: 'halo', cx: here[0], cy: here[1], r: radius + 3}), mark(kind, ...this.seen(here), radius));
    return nodes;
  }

  /** What is beyond the picture is at its edge. */
  private seen([x, y]: Pixel): Pixel {
    const edge = (value: number) => Math.min(this.plane.side - radius - 2, Math.max(radius + 2, value));
    return [edge(x), edge(y)];
  }

  /** Numbers of tendons where their frontiers leave the picture, each away from the others; names of the axes. */
  private words({section, isDisc, given}: View): Node[] {
    const {side} = this.plane, half = side / 2, names = isDisc ? ['θ cos φ', 'θ sin φ'] : ['β₁', 'β₂'];
    const tags = this.tags(section, given).map(([tendon, [x, y]]) => tag(tendon, x, y, 8));
    return [
      svg('text', {class: 'axis', x: side - 5, y: half - 6, 'text-anchor': 'end'}, names[0]!), svg('text', {class: 'axis', x: half + 6, y: 13}, names[1]!),
      ...tags, ...given.map((line, i) => svg('text', {class: 'given', x: 7, y: side - 8 - 13 * (given.length - 1 - i)}, line)),
    ];
  }

  private tags(section: SectionFrame, given: string[]): [number, Pixel][] {
    const {plane} = this, {side} = plane, placed: [number, Pixel][] = [], taken: Pixel[] = [[side - 14, side / 2 - 10], [side / 2 + 12, 10], ...this.corner(given), ...(section.point ? [plane.at(section.point)] : [])];
    (section.frontiers ?? []).forEach((of, i) => {
      const points = plane.frontier(of)?.points.filter((one) => plane.holds(one, -1)) ?? [];
      if (points.length < 2) return;
      const ends = [inwards(points[0]!, points[1]!), inwards(points.at(-1)!, points.at(-2)!)].map(([x, y]): Pixel => [Math.min(side - 10, Math.max(10, x)), Math.min(side - 10, Math.max(10, y))]);
      const free = (end: Pixel) => Math.min(...taken.map(([x, y]) => Math.hypot(x - end[0], y - end[1])));
      const end = free(ends[0]!) > free(ends[1]!) ? ends[0]! : ends[1]!;
      taken.push(end);
      placed.push([i, end]);
    });
    return placed;
  }

  /** Where the words are that say on what it depends. */
  private corner(given: string[]): Pixel[] {
    const y = this.plane.side - 6 * given.length - 6;
    return given.length === 0 ? [] : [20, 60, ...(given.length > 1 ? [100, 140] : [])].map((x) => [x, y]);
  }

  /** What is too small to be seen, larger. */
  private large({section, kind, given}: View): Node[] {
    const shape = kind === 'over' ? this.triangle(section) : kind === 'slack' ? freeOf(section) : [];
    if (shape.length < 2) return [];
    const {plane} = this, keep = [...this.tags(section, given).map(([, at]) => at), ...this.corner(given), ...(section.point ? [plane.at(section.point)] : []), plane.at(section.target)];
    return inset(shape.map((one) => plane.at(one)), plane.side, keep, kind === 'over' ? 'empty' : shape.length === 2 ? 'taut' : 'free', this.clip);
  }

  private line(points: Bend[]): string {
    return text(points.map((one) => this.plane.at(one)));
  }
}

/** What no tendon forbids; between curved frontiers only what of it lies in the envelope is known. */
const freeOf = ({polygon, boundary}: SectionFrame): Bend[] => polygon ?? boundary ?? [];

function crossHair([x, y]: Pixel): Node[] {
  return [svg('circle', {class: 'goal', cx: x, cy: y, r: 7}), svg('path', {class: 'goal', d: `M${x - 12} ${y}H${x + 12}M${x} ${y - 12}V${y + 12}`})];
}

/** A little along the line from where it leaves the picture. */
function inwards([x, y]: Pixel, [a, b]: Pixel): Pixel {
  const length = Math.hypot(a - x, b - y) || 1, by = Math.min(16, length / 2);
  return [x + (by * (a - x)) / length, y + (by * (b - y)) / length];
}

/** What a diagram says, for those who do not see it. */
export function described({section, given}: View, name: string, angle: (value: number) => string): string {
  const {point, target} = section, pair = (bend: Bend) => bend.map(angle).join(', ');
  return `${name}, ${section.word.toLowerCase()}${given.length > 0 ? `, ${given.join(' ')}` : ''}${point ? `, at ${pair(point)}` : ''}, target ${pair(target)}`;
}

const reasons = {previous_over_tensioned: 'over-tensioned', over_tensioned: 'itself over-tensioned', beyond_envelope: 'beyond the limit', exact_model: 'not in the exact model'} as const;

/** On what a diagram holds: on the state of the section before it. Where what that leaves is not to be drawn, why. */
export function given({conditional, no_outline}: SectionFrame, section: number): string[] {
  if (!conditional) return [];
  return no_outline ? [`given S${section}, no outline:`, reasons[no_outline]] : [`given S${section}`];
}
