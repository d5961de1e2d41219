// What the page shows of a file's scene, by what a person does with it.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { begin, drop, end, kSmall, open, painted, settled } from './page.mjs';

before(begin);
after(end);

/** Squares across z, of a side, each with a material: from the front to the back, or as they are given. */
function squares(list) {
  const corners = new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1]);
  const bytes = Buffer.concat([Buffer.from(corners.buffer), Buffer.from(new Uint16Array([0, 1, 2, 0, 2, 3]).buffer)]);
  return Buffer.from(JSON.stringify({
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: list.map((_, i) => i) }],
    nodes: list.map(({ at, size = 1 }, mesh) => ({ mesh, translation: at, scale: [size, size, size] })),
    meshes: list.map((_, material) => ({ primitives: [{ attributes: { POSITION: 0, NORMAL: 1 }, indices: 2, material }] })),
    materials: list.map(({ material }) => material),
    accessors: [
      { bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [-1, -1, 0], max: [1, 1, 0] },
      { bufferView: 1, componentType: 5126, count: 4, type: 'VEC3' }, { bufferView: 2, componentType: 5123, count: 6, type: 'SCALAR' },
    ],
    bufferViews: [{ buffer: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 48 }, { buffer: 0, byteOffset: 96, byteLength: 12 }],
    buffers: [{ byteLength: bytes.length, uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` }],
  }));
}
/** Of one emitted colour, and nothing else. */
const shining = (...color) => ({ emissiveFactor: color, pbrMetallicRoughness: { baseColorFactor: [0, 0, 0, 1], metallicFactor: 0 }, extensions: { KHR_materials_specular: { specularFactor: 0 } } });
const glass = (roughnessFactor) => ({ pbrMetallicRoughness: { roughnessFactor, metallicFactor: 0 }, extensions: { KHR_materials_transmission: { transmissionFactor: 1 } } });
/** Over what is behind, half. */
const veil = (...color) => ({ ...shining(...color), alphaMode: 'BLEND', pbrMetallicRoughness: { baseColorFactor: [0, 0, 0, 0.5], metallicFactor: 0 } });

/** Seen from ahead, unlit; colours at places from -1 to 1 of the picture. */
const seen = (page, places) => page.evaluate((places) => {
  const { viewport } = window.lacquerPage;
  viewport.orbit.yaw = viewport.orbit.pitch = 0;
  const pixels = viewport.pixels();
  const { width, height } = viewport.canvas;
  return places.map(([x, y]) => [...pixels.subarray(4 * (Math.floor((0.5 - 0.5 * y) * height) * width + Math.floor((0.5 + 0.5 * x) * width))).subarray(0, 3)]);
}, places);
async function show(page, list) {
  await drop(page, [['scene.gltf', squares(list)]]);
  await page.selectOption('#environment', 'Dark');
  await page.selectOption('#lamps', 'none');
  await settled(page);
}

test('behind glass is the scene, blurred where the glass is rough, whatever the order in the file', () =>
  open([], async (page) => {
    const red = { at: [-1, 0, -1], material: shining(1, 0, 0) };
    const green = { at: [1, 0, -1], material: shining(0, 1, 0) };
    const pane = (roughness) => ({ at: [0, 0, 0], size: 0.9, material: glass(roughness) });
    await show(page, [pane(0), red, green]);
    const [left, right] = await seen(page, [[-0.05, 0], [0.05, 0]]);
    assert.ok(left[0] > 200 && left[1] < 30 && right[1] > 200 && right[0] < 30, `through clear glass: ${left}, ${right}`);
    await show(page, [pane(0.8), red, green]);
    const [through] = await seen(page, [[-0.02, 0]]);
    assert.ok(through[0] > 60 && through[1] > 60, `through rough glass: ${through}`);
    // The picture behind is as large as the canvas, and there is one of it.
    const made = await page.evaluate(() => {
      const { viewport } = window.lacquerPage;
      const { gl } = viewport;
      let made = 0;
      const own = gl.createTexture;
      gl.createTexture = function () { ++made; return own.call(this); };
      for (let i = 0; i < 3; ++i) viewport.draw();
      gl.createTexture = own;
      return made;
    });
    assert.equal(made, 0);
    await page.setViewportSize({ width: 700, height: 500 });
    await painted(page);
    const [again] = await seen(page, [[-0.02, 0]]);
    assert.ok(again[0] > 60 && again[1] > 60, `after a change of size: ${again}`);
  }, { size: kSmall }));

test('what is blended is drawn from the back, over glass and what is seen through it', () =>
  open([], async (page) => {
    await show(page, [
      { at: [0, 0, 0.2], material: veil(0, 0, 1) }, { at: [0, 0, 0.1], material: veil(0, 1, 0) },
      { at: [0, 0, 0], material: glass(0) }, { at: [0, 0, -0.1], material: shining(1, 0, 0) },
    ]);
    const [[red, green, blue]] = await seen(page, [[0, 0]]);
    assert.ok(blue > green && green > 40 && red > 40, `${[red, green, blue]}`);
  }, { size: kSmall }));

test('what is around is shown, blurred or not, behind a ball of glass, too', () =>
  open(['examples/glass.gltf'], async (page) => {
    const corner = async () => (await seen(page, [[-0.9, 0.6]]))[0];
    const through = async () => (await seen(page, [[0, 0]]))[0];
    await page.selectOption('#environment', 'Overcast');
    const [plain, board] = [await corner(), await through()];
    await page.selectOption('#background', 'environment');
    const [around, clear] = [await corner(), await through()];
    assert.notDeepEqual(around, plain);
    assert.notDeepEqual(clear, board);
    await page.selectOption('#background', 'blurred');
    await page.fill('#brightness', '0');
    assert.deepEqual(await corner(), [0, 0, 0]);
    await page.selectOption('#background', 'plain');
    assert.deepEqual(await corner(), plain);
  }, { size: kSmall }));
