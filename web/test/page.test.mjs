// The page in a real browser, and the example of the package: Debian's Chromium, driven by playwright-core.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join, normalize } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';
import { lacquer, output, read, root, withImages } from './native.mjs';

const { load } = await import(join(output, 'package/index.js'));
const kChromium = process.env.LACQUER_CHROMIUM ?? '/usr/bin/chromium';
const kSamples = ['car_paint', 'clearcoat', 'clearcoat_color', 'clearcoat_darkening', 'clearcoat_tint', 'coat', 'core'];
/** How far the browser's colours may be from `lacquer eval --engine float`: a 255th, of what a display can show. */
const kTolerance = 1 / 255;

let browser;
let folder;
let library;
before(async () => {
  library = await load();
  browser = await chromium.launch({
    executablePath: kChromium, args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
  });
  folder = mkdtempSync(join(tmpdir(), 'lacquer-page-'));
  cpSync(join(root, 'examples/textures'), join(folder, 'textures'), { recursive: true });
});
after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true });
});

/** A page made by `lacquer view`, from the disk; fails on any message on the console. */
async function open(files, use, size = { width: 1440, height: 900 }) {
  const html = join(folder, 'page.html');
  lacquer('view', ...files, '-o', html, '--page', join(output, 'view.html'));
  const context = await browser.newContext({ viewport: size, colorScheme: 'light', acceptDownloads: true });
  context.setDefaultTimeout(120_000); // a machine may have other work
  const page = await context.newPage();
  const said = [];
  page.on('console', (message) => said.push(message.text()));
  page.on('pageerror', (error) => said.push(String(error)));
  await page.goto(pathToFileURL(html).href);
  await page.waitForSelector('body.ready', { timeout: 240_000 });
  try {
    await use(page);
  } finally {
    await context.close();
  }
  assert.deepEqual(said, []);
}

/** The current material's textures are uploaded. */
const settled = (page) => page.evaluate(async () => {
  const it = window.lacquerPage;
  await it.viewport.loadTextures(it.document.file, it.lookNow());
});

const kPoint = { n: [0.2, 0.3, 0.9327379], t: [0.9777802, 0, -0.2096336, 1], l: [0.36, 0.48, 0.8], light: [1.5, 1.4, 1.3], uv: [0.3, 0.6] };

/** Sets a slider as a person does, and asks for the colour; the edited file stays in the page. */
async function set(page, id, value) {
  return page.evaluate(([id, value, point]) => {
    const it = window.lacquerPage;
    const slider = document.getElementById(id);
    slider.value = String(value);
    slider.dispatchEvent(new Event('input', { bubbles: true }));
    slider.dispatchEvent(new Event('change', { bubbles: true }));
    const look = it.lookNow();
    return {
      lamp: it.viewport.probe(look, { ...point, env: [0, 0, 0] }),
      id: look.id,
      json: JSON.stringify(it.document.json),
      name: it.document.names[it.document.material],
      status: document.getElementById('status').textContent,
    };
  }, [id, value, kPoint]);
}

const kEvaluated = { n: kPoint.n, t: kPoint.t, v: [0, 0, 1], l: kPoint.l, light: kPoint.light, uv0: kPoint.uv, uv1: kPoint.uv, env: [0, 0, 0] };

/** `lacquer eval` of an edited file, whose images lie beside the examples. */
function evaluatedByProgram(json, name) {
  const file = join(folder, 'edited.gltf');
  writeFileSync(file, json);
  writeFileSync(join(folder, 'points.json'), JSON.stringify([kEvaluated]));
  return JSON.parse(lacquer('eval', file, '--material', name, '--engine', 'float', '--points', join(folder, 'points.json'))).rgba[0];
}

/** The same by the module in Node, without a process for each: its images are put into the file. */
function evaluated(json, material) {
  const scene = library.scene(withImages(json), 'edited.gltf');
  try {
    return scene.evaluate(material, [kEvaluated], { engine: 'float' }).rgba[0];
  } finally {
    scene.free();
  }
}

for (const sample of kSamples) {
  test(`${sample}: every slider at both ends and the middle gives the colours of \`lacquer eval\``, () =>
    open([`examples/${sample}.gltf`], async (page) => {
      const materials = await page.evaluate(() => window.lacquerPage.document.names.length);
      let compared = 0;
      for (let material = 0; material < materials; ++material) {
        await page.selectOption('#material', String(material));
        await settled(page);
        const sliders = await page.evaluate(() =>
          [...document.querySelectorAll('#properties input[type=range]')].map(({ id, min, max, value }) => ({ id, min: Number(min), max: Number(max), value })),
        );
        for (const { id, min, max, value } of sliders) {
          for (const x of [min, (min + max) / 2, max]) {
            const got = await set(page, id, x);
            assert.equal(got.status, '', `${id} ${x}`);
            const expected = compared % 40 === 0 ? evaluatedByProgram(got.json, got.name) : evaluated(got.json, material);
            got.lamp.forEach((c, i) => {
              if (expected[i] === null) return;
              const scale = Math.max(1, Math.abs(expected[i]));
              assert.ok(Math.abs(c - expected[i]) <= kTolerance * scale, `${got.name} ${id} = ${x}: ${got.lamp} is not ${expected}`);
            });
            ++compared;
          }
          await set(page, id, value);
        }
      }
      assert.ok(compared > 10, `${compared}`);
    }));
}

test('the texts on the page are those of `lacquer gen`', () =>
  open(kSamples.map((name) => `examples/${name}.gltf`), async (page) => {
    const manifest = JSON.parse(read('generated/manifest.json'));
    const kExtension = { essl: 'glsl', glsl: 'glsl', 'glsl-gl': 'glsl', hlsl: 'hlsl' };
    let compared = 0;
    for (const [i, sample] of kSamples.entries()) {
      await page.selectOption('#sample', String(i));
      const file = manifest.files.find(({ source }) => source.endsWith(`/${sample}.gltf`));
      for (const material of file.materials) {
        await page.selectOption('#material', String(material.index));
        const id = await page.textContent('#id');
        assert.equal(id, material.uses[0].shader);
        for (const [target, extension] of Object.entries(kExtension)) {
          await page.selectOption('#target', target);
          const text = await page.evaluate(() => document.getElementById('code').textContent);
          assert.equal(text, readFileSync(join(root, 'generated', target, `${id}.frag.${extension}`), 'utf8'));
          ++compared;
        }
      }
    }
    assert.ok(compared > 60);
  }));

test('a slider at its neutral end says that the term has left, and brings it back', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    const id = 'p:/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor';
    const row = '[data-pointer="/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor"]';
    const before = await page.textContent('#id');
    await set(page, id, 0);
    assert.ok(await page.isVisible(`${row} .gone`));
    assert.notEqual(await page.textContent('#id'), before);
    await page.click('[data-tab=notes]');
    await page.waitForSelector('#skipped li');
    await set(page, id, 0.5);
    assert.ok(!(await page.isVisible(`${row} .gone`)));
    assert.equal(await page.textContent('#id'), before);
  }));

test('drop, edit, undo, export and reload', () =>
  open([], async (page) => {
    await drop(page, [['sphere.gltf', read('examples/core.gltf')]]);
    assert.equal(await page.textContent('#file'), 'sphere.gltf');
    const id = 'p:/materials/0/pbrMetallicRoughness/roughnessFactor';
    const at = () => page.evaluate(() => window.lacquerPage.document.get('/materials/0/pbrMetallicRoughness/roughnessFactor'));
    const original = await at();
    await set(page, id, 0.125);
    await set(page, id, 0.75);
    assert.equal(await at(), 0.75);
    await page.keyboard.press('Control+z');
    assert.equal(await at(), 0.125);
    await page.click('#undo');
    assert.equal(await at(), original);
    await page.click('#redo');
    const exported = await downloaded(page, '#export');
    assert.equal(JSON.parse(exported).materials[0].pbrMetallicRoughness.roughnessFactor, 0.125);
    const shader = await page.textContent('#id');
    await drop(page, [['again.gltf', Buffer.from(exported)]]);
    assert.equal(await at(), 0.125);
    assert.equal(await page.textContent('#id'), shader);
  }));

test('a .glb with its own geometry is shown, edited and exported', () =>
  open([], async (page) => {
    const gltf = JSON.parse(read('web/examples/webgl2/triangle.gltf'));
    const binary = Buffer.from(gltf.buffers[0].uri.split(',')[1], 'base64');
    delete gltf.buffers[0].uri;
    await drop(page, [['triangle.glb', glb(gltf, binary)]]);
    assert.equal(await page.inputValue('#shape'), 'own');
    await set(page, 'p:/materials/0/extensions/KHR_materials_coat/coatFactor', 0.5);
    const exported = await downloaded(page, '#export');
    await drop(page, [['again.glb', exported]]);
    const again = await page.evaluate(() => ({
      coat: window.lacquerPage.document.get('/materials/0/extensions/KHR_materials_coat/coatFactor'),
      triangles: window.lacquerPage.document.drawables.length,
    }));
    assert.deepEqual(again, { coat: 0.5, triangles: 1 });
  }));

test('a broken file gives the library\'s message, and the page lives on', () =>
  open(['examples/core.gltf'], async (page) => {
    const before = await page.textContent('#id');
    for (const [name, bytes] of [['cut.gltf', '{"asset": {"ver'], ['none.glb', 'glTF'], ['list.gltf', '[]'], ['empty.gltf', '']]) {
      await drop(page, [[name, Buffer.from(bytes)]]);
      await page.click('[data-tab=notes]');
      const text = await page.textContent('#messages');
      const native = join(folder, name);
      writeFileSync(native, bytes);
      let said = '';
      try {
        lacquer('graph', native);
      } catch (error) {
        said = error.stderr.trimEnd();
      }
      assert.equal(text, said.replaceAll(native, name));
      assert.equal(await page.textContent('#id'), before);
    }
    await set(page, 'p:/materials/0/pbrMetallicRoughness/metallicFactor', 0.3);
    assert.equal(await page.textContent('#status'), '');
  }));

test('the graph is shown by its rates, leads to the text and back, and is edited with the library\'s checks', () =>
  open(['examples/coat.gltf'], async (page) => {
    await page.click('[data-tab=graph]');
    await page.waitForSelector('#graph .node.light');
    const node = page.locator('#graph [data-node="coat.fresnel"]');
    await node.focus();
    await page.keyboard.press('Enter');
    await page.click('[data-tab=code]');
    await page.waitForSelector('#code .selected[data-term="coat.fresnel"]');
    await page.click('[data-tab=graph]');
    await page.waitForSelector('#graph .node.selected');
    const before = await page.textContent('#id');
    await page.fill('#editor input >> nth=0', '{"node": "nobody"}');
    await page.keyboard.press('Tab');
    assert.notEqual(await page.textContent('#status'), '');
    await page.click('#undo');
    assert.equal(await page.textContent('#status'), '');
    assert.equal(await page.textContent('#id'), before);
    await page.fill('#new-id', 'mine');
    await page.selectOption('#new-type', 'schlick');
    await page.click('#add-node');
    await page.waitForSelector('#graph [data-node=mine]', { state: 'attached' });
    const graph = JSON.parse(await downloaded(page, '#export-graph'));
    assert.ok(graph.nodes.some(({ id }) => id === 'mine'));
    await page.click('#forget-graph');
    await drop(page, [['graph.json', Buffer.from(JSON.stringify({ ...graph, nodes: graph.nodes.filter(({ id }) => id !== 'mine') }))]]);
    assert.equal(await page.textContent('#id'), before);
  }));

test('two profiles are compared with figures', () =>
  open(['examples/coat.gltf'], async (page) => {
    await page.selectOption('#compare', 'khr');
    assert.match(await page.textContent('#figures'), /khr \| khr: differ by at most 0\.00/);
    await page.selectOption('#compare', 'openpbr');
    const [, most] = /at most ([\d.e-]+)/.exec(await page.textContent('#figures'));
    assert.ok(Number(most) > 0);
  }));

test('sliders move within a frame', () =>
  open(['examples/car_paint.gltf'], async (page) => {
    const took = await page.evaluate(() => {
      const slider = document.getElementById('p:/materials/0/extensions/KHR_materials_coat/coatRoughnessFactor');
      const times = [];
      for (let i = 0; i < 60; ++i) {
        slider.value = String(0.2 + i / 100);
        slider.dispatchEvent(new Event('input', { bubbles: true }));
        times.push(window.lacquerPage.took);
      }
      return Math.min(...times); // what it takes when nothing else runs
    });
    console.log(`# an edit takes ${took.toFixed(1)} ms`);
    assert.ok(took < 60, `${took} ms`);
  }));

test('the page is drawn: a picture of the car paint', () =>
  open(['examples/car_paint.gltf'], async (page) => {
    await settled(page);
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    const file = process.env.LACQUER_SCREENSHOT ?? join(folder, 'page.png');
    const picture = await page.screenshot({ path: file });
    assert.ok(picture.length > 50_000);
    const colors = await page.evaluate(() => {
      const { gl } = window.lacquerPage.viewport;
      window.lacquerPage.viewport.draw();
      const rgba = new Uint8Array(4);
      gl.readPixels(gl.drawingBufferWidth / 2, gl.drawingBufferHeight / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
      return [...rgba];
    });
    assert.ok(colors[0] > colors[1] + 20, `a red paint: ${colors}`);
  }));

test('the package installs from its folder, and its example draws', async () => {
  const place = join(folder, 'example');
  cpSync(join(root, 'web/examples/webgl2'), place, { recursive: true, filter: (name) => !name.includes('node_modules') });
  const description = JSON.parse(readFileSync(join(place, 'package.json'), 'utf8'));
  description.dependencies.lacquer = `file:${join(output, 'package')}`;
  writeFileSync(join(place, 'package.json'), JSON.stringify(description));
  execFileSync('npm', ['install', '--offline', '--no-audit', '--no-fund', '--install-links'], { cwd: place, stdio: 'pipe' });
  const types = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm' };
  const server = createServer((request, response) => {
    const path = normalize(new URL(request.url, 'http://localhost').pathname);
    try {
      const bytes = readFileSync(join(place, path));
      response.writeHead(200, { 'content-type': types[extname(path)] ?? 'application/octet-stream' });
      response.end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  try {
    const page = await browser.newPage();
    const said = [];
    page.on('console', (message) => said.push(message.text()));
    page.on('pageerror', (error) => said.push(String(error)));
    await page.goto(`http://127.0.0.1:${server.address().port}/index.html`);
    await page.waitForFunction(() => document.title === 'drawn');
    const picture = await page.locator('canvas').screenshot();
    await page.close();
    assert.deepEqual(said, []);
    assert.ok(picture.length > 3000, 'there is more than one colour');
  } finally {
    server.close();
  }
});

async function drop(page, files) {
  await page.evaluate(async (files) => {
    await window.lacquerPage.take(files.map(([name, bytes]) => new File([new Uint8Array(bytes)], name)));
  }, files.map(([name, bytes]) => [name, [...bytes]]));
}

async function downloaded(page, button) {
  if (!(await page.isVisible(button))) await page.click('[data-tab=graph]');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click(button)]);
  return readFileSync(await download.path());
}

function glb(json, binary) {
  const pad = (bytes, with_) => Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, with_)]);
  const chunk = (kind, bytes) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(bytes.length, 0);
    head.writeUInt32LE(kind, 4);
    return Buffer.concat([head, bytes]);
  };
  const chunks = [chunk(0x4e4f534a, pad(Buffer.from(JSON.stringify(json)), ' ')), chunk(0x004e4942, pad(binary, 0))];
  const head = Buffer.alloc(12);
  head.write('glTF', 0);
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(12 + chunks[0].length + chunks[1].length, 8);
  return Buffer.concat([head, ...chunks]);
}
