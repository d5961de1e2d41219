// The package in Node: what it makes is what the native program makes, to the byte.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { before, test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { inputs, lacquer, output, read, root, withExamples, withFolder, withImages } from './native.mjs';

const { load, LacquerError, kUnusedAttributes } = await import(join(output, 'package/index.js'));
const kExtensions = { glsl: 'glsl', 'glsl-gl': 'glsl', essl: 'glsl', hlsl: 'hlsl', wgsl: 'wgsl' };
const kTargets = [...Object.keys(kExtensions), 'spirv'];
const kStages = { vertex: 'vert', fragment: 'frag' };
/** Bytes of lacquer.wasm after gzip: what the library takes today and a twentieth more. */
const kMostBytes = 1_490_000;

let library;
before(async () => {
  library = await load();
});

function codeOf(shader) {
  const files = {};
  for (const [stage, short] of Object.entries(kStages)) {
    for (const [target, extension] of Object.entries(kExtensions)) {
      const text = shader.text(target, stage);
      if (text !== '') files[`${target}/${shader.id}.${short}.${extension}`] = Buffer.from(text);
    }
    const words = shader.spirv(stage);
    if (words.length > 0) files[`spirv/${shader.id}.${short}.spv`] = Buffer.from(words.buffer);
  }
  return files;
}

for (const file of inputs()) {
  test(`${file.slice(file.lastIndexOf('/') + 1)}: ids, texts and SPIR-V are the native program's`, () => withFolder((folder) => {
    try {
      lacquer('gen', '-q', '--no-validate', '--no-sync', '--unused', '--target', kTargets.join(','), file, '-o', folder);
    } catch (error) {
      if (error.status == null) throw error; // it did not start, or was killed
      if (!existsSync(join(folder, 'manifest.json'))) {
        // What the program refuses, the module refuses.
        assert.throws(() => library.scene(read(file), file), LacquerError);
        return;
      }
    }
    const manifest = JSON.parse(readFileSync(join(folder, 'manifest.json'), 'utf8'));
    const scene = library.scene(read(file), file);
    let compared = 0;
    for (const material of manifest.files[0].materials) {
      if (material.index < 0) continue; // the default material of primitives without one
      assert.equal(scene.materialName(material.index), material.name);
      for (const use of material.uses) {
        const graph = scene.graph(material.index, { targets: kTargets }, use.attributes);
        const shader = graph.generate({ targets: kTargets });
        assert.equal(shader.id, use.shader);
        for (const [name, bytes] of Object.entries(codeOf(shader))) {
          assert.ok(bytes.equals(readFileSync(join(folder, name))), name);
          ++compared;
        }
        shader.free();
        graph.free();
      }
    }
    scene.free();
    const expected = manifest.files[0].materials.some(({ index, uses }) => index >= 0 && uses.length > 0);
    assert.ok(compared > 0 || !expected);
  }));
}

test('packed bytes are those of the values in the manifest', () => withExamples(['essl'], (folder, manifest) => {
  let compared = 0;
  for (const file of manifest.files) {
    const scene = library.scene(read(join(folder, file.source)), file.source);
    for (const material of file.materials) {
      for (const use of material.uses) {
        const graph = scene.graph(material.index, { targets: ['essl'] }, use.attributes);
        const shader = graph.generate({ targets: ['essl'] });
        const block = new DataView(shader.pack().buffer);
        const described = shader.interface.uniforms.find(({ role }) => role === 'material');
        assert.equal(block.byteLength, described?.size ?? 0);
        for (const { name, offset } of described?.fields ?? []) {
          [use.uniforms[name]].flat().forEach((value, i) => {
            assert.equal(block.getFloat32(offset + 4 * i, true), Math.fround(value), `${shader.id} ${name}`);
            ++compared;
          });
        }
        shader.free();
        graph.free();
      }
    }
    scene.free();
  }
  assert.ok(compared > 100);
}));

test('colours are those of `lacquer eval`', () => {
  const points = [{ v: [0, 0, 1], l: [0, 0.6, 0.8] }, { v: [0, 0.6, 0.8], l: [0.6, 0, 0.8], env: [0.3, 0.4, 0.5] }];
  for (const engine of ['double', 'float']) withFolder((folder) => {
    const scene = library.scene(withImages(read('examples/coat.gltf')), 'examples/coat.gltf');
    for (let i = 0; i < scene.materialCount; ++i) {
      const name = scene.materialName(i);
      const words = ['--material', name, '--engine', engine, '--points', writePoints(folder, points)];
      const native = JSON.parse(lacquer('eval', 'examples/coat.gltf', ...words));
      const mine = scene.evaluate(i, points, { engine });
      mine.rgba.flat().forEach((x, k) => {
        const y = native.rgba.flat()[k];
        // The same formulas over another mathematical library: a few units in the last place.
        assert.ok(Math.abs(x - y) <= (engine === 'double' ? 1e-12 : 1e-5) * Math.max(Math.abs(y), 1e-3), `${name} ${x} ${y}`);
      });
    }
    scene.free();
  });
});

test('a graph shows what its material shows, and what is edited of it', () => {
  const scene = library.scene(withImages(read('examples/coat.gltf')), 'examples/coat.gltf');
  const all = ['NORMAL', 'TANGENT', 'COLOR_0', 'TEXCOORD_0', 'TEXCOORD_1', 'TEXCOORD_2', 'TEXCOORD_3'];
  const points = [{ v: [0, 0.6, 0.8], l: [0.6, 0, 0.8], env: [0.3, 0.4, 0.5] }];
  const graph = scene.graph(0, {}, all);
  assert.deepEqual(graph.evaluate(points).rgba, scene.evaluate(0, points).rgba);
  assert.deepEqual(graph.preview(32), scene.preview(0, 32));
  const before = graph.evaluate(points).rgba;
  graph.setParameter('coat_roughness_factor', 0.75);
  assert.notDeepEqual(graph.evaluate(points).rgba, before);
  assert.throws(() => graph.evaluate(points, { profile: 'physical' }), /graph-is-built/);
  graph.free();
  scene.free();
});

test('matrices are parameters and attributes of graphs', () => {
  const graph = library.graph(`{"lacquer_graph": 1, "name": "matrices", "template": "forward",
  "parameters": {"m": {"type": "mat3", "value": [1, 0, 0, 0, 1, 0, 0, 0, 1]}},
  "nodes": [
    {"id": "a", "node": "transformmatrix", "inputs": {"in": [1, 2, 4], "mat": {"parameter": "m"}}},
    {"id": "b", "node": "transformmatrix", "inputs": {"in": {"node": "a"}, "mat": {"attribute": "_FRAME", "type": "mat3"}}},
    {"id": "c", "node": "max", "inputs": {"in1": {"node": "b"}, "in2": [0, 0, 0]}}],
  "outputs": {"emission": {"node": "c"}}}`);
  assert.deepEqual(graph.parameters()[0].value, [1, 0, 0, 0, 1, 0, 0, 0, 1]);
  const frame = [2, 0, 0, 0, 2, 0, 0, 0, 2];
  assert.deepEqual(graph.evaluate([{ _FRAME: frame }]).rgba[0].slice(0, 3), [2, 4, 8]);
  graph.setParameter('m', [0, 0, 1, 0, 1, 0, 1, 0, 0]);
  assert.deepEqual(graph.evaluate([{ _FRAME: frame }]).rgba[0].slice(0, 3), [8, 4, 2]);
  const shader = graph.generate();
  assert.equal(shader.pack({ m_0: [1, 2, 3] }).length, shader.uniformSize);
  assert.throws(() => graph.setParameter('m', [1, 2, 3]), /wrong-count/);
  graph.free();
});

test('a ball is drawn', () => {
  const scene = library.scene(read('examples/core.gltf'), 'core.gltf');
  const rgba = scene.preview(0, 32);
  assert.equal(rgba.length, 4 * 32 * 32);
  assert.notDeepEqual([...rgba.slice(0, 4)], [...rgba.slice(4 * (16 * 32 + 16), 4 * (16 * 32 + 16) + 4)]);
  assert.throws(() => scene.preview(0, 3), /out-of-range/);
  scene.free();
});

/** Numbers in [0, 1) that are the same in every run. */
const numbers = (seed) => () => {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 2 ** 32;
};

/** A tool's session: what it does to a graph in its hundred steps, each an edit in its JSON form. */
class Session {
  constructor(graph) {
    this.graph = graph;
    this.random = numbers(7);
  }

  choice(list) {
    return list[Math.floor(this.random() * list.length)];
  }

  /** What takes values from a node, as the edits that connect it again. */
  users(node) {
    const inputs = this.graph.nodes().flatMap(({ id, inputs }) =>
      Object.entries(inputs).map(([input, source]) => ({ do: 'connect', node: id, input, source })));
    const outputs = Object.entries(this.graph.outputs()).map(([output, source]) => ({ do: 'set_output', output, source }));
    return [...inputs, ...outputs].filter(({ source }) => source?.node === node);
  }

  setValue() {
    const { name, value, range } = this.choice(this.graph.parameters());
    const low = range?.[0] ?? 0;
    const number = () => low + ((range?.[1] ?? low + 1) - low) * this.random();
    const other = typeof value === 'boolean' ? !value : Array.isArray(value) ? value.map(number) : number();
    return { do: 'set_value', parameter: name, value: other };
  }

  /** A node like one that is used, beside it. */
  addCopy(step) {
    const { id, node, inputs } = this.choice(this.graph.nodes().filter((one) => one.node && this.users(one.id).length > 0));
    [this.copied, this.copy] = [id, `tool.n${step}`];
    return { do: 'add_node', node: { id: this.copy, node, inputs } };
  }

  useCopy() {
    const edit = this.choice(this.users(this.copied));
    return { ...edit, source: { ...edit.source, node: this.copy } };
  }

  /** An input that has a default; no texture falls out of use. */
  disconnect() {
    const inputs = this.graph.nodes().flatMap(({ id }) => this.graph.sockets(id).inputs.map((one) => ({ ...one, node: id })));
    const plain = inputs.filter(({ optional, source }) => optional && (typeof source === 'number' || source?.parameter));
    if (plain.length === 0) return this.setValue();
    const { node, name } = this.choice(plain);
    return { do: 'disconnect', node, input: name };
  }

  edit(step) {
    const before = this.copy;
    switch (step % 10) {
      case 1: return this.addCopy(step);
      case 2: return this.useCopy();
      case 3:
        this.copy = `my.n${step}`;
        return { do: 'rename_node', node: before, to: this.copy };
      case 4:
        this.group = `group_${step}`;
        return { do: 'make_group', nodes: [this.copy], group: this.group, node: 'instance' };
      case 5: return { do: 'set_ui', group: this.group, ui: { x: step, note: 'ä' } };
      case 6: return [{ do: 'expand', node: 'instance' }, { do: 'remove_group', group: this.group }];
      case 7: return this.disconnect();
      default: return this.setValue();
    }
  }

  /** What cannot be done throws, and changes nothing. */
  refused() {
    const { graph } = this;
    const before = graph.toText();
    const { id } = graph.nodes()[0];
    assert.throws(() => graph.addNode(id, 'schlick'), /duplicate-name/);
    assert.throws(() => graph.connect(id, 'no_such_input', 1), /unknown-input/);
    assert.throws(() => graph.renameNode('nobody', 'body'), /no-such-node/);
    assert.throws(() => graph.setOutput('nowhere', 1), /unknown-port/);
    assert.throws(() => graph.addInstance('x', 'no_such_group'), /unknown-group/);
    assert.throws(() => graph.edit([{ do: 'set_name', name: 'x' }, { do: 'fly' }]), /unknown-edit/);
    assert.equal(graph.toText(), before);
  }
}

test('a graph is edited for a hundred steps, and has the colours of the file that it is saved to after each', () => {
  const scene = library.scene(withImages(read('examples/coat.gltf')), 'examples/coat.gltf');
  const all = ['NORMAL', 'TANGENT', 'COLOR_0', 'TEXCOORD_0', 'TEXCOORD_1', 'TEXCOORD_2', 'TEXCOORD_3'];
  const graph = scene.graph(0, {}, all);
  const session = new Session(graph);
  const texels = graph.textures().map(({ name }) => `${name}=0.2,0.4,0.6,0.8`);
  const points = [{ v: [0, 0.6, 0.8], l: [0.6, 0, 0.8], env: [0.3, 0.4, 0.5] }];
  let shader = graph.generate({ targets: ['essl'] });
  const start = graph.toText();
  const back = [];
  const seen = new Set();
  let kept = 0;
  for (let step = 0; step < 100; ++step) {
    if (step % 10 === 9) session.refused();
    else back.push(graph.edit(session.edit(step)));
    const saved = library.graph(graph.toText());
    const colors = saved.evaluate(points, { texels }).rgba;
    assert.deepEqual(graph.evaluate(points, { texels }).rgba, colors);
    saved.free();
    seen.add(String(colors));
    const change = graph.changes();
    const packed = change === 'program' ? undefined : shader.packGraph(graph);
    const fresh = graph.generate({ targets: ['essl'] });
    assert.equal(graph.changes(), 'nothing');
    if (packed !== undefined) {
      assert.equal(fresh.id, shader.id);
      assert.deepEqual(fresh.pack(), packed);
      ++kept;
    }
    shader.free();
    shader = fresh;
  }
  assert.ok(kept > 33 && kept < 100 && seen.size > 10, `${kept} kept, ${seen.size} seen`);
  for (const edit of back.reverse()) graph.edit(edit);
  assert.equal(graph.toText(), start);
  for (const handle of [shader, graph, scene]) handle.free();
});

test('a shader packs the numbers of an edited graph', () => {
  const scene = library.scene(read('examples/coat.gltf'), 'coat.gltf');
  const graph = scene.graph(0);
  const shader = graph.generate({ targets: ['essl'] });
  graph.setParameter('coat_roughness_factor', 0.75);
  assert.equal(graph.changes(), 'numbers');
  assert.deepEqual(shader.packGraph(graph), shader.pack({ coat_roughness_factor: 0.75 }));
  for (const handle of [shader, graph, scene]) handle.free();
});

test('a graph is listed and grouped', () => {
  const scene = library.scene(read('examples/coat.gltf'), 'coat.gltf');
  const graph = scene.graph(0);
  const [node] = graph.nodes();
  const connected = graph.sockets(node.id).inputs.filter(({ source }) => source !== null);
  assert.deepEqual(connected.map(({ name }) => name).sort(), Object.keys(node.inputs).sort());
  assert.equal(graph.sockets().inputs.filter(({ source }) => source !== null).length, Object.keys(graph.outputs()).length);
  graph.makeGroup([node.id], 'folded', 'it');
  assert.deepEqual(graph.groups(), ['folded']);
  assert.deepEqual(graph.nodes('folded').map(({ id }) => id), [node.id]);
  assert.ok(Object.keys(graph.outputs('folded')).length > 0);
  graph.addInstance('again', 'folded');
  graph.renameNode('again', 'more');
  graph.removeNode('more');
  graph.expand('it');
  graph.addGroup('whole', scene.graph(0));
  assert.throws(() => graph.disconnect(graph.nodes()[0].id, 'nothing'), /not-connected/);
  assert.throws(() => graph.sockets('nobody'), /no-such-node/);
  graph.removeOutput(Object.keys(graph.outputs())[0]);
  graph.free();
  scene.free();
});

test('graphs are edited and checked', () => {
  const scene = library.scene(read('examples/coat.gltf'), 'coat.gltf');
  const graph = scene.graph(0);
  const text = graph.toText();
  assert.equal(library.graph(text).toText(), text);
  graph.addNode('mine', 'schlick');
  graph.connect('mine', 'F0', 0.04);
  assert.throws(() => graph.connect('nobody', 'F0', 0.04), /no-such-node/);
  assert.throws(() => graph.setOutput('alpha', { no: 1 }), LacquerError);
  graph.removeNode('mine');
  assert.deepEqual(graph.check(), []);
  assert.throws(() => graph.setOutput('nowhere', 1), /unknown-port/);
  for (const { id } of graph.nodes()) graph.removeNode(id);
  assert.equal(graph.check()[0].level, 'error');
  assert.throws(() => graph.generate(), LacquerError);
  assert.match(scene.graph(0).dump(), /; fragment/);
  const name = graph.parameters()[0].name;
  graph.setParameter(name, graph.parameters()[0].value);
  assert.throws(() => graph.setRange(name, 1, 0), /wrong-range/);
});

test('an environment is filtered to the files of the native program', () => withFolder((folder) => {
  const pixels = Array.from({ length: 8 }, (_, i) => [16 * i + 15, 64, 32, 129]).flat();
  const picture = Buffer.concat([Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n'), Buffer.from(pixels)]);
  writeFileSync(join(folder, 'sky.hdr'), picture);
  for (const [flags, form] of [[['--size', '32', '--samples', '64'], { size: 32, samples: 64 }], [['--draft'], { draft: true }]]) {
    lacquer('environment', join(folder, 'sky.hdr'), '-o', join(folder, 'sky'), ...flags);
    const { files, ...made } = library.environment(picture, 'sky.hdr', form);
    assert.deepEqual(made, JSON.parse(readFileSync(join(folder, 'sky/environment.json'), 'utf8')));
    for (const [slot, { file }] of Object.entries(made.textures))
      assert.ok(readFileSync(join(folder, 'sky', file)).equals(Buffer.from(files[slot])), slot);
  }
  assert.throws(() => library.environment(picture.subarray(0, -1), 'cut.hdr'), /cut\.hdr/);
  assert.throws(() => library.environment(picture, 'sky.hdr', { size: 33 }), /out-of-range/);
}));

test('what is wrong is a message of the library', () => {
  const wrong = [
    [() => library.scene('{"asset": ', 'broken.gltf'), /broken\.gltf:1:/],
    [() => library.scene('', 'empty.gltf'), /empty\.gltf/],
    [() => library.scene(read('examples/coat.gltf'), 'coat.gltf').graph(99), /no-such-material/],
    [() => library.scene(read('examples/coat.gltf'), 'coat.gltf', { colour: 1 }), /unknown-option/],
    [() => library.graph('[]'), LacquerError],
    [() => library.environmentDfg(1), /out-of-range/],
  ];
  for (const [call, expected] of wrong) assert.throws(call, expected);
  // The library lives on.
  assert.ok(library.scene(read('examples/coat.gltf'), 'coat.gltf').graph(0).generate().id);
});

test('names are not cut at a NUL, and may be many', () => {
  const scene = library.scene(read('examples/car_paint.gltf'), 'car_paint.gltf');
  const graph = scene.graph(0, { targets: ['essl'] });
  const shader = graph.generate({ targets: ['essl'] });
  for (const call of [
    () => library.scene('{}', 'a\0b'), () => graph.setParameter('coat_factor\0', 1), () => graph.addNode('x\0', 'schlick'),
    () => shader.pack({ 'coat_factor\0x': 1 }), () => shader.text('essl\0', 'fragment'),
  ]) assert.throws(call, { name: 'TypeError', message: /NUL/ });
  const many = Object.fromEntries(Array.from({ length: 20000 }, (_, i) => [`no_${i}`, i]));
  assert.deepEqual(shader.pack({ ...many, coat_factor: 0.25 }), shader.pack({ coat_factor: 0.25 }));
});

test('numbers outside of their ranges are packed as the nearest ones in them', () => {
  const scene = library.scene(read('examples/car_paint.gltf'), 'car_paint.gltf');
  const graph = scene.graph(0, { targets: ['essl'] });
  const shader = graph.generate({ targets: ['essl'] });
  const said = [];
  for (const x of [1.5, 1e39, 1e300, Infinity]) assert.deepEqual(shader.pack({ coat_roughness_factor: x }, said), shader.pack({ coat_roughness_factor: 1 }));
  assert.deepEqual(shader.pack({ coat_roughness_factor: NaN }, said), shader.pack());
  assert.deepEqual(said.map(({ code }) => code), [...Array(4).fill('out-of-range'), 'not-a-number']);
  for (const edit of [
    () => graph.setParameter('coat_factor', NaN), () => graph.setParameter('coat_factor', 1e39), () => graph.setRange('coat_factor', Infinity, Infinity),
  ]) assert.throws(edit, { name: 'LacquerError' });
});

test('long sessions take no more memory', () => {
  const bytes = read('examples/car_paint.gltf');
  const once = (value) => {
    const scene = library.scene(bytes, 'car_paint.gltf');
    const graph = scene.graph(0, { targets: ['essl'] });
    graph.setParameter('coat_roughness_factor', value);
    const shader = graph.generate({ targets: ['essl'] });
    const block = shader.pack({ coat_factor: value });
    for (const handle of [shader, graph, scene]) handle.free();
    return block.length;
  };
  for (let i = 0; i < 20; ++i) once(i / 20);
  const before = library.memory;
  for (let i = 0; i < 300; ++i) once(i / 300);
  assert.equal(library.memory, before);
});

test('the types say what a graph needs where nobody names attributes', () => {
  assert.deepEqual(kUnusedAttributes, ['NORMAL', 'TANGENT', 'TEXCOORD_0', 'TEXCOORD_1']);
});

test('what it was built without is said', () => {
  const scene = library.scene(read('examples/coat.gltf'), 'coat.gltf');
  const search = { targets: ['essl'], optimize: 1 };
  assert.throws(() => scene.graph(0).generate(search), (error) => error instanceof LacquerError && error.messages[0].code === 'no-search');
});

test('it is small enough to be sent', () => {
  const wasm = readFileSync(join(output, 'package/lacquer.wasm'));
  const packed = gzipSync(wasm, { level: 9 }).length;
  // How quick it is, is told: machines are busy.
  const { loaded, first, later } = JSON.parse(execFileSync(process.execPath, [join(root, 'web/test/first.mjs')], { encoding: 'utf8' }));
  console.log(`# lacquer.wasm: ${wasm.length} bytes, ${packed} after gzip; loaded in ${loaded.toFixed(1)} ms, the first material ${first.toFixed(1)} ms, later ones ${later.toFixed(2)} ms`);
  assert.ok(packed <= kMostBytes, `${packed} bytes after gzip`);
});

function writePoints(folder, points) {
  const file = join(folder, 'points.json');
  writeFileSync(file, JSON.stringify(points));
  return file;
}
