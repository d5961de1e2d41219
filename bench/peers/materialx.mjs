// MaterialX's own shaders, by its generators in WebAssembly: a folder with JsMaterialXGenShader.mjs, .wasm and .data.
import { existsSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const kModule = 'JsMaterialXGenShader';

/** The module, or null where the folder has none. */
export async function openMaterialX(folder) {
  const file = (suffix) => join(resolve(folder), `${kModule}.${suffix}`);
  if (!existsSync(file('mjs'))) return null;
  const { default: load } = await import(pathToFileURL(file('mjs')).href);
  return load({ locateFile: (name) => join(resolve(folder), name), wasmBinary: readFileSync(file('wasm')) });
}

/** What it throws is a number. */
export const saidBy = (mx, error) => (typeof error === 'number' ? mx.getExceptionMessage(error) : error.message ?? String(error));

/** A document and a generator for one directional light; `settings` are options of GenContext. `generate(name, element)`: a shader. */
export async function generatorOf(mx, kind, text, settings) {
  const generator = mx[kind].create();
  const context = new mx.GenContext(generator);
  const library = mx.loadStandardLibraries(context);
  const document = mx.createDocument();
  document.importLibrary(library);
  await mx.readFromXmlString(document, text);
  Object.assign(context.getOptions(), { hwMaxActiveLightSources: 1, ...settings });
  mx.HwShaderGenerator.bindLightShader(library.getNodeDef('ND_directional_light'), 1, context);
  return { document, generate: (name, element) => generator.generate(name, element, context) };
}

/** How a peer of works.mjs has its image-based light. */
const kEnvironments = { none: 'NONE', sampled: 'FIS', prefiltered: 'PREFILTER' };

/** What an application that knows its scene may write into the text: the lights of the works are one. */
const kKnown = { u_numActiveLightSources: '1', u_envRadianceSamples: '16', u_refractionTwoSided: 'false' };

/** Numbers for constants: `values` has, by the uniform's name, what stands in the constructor's parentheses. */
export function withConstants(text, values) {
  return text.replace(/^uniform (\w+) (\w+);$/gm, (line, type, name) => {
    return name in values && !type.startsWith('sampler') ? `const ${type} ${name} = ${type}(${values[name]});` : line;
  });
}

/** Without an environment the generator forgets to declare one uniform that its refraction reads. */
function declared(text) {
  const name = 'u_refractionTwoSided';
  if (!text.includes(name) || text.includes(`uniform bool ${name};`)) return text;
  return text.replace('// Uniform block: PrivateUniforms', (mark) => `${mark}\nuniform bool ${name};`);
}

/** The inputs of the material: numbers as GLSL writes them, and files with whether the document has them in sRGB. */
function inputsOf(shader, text) {
  const encoded = new Set([...text.matchAll(/value="([^"]*)" colorspace="srgb_texture"/g)].map(([, file]) => file));
  const values = {}, textures = {};
  const block = shader.getStage('pixel').getUniformBlocks().PublicUniforms;
  for (let i = 0; i < block.size(); ++i) {
    // An input without a value is nought in WebGL.
    const port = block.get(i), value = port.getValue()?.getValueString() ?? '0';
    if (port.getType().getName() !== 'filename') values[port.getVariable()] = value;
    else textures[port.getVariable()] = { file: value, srgb: encoded.has(value) };
  }
  return { values, textures };
}

/**
 * The shaders of a document's material for WebGL 2, its numbers constants, by the options for least code. Textures decode sRGB,
 * as those of the other peers do.
 */
export async function shadersOf(mx, text, environment) {
  const settings = {
    hwSpecularEnvironmentMethod: mx.HwSpecularEnvironmentMethod[`SPECULAR_ENVIRONMENT_${kEnvironments[environment]}`],
    shaderInterfaceType: mx.ShaderInterfaceType.SHADER_INTERFACE_REDUCED,
    elideConstantNodes: true, premultipliedBsdfAdd: true, distributeLayerOverBsdfMix: true, emitColorTransforms: false,
  };
  try {
    const { document, generate } = await generatorOf(mx, 'EsslShaderGenerator', text, settings);
    const shader = generate('work', mx.findRenderableElement(document));
    const { values, textures } = inputsOf(shader, text);
    return {
      vertex: shader.getSourceCode('vertex'), textures,
      fragment: withConstants(declared(shader.getSourceCode('pixel')), { ...kKnown, ...values }),
    };
  } catch (error) {
    throw new Error(saidBy(mx, error));
  }
}
