// Files that ask for too much, or have something else in the place of what glTF wants: what is wrong is left out, and the
// rest of the file opens. No browser is needed.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { build } from 'esbuild';
import { root } from './native.mjs';

const folder = mkdtempSync(join(tmpdir(), 'lacquer-hostile-'));
after(() => rmSync(folder, { recursive: true }));
const part = async (name, place) => {
  const outfile = join(folder, `${name}.mjs`);
  await build({ entryPoints: [join(root, place, `${name}.ts`)], outfile, bundle: true, format: 'esm', target: 'es2022' });
  return import(pathToFileURL(outfile));
};
const { bounds, bufferView, eachNode, fetchGltf, geometry, image, openGltf, sourceOf } = await part('gltf', 'web/src');
const { Document } = await part('document', 'web/page');
const { element, FileLights } = await part('lights', 'web/page');
const { Moves } = await part('moves', 'web/page');

/** A triangle, with every kind of thing that is read; `change` makes of it what is to be read. */
function triangle(change = () => undefined) {
  const json = {
    asset: { version: '2.0' },
    buffers: [{ byteLength: 42 }],
    bufferViews: [{ buffer: 0, byteOffset: 0, byteLength: 36, byteStride: 12 }, { buffer: 0, byteOffset: 36, byteLength: 6 }],
    accessors: [
      { bufferView: 0, byteOffset: 0, componentType: 5126, type: 'VEC3', count: 3, normalized: false },
      { bufferView: 1, componentType: 5123, type: 'SCALAR', count: 3 },
    ],
    images: [{ bufferView: 1, mimeType: 'image/png' }],
    textures: [{ source: 0, extensions: { EXT_texture_webp: { source: 0 } } }],
    materials: [{}],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 0 }, indices: 1, mode: 4, material: 0 }] }],
    nodes: [
      { mesh: 0, children: [1], translation: [0, 0, 0], rotation: [0, 0, 0, 1], scale: [1, 1, 1] },
      { mesh: 0, matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], extensions: { KHR_lights_punctual: { light: 0 } } },
    ],
    scenes: [{ nodes: [0] }],
    scene: 0,
    extensions: { KHR_lights_punctual: { lights: [
      { type: 'spot', color: [1, 1, 1], intensity: 1, range: 1, spot: { innerConeAngle: 0.1, outerConeAngle: 0.2 } },
    ] } },
    animations: [{ channels: [{ target: { extensions: { KHR_animation_pointer: { pointer: '/materials/0/alphaCutoff' } } } }] }],
    extensionsUsed: ['KHR_lights_punctual'],
  };
  return opened(change(json) ?? json);
}
function opened(json, binary = bytesOf(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]), new Uint16Array([0, 1, 2]))) {
  const file = openGltf('a.gltf', Buffer.from(typeof json === 'string' ? json : JSON.stringify(json)));
  file.binary = binary;
  return file;
}
const bytesOf = (...arrays) => new Uint8Array(Buffer.concat(arrays.map(({ buffer }) => Buffer.from(buffer))));
const names = (count, make) => Array.from({ length: count }, (_, i) => make(i));
const timed = (act) => {
  const begin = performance.now();
  const made = act();
  assert.ok(performance.now() - begin < 20_000, 'it takes too long');
  return made;
};

test('what is drawn has an end, though each of many nodes has a mesh of many primitives', () => {
  const many = (primitives, nodes) => triangle((json) => {
    json.meshes[0].primitives = names(primitives, () => json.meshes[0].primitives[0]);
    json.nodes = names(nodes, () => ({ mesh: 0 }));
    delete json.scenes;
  });
  const found = timed(() => geometry(many(700, 700)));
  assert.equal(found.length, 100_000);
  assert.equal(found[99_999].model, found[99_998].model);
  assert.equal(geometry(many(3, 700)).length, 2100);
  // Those that are left out are not come upon at every node again.
  assert.equal(timed(() => geometry(opened({
    meshes: [{ primitives: names(20_000, () => ({ attributes: { POSITION: 0 } })) }], nodes: names(20_000, () => ({ mesh: 0 })),
  }))).length, 0);
});

test('a chain of nodes may be of any length, and nodes come parents first, in order', () => {
  const length = 100_000;
  const nodes = names(length, (i) => (i + 1 < length ? { translation: [1, 0, 0], children: [i + 1] } : { mesh: 0 }));
  const [last, ...more] = geometry(triangle((json) => void (json.nodes = nodes)));
  assert.deepEqual([more.length, last.model[12]], [0, length - 1]);
  const order = [];
  eachNode(opened({
    nodes: [{ name: 'a', children: [3, 1] }, { name: 'b', children: [4] }, { name: 'c' }, { name: 'd', children: [2, 4] }, { name: 'e', children: [0] }],
    scenes: [{ nodes: [0, 2, 1] }],
  }), ({ name }) => order.push(name));
  assert.equal(order.join(''), 'adceb');
});

/** All that a file is asked for. */
function readAll(file) {
  const drawables = geometry(file);
  for (const { model, normal, attributes, indices, material } of drawables) {
    assert.ok(Number.isInteger(material) && material >= -1);
    assert.ok([...model, ...normal].every(Number.isFinite), 'a place is no number');
    const vertices = attributes.get('POSITION').data.length / 3;
    for (const { data, size } of attributes.values()) assert.equal(data.length, size * vertices);
    assert.ok(indices.every((i) => i < vertices));
  }
  const { middle, radius } = bounds(drawables);
  if (drawables.length > 0) assert.ok([...middle, radius].every(Number.isFinite), 'the bounds are no numbers');
  const lights = new FileLights(file).at(new Moves(file, [])).map(element);
  for (const light of lights) assert.ok(light.every(Number.isFinite), 'a light is no numbers');
  for (const index of [0, 1, -1, 0.5, '0', 'constructor', null]) bufferView(file, index);
  const source = sourceOf(Array.isArray(file.json.textures) ? file.json.textures[0] : undefined);
  assert.ok(Number.isInteger(source) && source >= -1);
  image(file, source);
  return { drawables: drawables.length, lights: lights.length };
}

const documentOf = (json) => new Document(
  { scene: () => ({ materialCount: 1, materialName: () => '', uses: () => [], free: () => undefined }) },
  { name: 'a.gltf', bytes: Buffer.from(JSON.stringify(json)), resources: new Map() },
);

test('what is of the wrong type is left out, and nothing beside it', () => {
  assert.deepEqual(readAll(triangle()), { drawables: 2, lights: 1 });
  const left = (drawables, change) => assert.equal(readAll(triangle(change)).drawables, drawables, String(change));
  left(0, ({ accessors }) => void (accessors[0].componentType = 'constructor'));
  left(0, ({ accessors }) => void (accessors[0].type = 'constructor'));
  left(0, ({ bufferViews }) => void (bufferViews[0].byteOffset = '0'));
  left(0, ({ bufferViews }) => void (bufferViews[0].byteLength = -36));
  left(0, ({ accessors }) => void (accessors[0].byteOffset = 1.5));
  left(0, ({ accessors }) => void (accessors[1].type = 'VEC3'));
  left(0, (json) => void (json.nodes = {}));
  left(0, (json) => void (json.scenes = [{ nodes: 3 }]));
  left(0, (json) => void (json.meshes = null));
  left(0, ({ meshes }) => void (meshes[0].primitives = 5));
  left(0, ({ nodes }) => void (nodes[0].translation = [1e300, 0, 0]));
  left(1, ({ nodes }) => void (nodes[0].children = 5));
  left(1, ({ nodes }) => void (nodes[0].children = [null, '1', 1.5, -1, {}, 'constructor']));
  left(1, ({ nodes }) => void (nodes[1].matrix[12] = 1e300));
  left(2, ({ nodes }) => void (nodes[0].rotation = 5));
  left(2, ({ nodes }) => void (nodes[1].matrix = [1, 2]));
  left(2, ({ nodes }) => void nodes[0].children.unshift(null));
  left(2, ({ meshes }) => void meshes[0].primitives.push(null, 5, 'x', [], {}, { attributes: null }, { attributes: { POSITION: null } }));
  left(2, ({ meshes }) => void meshes[0].primitives.push({ attributes: { POSITION: 0 }, material: 'x' }, { attributes: { POSITION: '0' } }));
  for (const json of ['null', '5', '"x"']) assert.throws(() => opened(json), /no object/);
  const far = triangle();
  far.binary = bytesOf(new Float32Array([NaN, 0, 0, 1, 0, 0, 0, 1, 0]), new Uint16Array([0, 1, 2]));
  assert.equal(readAll(far).drawables, 0, 'a position that is no number');
});

test('whatever is in the place of whatever value, the file opens', () => {
  const others = [
    null, true, 0, 5, -1, 1.5, 1e300, 4294967296, '', '0', 'x', 'constructor', '__proto__', [], [null], ['x', 1.5, -1, {}], {}, { length: 5 },
    { toString: 5, valueOf: 5 }, [[]], [1e300, 1e300, 1e300, 1e300],
  ];
  const places = (at, path = []) =>
    typeof at === 'object' && at !== null ? Object.entries(at).flatMap(([key, value]) => [[...path, key], ...places(value, [...path, key])]) : [];
  const all = places(triangle().json);
  assert.ok(all.length > 80);
  for (const path of all) {
    for (const other of [...others, undefined]) {
      const { json } = triangle((json) => {
        const last = path.at(-1);
        const at = path.slice(0, -1).reduce((at, key) => at[key], json);
        if (other === undefined) delete at[last];
        else at[last] = other;
      });
      const what = `${path.join('/')}: ${JSON.stringify(other)}`;
      assert.doesNotThrow(() => readAll(opened(json)), what);
      if (path[0] !== 'materials') assert.doesNotThrow(() => JSON.parse(documentOf(json).slim()), what);
    }
  }
});

test('what a file names is fetched, whatever else stands among the names', async () => {
  const json = { buffers: [null, 5, { uri: 5 }, { uri: {} }, { uri: 'data:,' }, {}], images: { uri: 'x' } };
  const { resources } = await fetchGltf(`data:model/gltf+json,${JSON.stringify(json)}`);
  assert.equal(resources.size, 0);
});

/** A server that answers by path, and what it was asked for. */
async function serving(answers) {
  const asked = [];
  const server = createServer((request, response) => {
    asked.push(request.url);
    const answer = answers[request.url];
    if (answer === undefined) response.writeHead(404).end();
    else if (typeof answer === 'function') answer(response);
    else response.end(answer);
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  const close = () => new Promise((done) => { server.closeAllConnections(); server.close(done); });
  return { at: `http://127.0.0.1:${server.address().port}`, asked, close };
}

const naming = (...uris) => JSON.stringify({ buffers: uris.map((uri) => ({ uri, byteLength: 1 })) });

test('a file has fetched what is below its folder, and nothing else', async () => {
  const other = await serving({ '/secret': 'no' });
  const redirect = (response) => response.writeHead(302, { location: `${other.at}/secret` }).end();
  const escapes = [
    '../up.bin', '/up.bin', '//127.0.0.1/up.bin', `${other.at}/secret`, 'file:///etc/passwd', '..%2fup.bin', '%2e%2e/up.bin', '..\\up.bin',
    'a/../../up.bin', 'http://user@127.0.0.1/up.bin', 'data.bin%00', 'redirect.bin', 'blob:x', 'ftp://127.0.0.1/x', '?', '#',
  ].filter((uri) => uri.length > 1);
  const files = { '/up.bin': 'no', '/folder/..%2fup.bin': 'no', '/folder/in.bin': 'yes', '/folder/deep/in.bin': 'yes', '/folder/redirect.bin': redirect };
  escapes.forEach((uri, i) => { files[`/folder/${i}.gltf`] = naming(uri); });
  files['/folder/good.gltf'] = naming('in.bin', 'deep/in.bin', 'deep/../in.bin');
  files['/folder/far.gltf'] = naming('../up.bin', `${other.at}/secret`);
  const server = await serving(files);
  for (const [i, uri] of escapes.entries()) await assert.rejects(fetchGltf(`${server.at}/folder/${i}.gltf`), undefined, uri);
  assert.deepEqual(server.asked.filter((path) => path.includes('up.bin')), []);
  assert.deepEqual(other.asked, []);
  const good = await fetchGltf(`${server.at}/folder/good.gltf`);
  assert.equal(good.resources.size, 3);
  const far = await fetchGltf(`${server.at}/folder/far.gltf`, { allow: (url) => ['/up.bin', '/secret'].includes(url.pathname) });
  assert.equal(far.resources.size, 2);
  await Promise.all([server.close(), other.close()]);
});

test('what is fetched has an end in bytes, in requests and in time', async () => {
  const endless = (response) => {
    const more = () => response.destroyed || response.write(Buffer.alloc(65536), more);
    more();
  };
  const server = await serving({
    '/endless.gltf': endless, '/of.gltf': naming('endless.bin'), '/endless.bin': endless, '/slow.gltf': () => undefined,
    '/many.gltf': naming(...Array.from({ length: 600 }, (_, i) => `${i}.bin`)),
  });
  await assert.rejects(fetchGltf(`${server.at}/endless.gltf`, { maxBytes: 1e6 }), /more than 1000000 bytes/);
  await assert.rejects(fetchGltf(`${server.at}/of.gltf`, { maxBytes: 1e6 }), /more than 1000000 bytes/);
  await assert.rejects(fetchGltf(`${server.at}/many.gltf`), /more than 512 files/);
  assert.equal(server.asked.filter((path) => /\d+\.bin/.test(path)).length, 0);
  await assert.rejects(fetchGltf(`${server.at}/slow.gltf`, { timeout: 100 }), /more than 100 ms/);
  const stop = new AbortController();
  stop.abort(new Error('enough'));
  await assert.rejects(fetchGltf(`${server.at}/slow.gltf`, { signal: stop.signal }), /enough/);
  await server.close();
});

test('an accessor is read once for all primitives that have it, and not more numbers than fit', () => {
  const vertices = 2 ** 20;
  const corners = 3 * 2 ** 18;
  const of = (primitive, count) => opened({
    buffers: [{ byteLength: 12 * vertices }],
    bufferViews: [{ buffer: 0, byteLength: 12 * vertices }],
    accessors: [
      { bufferView: 0, componentType: 5126, type: 'VEC3', count: vertices }, { bufferView: 0, componentType: 5125, type: 'SCALAR', count: 3 },
      { bufferView: 0, componentType: 5125, type: 'SCALAR', count: corners },
    ],
    meshes: [{ primitives: names(count, () => primitive) }], nodes: [{ mesh: 0 }],
  }, new Uint8Array(12 * vertices));
  // All share what they have.
  const shared = geometry(of({ attributes: { POSITION: 0, NORMAL: 0 }, indices: 1 }, 1000));
  assert.equal(shared.length, 1000);
  assert.equal(new Set(shared.flatMap(({ attributes }) => [...attributes.values()].map(({ data }) => data.buffer))).size, 1);
  assert.equal(new Set(shared.map(({ indices }) => indices)).size, 1);
  timed(() => bounds(shared));
  // What is made for each, or gone through for each, has an end: normals, strips, indices.
  const most = 2 ** 26;
  for (const primitive of [
    { attributes: { POSITION: 0 }, indices: 1 }, { attributes: { POSITION: 0, NORMAL: 0 }, indices: 2, mode: 5 },
    { attributes: { POSITION: 0, NORMAL: 0 }, indices: 2 }, { attributes: { POSITION: 0, NORMAL: 0 } },
  ]) {
    const found = timed(() => geometry(of(primitive, 1000)));
    const buffers = new Set(found.flatMap(({ attributes, indices }) => [indices.buffer, ...[...attributes.values()].map(({ data }) => data.buffer)]));
    const held = [...buffers].reduce((sum, { byteLength }) => sum + byteLength / 4, 0);
    assert.ok(found.length > 5 && found.length < 100 && held <= most, `${found.length} primitives with ${held} numbers: ${JSON.stringify(primitive)}`);
  }
  // So have accessors, of which each is a copy.
  const file = of({}, 0);
  file.json.accessors = names(1000, () => file.json.accessors[0]);
  file.json.meshes[0].primitives = names(1000, (i) => ({ attributes: { POSITION: i, NORMAL: i }, indices: i }));
  for (const each of file.json.meshes[0].primitives) delete each.indices;
  assert.ok(geometry(file).length < 22);
});

test('a pointer leads to what the file has itself, and to nothing that all objects inherit', () => {
  const material = { pbrMetallicRoughness: { baseColorFactor: [1, 0.5, 0.25, 1] }, alphaMode: 'BLEND' };
  const json = { asset: { version: '2.0' }, materials: [material, {}] };
  const of = documentOf(json);
  assert.equal(of.get('/materials/0/pbrMetallicRoughness/baseColorFactor/1'), 0.5);
  const wrong = [
    '/__proto__/x', '/materials/__proto__/x', '/materials/0/__proto__/x', '/__proto__', '/materials/0/__proto__', '/materials/length', '/materials/x',
    '/materials/push/x', '/materials/9/x', '/materials/0/alphaMode/x', '/materials/0/alphaMode/length', '', 'materials',
  ];
  for (const pointer of wrong) {
    of.set(pointer, 7, pointer);
    of.set(pointer, undefined, `${pointer} away`);
    if (pointer.startsWith('/')) assert.equal(of.get(pointer), undefined, pointer);
    assert.deepEqual(of.json, json, pointer);
    assert.equal({}.x ?? [].x ?? ''.x, undefined, pointer);
  }
  assert.equal(of.canUndo, false);
  for (const name of ['constructor', 'toString', 'hasOwnProperty']) {
    assert.equal(of.get(`/materials/0/${name}`), undefined);
    of.set(`/materials/1/${name}/prototype/x`, 7, name);
    assert.equal(of.get(`/materials/1/${name}/prototype/x`), 7, 'an object of its own');
    assert.equal(Object.x ?? Object.prototype[name].prototype?.x, undefined);
  }
  of.set('/materials/0/pbrMetallicRoughness/baseColorFactor/1', 0.75, 'a');
  of.set('/materials/0/extensions/KHR_materials_coat/coatFactor', 0.5, 'b');
  of.set('/materials/0/alphaMode', undefined, 'c');
  assert.deepEqual(of.json.materials[0], {
    pbrMetallicRoughness: { baseColorFactor: [1, 0.75, 0.25, 1] }, extensions: { KHR_materials_coat: { coatFactor: 0.5 } },
  });
});

test('a .glb of version 3 has buffers in the chunks that they name', () => {
  const number = (value, bytes) => {
    const made = Buffer.alloc(bytes);
    bytes === 8 ? made.writeBigUInt64LE(BigInt(value)) : made.writeUInt32LE(value);
    return made;
  };
  const glb3 = (...chunks) => {
    let all = Buffer.alloc(0);
    for (const [type, data] of chunks) {
      all = Buffer.concat([all, Buffer.alloc((8 - (all.length % 8)) % 8)]);
      all = Buffer.concat([all, Buffer.from(type.padEnd(4, '\0')), number(0, 4), number(data.length, 8), Buffer.from(data)]);
    }
    return Buffer.concat([Buffer.from('glTF'), number(3, 4), number(16 + all.length, 8), all]);
  };
  const json = (...buffers) => JSON.stringify({
    asset: { version: '2.1' }, buffers, bufferViews: buffers.map((_, buffer) => ({ buffer, byteOffset: 1, byteLength: 2 })),
  });
  const text = (file, index) => {
    const bytes = bufferView(file, index);
    return bytes && Buffer.from(bytes).toString();
  };
  const named = openGltf('a.glb', glb3(['mine', '12345'], ['BIN', 'abcd'], ['JSON', json({ chunk: 1 }, { chunk: 3 }, { chunk: 0 }, {})], ['BIN', 'efgh']));
  assert.deepEqual([0, 1, 2].map((i) => text(named, i)), ['bc', 'fg', null]);
  assert.equal(text(openGltf('a.glb', glb3(['JSON', json({})], ['BIN', 'abcd'])), 0), 'bc');
  assert.throws(() => openGltf('a.glb', glb3(['BIN', 'abcd'])), /no JSON/);
  for (let size = 0; size < 40; ++size) assert.throws(() => openGltf('a.glb', glb3(['JSON', json({})]).subarray(0, size)));
});
