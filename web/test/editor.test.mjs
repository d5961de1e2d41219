// The graph editor in a real browser, by mouse and keyboard as a person uses it.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { begin, downloaded, drop, end, folder, kWide, library, middle, open, set } from './page.mjs';
import { lacquer, read } from './native.mjs';

before(begin);
after(end);

const port = (box, side, name) => `#graph [data-box="${box}"] [data-side=${side}][data-port="${name}"]`;
const graphNow = (page) => page.evaluate(() => JSON.parse(window.lacquerPage.document.graphs.get(window.lacquerPage.document.material) ?? 'null'));

/** The graph's tab, with all of it in the window. */
async function openGraph(page) {
  await page.click('[data-tab=graph]');
  await page.waitForSelector('#graph [data-box="outputs "]', { state: 'attached' });
}

async function middleOf(page, selector) {
  const { x, y, width, height } = await page.locator(selector).boundingBox();
  return [x + width / 2, y + height / 2];
}

/** With the mouse, in steps as a hand does. */
async function drag(page, from, to) {
  await page.mouse.move(...from);
  await page.mouse.down();
  await page.mouse.move((from[0] + to[0]) / 2, (from[1] + to[1]) / 2, { steps: 3 });
  await page.mouse.move(...to, { steps: 3 });
  await page.mouse.up();
}
const wire = async (page, from, to) => drag(page, await middleOf(page, from), await middleOf(page, to));

/** A free place of the canvas. */
const emptyPlace = (page) => page.evaluate(() => {
  const { left, top, width, height } = document.getElementById('graph').getBoundingClientRect();
  for (let y = top + height - 30; y > top; y -= 20)
    for (let x = left + 30; x < left + width; x += 20)
      if (document.elementFromPoint(x, y)?.id === 'graph') return [x, y];
  throw new Error('no place is free');
});

/** Adds what the search finds first. */
async function add(page, words) {
  await page.click('#add-node');
  await page.keyboard.type(words);
  await page.keyboard.press('Enter');
}
async function renameTo(page, name) {
  await page.fill('#editor [data-field=name]', name);
  await page.keyboard.press('Tab');
}

test("the README's glow node, made with the mouse: a search, wires, a swizzle that is offered, a new parameter", () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    const before = await page.textContent('#id');
    await openGraph(page);
    await add(page, 'occluded');
    await page.waitForSelector('#graph [data-box="node occluded"].selected');
    await renameTo(page, 'glow');
    await page.waitForSelector('#graph [data-box="node glow"]');
    assert.equal(await page.textContent('#id'), before, 'a node that nobody asks for changes no shader');
    assert.equal(await page.textContent('#status'), '', 'it has numbers until it has wires');
    await page.click('#tidy');
    // A vec4 goes into no vec3: the library says what would do, at the place.
    await wire(page, port('node base.color', 'out', ''), port('node glow', 'in', 'light'));
    assert.match(await page.textContent('#graph .bubble'), /'light' of the node 'glow' is a vec3, its source is a vec4/);
    assert.equal((await graphNow(page)).nodes.find(({ id }) => id === 'glow').inputs.light, 0.5, 'nothing was connected');
    await page.click('#graph .bubble button:text-is(".rgb")');
    await page.waitForSelector('#graph .bubble', { state: 'detached' });
    // From the input to a free place: a parameter of the input's range.
    await drag(page, await middleOf(page, port('node glow', 'in', 'visible')), await emptyPlace(page));
    await page.waitForSelector('.palette');
    await page.click('.palette [data-entry="parameter: float"]');
    await page.waitForSelector('#graph [data-box="parameter visible"].selected');
    await renameTo(page, 'glow_amount');
    await page.fill('#editor [data-field="value 0"]', '0.1');
    await page.keyboard.press('Tab');
    await wire(page, port('node glow', 'out', ''), port('outputs ', 'in', 'emission'));
    const graph = await graphNow(page);
    const { ui: _ui, ...glow } = graph.nodes.find(({ id }) => id === 'glow');
    assert.deepEqual(glow, { id: 'glow', node: 'occluded', inputs: { light: { node: 'base.color', swizzle: 'rgb' }, visible: { parameter: 'glow_amount' } } });
    assert.deepEqual(graph.outputs.emission, { node: 'glow' });
    const { value, range } = graph.parameters.glow_amount;
    assert.deepEqual({ value, range }, { value: 0.1, range: [0, 1] });
    // The same by the library without a page.
    const scene = library.scene(read('examples/clearcoat.gltf'), 'clearcoat.gltf');
    const native = scene.graph(0, { targets: ['essl'] });
    native.edit([
      { do: 'add_node', node: { id: 'glow', node: 'occluded', inputs: {} } },
      { do: 'connect', node: 'glow', input: 'light', source: { node: 'base.color', swizzle: 'rgb' } },
      { do: 'add_parameter', parameter: 'glow_amount', as: { type: 'float', value: 0.1, range: [0, 1] } },
      { do: 'connect', node: 'glow', input: 'visible', source: { parameter: 'glow_amount' } },
      { do: 'set_output', output: 'emission', source: { node: 'glow' } },
    ]);
    assert.equal(await page.textContent('#id'), native.generate({ targets: ['essl'] }).id);
    const file = join(folder, 'glow.json');
    writeFileSync(file, await downloaded(page, '#export-graph'));
    assert.match(lacquer('gen', file, '--target', 'essl', '-o', join(folder, 'glow'), '-q') + 'made', /made/);
    while (await page.isEnabled('#undo')) await page.click('#undo');
    assert.equal(await page.textContent('#id'), before);
    assert.equal(await graphNow(page), null);
  }, { size: kWide }));

const focusedPort = (page) => page.evaluate(() => {
  const { port, side } = document.activeElement.dataset;
  return [document.activeElement.closest('[data-box]')?.dataset.box, side, port];
});
const inputsOf = async (page, id) => (await graphNow(page)).nodes.find((node) => node.id === id).inputs;

test('the graph is edited from the keyboard: added, connected, disconnected, moved, copied, removed and all of it undone', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    await openGraph(page);
    await page.focus('#graph');
    await page.keyboard.press('a');
    await page.keyboard.type('schlick');
    await page.keyboard.press('Enter');
    await page.waitForSelector('dialog.palette', { state: 'detached' });
    assert.equal(await page.evaluate(() => document.activeElement.dataset.box), 'node schlick');
    await page.keyboard.press('Enter');
    await page.keyboard.press('ArrowDown');
    assert.deepEqual(await focusedPort(page), ['node schlick', 'in', 'cosine']);
    // Enter takes the wire up; another port and Enter put it down.
    await page.keyboard.press('Enter');
    await page.waitForSelector(`${port('node schlick', 'in', 'cosine')}.held`);
    await page.focus('#graph [data-box="node coat.view_cosine"]');
    await page.keyboard.press('Enter');
    await page.keyboard.press('ArrowRight');
    assert.deepEqual(await focusedPort(page), ['node coat.view_cosine', 'out', '']);
    await page.keyboard.press('Enter');
    assert.deepEqual((await inputsOf(page, 'schlick')).cosine, { node: 'coat.view_cosine' });
    // A circle is refused, and Escape leaves the message.
    await page.focus(port('node schlick', 'in', 'F0'));
    await page.keyboard.press('Enter');
    await page.focus(port('node schlick', 'out', ''));
    await page.keyboard.press('Enter');
    assert.match(await page.textContent('#graph .bubble'), /in a circle: schlick -> schlick/);
    await page.keyboard.press('Escape');
    assert.equal(await page.locator('#graph .bubble').count(), 0);
    await page.focus(port('node schlick', 'in', 'cosine'));
    await page.keyboard.press('Delete');
    assert.equal((await inputsOf(page, 'schlick')).cosine, undefined);
    assert.deepEqual(await focusedPort(page), ['node schlick', 'in', 'cosine'], 'the focus stays');
    await page.keyboard.press('Control+z');
    assert.deepEqual((await inputsOf(page, 'schlick')).cosine, { node: 'coat.view_cosine' });
    await page.waitForTimeout(300);
    await page.focus('#graph [data-box="node schlick"]');
    const placeOf = async (id) => (await graphNow(page)).nodes.find((node) => node.id === id).ui;
    const { x, y } = await placeOf('schlick');
    await page.keyboard.press('Alt+ArrowRight');
    assert.deepEqual(await placeOf('schlick'), { x: x + 16, y });
    await page.keyboard.press('Control+c');
    await page.keyboard.press('Control+v');
    await page.waitForSelector('#graph [data-box="node schlick_2"].selected');
    assert.deepEqual(await inputsOf(page, 'schlick_2'), await inputsOf(page, 'schlick'));
    await page.keyboard.press('Delete');
    await page.waitForSelector('#graph [data-box="node schlick_2"]', { state: 'detached' });
    await page.focus('#graph [data-box="node coat.fresnel"]');
    const shader = await page.textContent('#id');
    await page.keyboard.press('Delete');
    assert.equal((await graphNow(page)).nodes.some(({ id }) => id === 'coat.fresnel'), false);
    assert.match(await page.textContent('#status'), /lacks the input 'fresnel'/);
    assert.equal(await page.textContent('#id'), shader, 'the last good shader stays');
    await page.waitForSelector('#graph .node.wrong');
    while (await page.isEnabled('#undo')) await page.keyboard.press('Control+z');
    assert.equal(await graphNow(page), null);
    assert.equal(await page.textContent('#status'), '');
  }));

test('nodes are moved, aligned, commented, put into a group, looked at there and taken out again; values are drawn', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    await openGraph(page);
    const shader = await page.textContent('#id');
    const placeOf = (key) => page.evaluate((key) => {
      const { x, y } = window.lacquerPage.graph.editor.view.boxes.get(key);
      return [Math.round(x), Math.round(y)];
    }, key);
    const one = 'node coat.cosines';
    const two = 'node coat.distribution';
    const head = (key) => `#graph [data-box="${key}"] .head`;
    const [x, y] = await placeOf(one);
    const from = await middleOf(page, head(one));
    await drag(page, from, [from[0] - 20, from[1] + 12]);
    assert.ok((await placeOf(one))[0] < x && (await placeOf(one))[1] > y);
    assert.equal(await graphNow(page), null, 'a place is no edit of the material');
    await page.click('#undo');
    await page.waitForTimeout(300);
    assert.deepEqual(await placeOf(one), [x, y]);
    await page.click(head(one));
    await page.click(head(two), { modifiers: ['Shift'] });
    await page.click('#align-top');
    assert.equal((await placeOf(one))[1], (await placeOf(two))[1]);
    await page.click('#add-comment');
    await page.keyboard.type('the coat');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => JSON.parse(window.lacquerPage.document.graphs.get(0)).ui?.comments?.[0].text === 'the coat');
    await page.click(head(one));
    await page.click(head(two), { modifiers: ['Shift'] });
    await page.click('#make-group');
    await page.waitForSelector('#graph [data-box="group group"].selected');
    assert.equal(await page.textContent('#id'), shader, 'a group changes no shader');
    const group = (await graphNow(page)).groups.group;
    assert.deepEqual(group.nodes.map(({ id }) => id), ['coat.cosines', 'coat.distribution']);
    await page.dblclick(head('group group'));
    await page.waitForSelector(`#graph [data-box="${one}"]`);
    assert.equal(await page.textContent('#path'), 'Graphgroup');
    // A new result of the group.
    await wire(page, port(one, 'out', 'NdotL'), port('outputs ', 'in', '+'));
    assert.deepEqual((await graphNow(page)).groups.group.outputs.NdotL_2, { node: 'coat.cosines', output: 'NdotL' });
    // And a new input, at an input that had none of the group's: instances have its default.
    await drag(page, await middleOf(page, port(one, 'in', 'V')), await emptyPlace(page));
    await page.waitForSelector('.palette');
    await page.keyboard.type('group input');
    await page.keyboard.press('Enter');
    await page.waitForSelector('#graph [data-box="input V"]');
    assert.deepEqual((await graphNow(page)).groups.group.nodes[0].inputs.V, { input: 'V' });
    await page.click('#undo');
    await page.waitForSelector('#graph [data-box="input V"]', { state: 'detached' });
    // A value in a group is that of the instance.
    await page.waitForFunction((key) => {
      const copy = new OffscreenCanvas(56, 56).getContext('2d');
      copy.drawImage(document.querySelector(`[data-box="${key}"] canvas`), 0, 0);
      return new Set(new Uint32Array(copy.getImageData(0, 0, 56, 56).data.buffer)).size > 20;
    }, one);
    await page.click('#path button >> nth=0');
    await page.click(head('group group'));
    await page.click('#dissolve');
    await page.waitForSelector('#graph [data-box="group group"]', { state: 'detached' });
    assert.equal(await page.textContent('#id'), shader);
    // Each box that is seen has its value, a ball or a number; they are drawn when there is time.
    await page.waitForFunction(() => {
      const copy = new OffscreenCanvas(56, 56).getContext('2d');
      copy.drawImage(document.querySelector('[data-box="node normal.unit"] canvas'), 0, 0);
      return new Set(new Uint32Array(copy.getImageData(0, 0, 56, 56).data.buffer)).size > 20;
    });
  }));

test('where only a node between would do, it is offered and put there', () =>
  open(['examples/car_paint.gltf'], async (page) => {
    await openGraph(page);
    await wire(page, port('texture normal_texture', 'out', ''), port('node base.color', 'in', 'texel'));
    assert.match(await page.textContent('#graph .bubble'), /is a vec4, its source is a sampler2D/);
    await page.click('#graph .bubble .offers button >> nth=0');
    await page.waitForSelector('#graph [data-box="node gltf_image_vec4"]');
    assert.deepEqual(await inputsOf(page, 'gltf_image_vec4'), { file: { texture: 'normal_texture' } });
    assert.deepEqual((await inputsOf(page, 'base.color')).texel, { node: 'gltf_image_vec4' });
    assert.equal(await page.textContent('#status'), '');
  }, { size: kWide }));

test('the palette finds nodes by name, by prose and by category, says what they take, and at a port offers what fits it', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    await openGraph(page);
    await page.click('#add-node');
    const found = () => page.evaluate(() => [...document.querySelectorAll('.palette [role=option]')].map(({ dataset }) => dataset.entry));
    const all = await page.evaluate(() => window.lacquerPage.nodes.nodes.length);
    assert.ok(Number(await page.textContent('.palette .count')) >= all);
    await page.keyboard.type("lambert's surface");
    assert.ok((await found()).includes('lambert'));
    await page.fill('.palette input', '');
    await page.selectOption('.palette select', 'procedural2d');
    assert.ok((await found()).length > 20);
    await page.selectOption('.palette select', '');
    await page.fill('.palette input', 'f0_from_ior');
    assert.match(await page.textContent('.palette .details'), /ior float in \[1, 1000000000\].*→?result float in \[0, 1\]/s);
    await page.keyboard.press('Escape');
    await page.waitForSelector('.palette', { state: 'detached' });
    // A wire that ends nowhere: the nodes that take it.
    await drag(page, await middleOf(page, port('node normal.unit', 'out', '')), await emptyPlace(page));
    await page.waitForSelector('.palette');
    await page.keyboard.type('reflection');
    const offered = await found();
    assert.ok(offered.includes('reflection') && !offered.includes('f0_from_ior'), `${offered}`);
    await page.click('.palette [data-entry=reflection]');
    await page.waitForSelector('#graph [data-box="node reflection"]');
    assert.deepEqual(Object.values(await inputsOf(page, 'reflection')).filter((source) => source.node), [{ node: 'normal.unit' }]);
  }));

const kTwice = `/// Twice the light.
/// source: a test
node twice(vec3 light in [0, 1]) -> vec3 in [0, 2] {
    return light * 2;
}
`;
const told = (page) => page.evaluate(() => [...document.querySelectorAll('#node-messages li')].map((row) => row.textContent));

test('a node of one\'s own is written on the page: errors at line and column as it is written, then it is in the palette and in the file', () =>
  open(['examples/core.gltf'], async (page) => {
    await page.click('[data-tab=nodes]');
    await page.click('#node-text');
    await page.keyboard.insertText(kTwice.replace('light * 2', 'lite * 2'));
    await page.waitForSelector('#node-messages .error');
    const [first] = await told(page);
    assert.match(first, /^4:12 .*lite/);
    assert.equal(await page.evaluate(() => document.querySelector('#node-lines .wrong').textContent), '4');
    await page.click('#node-messages button');
    await page.keyboard.press('Shift+End');
    await page.keyboard.type('light * 2;');
    await page.waitForFunction(() => document.querySelector('#node-messages').children.length === 0);
    assert.equal(await page.textContent('#node-told'), 'The palette has twice.');
    await openGraph(page);
    await add(page, 'twice');
    await wire(page, port('node twice', 'out', ''), port('outputs ', 'in', 'emission'));
    assert.equal(await page.textContent('#status'), '');
    const id = await page.textContent('#id');
    // A text that is wrong takes nothing away.
    await page.click('[data-tab=nodes]');
    await page.click('#node-text');
    await page.keyboard.press('Control+End');
    await page.keyboard.type('node');
    await page.waitForSelector('#node-messages .error');
    assert.equal(await page.textContent('#id'), id);
    assert.match(await page.textContent('#node-told'), /as it was before/);
    // Ctrl+Z is the text's there, and takes back no edit of the material.
    const state = () => page.evaluate(() => window.lacquerPage.document.state);
    const [edits, text] = [await state(), await page.inputValue('#node-text')];
    await page.keyboard.press('Control+z');
    assert.notEqual(await page.inputValue('#node-text'), text);
    assert.equal(await state(), edits);
    await page.keyboard.press('Control+y');
    await page.keyboard.press('Control+End');
    for (let i = 0; i < 4; ++i) await page.keyboard.press('Backspace');
    await page.waitForFunction(() => document.querySelector('#node-messages').children.length === 0);
    const exported = await downloaded(page, '#export');
    await drop(page, [['again.gltf', exported]]);
    assert.equal(await page.textContent('#id'), id);
    assert.equal(await page.inputValue('#node-text'), kTwice);
    await drop(page, [['core.gltf', read('examples/core.gltf')]]);
    assert.equal(await page.inputValue('#node-text'), '');
    assert.ok(!(await page.evaluate(() => window.lacquerPage.nodes.nodes.some(({ name }) => name === 'twice'))));
  }));

test('after an edit of the graph properties that have a place in it act, the others say that it has taken over; the file keeps both', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    const row = (name) => `[data-pointer="/materials/0/${name}"]`;
    const coat = 'extensions/KHR_materials_clearcoat/clearcoatFactor';
    assert.equal(await page.locator('.taken').count(), 0);
    await openGraph(page);
    // The coat is no parameter any more: its weight is a number.
    await page.click('#graph [data-box="node coat.surface"] .head');
    await page.selectOption('#editor [data-field="source weight_factor"]', { label: 'a number' });
    await page.fill('#editor [data-field="weight_factor 0"]', '0.25');
    await page.keyboard.press('Tab');
    assert.ok(await page.isVisible('.taken'));
    assert.equal(await page.textContent(`${row(coat)} .gone`), '');
    const id = await page.textContent('#id');
    const shown = await middle(page);
    await page.click('#graph [data-box="parameter coat_factor"] .head');
    await page.keyboard.press('Delete');
    assert.equal(await page.textContent(`${row(coat)} .gone`), 'taken over by the graph');
    assert.ok(await page.isDisabled(`${row(coat)} input[type=range]`));
    assert.equal(await page.textContent('.row[title="/materials/0/alphaMode"] .gone'), 'blending alone');
    assert.ok(await page.isDisabled('.adder select'));
    assert.deepEqual(await middle(page), shown);
    // One that is in the graph acts as before.
    await set(page, 'p:/materials/0/pbrMetallicRoughness/metallicFactor', 1);
    assert.notDeepEqual(await middle(page), shown);
    assert.equal(await page.textContent('#id'), id);
    // A new parameter is a slider, too.
    await page.click('#add-node');
    await page.keyboard.type('parameter: float');
    await page.keyboard.press('Enter');
    await page.waitForSelector('[data-parameter=parameter]');
    await page.focus('[id="g:parameter"]');
    await page.keyboard.press('End');
    assert.equal((await graphNow(page)).parameters.parameter.value, 1);
    const exported = JSON.parse(await downloaded(page, '#export'));
    assert.match(await page.textContent('#status'), /the graph of Varnish is in the file's extras/);
    assert.equal(exported.materials[0].extras.lacquer.graph.parameters.parameter.value, 1);
    assert.equal(exported.materials[0].pbrMetallicRoughness.metallicFactor, 1);
    const graph = await graphNow(page);
    await drop(page, [['again.gltf', Buffer.from(JSON.stringify(exported))]]);
    assert.equal(await page.textContent('#id'), id);
    assert.deepEqual(await graphNow(page), graph);
    assert.ok(await page.isVisible('.taken'));
    exported.materials[0].extras.lacquer.graph.nodes[0].node = 'nobody';
    await drop(page, [['broken.gltf', Buffer.from(JSON.stringify(exported))]]);
    assert.match(await page.textContent('#status'), /no node 'nobody'/);
    assert.ok(await page.evaluate(() => window.lacquerPage.viewport.looks.has(0)), 'the properties are seen');
    assert.ok((await graphNow(page)).nodes.some(({ node }) => node === 'nobody'), 'the graph is not lost');
    exported.materials[0].extras.lacquer.graph = { lacquer_graph: 7 };
    await drop(page, [['unread.gltf', Buffer.from(JSON.stringify(exported))]]);
    assert.match(await page.textContent('#status'), /the graph in extras of material 0.*the properties are shown/s);
    assert.equal(await page.locator('.taken').count(), 0);
    assert.deepEqual(JSON.parse(await downloaded(page, '#export')).materials[0].extras.lacquer, { graph: { lacquer_graph: 7 } });
    await drop(page, [['again.gltf', Buffer.from(JSON.stringify({ ...exported, materials: [exported.materials[0], {}] }))]]);
    await page.selectOption('#material', '1');
    assert.equal(await page.locator('.taken').count(), 0);
  }));

test('values of nodes wait while a slider moves, and follow it when it rests', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    await openGraph(page);
    const done = () => page.waitForFunction(() => window.lacquerPage.graph.editor.thumbs.isDone);
    await done();
    const color = () => page.evaluate(() => {
      const copy = new OffscreenCanvas(56, 56).getContext('2d');
      copy.drawImage(document.querySelector('[data-box="node base.color"] canvas'), 0, 0);
      return [...copy.getImageData(28, 28, 1, 1).data];
    });
    const before = await color();
    const drawnMoving = await page.evaluate(async () => {
      const { thumbs } = window.lacquerPage.graph.editor;
      const begin = thumbs.drawn;
      const slider = document.getElementById('p:/materials/0/pbrMetallicRoughness/baseColorFactor/1');
      for (let i = 0; i <= 20; ++i) {
        slider.value = String(0.2 + i * 0.035);
        slider.dispatchEvent(new Event('input', { bubbles: true }));
        await new Promise((wait) => setTimeout(wait, 10));
      }
      return thumbs.drawn - begin;
    });
    assert.equal(drawnMoving, 0);
    await page.waitForTimeout(400);
    await done();
    const after = await color();
    assert.ok(after[1] > before[1] + 60, `${before} ${after}`);
  }));

test('Fit shows all of a large graph, from which one comes nearer again', () =>
  open(['examples/car_paint.gltf'], async (page) => {
    await openGraph(page);
    await page.click('#fit');
    const outside = () => page.evaluate(() => {
      const window = document.getElementById('graph').getBoundingClientRect();
      return [...document.querySelectorAll('#graph .node')].filter((node) => {
        const { left, top, right, bottom } = node.getBoundingClientRect();
        return left < window.left || right > window.right || top < window.top || bottom > window.bottom;
      }).map(({ dataset }) => dataset.box);
    });
    assert.deepEqual(await outside(), []);
    const zoom = () => page.evaluate(() => window.lacquerPage.graph.editor.canvas.zoom);
    const whole = await zoom();
    await page.click('#zoom-out');
    assert.equal(await zoom(), whole);
    await page.click('#zoom-in');
    assert.ok((await zoom()) > whole);
  }));

test("the palette's first is what has the name that was typed, of whatever types", () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    await openGraph(page);
    await page.click('#add-node');
    await page.keyboard.type('mix');
    assert.match(await page.textContent('.palette [aria-selected=true] b'), /^mix</);
  }));

test('what the graph has taken over is said where the graph has an error, too', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    await page.evaluate(() => window.lacquerPage.editGraph((graph) => graph.removeNode('base.specular')));
    await page.waitForSelector('#status.error');
    const normal = page.locator('[data-slot="/materials/0/normalTexture"]');
    assert.match(await normal.textContent(), /taken over by the graph/);
    assert.ok(await normal.locator('select').first().isDisabled());
    const roughness = page.locator('[data-pointer="/materials/0/pbrMetallicRoughness/roughnessFactor"]');
    assert.ok(await roughness.locator('input[type=range]').isEnabled());
  }));
