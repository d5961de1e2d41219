// MaterialX in the module and on the page: documents are opened, edited and written.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { begin, downloaded, drop, end, library, open, set } from './page.mjs';

before(begin);
after(end);

const kDocument = `<materialx version="1.39">
  <xi:include href="lib/ramp.mtlx"/>
  <gltf_pbr name="shader" type="surfaceshader">
    <input name="base_color" type="color3" nodegraph="NG" output="color"/>
    <input name="roughness" type="float" value="0.75"/>
    <input name="metallic" type="float" value="0"/>
  </gltf_pbr>
  <surfacematerial name="Ramp" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="shader"/>
  </surfacematerial>
</materialx>`;
const kIncluded = `<materialx version="1.39">
  <nodegraph name="NG">
    <ramplr name="across" type="color3">
      <input name="valuel" type="color3" value="0.125, 0.25, 0.5"/>
      <input name="valuer" type="color3" value="0.5, 0.25, 0.125"/>
    </ramplr>
    <output name="color" type="color3" nodename="across"/>
  </nodegraph>
</materialx>`;
const kOptions = { document_texts: { 'lib/ramp.mtlx': kIncluded } };

test('a scene is written as a document and as glTF, and both are read again', () => {
  const scene = library.scene(kDocument, 'ramp.mtlx', kOptions);
  assert.equal(scene.materialCount, 1);
  const text = scene.toMaterialX();
  assert.match(text, /<gltf_pbr/);
  assert.match(text, /value="0\.125, 0\.25, 0\.5"/);
  assert.equal(library.scene(text, 'again.mtlx').toMaterialX(), text);
  const gltf = JSON.parse(scene.toGltf({ size: 2 }));
  assert.ok(gltf.extensions.KHR_texture_procedurals);
  assert.match(gltf.images[0].uri, /^data:image\/png;base64,/);
  assert.throws(() => scene.toMaterialX({ surface: 'phong' }), (error) => error.messages[0].code === 'unknown-surface');
  assert.throws(() => scene.toGltf({ size: 0 }), (error) => error.messages[0].code === 'out-of-range');
  assert.throws(() => library.scene(kDocument, 'ramp.mtlx', { document_texts: { 'ramp.mtlx': kIncluded } }),
    (error) => error.messages[0].code === 'include-missing');
  const graph = scene.graph(0);
  graph.setParameter('NG_across_valuel', [0.0625, 0.125, 0.25]);
  const messages = [];
  assert.match(scene.toMaterialX({ edited: new Map([[0, graph]]) }, messages), /value="0\.0625, 0\.125, 0\.25"/);
  assert.deepEqual(messages.map(({ code }) => code), ['not-said']);
});

test('a document that is dropped with what it includes is edited, and exported as a document and as glTF', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    await drop(page, [['ramp.mtlx', Buffer.from(kIncluded)], ['paint.mtlx', Buffer.from(kDocument)]]);
    assert.equal(await page.textContent('#status'), '');
    assert.equal(await page.textContent('#file'), 'paint.gltf');
    await set(page, 'p:/materials/0/pbrMetallicRoughness/roughnessFactor', 0.25);
    let text = String(await downloaded(page, '#export-mtlx'));
    assert.match(text, /<input name="roughness" type="float" value="0\.25"\/>/);
    assert.match(text, /value="0\.125, 0\.25, 0\.5"/);
    // A number within the pattern, in the graph.
    await page.evaluate(() => window.lacquerPage.editGraph((graph) => {
      const { id } = graph.toJson().nodes.find((node) => /across$/.test(node.id));
      graph.connect(id, 'valuel', [0.0625, 0.125, 0.25]);
    }));
    text = String(await downloaded(page, '#export-mtlx'));
    assert.match(text, /value="0\.0625, 0\.125, 0\.25"/);
    assert.equal(library.scene(text, 'again.mtlx').materialName(0), 'Ramp');
    const gltf = JSON.parse(String(await downloaded(page, '#export')));
    assert.equal(gltf.materials[0].pbrMetallicRoughness.roughnessFactor, 0.25);
    assert.ok(gltf.extensions.KHR_texture_procedurals);
  }));

test('a document that is wrong says so, and nothing is opened', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    await drop(page, [['m.mtlx', Buffer.from('<materialx version="1.39"/>')]]);
    assert.match(await page.textContent('#status'), /the document has no material, no surface and no pattern's output/);
    await drop(page, [['m.mtlx', Buffer.from(kDocument)]]);
    assert.match(await page.textContent('#status'), /"lib\/ramp\.mtlx" cannot be read/);
    assert.equal(await page.textContent('#file'), 'clearcoat.gltf');
  }));
