// Shadows on the materials, as Babylon.js computes them for its own: by its pieces of shaders, of which each light's radiance takes
// its share.
import { ShaderStore } from '@babylonjs/core/Engines/shaderStore.js';
import type { Light } from '@babylonjs/core/Lights/light.js';
import type { Effect } from '@babylonjs/core/Materials/effect.js';
import { PrepareDefinesForLight, PrepareUniformsAndSamplersForLight } from '@babylonjs/core/Materials/materialHelper.functions.js';
import type { AbstractMesh } from '@babylonjs/core/Meshes/abstractMesh.js';
import type { Scene } from '@babylonjs/core/scene.js';
import { lightFragment } from '@babylonjs/core/Shaders/ShadersInclude/lightFragment.js';
import '@babylonjs/core/Shaders/ShadersInclude/lightUboDeclaration.js';
import '@babylonjs/core/Shaders/ShadersInclude/lightVxUboDeclaration.js';
import '@babylonjs/core/Shaders/ShadersInclude/shadowsFragmentFunctions.js';
import '@babylonjs/core/Shaders/ShadersInclude/shadowsVertex.js';

const kInclude = 'lacquerShadow';
/** Of what Babylon.js does for one light the lines between these: how much of it arrives. */
const [kFrom, kTo] = ['#ifdef SHADOW{X}\n#ifdef SHADOWCSM{X}', '#ifdef SHADOWONLY\n#ifndef SHADOWINUSE'];

function register(): void {
  const { shader } = lightFragment;
  const from = shader.indexOf(kFrom);
  const to = shader.indexOf(kTo, from);
  if (from < 0 || to < 0) throw new Error('this version of Babylon.js computes shadows in a way that /babylon does not know');
  ShaderStore.IncludesShadersStore[kInclude] ??= `${shader.slice(from, to).replace('\n', '\nshadow = 1.;\n')}\nunshadowed[{X}] = shadow;\n#endif\n`;
}

/** Lines of the stages: declarations, and what stands in main(). */
export interface ShadowLines {
  vertex: { before: string[]; fill: string[] };
  fragment: { before: string[]; functions: string[]; fill: string[] };
}
const where = (lines: string[]): string[] => ['#ifdef SHADOWS', ...lines, '#endif'];

/** For a block of so many lights. */
export function shadowLines(size: number): ShadowLines {
  register();
  const each = (include: string) => `#include<${include}>[0..${size}]`;
  return {
    vertex: {
      before: where([each('lightVxUboDeclaration'), 'varying vec3 lacquer_place;']),
      fill: where([each('shadowsVertex'), 'lacquer_place = worldPos.xyz;']),
    },
    fragment: {
      before: [`float unshadowed[${size}];`, 'float lacquer_share(int i) {', ...where(['return unshadowed[i];']), 'return 1.0;', '}'],
      functions: where([each('lightUboDeclaration'), '#include<shadowsFragmentFunctions>', 'varying vec3 lacquer_place;']),
      fill: where([
        `for (int i = 0; i < ${size}; ++i) unshadowed[i] = 1.0;`, 'vec3 vPositionW = lacquer_place;', 'float shadow = 1.;', each(kInclude),
      ]),
    },
  };
}
export const dimmed = (essl: string): string => essl.replace(/lights\[(\w+)\]\.radiance\b/g, '(lights[$1].radiance * lacquer_share($1))');

/** Those of a mesh's lights, by their elements of the block Lights, whose shadows fall on it. */
export function castingOn(mesh: AbstractMesh, drawn: Light[], size: number): Map<number, Light> {
  const scene = mesh.getScene();
  const found = new Map<number, Light>();
  if (!scene.shadowsEnabled) return found;
  drawn.slice(0, size).forEach((light, i) => {
    const generator = light.getShadowGenerator(scene.activeCamera) ?? light.getShadowGenerator();
    if (light.shadowEnabled && generator?.getShadowMap()?.renderList?.length) found.set(i, light);
  });
  return found;
}

/** What an effect needs for them: its defines are given back, names added. Maps are of floats where Babylon.js makes such. */
export function prepareShadows(mesh: AbstractMesh, casting: Map<number, Light>, names: { uniforms: string[]; samplers: string[]; uniformBuffers: string[] }): string[] {
  const defines: Record<string, unknown> = {};
  const state = { needNormals: false, needRebuild: false, shadowEnabled: false, specularEnabled: false, lightmapMode: false };
  for (const [i, light] of casting) {
    PrepareDefinesForLight(mesh.getScene(), mesh, light, i, defines, false, state);
    PrepareUniformsAndSamplersForLight(i, names.uniforms, names.samplers, false, names.uniformBuffers);
  }
  const on = Object.entries(defines).filter(([, value]) => value !== false && value !== undefined);
  const { textureFloatRender, textureFloatLinearFiltering, textureHalfFloatRender, textureHalfFloatLinearFiltering } = mesh.getScene().getEngine().getCaps();
  const floats = (textureFloatRender && textureFloatLinearFiltering) || (textureHalfFloatRender && textureHalfFloatLinearFiltering);
  return [...(state.shadowEnabled ? ['SHADOWS', ...(floats ? ['SHADOWFLOAT'] : [])] : []), ...on.map(([name, value]) => (value === true ? name : `${name} ${value}`))];
}

export function bindShadows(scene: Scene, casting: Map<number, Light>, effect: Effect): void {
  for (const [i, light] of casting) light._bindLight(i, scene, effect, false, true);
}
