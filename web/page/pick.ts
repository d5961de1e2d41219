// Which of a scene's triangles is seen at a place.
import type { Drawable } from '../src/gltf';
import { cross, dot, point, sub, type Vec3 } from '../src/math';

/** How far along a ray a triangle is, in lengths of `along`; Infinity where the ray goes past. */
function meets(from: Vec3, along: Vec3, a: Vec3, b: Vec3, c: Vec3): number {
  const [ab, ac] = [sub(b, a), sub(c, a)];
  const p = cross(along, ac);
  const determinant = dot(ab, p);
  if (determinant === 0) return Infinity;
  const to = sub(from, a);
  const u = dot(to, p) / determinant;
  const q = cross(to, ab);
  const v = dot(along, q) / determinant;
  const distance = dot(ac, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && distance > 0 ? distance : Infinity;
}

/** What a ray meets first; undefined where it is nothing. */
export function firstMet(drawables: Iterable<Drawable>, from: Vec3, along: Vec3): Drawable | undefined {
  let nearest = Infinity;
  let found: Drawable | undefined;
  const places = new Float64Array(9);
  for (const drawable of drawables) {
    const { attributes, indices, model } = drawable;
    const { data } = attributes.get('POSITION')!;
    for (let i = 0; i + 2 < indices.length; i += 3) {
      for (let k = 0; k < 3; ++k) places.set(point(model, data.subarray(3 * indices[i + k], 3 * indices[i + k] + 3)), 3 * k);
      const corner = (k: number): Vec3 => [places[3 * k], places[3 * k + 1], places[3 * k + 2]];
      const distance = meets(from, along, corner(0), corner(1), corner(2));
      if (distance >= nearest) continue;
      nearest = distance;
      found = drawable;
    }
  }
  return found;
}
