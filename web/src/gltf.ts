// What a program that draws glTF needs beside shaders: a file's JSON and bytes, its triangles and its images. It knows no
// materials: those the library reads. Whatever is wrong with a primitive leaves it out.
import { compose, identity, multiply, normalMatrix, point, type Mat4, type Vec3 } from './math.js';

export type { Mat4, Vec3 };

export interface GltfFile {
  name: string;
  bytes: Uint8Array;
  json: any;
  /** The binary chunk of a .glb. */
  binary: Uint8Array | null;
  /** What the JSON names, by its URI or its name. */
  resources: Map<string, Uint8Array>;
}

/** Numbers of an attribute, so many for each vertex. */
export interface Numbers {
  data: Float32Array;
  size: number;
}

/** A primitive and its place in the world. */
export interface Drawable {
  /** -1: it has none, and is drawn with the default one. */
  material: number;
  model: Mat4;
  /** The inverse transpose of the model's upper 3x3. */
  normal: Mat4;
  /** The model swaps front and back faces. */
  mirrored?: boolean;
  /** As floats, by the attributes' names. Primitives of one mesh at several places have one map. */
  attributes: Map<string, Numbers>;
  /** Of triangles. */
  indices: Uint32Array;
}

const decoder = new TextDecoder();

/** Takes a .gltf or .glb apart; throws where there is no JSON. */
export function openGltf(name: string, bytes: Uint8Array, resources = new Map<string, Uint8Array>()): GltfFile {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 20 || view.getUint32(0, true) !== 0x46546c67)
    return { name, bytes, json: JSON.parse(decoder.decode(bytes)), binary: null, resources };
  let json: any = null;
  let binary: Uint8Array | null = null;
  for (let at = 12; at + 8 <= bytes.length; ) {
    const size = view.getUint32(at, true);
    const chunk = bytes.subarray(at + 8, at + 8 + size);
    const kind = view.getUint32(at + 4, true);
    if (kind === 0x4e4f534a && json === null) json = JSON.parse(decoder.decode(chunk));
    if (kind === 0x004e4942 && binary === null) binary = chunk;
    at += 8 + size;
  }
  if (json === null) throw new Error('the file has no JSON');
  return { name, bytes, json, binary, resources };
}

/** A file, its buffers and its images from where they are; throws where one cannot be had. */
export async function fetchGltf(url: URL | string): Promise<GltfFile> {
  const bytesAt = async (at: URL | string) => {
    const response = await fetch(at);
    if (!response.ok) throw new Error(`${at}: ${response.status} ${response.statusText}`);
    return new Uint8Array(await response.arrayBuffer());
  };
  const file = openGltf(String(url), await bytesAt(url));
  const { buffers = [], images = [] } = file.json;
  const named = new Set<string>([...buffers, ...images].map(({ uri }) => uri).filter((uri) => uri && !uri.startsWith('data:')));
  const base = new URL(url, globalThis.document?.baseURI);
  await Promise.all([...named].map(async (uri) => file.resources.set(uri, await bytesAt(new URL(uri, base)))));
  return file;
}

export function fromBase64(text: string): Uint8Array {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

/** The bytes behind a URI; null where they are not there. Names are looked for whole, then without their folders; what is
 * in the URI itself is decoded once. */
function resource(file: GltfFile, uri: string): Uint8Array | null {
  const known = file.resources.get(uri);
  if (known) return known;
  if (uri.startsWith('data:')) {
    const comma = uri.indexOf(',');
    if (!uri.slice(0, comma).endsWith(';base64')) return null;
    try {
      const bytes = fromBase64(uri.slice(comma + 1));
      file.resources.set(uri, bytes);
      return bytes;
    } catch {
      return null;
    }
  }
  let plain = uri;
  try {
    plain = decodeURIComponent(uri);
  } catch {
    // it stands for itself
  }
  const last = plain.slice(plain.lastIndexOf('/') + 1);
  return file.resources.get(plain) ?? file.resources.get(last) ?? null;
}

/** The bytes of a buffer view; null where they are not all there. */
export function bufferView(file: GltfFile, index: number): Uint8Array | null {
  const view = file.json.bufferViews?.[index];
  const buffer = file.json.buffers?.[view?.buffer];
  if (!view || !buffer) return null;
  const bytes = typeof buffer.uri === 'string' ? resource(file, buffer.uri) : file.binary;
  const from = view.byteOffset ?? 0;
  if (!bytes || from + view.byteLength > bytes.length) return null;
  return bytes.subarray(from, from + view.byteLength);
}

/** The image of a texture: its own, or one in another format that browsers decode. */
export function sourceOf(texture: any): number {
  const { EXT_texture_webp: webp, EXT_texture_avif: avif } = texture?.extensions ?? {};
  return texture?.source ?? webp?.source ?? avif?.source ?? -1;
}

/** An image as the browser decodes it, its numbers untouched; made smaller where a side has more than `most` pixels. null
 * where it is not there or no browser decodes it. */
export async function image(file: GltfFile, index: number, most = Infinity): Promise<ImageBitmap | null> {
  const of = file.json.images?.[index];
  if (!of) return null;
  const bytes = typeof of.uri === 'string' ? resource(file, of.uri) : bufferView(file, of.bufferView);
  if (!bytes) return null;
  const untouched = { premultiplyAlpha: 'none', colorSpaceConversion: 'none' } as const;
  try {
    const whole = await createImageBitmap(new Blob([bytes.slice()], { type: of.mimeType ?? '' }), untouched);
    const by = most / Math.max(whole.width, whole.height);
    if (by >= 1) return whole;
    const [resizeWidth, resizeHeight] = [whole.width, whole.height].map((side) => Math.max(1, Math.round(side * by)));
    const smaller = await createImageBitmap(whole, { ...untouched, resizeWidth, resizeHeight, resizeQuality: 'high' });
    whole.close();
    return smaller;
  } catch {
    return null;
  }
}

type Stored = Int8Array | Uint8Array | Int16Array | Uint16Array | Uint32Array | Float32Array;
/** By component type: arrays, their elements' bytes, and the number that stands for 1 where it is normalized. */
const kArrays: Record<number, [new (buffer: ArrayBuffer) => Stored, number, number]> = {
  5120: [Int8Array, 1, 127], 5121: [Uint8Array, 1, 255], 5122: [Int16Array, 2, 32767], 5123: [Uint16Array, 2, 65535],
  5125: [Uint32Array, 4, 1], 5126: [Float32Array, 4, 1],
};
const kSizes: Record<string, number> = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };
const isCount = (x: unknown) => Number.isInteger(x) && (x as number) >= 0;

/** The elements of an accessor one behind the other, as they are stored; null where it has none that can be read. */
function stored(file: GltfFile, index: number): { data: Stored; size: number; largest: number } | null {
  const of = file.json.accessors?.[index];
  const [Kind, component, largest] = kArrays[of?.componentType] ?? [];
  const size = kSizes[of?.type];
  if (!Kind || !component || !largest || !size || of.sparse || !isCount(of.count) || of.count === 0) return null;
  const bytes = bufferView(file, of.bufferView);
  if (!bytes) return null;
  const width = size * component;
  const stride = file.json.bufferViews[of.bufferView].byteStride ?? width;
  const start = of.byteOffset ?? 0;
  if (!isCount(start) || !isCount(stride) || stride < width || start + stride * (of.count - 1) + width > bytes.length) return null;
  const packed = new Uint8Array(width * of.count);
  if (stride === width) packed.set(bytes.subarray(start, start + packed.length));
  else for (let i = 0; i < of.count; ++i) packed.set(bytes.subarray(start + i * stride, start + i * stride + width), i * width);
  return { data: new Kind(packed.buffer), size, largest };
}

/** An accessor as floats; what is normalized is from -1 or 0 to 1. */
function numbers(file: GltfFile, index: number): Numbers | null {
  const read = stored(file, index);
  if (!read) return null;
  const { data, size, largest } = read;
  if (data instanceof Float32Array) return { data, size };
  if (!file.json.accessors[index].normalized) return { data: Float32Array.from(data), size };
  const floats = new Float32Array(data.length);
  for (let i = 0; i < data.length; ++i) floats[i] = Math.max(data[i] / largest, -1);
  return { data: floats, size };
}

/** The corners of the triangles, three by three, from those of a list, a strip or a fan; null for lines and points. */
function triangles(mode: number, corners: Uint32Array): Uint32Array | null {
  if (mode === 4) return corners.subarray(0, corners.length - (corners.length % 3));
  if (mode !== 5 && mode !== 6) return null;
  const made = new Uint32Array(3 * Math.max(corners.length - 2, 0));
  for (let t = 0; 3 * t < made.length; ++t) {
    const turned = mode === 5 && t % 2 === 1 ? [t + 1, t, t + 2] : [t, t + 1, t + 2];
    if (mode === 6) turned[0] = 0;
    turned.forEach((at, k) => (made[3 * t + k] = corners[at]));
  }
  return made;
}

function primitive(file: GltfFile, of: any): Pick<Drawable, 'attributes' | 'indices'> | null {
  const attributes = new Map<string, Numbers>();
  for (const [name, index] of Object.entries(of?.attributes ?? {})) {
    const read = numbers(file, index as number);
    if (read) attributes.set(name, read);
  }
  const positions = attributes.get('POSITION');
  if (!positions || positions.size !== 3) return null;
  const vertices = positions.data.length / 3;
  const given = of.indices === undefined ? null : stored(file, of.indices);
  if (of.indices !== undefined && !given) return null;
  const indices = triangles(of.mode ?? 4, given ? Uint32Array.from(given.data) : Uint32Array.from({ length: vertices }, (_, i) => i));
  if (!indices || indices.some((i) => i >= vertices)) return null;
  if (!attributes.has('NORMAL')) attributes.set('NORMAL', { data: facetNormals(positions.data, indices), size: 3 });
  return { attributes, indices };
}

/** The sum of the triangles' normals at each vertex. */
function facetNormals(p: Float32Array, indices: Uint32Array): Float32Array {
  const normals = new Float32Array(p.length);
  for (let t = 0; t + 2 < indices.length; t += 3) {
    const [a, b, c] = [3 * indices[t], 3 * indices[t + 1], 3 * indices[t + 2]];
    const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
    const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
    for (const at of [a, b, c]) {
      normals[at] += uy * vz - uz * vy;
      normals[at + 1] += uz * vx - ux * vz;
      normals[at + 2] += ux * vy - uy * vx;
    }
  }
  return normals;
}

/** Calls with every node of the default scene and where it is in the world. */
export function eachNode(file: GltfFile, use: (node: any, world: Mat4) => void): void {
  const { nodes = [], scenes = [], scene = 0 } = file.json;
  const seen = new Set<number>(); // a node has one parent, and a broken file may go in circles
  const walk = (index: number, parent: Mat4) => {
    const node = nodes[index];
    if (!node || seen.has(index)) return;
    seen.add(index);
    const local = Array.isArray(node.matrix)
      ? new Float32Array(node.matrix)
      : compose(node.translation ?? [0, 0, 0], node.rotation ?? [0, 0, 0, 1], node.scale ?? [1, 1, 1]);
    const world = multiply(parent, local);
    use(node, world);
    for (const child of node.children ?? []) walk(child, world);
  };
  for (const root of scenes[scene]?.nodes ?? nodes.map((_: unknown, i: number) => i)) walk(root, identity());
}

/** Every triangle mesh of the default scene, in world space. */
export function geometry(file: GltfFile): Drawable[] {
  const found: Drawable[] = [];
  const made = new Map<any, ReturnType<typeof primitive>>();
  eachNode(file, (node, model) => {
    for (const of of file.json.meshes?.[node.mesh]?.primitives ?? []) {
      if (!made.has(of)) made.set(of, primitive(file, of));
      const shape = made.get(of);
      if (shape) found.push({ material: of.material ?? -1, model, normal: normalMatrix(model), ...shape });
    }
  });
  return found;
}

/** The middle and the radius of what is drawn. */
export function bounds(drawables: Drawable[]): { middle: Vec3; radius: number } {
  const low: Vec3 = [Infinity, Infinity, Infinity];
  const high: Vec3 = [-Infinity, -Infinity, -Infinity];
  const boxes = new Map<Map<string, Numbers>, Vec3[]>();
  for (const { attributes, model } of drawables) {
    if (!boxes.has(attributes)) boxes.set(attributes, cornersOf(attributes.get('POSITION')!.data));
    for (const corner of boxes.get(attributes)!) {
      point(model, corner).forEach((x, k) => {
        low[k] = Math.min(low[k], x);
        high[k] = Math.max(high[k], x);
      });
    }
  }
  const middle = low.map((x, k) => (x + high[k]) / 2) as Vec3;
  return { middle, radius: Math.hypot(...low.map((x, k) => high[k] - x)) / 2 || 1 };
}

/** The eight corners of the box around positions. */
function cornersOf(positions: Float32Array): Vec3[] {
  const ends: Vec3[] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (let i = 0; i < positions.length; ++i) {
    const [x, k] = [positions[i], i % 3];
    if (x < ends[0][k]) ends[0][k] = x;
    if (x > ends[1][k]) ends[1][k] = x;
  }
  return Array.from({ length: 8 }, (_, i) => [0, 1, 2].map((k) => ends[(i >> k) & 1][k]) as Vec3);
}
