// A small shape of a diagram, drawn larger in a corner that is free.
import {type Pixel, svg, text} from './svg';

const least = 24;  // pixels, below which a shape is drawn larger: less would be hidden by the plate of the state's shape
const factors = [10, 5, 2];
const tiny = 8;    // pixels of what even then is no shape

/** @param keep what may not be covered @param looks the class of the shape */
export function inset(shape: Pixel[], side: number, keep: Pixel[], looks: string, name: string): Node[] {
  const xs = shape.map(([x]) => x), ys = shape.map(([, y]) => y), width = Math.max(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys));
  if (width >= least || factors[0]! * width < tiny) return [];
  const radius = Math.min(32, 0.17 * side), edge = radius + 5, far = side - edge;
  const free = ([x, y]: Pixel) => Math.min(...keep.map(([a, b]) => Math.hypot(a - x, b - y)));
  const corners: Pixel[] = [[edge, edge], [far, edge], [edge, far - 8], [far, far]], [x, y] = corners.reduce((best, one) => (free(one) > free(best) ? one : best));
  const factor = factors.find((by) => by * width <= 1.3 * radius) ?? factors.at(-1)!;
  const [cx, cy] = [(Math.max(...xs) + Math.min(...xs)) / 2, (Math.max(...ys) + Math.min(...ys)) / 2];
  const large = shape.map(([a, b]): Pixel => [x + factor * (a - cx), y - 4 + factor * (b - cy)]), clip = `${name}-inset`;
  return [svg('g', {class: 'inset'}, svg('clipPath', {id: clip}, svg('circle', {cx: x, cy: y, r: radius})), svg('circle', {class: 'lens', cx: x, cy: y, r: radius}),
              svg('g', {'clip-path': `url(#${clip})`}, svg(shape.length === 2 ? 'polyline' : 'polygon', {class: looks, points: text(large)})),
              svg('text', {x, y: y + radius - 5, 'text-anchor': 'middle'}, `×${factor}`))];
}
