// A glTF file's JSON, bytes and geometry, as far as the page shows them. Whatever is wrong with a primitive leaves it
// out: what is wrong with materials, the library says.
import { compose, identity, multiply, normalMatrix, point, type Mat4, type Vec3 } from './math';

export interface GltfFile {
  name: string;
  json: any;
  binary: Uint8Array | null;
  resources: Map<string, Uint8Array>;
}

export interface Drawable {
  material: number;
  model: Mat4;
  normal: Mat4;
  /** The model swaps front and back faces. */
  mirrored?: boolean;
  /** Float arrays by attribute, with their number of components. */
  attributes: Map<string, { data: Float32Array; size: number }>;
  indices: Uint32Array;
}

const decoder = new TextDecoder();

/** The JSON text and the binary chunk of a .gltf or .glb; throws where there is no JSON. */
export function openFile(name: string, bytes: Uint8Array, resources: Map<string, Uint8Array>): GltfFile {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 20 || view.getUint32(0, true) !== 0x46546c67)
    return { name, json: JSON.parse(decoder.decode(bytes)), binary: null, resources };
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
  return { name, json, binary, resources };
}

export function fromBase64(text: string): Uint8Array {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

/** The bytes behind a URI; null where they are not there. Names are looked for whole, then without their folders. */
export function resource(file: GltfFile, uri: string): Uint8Array | null {
  if (uri.startsWith('data:')) {
    const comma = uri.indexOf(',');
    return uri.slice(0, comma).endsWith(';base64') ? fromBase64(uri.slice(comma + 1)) : null;
  }
  let plain = uri;
  try {
    plain = decodeURIComponent(uri);
  } catch {
    // it stands for itself
  }
  const last = plain.slice(plain.lastIndexOf('/') + 1);
  return file.resources.get(uri) ?? file.resources.get(plain) ?? file.resources.get(last) ?? null;
}

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

/** An image as the browser decodes it, its numbers untouched. */
export async function image(file: GltfFile, index: number): Promise<ImageBitmap | null> {
  const of = file.json.images?.[index];
  if (!of) return null;
  const bytes = typeof of.uri === 'string' ? resource(file, of.uri) : bufferView(file, of.bufferView);
  if (!bytes) return null;
  try {
    const blob = new Blob([bytes.slice()], { type: of.mimeType ?? '' });
    return await createImageBitmap(blob, { premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
  } catch {
    return null; // no format that browsers decode: a neutral colour stands for it
  }
}

const kReaders: Record<number, [number, (v: DataView, at: number) => number, number]> = {
  5120: [1, (v, at) => v.getInt8(at), 127],
  5121: [1, (v, at) => v.getUint8(at), 255],
  5122: [2, (v, at) => v.getInt16(at, true), 32767],
  5123: [2, (v, at) => v.getUint16(at, true), 65535],
  5125: [4, (v, at) => v.getUint32(at, true), 1],
  5126: [4, (v, at) => v.getFloat32(at, true), 1],
};
const kSizes: Record<string, number> = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };

function accessor(file: GltfFile, index: number): { data: Float32Array; size: number } | null {
  const of = file.json.accessors?.[index];
  const reader = kReaders[of?.componentType];
  const size = kSizes[of?.type];
  if (!of || !reader || !size || of.sparse) return null;
  const bytes = bufferView(file, of.bufferView);
  if (!bytes) return null;
  const [width, read, largest] = reader;
  const stride = file.json.bufferViews[of.bufferView].byteStride || width * size;
  const start = of.byteOffset ?? 0;
  if (!(of.count > 0) || start + stride * (of.count - 1) + width * size > bytes.length) return null;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const data = new Float32Array(of.count * size);
  for (let i = 0; i < data.length; ++i) {
    const x = read(view, start + stride * Math.floor(i / size) + width * (i % size));
    data[i] = of.normalized ? Math.max(x / largest, -1) : x;
  }
  return { data, size };
}

function primitive(file: GltfFile, of: any, model: Mat4): Drawable | null {
  if (of?.mode !== undefined && of.mode !== 4) return null;
  const attributes = new Map<string, { data: Float32Array; size: number }>();
  for (const [name, index] of Object.entries(of?.attributes ?? {})) {
    const read = accessor(file, index as number);
    if (read) attributes.set(name, read);
  }
  const positions = attributes.get('POSITION');
  if (!positions || positions.size !== 3) return null;
  const vertices = positions.data.length / 3;
  const given = of.indices === undefined ? null : accessor(file, of.indices);
  const indices = given ? Uint32Array.from(given.data) : Uint32Array.from({ length: vertices }, (_, i) => i);
  if (indices.some((i) => i >= vertices)) return null;
  if (!attributes.has('NORMAL')) attributes.set('NORMAL', { data: facetNormals(positions.data, indices), size: 3 });
  return { material: of.material ?? -1, model, normal: normalMatrix(model), attributes, indices };
}

function facetNormals(positions: Float32Array, indices: Uint32Array): Float32Array {
  const normals = new Float32Array(positions.length);
  const at = (i: number) => positions.subarray(3 * i, 3 * i + 3);
  for (let t = 0; t + 2 < indices.length; t += 3) {
    const [a, b, c] = [at(indices[t]), at(indices[t + 1]), at(indices[t + 2])];
    const u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    const v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    for (let k = 0; k < 3; ++k) n.forEach((x, i) => (normals[3 * indices[t + k] + i] += x));
  }
  return normals;
}

/** Calls with every node of the default scene and where it is in the world. */
export function eachNode(file: GltfFile, use: (node: any, world: Mat4) => void): void {
  const { nodes = [], scenes = [], scene = 0 } = file.json;
  const walk = (index: number, parent: Mat4, depth: number) => {
    const node = nodes[index];
    if (!node || depth > 64) return;
    const local = Array.isArray(node.matrix)
      ? new Float32Array(node.matrix)
      : compose(node.translation ?? [0, 0, 0], node.rotation ?? [0, 0, 0, 1], node.scale ?? [1, 1, 1]);
    const world = multiply(parent, local);
    use(node, world);
    for (const child of node.children ?? []) walk(child, world, depth + 1);
  };
  for (const root of scenes[scene]?.nodes ?? nodes.map((_: unknown, i: number) => i)) walk(root, identity(), 0);
}

/** Every triangle mesh of the default scene, in world space. */
export function geometry(file: GltfFile): Drawable[] {
  const found: Drawable[] = [];
  eachNode(file, (node, world) => {
    for (const of of file.json.meshes?.[node.mesh]?.primitives ?? []) {
      const made = primitive(file, of, world);
      if (made) found.push(made);
    }
  });
  return found;
}

/** The middle and the radius of what is drawn. */
export function bounds(drawables: Drawable[]): { middle: Vec3; radius: number } {
  const low: Vec3 = [Infinity, Infinity, Infinity];
  const high: Vec3 = [-Infinity, -Infinity, -Infinity];
  for (const { attributes, model } of drawables) {
    const { data } = attributes.get('POSITION')!;
    for (let i = 0; i < data.length; i += 3) {
      point(model, data.subarray(i, i + 3)).forEach((x, k) => {
        low[k] = Math.min(low[k], x);
        high[k] = Math.max(high[k], x);
      });
    }
  }
  const middle = low.map((x, k) => (x + high[k]) / 2) as Vec3;
  return { middle, radius: Math.hypot(...low.map((x, k) => high[k] - x)) / 2 || 1 };
}

/** A ball of radius 1; the half that faces +z shows a texture once. */
export function ball(): Drawable {
  const rows = 96;
  const columns = 192;
  const position: number[] = [];
  const tangent: number[] = [];
  const uv: number[] = [];
  for (let r = 0; r <= rows; ++r) {
    for (let c = 0; c <= columns; ++c) {
      const longitude = (c / columns) * 2 * Math.PI - Math.PI;
      const latitude = (r / rows) * Math.PI;
      const ring = Math.sin(latitude);
      position.push(ring * Math.sin(longitude), Math.cos(latitude), ring * Math.cos(longitude));
      tangent.push(Math.cos(longitude), 0, -Math.sin(longitude), 1);
      uv.push(longitude / Math.PI + 0.5, r / rows);
    }
  }
  const indices: number[] = [];
  for (let r = 0; r < rows; ++r) {
    for (let c = 0; c < columns; ++c) {
      const a = r * (columns + 1) + c;
      const b = a + columns + 1;
      indices.push(a, b, b + 1, a, b + 1, a + 1);
    }
  }
  return flatDrawable(position, position, tangent, uv, indices);
}

/** With all attributes that a shader may ask for. */
export function flatDrawable(position: number[], normal: number[], tangent: number[], uv: number[], indices: number[]): Drawable {
  const attributes = new Map<string, { data: Float32Array; size: number }>();
  attributes.set('POSITION', { data: new Float32Array(position), size: 3 });
  attributes.set('NORMAL', { data: new Float32Array(normal), size: 3 });
  attributes.set('TANGENT', { data: new Float32Array(tangent), size: 4 });
  for (let i = 0; i < 4; ++i) attributes.set(`TEXCOORD_${i}`, { data: new Float32Array(uv), size: 2 });
  return { material: -1, model: identity(), normal: identity(), attributes, indices: new Uint32Array(indices) };
}
