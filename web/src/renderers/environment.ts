// The maps of `lacquer environment` in memory, before they are a renderer's textures.
import type { Lacquer } from '../index.js';
import type { EnvironmentFiles, EnvironmentForm } from '../types.js';

/** A cube of half floats, four a texel: of each level, from the largest on, its faces +x, -x, +y, -y, +z, -z. */
export interface Cube {
  edge: number;
  levels: Uint16Array[][];
}

/** What lacquer.environment() gives, as KTX2 and half floats: made in a worker, or by `lacquer environment`. */
export type EnvironmentMaps = Pick<EnvironmentFiles, 'environment_max_lod' | 'files'>;

const kHalfTexel = 8;
const kHalfFormat = 97; // VK_FORMAT_R16G16B16A16_SFLOAT
const kCubes = ['environment_specular', 'environment_irradiance', 'environment_charlie'];

/** Of a KTX2 file as the library writes it. */
function cubeOf(slot: string, file: Uint8Array): Cube {
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  if (!(file.length > 80 && view.getUint8(0) === 0xab && view.getUint32(12, true) === kHalfFormat))
    throw new TypeError(`${slot} is no KTX2 file of half floats: environment() makes such without \`dds\` and \`shared_exponents\``);
  const edge = view.getUint32(20, true);
  const levels = Array.from({ length: view.getUint32(40, true) }, (_, level) => {
    const bytes = (edge >> level) ** 2 * kHalfTexel;
    const start = Number(view.getBigUint64(80 + 24 * level, true));
    return Array.from({ length: 6 }, (_face, face) => new Uint16Array(file.slice(start + face * bytes, start + (face + 1) * bytes).buffer));
  });
  return { edge, levels };
}

/** The maps by their slots, and environment_max_lod, of a Radiance picture or of what was made of one before. */
export function cubesOf(lacquer: Lacquer, from: Uint8Array | EnvironmentMaps, form: EnvironmentForm): { cubes: Record<string, Cube>; levels: number } {
  const maps = from instanceof Uint8Array ? lacquer.environment(from, 'environment.hdr', { ...form, dds: false, shared_exponents: false }) : from;
  const slots = kCubes.filter((slot) => maps.files[slot]);
  if (!slots.includes(kCubes[0])) throw new TypeError(`an environment has the map ${kCubes[0]}`);
  return { cubes: Object.fromEntries(slots.map((slot) => [slot, cubeOf(slot, maps.files[slot])])), levels: maps.environment_max_lod };
}
export const isMaps = (from: unknown): from is EnvironmentMaps => typeof (from as EnvironmentMaps)?.files === 'object';

/** Equirectangular floats, four a texel from the upper left on, as a picture in Radiance HDR. `at`: one of them. */
export function radianceOf(width: number, height: number, at: (i: number) => number): Uint8Array {
  const head = new TextEncoder().encode(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`);
  const bytes = new Uint8Array(head.length + 4 * width * height);
  bytes.set(head);
  for (let texel = 0; texel < width * height; ++texel) {
    const rgb = [0, 1, 2].map((i) => Math.max(at(4 * texel + i), 0));
    const most = Math.max(...rgb);
    if (!(most > 1e-32)) continue;
    const exponent = Math.floor(Math.log2(most)) + 1;
    const to = head.length + 4 * texel;
    rgb.forEach((x, i) => (bytes[to + i] = Math.min(Math.floor((x * 256) / 2 ** exponent), 255)));
    bytes[to + 3] = exponent + 128;
  }
  return bytes;
}

export const kTable = 64;
const tables = new WeakMap<Lacquer, Record<string, Float32Array>>();
/** The tables of what lobes reflect in any surroundings, which take a while to make: pairs from 0 to 1. */
export function tablesFor(lacquer: Lacquer): Record<string, Float32Array> {
  let made = tables.get(lacquer);
  if (!made) {
    made = { environment_dfg: lacquer.environmentDfg(kTable), environment_sheen: lacquer.environmentSheen(kTable) };
    tables.set(lacquer, made);
  }
  return made;
}

/** environmentOf()'s, where nothing else is asked for. */
export const kForm: EnvironmentForm = { size: 64, samples: 64 };
