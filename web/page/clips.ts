// The animations of a file: what they move, and to what at a moment.
import type { Reader } from '../src/accessors';
import { isCount, isNear, item, list, once } from '../src/json';

type Mode = 'LINEAR' | 'STEP' | 'CUBICSPLINE';
/** What can be moved of a node. */
export type Part = 'translation' | 'rotation' | 'scale' | 'weights' | 'visible';
export const kParts = new Map<string, number>([['translation', 3], ['rotation', 4], ['scale', 3]]);

interface Curve {
  times: Float32Array;
  /** With CUBICSPLINE each element stands between its tangents, the one that comes in and the one that goes out. */
  values: Float32Array;
  size: number;
  mode: Mode;
}
export interface Channel extends Curve {
  node: number;
  part: Part;
}
/** A number of a material, by its pointer. */
export interface MaterialChannel extends Curve {
  material: number;
  pointer: string;
}
/** Numbers of a lamp or a camera, by their pointer. */
export interface PropertyChannel extends Curve {
  property: string;
}
export interface Clip {
  name: string;
  /** Seconds. */
  duration: number;
  channels: Channel[];
  materials: MaterialChannel[];
  properties: PropertyChannel[];
}

/** Of all clips of a file together; more are left out. */
const kMostChannels = 100_000;

/** Takes a turn along the shorter arc into `to`. */
function slerp(values: Float32Array, a: number, b: number, t: number, to: number[]): void {
  let cosine = 0;
  for (let i = 0; i < 4; ++i) cosine += values[a + i] * values[b + i];
  const side = cosine < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(Math.abs(cosine), 1));
  const sine = Math.sin(angle);
  // Between turns that are nearly one, the chord is the arc.
  const [from, on] = sine > 1e-4 ? [Math.sin((1 - t) * angle) / sine, Math.sin(t * angle) / sine] : [1 - t, t];
  for (let i = 0; i < 4; ++i) to[i] = from * values[a + i] + side * on * values[b + i];
}

/** The last of the times that is not after a moment. */
function lastBefore(times: Float32Array, seconds: number): number {
  let low = 0;
  for (let high = times.length; high - low > 1; ) {
    const middle = (low + high) >> 1;
    if (times[middle] <= seconds) low = middle;
    else high = middle;
  }
  return low;
}

/** What a curve has at a moment; before the first and after the last key it is theirs. A turn is of length 1. */
export function valueAt({ times, values, size, mode }: Curve, seconds: number, turn: boolean): number[] {
  const to: number[] = [];
  const key = lastBefore(times, seconds);
  const cubic = mode === 'CUBICSPLINE';
  const at = (k: number, which = 1) => (cubic ? (3 * k + which) * size : k * size);
  const span = key + 1 < times.length ? times[key + 1] - times[key] : 0;
  const t = span > 0 ? Math.min(Math.max((seconds - times[key]) / span, 0), 1) : 0;
  if (t === 0 || mode === 'STEP') for (let i = 0; i < size; ++i) to.push(values[at(key) + i]);
  else if (cubic) {
    const [t2, t3] = [t * t, t * t * t];
    for (let i = 0; i < size; ++i) {
      const [from, on] = [values[at(key) + i], values[at(key + 1) + i]];
      const [out, into] = [span * values[at(key, 2) + i], span * values[at(key + 1, 0) + i]];
      to.push((2 * t3 - 3 * t2 + 1) * from + (t3 - 2 * t2 + t) * out + (3 * t2 - 2 * t3) * on + (t3 - t2) * into);
    }
  } else if (turn) slerp(values, at(key), at(key + 1), t, to);
  else for (let i = 0; i < size; ++i) to.push(values[at(key) + i] * (1 - t) + values[at(key + 1) + i] * t);
  if (!turn) return to;
  const length = Math.hypot(...to);
  return length > 1e-12 ? to.map((x) => x / length) : [0, 0, 0, 1];
}

type Target = { node: number; part: Part } | { material: number; pointer: string } | { property: string; size: number };

/** What can be moved of lamps and cameras, by the lists that have them. */
const kProperties = /^\/(?:extensions\/KHR_lights_punctual\/(lights)|(cameras))\/(\d+)\/(color|intensity|range|spot\/(?:inner|outer)ConeAngle|perspective\/(?:aspectRatio|yfov|zfar|znear)|orthographic\/(?:xmag|ymag|zfar|znear))$/;

/** Reads the clips of a file; what is wrong with a channel leaves it out and is said. */
export class ClipReader {
  private readonly times = new Map<unknown, Float32Array | null>();
  private readonly values = new Map<unknown, { data: Float32Array; size: number } | null>();
  private room = kMostChannels;

  /** `weights` tells how many morph targets a node's mesh has. */
  constructor(private readonly from: Reader, private readonly weights: (node: number) => number, private readonly say: (text: string) => void) {}

  clips(): Clip[] {
    const read: Clip[] = [];
    list(this.from.file.json.animations).forEach((animation, i) => {
      const clip: Clip = { name: String(animation?.name ?? '') || `animation ${i}`, duration: 0, channels: [], materials: [], properties: [] };
      list(animation?.channels).forEach((channel, k) => {
        if (this.room === 0) return;
        this.add(clip, animation, channel, `/animations/${i}/channels/${k}`);
      });
      if (clip.channels.length + clip.materials.length + clip.properties.length > 0) read.push(clip);
    });
    if (this.room === 0) this.say(`the animations have more than ${kMostChannels} channels: the others are left out`);
    return read;
  }

  private add(clip: Clip, animation: any, channel: any, at: string): void {
    const wrong = (text: string) => this.say(`${at}: ${text}; it is left out`);
    const target = this.target(channel?.target);
    if (target === null) return; // it names nothing, which is allowed, or is not ours
    if (typeof target === 'string') return wrong(target);
    const curve = this.curve(animation, channel, target);
    if (typeof curve === 'string') return wrong(curve);
    --this.room;
    clip.duration = Math.max(clip.duration, curve.times[curve.times.length - 1]);
    if ('node' in target) clip.channels.push({ ...curve, ...target });
    else if ('material' in target) clip.materials.push({ ...curve, ...target });
    else clip.properties.push({ ...curve, property: target.property });
  }

  /** What a channel moves; a text that says what is wrong with it. */
  private target(of: any): Target | string | null {
    let { node, path } = of ?? {};
    const pointer = of?.extensions?.KHR_animation_pointer?.pointer;
    if (path === 'pointer') {
      if (typeof pointer !== 'string') return 'its target has the path "pointer" and no KHR_animation_pointer with a pointer';
      const material = /^\/materials\/(\d+)\//.exec(pointer);
      if (material) return item(this.from.file.json.materials, Number(material[1])) ? { material: Number(material[1]), pointer } : `${pointer} leads to no material`;
      const [property, lights, , index, name] = kProperties.exec(pointer) ?? [];
      if (property) {
        const { cameras, extensions } = this.from.file.json;
        if (!item(lights ? extensions?.KHR_lights_punctual?.lights : cameras, Number(index))) return `${pointer} leads to no ${lights ? 'lamp' : 'camera'}`;
        return { property, size: name === 'color' ? 3 : 1 };
      }
      const shown = /^\/nodes\/(\d+)\/extensions\/KHR_node_visibility\/visible$/.exec(pointer);
      if (shown) return item(this.from.file.json.nodes, Number(shown[1])) ? { node: Number(shown[1]), part: 'visible' } : `there is no node ${shown[1]}`;
      const part = /^\/nodes\/(\d+)\/(translation|rotation|scale|weights)$/.exec(pointer);
      if (!part) return null;
      node = Number(part[1]);
      path = part[2];
    }
    if (node === undefined) return null;
    const moved = item(this.from.file.json.nodes, node);
    if (!moved) return `there is no node ${JSON.stringify(node)}`;
    if (path !== 'weights' && !kParts.has(path)) return `${JSON.stringify(path)} is no path: it is translation, rotation, scale or weights`;
    if (path !== 'weights' && moved.matrix !== undefined) return `node ${node} has a matrix, and cannot be moved by its ${path}`;
    if (path === 'weights' && this.weights(node) === 0) return `the mesh of node ${node} has no morph targets`;
    return { node, part: path };
  }

  private curve(animation: any, channel: any, target: Target): Curve | string {
    const sampler = item(animation.samplers, channel.sampler);
    if (!sampler) return `there is no sampler ${JSON.stringify(channel.sampler)}`;
    const mode = sampler.interpolation ?? 'LINEAR';
    const visible = 'part' in target && target.part === 'visible';
    if (visible && mode !== 'STEP') return `what is seen or not has the interpolation STEP, and no ${JSON.stringify(mode)}`;
    if (mode !== 'LINEAR' && mode !== 'STEP' && mode !== 'CUBICSPLINE') return `the interpolation ${JSON.stringify(mode)} is none: it is LINEAR, STEP or CUBICSPLINE`;
    const times = once(this.times, sampler.input, () => this.timesOf(sampler.input));
    if (!times) return `the sampler's input, accessor ${JSON.stringify(sampler.input)}, cannot be read as times that go on from 0`;
    const read = once(this.values, sampler.output, () => this.valuesOf(sampler.output));
    if (!read) return `the sampler's output, accessor ${JSON.stringify(sampler.output)}, cannot be read as numbers`;
    const { data: values } = read;
    const size = visible ? 1 : 'pointer' in target ? read.size : 'property' in target ? target.size : target.part === 'weights' ? this.weights(target.node) : kParts.get(target.part)!;
    const needed = times.length * size * (mode === 'CUBICSPLINE' ? 3 : 1);
    if (values.length !== needed || ('part' in target && target.part !== 'weights' && read.size !== size))
      return `the sampler's output has ${values.length} numbers, ${read.size} in each element: ${times.length} times by ${mode} need ${needed}`;
    return { times, values, size, mode };
  }
  private timesOf(index: unknown): Float32Array | null {
    const read = this.from.numbers(index);
    if (read?.size !== 1 || !isCount(index)) return null;
    const { data } = read;
    return data.every((x, i) => isNear(x) && x >= (i === 0 ? 0 : data[i - 1])) ? data : null;
  }
  private valuesOf(index: unknown): { data: Float32Array; size: number } | null {
    const read = this.from.numbers(index);
    return read?.data.every(isNear) ? read : null;
  }
}
