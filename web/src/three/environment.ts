// The light around: the maps of `lacquer environment` as textures of three.js, and which scene has which.
import {
  CubeTexture, DataTexture, DataUtils, FloatType, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, RGBAFormat, RGFormat, type Scene,
  type Texture,
} from 'three';
import type { Lacquer } from '../index.js';
import { cubesOf, isMaps, kForm, kTable, radianceOf, tablesFor, type Cube, type EnvironmentMaps } from '../renderers/environment.js';
import type { EnvironmentForm } from '../types.js';

/** What surrounds a scene, for setEnvironment() or a material. */
export interface Environment {
  textures: Record<string, Texture>;
  /** environment_max_lod. */
  levels: number;
  dispose(): void;
}

function cubeOf({ edge, levels: texels }: Cube): CubeTexture {
  const levels = texels.map((faces, level) =>
    faces.map((face) => new DataTexture(face, edge >> level, edge >> level, RGBAFormat, HalfFloatType)));
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
function tableOf(pairs: Float32Array): DataTexture {
  const table = new DataTexture(Uint16Array.from(pairs, (x) => DataUtils.toHalfFloat(x)), kTable, kTable, RGFormat, HalfFloatType);
  table.magFilter = table.minFilter = LinearFilter;
  table.needsUpdate = true;
  return table;
}

const tables = new WeakMap<Lacquer, Record<string, Texture>>();
/** What lobes reflect, which holds in all surroundings. */
export function tablesOf(lacquer: Lacquer): Record<string, Texture> {
  let made = tables.get(lacquer);
  if (!made) {
    made = Object.fromEntries(Object.entries(tablesFor(lacquer)).map(([name, pairs]) => [name, tableOf(pairs)]));
    tables.set(lacquer, made);
  }
  return made;
}

/** From a picture of the surroundings, Radiance HDR, or a texture that HDRLoader made of one: filtered on the processor, for
 * seconds, in which the page waits. `form.size` and `form.samples` trade time for detail. Or, at once, from the maps that
 * lacquer.environment() made of one in a worker. */
export function environmentOf(
  lacquer: Lacquer,
  picture: Uint8Array | ArrayBuffer | Texture | EnvironmentMaps,
  form: EnvironmentForm = kForm,
): Environment {
  const file = picture instanceof ArrayBuffer ? new Uint8Array(picture) : picture;
  const { cubes, levels } = cubesOf(lacquer, file instanceof Uint8Array || isMaps(file) ? file : radiance(file), form);
  const textures: Record<string, Texture> = Object.fromEntries(Object.entries(cubes).map(([slot, cube]) => [slot, cubeOf(cube)]));
  return {
    textures,
    levels,
    dispose: () => Object.values(textures).forEach((texture) => texture.dispose()),
  };
}

/** The floats of an equirectangular texture as a picture in Radiance HDR. */
function radiance(texture: Texture): Uint8Array {
  const { data, width, height } = (texture?.image ?? {}) as { data?: ArrayLike<number>; width: number; height: number };
  const half = texture?.type === HalfFloatType;
  if (!data || data.length !== 4 * width * height || (!half && texture.type !== FloatType))
    throw new TypeError('an environment is the bytes of a Radiance picture, an equirectangular texture of RGBA floats as HDRLoader makes it, or the maps of environment()');
  return radianceOf(width, height, (i) => (half ? DataUtils.fromHalfFloat(data[i]) : data[i]));
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
  if (environment && environment.levels === undefined) throw new TypeError('this is no environment: environmentOf() makes one of a picture');
  if (environment) environments.set(scene, environment);
  else environments.delete(scene);
}
export const environmentIn = (scene: Scene): Environment => environments.get(scene) ?? darkness();
