// Lamps: two of the page's own, and those of a file (KHR_lights_punctual), as elements of the block Lights.
import { eachNode, type GltfFile } from '../src/gltf';
import { isNear, item, list } from '../src/json';
import { scale, unit, type Vec3 } from '../src/math';
import type { Moves } from './moves';

/** The fields of an element, as docs/bindings.md has them. */
export interface Light {
  position: Vec3; // of a directional light the unit direction to it
  positional: boolean;
  radiance: Vec3;
  range: number; // 0 without one
  direction: Vec3; // unit, from a spot outwards
  spot: { inner: number; outer: number } | null; // angles
}

/** As many as the shaders' block has room for. */
export const kMostLights = 16;

export function directional(to: Vec3, radiance: Vec3): Light {
  const towards = unit(to);
  return { position: towards, positional: false, radiance, range: 0, direction: scale(towards, -1), spot: null };
}

/** What the contact sheets of `lacquer preview` have, too. */
export const kStudioLights: Light[] = [
  directional([-0.62, 0.62, 0.62], [1, 0.97, 0.93]),
  directional([0.95, 0.22, 0.3], [0.2, 0.22, 0.25]),
];

/** The sixteen numbers of an element. */
export function element({ position, positional, radiance, range, direction, spot }: Light): number[] {
  const scaled = spot ? 1 / Math.max(0.001, Math.cos(spot.inner) - Math.cos(spot.outer)) : 0;
  return [
    ...position, positional ? 1 : 0, ...radiance, range > 0 ? range ** -4 : 0, ...direction, scaled,
    spot ? -Math.cos(spot.outer) * scaled : 1, 0, 0, 0,
  ];
}

/** Those that nodes of the default scene refer to; of what is seen the first sixteen. */
export class FileLights {
  private readonly lamps: { node: number; index: number; of: any }[] = [];

  constructor(file: GltfFile) {
    const declared = file.json.extensions?.KHR_lights_punctual?.lights;
    eachNode(file, (node, _, index) => {
      const light = node.extensions?.KHR_lights_punctual?.light;
      const of = item(declared, light);
      if (of) this.lamps.push({ node: index, index: light, of });
    });
  }
  get count(): number {
    return this.lamps.length;
  }

  /** As they are now, and where their nodes are. */
  at(moves: Moves): Light[] {
    return this.lamps.filter(({ node }) => !moves.hides(node)).slice(0, kMostLights).flatMap(({ node, index, of }) => {
      const world = moves.world(node);
      if (!world?.every(isNear)) return [];
      const now = (name: string, otherwise: number, said: unknown = of[name]) => {
        const [x = said] = moves.moved.get(`/extensions/KHR_lights_punctual/lights/${index}/${name}`) ?? [];
        return isNear(x) ? x : otherwise;
      };
      const color = moves.moved.get(`/extensions/KHR_lights_punctual/lights/${index}/color`) ?? list(of.color);
      const direction = unit([-world[8], -world[9], -world[10]]);
      const intensity = now('intensity', 1);
      const radiance = [0, 1, 2].map((i) => (isNear(color[i]) ? color[i] : 1) * intensity) as Vec3;
      if (of.type === 'directional') return [{ ...directional(scale(direction, -1), radiance), direction }];
      const spot = { inner: now('spot/innerConeAngle', 0, of.spot?.innerConeAngle), outer: now('spot/outerConeAngle', Math.PI / 4, of.spot?.outerConeAngle) };
      const position: Vec3 = [world[12], world[13], world[14]];
      return [{ position, positional: true, radiance, range: now('range', 0), direction, spot: of.type === 'spot' ? spot : null }];
    });
  }
}
