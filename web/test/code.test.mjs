// The generated text, taken away, and the material in the page's address.
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { unzipSync } from 'fflate';
import { lacquer, read } from './native.mjs';
import { begin, drop, end, folder, kSmall, open, set } from './page.mjs';

before(begin);
after(end);

const graphNow = (page) => page.evaluate(() => JSON.parse(window.lacquerPage.document.graphs.get(0) ?? 'null'));
const address = (page) => page.evaluate(() => location.hash);

test('the text is copied and saved as `lacquer gen` writes it, under its name', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
    const out = join(folder, 'code');
    lacquer('gen', 'examples/clearcoat.gltf', '-o', out, '-q', '--target', 'essl,hlsl,spirv,cpp');
    const id = await page.textContent('#id');
    await page.click('#copy-code');
    await page.waitForFunction(() => document.getElementById('code-told').textContent === 'copied');
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), readFileSync(join(out, 'essl', `${id}.frag.glsl`), 'utf8'));
    for (const [target, stage, ending] of [['essl', 'vertex', 'vert.glsl'], ['hlsl', 'fragment', 'frag.hlsl'], ['spirv', 'fragment', 'frag.spv'], ['cpp', 'fragment', 'h']]) {
      await page.selectOption('#target', target);
      await page.selectOption('#stage', stage);
      const [download] = await Promise.all([page.waitForEvent('download'), page.click('#download-code')]);
      assert.equal(download.suggestedFilename(), `${id}.${ending}`);
      assert.deepEqual(readFileSync(await download.path()), readFileSync(join(out, target, `${id}.${ending}`)), target);
    }
    await page.selectOption('#target', 'essl');
    await page.selectOption('#stage', 'fragment');
    assert.equal(await page.textContent('#size'), `${readFileSync(join(out, 'essl', `${id}.frag.glsl`)).length} bytes`);
  }));

test('a node is said to have no lines where the text has sections, and nowhere else', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    await page.click('#code [data-term="base.direct"]');
    assert.equal(await page.textContent('#code-told'), '');
    await page.selectOption('#stage', 'vertex');
    assert.match(await page.textContent('#code-told'), /^base\.direct has no lines here/);
    for (const target of ['spirv', 'msl']) {
      await page.selectOption('#target', target);
      assert.equal(await page.textContent('#code-told'), '', target);
    }
  }, { size: kSmall }));

test('the text is made with the options of `lacquer gen` that are chosen; the picture stays', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    const id = await page.textContent('#id');
    const saved = async () => {
      const [download] = await Promise.all([page.waitForEvent('download'), page.click('#download-code')]);
      return [download.suggestedFilename(), readFileSync(await download.path(), 'utf8')];
    };
    const cases = [
      ['baked', ['--params', 'baked', '--lights', 'none'], { 'gen-parameters': 'baked', 'gen-lights': 'none' }],
      ['halves', ['--params', 'baked', '--relaxed', '0.02'], { 'gen-parameters': 'baked', 'gen-relaxed': '0.02' }],
      ['surface', ['--template', 'surface'], { 'gen-template': 'surface' }],
      ['switched', ['--switch', 'ibl=off', '--switch', 'dfg_table=off'], { 'switch-ibl': 'off', 'switch-dfg_table': 'off' }],
    ];
    for (const [name, flags, chosen] of cases) {
      const out = join(folder, name);
      lacquer('gen', 'examples/clearcoat.gltf', '-o', out, '-q', '--target', 'essl', ...flags);
      await page.evaluate(() => document.querySelector('#generated details').setAttribute('open', ''));
      for (const [control, value] of Object.entries(chosen)) await page.selectOption(`#${control}`, value);
      const [file, text] = await saved();
      assert.equal(text, readFileSync(join(out, 'essl', file), 'utf8'), name);
      assert.equal(await page.textContent('#code'), text);
      assert.equal(await page.textContent('#id'), id);
      for (const control of Object.keys(chosen)) await page.selectOption(`#${control}`, '');
    }
    assert.equal((await saved())[0], `${id}.frag.glsl`);
    const fixed = join(folder, 'fixed');
    lacquer('gen', 'examples/clearcoat.gltf', '-o', fixed, '-q', '--target', 'essl', '--lights', 'directional:1,point:4');
    assert.ok(await page.isHidden('#gen-counts'));
    await page.selectOption('#gen-lights', 'fixed');
    await page.fill('#gen-count-point', '4');
    const [counted, of_counts] = await saved();
    assert.equal(of_counts, readFileSync(join(fixed, 'essl', counted), 'utf8'));
    // MSL is the program's.
    await page.selectOption('#target', 'msl');
    assert.match(await page.textContent('#code'), /\n\nlacquer gen clearcoat\.gltf --material \S+ --target msl -o shaders --profile khr --lights directional:1,point:4\n?$/);
    await page.selectOption('#target', 'essl');
    await page.selectOption('#gen-lights', '');
    // What cannot be together is said in the place of the text.
    await page.selectOption('#gen-binding', 'bindless');
    assert.match(await page.textContent('#code'), /bindless/);
    // What has them is saved all the same, alone and in the folder.
    await page.selectOption('#target', 'hlsl');
    const out = join(folder, 'bindless');
    lacquer('gen', 'examples/clearcoat.gltf', '-o', out, '-q', '--no-validate', '--target', 'hlsl', '--binding', 'bindless');
    const [file, text] = await saved();
    assert.equal(text, readFileSync(join(out, 'hlsl', file), 'utf8'));
    const [download] = await Promise.all([page.waitForEvent('download'), page.click('#download-folder')]);
    const files = Object.keys(unzipSync(readFileSync(await download.path())));
    assert.ok(files.includes(`hlsl/${file}`) && !files.some((name) => name.startsWith('essl/')), files.join());
    assert.match(await page.textContent('#code-told'), /^without essl/);
  }));

test('all targets are saved as a folder, as `lacquer gen` writes it', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    const all = await page.evaluate(() => [...document.getElementById('target').options].map(({ value }) => value));
    const targets = all.filter((target) => target !== 'msl');
    const out = join(folder, 'folder');
    lacquer('gen', 'examples/clearcoat.gltf', '-o', out, '-q', '--no-validate', '--target', targets.join());
    const id = await page.textContent('#id');
    const saved = async () => {
      const [download] = await Promise.all([page.waitForEvent('download'), page.click('#download-folder')]);
      assert.equal(download.suggestedFilename(), `${id}.zip`);
      return readFileSync(await download.path());
    };
    const bytes = await saved();
    const files = unzipSync(bytes);
    let compared = 0;
    for (const target of targets) {
      for (const name of readdirSync(join(out, target)).filter((name) => name.startsWith(id) && !name.endsWith('.d.ts'))) {
        assert.ok(Buffer.from(files[`${target}/${name}`]).equals(readFileSync(join(out, target, name))), name);
        ++compared;
      }
    }
    assert.equal(Object.keys(files).length, compared + 3);
    const { shaders } = JSON.parse(readFileSync(join(out, 'manifest.json')));
    const { uniforms } = JSON.parse(Buffer.from(files['interface.json']));
    assert.deepEqual(uniforms, shaders[id].uniforms);
    assert.equal(files['material.bin'].length, uniforms.find(({ block }) => block === 'Material').size);
    assert.equal(JSON.parse(Buffer.from(files['graph.json'])).template, 'forward');
    assert.ok((await saved()).equals(bytes));
  }));

test('a node of a graph leads to its lines, whatever it is called, and its lines to it', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    await page.evaluate(() => window.lacquerPage.editGraph((graph) => graph.edit([
      { do: 'add_node', node: { id: 'glow', node: 'occluded', inputs: { light: { node: 'coat.layer_ibl' }, visible: 0.1 } } },
      { do: 'set_output', output: 'emission', source: { node: 'glow' } },
    ])));
    await page.click('[data-tab=graph]');
    await page.click('#graph [data-box="node glow"] .head');
    await page.click('[data-tab=code]');
    await page.waitForSelector('#code .section.selected[data-term=occluded]');
    await page.click('#code [data-term="coat.fresnel"]');
    await page.click('#code [data-term=occluded]');
    await page.click('[data-tab=graph]');
    await page.waitForSelector('#graph [data-box="node glow"].selected');
    await page.click('#graph [data-box="node base.alpha"] .head');
    await page.click('[data-tab=code]');
    assert.match(await page.textContent('#code-told'), /base\.alpha has no lines here/);
  }));

test("a material with its graph and nodes is shared by the page's address, without its pictures, which is said", () =>
  open(['examples/car_paint.gltf'], async (page) => {
    const nodes = '/// Half of it.\n/// source: a test\nnode halved(vec3 light in [0, 1]) -> vec3 in [0, 1] {\n    return light / 2;\n}\n';
    await drop(page, [['clear.gltf', read('examples/clearcoat.gltf')]]);
    await set(page, 'p:/materials/0/pbrMetallicRoughness/roughnessFactor', 0.25);
    await page.click('[data-tab=nodes]');
    await page.click('#node-text');
    await page.keyboard.insertText(nodes);
    await page.waitForFunction(() => window.lacquerPage.document.nodeText !== '');
    await page.evaluate(() => window.lacquerPage.editGraph((graph) => graph.edit([
      { do: 'add_node', node: { id: 'half', node: 'halved', inputs: { light: 0.5 } } }, { do: 'set_output', output: 'emission', source: { node: 'half' } },
    ].map((each) => (each.node?.id === 'half' ? { ...each, node: { ...each.node, id: 'mine' } } : { ...each, source: { node: 'mine' } })))));
    const [id, graph] = [await page.textContent('#id'), await graphNow(page)];
    await page.click('#share');
    await page.waitForFunction(() => location.hash.startsWith('#share='));
    await page.waitForFunction(() => document.getElementById('status').textContent !== '');
    assert.match(await page.textContent('#status'), /the address of the page has Varnish, \d+ characters/);
    assert.ok(!/without its textures/.test(await page.textContent('#status')));
    const hash = await address(page);
    assert.ok(hash.length < 8000, `${hash.length} characters`);
    await page.reload();
    await page.waitForSelector('body.ready');
    assert.equal(await page.textContent('#file'), 'Varnish.gltf');
    assert.equal(await page.textContent('#id'), id);
    assert.deepEqual(await graphNow(page), graph);
    assert.equal(await page.inputValue('#node-text'), nodes);
    // One with textures: what it names is left out.
    await page.selectOption('#sample', '0');
    await page.click('#share');
    await page.waitForFunction((before) => location.hash !== before, hash);
    await page.waitForFunction(() => /textures/.test(document.getElementById('status').textContent));
    assert.match(await page.textContent('#status'), /without its textures \(.*normalTexture/i);
    await page.reload();
    await page.waitForSelector('body.ready');
    assert.equal(await page.textContent('#status'), '');
    assert.equal(await page.evaluate(() => JSON.stringify(window.lacquerPage.document.json).includes('Texture')), false);
    // What is no address of ours leaves what is there.
    const shown = await page.textContent('#id');
    for (const bad of ['#share=abc', '#share=!!', `#share=${hash.slice(7, 60)}`]) {
      await page.evaluate((to) => (location.hash = to), bad);
      await page.waitForFunction(() => /no material that can be read/.test(document.getElementById('status').textContent));
      assert.equal(await page.textContent('#id'), shown);
    }
  }));

test('an address opens every material of the gallery', () =>
  open(['examples/core.gltf'], async (page) => {
    const { materials } = JSON.parse(read('bench/peers/gallery.gltf'));
    assert.ok(materials.length >= 40);
    for (const { name } of materials) {
      await page.evaluate((to) => (location.hash = to), `#open=gallery.gltf/${encodeURIComponent(name)}`);
      await page.waitForFunction((wanted) => {
        const { document: of } = window.lacquerPage;
        return of.file.name === 'gallery.gltf' && of.names[of.material] === wanted;
      }, name);
      assert.equal(await page.textContent('#status'), '', name);
    }
    assert.equal(await page.evaluate(() => document.getElementById('file').textContent), 'gallery.gltf');
    for (const [bad, says] of [['#open=car.gltf/x', /the page has no such file/], ['#open=gallery.gltf/x', /gallery.gltf has none of this name/]]) {
      await page.evaluate((to) => (location.hash = to), bad);
      await page.waitForFunction((source) => new RegExp(source).test(document.getElementById('status').textContent), says.source);
    }
  }, { size: kSmall }));
