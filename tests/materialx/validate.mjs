// What MaterialX's own validator says of documents: node validate.mjs FOLDER FILE... with the folder of its
// WebAssembly module. Prints nothing for those that it takes.
import fs from 'fs';
import path from 'path';

const [folder, ...files] = process.argv.slice(2);
const {default: load} = await import(path.join(folder, 'JsMaterialXGenShader.mjs'));
const mx = await load({
  locateFile: name => path.join(folder, name),
  wasmBinary: fs.readFileSync(path.join(folder, 'JsMaterialXGenShader.wasm')),
});
const library = mx.loadStandardLibraries(new mx.GenContext(mx.VkShaderGenerator.create()));
for (const file of files) {
  const document = mx.createDocument();
  document.importLibrary(library);
  try {
    await mx.readFromXmlString(document, fs.readFileSync(file, 'utf8'));
  } catch (error) {
    console.log(file, typeof error === 'number' ? mx.getExceptionMessage(error) : error.message);
    continue;
  }
  const said = {};
  if (!document.validate(said)) console.log(path.basename(file), said.message);
}
