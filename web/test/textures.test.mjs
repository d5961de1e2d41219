// Pictures in the slots of textures: dropped, chosen, placed, sampled, exported.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { deflateSync } from 'node:zlib';
import { read } from './native.mjs';
import { begin, downloaded, drop, end, middle, open, settled } from './page.mjs';

before(begin);
after(end);

/** A PNG of 2 by 2 texels. */
function png(...texels) {
  const table = Array.from({ length: 256 }, (_, n) => {
    for (let k = 0; k < 8; ++k) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
    return n;
  });
  const crc = (bytes) => ~bytes.reduce((sum, byte) => table[(sum ^ byte) & 255] ^ (sum >>> 8), -1);
  const chunk = (kind, data) => {
    const named = Buffer.concat([Buffer.from(kind), data]);
    const [size, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
    size.writeUInt32BE(data.length);
    sum.writeInt32BE(crc(named));
    return Buffer.concat([size, named, sum]);
  };
  const rows = [0, ...texels[0], ...texels[1], 0, ...texels[2], ...texels[3]];
  const head = Buffer.from([0, 0, 0, 2, 0, 0, 0, 2, 8, 2, 0, 0, 0]);
  return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk('IHDR', head), chunk('IDAT', deflateSync(Buffer.from(rows))), chunk('IEND', Buffer.alloc(0))]);
}
const plain = (...color) => png(color, color, color, color);

const kBase = '/materials/0/pbrMetallicRoughness/baseColorTexture';
const slot = (pointer) => `[data-slot="${pointer}"]`;

async function dropOn(page, selector, name, bytes, type = 'image/png') {
  const dataTransfer = await page.evaluateHandle(([name, base64, type]) => {
    const made = new DataTransfer();
    made.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name, { type }));
    return made;
  }, [name, bytes.toString('base64'), type]);
  await page.dispatchEvent(selector, 'drop', { dataTransfer });
}
const thumbnail = (page, pointer) => page.evaluate((at) => {
  const copy = new OffscreenCanvas(40, 40).getContext('2d');
  copy.drawImage(document.querySelector(`[data-slot="${at}"] canvas`), 0, 0);
  return [...copy.getImageData(20, 20, 1, 1).data];
}, pointer);

test('every texture has a slot; a picture that is dropped there is seen, placed, sampled, and in the exported file', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    const slots = await page.evaluate(() => [...document.querySelectorAll('[data-slot]')].map(({ dataset }) => dataset.slot.split('/').pop()));
    assert.deepEqual(slots, ['baseColorTexture', 'metallicRoughnessTexture', 'normalTexture', 'occlusionTexture', 'emissiveTexture', 'clearcoatTexture', 'clearcoatRoughnessTexture', 'clearcoatNormalTexture']);
    assert.match(await page.textContent(slot(kBase)), /sRGB, a colour, rgba/);
    assert.match(await page.textContent(slot('/materials/0/normalTexture')), /linear data, rgb/);
    const before = await page.textContent('#id');
    const shown = await middle(page);
    const picture = plain(0, 255, 0);
    await dropOn(page, slot(kBase), 'green leaf.png', picture);
    await page.waitForFunction((id) => document.getElementById('id').textContent !== id, before);
    await settled(page);
    const [red, green, blue] = await middle(page);
    assert.ok(red < shown[0] && green > red && green > blue, `${[red, green, blue]}`);
    await page.waitForFunction((at) => {
      const copy = new OffscreenCanvas(40, 40).getContext('2d');
      copy.drawImage(document.querySelector(`[data-slot="${at}"] canvas`), 0, 0);
      return copy.getImageData(20, 20, 1, 1).data[1] === 255;
    }, kBase);
    assert.deepEqual(await thumbnail(page, kBase), [0, 255, 0, 255]);
    await page.click(`${slot(kBase)} summary`);
    await page.fill('[aria-label="baseColorTexture offset u"]', '0.25');
    await page.keyboard.press('Tab');
    await page.fill('[aria-label="baseColorTexture rotation, degrees"]', '90');
    await page.keyboard.press('Tab');
    await page.selectOption('[aria-label="baseColorTexture texture set"]', '1');
    await page.selectOption('[aria-label="baseColorTexture across"]', { label: 'clamped' });
    assert.match(await page.evaluate(() => document.getElementById('messages').textContent), /uses TEXCOORD_1, which a primitive with this material does not have/);
    await settled(page);
    const id = await page.textContent('#id');
    const exported = JSON.parse(await downloaded(page, '#export'));
    const { index, texCoord, extensions } = exported.materials[0].pbrMetallicRoughness.baseColorTexture;
    assert.equal(texCoord, 1);
    assert.deepEqual(extensions.KHR_texture_transform, { offset: [0.25, 0], rotation: Math.PI / 2 });
    assert.ok(exported.extensionsUsed.includes('KHR_texture_transform'));
    const texture = exported.textures[index];
    assert.deepEqual(exported.samplers[texture.sampler], { wrapS: 33071 });
    const { name, mimeType, uri } = exported.images[texture.source];
    assert.deepEqual([name, mimeType], ['green leaf.png', 'image/png']);
    assert.deepEqual(Buffer.from(uri.split(',')[1], 'base64'), picture);
    await drop(page, [['again.gltf', Buffer.from(JSON.stringify(exported))]]);
    assert.equal(await page.textContent('#id'), id);
    await settled(page);
    const again = await middle(page);
    assert.ok(again[1] > again[0], `${again}`);
  }));

test('a picture is chosen by its file or from those of the file, refused where it is none, and gone from the file when it is taken back', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    const original = JSON.parse(read('examples/clearcoat.gltf'));
    const before = await page.textContent('#id');
    await dropOn(page, slot(kBase), 'text.png', Buffer.from('no picture'));
    await page.waitForFunction(() => document.getElementById('status').textContent !== '');
    assert.match(await page.textContent('#status'), /text\.png is no picture/);
    assert.equal(await page.textContent('#id'), before);
    await page.setInputFiles(`${slot(kBase)} input[type=file]`, { name: 'red.png', mimeType: 'image/png', buffer: plain(255, 0, 0) });
    await page.waitForFunction((id) => document.getElementById('id').textContent !== id, before);
    assert.equal(await page.textContent('#status'), '');
    // The same picture in another slot, from the list.
    const emissive = '/materials/0/emissiveTexture';
    await page.selectOption(`${slot(emissive)} select`, { label: 'red.png' });
    assert.equal(await page.evaluate((at) => window.lacquerPage.document.get(`${at}/index`), emissive), original.textures.length);
    await drop(page, [['lost.png', plain(0, 0, 255)]]);
    assert.match(await page.textContent('#status'), /lost\.png is a picture: drop it on the slot/);
    await page.selectOption(`${slot(emissive)} select`, '');
    while (await page.isEnabled('#undo')) await page.click('#undo');
    assert.equal(await page.textContent('#id'), before);
    const exported = JSON.parse(await downloaded(page, '#export'));
    assert.deepEqual(exported, original);
  }));

test('channels of one picture are filled from grey ones, each for itself', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    const pointer = '/materials/0/pbrMetallicRoughness/metallicRoughnessTexture';
    const pixel = () => page.evaluate(async (at) => {
      const { document: of } = window.lacquerPage;
      const { uri } = of.json.images[of.json.textures[of.get(`${at}/index`)].source];
      const bytes = Uint8Array.from(atob(uri.split(',')[1]), (c) => c.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
      const copy = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
      copy.drawImage(bitmap, 0, 0);
      return [...copy.getImageData(0, 0, 1, 1).data];
    }, pointer);
    const fill = async (channel, value, expected) => {
      const before = await page.evaluate((at) => window.lacquerPage.document.get(`${at}/index`) ?? -1, pointer);
      await page.setInputFiles(`[aria-label="metallicRoughnessTexture, ${channel} from a grey picture"]`, { name: 'grey.png', mimeType: 'image/png', buffer: plain(value, value, value) });
      await page.waitForFunction(([at, was]) => (window.lacquerPage.document.get(`${at}/index`) ?? -1) !== was, [pointer, before]);
      assert.deepEqual(await pixel(), expected);
    };
    await fill('green', 128, [255, 128, 255, 255]);
    await fill('blue', 51, [255, 128, 51, 255]);
    await page.click('#undo');
    assert.deepEqual(await pixel(), [255, 128, 255, 255]);
    assert.equal(await page.textContent('#status'), '');
    assert.equal(await page.locator(`${slot(kBase)} >> text=channels from`).count(), 0, 'a colour is no packed data');
  }));

test('a click on a thumbnail asks for a picture, unless the graph has taken the slot over', () =>
  open(['examples/clearcoat.gltf'], async (page) => {
    const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.click(`${slot(kBase)} canvas`)]);
    await chooser.setFiles({ name: 'leaf.png', mimeType: 'image/png', buffer: plain(0, 255, 0) });
    await page.waitForSelector(`${slot(kBase)}:not(.empty)`);
    await page.evaluate(() => window.lacquerPage.editGraph((graph) => graph.addNode('mine', 'schlick')));
    let asked = 0;
    page.on('filechooser', () => ++asked);
    await page.click(`${slot('/materials/0/emissiveTexture')} canvas`);
    await page.waitForTimeout(300);
    assert.equal(asked, 0);
  }));
