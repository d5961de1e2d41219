// `node --test tests/peers/gallery_test.mjs`: the gallery's materials, its figures and its page.
import assert from 'node:assert/strict';
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { kEnvironment, writeScene } from '../../bench/peers/ball.mjs';
import { effect, extensionsIn, readGallery, withoutExtensions } from '../../bench/peers/gallery.mjs';
import { galleryPage, galleryPages } from '../../bench/peers/gallery_page.mjs';
import { kGalleryPeers } from '../../bench/peers/works.mjs';

const kRoot = join(dirname(fileURLToPath(import.meta.url)), '../..');
const entries = readGallery(join(kRoot, 'bench/peers'));

test('the page says what the record says', () => {
  for (const [path, text] of Object.entries(galleryPages(kRoot)))
    assert.equal(readFileSync(path, 'utf8'), text, `${path}: \`node bench/peers/peers.mjs .\` renews it from bench/gallery.json`);
});

test('every extension of a material that the specification page lists is in the gallery', () => {
  const page = readFileSync(join(kRoot, 'docs/specification.md'), 'utf8');
  const listed = [...page.matchAll(/^## ((?:KHR|EXT|ADOBE|NV)_(?:materials|texture)_\w+)/gm)].map(([, name]) => name);
  const shown = new Set(entries.flatMap(({ work }) => extensionsIn(work)));
  assert.ok(listed.length > 25);
  assert.deepEqual(listed.filter((name) => !shown.has(name)), []);
});

test('every material has a name of its own, a line, and a difference by its extension', () => {
  assert.equal(new Set(entries.map(({ name }) => name)).size, entries.length);
  for (const { name, of, says, work, without } of entries) {
    assert.match(says ?? '', /\.$/, name);
    if (without) assert.deepEqual(of.filter((each) => extensionsIn(without).includes(each) || !extensionsIn(work).includes(each)), [], name);
  }
});

test('the record has each material of each peer, and docs/images the sheets', () => {
  const { versions, materials } = JSON.parse(readFileSync(join(kRoot, 'bench/gallery.json'), 'utf8'));
  assert.deepEqual(Object.keys(materials), entries.map(({ name }) => name));
  const peers = kGalleryPeers.filter(({ package: name }) => name in versions).map(({ name }) => name);
  for (const [name, { peers: theirs }] of Object.entries(materials)) assert.deepEqual(Object.keys(theirs), peers, name);
  const page = readFileSync(join(kRoot, 'docs/gallery.md'), 'utf8');
  const images = [...page.matchAll(/images\/(gallery-\d+\.webp)/g)].map(([, name]) => name);
  for (const name of images) assert.ok(existsSync(join(kRoot, 'docs/images', name)), name);
  const there = readdirSync(join(kRoot, 'docs/images')).filter((name) => name.startsWith('gallery-'));
  assert.deepEqual(there.sort(), images.sort());
});

test('an extension goes wherever it stands, and leaves nothing empty', () => {
  const material = { extensions: { A: { extensions: { B: { x: 1 } }, y: [{ extensions: { B: {} } }] }, C: {} } };
  assert.deepEqual(extensionsIn(material).sort(), ['A', 'B', 'C']);
  assert.deepEqual(withoutExtensions(material, ['B']), { extensions: { A: { y: [{}] }, C: {} } });
  assert.deepEqual(withoutExtensions(material, ['A', 'C']), {});
});

test('what lets light through has a wall behind it, and pictures lie beside the file', () => {
  const folder = mkdtempSync(join(tmpdir(), 'lacquer-peers-'));
  const scene = (name) => JSON.parse(readFileSync(writeScene(folder, entries.find((each) => each.name === name).work), 'utf8'));
  try {
    const clear = scene('Transmission');
    assert.deepEqual(clear.scenes[0].nodes, [0, 1, 2, 3]);
    assert.deepEqual(clear.materials[1].pbrMetallicRoughness.baseColorFactor.slice(0, 3), Array(3).fill(kEnvironment));
    assert.equal(clear.buffers[0].byteLength, statSync(join(folder, 'ball.bin')).size);
    const tiles = scene('Texture transform');
    assert.equal(tiles.meshes.length, 1);
    assert.deepEqual(tiles.extensionsUsed.sort(), ['KHR_lights_punctual', 'KHR_texture_transform', 'NV_texture_swizzle']);
    assert.equal(readFileSync(join(folder, 'image_0.png')).toString('latin1', 1, 4), 'PNG');
  } finally {
    rmSync(folder, { recursive: true });
  }
});

test('the effect of an extension is compared, not what pictures differ by without it', () => {
  const grey = (x) => () => [x, x, x];
  const pictures = { ours: grey(0.5), oursWithout: grey(0.25), theirs: grey(1), theirsWithout: grey(0.75) };
  assert.deepEqual(effect(10, pictures), { own: 0.25, apart: 0 });
  assert.equal(effect(10, { ...pictures, theirs: grey(0.75) }).apart, 1);
  assert.equal(effect(10, { ...pictures, oursWithout: grey(0.5) }).apart, null);
});

test('a peer that does not know an extension, and one that fails, are told apart', () => {
  const [one] = entries.filter(({ without }) => without);
  const of = (got) => Object.fromEntries(kGalleryPeers.map(({ name }) => [name, got]));
  const page = (got) => galleryPage({
    versions: Object.fromEntries(kGalleryPeers.map((peer) => [peer.package, '1'])), materials: { [one.name]: { ours: { mean: 0.4 }, peers: of(got) } },
  }, [one]);
  assert.match(page({ mean: 0.1, max: 0.2, effect_apart: 1, knows: false }), /\| no · 0.1 \/ 0.2 \|/);
  assert.match(page({ mean: 0.1, max: 0.2, effect_apart: 0.125, knows: true }), /\| 13 % · 0.1 \/ 0.2 \|/);
  assert.match(page({ mean: 0.1, max: 0.2, effect_apart: null, knows: true }), /\| 0.1 \/ 0.2 \|/);
  assert.match(page({ problem: 'no' }), /\| fails \|/);
});
