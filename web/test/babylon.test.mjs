// Lacquer's materials in Babylon.js, as web/package-lock.json has it: their colours beside the library's own, and what a scene
// brings along.
import assert from 'node:assert/strict';
import { copyFileSync, cpSync, mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, dirname, join } from 'node:path';
import { after, before, test } from 'node:test';
import { build } from 'esbuild';
import { kPatience, kSlow, launch, listen, serve } from './browser.mjs';
import { inputs, output, read, realFiles, root } from './native.mjs';
import { assertAlike, drawnFiles } from './renderers.mjs';

const kPage = `<!doctype html><meta charset="utf-8"><title>babylon</title><link rel="icon" href="data:,">
<canvas width="64" height="64"></canvas><script type="module" src="page.js"></script>`;
/** What it says of itself when it starts. */
const kStarts = /^(BJS - \[.*\]: )?Babylon.js v|GPU stall/;

let browser;
let server;
let folder;
let page;
let watched;
before(async () => {
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), 'lacquer-babylon-'));
  writeFileSync(join(folder, 'index.html'), kPage);
  const made = join(output, 'package');
  await build({
    entryPoints: [join(root, 'web/test/babylon_page.mjs')], outdir: folder, entryNames: 'page', bundle: true, format: 'esm', splitting: true,
    target: 'es2022', logLevel: 'error', external: ['./packed.js'], nodePaths: [join(root, 'web/node_modules')],
    alias: { '@lacquer-shaders/lacquer/babylon': join(made, 'babylon.js'), '@lacquer-shaders/lacquer': join(made, 'index.js') },
  });
  copyFileSync(join(made, 'lacquer.wasm'), join(folder, 'lacquer.wasm'));
  const [real] = realFiles();
  if (real) symlinkSync(dirname(dirname(real)), join(folder, 'assets'));
  cpSync(join(root, 'examples'), join(folder, 'examples'), { recursive: true, filter: (name) => !/\.(cpp|h|txt)$/.test(name) });
  server = await serve(folder);
  page = await browser.newPage();
  watched = listen(page, kStarts);
  await page.goto(`${server.url}/index.html`, { timeout: kPatience });
  await watched.unlessItFails(page.waitForFunction(() => document.title === 'ready', null, { timeout: kPatience }));
});
after(async () => {
  await browser?.close();
  server?.close();
  if (folder) rmSync(folder, { recursive: true });
});

/** Runs in the page; what the console says there fails the test, but for what `expected` matches. */
async function inPage(run, argument, expected = /^$/) {
  const from = watched.said.length;
  const result = await watched.unlessItFails(page.evaluate(run, argument));
  assert.deepEqual(watched.said.slice(from).filter((text) => !expected.test(text)), []);
  return result;
}

/** The colours of a material of a file without its pictures on a quad, and the library's own at the same points. */
async function besideTheLibrary({ text, material, texel, rightHanded, tangents = true }) {
  const file = JSON.parse(text);
  const size = 8;
  const scene = sceneOf(rightHanded);
  const mesh = quadOf(scene, { tangents });
  const look = file.materials[material];
  const pictures = (file.textures ?? []).map(() => (srgb) => {
    const raw = new BABYLON.RawTexture(new Uint8Array(texel), 1, 1, 5, scene, false, false, 2, 0, 0, srgb);
    raw.gammaSpace = false;
    return raw;
  });
  const images = (file.textures ?? []).map((_, i) => ({ uri: `${i}.png` }));
  const alone = { asset: file.asset, materials: [look], images, textures: images.map((_, source) => ({ source })) };
  const graph = lacquer.scene(JSON.stringify(alone), 'a.gltf').graph(0, {}, lacquered.attributesOf(mesh));
  mesh.material = lacquered.materialFrom(lacquer, look, scene, { textures: pictures.map((make) => make(false)) });
  for (const { name, srgb, texture } of graph.textures()) if (srgb) mesh.material.setTexture(name, pictures[texture](true));
  mesh.material.alphaMode = BABYLON.Constants.ALPHA_DISABLE;
  const light = lampOf(scene);
  const drawn = await colours(scene, cameraOf(scene), size);
  const l = [0.3, 0.5, 0.9].map((x) => x / Math.hypot(0.3, 0.5, 0.9));
  const radiance = light.diffuse.asArray().map((x) => x * light.intensity);
  const points = Array.from({ length: size * size }, (_, i) => {
    const [x, y] = [i % size, Math.floor(i / size)].map((at) => ((at + 0.5) / size - 0.5) * 1.5);
    const eye = [-x, -y, 3].map((each) => each / Math.hypot(x, y, 3));
    return { n: [0, 0, 1], t: [1, 0, 0, 1], v: eye, l, light: radiance, uv0: [x / 2 + 0.5, y / 2 + 0.5], position: [x, y, 0] };
  });
  const decoded = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
  const linear = (srgb) => texel.map((x, i) => (srgb && i < 3 ? decoded(x / 255) : x / 255));
  const texels = graph.textures().map(({ name, srgb }) => `${name}=${linear(srgb).join()}`);
  const { rgba } = graph.evaluate(points, { texels, ibl: false });
  const lod = mesh.material.looksThrough;
  scene.dispose();
  return { drawn, expected: rgba.flat(), names: graph.textures().map(({ name }) => name), lod };
}

test('materials have the colours of the library under a lamp, in a scene of either hand', async () => {
  let compared = 0;
  for (const file of inputs().filter((name) => name.startsWith('examples/') || name.startsWith('bench/'))) {
    const text = read(file).toString();
    const { materials } = JSON.parse(text);
    for (let material = 0; material < materials.length; ++material) {
      const rightHanded = compared % 2 === 0;
      const { drawn, expected, lod } = await inPage(besideTheLibrary, { text, material, rightHanded, texel: [255, 255, 255, 255] });
      if (lod) continue; // what is behind is the scene's
      assertAlike(drawn, expected, `${file} ${materials[material].name} ${rightHanded}`);
      ++compared;
    }
  }
  assert.ok(compared > 20, `${compared}`);
});

test('pictures reach their slots, in their colour spaces, and normals bend alike in a scene of either hand', async () => {
  const text = read('examples/core.gltf').toString();
  const { materials } = JSON.parse(text);
  const material = materials.findIndex((each) => JSON.stringify(each).includes('normalTexture'));
  assert.ok(material >= 0);
  let found;
  for (const rightHanded of [true, false]) {
    for (const tangents of [true, false]) {
      const { drawn, expected, names } = await inPage(besideTheLibrary, { text, material, rightHanded, tangents, texel: [200, 120, 180, 255] });
      assert.ok(names.length > 0);
      // The tangents that the shader finds are those of the picture's u as it is turned.
      if (!tangents) found ??= drawn;
      assertAlike(drawn, tangents ? expected : found, `${materials[material].name} ${rightHanded} ${tangents}`);
      drawn.forEach((x, i) => assert.ok(i % 4 === 3 || Math.abs(x - expected[i]) < 0.03, `${x} ${expected[i]}`));
    }
  }
});
