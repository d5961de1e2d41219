// The text of a shader as Babylon.js takes it: its includes move vertices and end with what the scene does to colours, its
// preprocessor reads all lines.
import { asFunction, kBlock, kInput, semanticOf } from '../renderers/text.js';
import type { Attribute, Interface } from '../types.js';
import { dimmed, shadowLines } from './shadows.js';

/** The kinds of Babylon.js's vertex buffers for glTF's attributes. `moved`: the define under which morph targets move it, and the
 * variable that they then move. */
export const kKinds: Record<string, { kind: string; type: string; moved?: { under: string; as: string } }> = {
  POSITION: { kind: 'position', type: 'vec3', moved: { under: '', as: 'positionUpdated' } },
  NORMAL: { kind: 'normal', type: 'vec3', moved: { under: 'NORMAL', as: 'normalUpdated' } },
  TANGENT: { kind: 'tangent', type: 'vec4', moved: { under: 'TANGENT', as: 'tangentUpdated' } },
  TEXCOORD_0: { kind: 'uv', type: 'vec2', moved: { under: 'UV1', as: 'uvUpdated' } },
  TEXCOORD_1: { kind: 'uv2', type: 'vec2', moved: { under: 'UV2', as: 'uv2Updated' } },
  TEXCOORD_2: { kind: 'uv3', type: 'vec2' },
  TEXCOORD_3: { kind: 'uv4', type: 'vec2' },
  COLOR_0: { kind: 'color', type: 'vec4', moved: { under: 'VERTEXCOLOR', as: 'colorUpdated' } },
};
/** Those that a mesh may have or not, in the library's order. */
export const kOptional = ['NORMAL', 'TANGENT', 'COLOR_0', 'TEXCOORD_0', 'TEXCOORD_1', 'TEXCOORD_2', 'TEXCOORD_3'] as Attribute[];
/** Of an attribute of the file's own that of glTF, in lower case. */
export const kindOf = (semantic: string): string => kKinds[semantic]?.kind ?? semantic.toLowerCase();

/** What the text reads beside its blocks and textures. */
export const kUniforms = ['world', 'view', 'normalMatrix', 'lacquer_hand', 'lacquer_visibility', 'lacquer_turn', 'lacquer_levels'];

const kDeclarations = [
  '#include<instancesDeclaration>', '#include<bonesDeclaration>', '#include<bakedVertexAnimationDeclaration>',
  '#include<morphTargetsVertexGlobalDeclaration>', '#include<morphTargetsVertexDeclaration>[0..maxSimultaneousMorphTargets]',
  '#include<fogVertexDeclaration>', '#include<clipPlaneVertexDeclaration>', '#include<logDepthDeclaration>',
  'uniform mat4 normalMatrix;', 'uniform mat4 view;', 'uniform float lacquer_hand;',
];
const kMoving = [
  '#include<morphTargetsVertexGlobal>', '#include<morphTargetsVertex>[0..maxSimultaneousMorphTargets]', '#include<instancesVertex>',
  '#include<bonesVertex>', '#include<bakedVertexAnimation>',
];

/** A block's members as a struct of a global variable. */
const asStruct = (block: string, members: string, instance: string) => `struct ${block}Block {\n${members}};\n${block}Block ${instance};`;

/** Babylon.js has the objects' places, not in a block of that form. */
const object = (essl: string): string => essl.replace(kBlock, (all, block, members, instance) => (block === 'Object' ? asStruct(block, members, instance) : all));
const kNormals = 'mat4(transpose(inverse(mat3(finalWorld))))';

/** Elements of the block Lights. */
export const lightsIn = (shader: Interface): number => shader.uniforms.find(({ block }) => block === 'Lights')?.array ?? 1;

/** A mesh without colours of its own is white; those of instances come on top, as in Babylon.js. */
const colour = (variable: string, own: string): string[] => [
  '#ifdef LACQUER_COLORS', `${variable} = ${own};`, '#else', `${variable} = vec4(1.0);`, '#endif',
  '#if defined(INSTANCESCOLOR) && defined(INSTANCES)', `${variable} *= instanceColor;`, '#endif',
];

function vertexText(essl: string, shader: Interface): string {
  const attributes = ['attribute vec3 position;'];
  const moved = ['vec3 positionUpdated = position;'];
  const fill: string[] = [];
  const text = object(asFunction(essl)).replace(kInput, (_, location, type, variable) => {
    const semantic = semanticOf(shader, location, variable);
    const { kind = kindOf(semantic), type: stored = type, moved: target } = kKinds[semantic] ?? {};
    if (kind !== 'position') attributes.push(`attribute ${stored} ${kind};`);
    if (target?.under) moved.push(`${stored} ${target.as} = ${kind};`);
    if (semantic === 'COLOR_0') fill.push(...colour(variable, target?.as ?? kind));
    else fill.push(`${variable} = ${target?.as ?? kind};`);
    if (semantic === 'TANGENT') fill.push(`${variable}.w *= lacquer_hand;`);
    return `${type} ${variable};`;
  });
  const { vertex: shadows } = shadowLines(lightsIn(shader));
  return [
    'precision highp float;', ...attributes, ...kDeclarations, ...shadows.before, text, 'void main() {', ...moved, ...kMoving, ...fill,
    ...(text.includes('ObjectBlock object;') ? [
      'object.model = finalWorld;', 'object.normal_matrix = normalMatrix;',
      '#ifdef INSTANCES', `object.normal_matrix = ${kNormals};`, '#endif',
      '#if NUM_BONE_INFLUENCERS>0', `object.normal_matrix = ${kNormals};`, '#endif',
    ] : []),
    'surface();', 'vec4 worldPos = finalWorld * vec4(positionUpdated, 1.0);', ...shadows.fill,
    '#include<clipPlaneVertex>', '#include<fogVertex>', '#include<logDepthVertex>', '}', '',
  ].join('\n');
}

/** Cubes are looked up as they stand in the scene, at the level that has the roughness: lacquer_levels are a scale and an offset of
 * what lacquer_levels.z of Babylon.js's kinds makes of roughness and edge, or of nothing: 0. */
const kAround = [
  'uniform mat3 lacquer_turn;', 'uniform vec4 lacquer_levels;',
  'float lacquer_level(float level) {',
  'if (lacquer_levels.z == 0.0) return level;',
  'float steps = lacquer_levels.z == 1.0 ? log2(lacquer_levels.w * (level * level + 0.0005)) : log2(lacquer_levels.w) * level;',
  'return steps * lacquer_levels.x + lacquer_levels.y;', '}',
  'vec4 lacquer_around(samplerCube map, vec3 to, float level) {', 'return textureLod(map, lacquer_turn * to, lacquer_level(level));', '}',
];

function fragmentText(essl: string, shader: Interface): string {
  const cubes = shader.textures.filter(({ type }) => type === 'samplerCube').map(({ name }) => name);
  const lookup = new RegExp(`\\btextureLod\\((?=(?:${cubes.join('|')}), )`, 'g');
  const { fragment: shadows } = shadowLines(lightsIn(shader));
  const text = dimmed(object(asFunction(essl))).replace(cubes.length ? lookup : /$^/, 'lacquer_around(');
  const [color] = shader.outputs as { name: string }[];
  const start = text.search(/^(?:struct|layout|uniform|in|void|const) /m);
  return [
    text.slice(0, start), ...kAround, ...shadows.before, text.slice(start),
    ...(text.includes('ObjectBlock object;') ? ['uniform mat4 world;', 'uniform mat4 normalMatrix;'] : []),
    'uniform float lacquer_visibility;',
    '#define PBR', '#include<helperFunctions>', '#include<imageProcessingDeclaration>', '#include<imageProcessingFunctions>',
    '#include<fogFragmentDeclaration>', '#include<clipPlaneFragmentDeclaration>', '#include<logDepthDeclaration>', ...shadows.functions,
    'void main() {', '#include<clipPlaneFragment>', ...shadows.fill,
    ...(text.includes('ObjectBlock object;') ? ['object.model = world;', 'object.normal_matrix = normalMatrix;'] : []),
    'surface();', `vec4 color = out_${color.name};`, '#include<fogFragment>',
    '#ifndef IMAGEPROCESSINGPOSTPROCESS', 'color.rgb = max(color.rgb, 0.0);', 'color = applyImageProcessing(color);', '#endif',
    'color.a *= lacquer_visibility;', `out_${color.name} = color;`, '#include<logDepthFragment>', '}', '',
  ].join('\n');
}

/** Both stages' ESSL for a ShaderMaterial. */
export const babylonText = (text: Record<'vertex' | 'fragment', string>, shader: Interface) => ({
  vertexSource: vertexText(text.vertex, shader),
  fragmentSource: fragmentText(text.fragment, shader),
});
