// Lines and rods of WebGL, all of them in one call: a rectangle a segment, in which the shader draws it as wide as it is to be
// on the screen, with smooth edges whether or not the browser smooths. The buffer stays while it is large enough.
import {DynamicDrawUsage, GLSL3, InstancedBufferGeometry, InstancedInterleavedBuffer, InterleavedBufferAttribute, BufferAttribute, Mesh, RawShaderMaterial, Vector2} from 'three';
import {type Look, rgb} from './pen';
import type {Point} from './vector';

const vertex = `
precision highp float;
uniform mat4 viewMatrix, projectionMatrix;
uniform vec2 size;    // of the picture [px]
uniform float scale;  // pixels a metre
in vec2 corner;
in vec3 from, to;
in vec4 colour, form; // form: width at both ends [px], diameter [m], lift towards the eye [px]
in float run;         // along the line until here [m]
in vec4 dash;
out vec2 at;
flat out vec4 ends, ink, pattern;
flat out vec4 wide;   // at both ends [px], whether it is round, whether it is a head
flat out vec2 runs;

vec4 seen(vec3 point) {
  vec4 eye = viewMatrix * vec4(point, 1.0);
  eye.z += form.w / scale;
  return projectionMatrix * eye;
}

void main() {
  vec4 a = seen(from), b = seen(to);
  const float near = 1e-4;
  if (a.w < near && b.w < near) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  if (a.w < near) a = mix(a, b, (near - a.w) / (b.w - a.w));
  if (b.w < near) b = mix(b, a, (near - b.w) / (a.w - b.w));
  vec2 s = 0.5 * size * a.xy / a.w, e = 0.5 * size * b.xy / b.w, way = e - s;
  float reach = length(way);
  vec2 t = reach > 1e-4 ? way / reach : vec2(1.0, 0.0), n = vec2(-t.y, t.x);
  float real = 0.5 * size.y * projectionMatrix[1][1] * form.z;  // diameter at a distance of 1 [px]
  vec2 widths = max(form.xy, vec2(real / a.w, real / b.w) * step(0.001, form.xy));
  float pad = 0.5 * max(widths.x, widths.y) + 1.0;
  at = mix(s, e, corner.x) + t * (2.0 * corner.x - 1.0) * pad + n * corner.y * pad;
  ends = vec4(s, e);
  ink = colour;
  pattern = dash;
  wide = vec4(widths, step(1e-9, form.z), step(form.y, 0.001));
  runs = vec2(run, run + distance(from, to));
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

const stride = 20;  // numbers a segment
const fields: [string, number, number][] = [['from', 3, 0], ['to', 3, 3], ['colour', 4, 6], ['form', 4, 10], ['run', 1, 14], ['dash', 4, 15]];

/** What all ink of a picture has in common. */
export const uniforms = () => ({size: {value: new Vector2(1, 1)}, ratio: {value: 1}, scale: {value: 1}, behind: {value: 0}});

export class Ink extends Mesh<InstancedBufferGeometry, RawShaderMaterial> {
  step = 1;  // of so many points of a line one is drawn
  private numbers = new Float32Array(0);
  private count = 0;
  private along = 0;

  constructor(shared: ReturnType<typeof uniforms>) {
    super(new InstancedBufferGeometry(), new RawShaderMaterial({vertexShader: vertex, fragmentShader: fragment, glslVersion: GLSL3, uniforms: shared, transparent: true}));
    this.frustumCulled = false;
    this.allocate(256);
  }

  begin(): void {
    this.count = 0;
  }

  line(points: Point[], look: Look, isClosed: boolean): void {
    const last = points.length - 1, step = last > 4 * this.step ? this.step : 1;
    this.along = 0;
    for (let i = 0; i < last; i += step) this.join(points[i]!, points[Math.min(i + step, last)]!, look);
    if (isClosed && last > 0) this.join(points[last]!, points[0]!, look);
  }

  circle(middle: Point, u: Point, v: Point, radius: number, look: Look, turn: number, steps: number): void {
    let [x, y, z] = [middle[0]! + radius * u[0]!, middle[1]! + radius * u[1]!, middle[2]! + radius * u[2]!];
    this.along = 0;
    for (let i = 1; i <= steps; ++i) {
      const c = radius * Math.cos((turn * i) / steps), s = radius * Math.sin((turn * i) / steps);
      const a = middle[0]! + c * u[0]! + s * v[0]!, b = middle[1]! + c * u[1]! + s * v[1]!, d = middle[2]! + c * u[2]! + s * v[2]!;
      this.put(x, y, z, a, b, d, look, look.width ?? 1, look.width ?? 1, 0);
      [x, y, z] = [a, b, d];
    }
  }

  head(from: Point, to: Point, look: Look): void {
    this.put(from[0]!, from[1]!, from[2] ?? 0, to[0]!, to[1]!, to[2] ?? 0, look, look.width ?? 1, 0, 0);
  }

  /** @param lift towards the eye, so that what it marks does not hide it [px] */
  dot(point: Point, look: Look, lift: number): void {
    const [x, y, z] = [point[0]!, point[1]!, point[2] ?? 0];
    this.put(x, y, z, x, y, z, look, look.width ?? 1, look.width ?? 1, lift);
  }

  end(): void {
    const buffer = (this.geometry.getAttribute('from') as InterleavedBufferAttribute).data;
    buffer.clearUpdateRanges();
    buffer.addUpdateRange(0, this.count * stride);
    buffer.needsUpdate = true;
    this.geometry.instanceCount = this.count;
    this.visible = this.count > 0;
  }

  private join(a: Point, b: Point, look: Look): void {
    this.put(a[0]!, a[1]!, a[2] ?? 0, b[0]!, b[1]!, b[2] ?? 0, look, look.width ?? 1, look.width ?? 1, 0);
  }

  private put(ax: number, ay: number, az: number, bx: number, by: number, bz: number, {colour, opacity = 1, diameter = 0, dash}: Look, from: number, to: number, lift: number): void {
    if ((this.count + 1) * stride > this.numbers.length) this.allocate(2 * this.count);
    const {numbers} = this, [red, green, blue] = rgb(colour) as [number, number, number];
    let i = this.count++ * stride;
    numbers[i++] = ax; numbers[i++] = ay; numbers[i++] = az;
    numbers[i++] = bx; numbers[i++] = by; numbers[i++] = bz;
    numbers[i++] = red; numbers[i++] = green; numbers[i++] = blue; numbers[i++] = opacity;
    numbers[i++] = from; numbers[i++] = to; numbers[i++] = diameter; numbers[i++] = lift;
    numbers[i++] = this.along;
    numbers[i++] = dash?.[0] ?? 0; numbers[i++] = dash?.[1] ?? 0; numbers[i++] = dash?.[2] ?? 0; numbers[i] = dash?.[3] ?? 0;
    if (dash) this.along += Math.hypot(bx - ax, by - ay, bz - az);
  }

  private allocate(count: number): void {
    const old = this.numbers, geometry = new InstancedBufferGeometry();
    this.numbers = new Float32Array(count * stride);
    this.numbers.set(old);
    const buffer = new InstancedInterleavedBuffer(this.numbers, stride);
    buffer.setUsage(DynamicDrawUsage);
    geometry.setIndex([0, 1, 2, 2, 1, 3]);
    geometry.setAttribute('corner', new BufferAttribute(new Float32Array([0, -1, 1, -1, 0, 1, 1, 1]), 2));
    for (const [name, size, offset] of fields) geometry.setAttribute(name, new InterleavedBufferAttribute(buffer, size, offset));
    this.geometry.dispose();
    this.geometry = geometry;
  }
}
