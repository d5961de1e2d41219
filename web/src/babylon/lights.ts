// The lights of a scene of Babylon.js as the elements of the block Lights.
import { Light } from '@babylonjs/core/Lights/light.js';
import type { ShadowLight } from '@babylonjs/core/Lights/shadowLight.js';
import type { SpotLight } from '@babylonjs/core/Lights/spotLight.js';
import { lightValues, type PunctualLight } from '../webgpu.js';
import type { Values } from '../types.js';

type Triple = [number, number, number];

/** Null for what glTF has no light for: hemispheric lights. */
function lightOf(light: Light): PunctualLight | null {
  const kind = light.getTypeID();
  const kinds: Record<number, PunctualLight['type']> = {
    [Light.LIGHTTYPEID_DIRECTIONALLIGHT]: 'directional', [Light.LIGHTTYPEID_POINTLIGHT]: 'point', [Light.LIGHTTYPEID_SPOTLIGHT]: 'spot',
  };
  const type = kinds[kind];
  if (!type) return null;
  const of = light as ShadowLight;
  const moved = of.computeTransformedInformation();
  const position = (moved ? of.transformedPosition : of.position).asArray() as Triple;
  const range = light.range < 1e9 ? light.range : 0; // Babylon.js has the largest number for none
  const common = { type, position, color: light.diffuse.asArray() as Triple, intensity: light.getScaledIntensity(), range };
  if (type === 'point') return common;
  const direction = (moved ? of.transformedDirection : of.direction).normalizeToNew().asArray() as Triple;
  if (type === 'directional') return { ...common, direction };
  const { innerAngle, angle } = light as SpotLight;
  return { ...common, direction, innerConeAngle: innerAngle / 2, outerConeAngle: angle / 2 };
}

/** What the template forward_area has beside, of a light that is a point. */
const kPoint = { area_x: [0, 0, 0], area_y: [0, 0, 0], area_radiance: [0, 0, 0], disk: 0 };
const kIdle: Values = { ...kPoint, ...lightValues({ type: 'point', intensity: 0 }) };

/** Those that have elements, in their order. */
export const drawnLights = (lights: Light[]): Light[] => lights.filter((light) => light.isEnabled() && lightOf(light) !== null);

/** Elements of the block, as many as it has. Those beyond are left out. */
export function lightsOf(lights: Light[], size: number): { elements: Values[]; count: number } {
  const known = drawnLights(lights).map((light) => lightOf(light)!);
  const elements: Values[] = known.slice(0, size).map((light) => ({ ...kPoint, ...lightValues(light) }));
  const { length: count } = elements;
  while (elements.length < size) elements.push(kIdle);
  return { elements, count };
}
