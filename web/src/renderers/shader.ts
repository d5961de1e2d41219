// What a renderer's materials have of a graph: its shader, and the numbers of its parameters.
import type { Graph, Shader } from '../index.js';
import type { Interface, Message, Options, Parameter } from '../types.js';

/** A shader in ESSL. */
export interface Essl {
  shader: Shader;
  interface: Interface;
  text: Record<'vertex' | 'fragment', string>;
}

/** Of blocks without a size: lists of any length. */
const kLists = ['lights', 'list'];

/** The shader of a graph. Throws where a renderer has not what its template asks for. */
export function esslOf(graph: Graph, options: Options, messages: Message[], renderer: string): Essl {
  const shader = graph.generate({ ...options, targets: ['essl'] }, messages);
  const about = shader.interface;
  const [color] = (about.outputs ?? []) as { type: string }[];
  if (!shader.hasVertexStage || color?.type !== 'vec4' || about.uniforms.some(({ role, array }) => !array && kLists.includes(role)))
    throw new TypeError(`${renderer} draws the templates forward, forward_area and what extends them, not ${about.template}`);
  return { shader, interface: about, text: { vertex: shader.text('essl', 'vertex'), fragment: shader.text('essl', 'fragment') } };
}

/** The numbers of a material after a change. Throws where a name is no parameter's or a value no number. */
export function changedNumbers(
  parameters: Parameter[],
  now: Record<string, number[]>,
  values: Record<string, number | ArrayLike<number>>,
): Record<string, number[]> {
  const known = new Set(parameters.map(({ name }) => name));
  const changed = { ...now };
  for (const [name, value] of Object.entries(values)) {
    if (!known.has(name)) throw new RangeError(`the material has no parameter ${name}; it has ${[...known].join(', ') || 'none'}`);
    changed[name] = typeof value === 'number' ? [value] : Array.from(value ?? []);
    if (!changed[name].length || !changed[name].every(Number.isFinite)) throw new TypeError(`${name}: ${value} is no number, and no array of them`);
  }
  return changed;
}

/** The block SeeThrough, of a camera's matrix and a picture's size. */
export function behindValues(viewProjection: ArrayLike<number>, width: number, height: number): Record<string, number | number[]> {
  const m = viewProjection;
  const row = (make: (x: number, y: number, w: number) => number) => [0, 1, 2, 3].map((i) => make(m[4 * i], m[4 * i + 1], m[4 * i + 3]));
  return {
    scene_u: row((x, _, w) => (x + w) / 2),
    scene_v: row((_, y, w) => (y + w) / 2),
    scene_w: row((_x, _y, w) => w),
    scene_max_lod: Math.floor(Math.log2(Math.max(width, height))),
  };
}

/** A float counts whole numbers to here. */
const kLongestTime = 16_777_216;
/** The block Clock. */
export const clockValues = (frame: number) => ({ time: (performance.now() / 1000) % kLongestTime, frame: frame % kLongestTime });
