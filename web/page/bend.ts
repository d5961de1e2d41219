// Positions, normals and tangents as morph targets change them and joints of a skin take them along, in that order.
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
/** What a morph target adds. */
export type Target = Partial<Record<'POSITION' | 'NORMAL' | 'TANGENT', Float32Array>>;

const kBent = ['POSITION', 'NORMAL', 'TANGENT'] as const;

export class Bent {
  /** Those that are drawn: the bent ones are written anew. */
  readonly attributes: Drawable['attributes'];
  private readonly at: Drawable['attributes'];
  private readonly indices: Uint32Array;
  private last: number[];

  /** `bare`: it has no normals of its own, they are those of its triangles. */
  constructor(
    { attributes, indices }: Drawable, private readonly bare: boolean, readonly skin: Skin | null,
    private readonly sets: [Numbers, Numbers][], private readonly targets: Target[], private readonly rest: number[],
  ) {
    this.at = attributes;
    this.indices = indices;
    this.last = rest;
    this.attributes = new Map(attributes);
    for (const name of kBent) {
      const of = attributes.get(name);
      if (of) this.attributes.set(name, { data: of.data.slice(), size: of.size, version: 0 });
    }
  }
  /** How many numbers are made of a primitive. */
  static numbers(attributes: Drawable['attributes']): number {
    return kBent.reduce((sum, name) => sum + (attributes.get(name)?.data.length ?? 0), 0);
  }

  /** With these weights of the targets, or those at rest; where nothing has changed, all stays. */
  bend(given: number[] | null, anew = false): void {
    const weights = given ?? this.rest;
    const same = this.targets.length === 0 || weights.every((weight, i) => weight === this.last[i]);
    if (!anew && same && !this.skin?.moved) return;
    this.last = weights;
    for (const name of kBent) this.add(name, weights);
    const position = this.attributes.get('POSITION')!;
    if (this.skin) this.follow(this.skin);
    // A place that is none would take all others out of sight.
    const { data } = this.at.get('POSITION')!;
    for (let i = 0; i < data.length; ++i) if (!isNear(position.data[i])) position.data[i] = data[i];
    if (this.bare) this.attributes.get('NORMAL')!.data.set(facetNormals(position.data, this.indices));
    for (const name of kBent) {
      const of = this.attributes.get(name);
      if (of) of.version = of.version! + 1;
    }
  }

  private add(name: (typeof kBent)[number], weights: number[]): void {
    const [of, rest] = [this.attributes.get(name), this.at.get(name)];
    if (!of || !rest) return;
    const { data, size } = of;
    data.set(rest.data);
    this.targets.forEach((target, t) => {
      const by = weights[t] ?? 0;
      const change = target[name];
      if (by === 0 || !change) return;
      for (let v = 0, i = 0; i < change.length; v += size, i += 3) for (let k = 0; k < 3; ++k) data[v + k] += by * change[i + k];
    });
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
