// The lights of a scene of three.js as the elements of the block Lights.
import {
  Vector3, type Camera, type DirectionalLight, type Light, type Object3D, type PointLight, type Scene, type SpotLight,
  type WebGLRenderer,
} from 'three';
import { lightValues, type PunctualLight } from '../webgpu.js';
import type { Values } from '../types.js';

const at = new Vector3();
const to = new Vector3();
type Triple = [number, number, number];

function between(light: DirectionalLight | SpotLight): Triple {
  at.setFromMatrixPosition(light.matrixWorld);
  to.setFromMatrixPosition(light.target.matrixWorld);
  return to.sub(at).normalize().toArray();
}

/** Null for what glTF has no light for: ambient and hemisphere lights, probes, rectangles. */
function punctual(light: Light): PunctualLight | null {
  const position = at.setFromMatrixPosition(light.matrixWorld).toArray() as Triple;
  const color = light.color.toArray() as Triple;
  const common = { position, color, intensity: light.intensity };
  if ((light as DirectionalLight).isDirectionalLight) return { ...common, type: 'directional', direction: between(light as DirectionalLight) };
  if ((light as SpotLight).isSpotLight) {
    const { angle, penumbra, distance } = light as SpotLight;
    const cone = { innerConeAngle: angle * (1 - penumbra), outerConeAngle: angle };
    return { ...common, type: 'spot', direction: between(light as SpotLight), range: distance, ...cone };
  }
  return (light as PointLight).isPointLight ? { ...common, type: 'point', range: (light as PointLight).distance } : null;
}

/** Elements of the block, as many as it has. */
export interface Lights {
  elements: Values[];
  count: number;
}

interface Seen {
  frame: number;
  lights: PunctualLight[];
}
const seen = new WeakMap<Scene, Seen>();
const kIdle = lightValues({ type: 'point', intensity: 0 });

function visible(from: Object3D, camera: Camera, lights: PunctualLight[]): void {
  if (!from.visible) return;
  const light = from as Light;
  const made = light.isLight && light.layers.test(camera.layers) ? punctual(light) : null;
  if (made) lights.push(made);
  for (const child of from.children) visible(child, camera, lights);
}

/** The first lights that a camera's layers see; those beyond the block's size are left out, which is said once. */
export function lightsOf(renderer: WebGLRenderer, scene: Scene, camera: Camera, size: number): Lights {
  const { frame } = renderer.info.render;
  let known = seen.get(scene);
  if (known?.frame !== frame) {
    const lights: PunctualLight[] = [];
    visible(scene, camera, lights);
    if (lights.length > size && !(known && known.lights.length > size))
      console.warn(`lacquer: the scene has ${lights.length} lights, of which the first ${size} are drawn`);
    known = { frame, lights };
    seen.set(scene, known);
  }
  const elements = known.lights.slice(0, size).map(lightValues);
  const { length: count } = elements;
  while (elements.length < size) elements.push(kIdle);
  return { elements, count };
}
