// Parts of the page that need no browser: pictures of environments, lamps, half floats.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { build } from 'esbuild';
import { root } from './native.mjs';

const folder = mkdtempSync(join(tmpdir(), 'lacquer-parts-'));
after(() => rmSync(folder, { recursive: true }));
const part = async (name, place = 'web/page') => {
  const outfile = join(folder, `${name}.mjs`);
  await build({ entryPoints: [join(root, place, `${name}.ts`)], outfile, bundle: true, format: 'esm', target: 'es2022' });
  return import(pathToFileURL(outfile));
};
const { readHdr, radianceOf } = await part('hdr');
const { makeEnvironment, Turned } = await part('environment');
const { element, FileLights } = await part('lights');
const { Moves } = await part('moves');
const { halves } = await part('gpu');
const { viewOf } = await part('editor/view');
const { frameBlocks } = await part('frame');
const { kBlocks } = await part('viewport');
const { bounds, eachNode, geometry, openGltf } = await part('gltf', 'web/src');

/** A .hdr file of colours that RGBE holds exactly; rows are run-length coded where `runs`. */
function hdr(width, height, color, runs) {
  const bytes = [...Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`)];
  const rgbe = ([r, g, b]) => {
    const exponent = Math.ceil(Math.log2(Math.max(r, g, b, 1e-9))) + 1;
    return [...[r, g, b].map((x) => Math.round((x * 256) / 2 ** exponent)), exponent + 128];
  };
  for (let y = 0; y < height; ++y) {
    const row = Array.from({ length: width }, (_, x) => rgbe(color(x, y)));
    if (!runs) {
      bytes.push(...row.flat());
      continue;
    }
    bytes.push(2, 2, width >> 8, width & 255);
    for (let plane = 0; plane < 4; ++plane) {
      for (let x = 0; x < width; ) {
        let same = 1;
        while (x + same < width && same < 127 && row[x + same][plane] === row[x][plane]) ++same;
        if (same > 2) bytes.push(128 + same, row[x][plane]);
        else bytes.push(same, ...Array.from({ length: same }, (_, i) => row[x + i][plane]));
        x += same;
      }
    }
  }
  return new Uint8Array(bytes);
}

const close = (a, b, tolerance) => a.forEach((x, i) => assert.ok(Math.abs(x - b[i]) <= tolerance * Math.max(1, Math.abs(b[i])), `${a} is not ${b}`));

test('a Radiance picture is read, with runs and without', () => {
  const color = (x, y) => [x < 20 ? 0.5 : 8, y / 16, 0.25 * (x % 2)];
  for (const runs of [false, true]) {
    const { width, height, pixels } = readHdr(hdr(40, 16, color, runs));
    assert.deepEqual([width, height], [40, 16]);
    for (let y = 0; y < 16; ++y) {
      for (let x = 0; x < 40; ++x) close([...pixels.slice(3 * (40 * y + x), 3 * (40 * y + x) + 3)], color(x, y), 0.008);
    }
  }
});

test('what is no such picture, or ends too early, is refused', () => {
  const good = hdr(40, 16, () => [1, 1, 1], true);
  assert.throws(() => readHdr(new Uint8Array([1, 2, 3, 10])), /no Radiance picture/);
  assert.throws(() => readHdr(new Uint8Array()), /ends too early/);
  for (const at of [5, 50, good.length - 1]) assert.throws(() => readHdr(good.slice(0, at)), /ends too early|no Radiance/);
  const text = (head) => new Uint8Array(Buffer.from(`#?RADIANCE\n${head}`));
  assert.throws(() => readHdr(text('FORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234')), /is not read/);
  assert.throws(() => readHdr(text('\n+X 1 -Y 1\n1234')), /no size/);
  assert.throws(() => readHdr(text('\n-Y 99999 +X 99999\n')), /is not read/);
  // What claims more than there is takes no room for it.
  const taken = process.memoryUsage().arrayBuffers;
  assert.throws(() => readHdr(text('\n-Y 8192 +X 16384\n____')), /ends too early/);
  assert.ok(process.memoryUsage().arrayBuffers - taken < 1 << 20);
  const long = text('\n-Y 1 +X 8\n________');
  long.set([2, 2, 0, 8, 137, 1], long.length - 8);
  assert.throws(() => readHdr(long), /longer/);
});

test('an environment of one colour has it at every roughness, and its irradiance', () => {
  const { specular, irradiance } = makeEnvironment(radianceOf(readHdr(hdr(32, 16, () => [0.5, 2, 1], true))), 16);
  assert.equal(specular.levels.length, 3);
  for (const faces of specular.levels) for (const face of faces) close([...face.slice(0, 3)], [0.5, 2, 1], 0.01);
  for (const face of irradiance.levels[0]) close([...face.slice(0, 3)], [0.5, 2, 1], 0.01);
});

test('a turned environment is what its radiance gives turned, in maps that are filled again', () => {
  // From +z to +x, as yaw counts.
  const smooth = (yaw) => ([x, y, z]) => [1 + x * Math.cos(yaw) - z * Math.sin(yaw), 1 + y, 2 + x * Math.sin(yaw) + z * Math.cos(yaw)];
  const [turned, environment] = [new Turned(), makeEnvironment(smooth(0), 32)];
  assert.equal(turned.of(environment, 0), environment);
  const made = turned.of(environment, 2);
  for (const angle of [0.7, -2.5]) {
    const versions = [made.specular.version, made.irradiance.version];
    assert.equal(turned.of(environment, angle), made);
    assert.ok(made.specular.version > versions[0] && made.irradiance.version > versions[1]);
    const right = makeEnvironment(smooth(angle), 32);
    for (const map of ['specular', 'irradiance']) {
      right[map].levels.forEach((faces, level) => level < 2 && faces.forEach((texels, i) => {
        const far = texels.findIndex((x, at) => !(Math.abs(x - made[map].levels[level][i][at]) <= 0.1 * Math.max(1, Math.abs(x))));
        assert.equal(far, -1, `${map}, level ${level}, face ${i}`);
      }));
    }
  }
});

test('directions are those of an equirectangular picture, and roughness blurs and loses no light', () => {
  // Bright is what lies right of the middle, half way up: +x.
  const lamp = (x, y) => (Math.abs(x - 47.5) < 3 && Math.abs(y - 15.5) < 3 ? [64, 64, 64] : [0, 0, 0]);
  const radiance = radianceOf(readHdr(hdr(64, 32, lamp, true)));
  assert.ok(radiance([1, 0, 0], 0)[0] > 60);
  assert.ok(radiance([-1, 0, 0], 0)[0] === 0);
  assert.ok(radiance([0, 1, 0], 0)[0] === 0);
  const mean = (roughness) => {
    let sum = 0;
    const count = 4000;
    for (let i = 0; i < count; ++i) {
      const y = 1 - (2 * i + 1) / count;
      const angle = i * Math.PI * (3 - Math.sqrt(5));
      const ring = Math.sqrt(1 - y * y);
      sum += radiance([ring * Math.cos(angle), y, ring * Math.sin(angle)], roughness)[0] / count;
    }
    return sum;
  };
  const sharp = mean(0);
  for (const roughness of [0.2, 0.5, 0.8]) assert.ok(Math.abs(mean(roughness) / sharp - 1) < 0.15, `${roughness}: ${mean(roughness)} of ${sharp}`);
  assert.ok(radiance([1, 0, 0], 0.7)[0] < 0.5 * radiance([1, 0, 0], 0.2)[0]);
});

test("a file's own lamps are the elements that docs/bindings.md describes", () => {
  const half = Math.SQRT1_2;
  const json = {
    asset: { version: '2.0' },
    extensions: { KHR_lights_punctual: { lights: [
      { type: 'directional', intensity: 2, color: [1, 0.5, 0.25] },
      { type: 'point', intensity: 30, range: 2 },
      { type: 'spot', spot: { innerConeAngle: 0.2, outerConeAngle: 0.6 } },
    ] } },
    nodes: [
      { rotation: [-half, 0, 0, half], extensions: { KHR_lights_punctual: { light: 0 } } }, // it shines down
      { translation: [1, 2, 3], children: [2] },
      { translation: [0, 0, 1], extensions: { KHR_lights_punctual: { light: 1 } } },
      { scale: [2, 2, 2], extensions: { KHR_lights_punctual: { light: 2 } } },
      { extensions: { KHR_lights_punctual: { light: 9 } } },
    ],
    scenes: [{ nodes: [0, 1, 3, 4] }],
    scene: 0,
  };
  const file = openGltf('a.gltf', Buffer.from(JSON.stringify(json)), new Map());
  const [sun, bulb, spot, ...more] = new FileLights(file).at(new Moves(file, [])).map(element);
  assert.deepEqual(more, []);
  close(sun, [0, 1, 0, 0, 2, 1, 0.5, 0, 0, -1, 0, 0, 1, 0, 0, 0], 1e-6);
  close(bulb, [1, 2, 4, 1, 30, 30, 30, 1 / 16, 0, 0, -1, 0, 1, 0, 0, 0], 1e-6);
  const scale = 1 / (Math.cos(0.2) - Math.cos(0.6));
  close(spot, [0, 0, 0, 1, 1, 1, 1, 0, 0, 0, -1, scale, -Math.cos(0.6) * scale, 0, 0, 0], 1e-6);
});

test('what is not to be seen is not drawn, nor are its lamps lit, nor what is below it; a clip may change that', () => {
  const hide = (visible) => ({ KHR_node_visibility: { visible } });
  const lamp = (light) => ({ KHR_lights_punctual: { light } });
  const pointer = (node) => ({ path: 'pointer', extensions: { KHR_animation_pointer: { pointer: `/nodes/${node}/extensions/KHR_node_visibility/visible` } } });
  const made = () => withArrays([new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]), new Float32Array([0, 1, 2]), new Uint8Array([0, 1, 0, 0])], {
    extensions: { KHR_lights_punctual: { lights: [{ type: 'point', intensity: 1 }, { type: 'point', intensity: 2 }] } },
    accessors: [
      { bufferView: 0, componentType: 5126, count: 3, type: 'VEC3' }, { bufferView: 1, componentType: 5126, count: 3, type: 'SCALAR' },
      { bufferView: 2, componentType: 5121, count: 3, type: 'SCALAR' },
    ],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    nodes: [
      { mesh: 0, extensions: lamp(0) }, { mesh: 0, translation: [9, 0, 0], children: [2], extensions: hide(false) },
      { mesh: 0, children: [3], extensions: { ...hide(true), ...lamp(1) } }, { mesh: 0, extensions: hide('no') },
    ],
    animations: [
      { samplers: [{ input: 1, output: 2, interpolation: 'STEP' }], channels: [{ sampler: 0, target: pointer(1) }] },
      { samplers: [{ input: 1, output: 2 }, { input: 1, output: 2, interpolation: 'STEP' }], channels: [{ sampler: 0, target: pointer(1) }, { sampler: 1, target: pointer(7) }, { sampler: 1, target: { node: 0, path: 'visible' } }] },
    ],
  });
  assert.deepEqual(geometry(made()).map(({ node }) => node), [0]);
  const file = made();
  const all = geometry(file, { hidden: true });
  const seen = () => all.filter(({ hidden }) => !hidden).map(({ node }) => node);
  assert.deepEqual(seen(), [0]);
  assert.deepEqual([...bounds(all).middle], [0.5, 0.5, 0], 'of what is seen');
  const moves = new Moves(file, all);
  const lit = () => new FileLights(file).at(moves).map(({ radiance }) => radiance[0]);
  assert.deepEqual([seen(), lit()], [[0], [1]]);
  assert.equal(moves.clips.length, 1);
  assert.equal(moves.said.length, 3, moves.said.join('\n'));
  assert.match(moves.said[0], /STEP/);
  for (const [seconds, nodes, lamps] of [[0.5, [0], [1]], [1.5, [0, 1, 2, 3], [1, 2]], [2.5, [0], [1]]]) {
    moves.pose(moves.clips[0], seconds);
    assert.deepEqual([seen(), lit()], [nodes, lamps], `${seconds}`);
  }
  moves.pose(moves.clips[0], 1.5);
  moves.pose(null, 0);
  assert.deepEqual(seen(), [0], 'at rest it is as the file says');
});

/** A glTF file whose one buffer is the arrays, each a buffer view. */
function withArrays(arrays, more) {
  const bytes = Buffer.concat(arrays.map((each) => Buffer.from(each.buffer)));
  let at = 0;
  const bufferViews = arrays.map(({ byteLength }) => ({ buffer: 0, byteOffset: (at += byteLength) - byteLength, byteLength }));
  const uri = `data:application/octet-stream;base64,${bytes.toString('base64')}`;
  const json = { asset: { version: '2.0' }, buffers: [{ byteLength: bytes.length, uri }], bufferViews, ...more };
  return openGltf('a.gltf', Buffer.from(JSON.stringify(json)));
}

test('geometry is read as it is stored: strips and fans, bytes, gaps between elements, one mesh in two places', () => {
  const square = new Float32Array([0, 0, 0, 1, 0, 0, 0, 2, 0, 1, 2, 0]);
  const uv = new Uint8Array([0, 255, 9, 9, 51, 0, 9, 9, 255, 255, 9, 9, 0, 0, 9, 9]); // two of four bytes
  const file = withArrays([square, uv, new Uint16Array([0, 1, 2, 3])], {
    accessors: [
      { bufferView: 0, componentType: 5126, count: 4, type: 'VEC3' },
      { bufferView: 1, componentType: 5121, count: 4, type: 'VEC2', normalized: true },
      { bufferView: 2, componentType: 5123, count: 4, type: 'SCALAR' },
      { bufferView: 2, componentType: 5123, count: 5, type: 'SCALAR' },
    ],
    meshes: [{ primitives: [
      { attributes: { POSITION: 0, TEXCOORD_0: 1 }, indices: 2, mode: 5 },
      { attributes: { POSITION: 0 }, mode: 6, material: 3 },
      { attributes: { POSITION: 0 }, indices: 2, mode: 1 },
      { attributes: { POSITION: 0 }, indices: 3 },
    ] }],
    nodes: [{ mesh: 0 }, { mesh: 0, translation: [9, 0, 0] }],
  });
  file.json.bufferViews[1].byteStride = 4;
  const [strip, fan, again, , ...more] = geometry(file);
  assert.deepEqual(more, [], 'lines, and indices that end too early, are left out');
  assert.deepEqual([...strip.indices], [0, 1, 2, 2, 1, 3]);
  assert.deepEqual([...fan.indices], [0, 1, 2, 0, 2, 3]);
  assert.deepEqual([strip.material, fan.material], [-1, 3]);
  close([...strip.attributes.get('TEXCOORD_0').data], [0, 1, 0.2, 0, 1, 1, 0, 0], 1e-6);
  assert.deepEqual([...strip.attributes.get('NORMAL').data.slice(0, 3)], [0, 0, 2], 'of its triangle: 1 by 2');
  assert.equal(again.attributes, strip.attributes);
  const { middle, radius } = bounds([strip, again]);
  assert.deepEqual([...middle, radius], [5, 1, 0, Math.hypot(10, 2) / 2]);
});

test('instances that many nodes ask for end where there is room for no more', () => {
  const far = new Float32Array(3 * 50_000).fill(1e30);
  const bytes = Buffer.concat([Buffer.from(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]).buffer), Buffer.from(far.buffer)]);
  const node = { mesh: 0, extensions: { EXT_mesh_gpu_instancing: { attributes: { TRANSLATION: 1 } } } };
  const file = openGltf('many.gltf', Buffer.from(JSON.stringify({
    asset: { version: '2.0' }, nodes: Array.from({ length: 5000 }, () => node), meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: 'VEC3' }, { bufferView: 1, componentType: 5126, count: 50_000, type: 'VEC3' }],
    bufferViews: [{ buffer: 0, byteLength: 36 }, { buffer: 0, byteOffset: 36, byteLength: far.byteLength }],
    buffers: [{ uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` }],
  })));
  const begin = performance.now();
  assert.equal(geometry(file).length, 0);
  assert.ok(performance.now() - begin < 60_000);
});

test('nodes that go in circles are walked once', () => {
  const json = { asset: { version: '2.0' }, nodes: [{ children: [1, 1] }, { children: [0, 1, 7] }], scenes: [{ nodes: [0, 0] }], scene: 0 };
  let walked = 0;
  eachNode(openGltf('a.gltf', Buffer.from(JSON.stringify(json))), () => ++walked);
  assert.equal(walked, 2);
  // Without scenes those that are nobody's children begin.
  const places = [];
  eachNode(openGltf('a.gltf', Buffer.from(JSON.stringify({ nodes: [{}, { children: [0], translation: [5, 0, 0] }] }))), (_, world, index) => places.push([index, world[12]]));
  assert.deepEqual(places, [[1, 5], [0, 5]]);
});

test('a parameter and a texture stand in the bodies that name them, and in the graph where none does', () => {
  const body = { nodes: [{ id: 'a', node: 'n', inputs: { x: { parameter: 'inner' }, y: { texture: 'image' } } }], outputs: { r: { node: 'a' } } };
  const json = {
    template: 'forward', nodes: [{ id: 'g', group: 'group' }], outputs: { color: { node: 'g' } }, groups: { group: body },
    parameters: { inner: { type: 'float' }, outer: { type: 'float' }, idle: { type: 'float' } }, textures: { image: { type: 'sampler2D' } },
  };
  const socket = (name, source) => ({ name, type: 'float', low: null, high: null, or_zero: false, source: source ?? null, optional: true });
  const sockets = { g: { inputs: [socket('x', { parameter: 'outer' })], outputs: [socket('')] }, 'group/a': { inputs: [socket('x', { parameter: 'inner' }), socket('y', { texture: 'image' })], outputs: [socket('')] } };
  const graph = {
    nodes: (group) => (group ? body.nodes : json.nodes), outputs: (group) => (group ? body.outputs : json.outputs),
    sockets: (node) => sockets[node] ?? { inputs: [socket('color', { node: 'g' })], outputs: [] },
  };
  const keys = (group) => [...viewOf(graph, json, group).boxes.keys()];
  assert.deepEqual(keys(''), ['group g', 'parameter outer', 'parameter idle', 'outputs ']);
  assert.deepEqual(keys('group'), ['node a', 'parameter inner', 'texture image', 'outputs ']);
});

test('half floats are rounded to the nearest', () => {
  const words = halves(new Float32Array([0, 1, -2, 0.5, 65504, 1e9, 2 ** -24, 2 ** -14, 1 + 2 ** -11 + 2 ** -12]));
  assert.deepEqual([...words], [0, 0x3c00, 0xc000, 0x3800, 0x7bff, 0x7bff, 1, 0x0400, 0x3c01]);
});

test('the block of the time has seconds and pictures at 24 a second', () => {
  const identity = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
  const clockOf = (seconds) => new Float32Array(frameBlocks([0, 0, 1], identity, { lastLevel: 4 }, [], seconds).Clock.buffer);
  assert.deepEqual([...clockOf(0)], [0, 0, 0, 0]);
  assert.deepEqual([...clockOf(2.5)], [2.5, 60, 0, 0]);
  assert.deepEqual([...clockOf(0.04)].slice(1, 2), [0]);
  // What is filled has a place.
  for (const name of Object.keys(frameBlocks([0, 0, 1], identity, { lastLevel: 4 }, [], 0))) assert.ok(kBlocks.includes(name), name);
});
