// The picture of a robot without WebGL: the same lines by SVG.
import {Figure} from './figure';
import type {Solids} from './picture';
import {withText} from './png';
import {makeSvg, shapeOf, SvgPen} from './svg_pen';

export class PlainPicture extends Figure {
  readonly canvas = makeSvg();
  protected override readonly isFlat = true;
  protected readonly pen = new SvgPen(this.canvas, (point) => this.lookout.project(point));

  private readonly banner: HTMLElement;

  constructor(box: HTMLElement) {
    super(box);
    const banner = document.createElement('p');
    banner.className = 'simplified';
    banner.textContent = '3-D simplified: no WebGL';
    this.banner = banner;
    box.prepend(this.canvas, banner);
  }

  async save(command: string): Promise<Blob> {
    const {width, height} = this.lookout, copy = this.canvas.cloneNode(true) as SVGSVGElement, large = document.createElement('canvas'), image = new Image();
    [large.width, large.height] = [2 * width, 2 * height];
    copy.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
    copy.setAttribute('viewBox', `0 0 ${width} ${height}`);
    copy.setAttribute('width', String(large.width));
    copy.setAttribute('height', String(large.height));
    copy.prepend(shapeOf('rect', {width, height, fill: this.colours.scene}));
    image.src = `data:image/svg+xml,${encodeURIComponent(new XMLSerializer().serializeToString(copy))}`;
    await image.decode();
    const context = large.getContext('2d')!;
    context.drawImage(image, 0, 0);
    this.labels.paint(context, 2);
    const picture = await new Promise<Blob | null>((done) => large.toBlob(done, 'image/png'));
    return withText(picture!, 'sinew', command);
  }

  override solids(solids: Solids | null): void {
    this.banner.textContent = `3-D simplified: no WebGL${solids ? '; solids are not drawn' : ''}`;
  }

  protected override resize(): void {
    this.canvas.setAttribute('width', String(this.box.clientWidth));
    this.canvas.setAttribute('height', String(this.box.clientHeight));
    super.resize();
  }

  protected render(): void {}
}
