// The page in a real browser, and the example of the package: Debian's Chromium, driven by playwright-core.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cpSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join, normalize } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';
import { lacquer, output, read, root, withImages } from './native.mjs';

const { load } = await import(join(output, 'package/index.js'));
const kChromium = process.env.LACQUER_CHROMIUM ?? '/usr/bin/chromium';
const kSamples = readdirSync(join(root, 'examples')).filter((name) => name.endsWith('.gltf')).map((name) => name.slice(0, -5)).sort();
/** Milliseconds after which a page is given up: a machine may have much other work. */
const kPatience = 600_000;
/** How far the browser's colours may be from `lacquer eval --engine float`: a 255th, of what a display can show. */
const kTolerance = 1 / 255;

const launch = (...more) => chromium.launch({
  executablePath: kChromium,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', ...more],
});
/** What software needs to show WebGPU. WebGL says in that browser how slow its readPixels is. */
const kWebGpu = [
  '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--use-vulkan=swiftshader', '--enable-features=Vulkan',
  '--disable-vulkan-surface',
];
const kSlow = /GPU stall due to ReadPixels/;

/** Whether a browser has WebGPU; it is asked where the page lies, for not every place may have it. */
const hasWebGpu = (page) => page.evaluate(async () => Boolean(await navigator.gpu?.requestAdapter()));

let browser;
let folder;
let library;
before(async () => {
  library = await load();
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), 'lacquer-page-'));
  cpSync(join(root, 'examples/textures'), join(folder, 'textures'), { recursive: true });
});
after(async () => {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true });
});

/** A page made by `lacquer view`, from the disk; fails on any message on the console. */
async function open(files, use, { flags = ['--no-cost'], url = null, size = { width: 1440, height: 900 }, by = browser } = {}) {
  const html = join(folder, 'page.html');
  lacquer('view', ...files, '-o', html, '--page', join(output, 'view.html'), ...flags);
  const context = await by.newContext({ viewport: size, colorScheme: 'light', acceptDownloads: true });
  context.setDefaultTimeout(kPatience);
  const page = await context.newPage();
  const said = [];
  page.on('console', (message) => kSlow.test(message.text()) || said.push(message.text()));
  page.on('pageerror', (error) => said.push(String(error)));
  await page.goto(url ?? pathToFileURL(html).href, { timeout: kPatience });
  await page.waitForSelector('body.ready');
  try {
    await use(page);
  } finally {
    await context.close();
  }
  assert.deepEqual(said, []);
}

/** All that was asked for is on the canvas. */
const painted = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

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
    const kExtension = { essl: 'glsl', glsl: 'glsl', 'glsl-gl': 'glsl', hlsl: 'hlsl', wgsl: 'wgsl' };
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

test('profiles, simplifications and materials are compared with figures, side by side and as a difference', () =>
  open(['examples/coat.gltf'], async (page) => {
    const most = async (value) => {
      await page.selectOption('#compare', value);
      return Number(/at most ([\d.e+-]+)/.exec(await page.textContent('#figures'))?.[1]);
    };
    assert.ok(await page.isHidden('#comparing'));
    assert.equal(await most('profile:khr'), 0);
    assert.match(await page.textContent('#figures'), /one shader/);
    assert.ok((await most('profile:openpbr')) > 0);
    assert.ok((await most('material:2')) > 0);
    assert.ok((await most('simplify:without:coat')) > 0);
    assert.ok((await most('simplify:switch:ibl=off')) > 0);
    // What is compared is what the same words give the program.
    const id = await page.evaluate(() => window.lacquerPage.viewport.other.look.id);
    const options = { targets: ['essl'], simplify: ['switch:ibl=off'] };
    const scene = library.scene(read('examples/coat.gltf'), 'coat.gltf');
    assert.equal(id, scene.graph(0, options).generate(options).id);
    const [left, right] = await page.evaluate(() => {
      const { viewport } = window.lacquerPage;
      const at = (x) => {
        const { gl } = viewport;
        viewport.draw();
        const rgba = new Uint8Array(4);
        gl.readPixels(gl.drawingBufferWidth * x, gl.drawingBufferHeight / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
        return [...rgba];
      };
      return [at(0.45), at(0.55)];
    });
    assert.notDeepEqual(left, right);
    await page.selectOption('#compared', 'difference');
    await most('profile:khr');
    const black = await page.evaluate(() => {
      const { viewport } = window.lacquerPage;
      const { gl } = viewport;
      viewport.draw();
      const rgba = new Uint8Array(4);
      gl.readPixels(gl.drawingBufferWidth / 2, gl.drawingBufferHeight / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
      return [...rgba];
    });
    assert.deepEqual(black, [0, 0, 0, 255]);
    await page.selectOption('#compare', '');
    assert.ok(await page.isHidden('#comparing'));
  }));

test('costs are those that `lacquer view` measured, errors those of the tables', (t) =>
  open(['examples/coat.gltf'], async (page) => {
    await page.click('[data-tab=cost]');
    await page.waitForSelector('#errors-of-terms tr.used');
    const measured = JSON.parse(await page.textContent('#costs'));
    const id = await page.textContent('#id');
    assert.ok(measured[id].spirv > 50);
    const { gpus } = measured[id];
    if (Object.keys(gpus).length === 0) t.diagnostic('there is no RADV: SPIR-V alone is counted');
    for (const [gpu, { instructions }] of Object.entries(gpus)) {
      const row = page.locator('#measured tr', { has: page.locator(`th:text-is("${gpu}")`) });
      assert.equal(await row.locator('td').first().textContent(), String(instructions));
    }
    assert.match(await page.textContent('#operations'), /\d+ fragment, \d+ light/);
    const sizes = await page.textContent('#sizes');
    const text = readFileSync(join(root, 'generated/essl', `${id}.frag.glsl`));
    assert.ok(sizes.includes(`essl ${text.length},`), sizes);
    await page.selectOption('#material', { label: 'Absorption' });
    const { reference, rational } = JSON.parse(read('bench/error.json')).nodes.coat_absorption;
    await page.waitForSelector('#errors-of-terms th:text-is("coat.absorption")');
    const table = await page.textContent('#errors-of-terms');
    for (const of of [reference.e1.ulp, rational.e2.absolute]) assert.ok(table.includes(`${of.max} / ${of.p999} / ${of.rms}`), table);
    await page.click('#errors-of-terms button:text-is("rational")');
    assert.equal(await page.inputValue('#compare'), 'simplify:variant:coat.absorption=rational');
    assert.match(await page.textContent('#figures'), /differ by at most/);
  }, { flags: [] }));

/** Two triangles that face +z, under lamps of their own. */
function lit(lights) {
  const gltf = JSON.parse(read('web/examples/webgl2/triangle.gltf'));
  gltf.extensions = { KHR_lights_punctual: { lights } };
  gltf.nodes.push(...lights.map((_, light) => ({ translation: [0, 0, 2], extensions: { KHR_lights_punctual: { light } } })));
  gltf.scenes[0].nodes = gltf.nodes.map((_, i) => i);
  return Buffer.from(JSON.stringify(gltf));
}

const middle = (page) => page.evaluate(() => {
  const { viewport } = window.lacquerPage;
  const { gl } = viewport;
  viewport.draw();
  const rgba = new Uint8Array(4);
  gl.readPixels(gl.drawingBufferWidth / 2, gl.drawingBufferHeight / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
  return [...rgba];
});

test("a file's own lamps light it", () =>
  open(['examples/core.gltf'], async (page) => {
    const offered = () => page.evaluate(() => !document.querySelector('#lamps option[value=own]').disabled);
    assert.ok(!(await offered()));
    await drop(page, [['lit.gltf', lit([{ type: 'point', color: [0, 1, 0], intensity: 40 }])]]);
    assert.ok(await offered());
    await page.selectOption('#environment', 'Dark');
    await page.selectOption('#lamps', 'none');
    assert.deepEqual(await middle(page), [0, 0, 0, 255]);
    await page.selectOption('#lamps', 'own');
    const [red, green, blue] = await middle(page);
    assert.ok(green > 40 && red === blue, `${[red, green, blue]}`);
    await drop(page, [['core.gltf', read('examples/core.gltf')]]);
    assert.equal(await page.inputValue('#lamps'), 'studio');
  }));

/** A .hdr file of one colour, whose numbers are powers of two. */
function plainHdr(width, height, value) {
  const head = Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`);
  return Buffer.concat([head, Buffer.alloc(4 * width * height, Buffer.from([128, 128, 128, 129 + Math.log2(value)]))]);
}

test('an environment of one\'s own is dropped, and a broken one refused', () =>
  open(['examples/core.gltf'], async (page) => {
    await page.selectOption('#lamps', 'none');
    await drop(page, [['plain.hdr', plainHdr(64, 32, 1)]]);
    assert.equal(await page.inputValue('#environment'), 'plain.hdr');
    // What an environment of one colour gives is what `lacquer eval` says of one.
    const [seen, constant] = await page.evaluate(() => {
      const it = window.lacquerPage;
      const look = it.lookNow();
      const point = { n: [0, 0, 1], t: [1, 0, 0, 1], l: [0, 0, 1], light: [0, 0, 0], uv: [0.3, 0.6] };
      return [it.viewport.probe(look, point, 'plain.hdr'), it.viewport.probe(look, { ...point, env: [1, 1, 1] })];
    });
    seen.forEach((x, i) => assert.ok(Math.abs(x - constant[i]) < 0.01, `${seen} is not ${constant}`));
    const before = await middle(page);
    await drop(page, [['broken.hdr', Buffer.from('#?RADIANCE\n\n-Y 4 +X 4\n12')]]);
    assert.match(await page.textContent('#status'), /ends too early/);
    assert.equal(await page.inputValue('#environment'), 'plain.hdr');
    assert.deepEqual(await middle(page), before);
    await drop(page, [['plain.hdr', plainHdr(8, 4, 4)]]);
    assert.notDeepEqual(await middle(page), before);
  }));

test('WebGPU draws what WebGL 2 draws', async (t) => {
  const by = await launch(...kWebGpu);
  try {
    await open(['examples/car_paint.gltf', 'examples/glass.gltf', 'web/examples/webgl2/triangle.gltf'], async (page) => {
      if (!(await hasWebGpu(page))) return t.skip('this browser has no WebGPU');
      await page.evaluate(() => window.lacquerPage.paintWith('webgpu'));
      assert.equal(await page.inputValue('#painter'), 'webgpu');
      assert.ok(await page.isVisible('#viewport-gpu'));
      for (const sample of [0, 1, 2]) {
        await page.selectOption('#sample', String(sample));
        await settled(page);
        const { mean, far, colors } = await page.evaluate(async () => {
          const { viewport } = window.lacquerPage;
          const { gpu } = viewport;
          // WebGL's canvas is hidden: it takes the size of the other.
          viewport.gpu = null;
          gpu.canvas.hidden = true;
          viewport.canvas.hidden = false;
          const theirs = viewport.pixels();
          const mine = await gpu.pixels(viewport, viewport.canvas.width, viewport.canvas.height);
          viewport.gpu = gpu;
          gpu.canvas.hidden = false;
          viewport.canvas.hidden = true;
          const differ = mine.map((x, i) => Math.abs(x - theirs[i]));
          return {
            mean: differ.reduce((sum, x) => sum + x, 0) / mine.length, far: differ.filter((x) => x > 8).length / mine.length,
            colors: new Set(mine).size,
          };
        });
        // Edges are sampled in other places.
        assert.ok(mean < 0.2 && far < 0.005, `${sample}: ${mean} in the mean, ${far} of all far`);
        assert.ok(colors > 20, 'there is a picture');
      }
      await page.selectOption('#painter', 'webgl');
      assert.ok(await page.isVisible('#viewport'));
    }, { by });
  } finally {
    await by.close();
  }
});

test('a slider that keeps the structure makes no program', () =>
  open(['examples/car_paint.gltf'], async (page) => {
    const { before, after, took } = await page.evaluate(() => {
      const { viewport } = window.lacquerPage;
      const slider = document.getElementById('p:/materials/0/extensions/KHR_materials_coat/coatRoughnessFactor');
      const times = [];
      const before = viewport.programCount;
      for (let i = 0; i < 60; ++i) {
        slider.value = String(0.2 + i / 100);
        slider.dispatchEvent(new Event('input', { bubbles: true }));
        times.push(window.lacquerPage.took);
      }
      return { before, after: viewport.programCount, took: Math.min(...times) };
    });
    console.log(`# an edit takes ${took.toFixed(1)} ms`);
    assert.equal(after, before);
  }));

test('it opens from a static server, and its tabs from the keyboard', async () => {
  const server = await serve(folder);
  try {
    await open(['examples/core.gltf'], async (page) => {
      await page.focus('[data-tab=code]');
      for (const tab of ['graph', 'cost', 'notes', 'code']) {
        await page.keyboard.press('ArrowRight');
        assert.ok(await page.isVisible(`#panel-${tab}`), tab);
      }
      await page.focus('#viewport');
      const before = await page.evaluate(() => window.lacquerPage.viewport.orbit.yaw);
      await page.keyboard.press('ArrowLeft');
      assert.notEqual(await page.evaluate(() => window.lacquerPage.viewport.orbit.yaw), before);
    }, { url: `${server.url}/page.html` });
  } finally {
    server.close();
  }
});

test('the page is drawn: a picture of the car paint', () =>
  open(['examples/car_paint.gltf'], async (page) => {
    await settled(page);
    await painted(page);
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

/** The package and an example, installed as a person does it. */
function installed(example) {
  const place = join(folder, example);
  cpSync(join(root, 'web/examples', example), place, { recursive: true, filter: (name) => !name.includes('node_modules') });
  const description = JSON.parse(readFileSync(join(place, 'package.json'), 'utf8'));
  description.dependencies.lacquer = `file:${join(output, 'package')}`;
  writeFileSync(join(place, 'package.json'), JSON.stringify(description));
  execFileSync('npm', ['install', '--offline', '--no-audit', '--no-fund', '--install-links'], { cwd: place, stdio: 'pipe' });
  return place;
}

/** Gives files of a folder away, but for those that `hidden` matches. */
async function serve(place, hidden = /^$/) {
  const types = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm' };
  const server = createServer((request, response) => {
    const path = normalize(new URL(request.url, 'http://localhost').pathname);
    try {
      if (hidden.test(path)) throw new Error('hidden');
      const bytes = readFileSync(join(place, path));
      response.writeHead(200, { 'content-type': types[extname(path)] ?? 'application/octet-stream' });
      response.end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  return { url: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}

/** Uses the page of an example that has drawn; fails on any message but those that are expected. */
async function drawn(place, use, { by = browser, hidden = undefined, expected = [], before = () => undefined } = {}) {
  const server = await serve(place, hidden);
  const page = await by.newPage();
  try {
    const said = [];
    page.on('console', (message) => said.push(message.text()));
    page.on('pageerror', (error) => said.push(String(error)));
    await page.addInitScript(before);
    await page.goto(`${server.url}/index.html`, { timeout: kPatience });
    await page.waitForFunction(() => document.title === 'drawn', null, { timeout: kPatience });
    assert.deepEqual(said, expected);
    return await use(page);
  } finally {
    await page.close();
    server.close();
  }
}

test('the package installs from its folder, and its WebGL 2 example draws', async () => {
  const place = installed('webgl2');
  const shot = (page) => page.locator('canvas').screenshot();
  const picture = await drawn(place, shot);
  assert.ok(picture.length > 3000, 'there is more than one colour');
  // Where lacquer.wasm is not given away, the copy of it that is a script serves.
  const expected = ['Failed to load resource: the server responded with a status of 404 (Not Found)'];
  const again = await drawn(place, shot, { hidden: /\.wasm$/, expected });
  assert.ok(again.equals(picture));
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

test('its WebGPU example draws', async (t) => {
  const by = await launch(...kWebGpu);
  try {
    const place = installed('webgpu');
    const page = await by.newPage();
    const server = await serve(place);
    await page.goto(`${server.url}/package.json`);
    const there = await hasWebGpu(page);
    await page.close();
    server.close();
    if (!there) return t.skip('this browser has no WebGPU');
    const colors = await drawn(place, (page) => page.evaluate(async () => {
      const { device, texture } = window.kept;
      const buffer = device.createBuffer({ size: 4 * 512 * 512, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ });
      const encoder = device.createCommandEncoder();
      encoder.copyTextureToBuffer({ texture }, { buffer, bytesPerRow: 4 * 512 }, [512, 512]);
      device.queue.submit([encoder.finish()]);
      await buffer.mapAsync(GPUMapMode.READ);
      const words = new Uint32Array(buffer.getMappedRange());
      return { corner: words[0], middle: words[512 * 256 + 256], all: new Set(words).size };
    }), { by, before: keepTexture });
    assert.notEqual(colors.corner, colors.middle);
    assert.ok(colors.all > 20, `${colors.all} colours`);
  } finally {
    await by.close();
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
