// Materials that ask for the time: on the page it runs, stands and is set, and the shader sees it.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { begin, end, folder, open, painted, settled } from './page.mjs';

before(begin);
after(end);

/** Black, but for an emission: red an eighth of the seconds, green a hundredth of the pictures. */
const animated = () => {
  const node = (name, nodetype, type, inputs = {}) => ({ name, nodetype, type, inputs });
  const constant = (value, type = 'float') => ({ type, value });
  const file = join(folder, 'animated.gltf');
  writeFileSync(file, JSON.stringify({
    asset: { version: '2.0' },
    extensionsUsed: ['KHR_texture_procedurals', 'EXT_texture_procedurals_mx_1_39'],
    textures: [{}],
    extensions: { KHR_texture_procedurals: { procedurals: [{
      name: 'g', nodetype: 'nodegraph', type: 'color3',
      nodes: [
        node('t', 'time', 'float'), node('f', 'frame', 'float'),
        node('c', 'combine3', 'color3', { in1: { type: 'float', node: 0 }, in2: { type: 'float', node: 1 } }),
        node('s', 'multiply', 'color3', { in1: { type: 'color3', node: 2 }, in2: constant([0.125, 0.01, 0], 'color3') }),
      ],
      outputs: { out: { type: 'color3', node: 3 } },
    }] } },
    materials: [{
      pbrMetallicRoughness: { baseColorFactor: [0, 0, 0, 1] }, emissiveFactor: [1, 1, 1],
      emissiveTexture: { index: 0, extensions: { KHR_texture_procedurals: { index: 0 } } },
    }, { name: 'still' }],
  }));
  return file;
};

const at = { n: [0, 0, 1], t: [1, 0, 0, 1], l: [0, 0, 1], light: [0, 0, 0], env: [0, 0, 0], uv: [0.5, 0.5] };

test('the time runs on the page, stands and is set', () => open([animated()], async (page) => {
  await settled(page);
  const seconds = () => page.evaluate(() => window.lacquerPage.viewport.seconds);
  await painted(page);
  assert.equal(await page.isVisible('#clock'), true);
  const began = await seconds();
  await page.waitForFunction((before) => window.lacquerPage.viewport.seconds > before, began);
  await page.click('#play');
  await painted(page);
  const stood = await seconds();
  await painted(page);
  await painted(page);
  assert.equal(await seconds(), stood);
  assert.equal(await page.textContent('#play'), 'Play');
  for (const wanted of [0, 2.5, 4]) {
    await page.fill('#seconds', String(wanted));
    await painted(page);
    assert.equal(await seconds(), wanted);
    const got = await page.evaluate((point) => {
      const it = window.lacquerPage;
      return it.viewport.probe(it.lookNow(), point);
    }, at);
    const expected = [0.125 * wanted, 0.01 * Math.floor(24 * wanted), 0, 1];
    expected.forEach((x, i) => assert.ok(Math.abs(got[i] - x) < 1e-5, `${got} is not ${expected}`));
  }
  await page.selectOption('#material', '1');
  await settled(page);
  await painted(page);
  assert.equal(await page.isVisible('#clock'), false);
}));
