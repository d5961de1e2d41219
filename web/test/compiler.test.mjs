// The package's /compiler: what it makes is what the whole module makes, and what it has not it says.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { before, test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { inputs, output, read, root } from './native.mjs';

const { load, LacquerError } = await import(join(output, 'package/compiler.js'));
const whole = await import(join(output, 'package/index.js'));
const kTargets = ['glsl', 'glsl-gl', 'essl', 'hlsl', 'wgsl', 'spirv', 'cpp', 'js'];
const kStages = ['vertex', 'fragment'];
/** Bytes of lacquer-compiler.wasm after gzip. */
const kMostBytes = 943_000;

let compiler;
let all;
before(async () => {
  compiler = await load();
  all = await whole.load();
});

/** What is made of a use of a material, or what was said. */
function madeOf(library, bytes, name) {
  const messages = [];
  const made = [];
  try {
    const scene = library.scene(bytes, name, undefined, messages);
    for (let material = 0; material < scene.materialCount; ++material) {
      const use = scene.uses(material)[0];
      const graph = scene.graph(material, undefined, use, messages);
      const shader = graph.generate({ targets: kTargets }, messages);
      made.push(scene.materialName(material), scene.properties(material, undefined, use), graph.toText(), graph.parameters(), graph.textures());
      made.push(shader.id, shader.interface, [...shader.pack()], [...shader.packGraph(graph)]);
      for (const stage of kStages) made.push(...kTargets.map((target) => shader.text(target, stage)), [...shader.spirv(stage)]);
      for (const handle of [shader, graph]) handle.free();
    }
    scene.free();
  } catch (error) {
    if (!(error instanceof LacquerError)) throw error;
    made.push(error.messages);
  }
  return { made, messages };
}

for (const file of inputs()) {
  test(`${file.slice(file.lastIndexOf('/') + 1)}: what the whole module makes of it`, () => {
    const bytes = read(file);
    const name = file.slice(file.lastIndexOf('/') + 1);
    assert.deepEqual(madeOf(compiler, bytes, name), madeOf(all, bytes, name));
  });
}

test('nodes, graphs with numbers set, own nodes, checks and dumps are those of the whole module', () => {
  const node_texts = { 'own.node': '/// Two of it.\n/// source: none, "none"\nnode twice(float x = 1) -> float {\n  return x + x;\n}\n' };
  const json = { lacquer: 1, template: 'forward', nodes: [{ id: 'a', type: 'twice', inputs: { x: 0.25 } }] };
  const of = (library) => {
    const graph = library.scene(read('examples/coat.gltf'), 'coat.gltf').graph(0);
    graph.setParameter('coat_roughness_factor', 0.75);
    graph.setRange('coat_factor', 0, 0.95);
    const said = [];
    let own;
    try {
      own = library.graph(json, 'own.json', said, { node_texts }).toText();
    } catch (error) {
      own = error.messages;
    }
    return [library.nodes(), library.nodes({ node_texts }), graph.changes(), graph.toText(), graph.toDot(), graph.nodes(), graph.outputs(), graph.sockets(), graph.groups(), graph.check(), graph.dump(), own, said, library.environmentDfg(8), library.environmentSheen(8)];
  };
  assert.deepEqual(of(compiler), of(all));
});

test('what it has not throws, and says which entry has it', () => {
  const scene = compiler.scene(read('examples/coat.gltf'), 'coat.gltf');
  const graph = scene.graph(0);
  const calls = {
    evaluate: () => scene.evaluate(0, [{ l: [0, 0, 1] }]),
    preview: () => graph.preview(64),
    materialx: () => scene.toMaterialX(),
    gltf: () => scene.toGltf(),
    edit: () => graph.edit({ do: 'set_value', parameter: 'coat_factor', value: 0.5 }),
    add_node: () => graph.addNode('a', 'multiply'),
    environment_filter: () => compiler.environment(new Uint8Array(4), 'a.hdr'),
    check_nodes: () => compiler.checkNodes({}),
  };
  for (const [name, call] of Object.entries(calls)) {
    assert.throws(call, (error) => {
      assert.ok(error instanceof LacquerError, `${name}: ${error}`);
      assert.equal(error.messages[0].code, 'not-in-compiler', name);
      assert.match(error.message, new RegExp(`${name}\\(\\)[^]*main entry`));
      assert.equal(error.message.includes('setParameter()'), name === 'edit');
      return true;
    }, name);
  }
});

test('of MaterialX it says where that is read, and of procedural textures it takes the fallback', () => {
  const code = (expected) => (error) => error.messages.some(({ code, help }) => code === expected && help.includes('main entry'));
  assert.throws(() => compiler.scene('<?xml version="1.0"?>\n<materialx version="1.39"/>', 'a.mtlx'), code('not-in-compiler'));
  assert.throws(() => compiler.scene('{}', 'a.gltf', { materialx_texts: { 'own.mtlx': '<materialx/>' } }), code('not-in-compiler'));
  const file = (extensionsRequired) => JSON.stringify({
    asset: { version: '2.0' }, extensionsUsed: ['KHR_texture_procedurals'], extensionsRequired,
    extensions: { KHR_texture_procedurals: { procedurals: [{ name: 'a' }] } },
    images: [{ uri: 'a.png' }], textures: [{ source: 0 }],
    materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0, extensions: { KHR_texture_procedurals: { index: 0 } } } } }],
  });
  const messages = [];
  const scene = compiler.scene(file(undefined), 'a.gltf', undefined, messages);
  const graph = scene.graph(0, undefined, undefined, messages);
  assert.deepEqual(graph.textures().map(({ name }) => name), ['base_color_texture']);
  assert.deepEqual([...new Set(messages.map(({ level }) => level))], ['warning']);
  assert.ok(messages.some(({ code }) => code === 'not-in-compiler'), JSON.stringify(messages));
});

test('it is small enough to be sent', () => {
  const wasm = readFileSync(join(output, 'package/lacquer-compiler.wasm'));
  const packed = gzipSync(wasm, { level: 9 }).length;
  const words = [join(root, 'web/test/first.mjs'), join(root, 'examples/car_paint.gltf'), 'compiler'];
  const { loaded, first, later } = JSON.parse(execFileSync(process.execPath, words, { encoding: 'utf8' }));
  console.log(`# lacquer-compiler.wasm: ${wasm.length} bytes, ${packed} after gzip; loaded in ${loaded.toFixed(1)} ms, the first material ${first.toFixed(1)} ms, later ones ${later.toFixed(2)} ms`);
  assert.ok(packed <= kMostBytes, `${packed} bytes after gzip`);
});
