// `node --test tests/peers/fragments_test.mjs`: what a shader is given when its fragments are timed.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { vulkanGlsl } from '../../bench/peers/convert.mjs';
import { inputValues, interfaceOf, ourBound, sweepOf } from '../../bench/peers/fragments.mjs';

const kSource = `#version 300 es
precision highp float;
struct Light { vec3 direction; float intensity; int type; };
uniform Light lights[2];
uniform mat3 turn;
uniform float steps[2];
uniform sampler2D color_map;
uniform samplerCube surroundings;
layout(std140) uniform Scene { mat4 view; vec3 eye; };
in mat3 vTBN;
in vec3 vPositionW;
in vec2 vMainUV1;
layout(location = 0) out vec4 color;
void main() {
  vec3 n = turn * vTBN * lights[1].direction * lights[0].intensity * steps[1];
  if (lights[1].type == 1) n += eye;
  color = texture(color_map, vMainUV1) + texture(surroundings, n + vPositionW);
}
`;

const glslang = spawnSync('glslangValidator', ['--version']);
const skip = glslang.error && 'glslangValidator is not installed';

function compiled(use) {
  const folder = mkdtempSync(join(tmpdir(), 'lacquer-peers-'));
  try {
    writeFileSync(join(folder, 'x.frag'), vulkanGlsl(kSource));
    const file = join(folder, 'x.spv');
    execFileSync('glslangValidator', ['-V', '-R', '--auto-map-bindings', '--auto-map-locations', '-o', file, join(folder, 'x.frag')]);
    return use(file);
  } finally {
    rmSync(folder, { recursive: true });
  }
}

test('what the page had bound stands where the shader reads it', { skip }, () => compiled((file) => {
  const uniforms = {
    'lights[0].intensity': 3, 'lights[1].direction': [0.25, 0.5, 0.75], 'lights[1].type': 1, turn: [1, 2, 3, 4, 5, 6, 7, 8, 9], 'steps[1]': 2.5,
  };
  const scene = [...Array(80).keys()], sweep = sweepOf(file, { uniforms, blocks: { Scene: scene } });
  const { blocks } = interfaceOf(readFileSync(file)), lone = blocks.findIndex(({ type }) => type.name === 'gl_DefaultUniformBlock');
  assert.equal(blocks.length, 2);
  assert.deepEqual(sweep.blocks[1 - lone].bytes, scene);
  // By std140: a light takes 32 bytes, a column of the matrix 16, an element of the array 16.
  const bytes = Buffer.from(sweep.blocks[lone].bytes), float = (at) => bytes.readFloatLE(at);
  assert.equal(float(12), 3);
  assert.deepEqual([32, 36, 40].map(float), [0.25, 0.5, 0.75]);
  assert.equal(bytes.readInt32LE(48), 1);
  assert.deepEqual([64, 68, 72, 80, 96, 104].map(float), [1, 2, 3, 4, 7, 9]);
  assert.equal(float(112 + 16), 2.5);
  assert.equal(float(0), 0);
  assert.deepEqual(sweep.textures.map(({ shape }) => shape).sort(), ['cube', 'plane']);
  const places = [...sweep.textures, ...sweep.blocks].map(({ set, binding }) => `${set}.${binding}`);
  assert.equal(new Set(places).size, 4);
  assert.deepEqual(sweep.inputs.map(({ components }) => components), [3, 3, 3, 3, 2]);
}));

test('inputs are the middle of the ball, by their names', () => {
  const vector = (name, count) => inputValues({ name, type: { kind: 'vector', count } })[0].values;
  const [x, y, z] = vector('v_Normal', 3);
  assert.ok(x < 0 && y > 0 && Math.abs(Math.hypot(x, y, z) - 1) < 1e-12);
  assert.deepEqual(vector('vPositionW', 3), vector('normalWorld', 3));
  assert.deepEqual(vector('v_texcoord_0', 2), [0.25, 0.75, 0.75, 0.75, 0.25, 0.25]);
  assert.equal(vector('v_tangent', 4)[3], 1);
  assert.ok(vector('vViewPosition', 3)[2] > 1 && vector('v_to_eye', 3)[2] > 1);
  assert.throws(() => vector('vMystery', 3), /nobody knows what the input vMystery is/);
});

test('ours has its light, and the numbers of its material', () => {
  const manifest = { files: [{ materials: [{ uses: [{ uniforms: { roughness_factor: 0.25 } }] }] }] };
  const { uniforms } = ourBound(manifest);
  assert.equal(uniforms.roughness_factor, 0.25);
  assert.equal(uniforms.light_count, 1);
  assert.deepEqual(uniforms['lights[0].radiance'], [3, 3, 3]);
});
