// Geometry of the page's own, and what stands for absent pictures.
import { cross, identity, scale, type Vec3 } from '../src/math';
import type { Drawable } from '../src/gltf';

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
  const attributes: Drawable['attributes'] = new Map();
  attributes.set('POSITION', { data: new Float32Array(position), size: 3 });
  attributes.set('NORMAL', { data: new Float32Array(normal), size: 3 });
  attributes.set('TANGENT', { data: new Float32Array(tangent), size: 4 });
  for (let i = 0; i < 4; ++i) attributes.set(`TEXCOORD_${i}`, { data: new Float32Array(uv), size: 2 });
  return { material: -1, model: identity(), normal: identity(), attributes, indices: new Uint32Array(indices) };
}

/** Texture coordinates of a square from -1 to 1 across z with `uv` in its middle. They change just so much that a shader
 * without vertex tangents, which asks their derivatives, finds the frame of `n` and `t`. */
export function cornersUv({ n, t, uv }: { n: Vec3; t: number[]; uv: number[] }): number[] {
  const flat = (x: Vec3) => [x[0] - (n[0] * x[2]) / n[2], x[1] - (n[1] * x[2]) / n[2]];
  const along: Vec3 = [t[0], t[1], t[2]];
  const [u, v] = [flat(along), flat(scale(cross(n, along), -t[3]))];
  const step = 1e-3 / (u[0] * v[1] - u[1] * v[0]);
  return [[-1, -1], [1, -1], [1, 1], [-1, 1]].flatMap(([x, y]) => [
    uv[0] + step * (x * v[1] - y * v[0]), uv[1] + step * (y * u[0] - x * u[1]),
  ]);
}

/** What stands for an absent image. */
export function neutral(slot: string): [number, number, number, number] {
  if (slot.endsWith('normal_texture')) return [128, 128, 255, 255];
  if (slot.endsWith('anisotropy_texture')) return [255, 128, 255, 255];
  return [255, 255, 255, 255];
}
