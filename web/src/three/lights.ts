// The lights of a scene of three.js as the elements of the block Lights.
import {
  Vector3, type Camera, type DirectionalLight, type Light, type Object3D, type PointLight, type RectAreaLight, type Scene, type SpotLight,
  type WebGLRenderer,
} from 'three';
import { lightValues, type AreaLight, type PunctualLight } from '../webgpu.js';
import type { Values } from '../types.js';
import { kShadows } from './shadows.js';

const at = new Vector3();
const to = new Vector3();
type Triple = [number, number, number];

function between(light: DirectionalLight | SpotLight): Triple {
  at.setFromMatrixPosition(light.matrixWorld);
  to.setFromMatrixPosition(light.target.matrixWorld);
  return to.sub(at).normalize().toArray();
}

function rectangle(light: RectAreaLight): AreaLight {
  const [right, up] = [new Vector3(), new Vector3()];
  light.matrixWorld.extractBasis(right, up, to);
  const height = light.height * up.length();
  return {
    type: 'rect', position: at.setFromMatrixPosition(light.matrixWorld).toArray(), color: light.color.toArray() as Triple,
    intensity: light.intensity, size: height, aspect: (light.width * right.length()) / height,
    right: right.normalize().toArray(), up: up.normalize().toArray(),
  };
}

/** Null for what glTF has no light for: ambient and hemisphere lights, probes. */
function lightOf(light: Light, areas: boolean): PunctualLight | AreaLight | null {
  if ((light as RectAreaLight).isRectAreaLight) return areas ? rectangle(light as RectAreaLight) : null;
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
  /** Of three.js's shadows, by the uniforms that have them, the elements that they fall from. */
  shadows: Record<string, number[]>;
}

interface Seen {
  frame: number;
  lights: Light[];
}
const seen = new WeakMap<WebGLRenderer, WeakMap<Scene, Seen>>();
/** What the template forward_area has beside, of a light that is a point. */
const kPoint = { area_x: [0, 0, 0], area_y: [0, 0, 0], area_radiance: [0, 0, 0], disk: 0 };
const kIdle = { ...kPoint, ...lightValues({ type: 'point', intensity: 0 }) };

function visible(from: Object3D, camera: Camera, lights: Light[]): void {
  if (!from.visible) return;
  const light = from as Light;
  if (light.isLight && light.layers.test(camera.layers)) lights.push(light);
  for (const child of from.children) visible(child, camera, lights);
}

type Casting = Light & { map?: unknown };
/** As three.js orders them: the shadows of a kind are numbered in this order. */
const kCastingFirst = (a: Casting, b: Casting): number =>
  (b.castShadow ? 2 : 0) - (a.castShadow ? 2 : 0) + (b.map ? 1 : 0) - (a.map ? 1 : 0);

/** The element of each shadow; of a light that has none, the one behind them all. */
function shadowsOf(lights: Light[], drawn: Light[], size: number): Record<string, number[]> {
  const casting = [...lights].sort(kCastingFirst).filter(({ castShadow }) => castShadow);
  return Object.fromEntries(Object.entries(kShadows).map(([uniform, { light: kind }]) => {
    const elements = casting.filter((light) => (light as unknown as Record<string, unknown>)[kind]).map((light) => drawn.indexOf(light));
    return [uniform, padded(elements.map((element) => (element < 0 || element >= size ? size : element)), size)];
  }));
}
/** A uniform's array has one length for all scenes. */
const padded = (elements: number[], size: number): number[] => Array.from({ length: size }, (_, i) => elements[i] ?? size);

/** The first lights that a camera's layers see; those beyond the block's size are left out, which is said once. `areas`: the
 * template has lights that have an area. */
export function lightsOf(renderer: WebGLRenderer, scene: Scene, camera: Camera, size: number, areas: boolean): Lights {
  const { frame } = renderer.info.render;
  const scenes = seen.get(renderer) ?? new WeakMap<Scene, Seen>();
  seen.set(renderer, scenes);
  let known = scenes.get(scene);
  const most = known?.lights.length ?? 0;
  if (known?.frame !== frame) {
    known = { frame, lights: [] };
    visible(scene, camera, known.lights);
    scenes.set(scene, known);
  }
  const found = known.lights.map((light) => ({ light, as: lightOf(light, areas) })).filter(({ as }) => as !== null);
  const lights = found.map(({ as }) => as!);
  if (lights.length > size && most <= size) console.warn(`lacquer: the scene has ${lights.length} lights, of which the first ${size} are drawn`);
  const elements: Values[] = lights.slice(0, size).map((light) => ({ ...kPoint, ...lightValues(light) }));
  const { length: count } = elements;
  while (elements.length < size) elements.push(kIdle);
  return { elements, count, shadows: shadowsOf(known.lights, found.map(({ light }) => light), size) };
}
