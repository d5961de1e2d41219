// What moves in a file: nodes, skins and morph targets, by its animations, on the page.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { build } from 'esbuild';
import { hasWebGpu, kWebGpu, launch } from './browser.mjs';
import { root } from './native.mjs';
import { begin, drop, end, kSmall, middle, open, painted, set, settled } from './page.mjs';

const parts = mkdtempSync(join(tmpdir(), 'lacquer-moves-'));
const part = async (name) => {
  const outfile = join(parts, `${name}.mjs`);
  await build({ entryPoints: [join(root, `web/page/${name}.ts`)], outfile, bundle: true, format: 'esm', target: 'es2022' });
  return import(pathToFileURL(outfile));
};
before(begin);
after(end);
after(() => rmSync(parts, { recursive: true }));

/** With room for one more bar below the picture. */
const kTall = { ...kSmall, height: 460 };

const kTypes = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
/** A file of a square from -1 to 1 that shines in red, whose numbers accessor() takes in. */
function squareFile(change) {
  const chunks = [];
  const json = {
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }], bufferViews: [], accessors: [],
    materials: [{ doubleSided: true, emissiveFactor: [1, 0, 0], pbrMetallicRoughness: { baseColorFactor: [0, 0, 0, 1], metallicFactor: 0 }, extensions: { KHR_materials_specular: { specularFactor: 0 } } }],
  };
  const accessor = (type, numbers, componentType = 5126) => {
    const bytes = Buffer.from((componentType === 5126 ? new Float32Array(numbers) : new Uint16Array(numbers)).buffer);
    json.bufferViews.push({ buffer: 0, byteOffset: chunks.reduce((sum, { length }) => sum + length, 0), byteLength: bytes.length });
    chunks.push(bytes);
    return json.accessors.push({ bufferView: json.bufferViews.length - 1, componentType, count: numbers.length / kTypes[type], type }) - 1;
  };
  const attributes = { POSITION: accessor('VEC3', [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), NORMAL: accessor('VEC3', [0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1]) };
  json.meshes = [{ primitives: [{ attributes, indices: accessor('SCALAR', [0, 1, 2, 0, 2, 3, 0, 0], 5123), material: 0 }] }];
  json.accessors[2].count = 6;
  change(json, accessor);
  const bytes = Buffer.concat(chunks);
  json.buffers = [{ byteLength: bytes.length, uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` }];
  return Buffer.from(JSON.stringify(json));
}
/** A clip of one channel. */
const clip = (accessor, node, path, times, type, values, interpolation) => ({
  name: path, samplers: [{ input: accessor('SCALAR', times), output: accessor(type, values), interpolation }], channels: [{ sampler: 0, target: { node, path } }],
});
/** Two joints, the lower half of the square on the first, the upper one on the second. */
function bend(json, accessor) {
  Object.assign(json.meshes[0].primitives[0].attributes, {
    JOINTS_0: accessor('VEC4', [0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0], 5123),
    WEIGHTS_0: accessor('VEC4', [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]),
  });
  const unit = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  json.skins = [{ joints: [1, 2], inverseBindMatrices: accessor('MAT4', [...unit, ...unit]) }];
  json.nodes = [{ mesh: 0, skin: 0, translation: [50, 0, 0] }, { children: [2] }, {}];
  json.scenes[0].nodes = [0, 1];
}

async function show(page, file) {
  await drop(page, [['moving.gltf', file]]);
  await page.selectOption('#environment', 'Dark');
  await page.selectOption('#lamps', 'none');
  await settled(page);
}
/** The clip stands at a moment. */
async function scrub(page, seconds) {
  await page.locator('#moment').fill(String(seconds));
  await painted(page);
}
/** From ahead, 6 units of the world from the lower edge to the upper one: the red share of each place. */
const seen = (page, places) => page.evaluate((places) => {
  const { viewport } = window.lacquerPage;
  Object.assign(viewport, { middle: [0, 0, 0], radius: 3 / Math.tan(0.36) / 3.4 });
  Object.assign(viewport.orbit, { yaw: 0, pitch: 0, distance: 3.4 });
  const pixels = viewport.pixels();
  const { width, height } = viewport.canvas;
  return places.map(([x, y]) => {
    const at = 4 * (Math.floor((0.5 - y / 6) * height) * width + Math.floor(width / 2 + (x / 6) * height));
    return pixels[at] > 200 && pixels[at + 1] < 100;
  });
}, places);
const all = (page) => page.evaluate(() => {
  const { viewport } = window.lacquerPage;
  const sum = viewport.pixels().reduce((sum, x) => (sum * 31 + x) % 2 ** 32, 0);
  return [viewport.canvas.width, viewport.canvas.height, sum];
});
const reduced = async (page) => {
  await page.emulateMedia({ reducedMotion: 'reduce' });
  await page.reload();
  await page.waitForSelector('body.ready');
};

test('a clip moves a node; scrubbing back brings the picture back', () => open([], async (page) => {
  await reduced(page);
  await show(page, squareFile((json, accessor) => {
    json.nodes = [{ children: [1] }, { mesh: 0, scale: [0.5, 0.5, 1] }];
    json.animations = [
      clip(accessor, 0, 'translation', [0, 2], 'VEC3', [0, 0, 0, 4, 0, 0]),
      clip(accessor, 1, 'translation', [0, 1, 2], 'VEC3', [0, 0, 0, 0, 2, 0, 0, -2, 0], 'STEP'),
      clip(accessor, 1, 'rotation', [0, 2], 'VEC4', [0, 0, 0, 1, 0, 0, 1, 0]),
      clip(accessor, 1, 'translation', [0, 2], 'VEC3', [9, 9, 9, 0, 0, 0, 0, 4, 0, 0, -4, 0, 2, 0, 0, 9, 9, 9], 'CUBICSPLINE'),
    ];
    json.animations[2].name = 'turn';
  }));
  assert.equal(await page.isVisible('#moves'), true);
  assert.equal(await page.textContent('#play-clip'), 'Play'); // as the system asks
  const places = [[0, 0], [2, 0], [4, 0]];
  assert.deepEqual(await seen(page, places), [true, false, false]);
  const first = await all(page);
  await scrub(page, 1);
  assert.deepEqual(await seen(page, places), [false, true, false]);
  await scrub(page, 2);
  assert.deepEqual(await seen(page, places), [false, false, true]);
  await scrub(page, 0);
  assert.deepEqual(await seen(page, places), [true, false, false]);
  assert.deepEqual(await all(page), first);
  // Steps hold their values.
  await page.selectOption('#clip', '1');
  await scrub(page, 0.98);
  assert.deepEqual(await seen(page, [[0, 0], [0, 2]]), [true, false]);
  await scrub(page, 1.5);
  assert.deepEqual(await seen(page, [[0, 0], [0, 2]]), [false, true]);
  // Half of a half turn stands on an edge's side: the corner of an eighth is beyond it.
  await page.selectOption('#clip', '2');
  await scrub(page, 0.5);
  assert.deepEqual(await seen(page, [[0.64, 0], [0.45, 0.45]]), [true, false]);
  // A cubic of tangents 4 and -4: 2 (3/4 - 2/4) + 2 (1/8 4 + 1/8 4) = 1 + 1 up at its middle, and 1 to the right.
  await page.selectOption('#clip', '3');
  await scrub(page, 1);
  assert.deepEqual(await seen(page, [[1, 2], [1, 0.6], [0, 0]]), [true, false, false]);
  await page.selectOption('#clip', '');
  await painted(page);
  assert.deepEqual(await all(page), first);
}, { size: kTall }));

test('a skin bends a square where its joints are', () => open([], async (page) => {
  await reduced(page);
  await show(page, squareFile((json, accessor) => {
    bend(json, accessor);
    json.animations = [clip(accessor, 2, 'translation', [0, 1], 'VEC3', [0, 0, 0, 2, 0, 0])];
  }));
  const places = [[-0.7, 0.7], [2.5, 0.8], [0, 0]];
  assert.deepEqual(await seen(page, places), [true, false, true]); // where its joints are, not where its node is
  await scrub(page, 1);
  assert.deepEqual(await seen(page, places), [false, true, true]);
  // What is seen is what is picked.
  assert.equal(await page.evaluate(() => window.lacquerPage.viewport.materialAt(2.5 / 3 / (window.lacquerPage.viewport.canvas.width / window.lacquerPage.viewport.canvas.height), 0.8 / 3)), 0);
  await scrub(page, 0);
  assert.deepEqual(await seen(page, places), [true, false, true]);
}, { size: kTall }));

test('WebGPU draws a bent square and a moved one, too', async (t) => {
  const by = await launch(...kWebGpu);
  try {
    await open([], async (page) => {
      if (!(await hasWebGpu(page))) return t.skip('this browser has no WebGPU');
      await reduced(page);
      await page.selectOption('#painter', 'webgpu');
      await page.waitForSelector('#viewport-gpu:visible');
      await show(page, squareFile((json, accessor) => {
        bend(json, accessor);
        json.nodes.push({ mesh: 0, translation: [-2, -2, 0], scale: [0.3, 0.3, 1] });
        json.scenes[0].nodes.push(3);
        const [bent, carried] = [clip(accessor, 2, 'translation', [0, 1], 'VEC3', [0, 0, 0, 2, 0, 0]), clip(accessor, 3, 'translation', [0, 1], 'VEC3', [-2, -2, 0, 2, -2, 0])];
        const glow = { sampler: 2, target: { path: 'pointer', extensions: { KHR_animation_pointer: { pointer: '/materials/0/emissiveFactor' } } } };
        json.animations = [{
          samplers: [bent.samplers[0], carried.samplers[0], { input: accessor('SCALAR', [0, 1, 2]), output: accessor('VEC3', [1, 0, 0, 1, 0, 0, 0, 1, 0]) }],
          channels: [bent.channels[0], { ...carried.channels[0], sampler: 1 }, glow],
        }];
        json.extensionsUsed = ['KHR_animation_pointer'];
      }));
      const colors = () => page.evaluate(async (places) => {
        const { viewport } = window.lacquerPage;
        Object.assign(viewport, { middle: [0, 0, 0], radius: 3 / Math.tan(0.36) / 3.4 });
        Object.assign(viewport.orbit, { yaw: 0, pitch: 0, distance: 3.4 });
        viewport.draw();
        const { width, height } = viewport.gpu.canvas;
        const pixels = await viewport.gpu.pixels(viewport, width, height);
        return places.map(([x, y]) => {
          const at = 4 * (Math.floor((0.5 - y / 6) * height) * width + Math.floor(width / 2 + (x / 6) * height));
          const [red, green, blue] = pixels.subarray(at, at + 3);
          return red > 200 && green < 100 ? 'red' : green > 200 && red < 100 ? 'green' : Math.abs(green - blue) < 8 ? '' : `${[red, green, blue]}`;
        });
      }, [[-0.7, 0.7], [2.5, 0.8], [-2, -2], [2, -2]]);
      assert.deepEqual(await colors(), ['red', '', 'red', '']);
      await scrub(page, 1);
      assert.deepEqual(await colors(), ['', 'red', '', 'red']);
      await scrub(page, 2);
      assert.deepEqual(await colors(), ['', 'green', '', 'green']);
      await scrub(page, 0);
      assert.deepEqual(await colors(), ['red', '', 'red', '']);
    }, { size: kTall, by });
  } finally {
    await by.close();
  }
});

test('a clip moves a number of a material, on a ball and after an edit, too', () => open([], async (page) => {
  await reduced(page);
  await show(page, squareFile((json, accessor) => {
    const { samplers, channels } = clip(accessor, 0, 'translation', [0, 1], 'VEC3', [1, 0, 0, 0, 1, 0]);
    channels[0].target = { path: 'pointer', extensions: { KHR_animation_pointer: { pointer: '/materials/0/emissiveFactor' } } };
    json.animations = [{ samplers, channels }];
    json.extensionsUsed = ['KHR_animation_pointer'];
  }));
  const color = async () => {
    const [red, green] = await middle(page);
    return red > 200 && green < 100 ? 'red' : green > 200 && red < 100 ? 'green' : `${[red, green]}`;
  };
  assert.equal(await color(), 'red');
  await scrub(page, 1);
  assert.equal(await color(), 'green');
  await page.selectOption('#shape', 'ball');
  await painted(page);
  assert.equal(await color(), 'green');
  await set(page, 'p:/materials/0/pbrMetallicRoughness/roughnessFactor', 0.3);
  await painted(page);
  assert.equal(await color(), 'green');
  await page.selectOption('#clip', '');
  await painted(page);
  assert.equal(await color(), 'red');
  assert.deepEqual(await page.evaluate(() => window.lacquerPage.document.get('/materials/0/emissiveFactor')), [1, 0, 0]);
}, { size: kTall }));

test('a morph target moves what it is of, by the weights of the mesh, the node and the clip', () => open([], async (page) => {
  await reduced(page);
  const file = (weights, animated) => squareFile((json, accessor) => {
    json.meshes[0].primitives[0].targets = [{ POSITION: accessor('VEC3', [2, 0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0]) }, { POSITION: accessor('VEC3', [0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2, 0]) }];
    json.meshes[0].weights = weights;
    if (animated) json.animations = [clip(accessor, 0, 'weights', [0, 1], 'SCALAR', [0, 0, 0, 1])];
  });
  const places = [[0, 0], [2, 0], [0, 2]];
  await show(page, file(undefined, false));
  assert.deepEqual(await seen(page, places), [true, false, false]);
  assert.equal(await page.isVisible('#moves'), false);
  await show(page, file([1, 0], false));
  assert.deepEqual(await seen(page, places), [false, true, false]);
  await show(page, file([1, 0], true));
  assert.deepEqual(await seen(page, places), [true, false, false]);
  await scrub(page, 1);
  assert.deepEqual(await seen(page, places), [false, false, true]);
  await page.selectOption('#clip', '');
  await painted(page);
  assert.deepEqual(await seen(page, places), [false, true, false]);
}, { size: kTall }));

test('morph targets change colours and places in a picture', () => open([], async (page) => {
  await reduced(page);
  await show(page, squareFile((json, accessor) => {
    const [primitive] = json.meshes[0].primitives;
    json.materials = [
      { doubleSided: true, pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 1 }, extensions: { KHR_materials_unlit: {} } },
    ];
    json.extensionsUsed = ['KHR_materials_unlit'];
    primitive.attributes.COLOR_0 = accessor('VEC4', Array(4).fill([1, 0, 0, 1]).flat());
    // Beyond 1 it ends.
    primitive.targets = [{ COLOR_0: accessor('VEC4', Array(4).fill([-1, 5, 0, 0]).flat()) }, { COLOR_0: accessor('VEC3', Array(4).fill([-1, 0, 1]).flat()) }];
    json.animations = [clip(accessor, 0, 'weights', [0, 1, 2, 3], 'SCALAR', [0, 0, 1, 0, 0, 1, 0, 0])];
  }));
  const color = async () => (await middle(page)).slice(0, 3).map((x) => (x > 200 ? 1 : x < 100 ? 0 : x)).join('');
  assert.equal(await color(), '100');
  await scrub(page, 1);
  assert.equal(await color(), '010');
  await scrub(page, 2);
  assert.equal(await color(), '001');
  await scrub(page, 3);
  assert.equal(await color(), '100');
  // A picture of red on the left and green on the right, of which the left half's middle is seen.
  const bitmap = await page.evaluate(() => {
    const canvas = document.createElement('canvas');
    Object.assign(canvas, { width: 64, height: 64 });
    const context = canvas.getContext('2d');
    context.fillStyle = '#f00';
    context.fillRect(0, 0, 32, 64);
    context.fillStyle = '#0f0';
    context.fillRect(32, 0, 32, 64);
    return canvas.toDataURL('image/png');
  });
  await show(page, squareFile((json, accessor) => {
    const [primitive] = json.meshes[0].primitives;
    Object.assign(json, { images: [{ uri: bitmap }], textures: [{ source: 0 }], extensionsUsed: ['KHR_materials_unlit'] });
    json.materials = [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 } }, extensions: { KHR_materials_unlit: {} } }];
    primitive.attributes.TEXCOORD_0 = accessor('VEC2', Array(4).fill([0.25, 0.5]).flat());
    primitive.targets = [{ TEXCOORD_0: accessor('VEC2', Array(4).fill([0.5, 0]).flat()) }];
    json.animations = [clip(accessor, 0, 'weights', [0, 1], 'SCALAR', [0, 1])];
  }));
  assert.equal(await color(), '100');
  await scrub(page, 1);
  assert.equal(await color(), '010');
}, { size: kTall }));

/** A clip that moves values by their pointers: lists of numbers at the seconds from 0 on. */
const pointing = (accessor, moved) => ({
  samplers: Object.values(moved).map(([type, values]) => ({ input: accessor('SCALAR', Array.from({ length: values.length / kTypes[type] }, (_, i) => i)), output: accessor(type, values) })),
  channels: Object.keys(moved).map((pointer, sampler) => ({ sampler, target: { path: 'pointer', extensions: { KHR_animation_pointer: { pointer } } } })),
});
/** The colour of a place, as seen() has them: which of red, green and blue are bright. */
const colorAt = (page, x, y) => page.evaluate(([x, y]) => {
  const { viewport } = window.lacquerPage;
  const pixels = viewport.pixels();
  const { width, height } = viewport.canvas;
  const at = 4 * (Math.floor((0.5 - y / 6) * height) * width + Math.floor(width / 2 + (x / 6) * height));
  return [...pixels.subarray(at, at + 3)].map((x) => (x > 150 ? 1 : x < 60 ? 0 : x)).join('');
}, [x, y]);

test("the file's lamps go with their nodes and have the clip's colours", () => open([], async (page) => {
  await reduced(page);
  const kLights = '/extensions/KHR_lights_punctual/lights';
  await show(page, squareFile((json, accessor) => {
    json.materials = [{ pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 1 } }];
    json.extensions = { KHR_lights_punctual: { lights: [{ type: 'point', color: [1, 0, 0], intensity: 3 }, { type: 'spot', intensity: 0, spot: { innerConeAngle: 0.1, outerConeAngle: 0.2 } }] } };
    json.extensionsUsed = ['KHR_lights_punctual', 'KHR_animation_pointer'];
    json.nodes = [{ mesh: 0 }, { children: [2] }, { extensions: { KHR_lights_punctual: { light: 0 } }, translation: [0, 0, 1] }, { extensions: { KHR_lights_punctual: { light: 1 } }, translation: [0, 0, 2] }];
    json.scenes[0].nodes = [0, 1, 3];
    json.animations = [
      clip(accessor, 1, 'translation', [0, 1], 'VEC3', [0, 0, 0, 0, 0, -9]),
      pointing(accessor, { [`${kLights}/0/color`]: ['VEC3', [1, 0, 0, 0, 1, 0]], [`${kLights}/0/intensity`]: ['SCALAR', [3, 3]] }),
      pointing(accessor, { [`${kLights}/1/intensity`]: ['SCALAR', [12, 12]], [`${kLights}/1/color`]: ['VEC3', [0, 0, 1, 0, 0, 1]], [`${kLights}/1/spot/innerConeAngle`]: ['SCALAR', [0, 0.9]], [`${kLights}/1/spot/outerConeAngle`]: ['SCALAR', [0.1, 1]], [`${kLights}/0/intensity`]: ['SCALAR', [0, 0]] }),
    ];
  }));
  assert.equal(await page.evaluate(() => window.lacquerPage.document.moves.said.join()), '');
  await page.selectOption('#lamps', 'own');
  await seen(page, []);
  assert.equal(await colorAt(page, 0, 0), '100');
  await scrub(page, 1);
  assert.equal(await colorAt(page, 0, 0), '000'); // behind it
  await scrub(page, 0);
  assert.equal(await colorAt(page, 0, 0), '100');
  await page.selectOption('#clip', '1');
  await scrub(page, 1);
  assert.equal(await colorAt(page, 0, 0), '010');
  await page.selectOption('#clip', '2');
  await scrub(page, 0);
  assert.deepEqual([await colorAt(page, 0, 0), await colorAt(page, 0.9, 0)], ['001', '000']);
  await scrub(page, 1);
  assert.deepEqual([await colorAt(page, 0, 0), await colorAt(page, 0.9, 0)], ['001', '001']);
  await page.selectOption('#clip', '');
  assert.equal(await colorAt(page, 0, 0), '100');
}, { size: kTall }));

test('the picture is seen by a camera of the file, which moves, until a hand turns it', () => open([], async (page) => {
  await reduced(page);
  await show(page, squareFile((json, accessor) => {
    json.cameras = [
      { type: 'perspective', perspective: { yfov: 2 * Math.atan(0.5), znear: 0.1 } },
      { type: 'orthographic', name: 'flat', orthographic: { xmag: 0.5, ymag: 3, znear: 0, zfar: 20 } },
      { type: 'perspective', perspective: { yfov: 0, znear: 0.1 } },
    ];
    json.nodes = [{ mesh: 0 }, { children: [2], name: 'arm' }, { camera: 0, translation: [0, 0, 6], scale: [2, 2, 2], name: 'eye' }, { camera: 1, translation: [1, 0, 6] }, { camera: 2 }];
    json.scenes[0].nodes = [0, 1, 3, 4];
    json.extensionsUsed = ['KHR_animation_pointer'];
    json.animations = [
      clip(accessor, 1, 'translation', [0, 1], 'VEC3', [0, 0, 0, 2, 0, 0]),
      pointing(accessor, { '/cameras/0/perspective/yfov': ['SCALAR', [2 * Math.atan(0.5), 2 * Math.atan(1)]], '/cameras/1/orthographic/ymag': ['SCALAR', [3, 6]] }),
    ];
  }));
  const red = async (...places) => {
    const colors = [];
    for (const x of places) colors.push(await colorAt(page, x, 0) === '100');
    return colors;
  };
  assert.deepEqual(await page.locator('#camera option').allTextContents(), ['Turned by hand', 'eye', 'flat']);
  assert.match(await page.evaluate(() => window.lacquerPage.document.cameras.said.join()), /\/cameras\/2: yfov is 0, and must be between 0 and pi; it is left out/);
  // Six units from the lower edge to the upper one.
  await page.selectOption('#camera', { label: 'eye' });
  assert.deepEqual(await red(-0.9, 0.9, -1.1, 1.1), [true, true, false, false]);
  await scrub(page, 1);
  assert.deepEqual(await red(-2.9, -1.1, -0.9, 0), [true, true, false, false]);
  await scrub(page, 0);
  await page.selectOption('#clip', '1');
  await scrub(page, 1);
  assert.deepEqual(await red(-0.4, 0.4, -0.6, 0.6), [true, true, false, false]);
  await scrub(page, 0);
  await page.selectOption('#camera', { label: 'flat' });
  assert.deepEqual(await red(-1.9, -0.1, -2.1, 0.1), [true, true, false, false]);
  await scrub(page, 1);
  assert.deepEqual(await red(-0.9, -0.1, -1.1, 0.1), [true, true, false, false]);
  // A click chooses what this camera sees, and a drag begins where the camera is.
  const aspect = await page.evaluate(() => window.lacquerPage.viewport.canvas.width / window.lacquerPage.viewport.canvas.height);
  const at = (x) => page.evaluate((x) => window.lacquerPage.viewport.materialAt(x, 0), x / 3 / aspect);
  assert.deepEqual([await at(-0.5), await at(0.2)], [0, undefined]);
  await page.selectOption('#camera', { label: 'eye' });
  await page.selectOption('#clip', '');
  const eye = await page.evaluate(() => window.lacquerPage.viewport.eye());
  assert.deepEqual(eye, [0, 0, 6]);
  await page.focus('#viewport');
  await page.keyboard.press('+');
  assert.equal(await page.inputValue('#camera'), '');
  const { orbit, middle: between, radius } = await page.evaluate(() => {
    const { orbit, middle, radius } = window.lacquerPage.viewport;
    return { orbit, middle, radius };
  });
  assert.deepEqual([orbit.yaw, orbit.pitch], [0, 0]);
  assert.ok(Math.abs(orbit.distance * radius - 0.9 * (6 - between[2])) < 1e-3, JSON.stringify([orbit, between, radius]));
  // The eye of a parallel projection is far away: a hand turns what is shown all the same.
  await page.selectOption('#camera', { label: 'flat' });
  await page.focus('#viewport');
  await page.keyboard.press('+');
  const from = await page.evaluate(() => ({ far: window.lacquerPage.viewport.orbit.distance, middle: window.lacquerPage.viewport.middle }));
  assert.ok(from.far <= 20 && Math.abs(from.middle[2] - between[2]) < 1e-2, JSON.stringify([from, between]));
  await page.keyboard.press('f');
  await painted(page);
  // The ball is no part of the file.
  await page.selectOption('#camera', { label: 'flat' });
  await page.selectOption('#shape', 'ball');
  assert.equal(await colorAt(page, 0, 0), '100');
  await drop(page, [['plain.gltf', squareFile(() => undefined)]]);
  assert.equal(await page.isVisible('#camera'), false);
}, { size: kTall }));

test('sparse accessors are drawn: those of a morph target alone, and those that change another one', () => open([], async (page) => {
  await reduced(page);
  const file = (change) => squareFile((json, accessor) => {
    /** Vertices 1 and 2 of a list that has four. */
    const sparse = (index, numbers, componentType = 5123) => {
      const [places, values] = [accessor('SCALAR', [1, 2], 5123), accessor('VEC3', numbers)].map((each) => json.accessors[each].bufferView);
      const of = { count: 2, indices: { bufferView: places, componentType }, values: { bufferView: values } };
      if (index < 0) return json.accessors.push({ componentType: 5126, count: 4, type: 'VEC3', sparse: of }) - 1;
      json.accessors[index].sparse = of;
      return index;
    };
    change(json, sparse);
  });
  const wide = [[-0.5, 0], [2, 0]];
  await show(page, file((json, sparse) => {
    json.meshes[0].primitives[0].targets = [{ POSITION: sparse(-1, [2, 0, 0, 2, 0, 0]) }];
    json.meshes[0].weights = [1];
  }));
  assert.deepEqual(await seen(page, wide), [true, true]);
  assert.equal(await page.evaluate(() => window.lacquerPage.document.moves.said.join()), '');
  await show(page, file((json, sparse) => sparse(0, [3, -1, 0, 3, 1, 0])));
  assert.deepEqual(await seen(page, wide), [true, true]);
  // What cannot be read leaves its primitive out.
  for (const wrong of [{ componentType: 5126 }, { byteOffset: 2 }, { bufferView: 99 }]) {
    await show(page, file((json, sparse) => Object.assign(json.accessors[sparse(0, [3, -1, 0, 3, 1, 0])].sparse.indices, wrong)));
    assert.equal(await page.evaluate(() => window.lacquerPage.document.drawables.length), 0);
  }
}, { size: kTall }));

test('an animation plays, stands and is stepped through by keys', () => open([], async (page) => {
  await show(page, squareFile((json, accessor) => {
    json.animations = [clip(accessor, 0, 'translation', [0, 60], 'VEC3', [0, 0, 0, 4, 0, 0])];
  }));
  const x = () => page.evaluate(() => window.lacquerPage.document.drawables[0].model[12]);
  assert.equal(await page.textContent('#play-clip'), 'Pause');
  const began = await x();
  await page.waitForFunction((began) => window.lacquerPage.document.drawables[0].model[12] > began, began);
  await page.focus('#viewport');
  await page.keyboard.press(' ');
  assert.equal(await page.textContent('#play-clip'), 'Play');
  await painted(page);
  const stood = await x();
  await painted(page);
  await painted(page);
  assert.equal(await x(), stood);
  await page.keyboard.press('.');
  const on = await x();
  await page.keyboard.press('.');
  assert.ok(Math.abs((await x()) - on - 4 / 60 / 24) < 1e-5);
  await page.keyboard.press(',');
  assert.equal(await x(), on);
  await page.focus('#moment');
  await page.keyboard.press('End');
  assert.equal(await x(), 4);
  await page.keyboard.press('Home');
  assert.equal(await x(), 0);
  await page.click('#play-clip');
  await page.waitForFunction(() => window.lacquerPage.document.drawables[0].model[12] > 0);
  // A low window has room for the picture still.
  await page.setViewportSize(kSmall);
  const height = await page.evaluate(() => window.lacquerPage.viewport.canvas.clientHeight);
  assert.ok(height > 50, `${height}`);
}, { size: kTall }));

test('what is wrong with what moves is said, and the rest is drawn', () => open([], async (page) => {
  const said = async (change) => {
    await show(page, squareFile(change));
    assert.deepEqual(await seen(page, [[0, 0]]), [true]);
    return page.evaluate(() => window.lacquerPage.document.moves.said.join('\n'));
  };
  const skin = (change) => (json, accessor) => {
    bend(json, accessor);
    json.nodes[0].translation = [0, 0, 0];
    change(json, accessor);
  };
  const moved = (path, times, type, values, change = () => undefined) => (json, accessor) => {
    json.animations = [clip(accessor, 0, path, times, type, values)];
    change(json);
  };
  assert.match(await said(skin((json, accessor) => { json.skins[0].inverseBindMatrices = accessor('MAT4', Array(16).fill(0)); })), /\/skins\/0: it has 2 joints and 1 inverseBindMatrices; what has it is drawn at rest/);
  assert.match(await said(skin((json) => { json.skins[0].inverseBindMatrices = 99; })), /\/skins\/0: inverseBindMatrices, accessor 99, cannot be read/);
  assert.match(await said(skin((json) => { json.skins[0].joints = [1]; delete json.skins[0].inverseBindMatrices; })), /JOINTS_0: vertex 2 has joint 1 by 1, of a skin with 1; it is drawn at rest/);
  assert.match(await said(skin((json) => { json.skins[0].joints = [1, 7]; })), /its joint 7 is no node/);
  assert.match(await said(skin((json) => { json.nodes[0].skin = 5; })), /\/skins\/5: there is no such skin/);
  assert.match(await said(skin((json) => { delete json.meshes[0].primitives[0].attributes.JOINTS_0; })), /it has no JOINTS_0 and WEIGHTS_0/);
  assert.equal(await said(skin((json) => { delete json.skins[0].inverseBindMatrices; })), ''); // they are identities
  assert.match(await said((json) => { json.nodes = [{ mesh: 0, children: [1] }, { children: [0] }]; }), /\/nodes\/1\/children: node 0 has another parent, or is above itself/);
  assert.match(await said((json, accessor) => {
    json.meshes[0].primitives[0].targets = [{ POSITION: accessor('VEC3', [5, 5, 5]) }];
    json.meshes[0].weights = [1];
  }), /targets\/0\/POSITION: accessor \d+ cannot be read as three numbers for each of 4 vertices/);
  assert.match(await said((json, accessor) => {
    json.meshes[0].primitives[0].attributes.TEXCOORD_0 = accessor('VEC2', Array(8).fill(0));
    json.meshes[0].primitives[0].targets = [{ TEXCOORD_0: 0 }];
    json.meshes[0].weights = [1];
  }), /targets\/0\/TEXCOORD_0: accessor 0 cannot be read as two numbers for each of 4 vertices/);
  assert.match(await said(moved('translation', [0, 1], 'VEC3', [0, 0, 0])), /\/animations\/0\/channels\/0: the sampler's output has 3 numbers, 3 in each element: 2 times by LINEAR need 6/);
  assert.match(await said(moved('translation', [1, 0], 'VEC3', [0, 0, 0, 1, 1, 1])), /cannot be read as times/);
  assert.match(await said(moved('rotation', [0, 1], 'VEC3', [0, 0, 0, 1, 1, 1])), /need 8/);
  assert.match(await said(moved('weights', [0, 1], 'SCALAR', [0, 1])), /the mesh of node 0 has no morph targets/);
  assert.match(await said(moved('color', [0, 1], 'SCALAR', [0, 1])), /"color" is no path/);
  assert.match(await said(moved('translation', [0, 1], 'VEC3', [0, 0, 0, 1, 1, 1], (json) => { json.animations[0].channels[0].target.node = 9; })), /there is no node 9/);
  assert.match(await said(moved('translation', [0, 1], 'VEC3', [0, 0, 0, 1, 1, 1], (json) => { json.animations[0].channels[0].sampler = 4; })), /there is no sampler 4/);
  assert.match(await said(moved('translation', [0, 1], 'VEC3', [0, 0, 0, 1, 1, 1], (json) => { json.animations[0].samplers[0].interpolation = 'SPLINE'; })), /"SPLINE" is none/);
  assert.match(await said(moved('translation', [0, 1], 'VEC3', [0, 0, 0, 1, 1, 1], (json) => { json.nodes[0].matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]; })), /node 0 has a matrix/);
  assert.match(await page.textContent('#messages'), /node 0 has a matrix/);
}, { size: kTall }));

const { Document } = await part('document');
const documentOf = (json) => new Document(
  { scene: () => ({ materialCount: 1, materialName: () => '', uses: () => [], free: () => undefined }) },
  { name: 'a.gltf', bytes: Buffer.from(JSON.stringify(json)), resources: new Map() },
);
const near = (of, wanted) => wanted.forEach((x, i) => assert.ok(Math.abs(of[i] - x) < 1e-5, `${[...of]} is not ${wanted}`));
const attribute = (of, name, drawable = 0) => of.drawables[drawable].attributes.get(name).data;

test('normals and tangents turn with their joints, eight of them for a vertex', () => {
  const half = Math.SQRT1_2;
  const file = JSON.parse(squareFile((json, accessor) => {
    bend(json, accessor);
    const [{ attributes }] = json.meshes[0].primitives;
    attributes.TANGENT = accessor('VEC4', Array(4).fill([1, 0, 0, -1]).flat());
    attributes.WEIGHTS_0 = accessor('VEC4', Array(4).fill([0, 0, 0, 0.5]).flat());
    attributes.JOINTS_0 = attributes.JOINTS_1 = accessor('VEC4', Array(16).fill(1), 5123);
    attributes.WEIGHTS_1 = accessor('VEC4', Array(4).fill([0, 0.5, 0, 0]).flat());
    json.nodes[2].rotation = [half, 0, 0, half]; // y to z, z to -y
    json.nodes[2].scale = [2, 1, 1];
    json.animations = [clip(accessor, 2, 'rotation', [0, 1], 'VEC4', [0, 0, 0, 1, 0, half, 0, -half])];
  }));
  const of = documentOf(file);
  assert.deepEqual(of.moves.said, []);
  near(attribute(of, 'POSITION'), [-2, 0, -1, 2, 0, -1, 2, 0, 1]);
  near(attribute(of, 'NORMAL'), [0, -1, 0]);
  near(attribute(of, 'TANGENT'), [1, 0, 0, -1]);
  // Along the shorter arc: an eighth about -y.
  of.moves.pose(of.moves.clips[0], 0.5);
  near(attribute(of, 'TANGENT'), [half, 0, half, -1]);
  near(attribute(of, 'NORMAL'), [-half, 0, half]);
  near(of.drawables[0].model, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
});

test('morph targets change normals; where a primitive has none, they are those of its bent triangles', () => {
  const file = (bare) => documentOf(JSON.parse(squareFile((json, accessor) => {
    const [primitive] = json.meshes[0].primitives;
    primitive.targets = [{ POSITION: accessor('VEC3', [0, 0, 0, 0, 0, 2, 0, 0, 2, 0, 0, 0]), NORMAL: accessor('VEC3', Array(4).fill([1, 0, -1]).flat()) }];
    json.meshes[0].weights = [0];
    json.nodes[0].weights = [1];
    if (bare) delete primitive.attributes.NORMAL;
  })));
  near(attribute(file(false), 'NORMAL'), [1, 0, 0]);
  const [x, y, z] = attribute(file(true), 'NORMAL');
  assert.ok(y === 0 && z > 0 && Math.abs(x + z) < 1e-6, `${[x, y, z]}`);
});

test('instances go where their node goes, and one bent shape is theirs together', () => {
  const of = documentOf(JSON.parse(squareFile((json, accessor) => {
    json.meshes[0].primitives[0].targets = [{ POSITION: accessor('VEC3', Array(12).fill(1)) }];
    json.nodes[0].extensions = { EXT_mesh_gpu_instancing: { attributes: { TRANSLATION: accessor('VEC3', [1, 0, 0, 3, 0, 0]) } } };
    const [moved, changed] = [clip(accessor, 0, 'translation', [0, 1], 'VEC3', [0, 0, 0, 0, 8, 0]), clip(accessor, 0, 'weights', [0, 1], 'SCALAR', [0, 1])];
    json.animations = [{ samplers: [moved.samplers[0], changed.samplers[0]], channels: [moved.channels[0], { ...changed.channels[0], sampler: 1 }] }];
  })));
  of.moves.pose(of.moves.clips[0], 0.5);
  assert.deepEqual(of.drawables.map(({ model }) => [...model.slice(12, 15)]), [[1, 4, 0], [3, 4, 0]]);
  assert.equal(of.drawables[0].attributes, of.drawables[1].attributes);
  near(attribute(of, 'POSITION', 1), [-0.5, -0.5, 0.5]);
  assert.equal(attribute(of, 'POSITION'), attribute(of, 'POSITION', 1));
});

/** All clips at some moments, and at rest: what is drawn stays numbers. */
function playAll({ moves, drawables }) {
  for (const clip of [...moves.clips, null]) {
    for (const seconds of [0, 0.5, 1, 7]) {
      moves.pose(clip, seconds);
      for (const { model, normal, attributes } of drawables) {
        assert.ok([...model, ...normal, ...attributes.get('POSITION').data, ...attributes.get('NORMAL').data].every(Number.isFinite));
      }
    }
  }
}

test('whatever is in the place of whatever value, all clips play', () => {
  const whole = squareFile((json, accessor) => {
    bend(json, accessor);
    json.meshes[0].primitives[0].targets = [{ POSITION: accessor('VEC3', Array(12).fill(2)), NORMAL: accessor('VEC3', Array(12).fill(1)), COLOR_0: accessor('VEC3', Array(12).fill(1)) }];
    json.meshes[0].primitives[0].attributes.COLOR_0 = accessor('VEC4', Array(16).fill(1));
    json.meshes[0].weights = [0.5];
    json.nodes.push({ mesh: 0, rotation: [0, 0, 0, 1], scale: [1, 1, 1], matrix: undefined });
    json.animations = [
      clip(accessor, 2, 'rotation', [0, 1], 'VEC4', [0, 0, 0, 1, 0, 0, 1, 0]), clip(accessor, 0, 'weights', [0, 1], 'SCALAR', [0, 1], 'STEP'),
      clip(accessor, 1, 'scale', [0, 1], 'VEC3', Array(18).fill(1), 'CUBICSPLINE'),
    ];
    json.animations[2].channels[0].target = { path: 'pointer', extensions: { KHR_animation_pointer: { pointer: '/nodes/1/scale' } } };
  });
  const others = [null, true, 0, 5, -1, 1.5, 1e300, '', 'x', '__proto__', [], [null], [1, 1], ['x', 1.5, -1, {}], {}, { length: 5 }, [1e300, 1e300, 1e300, 1e300]];
  const places = (at, path = []) =>
    typeof at === 'object' && at !== null ? Object.entries(at).flatMap(([key, value]) => [[...path, key], ...places(value, [...path, key])]) : [];
  const first = JSON.parse(whole);
  const sound = documentOf(first);
  assert.deepEqual([sound.moves.said, sound.moves.clips.length], [[], 3]);
  playAll(sound);
  for (const path of places(first).filter(([top]) => ['meshes', 'nodes', 'skins', 'animations', 'accessors', 'scenes'].includes(top))) {
    for (const other of [...others, undefined]) {
      const json = JSON.parse(whole);
      const at = path.slice(0, -1).reduce((at, key) => at[key], json);
      if (other === undefined) delete at[path.at(-1)];
      else at[path.at(-1)] = other;
      assert.doesNotThrow(() => playAll(documentOf(json)), `${path.join('/')}: ${JSON.stringify(other)}`);
    }
  }
});

test('what moves has an end, though many nodes have a large mesh, a skin and many targets', () => {
  const many = (count, make) => Array.from({ length: count }, (_, i) => make(i));
  const begin = performance.now();
  const large = squareFile((json, accessor) => {
    bend(json, accessor);
    const [primitive] = json.meshes[0].primitives;
    primitive.targets = many(20_000, () => ({ POSITION: 0 }));
    json.meshes[0].weights = many(20_000, () => 1);
    json.skins = many(100, () => json.skins[0]);
    json.nodes = [...json.nodes, ...many(20_000, (i) => ({ mesh: 0, skin: i % 100 }))];
    delete json.scenes;
    json.animations = [{ samplers: [{ input: accessor('SCALAR', [0, 1]), output: 0 }], channels: many(200_000, () => ({ sampler: 0, target: { node: 2, path: 'translation' } })) }];
    json.animations[0].samplers[0].output = accessor('VEC3', [0, 0, 0, 1, 1, 1]);
  });
  const of = documentOf(JSON.parse(large));
  of.moves.pose(of.moves.clips[0], 0.5);
  assert.equal(of.moves.clips[0].channels.length, 100_000);
  assert.ok(performance.now() - begin < 30_000, 'it takes too long');
  assert.ok(of.moves.said.length < 10 && of.moves.said.some((text) => /drawn at rest/.test(text)), of.moves.said.join('\n'));
});
