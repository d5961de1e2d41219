// Geometry of the page's own.
import { identity } from '../src/math';
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
