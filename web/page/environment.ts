// What surrounds the material: the studio of `lacquer preview`, given by formulas, as cube maps.
import { cross, dot, unit, type Vec3 } from '../src/math';

/** Radiance from a unit direction, blurred as the lobe of a roughness blurs it. */
export type Radiance = (direction: Vec3, roughness: number) => Vec3;

interface Softbox {
  middle: Vec3;
  across: Vec3;
  up: Vec3;
  width: number;
  height: number;
  radiance: Vec3;
}

function softbox(to: Vec3, width: number, height: number, radiance: Vec3): Softbox {
  const middle = unit(to);
  const across = unit(cross([0, 1, 0], middle));
  return { middle, across, up: cross(middle, across), width, height, radiance };
}

const kBoxes = [
  softbox([-0.62, 0.62, 0.62], 0.36, 0.36, [4.6, 4.5, 4.35]),
  softbox([0.95, 0.22, 0.3], 0.1, 0.75, [2.4, 2.6, 2.9]),
  softbox([0.15, 0.45, -1], 1.1, 0.14, [2.4, 2.4, 2.4]),
];
const kZenith: Vec3 = [0.34, 0.38, 0.44];
const kHorizon: Vec3 = [0.2, 0.205, 0.215];
const kGround: Vec3 = [0.055, 0.052, 0.048];

/** The error function, to 1.5e-7 (Abramowitz and Stegun 7.1.26). */
function erf(x: number): number {
  const t = 1 / (1 + 0.3275911 * Math.abs(x));
  const y = 1 - ((((1.061405429 * t - 1.453152027) * t + 1.421413741) * t - 0.284496736) * t + 0.254829592) * t * Math.exp(-x * x);
  return x < 0 ? -y : y;
}
const edge = (x: number, deviation: number) => 0.5 + 0.5 * erf(x / (deviation * Math.SQRT2));

function seen(box: Softbox, direction: Vec3, deviation: number): number {
  const depth = dot(direction, box.middle);
  if (depth <= 0) return 0;
  const x = dot(direction, box.across) / depth;
  const y = dot(direction, box.up) / depth;
  return (
    (edge(x + box.width, deviation) - edge(x - box.width, deviation)) *
    (edge(y + box.height, deviation) - edge(y - box.height, deviation))
  );
}

export const studio: Radiance = (direction, roughness) => {
  const deviation = 0.012 + 0.85 * roughness * roughness;
  const above = edge(direction[1], 0.02 + 0.5 * deviation);
  const height = Math.sqrt(Math.min(Math.max(direction[1], 0), 1));
  const parts = kBoxes.map((box) => seen(box, direction, deviation));
  return [0, 1, 2].map((i) => {
    const sky = kHorizon[i] + (kZenith[i] - kHorizon[i]) * height;
    const plain = kGround[i] + (sky - kGround[i]) * above;
    return parts.reduce((sum, part, box) => sum + part * kBoxes[box].radiance[i], plain);
  }) as Vec3;
};

/** Overcast: bright above, dark below. */
export const overcast: Radiance = (direction, roughness) => {
  const above = edge(direction[1], 0.15 + 0.6 * roughness * roughness);
  return [0.08 + 0.92 * above, 0.08 + 0.94 * above, 0.08 + 0.98 * above];
};

export const kEnvironments: Record<string, Radiance> = {
  Studio: studio,
  Overcast: overcast,
  Dark: () => [0, 0, 0],
};

const kFaces: ((s: number, t: number) => Vec3)[] = [
  (s, t) => [1, -t, -s],
  (s, t) => [-1, -t, s],
  (s, t) => [s, 1, t],
  (s, t) => [s, -1, -t],
  (s, t) => [s, -t, 1],
  (s, t) => [-s, -t, -1],
];

/** The texels of a face, row by row. */
function face(index: number, size: number, value: (direction: Vec3) => Vec3): Float32Array {
  const texels = new Float32Array(4 * size * size);
  for (let y = 0; y < size; ++y) {
    for (let x = 0; x < size; ++x) {
      const direction = unit(kFaces[index]((2 * x + 1) / size - 1, (2 * y + 1) / size - 1));
      texels.set([...value(direction), 1], 4 * (y * size + x));
    }
  }
  return texels;
}

/** Irradiance over pi, to the second order of spherical harmonics (Ramamoorthi and Hanrahan 2001). */
export function irradianceOf(radiance: Radiance): (normal: Vec3) => Vec3 {
  const basis = ([x, y, z]: Vec3) => [
    0.282095, 0.488603 * y, 0.488603 * z, 0.488603 * x, 1.092548 * x * y, 1.092548 * y * z,
    0.315392 * (3 * z * z - 1), 1.092548 * x * z, 0.546274 * (x * x - y * y),
  ];
  const cosine = [1, 2 / 3, 2 / 3, 2 / 3, 0.25, 0.25, 0.25, 0.25, 0.25];
  const rows = 48;
  const columns = 96;
  const sums = Array.from({ length: 9 }, () => [0, 0, 0]);
  for (let row = 0; row < rows; ++row) {
    const y = 1 - ((row + 0.5) * 2) / rows;
    const ring = Math.sqrt(1 - y * y);
    for (let column = 0; column < columns; ++column) {
      const angle = ((column + 0.5) * 2 * Math.PI) / columns;
      const direction: Vec3 = [ring * Math.cos(angle), y, ring * Math.sin(angle)];
      const light = radiance(direction, 0.3);
      basis(direction).forEach((b, k) =>
        light.forEach((x, i) => (sums[k][i] += (x * b * cosine[k] * 4 * Math.PI) / (rows * columns))),
      );
    }
  }
  return (normal) => {
    const b = basis(normal);
    return [0, 1, 2].map((i) => Math.max(0, b.reduce((sum, x, k) => sum + x * sums[k][i], 0))) as Vec3;
  };
}

/** A cube's levels, of each the six faces: RGBA, in the order of OpenGL and WebGPU. */
export interface Cube {
  size: number;
  levels: Float32Array[][];
  /** Another one when its texels are others. */
  version: number;
}

/** The two maps that shaders are given (docs/bindings.md). */
export interface Environment {
  specular: Cube;
  irradiance: Cube;
  lastLevel: number;
}

function cube(size: number, levels: number, value: (d: Vec3, level: number) => Vec3): Cube {
  const of = (level: number) => [0, 1, 2, 3, 4, 5].map((i) => face(i, Math.max(1, size >> level), (d) => value(d, level)));
  return { size, levels: Array.from({ length: levels }, (_, level) => of(level)), version: 0 };
}

export function makeEnvironment(radiance: Radiance, size: number): Environment {
  const levels = Math.max(1, Math.log2(size) - 1);
  const lastLevel = levels - 1;
  const irradiance = irradianceOf(radiance);
  return {
    specular: cube(size, levels, (d, level) => radiance(d, lastLevel > 0 ? level / lastLevel : 0)),
    irradiance: cube(Math.min(size, 16), 1, (d) => irradiance(d)),
    lastLevel,
  };
}

/** One that is the same from all sides. */
export function constantEnvironment(radiance: Vec3): Environment {
  const map = () => cube(1, 1, () => radiance);
  return { specular: map(), irradiance: map(), lastLevel: 0 };
}

const made = new Map<string, Environment>();

/** Of that name, made when it is first asked for. */
export function environmentOf(name: string): Environment {
  let found = made.get(name);
  if (!found) made.set(name, (found = makeEnvironment(kEnvironments[name] ?? studio, 64)));
  return found;
}

/** One of the user's own, in place of what had that name. */
export function addEnvironment(name: string, radiance: Radiance, size: number): void {
  made.set(name, makeEnvironment(radiance, size));
}

/** Where a direction comes to lie in a cube: the face, and in it from -1 to 1. */
function placeIn([x, y, z]: Vec3): [number, number, number] {
  const [ax, ay, az] = [Math.abs(x), Math.abs(y), Math.abs(z)];
  if (ax >= ay && ax >= az) return x > 0 ? [0, -z / ax, -y / ax] : [1, z / ax, -y / ax];
  if (ay >= az) return y > 0 ? [2, x / ay, z / ay] : [3, x / ay, -z / ay];
  return z > 0 ? [4, x / az, -y / az] : [5, -x / az, -y / az];
}

/** A level of a cube turned about +y: each texel is read between those of its direction's face. */
function turnLevel(from: Float32Array[], to: Float32Array[], angle: number): void {
  const size = Math.round(Math.sqrt(from[0].length / 4));
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  for (let index = 0; index < 6; ++index) {
    for (let at = 0; at < size * size; ++at) {
      const [x, y, z] = kFaces[index]((2 * (at % size) + 1) / size - 1, (2 * Math.floor(at / size) + 1) / size - 1);
      const [face, s, t] = placeIn([x * cos - z * sin, y, x * sin + z * cos]);
      const u = Math.min(Math.max(((s + 1) * size - 1) / 2, 0), size - 1);
      const v = Math.min(Math.max(((t + 1) * size - 1) / 2, 0), size - 1);
      const [u0, v0] = [Math.floor(u), Math.floor(v)];
      const [u1, v1] = [Math.min(u0 + 1, size - 1), Math.min(v0 + 1, size - 1)];
      const [a, b] = [u - u0, v - v0];
      const texels = from[face];
      for (let c = 0; c < 4; ++c) {
        const upper = texels[4 * (v0 * size + u0) + c] * (1 - a) + texels[4 * (v0 * size + u1) + c] * a;
        const lower = texels[4 * (v1 * size + u0) + c] * (1 - a) + texels[4 * (v1 * size + u1) + c] * a;
        to[index][4 * at + c] = upper * (1 - b) + lower * b;
      }
    }
  }
}

/** Environments turned about +y, in maps that are made once for each and filled again for another angle. */
export class Turned {
  private readonly made = new WeakMap<Environment, { turned: Environment; angle: number }>();

  of(environment: Environment, angle: number): Environment {
    if (angle === 0) return environment;
    let known = this.made.get(environment);
    if (!known) {
      const same = ({ size, levels }: Cube): Cube => ({ size, levels: levels.map((faces) => faces.map((texels) => texels.slice())), version: 0 });
      const { specular, irradiance, lastLevel } = environment;
      known = { turned: { specular: same(specular), irradiance: same(irradiance), lastLevel }, angle: 0 };
      this.made.set(environment, known);
    }
    if (known.angle === angle) return known.turned;
    known.angle = angle;
    for (const map of ['specular', 'irradiance'] as const) {
      environment[map].levels.forEach((faces, level) => turnLevel(faces, known.turned[map].levels[level], angle));
      ++known.turned[map].version;
    }
    return known.turned;
  }
}
