// What the material stands in: lamps with handles and a turned environment, by mouse, finger and key, in both renderers.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { DataTexture, FloatType, RGBAFormat } from 'three';
import { EXRExporter, NO_COMPRESSION, ZIP_COMPRESSION, ZIPS_COMPRESSION } from 'three/examples/jsm/exporters/EXRExporter.js';
import { hasWebGpu, kWebGpu, launch } from './browser.mjs';
import { begin, downloaded, drop, end, open, painted } from './page.mjs';

before(begin);
after(end);

/** Of a window in which there is room for handles. */
const kRoom = { width: 960, height: 560 };
const stage = (page) => page.evaluate(() => window.lacquerPage.document.stage);
const centre = async (locator) => {
  const { x, y, width, height } = await locator.boundingBox();
  return { x: x + width / 2, y: y + height / 2 };
};
const lampAt = (page, i) => centre(page.locator('.lamp').nth(i));
/** The picture's mean colours left and right of its middle, by what draws it. */
const halves = (page) => page.evaluate(async () => {
  const { viewport } = window.lacquerPage;
  const { canvas } = viewport.gpu ?? viewport;
  const pixels = viewport.gpu ? await viewport.gpu.pixels(viewport, canvas.width, canvas.height) : viewport.pixels();
  const { width, height } = canvas;
  const sums = [0, 0, 0, 0, 0, 0];
  const half = Math.floor(width / 2);
  for (let i = 0; i < width * height; ++i) {
    const x = i % width;
    if (x < half || x >= width - half) for (let c = 0; c < 3; ++c) sums[c + (x < half ? 0 : 3)] += pixels[4 * i + c];
  }
  return { left: sums.slice(0, 3).map((x) => x / (width * height)), right: sums.slice(3).map((x) => x / (width * height)) };
});
const total = ([r, g, b]) => r + g + b;
async function drag(page, from, to) {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let i = 1; i <= 8; ++i) await page.mouse.move(from.x + ((to.x - from.x) * i) / 8, from.y + ((to.y - from.y) * i) / 8);
  await page.mouse.up();
  await painted(page);
}
/** Fingers that go from places to others. */
async function fingers(page, from, to) {
  const session = await page.context().newCDPSession(page);
  await session.send('Emulation.setTouchEmulationEnabled', { enabled: true, maxTouchPoints: 2 });
  const send = (type, at) => session.send('Input.dispatchTouchEvent', { type, touchPoints: at.map(({ x, y }, id) => ({ x, y, id })) });
  await send('touchStart', from);
  for (let i = 1; i <= 8; ++i) await send('touchMove', from.map(({ x, y }, k) => ({ x: x + ((to[k].x - x) * i) / 8, y: y + ((to[k].y - y) * i) / 8 })));
  await send('touchEnd', []);
  await session.send('Emulation.setTouchEmulationEnabled', { enabled: false });
  await session.detach();
  await painted(page);
}
async function only(page, lamp) {
  await page.selectOption('#environment', 'Dark');
  await page.selectOption('#lamps', 'placed');
  await page.uncheck(`[aria-label="Lamp ${3 - lamp} is on"]`);
  await painted(page);
}
async function withWebGpu(t, files, use) {
  const by = await launch(...kWebGpu);
  try {
    await open(files, async (page) => {
      if (!(await hasWebGpu(page))) return t.skip('this browser has no WebGPU');
      await page.selectOption('#painter', 'webgpu');
      await page.waitForSelector('#viewport-gpu:not([hidden])');
      await use(page);
    }, { by, size: kRoom });
  } finally {
    await by.close();
  }
}

test('a lamp goes where its handle is dragged, over the edge to the back, by mouse and finger, and a step back takes it there again', () =>
  open(['examples/core.gltf'], async (page) => {
    await only(page, 1);
    const middle = await centre(page.locator('#picture'));
    const [first] = (await stage(page)).lamps;
    const lit = await halves(page);
    assert.ok(total(lit.left) > total(lit.right), JSON.stringify(lit));
    await drag(page, await lampAt(page, 0), { x: middle.x + 40, y: middle.y - 15 });
    const at = await lampAt(page, 0);
    assert.ok(Math.hypot(at.x - middle.x - 40, at.y - middle.y + 15) < 3, `${at.x - middle.x}, ${at.y - middle.y}`);
    const dragged = await halves(page);
    assert.ok(total(dragged.right) > total(dragged.left), JSON.stringify(dragged));
    // One drag is one step.
    await page.keyboard.press('Control+z');
    assert.deepEqual((await stage(page)).lamps[0], first);
    assert.deepEqual(await halves(page), lit);
    await page.click('#redo');
    assert.deepEqual(await halves(page), dragged);
    // Over the edge and back it is behind, where it lights what is not seen.
    await page.mouse.move(at.x, at.y);
    await page.mouse.down();
    for (const x of [middle.x + 200, middle.x + 300, middle.x + 40]) await page.mouse.move(x, middle.y);
    await page.mouse.up();
    await page.waitForSelector('.lamp.behind');
    const behind = await halves(page);
    assert.ok(total(behind.left) + total(behind.right) < total(dragged.left) + total(dragged.right), JSON.stringify(behind));
    const from = await lampAt(page, 0);
    await fingers(page, [from], [{ x: middle.x - 30, y: middle.y }]);
    const touched = await lampAt(page, 0);
    assert.ok(Math.hypot(touched.x - middle.x + 30, touched.y - middle.y) < 3, `${touched.x - middle.x}, ${touched.y - middle.y}`);
  }, { size: kRoom }));

test('keys move a lamp and change it; its colour, its strength and whether it is on are seen', () =>
  open(['examples/core.gltf'], async (page) => {
    await only(page, 1);
    const [before] = (await stage(page)).lamps;
    await page.focus('.lamp >> nth=0');
    for (const key of ['ArrowRight', 'ArrowRight', 'ArrowUp', '+']) await page.keyboard.press(key);
    const [after] = (await stage(page)).lamps;
    assert.ok(after.yaw > before.yaw && after.pitch > before.pitch && after.strength > before.strength, JSON.stringify(after));
    const white = await halves(page);
    await page.fill('[aria-label="Colour of lamp 1"]', '#ff0000');
    const red = await halves(page);
    assert.ok(red.left[0] - red.left[1] > white.left[0] - white.left[1] + 1, `${white.left} ${red.left}`);
    await page.focus('[aria-label="Strength of lamp 1"]');
    await page.keyboard.press('End');
    assert.ok((await halves(page)).left[0] > red.left[0] + 1);
    await page.focus('.lamp >> nth=0');
    await page.keyboard.press('Space');
    assert.equal((await stage(page)).lamps[0].on, false);
    const dark = await halves(page);
    assert.ok(total(dark.left) < total(red.left));
    await page.keyboard.press('Control+z');
    assert.equal((await stage(page)).lamps[0].on, true);
    await page.selectOption('#lamps', 'none');
    assert.ok(await page.isHidden('.lamp >> nth=0'));
    await page.click('#undo');
    assert.equal(await page.inputValue('#lamps'), 'placed');
    assert.ok(await page.isVisible('.lamp >> nth=0'));
  }, { size: kRoom }));

test('the lamps light what WebGPU draws, as in WebGL 2', (t) => withWebGpu(t, ['examples/core.gltf'], async (page) => {
  await only(page, 1);
  const middle = await centre(page.locator('#picture'));
  await drag(page, await lampAt(page, 0), { x: middle.x + 40, y: middle.y });
  await page.fill('[aria-label="Colour of lamp 1"]', '#ff0000');
  await page.focus('[aria-label="Strength of lamp 1"]');
  await page.keyboard.press('End');
  const there = await halves(page);
  assert.ok(there.right[0] > there.left[0] + 1 && there.right[0] > there.right[2] + 1, JSON.stringify(there));
  await page.selectOption('#painter', 'webgl');
  await page.waitForSelector('#viewport:not([hidden])');
  const here = await halves(page);
  for (const side of ['left', 'right']) here[side].forEach((x, i) => assert.ok(Math.abs(x - there[side][i]) < 0.5, `${JSON.stringify([here, there])}`));
}));

test('the lamps are in the draft and in the exported file', () =>
  open(['examples/core.gltf'], async (page) => {
    await page.selectOption('#lamps', 'placed');
    await page.focus('.lamp >> nth=1');
    await page.keyboard.press('ArrowLeft');
    const kept = await stage(page);
    await page.waitForFunction(() => window.lacquerPage.files.kept === window.lacquerPage.document.state);
    await page.reload();
    await page.waitForSelector('body.ready');
    assert.equal(await page.inputValue('#lamps'), 'studio');
    await page.click('#drafts >> text=Open the draft');
    await page.waitForSelector('.lamp >> nth=1');
    assert.deepEqual(await stage(page), kept);
    const exported = JSON.parse(await downloaded(page, '#export'));
    assert.deepEqual(exported.extras.lacquer.stage, kept);
    // What a file of somebody else's says there is taken as far as it can be.
    exported.extras.lacquer.stage = { placed: true, lamps: [{ yaw: 1e300, color: 'red;', strength: 'much' }], turn: null };
    await drop(page, [['odd.gltf', Buffer.from(JSON.stringify(exported))]]);
    const { lamps: [lamp], turn } = await stage(page);
    assert.deepEqual([lamp.yaw, lamp.color, lamp.strength, turn], [Math.PI, '#fffcf7', 1, 0]);
  }, { size: kRoom }));

test('what is around turns by a slider, a drag with Shift and keys, with its background, as WebGL 2 and WebGPU draw it; a step back turns it back', (t) =>
  withWebGpu(t, ['examples/core.gltf'], async (page) => {
    await page.selectOption('#lamps', 'none');
    await page.selectOption('#background', 'environment');
    const before = await halves(page);
    await page.focus('#turn');
    for (let i = 0; i < 3; ++i) await page.keyboard.press('PageUp');
    const { turn } = await stage(page);
    assert.ok(turn > 0.3, `${turn}`);
    await page.keyboard.press('End');
    assert.ok((await stage(page)).turn > 3.1);
    const there = await halves(page);
    assert.ok(Math.abs(total(there.left) - total(before.left)) > 5, JSON.stringify([before, there]));
    await page.selectOption('#painter', 'webgl');
    await page.waitForSelector('#viewport:not([hidden])');
    const here = await halves(page);
    for (const side of ['left', 'right']) here[side].forEach((x, i) => assert.ok(Math.abs(x - there[side][i]) < 0.5, `${JSON.stringify([here, there])}`));
    // The material's light is the turned one, too, and no more programs nor textures are made for another angle.
    await page.selectOption('#background', 'plain');
    const lit = await halves(page);
    const orbit = await page.evaluate(() => ({ ...window.lacquerPage.viewport.orbit }));
    const middle = await centre(page.locator('#picture'));
    await page.evaluate(() => {
      const { viewport } = window.lacquerPage;
      window.before = viewport.programCount;
      window.made = 0;
      const own = viewport.gl.createTexture;
      viewport.gl.createTexture = function () { ++window.made; return own.call(this); };
    });
    await page.keyboard.down('Shift');
    await drag(page, middle, { x: middle.x - 200, y: middle.y + 30 });
    await page.keyboard.up('Shift');
    assert.ok(Math.abs((await stage(page)).turn - (Math.PI - 200 / 150)) < 0.02, JSON.stringify(await stage(page)));
    assert.deepEqual(await page.evaluate(() => ({ ...window.lacquerPage.viewport.orbit })), orbit);
    const dragged = await halves(page);
    assert.ok(Math.abs(total(dragged.left) - total(lit.left)) > 0.5, JSON.stringify([lit, dragged]));
    assert.deepEqual(await page.evaluate(() => [window.made, window.lacquerPage.viewport.programCount - window.before]), [0, 0]);
    await page.keyboard.press('Control+z');
    assert.deepEqual(await halves(page), lit);
    await page.focus('#viewport');
    await page.keyboard.press('Shift+ArrowLeft');
    const kept = await stage(page);
    assert.ok(kept.turn < 3.1);
    await page.waitForFunction(() => window.lacquerPage.files.kept === window.lacquerPage.document.state);
    await page.reload();
    await page.click('#drafts >> text=Open the draft');
    await page.waitForFunction(() => document.getElementById('turn').valueAsNumber > 100);
    assert.deepEqual(await stage(page), kept);
  }));

/** A .exr file of a colour above and one below, as three.js writes it. */
async function exr(above, below, compression, type = FloatType) {
  const [width, height] = [64, 32];
  const data = new Float32Array(4 * width * height);
  // A texture's rows run from below.
  for (let i = 0; i < width * height; ++i) data.set([...(i < (width * height) / 2 ? below : above), 1], 4 * i);
  return Buffer.from(await new EXRExporter().parse(Object.assign(new DataTexture(data, width, height, RGBAFormat, FloatType), { needsUpdate: true }), { type, compression }));
}

test('environments in OpenEXR light as they say, compressed or not; a broken one is refused by name, and what is seen stays', () =>
  open(['examples/core.gltf'], async (page) => {
    await page.selectOption('#lamps', 'none');
    const seen = (name) => page.evaluate((name) => {
      const it = window.lacquerPage;
      const point = { n: [0, 0, 1], t: [1, 0, 0, 1], l: [0, 0, 1], light: [0, 0, 0], uv: [0.3, 0.6] };
      return [it.viewport.probe(it.lookNow(), point, name), it.viewport.probe(it.lookNow(), { ...point, env: [2, 1, 0.5] })];
    }, name);
    for (const [name, compression] of [['plain.exr', NO_COMPRESSION], ['zip.EXR', ZIP_COMPRESSION], ['zips.exr', ZIPS_COMPRESSION]]) {
      await drop(page, [[name, await exr([2, 1, 0.5], [2, 1, 0.5], compression)]]);
      assert.equal(await page.inputValue('#environment'), name);
      const [own, constant] = await seen(name);
      own.forEach((x, i) => assert.ok(Math.abs(x - constant[i]) < 0.01, `${name}: ${own} is not ${constant}`));
    }
    const upright = await exr([4, 4, 4], [0, 0, 0], ZIP_COMPRESSION);
    await drop(page, [['upright.exr', upright]]);
    await page.selectOption('#background', 'environment');
    const rows = () => page.evaluate(() => {
      const { viewport } = window.lacquerPage;
      viewport.orbit.pitch = 0;
      const pixels = viewport.pixels();
      return [pixels[0], pixels[pixels.length - 4]];
    });
    assert.deepEqual((await rows()).map((x) => x > 128), [true, false]);
    const before = await rows();
    const raw = await exr([4, 4, 4], [0, 0, 0], NO_COMPRESSION);
    const with64 = (bytes, at, value) => { const made = Buffer.from(bytes); made.writeBigUInt64LE(value, at); return made; };
    const sized = (bytes) => { const made = Buffer.from(bytes); made.writeInt32LE(0x7ffffff0, made.indexOf('dataWindow\0') + 'dataWindow\0box2i\0'.length + 4 + 8); return made; };
    // Of 32 rows, each in a chunk of its own, the first behind the table.
    const table = [...raw.keys()].find((at) => raw.readBigUInt64LE(at) === BigInt(at + 8 * 32));
    for (const [name, bytes, says] of [
      ['cut.exr', upright.subarray(0, -40), /cut\.exr: the picture ends too early/], ['raw.exr', raw.subarray(0, -40), /ends too early/],
      ['head.exr', raw.subarray(0, 100), /ends too early/], ['text.exr', Buffer.from('a text, and no picture'), /text\.exr: this is no OpenEXR picture/],
      ['empty.exr', Buffer.alloc(0), /no OpenEXR/], ['huge.exr', sized(raw), /of 2147483633 by 32 is not read/],
      ['odd.exr', with64(raw, table, 1n), /odd\.exr: the picture says wrongly/],
      ['garbled.exr', Buffer.from(upright).fill(0x55, upright.length - 60), /garbled\.exr: the picture cannot be decoded/],
    ]) {
      await drop(page, [[name, bytes]]);
      assert.match(await page.textContent('#status'), says);
      assert.equal(await page.inputValue('#environment'), 'upright.exr');
      assert.deepEqual(await rows(), before);
    }
  }, { size: kRoom }));
