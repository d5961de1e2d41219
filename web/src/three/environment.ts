// The light around: the maps of `lacquer environment` as textures of three.js, and which scene has which.
import {
  CubeTexture, DataTexture, DataUtils, FloatType, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, RGBAFormat, RGFormat, type Scene,
  type Texture,
} from 'three';
import type { Lacquer } from '../index.js';
import type { EnvironmentForm } from '../types.js';

/** What surrounds a scene, for setEnvironment() or a material. */
export interface Environment {
  textures: Record<string, Texture>;
  /** environment_max_lod. */
  levels: number;
  dispose(): void;
}

const kHalfTexel = 8;

/** A cube of half floats, in KTX2, as the library writes it: from the largest level on. */
function cubeOf(file: Uint8Array): CubeTexture {
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const edge = view.getUint32(20, true);
  const levels = Array.from({ length: view.getUint32(40, true) }, (_, level) => {
    const size = edge >> level;
    const start = Number(view.getBigUint64(80 + 24 * level, true));
    return Array.from({ length: 6 }, (_face, face) => {
      const at = start + face * size * size * kHalfTexel;
      const texels = new Uint16Array(file.slice(at, at + size * size * kHalfTexel).buffer);
      return new DataTexture(texels, size, size, RGBAFormat, HalfFloatType);
    });
  });
  const cube = new CubeTexture(levels[0] as unknown as HTMLImageElement[]);
  cube.format = RGBAFormat;
  cube.type = HalfFloatType;
  cube.mipmaps = levels.slice(1).map((image) => ({ image })) as unknown as typeof cube.mipmaps;
  cube.generateMipmaps = false;
  cube.magFilter = LinearFilter;
  cube.minFilter = levels.length > 1 ? LinearMipmapLinearFilter : LinearFilter;
  cube.needsUpdate = true;
  return cube;
}

/** A table of pairs from 0 to 1. */
function tableOf(pairs: Float32Array, size: number): DataTexture {
  const table = new DataTexture(Uint16Array.from(pairs, (x) => DataUtils.toHalfFloat(x)), size, size, RGFormat, HalfFloatType);
  table.magFilter = table.minFilter = LinearFilter;
  table.needsUpdate = true;
  return table;
}

const kTable = 64;
const tables = new WeakMap<Lacquer, Record<string, Texture>>();
/** What lobes reflect, which holds in all surroundings. */
export function tablesOf(lacquer: Lacquer): Record<string, Texture> {
  let made = tables.get(lacquer);
  if (!made) {
    made = {
      environment_dfg: tableOf(lacquer.environmentDfg(kTable), kTable),
      environment_sheen: tableOf(lacquer.environmentSheen(kTable), kTable),
    };
    tables.set(lacquer, made);
  }
  return made;
}

/** From a picture of the surroundings, Radiance HDR, or a texture that HDRLoader made of one: filtered on the processor, for
 * seconds, in which the page waits. `form.size` and `form.samples` trade time for detail. */
export function environmentOf(
  lacquer: Lacquer,
  picture: Uint8Array | ArrayBuffer | Texture,
  form: EnvironmentForm = { size: 64, samples: 64 },
): Environment {
  const file = picture instanceof ArrayBuffer ? new Uint8Array(picture) : picture;
  const bytes = file instanceof Uint8Array ? file : radianceOf(file);
  const { files, environment_max_lod } = lacquer.environment(bytes, 'environment.hdr', { ...form, dds: false, shared_exponents: false });
  const textures: Record<string, Texture> = {};
  for (const slot of ['environment_specular', 'environment_irradiance', 'environment_charlie']) {
    if (files[slot]) textures[slot] = cubeOf(files[slot]);
  }
  return {
    textures,
    levels: environment_max_lod,
    dispose: () => Object.values(textures).forEach((texture) => texture.dispose()),
  };
}

/** The floats of an equirectangular texture as a picture in Radiance HDR. */
function radianceOf(texture: Texture): Uint8Array {
  const { data, width, height } = (texture?.image ?? {}) as { data?: ArrayLike<number>; width: number; height: number };
  const half = texture?.type === HalfFloatType;
  if (!data || data.length !== 4 * width * height || (!half && texture.type !== FloatType))
    throw new TypeError('an environment is the bytes of a Radiance picture, or an equirectangular texture of RGBA floats as HDRLoader makes it');
  const head = new TextEncoder().encode(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`);
  const bytes = new Uint8Array(head.length + 4 * width * height);
  bytes.set(head);
  const at = (i: number) => Math.max(half ? DataUtils.fromHalfFloat(data[i]) : data[i], 0);
  for (let texel = 0; texel < width * height; ++texel) {
    const rgb = [at(4 * texel), at(4 * texel + 1), at(4 * texel + 2)];
    const most = Math.max(...rgb);
    if (!(most > 1e-32)) continue;
    const exponent = Math.floor(Math.log2(most)) + 1;
    const to = head.length + 4 * texel;
    rgb.forEach((x, i) => (bytes[to + i] = Math.min(Math.floor((x * 256) / 2 ** exponent), 255)));
    bytes[to + 3] = exponent + 128;
  }
  return bytes;
}

const kNothing = (): Environment => {
  const cube = new CubeTexture(Array.from({ length: 6 }, () => {
    return new DataTexture(new Uint16Array(4), 1, 1, RGBAFormat, HalfFloatType);
  }) as unknown as HTMLImageElement[]);
  cube.format = RGBAFormat;
  cube.type = HalfFloatType;
  cube.generateMipmaps = false;
  cube.minFilter = LinearFilter;
  cube.needsUpdate = true;
  return {
    textures: { environment_specular: cube, environment_irradiance: cube, environment_charlie: cube },
    levels: 0,
    dispose: () => undefined,
  };
};
let nothing: Environment | undefined;
/** No light around. */
export const darkness = (): Environment => (nothing ??= kNothing());

const environments = new WeakMap<Scene, Environment>();
/** Lights all materials of a scene that have no environment of their own. The scene's `environmentIntensity` and
 * `environmentRotation` hold for it; with null it has none any more. */
export function setEnvironment(scene: Scene, environment: Environment | null): void {
  if (environment && !environment.textures) throw new TypeError('this is no environment: environmentOf() makes one of a picture');
  if (environment) environments.set(scene, environment);
  else environments.delete(scene);
}
export const environmentIn = (scene: Scene): Environment => environments.get(scene) ?? darkness();
