// The text of a shader as three.js takes it: three.js declares the vertex attributes that it knows, sets plain uniforms and no
// blocks, and has a main() that ends with what the renderer does to colours.
import { asFunction, kBlock, kInput, semanticOf } from '../renderers/text.js';
import type { Interface } from '../types.js';
import { fragmentShadows, shadowed, vertexShadows } from './shadows.js';

/** The names that three.js's geometries have for glTF's attributes. `under`: the define under which three.js declares it; an
 * empty one: always. */
const kAttributes: Record<string, { name: string; under?: string }> = {
  POSITION: { name: 'position', under: '' },
  NORMAL: { name: 'normal', under: '' },
  TANGENT: { name: 'tangent', under: 'USE_TANGENT' },
  TEXCOORD_0: { name: 'uv', under: '' },
  TEXCOORD_1: { name: 'uv1', under: 'USE_UV1' },
  TEXCOORD_2: { name: 'uv2', under: 'USE_UV2' },
  TEXCOORD_3: { name: 'uv3', under: 'USE_UV3' },
  COLOR_0: { name: 'color' },
  JOINTS_0: { name: 'skinIndex', under: 'USE_SKINNING' },
  WEIGHTS_0: { name: 'skinWeight', under: 'USE_SKINNING' },
};
/** Of an attribute of the file's own that of glTF, in lower case. */
export const attributeName = (semantic: string): string => kAttributes[semantic]?.name ?? semantic.toLowerCase();

/** What three.js says of an object and a camera, in the fields of the blocks that have it. */
const kGiven: Record<string, Record<string, string>> = {
  Frame: { view_projection: 'projectionMatrix * viewMatrix', camera_position: 'cameraPosition' },
  Object: { model: 'modelMatrix', normal_matrix: 'mat4(transpose(mat3(viewMatrix)) * normalMatrix)' },
};
const kInstances = [
  '#ifdef USE_INSTANCING',
  'object.model = object.model * instanceMatrix;',
  'object.normal_matrix = object.normal_matrix * mat4(transpose(inverse(mat3(instanceMatrix))));',
  '#endif', '#ifdef USE_BATCHING',
  'mat4 lacquer_batched = getBatchingMatrix(getIndirectIndex(gl_DrawID));',
  'object.model = object.model * lacquer_batched;',
  'object.normal_matrix = object.normal_matrix * mat4(transpose(inverse(mat3(lacquer_batched))));',
  '#endif',
];
/** three.js has it in a piece with names that the library's text has too. */
const kPerspective = ['#ifdef USE_LOGARITHMIC_DEPTH_BUFFER', 'bool isPerspectiveMatrix(mat4 m) { return m[2][3] == -1.0; }', '#endif'];

/** Declares what three.js does not, in the place of a block or an attribute, and says with what the variable that stands for it
 * is filled. */
class Rewriting {
  readonly fill: string[] = [];
  constructor(private readonly vertex: boolean, private readonly shader: Interface) {}

  input = (_: string, location: string, type: string, variable: string): string => {
    const semantic = semanticOf(this.shader, location, variable);
    if (semantic === 'MORPH_VERTEX') {
      this.fill.push(`${variable} = ${type}(gl_VertexID);`);
      return `${type} ${variable};`;
    }
    const name = attributeName(semantic);
    if (semantic === 'COLOR_0') return this.color(type, variable);
    const { under } = kAttributes[semantic] ?? {};
    this.fill.push(`${variable} = ${name};`);
    const declared = `in ${type} ${name};\n`;
    const once = under === '' ? '' : under ? `#ifndef ${under}\n${declared}#endif\n` : declared;
    return `${once}${type} ${variable};`;
  };

  /** Which an application may have three.js declare by `vertexColors`; where a mesh has none, it is white. */
  private color(type: string, variable: string): string {
    const without = '#if defined(USE_COLOR) && !defined(USE_COLOR_ALPHA)';
    this.fill.push(without, `${variable} = vec4(color, 1.0);`, '#else', `${variable} = color;`, '#endif');
    this.fill.push('#ifdef USE_INSTANCING_COLOR', `${variable}.rgb *= instanceColor;`, '#endif');
    this.fill.push('#ifdef USE_BATCHING_COLOR', `${variable} *= getBatchingColor(getIndirectIndex(gl_DrawID));`, '#endif');
    return `#if !defined(USE_COLOR) && !defined(USE_COLOR_ALPHA)\nin ${type} color;\n#endif\n${type} ${variable};`;
  }

  block = (_: string, block: string, members: string, instance: string | undefined): string => {
    if (!instance) return `uniform ${members.trim()}`; // an array of structs that stand before it
    const struct = `struct ${block}Block {\n${members}};\nuniform ${block}Block`;
    const given = kGiven[block];
    if (!given) return `${struct} ${instance};`;
    this.fill.push(`${instance} = given_${instance};`);
    for (const [field, value] of Object.entries(given)) {
      if (this.vertex || field === 'camera_position') this.fill.push(`${instance}.${field} = ${value};`);
    }
    if (this.vertex && block === 'Object') this.fill.push(...kInstances);
    return `${struct} given_${instance};\n${block}Block ${instance};`;
  };
}

/** The name of the uniform that a block is; its fields are its value's. */
export const uniformOf = (block: string, instance: string): string => (kGiven[block] ? `given_${instance}` : instance);

/** The instances of a stage's blocks, by their names; of an array its name. */
export function instancesOf(essl: string): Map<string, string> {
  return new Map([...essl.matchAll(kBlock)].map(([, block, members, instance]) => {
    const array = /(\w+)\[\d+\];/.exec(members)?.[1] ?? '';
    return [block, uniformOf(block, instance ?? array)];
  }));
}

/** The place of a vertex, kept for three.js's pieces: where no line says it, of what the line makes of it. */
function world(text: string): { text: string; fill: string[] } {
  const told = text.replace(/^( *)gl_Position = frame\.view_projection \* (.+);$/m, '$&\n$1lacquer_world = $2;');
  return { text: told, fill: told === text ? ['    lacquer_world = inverse(projectionMatrix * viewMatrix) * gl_Position;'] : [] };
}

/** A stage's ESSL for a ShaderMaterial with glslVersion GLSL3. Instances, batches, shadows, clipping, logarithmic depth, fog, tone
 * mapping and colour spaces are added. */
export function threeText(essl: string, stage: 'vertex' | 'fragment', shader: Interface): string {
  const vertex = stage === 'vertex';
  const to = new Rewriting(vertex, shader);
  const lights = shader.uniforms.find(({ block }) => block === 'Lights')?.array ?? 0;
  const shadows = lights === 0 ? { before: [], fill: [] } : vertex ? vertexShadows(essl) : fragmentShadows(lights);
  const bare = asFunction(essl);
  const text = (vertex ? bare.replace(kInput, to.input) : bare).replace(kBlock, to.block);
  const main = ['void main() {', ...to.fill.map((line) => (line.startsWith('#') ? line : `    ${line}`))];
  if (vertex) {
    const placed = world(text);
    return [
      ...['fog', 'clipping_planes', 'batching', 'logdepthbuf'].map((chunk) => `#include <${chunk}_pars_vertex>`), ...kPerspective, 'vec4 lacquer_world;', ...shadows.before, placed.text,
      ...main, '    surface();', ...placed.fill, '    vec4 mvPosition = viewMatrix * lacquer_world;', ...shadows.fill,
      '#include <clipping_planes_vertex>', '#ifdef USE_FOG', '    vFogDepth = gl_Position.w;', '#endif', '#include <logdepthbuf_vertex>', '}', '',
    ].join('\n');
  }
  const ends = ['tonemapping', 'colorspace', 'fog', 'premultiplied_alpha'].map((chunk) => `#include <${chunk}_fragment>`);
  const [color] = shader.outputs as { name: string }[];
  return [
    ...['fog', 'clipping_planes', 'logdepthbuf'].map((chunk) => `#include <${chunk}_pars_fragment>`), ...shadows.before, lights === 0 ? text : shadowed(text),
    `#define gl_FragColor out_${color.name}`, ...main, '    vec4 diffuseColor = vec4(1.0);', '#include <clipping_planes_fragment>', '#include <logdepthbuf_fragment>', ...shadows.fill,
    '    surface();', '    gl_FragColor.a *= diffuseColor.a; // what a plane covers of the pixel', ...ends, '}', '',
  ].join('\n');
}
