// MaterialX's own shaders of all surfaces of a document that stand beside its nodegraphs, for one light and a prefiltered
// environment, with the numbers as constants:
//
//     node surfaces.mjs FOLDER_OF_MATERIALX FILE.mtlx OUTPUT_FOLDER
import fs from 'fs';
import path from 'path';
import { generatorOf, openMaterialX, saidBy } from '../../bench/peers/materialx.mjs';

const [folder, file, output] = process.argv.slice(2);
const mx = await openMaterialX(folder);
const text = fs.readFileSync(file, 'utf8');
const { document, generate } = await generatorOf(mx, 'VkShaderGenerator', text, {
  hwSpecularEnvironmentMethod: mx.HwSpecularEnvironmentMethod.SPECULAR_ENVIRONMENT_PREFILTER,
  shaderInterfaceType: mx.ShaderInterfaceType.SHADER_INTERFACE_REDUCED,
});
fs.mkdirSync(output, {recursive: true});
for (const [, name] of text.matchAll(/<\w+ name="(\w+)" type="surfaceshader"/g)) {
  try {
    const shader = generate(name, document.getNode(name));
    fs.writeFileSync(path.join(output, `${name}.pixel`), shader.getSourceCode('pixel'));
  } catch (error) {
    console.log(name, saidBy(mx, error));
    process.exitCode = 1;
  }
}
