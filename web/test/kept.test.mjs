// What a person has made is not lost: drafts, questions, messages, and what is offered.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { read } from './native.mjs';
import { begin, downloaded, drop, end, open, painted, set } from './page.mjs';

before(begin);
after(end);

const kRoughness = 'p:/materials/0/pbrMetallicRoughness/roughnessFactor';
const roughness = (page) => page.evaluate(() => window.lacquerPage.document.get('/materials/0/pbrMetallicRoughness/roughnessFactor'));
const kept = (page) => page.evaluate(async () => {
  const base = await new Promise((done) => Object.assign(indexedDB.open('lacquer', 1), { onsuccess: ({ target }) => done(target.result) }));
  const all = base.transaction('drafts').objectStore('drafts').getAll();
  await new Promise((done) => (all.onsuccess = done));
  base.close();
  return all.result.length;
});
async function untilKept(page, count) {
  const upToDate = () => page.evaluate(() => {
    const { document: of, files } = window.lacquerPage;
    return !of.isEdited || files.kept === of.state;
  });
  for (let i = 0; i < 100 && !((await upToDate()) && (await kept(page)) === count); ++i) await page.waitForTimeout(100);
  assert.equal(await kept(page), count);
}
async function reload(page) {
  await page.reload();
  await page.waitForSelector('body.ready');
}

test('a draft of what was edited is kept and offered after a reload; it goes when it is exported, discarded or taken back', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    assert.equal(await page.textContent('#file'), 'clearcoat.gltf');
    await page.focus(`[id="${kRoughness}"]`);
    await page.keyboard.press('End');
    assert.ok(await page.isVisible('#file.edited'));
    await untilKept(page, 1);
    await page.keyboard.press('Control+z');
    assert.ok(await page.isHidden('#file.edited'));
    await untilKept(page, 0);
    await set(page, kRoughness, 0.125);
    await page.evaluate(() => window.lacquerPage.editGraph((graph) => graph.addNode('mine', 'schlick')));
    await untilKept(page, 1);
    await reload(page);
    assert.equal(await roughness(page), 0.7);
    assert.match(await page.textContent('#drafts'), /A draft of clearcoat\.gltf from .* was kept/);
    // Another edit before the offer is answered takes nothing away from it.
    await set(page, kRoughness, 0.5);
    await untilKept(page, 2);
    await reload(page);
    assert.equal(await page.locator('#drafts > div').count(), 2);
    await page.click('#drafts > div >> nth=1 >> text=Open the draft');
    await page.waitForFunction(() => document.querySelectorAll('#drafts > div').length === 1);
    assert.equal(await roughness(page), 0.125);
    assert.ok(await page.evaluate(() => JSON.parse(window.lacquerPage.document.graphs.get(0)).nodes.some(({ id }) => id === 'mine')));
    assert.ok(await page.isVisible('#file.edited'));
    await page.click('#drafts >> text=Discard it');
    await untilKept(page, 1);
    await downloaded(page, '#export');
    await untilKept(page, 0);
    await reload(page);
    assert.ok(await page.isHidden('#drafts'));
  }));

test('the camera that is chosen is kept in the draft, until the hand takes over', () =>
  open([], async (page) => {
    const json = JSON.parse(read('examples/clearcoat.gltf'));
    const eye = (x) => json.nodes.push({ camera: 0, translation: [x, 0, 4] }) - 1;
    json.cameras = [{ type: 'perspective', perspective: { yfov: 0.8, znear: 0.1 } }];
    json.nodes ??= [];
    json.scenes ??= [{ nodes: json.nodes.map((_, i) => i) }];
    json.scenes[json.scene ?? 0].nodes.push(eye(0), eye(1));
    await drop(page, [['seen.gltf', Buffer.from(JSON.stringify(json))]]);
    await set(page, kRoughness, 0.125);
    await untilKept(page, 1);
    const keptCamera = (value) => page.waitForFunction((wanted) => window.lacquerPage.files.keptCamera === wanted, value);
    await page.selectOption('#camera', '1');
    await keptCamera('1');
    await reload(page);
    await page.click('#drafts >> text=Open the draft');
    await page.waitForFunction(() => document.querySelectorAll('#drafts > div').length === 0);
    assert.equal(await page.inputValue('#camera'), '1');
    assert.ok(await page.evaluate(() => window.lacquerPage.viewport.camera !== null));
    await page.selectOption('#camera', '');
    await keptCamera('');
  }));

test('a file that takes the place of edits asks; one that cannot be read does not, and its message goes with the next edit', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    await set(page, kRoughness, 0.125);
    await drop(page, [['cut.gltf', Buffer.from('{"asset"')]]);
    assert.match(await page.textContent('#status'), /JSON/);
    assert.equal(await page.locator('.ask').count(), 0);
    await set(page, kRoughness, 0.25);
    assert.equal(await page.textContent('#status'), '');
    for (const [answer, name, value] of [['', 'clearcoat.gltf', 0.25], ['replace', 'other.gltf', undefined]]) {
      const dropped = drop(page, [['other.gltf', Buffer.from('{"asset": {"version": "2.0"}, "materials": [{}]}')]]);
      await page.waitForSelector('.ask');
      assert.match(await page.textContent('.ask p'), /clearcoat\.gltf has edits that are in no file/);
      await page.click(`.ask button[value="${answer}"]`);
      await dropped;
      assert.equal(await page.textContent('#file'), name);
      assert.equal(await roughness(page), value);
    }
    await drop(page, [['third.gltf', read('examples/core.gltf')]]);
    assert.equal(await page.textContent('#file'), 'third.gltf');
    // The sample that is chosen again stays what it was where the answer is no.
    await set(page, kRoughness, 0.125);
    const before = await page.inputValue('#sample');
    await page.selectOption('#sample', '2');
    await page.keyboard.press('Escape');
    await page.waitForSelector('.ask', { state: 'detached' });
    assert.equal(await page.inputValue('#sample'), before);
    assert.equal(await page.textContent('#file'), 'third.gltf');
    await page.click('#undo');
  }));

test('extensions are offered that can stand with what is there, the others with what is against them', () =>
  open([], async (page) => {
    const material = (extensions) => Buffer.from(JSON.stringify({ asset: { version: '2.0' }, extensionsUsed: Object.keys(extensions), materials: [{ extensions }] }));
    const option = (name) => page.evaluate((name) => {
      const { disabled, textContent } = [...document.querySelectorAll('.adder option')].find(({ value }) => value === name);
      return [disabled, textContent];
    }, name);
    await drop(page, [['clear.gltf', material({ KHR_materials_clearcoat: { clearcoatFactor: 1 } })]]);
    assert.deepEqual(await option('KHR_materials_sheen'), [false, 'KHR_materials_sheen']);
    assert.deepEqual(await option('KHR_materials_coat'), [false, 'KHR_materials_coat, in place of KHR_materials_clearcoat']);
    assert.deepEqual(await option('KHR_materials_scatter'), [true, 'KHR_materials_scatter: it needs KHR_materials_transmission']);
    assert.deepEqual(await option('EXT_materials_specular_edge_color'), [true, 'EXT_materials_specular_edge_color: it stands in KHR_materials_specular']);
    assert.deepEqual(await option('KHR_materials_unlit'), [true, 'KHR_materials_unlit: not with KHR_materials_clearcoat']);
    await page.selectOption('.adder select', 'KHR_materials_sheen');
    assert.ok(await page.isVisible('[data-extension=KHR_materials_sheen]'));
  }));

test('on a phone the picture is on top and stays there', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    const tops = () => page.evaluate(() => ['middle', 'left', 'right'].map((id) => document.getElementById(id).getBoundingClientRect().top));
    const [picture, properties, panels] = await tops();
    assert.ok(picture < properties && properties < panels, `${[picture, properties, panels]}`);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= 400, `${wide} pixels wide`);
    await page.locator('#right').scrollIntoViewIfNeeded();
    await painted(page);
    const [after] = await tops();
    assert.ok(after >= 0 && after <= picture, `${after}`);
  }, { size: { width: 400, height: 820 } }));

test("the file's name stands once, as long as there is room whole, and the page's own files are opened again", () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    const shown = () => page.evaluate(() => {
      const selects = [...document.querySelectorAll('header select')].map(({ selectedOptions: [option] }) => option?.text);
      const file = document.getElementById('file');
      return { times: [file.textContent, ...selects].filter((text) => text === file.textContent).length, isWhole: file.scrollWidth <= file.clientWidth };
    });
    assert.deepEqual(await shown(), { times: 1, isWhole: true });
    const header = await page.textContent('header');
    assert.ok(header.indexOf('clearcoat.gltf') < header.indexOf('Other files'));
    // After a file of one's own none of the list is said to be open, and each can be opened.
    await drop(page, [['mine.gltf', read('examples/core.gltf')]]);
    assert.equal(await page.inputValue('#sample'), '');
    await page.selectOption('#sample', '0');
    await page.waitForFunction(() => document.getElementById('file').textContent === 'clearcoat.gltf');
    await set(page, kRoughness, 0.125);
    await page.selectOption('#sample', '0');
    await page.click('.ask button[value=replace]');
    await page.waitForFunction(() => !document.querySelector('#file.edited'));
    assert.equal(await roughness(page), 0.7);
  }));

test('an export says what it did, in the place of what was said before, and all that a document lacks is under Notes', () =>
  open(['examples/car_paint.gltf'], async (page) => {
    const status = () => page.textContent('#status');
    await page.click('#share');
    await page.waitForFunction(() => /the address of the page/.test(document.getElementById('status').textContent));
    await downloaded(page, '#export');
    assert.equal(await status(), 'car_paint.gltf is exported with all edits');
    await downloaded(page, '#export-mtlx');
    assert.match(await status(), /coatAnisotropyRotation.*\(and 1 more, under Notes\)$/s);
    assert.equal(await page.locator('#messages li').count(), 2);
    assert.equal(await page.locator('#messages li', { hasText: 'not-said' }).count(), 2);
  }));
