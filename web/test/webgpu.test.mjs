// What lacquer/webgpu makes of a contract.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';
import { output } from './native.mjs';

const webgpu = await import(join(output, 'package/webgpu.js'));
const kFloats = { type: 'VEC3', component_type: 'FLOAT' };

test('vertex formats make floats of what is stored', () => {
  const stream = (type, component_type, normalized, semantic = 'TEXCOORD_0') =>
    webgpu.vertexStream(semantic, { type, component_type, normalized });
  assert.deepEqual(stream('VEC3', 'FLOAT'), { format: 'float32x3', arrayStride: 12, scale: 1 });
  assert.deepEqual(stream('SCALAR', 'FLOAT'), { format: 'float32', arrayStride: 4, scale: 1 });
  assert.deepEqual(stream('VEC2', 'UNSIGNED_SHORT', true), { format: 'unorm16x2', arrayStride: 4, scale: 1 });
  assert.deepEqual(stream('VEC3', 'BYTE', true), { format: 'snorm8x4', arrayStride: 4, scale: 1 });
  assert.deepEqual(stream('VEC3', 'SHORT'), { format: 'snorm16x4', arrayStride: 8, scale: 32767 });
  assert.deepEqual(stream('VEC4', 'UNSIGNED_BYTE', false, 'JOINTS_0'), { format: 'unorm8x4', arrayStride: 4, scale: 255 });
  assert.equal(stream('VEC3', 'UNSIGNED_BYTE', true, 'COLOR_0'), undefined);
  assert.equal(stream('VEC4', 'UNSIGNED_INT'), undefined);
  assert.equal(stream('MAT4', 'FLOAT'), undefined);
});

test('vertex buffers are the inputs in their order, with stand-ins that do not move on', () => {
  const shader = { inputs: [
    { name: 'POSITION', type: 'vec3', location: 0 }, { name: 'COLOR_0', type: 'vec4', location: 7 },
    { name: 'SCALE', type: 'vec3', location: 14 },
  ] };
  const buffers = webgpu.vertexBuffers(shader, { attributes: { POSITION: kFloats } }, {
    SCALE: { format: 'float32x3', arrayStride: 12, scale: 1 },
  });
  assert.deepEqual(buffers, [
    { arrayStride: 12, stepMode: 'vertex', attributes: [{ shaderLocation: 0, offset: 0, format: 'float32x3' }] },
    { arrayStride: 0, stepMode: 'vertex', attributes: [{ shaderLocation: 7, offset: 0, format: 'float32x4' }] },
    { arrayStride: 12, stepMode: 'instance', attributes: [{ shaderLocation: 14, offset: 0, format: 'float32x3' }] },
  ]);
  assert.deepEqual(webgpu.standIn('COLOR_0'), [1, 1, 1, 1]);
  assert.deepEqual(webgpu.standIn('ROTATION'), [0, 0, 0, 1]);
});

test('the numbers of an instance come once for each, and arrays of textures are refused', () => {
  const shader = { inputs: [{ name: 'DRAW', type: 'ivec2', location: 15 }], outputs: [{}], textures: [{ name: 'map', array: 'textures' }] };
  assert.deepEqual(webgpu.vertexBuffers(shader, { attributes: {} }), [
    { arrayStride: 8, stepMode: 'instance', attributes: [{ shaderLocation: 15, offset: 0, format: 'sint32x2' }] },
  ]);
  assert.throws(() => webgpu.pipelineStates(shader, { double_sided: false, depth_write: true }), /arrays of textures/);
});

test('samplers are what the file says, and linear where it says nothing', () => {
  assert.deepEqual(webgpu.samplerOf({ wrap_s: 'clamp', wrap_t: 'mirror' }), {
    addressModeU: 'clamp-to-edge', addressModeV: 'mirror-repeat', magFilter: 'linear', minFilter: 'linear',
    mipmapFilter: 'linear', lodMaxClamp: 32,
  });
  const nearest = webgpu.samplerOf({ wrap_s: 'repeat', wrap_t: 'repeat', mag_filter: 'nearest', min_filter: 'nearest' });
  assert.equal(nearest.magFilter, 'nearest');
  assert.equal(nearest.minFilter, 'nearest');
  assert.equal(nearest.lodMaxClamp, 0);
  assert.equal(webgpu.samplerOf({ wrap_s: 'repeat', wrap_t: 'repeat', min_filter: 'linear-mipmap-nearest' }).mipmapFilter, 'nearest');
  assert.equal(webgpu.frameSamplerOf({ name: 'light_shadow_map', type: 'sampler2DShadow', role: 'environment' }).compare, 'less-equal');
  assert.equal(webgpu.frameSamplerOf({ name: 'joint_matrices', type: 'sampler2D', role: 'object' }).magFilter, 'nearest');
  assert.equal(webgpu.textureFormat('srgb'), 'rgba8unorm-srgb');
});

test('pipeline states are the material\'s', () => {
  const blend = { color: ['src-alpha', 'one-minus-src-alpha'], alpha: ['one', 'one-minus-src-alpha'] };
  const made = webgpu.pipelineStates({ outputs: [{}, {}] }, { double_sided: false, depth_write: false, blend }, { mirrored: true });
  assert.deepEqual(made.primitive, { topology: 'triangle-list', cullMode: 'back', frontFace: 'cw' });
  assert.equal(made.depthStencil.depthWriteEnabled, false);
  assert.equal(made.targets.length, 2);
  assert.deepEqual(made.targets[0].blend.color, { operation: 'add', srcFactor: 'src-alpha', dstFactor: 'one-minus-src-alpha' });
  assert.equal(webgpu.pipelineStates({ outputs: [{}] }, { double_sided: true, depth_write: true }).targets[0].blend, undefined);
});

test('matrices, lights and constants', () => {
  const model = [2, 0, 0, 0, 0, 1, 0, 0, 0, 0, -4, 0, 5, 6, 7, 1];
  assert.deepEqual(webgpu.normalMatrix(model).map((x) => x + 0), [0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, -0.25, 0, 0, 0, 0, 1]);
  assert.equal(webgpu.mirrors(model), true);
  assert.equal(webgpu.mirrors(webgpu.objectValues(model).normal_matrix), true);
  assert.ok(webgpu.normalMatrix(new Array(16).fill(0)).every(Number.isFinite));
  const spot = webgpu.lightValues({ type: 'spot', intensity: 2, range: 2, innerConeAngle: 0, outerConeAngle: Math.PI / 3 });
  assert.ok(Math.abs(spot.spot_scale - 2) < 1e-12 && Math.abs(spot.spot_offset + 1) < 1e-12);
  assert.equal(spot.inverse_range_4, 1 / 16);
  assert.deepEqual(spot.radiance, [2, 2, 2]);
  const lamp = webgpu.lightValues({ type: 'rect', size: 2, aspect: 3, intensity: 4, color: [1, 0.5, 0] });
  assert.deepEqual(lamp.direction.map((x) => x + 0), [0, 0, -1]);
  assert.deepEqual([lamp.area_x, lamp.area_y, lamp.area_radiance, lamp.disk], [[3, 0, 0], [0, 1, 0], [4, 2, 0], 0]);
  assert.deepEqual(webgpu.lightValues({ type: 'disk', size: 2, aspect: 3 }).area_x, [1, 0, 0]);
  const sun = webgpu.lightValues({ type: 'directional', direction: [0, -1, 0] });
  assert.deepEqual(sun.position.map((x) => x + 0), [0, 1, 0]);
  assert.equal(sun.positional, 0);
  // The middle of clip space is the picture's; its upper edge is the first row.
  const see = webgpu.seeThroughValues([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], 5);
  const at = (row, point) => row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3];
  assert.equal(at(see.scene_v, [0, 1, 0]), 0);
  assert.equal(at(see.scene_u, [1, 0, 0]), 1);
  assert.equal(see.scene_max_lod, 4);
  const spec_constants = [{ id: 3, name: 'tint', component: 1, default: 0.5 }, { id: 4, name: 'on', component: 0, default: true }];
  assert.deepEqual(webgpu.constants({ spec_constants }, { parameters: { tint: { value: [1, 2, 3] } } }), { 3: 2, 4: 1 });
});

test('a frame is drawn by passes, what is seen through from back to front', () => {
  const items = [
    { pass: 'blended', distance: 1 }, { pass: 'opaque', distance: 5 }, { pass: 'blended', distance: 3 },
    { pass: 'looks_through', distance: 2 }, { pass: 'opaque', distance: 1 }, { pass: 'masked', distance: 0 },
  ];
  assert.deepEqual(items.sort(webgpu.drawOrder).map(({ pass, distance }) => `${pass} ${distance}`),
    ['opaque 1', 'opaque 5', 'masked 0', 'looks_through 2', 'blended 3', 'blended 1']);
});
