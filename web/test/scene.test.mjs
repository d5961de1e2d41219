// What the page shows of a file's scene, by what a person does with it.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { begin, downloaded, drop, end, kSmall, open, painted, settled } from './page.mjs';

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

const view = (page) => page.evaluate(() => {
  const { orbit, middle, radius } = window.lacquerPage.viewport;
  return { ...orbit, middle: [...middle], radius };
});

test('a click chooses the material that is seen there, a drag turns, with the right button or Ctrl it moves, and F shows all again', () =>
  open([], async (page) => {
    await show(page, [{ at: [-1.2, 0, 0], material: shining(1, 0, 0) }, { at: [1.2, 0, 0], material: shining(0, 1, 0) }, { at: [1.2, 0, -1], material: shining(0, 0, 1) }]);
    await page.evaluate(() => Object.assign(window.lacquerPage.viewport.orbit, { yaw: 0, pitch: 0 }));
    const { x, y, width, height } = await page.locator('#viewport').boundingBox();
    const [left, right] = [{ x: x + width / 2 - height / 6, y: y + height / 2 }, { x: x + width / 2 + height / 6, y: y + height / 2 }];
    await page.mouse.click(right.x, right.y);
    assert.equal(await page.inputValue('#material'), '1');
    await page.mouse.click(left.x, left.y);
    assert.equal(await page.inputValue('#material'), '0');
    await page.mouse.click(x + 3, y + 3);
    assert.equal(await page.inputValue('#material'), '0');
    const first = await view(page);
    const drag = async (by, button = 'left') => {
      await page.mouse.move(right.x, right.y);
      await page.mouse.down({ button });
      await page.mouse.move(right.x + by[0] / 2, right.y + by[1] / 2);
      await page.mouse.move(right.x + by[0], right.y + by[1]);
      await page.mouse.up({ button });
    };
    await drag([30, 0]);
    assert.equal(await page.inputValue('#material'), '0'); // a drag is no click
    const turned = await view(page);
    assert.ok(Math.abs(turned.yaw + 0.2) < 1e-6 && turned.middle.join() === first.middle.join(), JSON.stringify(turned));
    await page.evaluate(() => Object.assign(window.lacquerPage.viewport.orbit, { yaw: 0 }));
    await drag([height / 4, height / 4], 'right');
    const moved = await view(page);
    // What is under the pointer stays under it.
    const by = 0.5 * moved.distance * moved.radius * Math.tan(0.36);
    assert.ok(Math.abs(moved.middle[0] + by) < 0.02 * by && Math.abs(moved.middle[1] - by) < 0.02 * by && moved.yaw === 0, JSON.stringify([moved, by]));
    await page.keyboard.down('Control');
    await drag([-20, 0]);
    await page.keyboard.up('Control');
    assert.ok((await view(page)).middle[0] > moved.middle[0]);
    await page.mouse.wheel(0, 400);
    await page.focus('#viewport');
    await page.keyboard.press('Control+ArrowUp');
    assert.ok((await view(page)).middle[1] > moved.middle[1]);
    await page.keyboard.press('f');
    assert.deepEqual(await view(page), first);
  }, { size: kSmall }));

test('two fingers come nearer and move the picture; one turns it', () =>
  open(['examples/core.gltf'], async (page) => {
    const { x, y, width, height } = await page.locator('#viewport').boundingBox();
    const [cx, cy] = [x + width / 2, y + height / 2];
    const session = await page.context().newCDPSession(page);
    await session.send('Emulation.setTouchEmulationEnabled', { enabled: true, maxTouchPoints: 2 });
    const send = (type, list) => session.send('Input.dispatchTouchEvent', { type, touchPoints: list.map(([x, y], id) => ({ x, y, id })) });
    const first = await view(page);
    await send('touchStart', [[cx - 10, cy], [cx + 10, cy]]);
    for (const apart of [14, 17, 20]) await send('touchMove', [[cx - apart, cy], [cx + apart, cy]]);
    await painted(page); // moves of fingers come with the pictures
    const near = await view(page);
    assert.ok(Math.abs(near.distance - first.distance / 2) < 0.1 && near.yaw === first.yaw, JSON.stringify(near));
    await send('touchMove', [[cx, cy], [cx + 40, cy]]);
    await painted(page);
    await send('touchEnd', []);
    const moved = await view(page);
    assert.ok(moved.middle[0] < -0.1 && Math.abs(moved.distance - near.distance) < 0.1, JSON.stringify(moved));
    await send('touchStart', [[cx, cy]]);
    await send('touchMove', [[cx + 30, cy]]);
    await send('touchEnd', []);
    assert.ok((await view(page)).yaw < moved.yaw);
  }, { size: kSmall }));

test('the picture is saved as PNG', () =>
  open(['examples/core.gltf'], async (page) => {
    const png = await downloaded(page, '#save-picture');
    const { width, height, middle } = await page.evaluate(() => {
      const { canvas } = window.lacquerPage.viewport;
      const pixels = window.lacquerPage.viewport.pixels();
      const at = 4 * (Math.floor(canvas.height / 2) * canvas.width + Math.floor(canvas.width / 2));
      return { width: canvas.width, height: canvas.height, middle: [...pixels.subarray(at, at + 3)] };
    });
    const there = await page.evaluate(async (base64) => {
      const bitmap = await createImageBitmap(new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))]));
      const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
      context.drawImage(bitmap, 0, 0);
      return { width: bitmap.width, height: bitmap.height, middle: [...context.getImageData(Math.floor(bitmap.width / 2), Math.floor(bitmap.height / 2), 1, 1).data].slice(0, 3) };
    }, png.toString('base64'));
    assert.deepEqual(there, { width, height, middle });
  }, { size: kSmall }));

test('instances stand in their places, and a variant is drawn with its materials', () =>
  open([], async (page) => {
    const file = JSON.parse(squares([{ at: [0, 0, 0], material: shining(1, 0, 0) }, { at: [0, 0, -9], material: shining(0, 1, 0) }]));
    const places = Buffer.from(new Float32Array([-1.2, 0, 0, 1.2, 0, 0]).buffer);
    file.buffers.push({ byteLength: places.length, uri: `data:application/octet-stream;base64,${places.toString('base64')}` });
    file.bufferViews.push({ buffer: 1, byteLength: places.length });
    file.accessors.push({ bufferView: 3, componentType: 5126, count: 2, type: 'VEC3' });
    file.scenes[0].nodes = [0];
    file.nodes[0].extensions = { EXT_mesh_gpu_instancing: { attributes: { TRANSLATION: 3 } } };
    file.extensions = { KHR_materials_variants: { variants: [{ name: 'red' }, { name: 'green' }] } };
    file.meshes[0].primitives[0].extensions = { KHR_materials_variants: { mappings: [{ material: 1, variants: [1] }, { material: 0, variants: [0] }] } };
    file.extensionsUsed = ['EXT_mesh_gpu_instancing', 'KHR_materials_variants'];
    await drop(page, [['many.gltf', Buffer.from(JSON.stringify(file))]]);
    await page.selectOption('#environment', 'Dark');
    await page.selectOption('#lamps', 'none');
    await settled(page);
    const { width, height } = await page.locator('#viewport').boundingBox();
    const x = (0.38 * height) / width;
    const [left, middle, right] = await seen(page, [[-x, 0], [0, 0], [x, 0]]);
    assert.ok(left[0] > 200 && right[0] > 200 && Math.abs(middle[0] - middle[1]) < 5, `${[left, middle, right]}`);
    await page.selectOption('#variant', { label: 'green' });
    await settled(page);
    const [there] = await seen(page, [[x, 0]]);
    assert.ok(there[1] > 200 && there[0] < 100, `${there}`);
    await page.selectOption('#variant', { index: 0 });
    await settled(page);
    assert.deepEqual((await seen(page, [[x, 0]]))[0], right);
    await drop(page, [['core.gltf', squares([{ at: [0, 0, 0], material: {} }])]]);
    assert.ok(await page.isHidden('#variant'));
  }, { size: kSmall }));

test('files that are dropped together belong together; what is missing is listed', () =>
  open([], async (page) => {
    const file = JSON.parse(squares([{ at: [0, 0, 0], material: shining(1, 0, 0) }]));
    const bytes = Buffer.from(file.buffers[0].uri.split(',')[1], 'base64');
    file.buffers[0].uri = 'all%20of.bin';
    file.images = [{ uri: 'pictures/a.png' }];
    const text = Buffer.from(JSON.stringify(file));
    await drop(page, [['apart.gltf', text]]);
    assert.match(await page.textContent('#status'), /apart\.gltf names all%20of\.bin, pictures\/a\.png, which are not there: drop all of them at once/);
    await drop(page, [['all of.bin', bytes], ['apart.gltf', text]]);
    assert.match(await page.textContent('#status'), /names pictures\/a\.png, which is not there/);
    assert.equal(await page.evaluate(() => window.lacquerPage.document.drawables.length), 1);
    await drop(page, [['a.png', Buffer.from('a picture')], ['all of.bin', bytes], ['apart.gltf', text]]);
    assert.equal(await page.textContent('#status'), '');
  }, { size: kSmall }));
