// MaterialX's own shaders of all surfaces of a document that stand beside its nodegraphs, for one light and a prefiltered
// environment, with the numbers as constants:
//
//     node surfaces.mjs FOLDER_OF_MATERIALX FILE.mtlx OUTPUT_FOLDER
import fs from 'fs';
import path from 'path';
import {pathToFileURL} from 'url';

const [folder, file, output] = process.argv.slice(2);
const {default: MaterialX} = await import(pathToFileURL(path.join(folder, 'JsMaterialXGenShader.mjs')).href);
const mx = await MaterialX({
  locateFile: name => path.join(folder, name),
  wasmBinary: fs.readFileSync(path.join(folder, 'JsMaterialXGenShader.wasm')),
});
const generator = mx.VkShaderGenerator.create();
const context = new mx.GenContext(generator);
const library = mx.loadStandardLibraries(context);
const document = mx.createDocument();
document.importLibrary(library);
const text = fs.readFileSync(file, 'utf8');
await mx.readFromXmlString(document, text);
const settings = context.getOptions();
settings.hwMaxActiveLightSources = 1;
settings.hwSpecularEnvironmentMethod = mx.HwSpecularEnvironmentMethod.SPECULAR_ENVIRONMENT_PREFILTER;
settings.shaderInterfaceType = mx.ShaderInterfaceType.SHADER_INTERFACE_REDUCED;
mx.HwShaderGenerator.bindLightShader(library.getNodeDef('ND_directional_light'), 1, context);
fs.mkdirSync(output, {recursive: true});
for (const [, name] of text.matchAll(/<\w+ name="(\w+)" type="surfaceshader"/g)) {
  try {
    const shader = generator.generate(name, document.getNode(name), context);
    fs.writeFileSync(path.join(output, `${name}.pixel`), shader.getSourceCode('pixel'));
  } catch (error) {
    console.log(name, typeof error === 'number' ? mx.getExceptionMessage(error) : error.message ?? error);
    process.exitCode = 1;
  }
}
