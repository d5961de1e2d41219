// What a program that draws glTF needs beside shaders: a file's JSON and bytes, its triangles and its images. It knows no
// materials: those the library reads. Whatever is wrong with a primitive leaves it out, and so does what is too much.
import { Reader } from './accessors.js';
import { isCount, isNear, item, list, numbersOf, once, rootsOf } from './json.js';
import { compose, facetNormals, identity, multiply, normalMatrix, point, type Mat4, type Vec3 } from './math.js';

export type { Mat4, Vec3 };

export interface GltfFile {
  name: string;
  bytes: Uint8Array;
  json: any;
  /** The binary chunk of a .glb that its first buffer is where it names none. */
  binary: Uint8Array | null;
  /** All chunks of a .glb; null for those that are no buffers. */
  chunks?: (Uint8Array | null)[];
  /** What the JSON names, by its URI or its name. */
  resources: Map<string, Uint8Array>;
}

/** Numbers of an attribute, so many for each vertex. */
export interface Numbers {
  data: Float32Array;
  size: number;
  /** Of those that are written again while they are drawn: another one each time. */
  version?: number;
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
  /** Its node, or one above, is not to be seen (KHR_node_visibility). */
  hidden?: boolean;
  /** The numbers of its node, and of the primitive in the node's mesh. */
  node?: number;
  primitive?: number;
  /** Of an instance (EXT_mesh_gpu_instancing): its place before the node's. */
  instance?: Mat4;
  /** The materials that it has in variants (KHR_materials_variants), by their numbers. */
  variants?: ReadonlyMap<number, number>;
  /** As floats, by the attributes' names. Primitives of one mesh at several places have one map, and those that name one
   * accessor, its one array. */
  attributes: Map<string, Numbers>;
  /** Of triangles. */
  indices: Uint32Array;
}

/** Of a file: more, which a few kilobytes can ask for, are left out. */
const kMostDrawables = 100_000;
const kMostVariants = 10_000;
function objectFrom(bytes: Uint8Array): any {
  const json = JSON.parse(new TextDecoder().decode(bytes));
  if (typeof json !== 'object' || json === null) throw new Error('the JSON is no object');
  return json;
}

/** Takes a .gltf or .glb apart; throws where there is no JSON. */
export function openGltf(name: string, bytes: Uint8Array, resources = new Map<string, Uint8Array>()): GltfFile {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 20 || view.getUint32(0, true) !== 0x46546c67)
    return { name, bytes, json: objectFrom(bytes), binary: null, resources };
  // Version 3, of glTF 2.1: lengths of 64 bits, behind a chunk's type and encoding.
  const wide = view.getUint32(4, true) === 3;
  const head = wide ? 16 : 8;
  let json: any = null;
  const chunks: (Uint8Array | null)[] = [];
  for (let at = wide ? 16 : 12; at + head <= bytes.length; ) {
    const size = wide ? Number(view.getBigUint64(at + 8, true)) : view.getUint32(at, true);
    const chunk = bytes.subarray(at + head, at + head + size);
    const kind = view.getUint32(wide ? at : at + 4, true);
    const plain = !wide || view.getUint32(at + 4, true) === 0;
    if (kind === 0x4e4f534a && json === null && plain) json = objectFrom(chunk);
    chunks.push(kind === 0x004e4942 && plain ? chunk : null);
    at += head + size;
    if (wide) at = Math.ceil(at / 8) * 8;
  }
  if (json === null) throw new Error('the file has no JSON');
  const binary = wide ? chunks[1] : chunks.find((chunk) => chunk !== null);
  return { name, bytes, json, binary: binary ?? null, chunks, resources };
}

/** How far fetchGltf() goes for a file that anyone may have written. */
export interface FetchLimits {
  /** Asked of each buffer and image that is not of the file's origin and below its folder; without it none is fetched. */
  allow?: (url: URL) => boolean;
  /** Bytes of the file, its buffers and its images together; 2^30 where it is not said. */
  maxBytes?: number;
  /** Requests for buffers and images; 512. */
  maxRequests?: number;
  /** Milliseconds for all of it; five minutes. */
  timeout?: number;
  signal?: AbortSignal;
}

/** Whether a URL is of the origin of `base` and below its folder, however the server reads escapes. */
function isBelow(url: URL, base: URL): boolean {
  const folder = base.pathname.slice(0, base.pathname.lastIndexOf('/') + 1);
  return base.origin !== 'null' && url.origin === base.origin && url.pathname.startsWith(folder) &&
    !/%2f|%5c|%00/i.test(url.pathname.slice(folder.length)) && url.username === '' && url.password === '';
}

/** A response's body; throws where it has more bytes than `take` allows. */
async function bodyOf(response: Response, take: (size: number) => void): Promise<Uint8Array> {
  const parts: Uint8Array[] = [];
  const reader = response.body?.getReader();
  let size = 0;
  for (let part = await reader?.read(); part && !part.done; part = await reader?.read()) {
    take(part.value.length);
    parts.push(part.value);
    size += part.value.length;
  }
  const bytes = new Uint8Array(size);
  let at = 0;
  for (const part of parts) {
    bytes.set(part, at);
    at += part.length;
  }
  return bytes;
}

/** A file, its buffers and its images from where they are; throws where one cannot be had, or the limits do not allow it.
 * Buffers and images are followed nowhere else: a redirect of one is an error. */
export async function fetchGltf(url: URL | string, limits: FetchLimits = {}): Promise<GltfFile> {
  const { allow, maxBytes = 2 ** 30, maxRequests = 512, timeout = 300_000, signal } = limits;
  const stop = new AbortController();
  const stopWith = () => stop.abort(signal?.reason);
  const timer = setTimeout(() => stop.abort(new Error(`${url}: it takes more than ${timeout} ms`)), timeout);
  signal?.addEventListener('abort', stopWith);
  if (signal?.aborted) stopWith();
  let left = maxBytes;
  const bytesAt = async (at: URL | string, redirect: RequestRedirect): Promise<[Uint8Array, string]> => {
    const response = await fetch(at, { redirect, signal: stop.signal });
    if (!response.ok) throw new Error(`${at}: ${response.status} ${response.statusText}`);
    const bytes = await bodyOf(response, (size) => {
      left -= size;
      if (left < 0) throw new Error(`${url}: it has more than ${maxBytes} bytes`);
    });
    return [bytes, response.url || String(at)];
  };
  try {
    const [bytes, from] = await bytesAt(url, 'follow');
    const file = openGltf(String(url), bytes);
    const uris = [...list(file.json.buffers), ...list(file.json.images)].map((each) => each?.uri);
    const named = [...new Set<string>(uris.filter((uri) => uri && typeof uri === 'string' && !uri.startsWith('data:')))];
    if (named.length > maxRequests) throw new Error(`${url}: it names more than ${maxRequests} files`);
    const base = new URL(from, globalThis.document?.baseURI);
    const targets = named.map((uri) => {
      const target = URL.canParse(uri, base) ? new URL(uri, base) : null;
      if (target && (isBelow(target, base) || allow?.(target))) return target;
      throw new Error(`${uri} is not below the folder of ${url}`);
    });
    await Promise.all(named.map(async (uri, i) => file.resources.set(uri, (await bytesAt(targets[i], 'error'))[0])));
    return file;
  } finally {
    stop.abort();  // what is under way has nobody left who waits for it
    clearTimeout(timer);
    signal?.removeEventListener('abort', stopWith);
  }
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
    let bytes: Uint8Array = new Uint8Array();
    try {
      bytes = fromBase64(uri.slice(comma + 1));
    } catch {
      // none: nor are they looked for again
    }
    file.resources.set(uri, bytes);
    return bytes;
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

/** What a file names, and is not there. */
export function missing(file: GltfFile): string[] {
  const uris = [...list(file.json.buffers), ...list(file.json.images)].map((each) => each?.uri);
  return [...new Set(uris)].filter((uri) => typeof uri === 'string' && !uri.startsWith('data:') && !resource(file, uri));
}

/** The bytes of a buffer view; null where they are not all there. */
export function bufferView(file: GltfFile, index: number): Uint8Array | null {
  const view = item(file.json.bufferViews, index);
  const buffer = item(file.json.buffers, view?.buffer);
  if (!buffer) return null;
  const bytes = typeof buffer.uri === 'string' ? resource(file, buffer.uri)
    : buffer.chunk === undefined ? file.binary : item(file.chunks, buffer.chunk);
  const from = view.byteOffset ?? 0;
  if (!bytes || !isCount(from) || !isCount(view.byteLength) || from + view.byteLength > bytes.length) return null;
  return bytes.subarray(from, from + view.byteLength);
}

/** The image of a texture: its own, one in another format that browsers decode, or one whose channels the shader takes. */
export function sourceOf(texture: any): number {
  const { EXT_texture_webp: webp, EXT_texture_avif: avif, NV_texture_swizzle: swizzle } = texture?.extensions ?? {};
  const own = [texture?.source, webp?.source, avif?.source].find(isCount);
  return own ?? list(swizzle?.options).find(inOneImage)?.source ?? -1;
}
const inOneImage = (option: any): boolean => isCount(option?.source) && !option.arrayLayer && list(option.channels).every((c) => Number(c) < 4);

/** An image as the browser decodes it, its numbers untouched; made smaller where a side has more than `most` pixels. null
 * where it is not there or no browser decodes it. */
export async function image(file: GltfFile, index: number, most = Infinity): Promise<ImageBitmap | null> {
  const of = item(file.json.images, index);
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

/** The corners of the triangles, three by three, from those of a list, a strip or a fan; null for lines and points. */
function triangles(mode: number, corners: Uint32Array): Uint32Array | null {
  if (mode === 4) return corners.length % 3 === 0 ? corners : corners.subarray(0, corners.length - (corners.length % 3));
  if (mode !== 5 && mode !== 6) return null;
  const made = new Uint32Array(3 * Math.max(corners.length - 2, 0));
  for (let t = 0; 3 * t < made.length; ++t) {
    const turned = mode === 5 ? t % 2 : 0;
    made[3 * t] = corners[mode === 6 ? 0 : t + turned];
    made[3 * t + 1] = corners[t + 1 - turned];
    made[3 * t + 2] = corners[t + 2];
  }
  return made;
}

type Shape = Pick<Drawable, 'material' | 'variants' | 'attributes' | 'indices' | 'primitive'>;

function shapeOf(from: Reader, of: any, primitive: number): Shape | null {
  const material = of?.material ?? -1;
  const positions = from.positions(of?.attributes?.POSITION);
  if (!positions || (material !== -1 && !isCount(material))) return null;
  const vertices = positions.length / 3;
  const attributes = new Map<string, Numbers>();
  for (const [name, index] of Object.entries(of.attributes)) {
    const read = from.numbers(index);
    // One that ends before the vertices do cannot be drawn with.
    if (read && read.size <= 4 && read.data.length === read.size * vertices) attributes.set(name, read);
  }
  const given = of.indices === undefined ? null : from.indices(of.indices);
  if (of.indices !== undefined && !given) return null;
  // Every primitive is gone through, and a strip is made to triangles, though its accessors are read once.
  const corners = given?.length ?? vertices;
  if (!from.takes((of.mode ?? 4) === 4 ? corners : 3 * corners)) return null;
  const indices = triangles(of.mode ?? 4, given ?? new Uint32Array(vertices).map((_, i) => i));
  if (!indices || indices.some((i) => i >= vertices)) return null;
  if (!attributes.has('NORMAL')) {
    if (!from.takes(positions.length)) return null;
    attributes.set('NORMAL', { data: facetNormals(positions, indices), size: 3 });
  }
  const variants = variantsOf(of);
  return { material, primitive, attributes, indices, ...(variants.size > 0 && { variants }) };
}

function variantsOf(primitive: any): Map<number, number> {
  const found = new Map<number, number>();
  for (const mapping of list(primitive.extensions?.KHR_materials_variants?.mappings)) {
    if (!isCount(mapping?.material)) continue;
    for (const variant of list(mapping.variants)) if (isCount(variant) && found.size < kMostVariants) found.set(variant, mapping.material);
  }
  return found;
}

/** Where a node's mesh is (EXT_mesh_gpu_instancing): at the node, or at each of its instances, before the node's place; null where they
 * cannot be read. */
function placesOf(from: Reader, node: any): (Mat4 | undefined)[] | null {
  const attributes = node.extensions?.EXT_mesh_gpu_instancing?.attributes;
  if (typeof attributes !== 'object' || attributes === null) return [undefined];
  const [t, r, s] = (['TRANSLATION', 'ROTATION', 'SCALE'] as const).map((name) => (attributes[name] === undefined ? undefined : from.numbers(attributes[name])));
  if ([t, r, s].includes(null) || (t && t.size !== 3) || (r && r.size !== 4) || (s && s.size !== 3)) return null;
  const counts = [t, r, s].flatMap((each) => (each ? [each.data.length / each.size] : []));
  const count = Math.min(counts.length > 0 ? Math.min(...counts) : 0, kMostDrawables);
  // Many nodes may name one accessor.
  if (!from.takes(16 * count)) return null;
  const at = (of: Numbers | null | undefined, i: number, otherwise: number[]) => (of ? [...of.data.subarray(of.size * i, of.size * (i + 1))] : otherwise);
  return Array.from({ length: count }, (_, i) => compose(at(t, i, [0, 0, 0]), at(r, i, [0, 0, 0, 1]), at(s, i, [1, 1, 1])));
}

/** Whether a node says that it is not seen, and all below it (KHR_node_visibility). */
export const hides = (node: any): boolean => node?.extensions?.KHR_node_visibility?.visible === false;

/** Calls with every node of the default scene, where it is in the world, its number, and whether it is not to be seen. */
export function eachNode(file: GltfFile, use: (node: any, world: Mat4, index: number, hidden: boolean) => void): void {
  const { nodes, scenes, scene = 0 } = file.json;
  const seen = new Set<number>(); // a node has one parent, and a broken file may go in circles
  const open: [number, Mat4, boolean][] = []; // a chain of nodes may be longer than the stack of calls is deep
  const push = (indices: any[], parent: Mat4, hidden: boolean) => {
    for (let i = indices.length; i-- > 0; ) open.push([indices[i], parent, hidden]); // the last is taken first
  };
  const roots = item(scenes, scene)?.nodes;
  push(roots === undefined ? rootsOf(list(nodes)) : list(roots), identity(), false);
  for (let next = open.pop(); next; next = open.pop()) {
    const [index, parent, above] = next;
    const node = item(nodes, index);
    if (!node || seen.has(index)) continue;
    seen.add(index);
    const matrix = numbersOf(node.matrix, 16);
    const local = matrix
      ? new Float32Array(matrix)
      : compose(numbersOf(node.translation, 3) ?? [0, 0, 0], numbersOf(node.rotation, 4) ?? [0, 0, 0, 1], numbersOf(node.scale, 3) ?? [1, 1, 1]);
    const world = multiply(parent, local);
    if (!world.every(isNear)) continue; // it would take what is drawn beside it out of sight
    const hidden = above || hides(node);
    use(node, world, index, hidden);
    push(list(node.children), world, hidden);
  }
}

/** Every triangle mesh of the default scene, in world space; of nodes that are not to be seen only when `hidden` asks for them. */
export function geometry(file: GltfFile, { hidden = false } = {}): Drawable[] {
  const found: Drawable[] = [];
  const from = new Reader(file);
  const made = new Map<any, Shape[]>();
  eachNode(file, (node, model, index, unseen) => {
    const mesh = item(file.json.meshes, node.mesh);
    const room = kMostDrawables - found.length;
    if (!mesh || room === 0 || (unseen && !hidden)) return;
    // What is left out of a mesh is not come upon again at its other nodes.
    const shapes = once(made, mesh, () => list(mesh.primitives).map((of, i) => shapeOf(from, of, i)).filter((shape) => shape !== null));
    if (shapes.length === 0) return;
    for (const instance of placesOf(from, node) ?? []) {
      const place = instance ? multiply(model, instance) : model;
      if (!place.every(isNear)) continue;
      const normal = normalMatrix(place);
      for (const shape of shapes.slice(0, kMostDrawables - found.length)) found.push({ model: place, normal, node: index, ...(unseen && { hidden: true }), ...(instance && { instance }), ...shape });
    }
  });
  return found;
}

/** The middle and the radius of what is seen of it; where nothing is, of all. */
export function bounds(drawables: Drawable[]): { middle: Vec3; radius: number } {
  const seen = drawables.filter(({ hidden }) => !hidden);
  const low: Vec3 = [Infinity, Infinity, Infinity];
  const high: Vec3 = [-Infinity, -Infinity, -Infinity];
  const boxes = new Map<Float32Array, Vec3[]>();
  for (const { attributes, model } of seen.length > 0 ? seen : drawables) {
    const positions = attributes.get('POSITION')!.data;
    for (const corner of once(boxes, positions, () => cornersOf(positions))) {
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
