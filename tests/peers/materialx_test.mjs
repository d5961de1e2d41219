// `node --test tests/peers/materialx_test.mjs`: MaterialX as a peer. What needs its module is skipped where that is not there.
import assert from 'node:assert/strict';
import { dirname, join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { openMaterialX, shadersOf, withConstants } from '../../bench/peers/materialx.mjs';
import { record, section } from '../../bench/peers/report.mjs';
import { asFor, kPeers, kWorks } from '../../bench/peers/works.mjs';

const kRoot = join(dirname(fileURLToPath(import.meta.url)), '../..');
const kMaterial = `<materialx version="1.39" colorspace="lin_rec709">
  <gltf_colorimage name="color" type="multioutput">
    <input name="file" type="filename" value="color.png" colorspace="srgb_texture"/>
  </gltf_colorimage>
  <gltf_image name="rough" type="float"><input name="file" type="filename" value="rough.png"/></gltf_image>
  <gltf_pbr name="surface" type="surfaceshader">
    <input name="base_color" type="color3" nodename="color" output="outcolor"/>
    <input name="roughness" type="float" nodename="rough"/>
    <input name="metallic" type="float" value="0.25"/>
  </gltf_pbr>
  <surfacematerial name="m" type="material"><input name="surfaceshader" type="surfaceshader" nodename="surface"/></surfacematerial>
</materialx>
`;

test('numbers become constants, textures and what the application sets stay uniforms', () => {
  const text = 'uniform mat4 u_matrix;\nuniform sampler2D image;\nuniform vec3 color;\nuniform float ior;\n' +
    '  uniform float inner;\nin vec3 ior2;\n';
  const values = { color: '0.8, 0.3, 0.1', ior: '1.5', image: 'a.png', inner: '1' };
  assert.equal(withConstants(text, values), 'uniform mat4 u_matrix;\nuniform sampler2D image;\nconst vec3 color = vec3(0.8, 0.3, 0.1);\n' +
    'const float ior = float(1.5);\n  uniform float inner;\nin vec3 ior2;\n');
});

/** Figures that only tell peers apart. */
function measured(peers) {
  const gpu = { instructions: 10, inverse_throughput: 20 }, colors = { mean: 0.1, max: 0.2, mean_of_ours: 0.3 };
  const each = Object.fromEntries(peers.map(({ name }) => [name, { navi21: gpu, colors, bytes: 12345, driver_ms: 6.25, fragment_ns: 432.1 }]));
  return record({
    driver: 'Mesa', versions: Object.fromEntries(peers.map((peer) => [peer.package, '1.2'])),
    results: Object.fromEntries(kWorks.map(({ name }) => [name, each])),
    ours: Object.fromEntries(kWorks.map(({ name }) => [name, { bytes: 6789, driver_ms: 3, fragment_ns: 98.76 }])), device: 'llvmpipe',
  });
}

test('where MaterialX is not there, the tables go without it', () => {
  const ours = Object.fromEntries(kWorks.map(({ name }) => [name, { instructions: 5, inverse_throughput: 5 }]));
  const others = kPeers.filter(({ environment }) => !environment);
  assert.equal(kPeers.length - others.length, 2);
  assert.match(section(measured(kPeers), ours), /\| work \| Lacquer \|.* MaterialX \(sampled\) \| MaterialX \(prefiltered\) \|/);
  const without = section(measured(others), ours);
  assert.doesNotMatch(without, /MaterialX|undefined|failed/);
  assert.match(without, /\| W3 \| \*\*6.8 \/ 3.0\*\* \| \(12.3 \/ 6.3\) \| \(12.3 \/ 6.3\) \| \(12.3 \/ 6.3\) \| 12.3 \/ 6.3 \|\n/);
  assert.match(without, /on llvmpipe:/);
  assert.match(without, /\| W3 \| \*\*98.8\*\* \| \(432\) \| \(432\) \| \(432\) \| 432 \|\n/);
  assert.match(without, /\| W3 \| \*\*5 \/ 5\*\* \| \(10 \/ 20\) \| \(10 \/ 20\) \| \(10 \/ 20\) \| 10 \/ 20 \| 50 % \/ 25 % \|/);
});

test('a folder without the module is told', async () => assert.equal(await openMaterialX(join(kRoot, 'bench')), null));

test('its lobes get tangents, the work stays as it is', () => {
  const work = { meshes: [{ primitives: [{ attributes: { POSITION: 0 }, material: 0 }] }] };
  const peer = kPeers.find(({ environment }) => environment);
  const attributes = (of) => Object.keys(of.meshes[0].primitives[0].attributes);
  assert.deepEqual(attributes(asFor(peer, 'w0', work)), ['POSITION', 'NORMAL', 'TANGENT', 'TEXCOORD_0']);
  assert.deepEqual(attributes(work), ['POSITION']);
});

const mx = await openMaterialX(process.env.LACQUER_MATERIALX ?? join(kRoot, '../shared/peers/materialx'));
test('the generator writes WebGL 2 with the numbers in it', { skip: mx ? false : 'MaterialX is not there' }, async () => {
  const { fragment, vertex, textures } = await shadersOf(mx, kMaterial, 'prefiltered');
  assert.match(vertex, /^#version 300 es/);
  assert.match(fragment, /^#version 300 es/);
  assert.deepEqual(textures, { color_file: { file: 'color.png', srgb: true }, rough_file: { file: 'rough.png', srgb: false } });
  assert.match(fragment, /const int u_numActiveLightSources = int\(1\);/);
  assert.match(fragment, /uniform sampler2D color_file;/);
  assert.doesNotMatch(fragment, /uniform (float|vec[234]|int|bool) (?!u_(envLightIntensity|envRadianceMips|viewPosition))|NG_srgb_texture/);
  assert.match((await shadersOf(mx, kMaterial, 'sampled')).fragment, /const int u_envRadianceSamples = int\(16\);/);
  const direct = (await shadersOf(mx, kMaterial, 'none')).fragment;
  assert.doesNotMatch(direct, /uniform \w+ u_env/);
  assert.match(direct, /const bool u_refractionTwoSided = bool\(false\);/);
  await assert.rejects(shadersOf(mx, '<materialx', 'none'), /MaterialX/);
});
