// Where a picture is seen from: around the middle of what is shown, or by a camera of the file.
import { eachNode, type GltfFile, type Mat4, type Vec3 } from '../src/gltf';
import { isNear, item } from '../src/json';
import { add, cross, dot, lookAt, perspective, scale, sub, unit } from '../src/math';
import type { Moves } from './moves';

/** `rays` are from the eye to the right, up and ahead: those through (x, y) of the screen, from -1 to 1, are x right + y up + ahead. */
export interface View {
  eye: Vec3;
  view: Mat4;
  projection(aspect: number): Mat4;
  rays(aspect: number): Float32Array;
}

export interface Orbit {
  yaw: number;
  pitch: number;
  distance: number;
}

/** The tangent of half the angle that is seen from below to above. */
const kSlope = Math.tan(0.36);
/** Of a parallel projection the eye stands so many depths of it away: its rays are as good as parallel. */
const kFarAway = 1000;

const raysOf = (view: Mat4, across: number, up: number) =>
  Float32Array.from([across, up, -1].flatMap((by, row) => [view[row] * by, view[4 + row] * by, view[8 + row] * by]));

export function orbiting({ yaw, pitch, distance }: Orbit, middle: Vec3, radius: number): View {
  const eye = add(middle, scale([Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch)], distance * radius));
  const view = lookAt(eye, middle);
  // Of a picture that is higher than wide the width shows as much.
  const slope = (aspect: number) => kSlope / Math.min(aspect, 1);
  const near = Math.max(distance - 1.5, 0.02) * radius;
  return {
    eye, view,
    projection: (aspect) => perspective(2 * Math.atan(slope(aspect)), aspect, near, (distance + 3) * radius),
    rays: (aspect) => raysOf(view, slope(aspect) * aspect, slope(aspect)),
  };
}

/** What a camera of a file says, with `far` infinite where a perspective has no end. */
export type Lens =
  | { kind: 'perspective'; yfov: number; aspectRatio?: number; znear: number; zfar: number }
  | { kind: 'orthographic'; xmag: number; ymag: number; znear: number; zfar: number };

/** A camera's numbers by their names; a text where they make none. */
export function lensOf(type: unknown, of: Record<string, unknown>): Lens | string {
  const { znear, zfar = type === 'perspective' ? Infinity : undefined } = of;
  const above = (x: unknown, least: number): x is number => typeof x === 'number' && x > least && (isNear(x) || x === Infinity);
  if (type !== 'perspective' && type !== 'orthographic') return 'its type is "perspective" or "orthographic"';
  if (!isNear(znear) || znear < 0 || (type === 'perspective' && znear === 0)) return `znear is ${JSON.stringify(znear)}, and must be greater than 0`;
  if (!above(zfar, znear)) return `zfar is ${JSON.stringify(zfar)}, and must be greater than znear`;
  if (type === 'perspective') {
    const { yfov, aspectRatio } = of;
    if (!above(yfov, 0) || yfov >= Math.PI) return `yfov is ${JSON.stringify(yfov)}, and must be between 0 and pi`;
    return { kind: type, yfov, znear, zfar, ...(above(aspectRatio, 0) && isNear(aspectRatio) && { aspectRatio }) };
  }
  const [xmag, ymag] = [of.xmag, of.ymag];
  if (!isNear(zfar)) return 'zfar has no number';
  if (!isNear(xmag) || !isNear(ymag) || xmag === 0 || ymag === 0) return `xmag and ymag are ${JSON.stringify([xmag, ymag])}, and must not be 0`;
  return { kind: type, xmag: Math.abs(xmag), ymag: Math.abs(ymag), znear, zfar };
}

/** From a place in the world, whose scale a camera does not have. All that the camera shows is in the picture, whatever its form. */
export function seenBy(lens: Lens, world: Mat4): View {
  const column = (i: number): Vec3 => [world[4 * i], world[4 * i + 1], world[4 * i + 2]];
  const z = unit(column(2));
  const right = column(0);
  const x = unit(sub(right, scale(z, dot(z, right))));
  const y = cross(z, x);
  const from: Vec3 = [world[12], world[13], world[14]];
  const view = new Float32Array([x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, -dot(x, from), -dot(y, from), -dot(z, from), 1]);
  const { znear: near, zfar: far } = lens;
  if (lens.kind === 'perspective') {
    const slope = (aspect: number) => Math.tan(lens.yfov / 2) * Math.max((lens.aspectRatio ?? aspect) / aspect, 1);
    const [a, b] = far === Infinity ? [-1, -2 * near] : [(far + near) / (near - far), (2 * far * near) / (near - far)];
    return {
      eye: from, view,
      projection: (aspect) => new Float32Array([1 / (slope(aspect) * aspect), 0, 0, 0, 0, 1 / slope(aspect), 0, 0, 0, 0, a, -1, 0, 0, b, 0]),
      rays: (aspect) => raysOf(view, slope(aspect) * aspect, slope(aspect)),
    };
  }
  const high = (aspect: number) => Math.max(lens.ymag, lens.xmag / aspect);
  const away = kFarAway * Math.max(far, lens.xmag, lens.ymag);
  return {
    eye: add(from, scale(z, away)), view,
    projection: (aspect) => new Float32Array([
      1 / (high(aspect) * aspect), 0, 0, 0, 0, 1 / high(aspect), 0, 0, 0, 0, 2 / (near - far), 0, 0, 0, (far + near) / (near - far), 1,
    ]),
    rays: (aspect) => raysOf(view, (high(aspect) * aspect) / away, high(aspect) / away),
  };
}

/** The orbit that goes on where a view is: it looks the same way, at what is as far as the middle was; from nearer, where that is
 * further than an orbit goes. */
export function orbitFrom({ eye, view }: View, middle: Vec3, radius: number): { orbit: Orbit; middle: Vec3 } {
  const back: Vec3 = [view[2], view[6], view[10]];
  const depth = Math.max(dot(sub(eye, middle), back), 1.2 * radius);
  return {
    orbit: { yaw: Math.atan2(back[0], back[2]), pitch: Math.min(Math.max(Math.asin(Math.min(Math.max(back[1], -1), 1)), -1.5), 1.5), distance: Math.min(depth / radius, 20) },
    middle: sub(eye, scale(back, depth)),
  };
}

/** More are not offered. */
const kMostCameras = 1000;

export interface Camera {
  name: string;
  node: number;
  /** Of the file's list. */
  index: number;
}

/** Of the default scene; what is wrong with one leaves it out and is said. */
export class FileCameras {
  readonly all: Camera[] = [];
  readonly said: string[] = [];

  constructor(private readonly file: GltfFile) {
    eachNode(file, (node, _, index) => {
      const of = item(file.json.cameras, node.camera);
      if (!of || this.all.length === kMostCameras) return;
      const lens = this.lensOf(node.camera);
      if (typeof lens !== 'string') this.all.push({ name: String(node.name || of.name || '') || `camera ${this.all.length}`, node: index, index: node.camera });
      else if (this.said.length < 8) this.said.push(`${file.name}: /cameras/${node.camera}: ${lens}; it is left out`);
    });
  }

  private lensOf(index: number, moved?: ReadonlyMap<string, number[]>) {
    const { type, ...parts } = item(this.file.json.cameras, index);
    const numbers: Record<string, unknown> = { ...(typeof parts[type] === 'object' ? parts[type] : {}) };
    for (const name of ['yfov', 'aspectRatio', 'xmag', 'ymag', 'znear', 'zfar']) {
      const value = moved?.get(`/cameras/${index}/${type}/${name}`);
      if (value) numbers[name] = value[0];
    }
    return lensOf(type, numbers);
  }

  /** What a camera sees now; null where it stands nowhere. */
  at({ node, index }: Camera, moves: Moves): View | null {
    const world = moves.world(node);
    if (!world?.every(isNear)) return null;
    let lens = this.lensOf(index, moves.moved);
    if (typeof lens === 'string') lens = this.lensOf(index); // a curve may go where no camera is
    return typeof lens === 'string' ? null : seenBy(lens, world);
  }
}
