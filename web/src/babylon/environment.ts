// The light around: the maps of `lacquer environment` as textures of Babylon.js, or a scene's own cube.
import { Constants } from '@babylonjs/core/Engines/constants.js';
import type { AbstractEngine } from '@babylonjs/core/Engines/abstractEngine.js';
import type { ThinEngine } from '@babylonjs/core/Engines/thinEngine.js';
import { BaseTexture } from '@babylonjs/core/Materials/Textures/baseTexture.js';
import '@babylonjs/core/Materials/Textures/baseTexture.polynomial.js';
import { RawCubeTexture } from '@babylonjs/core/Materials/Textures/rawCubeTexture.js';
import { RawTexture } from '@babylonjs/core/Materials/Textures/rawTexture.js';
import { Matrix } from '@babylonjs/core/Maths/math.vector.js';
import { ToHalfFloat } from '@babylonjs/core/Misc/textureTools.js';
import type { SphericalPolynomial } from '@babylonjs/core/Maths/sphericalPolynomial.js';
import type { Scene } from '@babylonjs/core/scene.js';
import type { Lacquer } from '../index.js';
import { cubesOf, isMaps, kForm, kTable, tablesFor, type Cube, type EnvironmentMaps } from '../renderers/environment.js';
import type { EnvironmentForm } from '../types.js';

/** What surrounds a scene, for setEnvironment() or a material. */
export interface Environment {
  textures: Record<string, BaseTexture>;
  /** environment_max_lod. */
  levels: number;
  dispose(): void;
}

/** An environment as a scene has it at the moment: beside its textures what the lookups of its cubes need. */
export interface Surroundings {
  textures: Record<string, BaseTexture>;
  levels: number;
  intensity: number;
  /** From the world to the cube, column by column. */
  turn: Float32Array;
  /** What the shader reads as lacquer_levels. */
  steps: [number, number, number, number];
}

const kHalf = Constants.TEXTURETYPE_HALF_FLOAT;

function cubeOf(scene: Scene, { edge, levels }: Cube): RawCubeTexture {
  const [mode, bilinear] = [Constants.TEXTURE_TRILINEAR_SAMPLINGMODE, Constants.TEXTURE_BILINEAR_SAMPLINGMODE];
  const mips = levels.length > 1;
  const cube = new RawCubeTexture(scene, levels[0], edge, Constants.TEXTUREFORMAT_RGBA, kHalf, mips, false, mips ? mode : bilinear);
  const texture = cube.getInternalTexture();
  const engine = scene.getEngine() as ThinEngine & AbstractEngine; // WebGL's
  // What was generated below them is not looked up.
  for (let level = 1; level < levels.length && texture; ++level)
    levels[level].forEach((face, i) => engine.updateTextureData(texture, face, 0, 0, edge >> level, edge >> level, i, level));
  cube.gammaSpace = false;
  return cube;
}

function tableOf(scene: Scene, pairs: Float32Array): RawTexture {
  const halves = Uint16Array.from(pairs, (x) => ToHalfFloat(x));
  const table = new RawTexture(
    halves, kTable, kTable, Constants.TEXTUREFORMAT_RG, scene, false, false, Constants.TEXTURE_BILINEAR_SAMPLINGMODE, kHalf,
  );
  table.wrapU = table.wrapV = Constants.TEXTURE_CLAMP_ADDRESSMODE;
  table.gammaSpace = false;
  return table;
}

/** What each scene has of its own, which goes with it. */
const tables = new WeakMap<Scene, Record<string, BaseTexture>>();
/** What lobes reflect, which holds in all surroundings. */
export function tablesOf(lacquer: Lacquer, scene: Scene): Record<string, BaseTexture> {
  let made = tables.get(scene);
  if (!made) {
    made = Object.fromEntries(Object.entries(tablesFor(lacquer)).map(([name, pairs]) => [name, tableOf(scene, pairs)]));
    tables.set(scene, made);
  }
  return made;
}

/** From a picture of the surroundings, Radiance HDR: filtered on the processor, for seconds, in which the page waits. `form.size` and
 * `form.samples` trade time for detail. Or, at once, from the maps that lacquer.environment() made of one in a worker. */
export function environmentOf(
  lacquer: Lacquer,
  scene: Scene,
  picture: Uint8Array | ArrayBuffer | EnvironmentMaps,
  form: EnvironmentForm = kForm,
): Environment {
  const from = picture instanceof ArrayBuffer ? new Uint8Array(picture) : picture;
  if (!(from instanceof Uint8Array || isMaps(from)))
    throw new TypeError('an environment is the bytes of a Radiance picture, or the maps of environment()');
  const { cubes, levels } = cubesOf(lacquer, from, form);
  const textures: Record<string, BaseTexture> = Object.fromEntries(Object.entries(cubes).map(([slot, cube]) => [slot, cubeOf(scene, cube)]));
  return { textures, levels, dispose: () => Object.values(textures).forEach((texture) => texture.dispose()) };
}

const kBlack: Cube = { edge: 1, levels: [Array.from({ length: 6 }, () => new Uint16Array(4))] };
const darknesses = new WeakMap<Scene, Environment>();
/** No light around. */
function darkness(scene: Scene): Environment {
  let made = darknesses.get(scene);
  if (!made) {
    const cube = cubeOf(scene, kBlack);
    made = {
      textures: { environment_specular: cube, environment_irradiance: cube, environment_charlie: cube },
      levels: 0, dispose: () => undefined,
    };
    darknesses.set(scene, made);
  }
  return made;
}

const environments = new WeakMap<Scene, Environment>();
/** Lights all materials of a scene that have no environment of their own, in the place of the scene's `environmentTexture`; null
 * gives that its place back. The scene's `environmentIntensity` holds for it. */
export function setEnvironment(scene: Scene, environment: Environment | null): void {
  if (environment && environment.levels === undefined) throw new TypeError('this is no environment: environmentOf() makes one of a picture');
  if (environment) environments.set(scene, environment);
  else environments.delete(scene);
}

const kIrradianceEdge = 16;
/** Where the texels of a cube's faces +x, -x, +y, -y, +z, -z look to, for u and v from -1 to 1. */
const kFaces: ((u: number, v: number) => number[])[] = [
  (u, v) => [1, -v, -u], (u, v) => [-1, -v, u], (u, v) => [u, 1, v], (u, v) => [u, -1, -v], (u, v) => [u, -v, 1], (u, v) => [-u, -v, -1],
];

/** The irradiance over pi that Babylon.js's materials have as harmonics, as a cube. */
function irradianceOf(scene: Scene, { preScaledHarmonics: of }: SphericalPolynomial): RawCubeTexture {
  const at = (n: number[]) => {
    const [x, y, z] = n.map((each) => each / Math.hypot(...n));
    const terms = [
      [of.l00, 1], [of.l1_1, y], [of.l10, z], [of.l11, x], [of.l2_2, y * x], [of.l2_1, y * z], [of.l20, 3 * z * z - 1], [of.l21, z * x],
      [of.l22, x * x - y * y],
    ] as const;
    return (['x', 'y', 'z'] as const).map((channel) => terms.reduce((sum, [each, factor]) => sum + each[channel] * factor, 0));
  };
  const edge = kIrradianceEdge;
  const middle = (i: number) => ((i + 0.5) / edge) * 2 - 1;
  const faces = kFaces.map((to) => {
    const texels = new Uint16Array(4 * edge * edge);
    for (let i = 0; i < edge * edge; ++i) {
      const rgb = at(to(middle(i % edge), middle(Math.floor(i / edge))));
      texels.set([...rgb.map((each) => Math.max(each, 0)), 1].map(ToHalfFloat), 4 * i);
    }
    return texels;
  });
  return cubeOf(scene, { edge, levels: [faces] });
}

const irradiances = new WeakMap<BaseTexture, { polynomial: SphericalPolynomial; cube: BaseTexture }>();
/** Null until it is known. */
function irradianceIn(scene: Scene, texture: BaseTexture): BaseTexture | null {
  if (texture.irradianceTexture) return texture.irradianceTexture.isReady() ? texture.irradianceTexture : null;
  const polynomial = texture.sphericalPolynomial;
  if (!polynomial) return null;
  const known = irradiances.get(texture);
  if (known?.polynomial === polynomial) return known.cube;
  known?.cube.dispose();
  const cube = irradianceOf(scene, polynomial);
  irradiances.set(texture, { polynomial, cube });
  return cube;
}

/** A file's world as the loader puts it into a left-handed scene: mirrored in x. */
const kMirrored = new Float32Array([-1, 0, 0, 0, 1, 0, 0, 0, 1]);
const kPlain = new Float32Array([1, 0, 0, 0, 1, 0, 0, 0, 1]);

/** A cube of the scene, with its levels as Babylon.js filters them. Null until it has all that is needed. */
function own(scene: Scene, texture: BaseTexture): Surroundings | null {
  const irradiance = texture.isReady() ? irradianceIn(scene, texture) : null;
  if (!irradiance) return null;
  const m = (texture.getReflectionTextureMatrix?.() ?? Matrix.Identity()).asArray();
  const z = scene.useRightHandedSystem !== Boolean(texture.invertZ) ? -1 : 1;
  const turn = new Float32Array([0, 1, 2].flatMap((column) => [m[4 * column], m[4 * column + 1], z * m[4 * column + 2]]));
  const { width } = texture.getSize();
  return {
    textures: { environment_specular: texture, environment_irradiance: irradiance, environment_charlie: texture },
    levels: 1, intensity: scene.environmentIntensity * texture.level, turn,
    steps: [texture.lodGenerationScale, texture.lodGenerationOffset, texture.linearSpecularLOD ? 2 : 1, width],
  };
}

/** What surrounds a material. A texture without radiance, and one that is not loaded, is dark. */
export function surroundingsOf(scene: Scene, environment: Environment | null): Surroundings {
  const given = environment ?? environments.get(scene);
  const texture = scene.environmentTexture;
  if (!given && texture?.isCube && !texture.gammaSpace && !texture.isRGBD) {
    const found = own(scene, texture);
    if (found) return found;
  }
  const { textures, levels } = given ?? darkness(scene);
  return { textures, levels, intensity: scene.environmentIntensity, turn: scene.useRightHandedSystem ? kPlain : kMirrored, steps: [0, 0, 0, 0] };
}
