// What runs in the page for lacquer-wgsl-colors: every point is a pixel of float targets, covered by a triangle of its
// own with the same inputs at its corners.
'use strict';

var device = null;

/// Numbers are not discarded colours when they are this.
var kUntouched = -1.5e38;

async function openDevice() {
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) return null;
  const features = ['float32-filterable'].filter((feature) => adapter.features.has(feature));
  const limits = {};
  for (const name of ['maxColorAttachments', 'maxColorAttachmentBytesPerSample', 'maxSampledTexturesPerShaderStage',
                      'maxSamplersPerShaderStage', 'maxInterStageShaderVariables'])
    limits[name] = adapter.limits[name];
  device = await adapter.requestDevice({requiredFeatures: features, requiredLimits: limits});
  device.onuncapturederror = () => {};
  return `${adapter.info.vendor} ${adapter.info.architecture}`;
}

function vertexText(inputs) {
  const type = (components) => components === 1 ? 'f32' : `vec${components}f`;
  const attributes = inputs.map((i) => `    @location(${i.location}) a${i.location}: ${type(i.components)},\n`);
  const results = inputs.map((i) => `    @location(${i.location}) v${i.location}: ${type(i.components)},\n`);
  const copies = inputs.map((i) => `    out.v${i.location} = a${i.location};\n`);
  const back = inputs.length === 0 ? 0 : Math.max(...inputs.map((i) => i.location)) + 1;
  return {
    back,
    code: `struct Out {\n    @builtin(position) position: vec4f,\n${results.join('')}}\n@vertex fn main(
    @builtin(vertex_index) corner: u32,\n    @location(${back}) back: f32,\n${attributes.join('')}) -> Out {
    var out: Out;
    let x = select(-1.0, 3.0, corner == 1u);
    let y = select(-1.0, 3.0, corner == 2u);
    out.position = vec4f(select(x, y, back > 0.5), select(y, x, back > 0.5), 0.5, 1.0);
${copies.join('')}    return out;\n}\n`,
  };
}

/// The inputs of each point and the side, interleaved.
function vertexData(work, back) {
  const floats = 1 + work.inputs.reduce((sum, i) => sum + i.components, 0);
  const data = new Float32Array(floats * work.points);
  const attributes = [{shaderLocation: back, offset: 0, format: 'float32'}];
  let at = 1;
  for (const input of work.inputs) {
    const n = input.components;
    attributes.push({shaderLocation: input.location, offset: 4 * at, format: n === 1 ? 'float32' : `float32x${n}`});
    for (let p = 0; p < work.points; ++p) {
      for (let c = 0; c < n; ++c) data[p * floats + at + c] = input.values[p * n + c];
    }
    at += n;
  }
  for (let p = 0; p < work.points; ++p) data[p * floats] = work.backFacing[p] ? 1 : 0;
  return {data, layout: {arrayStride: 4 * floats, stepMode: 'instance', attributes}};
}

function bufferOf(data, usage) {
  const buffer = device.createBuffer({size: (data.byteLength + 15) & ~15, usage: usage | GPUBufferUsage.COPY_DST});
  device.queue.writeBuffer(buffer, 0, data);
  return buffer;
}

/// A depth map of one depth: WebGPU writes floats into none, it renders into them.
function depthMap({width, height, texels}) {
  if (texels.some((x, i) => i % 4 === 0 && x !== texels[0])) throw new Error('a depth map here has one depth');
  const usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.RENDER_ATTACHMENT;
  const texture = device.createTexture({size: [width, height], format: 'depth32float', usage});
  const encoder = device.createCommandEncoder();
  encoder.beginRenderPass({
    colorAttachments: [],
    depthStencilAttachment: {
      view: texture.createView(), depthLoadOp: 'clear', depthStoreOp: 'store', depthClearValue: texels[0],
    },
  }).end();
  device.queue.submit([encoder.finish()]);
  return texture.createView();
}

function textureOf(image) {
  if (image.compares) return depthMap(image);
  const {shape, width, height, texels} = image;
  const cube = shape === 'cube';
  const layers = cube ? 6 : texels.length / (4 * width * height);
  const texture = device.createTexture({
    size: [width, height, layers],
    format: 'rgba32float',
    usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST,
  });
  for (let layer = 0; layer < layers; ++layer) {
    const first = cube ? 0 : 4 * width * height * layer;
    device.queue.writeTexture({texture, origin: [0, 0, layer]},
                              new Float32Array(texels.slice(first, first + 4 * width * height)), {bytesPerRow: 16 * width},
                              [width, height]);
  }
  return texture.createView({dimension: shape});
}

/// A cube has one colour: of each point, or of all.
function cubeColor(texture, point) {
  const at = texture.texels.length > 4 ? 4 * point : 0;
  return texture.texels.slice(at, at + 4);
}

/// For each point the resources of each group.
function makeBinder(work, pipeline) {
  const groups = [...new Set([...work.blocks, ...work.textures].map(({group}) => group))];
  const cache = new Map();
  const kept = (key, make) => {
    if (!cache.has(key)) cache.set(key, make());
    return cache.get(key);
  };
  const blocks = work.blocks.map((block) => {
    const bytes = Uint8Array.from(atob(block.bytes), (c) => c.charCodeAt(0));
    const size = block.perPoint ? bytes.length / work.points : bytes.length;
    const stride = (size + 255) & ~255;
    const copies = block.perPoint ? work.points : 1;
    const data = new Uint8Array(stride * copies);
    for (let i = 0; i < copies; ++i) data.set(bytes.subarray(i * size, (i + 1) * size), i * stride);
    const usage = block.storage ? GPUBufferUsage.STORAGE : GPUBufferUsage.UNIFORM;
    return {...block, size, stride, buffer: bufferOf(data, usage)};
  });
  const wraps = {repeat: 'repeat', clamp: 'clamp-to-edge', mirror: 'mirror-repeat'};
  const entriesOf = (group, point) => {
    const entries = [];
    for (const block of blocks.filter((b) => b.group === group)) {
      const offset = block.perPoint ? point * block.stride : 0;
      entries.push({binding: block.binding, resource: {buffer: block.buffer, offset, size: block.size}});
    }
    for (const texture of work.textures.filter((t) => t.group === group)) {
      const cube = texture.shape === 'cube';
      const one = cube ? {...texture, width: 1, height: 1, texels: cubeColor(texture, point)} : texture;
      const view = kept(`${group} ${texture.binding} ${cube ? one.texels : ''}`, () => textureOf(one));
      const filter = texture.nearest ? 'nearest' : 'linear';
      const [s, t] = texture.wrap.map((wrap) => wraps[wrap]);
      const sampler = kept(`sampler ${group} ${texture.sampler}`, () => device.createSampler({
        addressModeU: s, addressModeV: t, magFilter: filter, minFilter: filter,
        compare: texture.compares ? 'less-equal' : undefined,
      }));
      entries.push({binding: texture.binding, resource: view}, {binding: texture.sampler, resource: sampler});
    }
    return entries;
  };
  return (pass, point) => {
    for (const group of groups) {
      const layout = kept(`layout ${group}`, () => pipeline.getBindGroupLayout(group));
      pass.setBindGroup(group, device.createBindGroup({layout, entries: entriesOf(group, point)}));
    }
  };
}

/// The layout of the bindings: `auto` takes float textures to be filtered, which all of them are not.
function layoutOf(work) {
  const groups = [];
  const add = (group, entry) => (groups[group] ??= []).push({visibility: GPUShaderStage.FRAGMENT, ...entry});
  for (const {group, binding, storage} of work.blocks)
    add(group, {binding, buffer: {type: storage ? 'read-only-storage' : 'uniform'}});
  for (const t of work.textures) {
    const filtered = device.features.has('float32-filterable');
    const sampleType = t.compares ? 'depth' : filtered ? 'float' : 'unfilterable-float';
    add(t.group, {binding: t.binding, texture: {sampleType, viewDimension: t.shape}});
    const type = t.compares ? 'comparison' : filtered ? 'filtering' : 'non-filtering';
    add(t.group, {binding: t.sampler, sampler: {type}});
  }
  const bindGroupLayouts = Array.from(groups, (entries) => device.createBindGroupLayout({entries: entries ?? []}));
  return device.createPipelineLayout({bindGroupLayouts});
}

async function readBack(target, width, height) {
  const bytesPerRow = (16 * width + 255) & ~255;
  const buffer = device.createBuffer(
    {size: bytesPerRow * height, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ});
  const encoder = device.createCommandEncoder();
  encoder.copyTextureToBuffer({texture: target}, {buffer, bytesPerRow}, [width, height]);
  device.queue.submit([encoder.finish()]);
  await buffer.mapAsync(GPUMapMode.READ);
  const all = new Float32Array(buffer.getMappedRange());
  const rows = [];
  for (let y = 0; y < height; ++y) rows.push(...all.subarray(y * bytesPerRow / 4, y * bytesPerRow / 4 + 4 * width));
  buffer.destroy();
  return rows;
}

/// One output at a time: together, floats may be more bytes than a pixel may have.
async function runOutput(work, location) {
  const vertex = vertexText(work.inputs);
  const {data, layout} = vertexData(work, vertex.back);
  const targets = Array(location + 1).fill(null);
  targets[location] = {format: 'rgba32float'};
  const pipeline = device.createRenderPipeline({
    layout: layoutOf(work),
    vertex: {module: device.createShaderModule({code: vertex.code}), buffers: [layout]},
    fragment: {module: device.createShaderModule({code: work.wgsl}), targets, constants: work.constants},
  });
  const width = Math.min(work.points, 64);
  const height = Math.ceil(work.points / width);
  const target = device.createTexture({
    size: [width, height], format: 'rgba32float',
    usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC,
  });
  const colorAttachments = Array(location + 1).fill(null);
  colorAttachments[location] = {
    view: target.createView(), loadOp: 'clear', storeOp: 'store',
    clearValue: [kUntouched, kUntouched, kUntouched, kUntouched],
  };
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginRenderPass({colorAttachments});
  pass.setPipeline(pipeline);
  pass.setVertexBuffer(0, bufferOf(data, GPUBufferUsage.VERTEX));
  const bind = makeBinder(work, {getBindGroupLayout: (group) => pipeline.getBindGroupLayout(group)});
  for (let point = 0; point < work.points; ++point) {
    pass.setScissorRect(point % width, Math.floor(point / width), 1, 1);
    bind(pass, point);
    pass.draw(3, 1, 0, point);
  }
  pass.end();
  device.queue.submit([encoder.finish()]);
  return (await readBack(target, width, height)).slice(0, 4 * work.points);
}

async function run(work) {
  device.pushErrorScope('validation');
  const outputs = [];
  for (const location of work.outputs) outputs.push(await runOutput(work, location).catch((error) => error.message));
  const error = await device.popErrorScope();
  if (error) return {error: error.message};
  const untouched = Math.fround(kUntouched);
  const discarded = Array.from({length: work.points}, (_, p) => outputs.every((rgba) => rgba[4 * p] === untouched));
  // JSON has no infinity and no NaN.
  const spelled = (x) => Number.isFinite(x) ? x : String(x);
  return {outputs: outputs.map((rgba) => Array.from(rgba, spelled)), discarded};
}
