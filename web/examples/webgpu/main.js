// A glTF file in WebGPU with shaders that are made in the page: `npm install`, then any static server, then
// index.html?file.gltf. For files with one buffer; each primitive is drawn with its material, under one lamp.
import { load } from 'lacquer';

const canvas = document.querySelector('canvas');
const context = canvas.getContext('webgpu');
const format = navigator.gpu.getPreferredCanvasFormat();
const url = new URL(location.search.slice(1) || 'triangle.gltf', location.href);
let device, gltf, data, scene;
const kOptions = { targets: ['wgsl'], ibl: false, lights: { directional: 1 } };
const kFormats = { 5121: { name: 'unorm8', bytes: 1 }, 5123: { name: 'unorm16', bytes: 2 }, 5126: { name: 'float32', bytes: 4 } };
const kIndices = { 5121: Uint8Array, 5123: Uint16Array, 5125: Uint32Array };
const kIdentity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const kView = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -0.1, 0, 0, 0, 0.5, 1]; // seen from +z, [-1, 1] in x and y
const kValues = {
  view_projection: kView, camera_position: [0, 0, 5], model: kIdentity, normal_matrix: kIdentity,
  position: [0.4, 0.5, 0.77], direction: [-0.4, -0.5, -0.77], radiance: [3, 3, 3], spot_offset: [1], // a directional light
};

async function open() {
  device = await (await navigator.gpu.requestAdapter()).requestDevice();
  context.configure({ device, format });
  const bytes = new Uint8Array(await (await fetch(url)).arrayBuffer());
  gltf = JSON.parse(new TextDecoder().decode(bytes));
  data = await (await fetch(new URL(gltf.buffers[0].uri, url))).arrayBuffer();
  scene = (await load()).scene(bytes, 'file.gltf');
}

function buffer(bytes, usage) {
  const made = device.createBuffer({ size: Math.ceil(bytes.byteLength / 4) * 4, usage, mappedAtCreation: true });
  new Uint8Array(made.getMappedRange()).set(new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength));
  made.unmap();
  return made;
}

function viewed({ bufferView, byteOffset = 0 }) {
  const view = gltf.bufferViews[bufferView];
  return new Uint8Array(data, (view.byteOffset ?? 0) + byteOffset, view.byteLength - byteOffset);
}

async function texture(of, srgb) {
  const { source } = gltf.textures[of];
  const { uri, bufferView, mimeType } = gltf.images[source];
  const blob = uri ? await (await fetch(new URL(uri, url))).blob() : new Blob([viewed({ bufferView })], { type: mimeType });
  const image = await createImageBitmap(blob, { premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
  const size = [image.width, image.height];
  const usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST | GPUTextureUsage.RENDER_ATTACHMENT;
  const made = device.createTexture({ size, format: srgb ? 'rgba8unorm-srgb' : 'rgba8unorm', usage });
  device.queue.copyExternalImageToTexture({ source: image }, { texture: made }, size);
  return made.createView();
}

/** What a primitive is drawn with: all of it is in the shader's interface. */
async function prepare(primitive) {
  const attributes = Object.keys(primitive.attributes).filter((name) => name !== 'POSITION');
  const graph = scene.graph(primitive.material, kOptions, attributes);
  const shader = graph.generate(kOptions);
  const { inputs, uniforms, webgpu } = shader.interface;
  const slots = graph.toJson().textures ?? {};
  const accessors = inputs.map(({ name }) => gltf.accessors[primitive.attributes[name]]);
  const module = (stage) => device.createShaderModule({ code: shader.text('wgsl', stage) });
  const [layouts, entries] = [[[], [], []], [[], [], []]];
  for (const { name, group, visibility, ...entry } of webgpu.bindings) {
    const stages = visibility.reduce((bits, stage) => bits | GPUShaderStage[stage.toUpperCase()], 0);
    layouts[group].push({ ...entry, visibility: stages });
    entries[group].push({ binding: entry.binding, resource: await resource(name, entry) });
  }
  async function resource(name, entry) {
    if (entry.sampler) return device.createSampler({ magFilter: 'linear', addressModeU: 'repeat', addressModeV: 'repeat' });
    if (entry.texture) return texture(slots[name].texture, slots[name].srgb);
    const { role, size, fields } = uniforms.find(({ block }) => block === name);
    const block = role === 'material' ? shader.pack() : new Uint8Array(size);
    if (role !== 'material') for (const { name, offset } of fields) new Float32Array(block.buffer).set(kValues[name] ?? [], offset / 4);
    return { buffer: buffer(block, GPUBufferUsage.UNIFORM) };
  }
  const groups = layouts.map((entries) => device.createBindGroupLayout({ entries }));
  const pipeline = device.createRenderPipeline({
    layout: device.createPipelineLayout({ bindGroupLayouts: groups }),
    vertex: { module: module('vertex'), buffers: inputs.map(({ location }, i) => {
      const { componentType, type, bufferView } = accessors[i];
      const { name, bytes } = kFormats[componentType];
      const arrayStride = gltf.bufferViews[bufferView].byteStride ?? bytes * type.slice(3);
      return { arrayStride, attributes: [{ shaderLocation: location, offset: 0, format: `${name}x${type.slice(3)}` }] };
    }) },
    fragment: { module: module('fragment'), targets: [{ format }] },
    depthStencil: { format: 'depth24plus', depthWriteEnabled: true, depthCompare: 'less' },
  });
  return { pipeline, binds: groups.map((layout, i) => device.createBindGroup({ layout, entries: entries[i] })), accessors };
}

async function main() {
  await open();
  const primitives = gltf.meshes.flatMap((mesh) => mesh.primitives);
  const prepared = await Promise.all(primitives.map(async (of) => ({ of, ...(await prepare(of)) })));
  const encoder = device.createCommandEncoder();
  const size = [canvas.width, canvas.height];
  const depth = device.createTexture({ size, format: 'depth24plus', usage: GPUTextureUsage.RENDER_ATTACHMENT });
  const pass = encoder.beginRenderPass({
    colorAttachments: [{ view: context.getCurrentTexture().createView(), clearValue: [0.1, 0.1, 0.12, 1], loadOp: 'clear', storeOp: 'store' }],
    depthStencilAttachment: { view: depth.createView(), depthClearValue: 1, depthLoadOp: 'clear', depthStoreOp: 'discard' },
  });
  for (const { of, pipeline, binds, accessors } of prepared) {
    pass.setPipeline(pipeline);
    binds.forEach((bind, i) => pass.setBindGroup(i, bind));
    accessors.forEach((accessor, i) => pass.setVertexBuffer(i, buffer(viewed(accessor), GPUBufferUsage.VERTEX)));
    const indices = gltf.accessors[of.indices];
    const list = indices ? new kIndices[indices.componentType](data, viewed(indices).byteOffset, indices.count)
      : Array.from({ length: gltf.accessors[of.attributes.POSITION].count }, (_, i) => i);
    pass.setIndexBuffer(buffer(Uint32Array.from(list), GPUBufferUsage.INDEX), 'uint32');
    pass.drawIndexed(list.length);
  }
  pass.end();
  device.queue.submit([encoder.finish()]);
  await device.queue.onSubmittedWorkDone();
  document.title = 'drawn';
}
main();
