// MaterialX's own shaders, for one light and a prefiltered environment, for all tests of a process: it takes longer to load than
// a shader takes.
//
//     node peers.mjs FOLDER_OF_MATERIALX
//
// reads lines, KIND FILE.mtlx OUTPUT_FOLDER with tabs between, and answers each with "good" or what is wrong. Of a kind
// `surfaces` there are fragment shaders of all surfaces beside nodegraphs, NAME.pixel; of the others one of the first output of
// a nodegraph, out.pixel. `editable`: inputs are uniforms, else constants.
import fs from 'node:fs';
import path from 'node:path';
import { createInterface } from 'node:readline';
import { openMaterialX, saidBy } from '../../bench/peers/materialx.mjs';

const mx = await openMaterialX(process.argv[2]);
const constants = { shaderInterfaceType: mx.ShaderInterfaceType.SHADER_INTERFACE_REDUCED };
const kinds = {
  editable: {},
  best: { ...constants, elideConstantNodes: true, premultipliedBsdfAdd: true, distributeLayerOverBsdfMix: true },
  surfaces: constants,
};
const makers = {};

/** A kind's generator with MaterialX's library. */
function makerOf(kind) {
  const generator = mx.VkShaderGenerator.create();
  const context = new mx.GenContext(generator);
  const library = mx.loadStandardLibraries(context);
  Object.assign(context.getOptions(), {
    hwMaxActiveLightSources: 1, hwSpecularEnvironmentMethod: mx.HwSpecularEnvironmentMethod.SPECULAR_ENVIRONMENT_PREFILTER, ...kinds[kind],
  });
  mx.HwShaderGenerator.bindLightShader(library.getNodeDef('ND_directional_light'), 1, context);
  return { generator, context, library };
}

async function make(kind, file, output) {
  const { generator, context, library } = makers[kind] ??= makerOf(kind);
  const text = fs.readFileSync(file, 'utf8');
  const document = mx.createDocument();
  try {
    document.importLibrary(library);
    await mx.readFromXmlString(document, text);
    const write = (name, element) =>
      fs.writeFileSync(path.join(output, `${name}.pixel`), generator.generate(name, element, context).getSourceCode('pixel'));
    if (kind !== 'surfaces') return write('out', mx.findRenderableElement(document));
    for (const [, name] of text.matchAll(/<\w+ name="(\w+)" type="surfaceshader"/g)) write(name, document.getNode(name));
  } finally {
    document.delete?.();
  }
}

for await (const line of createInterface({ input: process.stdin })) {
  let answer = 'good';
  try {
    await make(...line.split('\t'));
  } catch (error) {
    answer = saidBy(mx, error).replaceAll('\n', ' ');
  }
  fs.writeSync(1, `${answer}\n`);
}
