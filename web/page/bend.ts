// Positions, normals, tangents, texture coordinates and colours as morph targets change them; the first three then go with the joints
// of a skin.
import type { Drawable, Numbers } from '../src/gltf';
import { isNear } from '../src/json';
import { facetNormals } from '../src/math';

export interface Skin {
  joints: number[];
  /** Inverse bind matrices; none: they are identities. */
  inverse: Float32Array | null;
  /** Of each joint: where it is, times its inverse bind matrix. */
  matrices: Float32Array;
  moved: boolean;
}
/** What a morph target adds, by the attributes' names. */
export type Target = ReadonlyMap<string, Numbers>;

const kBent = ['POSITION', 'NORMAL', 'TANGENT'] as const;
/** What a target may add to beside: those that shaders read. */
const kFlat = ['TEXCOORD_0', 'TEXCOORD_1', 'TEXCOORD_2', 'TEXCOORD_3', 'COLOR_0'];
/** Numbers of a vertex that a target may have, at least and at most. */
const kSizes = { POSITION: [3, 3], NORMAL: [3, 3], TANGENT: [3, 3], COLOR_0: [3, 4] } as Record<string, [number, number]>;
export const sizesOf = (name: string): [number, number] => kSizes[name] ?? [2, 2];

export class Bent {
  /** Those that are drawn: the bent ones are written anew. */
  readonly attributes: Drawable['attributes'];
  private readonly at: Drawable['attributes'];
  private readonly indices: Uint32Array;
  private readonly names: string[];
  private last: number[];

  /** `bare`: it has no normals of its own, they are those of its triangles. */
  constructor(
    { attributes, indices }: Drawable, private readonly bare: boolean, readonly skin: Skin | null,
    private readonly sets: [Numbers, Numbers][], private readonly targets: Target[], private readonly rest: number[],
  ) {
    this.names = Bent.names(attributes, new Set(targets.flatMap((target) => [...target.keys()])));
    this.at = attributes;
    this.indices = indices;
    this.last = rest;
    this.attributes = new Map(attributes);
    for (const name of this.names) {
      const of = attributes.get(name)!;
      this.attributes.set(name, { data: of.data.slice(), size: of.size, version: 0 });
    }
  }
  /** What is bent of a primitive by targets that have attributes of these names. */
  static names(attributes: Drawable['attributes'], targets: Set<string>): string[] {
    return [...kBent, ...kFlat.filter((name) => targets.has(name))].filter((name) => attributes.has(name));
  }

  /** With these weights of the targets, or those at rest; where nothing has changed, all stays. */
  bend(given: number[] | null, anew = false): void {
    const weights = given ?? this.rest;
    const same = this.targets.length === 0 || weights.every((weight, i) => weight === this.last[i]);
    if (!anew && same && !this.skin?.moved) return;
    this.last = weights;
    for (const name of this.names) this.add(name, weights);
    const position = this.attributes.get('POSITION')!;
    if (this.skin) this.follow(this.skin);
    // A place that is none would take all others out of sight.
    const { data } = this.at.get('POSITION')!;
    for (let i = 0; i < data.length; ++i) if (!isNear(position.data[i])) position.data[i] = data[i];
    if (this.bare) this.attributes.get('NORMAL')!.data.set(facetNormals(position.data, this.indices));
    for (const name of this.names) ++this.attributes.get(name)!.version!;
  }

  private add(name: string, weights: number[]): void {
    const { data, size } = this.attributes.get(name)!;
    data.set(this.at.get(name)!.data);
    this.targets.forEach((target, t) => {
      const by = weights[t] ?? 0;
      const change = target.get(name);
      if (by === 0 || !change) return;
      const most = Math.min(change.size, size);
      for (let v = 0, i = 0; i < change.data.length; v += size, i += change.size) for (let k = 0; k < most; ++k) data[v + k] += by * change.data[i + k];
    });
    if (name === 'COLOR_0') for (let i = 0; i < data.length; ++i) data[i] = Math.min(Math.max(data[i], 0), 1);
  }

  /** Each vertex by the sum of its joints' matrices; normals by the inverse transpose, but for its length. */
  private follow({ matrices }: Skin): void {
    const [position, normal, tangent] = kBent.map((name) => this.attributes.get(name)?.data);
    const stride = this.attributes.get('TANGENT')?.size ?? 4;
    const m = new Float64Array(12); // rows of four
    for (let v = 0; 3 * v < position!.length; ++v) {
      m.fill(0);
      for (const [joints, weights] of this.sets) {
        for (let k = 4 * v; k < 4 * v + 4; ++k) {
          const by = weights.data[k];
          if (by === 0) continue;
          const from = 16 * joints.data[k];
          for (let row = 0; row < 3; ++row) for (let column = 0; column < 4; ++column) m[4 * row + column] += by * matrices[from + 4 * column + row];
        }
      }
      turn(m, position!, 3 * v, 1);
      if (normal) turnNormal(m, normal, 3 * v);
      if (!tangent) continue;
      turn(m, tangent, stride * v, 0);
      shorten(tangent, stride * v);
    }
  }
}

function turn(m: Float64Array, data: Float32Array, at: number, w: number): void {
  const [x, y, z] = [data[at], data[at + 1], data[at + 2]];
  for (let row = 0; row < 3; ++row) data[at + row] = m[4 * row] * x + m[4 * row + 1] * y + m[4 * row + 2] * z + m[4 * row + 3] * w;
}
/** By the cofactors, which are the inverse transpose times the determinant. */
function turnNormal(m: Float64Array, data: Float32Array, at: number): void {
  const [x, y, z] = [data[at], data[at + 1], data[at + 2]];
  const c = (r: number, s: number, i: number, j: number) => m[4 * r + i] * m[4 * s + j] - m[4 * r + j] * m[4 * s + i];
  const side = m[0] * c(1, 2, 1, 2) - m[1] * c(1, 2, 0, 2) + m[2] * c(1, 2, 0, 1) < 0 ? -1 : 1;
  data[at] = side * (c(1, 2, 1, 2) * x - c(1, 2, 0, 2) * y + c(1, 2, 0, 1) * z);
  data[at + 1] = side * (-c(0, 2, 1, 2) * x + c(0, 2, 0, 2) * y - c(0, 2, 0, 1) * z);
  data[at + 2] = side * (c(0, 1, 1, 2) * x - c(0, 1, 0, 2) * y + c(0, 1, 0, 1) * z);
  shorten(data, at);
}
/** To length 1. */
function shorten(data: Float32Array, at: number): void {
  const length = Math.hypot(data[at], data[at + 1], data[at + 2]);
  if (length > 0) for (let k = 0; k < 3; ++k) data[at + k] /= length;
}
