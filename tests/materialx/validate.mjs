// What MaterialX's own validator says of documents: node validate.mjs FOLDER FILE... with the folder of its
// WebAssembly module. Prints nothing for those that it takes.
import fs from 'fs';
import path from 'path';
import { openMaterialX, saidBy } from '../../bench/peers/materialx.mjs';

const [folder, ...files] = process.argv.slice(2);
const mx = await openMaterialX(folder);
const library = mx.loadStandardLibraries(new mx.GenContext(mx.VkShaderGenerator.create()));
for (const file of files) {
  const document = mx.createDocument();
  document.importLibrary(library);
  try {
    await mx.readFromXmlString(document, fs.readFileSync(file, 'utf8'));
  } catch (error) {
    console.log(file, saidBy(mx, error));
    continue;
  }
  const said = {};
  if (!document.validate(said)) console.log(path.basename(file), said.message);
}
