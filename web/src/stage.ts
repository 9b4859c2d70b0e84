// The picture with what belongs to it: views, layers, ghost, names of what the pointer is on.
import {sectionName} from './arm';
import {coordinates, withUnit} from './answer';
import type {Json} from './client';
import type {Described} from './described';
import {drawingOf} from './drawn';
import type {Ghost} from './ghost';
import {button, byId, make} from './make';
import {type Drawing, type Layer, layerNames, type Part, shownAtFirst, type View} from './picture';
import {makePicture} from './picture_of';
import type {State} from './state';
import {toast} from './toast';
import type {System} from './units';

/** An answer with the picture of it. */
export interface Shown {
  described: Described; state: State; answer: Json; shape: Json;
  isStale: boolean;                    ///< something else is asked by now, and has no picture
  start: number[] | null | undefined;  ///< where a command has to begin so that it ends here; undefined: not known yet
}

export const views: [string, View][] = [['1', 'side'], ['2', 'top'], ['3', 'front'], ['4', 'tip']];

export class Stage {
  readonly picture = makePicture(byId('view'));
  ghost: Ghost | null = null;
  private readonly sides = views.map(([key, view]) => button(view[0]!.toUpperCase() + view.slice(1), () => this.view(view), `view (${key})`));
  private readonly layers = new Set<Layer>(shownAtFirst);
  private shown: Shown | null = null;
  private system: System = 'mm';

  /** @param moved the camera or the layers are others now */
  constructor(private readonly moved: () => void, save: () => void) {
    byId('tools').append(button('Fit', () => this.picture.fit(), 'all in view (f)'),
                         ...this.sides,
                         button('Save', save, 'save the picture (p)'));
    for (const layer of layerNames) {
      const box = make('input', {type: 'checkbox', checked: this.layers.has(layer)});
      box.addEventListener('change', () => this.toggle(layer, box.checked));
      box.dataset.layer = layer;
      byId('layers').append(make('label', {className: 'choice'}, box, layer));
    }
    this.picture.labelOf = (part) => this.labelOf(part);
    this.picture.note = toast;
    this.picture.moved = moved;
  }

  /** Another robot comes. What is planar has one side. */
  clear(camera: string | null, isPlanar: boolean): void {
    for (const side of this.sides) side.hidden = isPlanar;
    this.shown = null;
    this.picture.clear();
    if (camera !== null) this.picture.camera = camera;
  }

  draw(shown = this.shown): void {
    this.shown = shown;
    if (!shown) return;
    this.picture.draw(this.drawing(shown));
  }

  paint(system: System): void {
    this.system = system;
    this.picture.paint(getComputedStyle(document.documentElement));
    this.draw();
  }

  view(view: View): void {
    if (this.shown?.described.isPlanar) return toast('what lies in the plane has one side');
    if (this.shown) this.picture.fit(view);
  }

  /** What of the view is not as it is at first. */
  toLink(link: URLSearchParams): void {
    const layers = layerNames.filter((layer) => this.layers.has(layer)).join('.');
    if (this.picture.camera) link.set('camera', this.picture.camera);
    if (layers !== shownAtFirst.join('.')) link.set('layers', layers);
  }

  fromLink(link: URLSearchParams): void {
    const layers = link.get('layers')?.split('.');
    if (layers) for (const layer of layerNames) this.toggle(layer, layers.includes(layer));
  }

  /** @param text that goes with it */
  async save(name: string, text: string): Promise<void> {
    this.give(await this.picture.save(text), name);
  }

  give(picture: Blob, name: string): void {
    const url = URL.createObjectURL(picture);
    make('a', {href: url, download: `${name}.png`}).click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
    toast('picture saved, with its command in it');
  }

  private toggle(layer: Layer, is: boolean): void {
    if (is) this.layers.add(layer);
    else this.layers.delete(layer);
    this.picture.show(layer, is);
    document.querySelector<HTMLInputElement>(`[data-layer="${layer}"]`)!.checked = is;
    this.moved();
  }

  private drawing({described, state, answer, shape, isStale}: Shown): Drawing {
    return {...drawingOf(described, state, answer, shape), isStale, ghost: this.ghost?.shape ?? null};
  }

  private labelOf({kind, index, tendon}: Part): string {
    if (!this.shown) return '';
    const {answer, described} = this.shown, leg: Json = answer.legs?.[index] ?? {}, name = described.hasArmLegs && kind === 'tendon' ? sectionName(described.answer, index) : `${described.isSerial || (described.isArm && !described.hasArmLegs) ? 'section' : 'leg'} ${index + 1}`;
    const text = (value: number, unit: 'm' | 'rad' | '1/m' | 'N') => withUnit(value, unit, this.system);
    if (kind === 'platform') return coordinates(answer.pose ?? answer.tip).map(([of, value, unit]) => `${of} ${withUnit(value, unit, this.system)}`).join(', ');
    if (kind === 'tendon' && described.isArm) {
      const [pulls, changes, slack]: (number | undefined)[] = [answer.tensions, answer.changes, answer.slack].map((of) => of?.[index]?.[tendon ?? 0]);
      return [`${name}, tendon ${(tendon ?? 0) + 1}`, ...(pulls === undefined ? [] : [text(pulls, 'N')]), ...(changes === undefined ? [] : [`Δ ${text(changes, 'm')}`]), ...(slack ? [`slack by ${text(slack, 'm')}`] : [])].join(', ');
    }
    if (kind === 'tendon') {
      const length = described.isSerial ? answer.changes?.[index]?.[tendon ?? 0] : leg.tendon_lengths?.[tendon ?? 0];
      return `${name}, tendon ${(tendon ?? 0) + 1}${length === undefined ? '' : ` ${text(length, 'm')}`}`;
    }
    if (kind !== 'backbone') return name;
    if (described.isArm && !described.hasArmLegs) return `backbone, ${text(described.answer.length, 'm')}`;
    const parts = [name];
    if (leg.length !== undefined) parts.push(text(leg.length, 'm'));
    if (leg.curvature !== undefined) parts.push(`κ ${text(leg.curvature, '1/m')}`);
    if (leg.force) parts.push(`${Math.hypot(...leg.force).toPrecision(3)} N`);
    if (answer.configuration?.[index]) parts.push(...answer.configuration[index].map((part: number) => text(part, 'rad')));
    return parts.join(', ');
  }
}
