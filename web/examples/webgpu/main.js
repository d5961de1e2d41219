// A glTF file in WebGPU with shaders that are made in the page: `npm install`, then any static server, then
// index.html?file.glb. What has a material is drawn with it, seen from +z, under one lamp.
import { load } from '@lacquer-shaders/lacquer';
import { bounds, fetchGltf, geometry, image, sourceOf } from '@lacquer-shaders/lacquer/gltf';

const canvas = document.querySelector('canvas');
const context = canvas.getContext('webgpu');
const format = navigator.gpu.getPreferredCanvasFormat();
let device;
const kOptions = { targets: ['wgsl'], ibl: false, lights: { directional: 1 } };
const kLamp = { position: [0.4, 0.5, 0.77], direction: [-0.4, -0.5, -0.77], radiance: [3, 3, 3], spot_offset: 1 };
const kClamp = 33071; // of glTF's samplers

/** What the block Frame has for a camera that sees all of it. */
function frameOf({ middle: [x, y, z], radius }) {
  const eye = [x, y, z + 3 * radius];
  const projection = new DOMMatrix([2.8, 0, 0, 0, 0, 2.8, 0, 0, 0, 0, -2, -1, 0, 0, -4 * radius, 0]); // from 2 to 4 radii away
  return { view_projection: projection.translate(-eye[0], -eye[1], -eye[2]).toFloat32Array(), camera_position: eye };
}

function bufferOf(bytes, usage) {
  const buffer = device.createBuffer({ size: bytes.byteLength, usage: usage | GPUBufferUsage.COPY_DST });
  device.queue.writeBuffer(buffer, 0, bytes);
  return buffer;
}

async function textureOf(file, { texture, srgb }) {
  const source = await image(file, sourceOf(file.json.textures[texture]));
  const size = [source.width, source.height];
  const usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST | GPUTextureUsage.RENDER_ATTACHMENT;
  const made = device.createTexture({ size, format: srgb ? 'rgba8unorm-srgb' : 'rgba8unorm', usage });
  device.queue.copyExternalImageToTexture({ source }, { texture: made }, size);
  return made.createView();
}

function samplerOf(file, { texture }) {
  const { wrapS, wrapT } = file.json.samplers?.[file.json.textures[texture].sampler] ?? {};
  const [addressModeU, addressModeV] = [wrapS, wrapT].map((wrap) => (wrap === kClamp ? 'clamp-to-edge' : 'repeat'));
  return device.createSampler({ magFilter: 'linear', minFilter: 'linear', addressModeU, addressModeV });
}

/** What a primitive is drawn with: all of it is in the shader's interface. */
async function prepare(file, scene, { material, attributes, indices, model, normal }, frame) {
  const graph = scene.graph(material, kOptions, [...attributes.keys()].filter((name) => name !== 'POSITION'));
  const shader = graph.generate(kOptions);
  const slots = graph.toJson().textures;
  const values = { Frame: frame, Lights: kLamp, Object: { model, normal_matrix: normal } };
  const resourceOf = async ({ name, buffer, texture }) => {
    if (buffer) return { buffer: bufferOf(values[name] ? shader.block(name, values[name]) : shader.pack(), GPUBufferUsage.UNIFORM) };
    return texture ? textureOf(file, slots[name]) : samplerOf(file, slots[name.replace(/_sampler$/, '')]);
  };
  const groups = shader.bindGroupLayouts();
  const layouts = groups.map((group) => device.createBindGroupLayout(group));
  const bound = await Promise.all(groups.map(async ({ entries }, i) => device.createBindGroup({
    layout: layouts[i],
    entries: await Promise.all(entries.map(async (entry) => ({ binding: entry.binding, resource: await resourceOf(entry) }))),
  })));

  const { inputs } = shader.interface;
  const numbers = inputs.map(({ name }) => attributes.get(name));
  const buffers = numbers.map(({ size }, i) => ({
    arrayStride: 4 * size, attributes: [{ shaderLocation: inputs[i].location, offset: 0, format: `float32x${size}` }],
  }));
  const moduleOf = (stage) => device.createShaderModule({ code: shader.text('wgsl', stage) });
  const pipeline = device.createRenderPipeline({
    layout: device.createPipelineLayout({ bindGroupLayouts: layouts }),
    vertex: { module: moduleOf('vertex'), buffers },
    fragment: { module: moduleOf('fragment'), targets: [{ format }] },
    depthStencil: { format: 'depth24plus', depthWriteEnabled: true, depthCompare: 'less' },
  });
  return (pass) => {
    pass.setPipeline(pipeline);
    bound.forEach((group, i) => pass.setBindGroup(i, group));
    numbers.forEach(({ data }, i) => pass.setVertexBuffer(i, bufferOf(data, GPUBufferUsage.VERTEX)));
    pass.setIndexBuffer(bufferOf(indices, GPUBufferUsage.INDEX), 'uint32');
    pass.drawIndexed(indices.length);
  };
}

async function main() {
  device = await (await navigator.gpu.requestAdapter()).requestDevice();
  context.configure({ device, format });
  const file = await fetchGltf(new URL(location.search.slice(1) || 'triangle.gltf', location.href));
  const scene = (await load()).scene(file.bytes, file.name);
  const drawables = geometry(file).filter(({ material }) => material >= 0);
  const draws = await Promise.all(drawables.map((each) => prepare(file, scene, each, frameOf(bounds(drawables)))));
  const encoder = device.createCommandEncoder();
  const depth = device.createTexture({ size: [canvas.width, canvas.height], format: 'depth24plus', usage: GPUTextureUsage.RENDER_ATTACHMENT });
  const pass = encoder.beginRenderPass({
    colorAttachments: [{ view: context.getCurrentTexture().createView(), clearValue: [0.1, 0.1, 0.12, 1], loadOp: 'clear', storeOp: 'store' }],
    depthStencilAttachment: { view: depth.createView(), depthClearValue: 1, depthLoadOp: 'clear', depthStoreOp: 'discard' },
  });
  for (const draw of draws) draw(pass);
  pass.end();
  device.queue.submit([encoder.finish()]);
  await device.queue.onSubmittedWorkDone();
  document.title = 'drawn';
}
main();
