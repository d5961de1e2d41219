// The blocks that are the same for all that a frame draws.
import type { Environment } from './environment';
import { element, kMostLights, type Light } from './lights';
import type { Mat4, Vec3 } from '../src/math';

/** Pictures in a second of the materials' time, whatever the screen shows of them. */
export const kPicturesPerSecond = 24;

/** What frameBlocks() is told beside the camera. `lod` is the last of scene_behind, whose rows run `down` the screen or up. */
export interface Surroundings {
  lod?: number;
  down?: boolean;
  brightness?: number;
}

/** The blocks of a frame, by the fields' places in templates/mesh.node (docs/bindings.md). */
export function frameBlocks(
  eye: Vec3, viewProjection: Mat4, environment: Environment, lights: Light[], seconds: number, { lod = 0, down = false, brightness = 1 }: Surroundings = {},
): Record<string, Uint8Array> {
  const frame = new DataView(new ArrayBuffer(96));
  viewProjection.forEach((x, i) => frame.setFloat32(4 * i, x, true));
  eye.forEach((x, i) => frame.setFloat32(64 + 4 * i, x, true));
  frame.setFloat32(76, brightness, true);
  frame.setFloat32(80, environment.lastLevel, true);
  frame.setInt32(84, lights.length, true);
  const all = new Float32Array(16 * kMostLights);
  lights.forEach((light, i) => all.set(element(light), 16 * i));
  const through = new Float32Array(16);
  const m = viewProjection;
  for (let k = 0; k < 4; ++k) {
    through[k] = 0.5 * (m[4 * k] + m[4 * k + 3]);
    through[4 + k] = 0.5 * (m[4 * k + 3] + (down ? -1 : 1) * m[4 * k + 1]);
    through[8 + k] = m[4 * k + 3];
  }
  through[12] = lod;
  const bytes = ({ buffer }: Float32Array) => new Uint8Array(buffer);
  const clock = new Float32Array([seconds, Math.floor(seconds * kPicturesPerSecond), 0, 0]);
  return { Frame: new Uint8Array(frame.buffer), Lights: bytes(all), SeeThrough: bytes(through), Clock: bytes(clock) };
}
