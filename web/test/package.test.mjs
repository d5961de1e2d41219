// The npm package as others use it: installed from its folder, in a browser by itself and in a Vite project.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { cpSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { hasWebGpu, kPatience, kWebGpu, launch, listen, serve } from './browser.mjs';
import { glb, inputs, output, read, root } from './native.mjs';

let browser;
let folder;
before(async () => {
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), 'lacquer-package-'));
});
after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true });
});

/** The package and an example, installed as a person does it. */
function installed(example, name = example) {
  const place = join(folder, name);
  rmSync(place, { recursive: true, force: true });
  cpSync(join(root, 'web/examples', example), place, { recursive: true, filter: (name) => !name.includes('node_modules') });
  const description = JSON.parse(readFileSync(join(place, 'package.json'), 'utf8'));
  description.dependencies['@lacquer-shaders/lacquer'] = `file:${join(output, 'package')}`;
  writeFileSync(join(place, 'package.json'), JSON.stringify(description));
  execFileSync('npm', ['install', '--offline', '--no-audit', '--no-fund', '--install-links'], { cwd: place, stdio: 'pipe' });
  return place;
}

/** Uses the page of an example that has drawn; fails on any message but those that are expected. */
async function drawnAt(url, use, { by = browser, expected = [], passed = /^$/, before = () => undefined } = {}) {
  const page = await by.newPage();
  try {
    const { said, unlessItFails } = listen(page, passed);
    await page.addInitScript(before);
    await page.goto(url, { timeout: kPatience });
    await unlessItFails(page.waitForFunction(() => document.title === 'drawn', null, { timeout: kPatience }));
    assert.deepEqual(said, expected);
    return await use(page);
  } finally {
    await page.close();
  }
}

/** The same, of a folder that a static server gives away. */
async function drawn(place, use, { hidden = undefined, query = '', ...how } = {}) {
  const server = await serve(place, hidden);
  try {
    return await drawnAt(`${server.url}/index.html${query}`, use, how);
  } finally {
    server.close();
  }
}

const shot = (page) => page.locator('canvas').screenshot();

test('the package installs from its folder, and its WebGL 2 example draws', async () => {
  const place = installed('webgl2');
  const picture = await drawn(place, shot);
  assert.ok(picture.length > 3000, 'there is more than one colour');
  // Where lacquer.wasm is not given away, the copy of it that is a script serves.
  const expected = ['Failed to load resource: the server responded with a status of 404 (Not Found)'];
  const again = await drawn(place, shot, { hidden: /\.wasm$/, expected });
  assert.ok(again.equals(picture));
});

/** The examples' triangle in a .glb, a node lower, twice as large and elsewhere: the camera sees it as it was. */
function movedTriangle() {
  const gltf = JSON.parse(read('web/examples/webgl2/triangle.gltf'));
  const binary = Buffer.from(gltf.buffers[0].uri.split(',')[1], 'base64');
  delete gltf.buffers[0].uri;
  gltf.nodes = [{ children: [1], translation: [4, -2, 8] }, { mesh: 0, scale: [2, 2, 2] }];
  return glb(gltf, binary);
}

test('the WebGL 2 example draws a .glb where its nodes are', async () => {
  const place = installed('webgl2', 'glb');
  const picture = await drawn(place, shot);
  writeFileSync(join(place, 'moved.glb'), movedTriangle());
  const again = await drawn(place, shot, { query: '?moved.glb' });
  assert.ok(again.equals(picture));
});

test('the examples have a hundred lines at most', () => {
  for (const example of ['webgl2', 'webgpu', 'three', 'babylon']) {
    const lines = read(`web/examples/${example}/main.js`).toString().trimEnd().split('\n');
    assert.ok(lines.length <= 100 && lines.every((line) => line.length <= 150), `${example}: ${lines.length} lines`);
  }
});

test('blocks are filled by the names of their fields', async () => {
  const { load } = await import(join(output, 'package/index.js'));
  const library = await load();
  const shader = library.scene(read('examples/coat.gltf'), 'coat.gltf').graph(0).generate({ targets: ['wgsl'] });
  const of = (name) => shader.interface.uniforms.find(({ block }) => block === name);
  const lights = shader.block('Lights', [{ radiance: [1, 2, 3] }, { position: [4, 5, 6], positional: 1, nothing: 7 }]);
  assert.equal(lights.length, of('Lights').size);
  const floats = new Float32Array(lights.buffer);
  const stride = of('Lights').stride / 4;
  assert.deepEqual([...floats.slice(0, 8)], [0, 0, 0, 0, 1, 2, 3, 0]);
  assert.deepEqual([...floats.slice(stride, stride + 4)], [4, 5, 6, 1]);
  assert.ok(floats.slice(2 * stride).every((x) => x === 0));
  const frame = shader.block('Frame', { light_count: 2, environment_intensity: 0.5 });
  const offset = (name) => of('Frame').fields.find((field) => field.name === name).offset;
  assert.equal(new DataView(frame.buffer).getInt32(offset('light_count'), true), 2);
  assert.equal(new DataView(frame.buffer).getFloat32(offset('environment_intensity'), true), 0.5);
  assert.throws(() => shader.block('Nothing'), /no block Nothing/);
  // What createBindGroupLayout() wants is what the interface tells, in its order.
  const groups = shader.bindGroupLayouts();
  const { bindings } = shader.interface.webgpu;
  assert.deepEqual(groups.map(({ entries }) => entries.map(({ name }) => name)), groups.map((_, i) => bindings.filter(({ group }) => group === i).map(({ name }) => name)));
  const found = groups[0].entries.find(({ name }) => name === 'Frame');
  assert.deepEqual(found, { name: 'Frame', binding: 0, visibility: 3, buffer: { type: 'uniform', minBindingSize: of('Frame').size } });
});

/** Where software shows WebGPU, a screenshot does not hold it: the canvas gives a texture that can be read. */
function keepTexture() {
  let device;
  const { configure } = GPUCanvasContext.prototype;
  GPUCanvasContext.prototype.configure = function (how) {
    device = how.device;
    return configure.call(this, how);
  };
  GPUCanvasContext.prototype.getCurrentTexture = function () {
    const usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC;
    const format = navigator.gpu.getPreferredCanvasFormat();
    window.kept = { device, texture: device.createTexture({ size: [this.canvas.width, this.canvas.height], format, usage }) };
    return window.kept.texture;
  };
}

/** Of the texture that keepTexture() has kept. */
const keptColors = (page) => page.evaluate(async () => {
  const { device, texture } = window.kept;
  const buffer = device.createBuffer({ size: 4 * 512 * 512, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ });
  const encoder = device.createCommandEncoder();
  encoder.copyTextureToBuffer({ texture }, { buffer, bytesPerRow: 4 * 512 }, [512, 512]);
  device.queue.submit([encoder.finish()]);
  await buffer.mapAsync(GPUMapMode.READ);
  const words = new Uint32Array(buffer.getMappedRange());
  return { corner: words[0], middle: words[512 * 256 + 256], all: new Set(words).size };
});

/** Calls with a browser that has WebGPU; where there is none, the test is left out. */
async function withWebGpu(t, place, use) {
  const by = await launch(...kWebGpu);
  try {
    const server = await serve(place);
    let there = false;
    try {
      const page = await by.newPage();
      await page.goto(`${server.url}/package.json`);
      there = await hasWebGpu(page);
      await page.close();
    } finally {
      server.close();
    }
    if (!there) return t.skip('this browser has no WebGPU');
    await use({ by, before: keepTexture });
  } finally {
    await by.close();
  }
}

function assertPicture({ corner, middle, all }) {
  assert.notEqual(corner, middle);
  assert.ok(all > 20, `${all} colours`);
}

test('its WebGPU example draws', async (t) => {
  const place = installed('webgpu');
  await withWebGpu(t, place, async (how) => assertPicture(await drawn(place, keptColors, how)));
});

// ---- Vite

/** Vite as web/test/vite/package-lock.json has it; null, and a message, where that was not installed. */
async function viteFor(t) {
  const file = join(root, 'web/test/vite/node_modules/vite/dist/node/index.js');
  if (existsSync(file)) return import(pathToFileURL(file));
  t.skip('there is no Vite: `npm ci --prefix web/test/vite` installs it');
  return null;
}

/** A fresh project with an example in it, as Vite's own template lays it out. */
function viteProject(example) {
  const place = installed(example, `vite-${example}`);
  mkdirSync(join(place, 'public'));
  mkdirSync(join(place, 'src'));
  renameSync(join(place, 'triangle.gltf'), join(place, 'public/triangle.gltf'));
  renameSync(join(place, 'main.js'), join(place, 'src/main.js'));
  writeFileSync(join(place, 'index.html'), [
    '<!doctype html>', '<html lang="en">', '<head><meta charset="utf-8"><title>Vite</title><link rel="icon" href="data:,"></head>',
    '<body><canvas width="512" height="512"></canvas><script type="module" src="/src/main.js"></script></body>', '</html>',
  ].join('\n'));
  return place;
}

/** The example as the development server gives it, then built and as a static server gives that. */
async function inVite(vite, place, use, how) {
  const base = { root: place, configFile: false, logLevel: 'error', cacheDir: join(place, '.vite') };
  const server = await vite.createServer({ ...base, server: { host: '127.0.0.1' } });
  try {
    await server.listen();
    const { port } = server.httpServer.address();
    await drawnAt(`http://127.0.0.1:${port}/`, use, { ...how, passed: /^\[vite\] connect/ });
  } finally {
    await server.close();
  }
  await vite.build(base);
  const assets = readdirSync(join(place, 'dist/assets'));
  assert.equal(assets.filter((name) => name.endsWith('.wasm')).length, 1, `lacquer.wasm is among ${assets}`);
  await drawn(join(place, 'dist'), use, how);
}

test('in a Vite project its WebGL 2 example draws, served and built', async (t) => {
  const vite = await viteFor(t);
  if (!vite) return;
  const direct = await drawn(installed('webgl2'), shot);
  await inVite(vite, viteProject('webgl2'), async (page) => assert.ok((await shot(page)).equals(direct)));
});

test('in a Vite project its WebGPU example draws, served and built', async (t) => {
  const vite = await viteFor(t);
  if (!vite) return;
  const place = viteProject('webgpu');
  await withWebGpu(t, place, (how) => inVite(vite, place, async (page) => assertPicture(await keptColors(page)), how));
});

test('its tarball has a README, examples of this version and each module once', () => {
  const listed = JSON.parse(execFileSync('npm', ['pack', '--dry-run', '--json', '--offline'], { cwd: join(output, 'package'), encoding: 'utf8' }));
  const [{ name, version, files }] = listed;
  const paths = files.map(({ path }) => path);
  assert.equal(name, '@lacquer-shaders/lacquer');
  assert.deepEqual(paths.filter((path) => path.endsWith('.wasm')).sort(), ['lacquer-compiler.wasm', 'lacquer.wasm']);
  for (const path of ['README.md', 'LICENSE', 'index.d.ts', 'compiler.js', 'compiler.d.ts', 'library.js', 'library.d.ts', 'examples/webgl2/index.html', 'examples/webgpu/main.js', 'three.js', 'three/index.d.ts', 'babylon.js', 'babylon/index.d.ts']) assert.ok(paths.includes(path), path);
  const example = JSON.parse(readFileSync(join(output, 'package/examples/webgl2/package.json'), 'utf8'));
  assert.deepEqual(example.dependencies, { [name]: `^${version}` });
});

test('its types hold what a program in TypeScript says with them', () => {
  const place = installed('webgl2', 'typed');
  const program = (last) => `
    import { load, LacquerError, type Message, type Shader } from '@lacquer-shaders/lacquer';
    import { geometry, openGltf, type Drawable } from '@lacquer-shaders/lacquer/gltf';
    const said: Message[] = [];
    export async function paint(bytes: Uint8Array): Promise<Shader> {
      const lacquer = await load();
      const scene = lacquer.scene(bytes, 'a.gltf', { profile: 'khr' }, said);
      const rgba: (number | null)[][] = scene.evaluate(0, [{ l: [0, 0.6, 0.8] }]).rgba;
      const ball: Uint8ClampedArray = scene.preview(0, 64 + rgba.length);
      const graph = scene.graph(0, { targets: ['essl'] });
      for (const { name, value } of graph.parameters()) graph.setParameter(name, value);
      const shader = graph.generate();
      const block: Uint8Array = shader.pack({ coat_factor: ball.length });
      const { model, normal }: Drawable = geometry(openGltf('a.gltf', bytes))[0];
      shader.block('Object', { model, normal_matrix: normal });
      shader.block('Lights', [{ radiance: [1, 1, 1] }]);
      if (block.length === 0) throw new LacquerError(graph.check());
      ${last}
      return shader;
    }`;
  const check = (last) => {
    writeFileSync(join(place, 'typed.ts'), program(last));
    const tsc = join(root, 'web/node_modules/typescript/bin/tsc');
    const words = ['--noEmit', '--strict', '--target', 'es2022', '--lib', 'es2022,dom', '--module', 'esnext', '--moduleResolution', 'bundler', '--types', '', 'typed.ts'];
    const { status, stdout } = spawnSync(process.execPath, [tsc, ...words], { cwd: place, encoding: 'utf8' });
    return { status, stdout };
  };
  assert.deepEqual(check(''), { status: 0, stdout: '' });
  assert.match(check("shader.text('essl', 'middle');").stdout, /'"middle"' is not assignable/);
});

// ---- the same bytes in every engine

const kTargets = ['glsl', 'glsl-gl', 'essl', 'hlsl', 'wgsl', 'spirv'];

/** All that a module makes of a file: for each use of each material its id, texts, words and packed bytes. Runs here and in
 * the browser, and so names nothing around it. */
function everything(library, bytes, name, targets) {
  const made = [];
  let scene;
  try {
    scene = library.scene(bytes, name);
  } catch (error) {
    return [error.messages.map(({ text }) => text)];
  }
  for (let material = 0; material < scene.materialCount; ++material) {
    for (const use of scene.uses(material)) {
      try {
        const graph = scene.graph(material, { targets }, use);
        const shader = graph.generate({ targets });
        made.push([shader.id, [...shader.pack()], shader.interface]);
        for (const stage of ['vertex', 'fragment']) {
          for (const target of targets) made.push(target === 'spirv' ? [...shader.spirv(stage)] : shader.text(target, stage));
        }
        shader.free();
        graph.free();
      } catch (error) {
        made.push(error.messages.map(({ text }) => text));
      }
    }
  }
  scene.free();
  return made;
}

test('in Chromium the module makes what it makes in Node', async () => {
  const { load } = await import(join(output, 'package/index.js'));
  const library = await load();
  const server = await serve(join(output, 'package'));
  const page = await browser.newPage();
  try {
    await page.goto(`${server.url}/package.json`);
    await page.evaluate(async (everything) => {
      const { load } = await import('/index.js');
      const library = await load();
      const make = new Function(`return ${everything}`)();
      window.digest = async (base64, name, targets) => {
        const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
        const text = new TextEncoder().encode(JSON.stringify(make(library, bytes, name, targets)));
        return { size: text.length, hash: [...new Uint8Array(await crypto.subtle.digest('SHA-256', text))].map((x) => x.toString(16).padStart(2, '0')).join('') };
      };
    }, String(everything));
    let shaders = 0;
    for (const file of inputs()) {
      const made = everything(library, read(file), file, kTargets);
      const text = Buffer.from(JSON.stringify(made));
      const expected = { size: text.length, hash: createHash('sha256').update(text).digest('hex') };
      const words = [read(file).toString('base64'), file, kTargets];
      assert.deepEqual(await page.evaluate((words) => window.digest(...words), words), expected, file);
      shaders += made.filter(Array.isArray).length;
    }
    assert.ok(shaders > 30, `${shaders}`);
  } finally {
    await page.close();
    server.close();
  }
});
