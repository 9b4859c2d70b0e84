// Lines and rods of WebGL, all of them in one call: a rectangle a segment, in which the shader draws it as wide as it is to be
// on the screen, with smooth edges whether or not the browser smooths. The buffer stays while it is large enough.
import {BufferAttribute, BufferGeometry, DynamicDrawUsage, GLSL3, InterleavedBuffer, InterleavedBufferAttribute, Mesh, RawShaderMaterial, Vector2} from 'three';
import {type Look, rgb} from './pen';
import type {Point} from './vector';

const vertex = `
precision highp float;
uniform mat4 viewMatrix, projectionMatrix;
uniform vec2 size;    // of the picture [px]
uniform float scale;  // pixels a metre
in vec3 from, to;
in vec4 form;         // width [px], diameter [m], lift towards the eye [px], less than 0: it is a head; along the line until here [m]
in vec4 colour, dash; // of 1; of 255 pixels
out vec2 at;
flat out vec4 ends, ink, pattern;
flat out vec4 wide;   // at both ends [px], whether it is round, whether it is a head
flat out vec2 runs;

vec4 seen(vec3 point) {
  vec4 eye = viewMatrix * vec4(point, 1.0);
  eye.z += max(form.z, 0.0) / scale;
  return projectionMatrix * eye;
}

void main() {
  vec2 corner = vec2(gl_VertexID & 1, (gl_VertexID & 2) - 1);
  vec4 a = seen(from), b = seen(to);
  const float near = 1e-4;
  if (a.w < near && b.w < near) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  if (a.w < near) a = mix(a, b, (near - a.w) / (b.w - a.w));
  if (b.w < near) b = mix(b, a, (near - b.w) / (a.w - b.w));
  vec2 s = 0.5 * size * a.xy / a.w, e = 0.5 * size * b.xy / b.w, way = e - s;
  float reach = length(way);
  vec2 t = reach > 1e-4 ? way / reach : vec2(1.0, 0.0), n = vec2(-t.y, t.x);
  float real = 0.5 * size.y * projectionMatrix[1][1] * form.y;  // diameter at a distance of 1 [px]
  vec2 widths = max(vec2(form.x), vec2(real / a.w, real / b.w)) * vec2(1.0, step(0.0, form.z));
  float pad = 0.5 * max(widths.x, widths.y) + 1.0;
  at = mix(s, e, corner.x) + t * (2.0 * corner.x - 1.0) * pad + n * corner.y * pad;
  ends = vec4(s, e);
  ink = colour;
  pattern = 255.0 * dash;
  wide = vec4(widths, step(1e-9, form.y), 1.0 - step(0.0, form.z));
  runs = vec2(form.w, form.w + distance(from, to));
  gl_Position = vec4(at / (0.5 * size), mix(a.z / a.w, b.z / b.w, reach > 1e-4 ? corner.x + (2.0 * corner.x - 1.0) * pad / reach : 0.5), 1.0);
}`;

const fragment = `
precision highp float;
uniform float ratio;  // dots of the screen a pixel
uniform float scale;  // pixels a metre
uniform float behind; // depth of a pixel
in vec2 at;
flat in vec4 ends, ink, pattern, wide;
flat in vec2 runs;
out vec4 result;

void main() {
  vec2 way = ends.zw - ends.xy, from = at - ends.xy;
  float reach = length(way);
  vec2 t = reach > 1e-4 ? way / reach : vec2(1.0, 0.0);
  float x = dot(from, t), y = abs(dot(from, vec2(-t.y, t.x))), part = reach > 1e-4 ? clamp(x / reach, 0.0, 1.0) : 0.0;
  float radius = 0.5 * mix(wide.x, wide.y, part);
  float out_by = wide.w > 0.5 ? max(y - radius, -x) : length(vec2(x - part * reach, y)) - radius;
  float opacity = clamp(0.5 - out_by * ratio, 0.0, 1.0);
  if (pattern.x > 0.0) {
    float u = mod(mix(runs.x, runs.y, part) * scale, pattern.x + pattern.y + pattern.z + pattern.w), second = pattern.x + pattern.y, all = second + pattern.z + pattern.w;
    float off = min(max(-u, u - pattern.x), all - u);
    if (pattern.z > 0.0) off = min(off, max(second - u, u - second - pattern.z));
    opacity *= clamp(0.5 - off * ratio, 0.0, 1.0);
  }
  if (opacity < 0.02) discard;
  vec3 colour = ink.rgb;
  if (wide.z > 0.5) {  // a rod: lit from the eye
    float front = sqrt(max(0.0, 1.0 - y * y / (radius * radius)));
    colour = mix(colour * 0.8, mix(colour, vec3(1.0), 0.42), smoothstep(0.25, 1.0, front) * smoothstep(1.0, 2.5, radius));
  }
  float beyond = max(0.0, max(-x, x - reach));  // soft edges and ends hide nothing of what joins them
  gl_FragDepth = gl_FragCoord.z + behind * (beyond + 2.0 * (1.0 - opacity));
  result = vec4(colour, ink.a * opacity);
}`;

const stride = 10;  // numbers a corner, beside eight bytes

/** What all ink of a picture has in common. */
export const uniforms = () => ({size: {value: new Vector2(1, 1)}, ratio: {value: 1}, scale: {value: 1}, behind: {value: 0}});

export class Ink extends Mesh<BufferGeometry, RawShaderMaterial> {
  tolerance = 0.15;  // pixels beside a curve that a segment of it may lie
  private numbers = new Float32Array(0);
  private bytes = new Uint8Array(0);
  private count = 0;
  private along = 0;
  private pixels = 1;

  constructor(shared: ReturnType<typeof uniforms>) {
    super(new BufferGeometry(), new RawShaderMaterial({vertexShader: vertex, fragmentShader: fragment, glslVersion: GLSL3, uniforms: shared, transparent: true}));
    this.frustumCulled = false;
    this.allocate(256);
  }

  /** @param pixels of a metre */
  begin(pixels: number): void {
    this.count = 0;
    this.pixels = pixels;
  }

  line(points: Point[], look: Look, isClosed: boolean): void {
    const last = points.length - 1;
    this.along = 0;
    for (let i = 0, next; i < last; i = next) {
      for (next = i + 1; next < last && this.isStraight(points[i]!, points[(i + next + 1) >> 1]!, points[next + 1]!);) ++next;
      this.join(points[i]!, points[next]!, look);
    }
    if (isClosed && last > 0) this.join(points[last]!, points[0]!, look);
  }

  circle(middle: Point, u: Point, v: Point, radius: number, look: Look, turn: number): void {
    const steps = Math.ceil(Math.min(48, Math.max(8, 0.5 * turn * Math.sqrt((this.pixels * radius) / (4 * this.tolerance)))));
    let [x, y, z] = [middle[0]! + radius * u[0]!, middle[1]! + radius * u[1]!, middle[2]! + radius * u[2]!];
    this.along = 0;
    for (let i = 1; i <= steps; ++i) {
      const c = radius * Math.cos((turn * i) / steps), s = radius * Math.sin((turn * i) / steps);
      const a = middle[0]! + c * u[0]! + s * v[0]!, b = middle[1]! + c * u[1]! + s * v[1]!, d = middle[2]! + c * u[2]! + s * v[2]!;
      this.put(x, y, z, a, b, d, look, 0);
      [x, y, z] = [a, b, d];
    }
  }

  head(from: Point, to: Point, look: Look): void {
    this.put(from[0]!, from[1]!, from[2] ?? 0, to[0]!, to[1]!, to[2] ?? 0, look, -1);
  }

  /** @param lift towards the eye, so that what it marks does not hide it [px] */
  dot(point: Point, look: Look, lift: number): void {
    const [x, y, z] = [point[0]!, point[1]!, point[2] ?? 0];
    this.put(x, y, z, x, y, z, look, lift);
  }

  end(): void {
    for (const name of ['from', 'colour']) {
      const {data} = this.geometry.getAttribute(name) as InterleavedBufferAttribute;
      data.clearUpdateRanges();
      data.addUpdateRange(0, 4 * this.count * data.stride);
      data.needsUpdate = true;
    }
    this.geometry.setDrawRange(0, 6 * this.count);
    this.visible = this.count > 0;
  }

  /** Whether a point is as good as on the segment between its neighbours. */
  private isStraight(a: Point, b: Point, c: Point): boolean {
    const x = c[0]! - a[0]!, y = c[1]! - a[1]!, z = (c[2] ?? 0) - (a[2] ?? 0), u = b[0]! - a[0]!, v = b[1]! - a[1]!, w = (b[2] ?? 0) - (a[2] ?? 0);
    const square = x * x + y * y + z * z, part = square > 0 ? (u * x + v * y + w * z) / square : 0;
    return part >= 0 && part <= 1 && (u - part * x) ** 2 + (v - part * y) ** 2 + (w - part * z) ** 2 < (this.tolerance / this.pixels) ** 2;
  }

  private join(a: Point, b: Point, look: Look): void {
    this.put(a[0]!, a[1]!, a[2] ?? 0, b[0]!, b[1]!, b[2] ?? 0, look, 0);
  }

  /** @param lift towards the eye [px]; less than 0: it is a head */
  private put(ax: number, ay: number, az: number, bx: number, by: number, bz: number, {colour, width = 1, opacity = 1, diameter = 0, dash}: Look, lift: number): void {
    if (6 * (this.count + 1) > (this.geometry.index?.count ?? 0)) this.allocate(2 * this.count);
    const {numbers, bytes} = this, [red, green, blue] = rgb(colour) as [number, number, number], first = 4 * stride * this.count, start = 32 * this.count++;
    let [i, k] = [first, start];
    numbers[i++] = ax; numbers[i++] = ay; numbers[i++] = az; numbers[i++] = bx; numbers[i++] = by; numbers[i++] = bz;
    numbers[i++] = width; numbers[i++] = diameter; numbers[i++] = lift; numbers[i] = this.along;
    bytes[k++] = 255 * red; bytes[k++] = 255 * green; bytes[k++] = 255 * blue; bytes[k++] = 255 * opacity;
    bytes[k++] = dash?.[0] ?? 0; bytes[k++] = dash?.[1] ?? 0; bytes[k++] = dash?.[2] ?? 0; bytes[k] = dash?.[3] ?? 0;
    for (let corner = 1; corner < 4; ++corner) {
      numbers.copyWithin(first + corner * stride, first, first + stride);
      bytes.copyWithin(start + corner * 8, start, start + 8);
    }
    if (dash) this.along += Math.hypot(bx - ax, by - ay, bz - az);
  }

  private allocate(count: number): void {
    const geometry = new BufferGeometry(), index = new Uint32Array(6 * count), numbers = new Float32Array(4 * count * stride), bytes = new Uint8Array(32 * count);
    numbers.set(this.numbers);
    bytes.set(this.bytes);
    [this.numbers, this.bytes] = [numbers, bytes];
    const places = new InterleavedBuffer(numbers, stride), looks = new InterleavedBuffer(bytes, 8);
    for (const buffer of [places, looks]) buffer.setUsage(DynamicDrawUsage);
    for (let i = 0; i < count; ++i) [0, 1, 2, 2, 1, 3].forEach((corner, k) => { index[6 * i + k] = 4 * i + corner; });
    geometry.setIndex(new BufferAttribute(index, 1));
    geometry.setAttribute('from', new InterleavedBufferAttribute(places, 3, 0));
    geometry.setAttribute('to', new InterleavedBufferAttribute(places, 3, 3));
    geometry.setAttribute('form', new InterleavedBufferAttribute(places, 4, 6));
    geometry.setAttribute('colour', new InterleavedBufferAttribute(looks, 4, 0, true));
    geometry.setAttribute('dash', new InterleavedBufferAttribute(looks, 4, 4, true));
    this.geometry.dispose();
    this.geometry = geometry;
  }
}
