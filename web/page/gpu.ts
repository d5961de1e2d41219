// Draws what the viewport shows with WebGPU: the Wgsl texts, and bind groups as the shader's interface tells.
import type { Interface, Shader } from '../src/index';
import { backgroundLevel, kBoard, lastLod } from './behind';
import type { Cube, Environment } from './environment';
import type { Drawable, Mat4, Numbers } from '../src/gltf';
import { once } from '../src/json';
import { multiply } from '../src/math';
import { neutral } from './shapes';
import type { Pass } from '../src/types';
import { frameBlocks } from './frame';
import { dropOldest, kBlocks, kLocations, kSolid, kSorted, slotKey, type Look, type Viewport } from './viewport';

declare const GPUBufferUsage: Record<'VERTEX' | 'INDEX' | 'UNIFORM' | 'COPY_DST' | 'MAP_READ', number>;
declare const GPUMapMode: Record<'READ', number>;
declare const GPUTextureUsage: Record<'TEXTURE_BINDING' | 'RENDER_ATTACHMENT' | 'COPY_DST' | 'COPY_SRC', number>;
declare const GPUShaderStage: Record<'VERTEX' | 'FRAGMENT', number>;

interface Binding {
  name: string;
  group: number;
  binding: number;
  visibility: string[];
  buffer?: GPUBufferBindingLayout;
  texture?: GPUTextureBindingLayout;
  sampler?: GPUSamplerBindingLayout;
}
interface Program {
  bindings: Binding[];
  layouts: GPUBindGroupLayout[];
  inputs: { name: string; location: number; type: string }[];
  stages: { vertex: GPUShaderModule; fragment: GPUShaderModule };
  pipelines: Map<string, GPURenderPipeline>;
}
interface Geometry {
  attributes: Map<string, { buffer: GPUBuffer; size: number }>;
  indices: GPUBuffer;
  count: number;
  object: GPUBuffer;
  /** That the object's block is of. */
  model: Mat4;
  moving: Numbers[];
}
interface Target {
  width: number;
  height: number;
  color: GPUTexture;
  depth: GPUTexture;
  resolved: GPUTexture;
  /** What is seen through glass, with mip levels, once something is. */
  behind: GPUTexture | null;
}

const kSamples = 4;
const kColor: GPUTextureFormat = 'rgba16float';
/** OpenGL's depths, -1 to 1, as WebGPU has them. */
const kDepths = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5, 0, 0, 0, 0.5, 1]);

const kFloat = new Float32Array(1);
const kBits = new Uint32Array(kFloat.buffer);
/** The nearest half float; what is larger than the largest is the largest. */
function half(x: number): number {
  kFloat[0] = Math.min(Math.max(x, -65504), 65504);
  const sign = (kBits[0] >>> 16) & 0x8000;
  const magnitude = kBits[0] & 0x7fffffff;
  if (magnitude < 0x38800000) return sign | Math.round(Math.abs(kFloat[0]) * 2 ** 24);
  return sign | ((magnitude - 0x38000000 + 0x1000) >>> 13);
}
export function halves(numbers: Float32Array): Uint16Array<ArrayBuffer> {
  const made = new Uint16Array(numbers.length);
  for (let i = 0; i < made.length; ++i) made[i] = half(numbers[i]);
  return made;
}

function objectBlock({ model, normal }: Drawable): Float32Array<ArrayBuffer> {
  const block = new Float32Array(32);
  block.set(model);
  block.set(normal, 16);
  return block;
}

export class GpuPainter {
  private readonly context: GPUCanvasContext;
  private readonly format: GPUTextureFormat;
  private programs = new Map<string, Program>();
  private geometries = new WeakMap<Drawable, Geometry>();
  /** Of numbers that several drawables may have. */
  private arrays = new WeakMap<ArrayBufferView, GPUBuffer>();
  /** What is in the buffers of numbers that change. */
  private versions = new WeakMap<Numbers, number>();
  private materials = new WeakMap<Look, { buffer: GPUBuffer; version?: number }>();
  private cubes = new WeakMap<Cube, { texture: GPUTexture; view: GPUTextureView; version: number }>();
  private textures = new Map<string, GPUTextureView>();
  private samplers = new Map<string, GPUSampler>();
  private blocks = new Map<string, GPUBuffer>();
  private tables: Record<string, GPUTextureView>;
  private constant: GPUBuffer;
  private target: Target | null = null;
  private show: GPURenderPipeline;
  private shrink = new Map<GPUTextureFormat, GPURenderPipeline>();
  private shown: GPUBuffer;
  private take: GPURenderPipeline;
  private surround: GPURenderPipeline;
  private around: GPUBuffer;
  private constructor(readonly canvas: HTMLCanvasElement, readonly device: GPUDevice, dfg: Float32Array, sheen: Float32Array) {
    this.context = canvas.getContext('webgpu') as unknown as GPUCanvasContext;
    this.format = navigator.gpu.getPreferredCanvasFormat();
    this.context.configure({ device, format: this.format, alphaMode: 'opaque' });
    const table = (data: Float32Array) => {
      const size = Math.sqrt(data.length / 2);
      return this.image([size, size], 'rg16float', halves(data), 4 * size);
    };
    this.tables = {
      environment_dfg: table(dfg),
      environment_sheen: table(sheen),
    };
    this.constant = this.buffer(new Float32Array([1, 1, 1, 1, 1, 0, 0, 1]), GPUBufferUsage.VERTEX);
    this.shown = device.createBuffer({ size: 32, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
    this.show = this.fullscreen(kShow, this.format);
    this.take = this.fullscreen(kTake, kColor);
    this.surround = this.fullscreen(kSurround, kColor, {
      depthStencil: { format: 'depth24plus', depthWriteEnabled: false, depthCompare: 'less-equal' }, multisample: { count: kSamples },
    });
    this.around = device.createBuffer({ size: 64, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
  }

  /** null where there is no WebGPU. */
  static async make(canvas: HTMLCanvasElement, dfg: Float32Array, sheen: Float32Array): Promise<GpuPainter | null> {
    const adapter = await navigator.gpu?.requestAdapter();
    const device = await adapter?.requestDevice();
    return device ? new GpuPainter(canvas, device, dfg, sheen) : null;
  }

  /** Makes what a shader's pipelines are made of, where there is none yet. */
  prepare(shader: Shader, used: Set<string>): void {
    const { device } = this;
    if (this.programs.has(shader.id)) return;
    dropOldest(this.programs, used);
    const described = shader.interface as Interface & { webgpu: { bindings: Binding[] } };
    const layouts: GPUBindGroupLayoutEntry[][] = [[], [], []];
    for (const { name: _name, group, visibility, ...entry } of described.webgpu.bindings) {
      const stages = visibility.map((stage) => (stage === 'vertex' ? GPUShaderStage.VERTEX : GPUShaderStage.FRAGMENT));
      layouts[group].push({ ...entry, visibility: stages.reduce((bits, bit) => bits | bit, 0) });
    }
    const stage = (name: 'vertex' | 'fragment') => device.createShaderModule({ label: `${shader.id} ${name}`, code: shader.text('wgsl', name) });
    this.programs.set(shader.id, {
      bindings: described.webgpu.bindings,
      layouts: layouts.map((entries) => device.createBindGroupLayout({ entries })),
      inputs: described.inputs ?? [],
      stages: { vertex: stage('vertex'), fragment: stage('fragment') },
      pipelines: new Map(),
    });
  }
  forgetTextures(): void {
    this.textures.clear();
  }

  /** On the canvas, or on a texture of the canvas's format. */
  paint(view: Viewport, { width, height }: { width: number; height: number }, onto?: GPUTexture): void {
    const target = this.targetOf(width, height);
    const environment = view.around();
    const projection = multiply(kDepths, view.viewProjection(width / height));
    const blocks = frameBlocks(view.eye(), projection, environment, view.lights, view.seconds, {
      lod: lastLod(width, height), down: true, brightness: view.brightness,
    });
    for (const [name, bytes] of Object.entries(blocks)) this.fill(name, bytes);
    const encoder = this.device.createCommandEncoder();
    const cut = view.cut(width);
    let pass = this.begin(encoder, target, 'clear');
    const sides = (passes: Pass[]) => {
      if (cut > 0) {
        pass.setScissorRect(0, 0, cut, height);
        this.drawAll(pass, view, environment, null, passes);
      }
      if (view.other && cut < width) {
        pass.setScissorRect(cut, 0, width - cut, height);
        this.drawAll(pass, view, environment, view.other.look, passes);
      }
    };
    sides(kSolid);
    pass.setScissorRect(0, 0, width, height);
    if (view.background !== 'plain') this.drawAround(pass, view, environment, width / height);
    const through = [null, view.other?.look ?? null].some((instead) => !view.drawn(instead, ['looks_through']).next().done);
    if (through) {
      pass.end();
      this.takeBehind(encoder, target);
      pass = this.begin(encoder, target, 'load');
    }
    sides(kSorted);
    pass.end();
    this.present(encoder, view, target, cut, onto ?? this.context.getCurrentTexture());
    this.device.queue.submit([encoder.finish()]);
  }

  /** What paint() shows, rows from the top, RGBA. */
  async pixels(view: Viewport, width: number, height: number): Promise<Uint8Array> {
    const { device } = this;
    const onto = device.createTexture({ size: [width, height], format: this.format, usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC });
    this.paint(view, { width, height }, onto);
    const bytesPerRow = Math.ceil(width / 64) * 256;
    const buffer = device.createBuffer({ size: bytesPerRow * height, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ });
    const encoder = device.createCommandEncoder();
    encoder.copyTextureToBuffer({ texture: onto }, { buffer, bytesPerRow }, [width, height]);
    device.queue.submit([encoder.finish()]);
    await buffer.mapAsync(GPUMapMode.READ);
    const rows = new Uint8Array(buffer.getMappedRange());
    const order = this.format === 'bgra8unorm' ? [2, 1, 0, 3] : [0, 1, 2, 3];
    const pixels = Uint8Array.from({ length: 4 * width * height }, (_, i) => {
      const [pixel, channel] = [i >> 2, i & 3];
      return rows[bytesPerRow * Math.floor(pixel / width) + 4 * (pixel % width) + order[channel]];
    });
    for (const each of [buffer, onto]) each.destroy();
    return pixels;
  }

  // ---- drawing

  private begin(encoder: GPUCommandEncoder, { color, resolved, depth }: Target, loadOp: GPULoadOp): GPURenderPassEncoder {
    return encoder.beginRenderPass({
      colorAttachments: [{ view: color.createView(), resolveTarget: resolved.createView(), loadOp, storeOp: 'store', clearValue: [0, 0, 0, 0] }],
      depthStencilAttachment: { view: depth.createView(), depthClearValue: 1, depthLoadOp: loadOp, depthStoreOp: 'store' },
    });
  }

  /** What is around, where nothing has been drawn. */
  private drawAround(pass: GPURenderPassEncoder, view: Viewport, environment: Environment, aspect: number): void {
    const rays = view.rays(aspect);
    const level = backgroundLevel(view.background, environment.lastLevel);
    const numbers = new Float32Array([...rays.subarray(0, 3), level, ...rays.subarray(3, 6), view.brightness, ...rays.subarray(6), 0, 0, 0, 0, 0]);
    this.device.queue.writeBuffer(this.around, 0, numbers);
    pass.setPipeline(this.surround);
    const entries = [
      { binding: 0, resource: { buffer: this.around } }, { binding: 1, resource: this.cubeOf(environment.specular) }, { binding: 2, resource: this.samplerOf(null) },
    ];
    pass.setBindGroup(0, this.device.createBindGroup({ layout: this.surround.getBindGroupLayout(0), entries }));
    pass.draw(3);
  }

  /** The picture so far, with the board where it has nothing, and its mip levels. */
  private takeBehind(encoder: GPUCommandEncoder, target: Target): void {
    const { width, height } = target;
    target.behind ??= this.device.createTexture({
      size: [width, height], format: kColor, mipLevelCount: lastLod(width, height) + 1, usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.RENDER_ATTACHMENT,
    });
    this.onto(encoder, this.take, target.behind.createView({ mipLevelCount: 1 }), [{ binding: 0, resource: target.resolved.createView() }]);
    this.shrinkLevels(encoder, target.behind);
  }

  private drawAll(pass: GPURenderPassEncoder, view: Viewport, environment: Environment, instead: Look | null, passes: Pass[]): void {
    for (const { mesh, look } of view.drawn(instead, passes)) {
      const program = this.programs.get(look.id);
      if (!program) continue;
      const { drawable } = mesh;
      const geometry = this.geometryOf(drawable);
      pass.setPipeline(this.pipelineOf(program, geometry, look, drawable.mirrored === true));
      program.layouts.forEach((layout, group) => {
        const entries = program.bindings.filter((each) => each.group === group);
        const resource = (entry: Binding) => this.resource(entry, view, look, environment, geometry);
        pass.setBindGroup(group, this.device.createBindGroup({ layout, entries: entries.map((entry) => ({ binding: entry.binding, resource: resource(entry) })) }));
      });
      program.inputs.forEach(({ name }, i) => {
        const attribute = geometry.attributes.get(name);
        pass.setVertexBuffer(i, attribute?.buffer ?? this.constant, attribute || name === 'COLOR_0' ? 0 : 16);
      });
      pass.setIndexBuffer(geometry.indices, 'uint32');
      pass.drawIndexed(geometry.count);
    }
  }

  private pipelineOf(program: Program, geometry: Geometry, look: Look, mirrored: boolean): GPURenderPipeline {
    const sizes = program.inputs.map(({ name }) => geometry.attributes.get(name)?.size ?? 0);
    const key = [look.blended, look.doubleSided, mirrored, sizes].join();
    let made = program.pipelines.get(key);
    if (made) return made;
    const blend: GPUBlendState = {
      color: { srcFactor: 'src-alpha', dstFactor: 'one-minus-src-alpha' }, alpha: { srcFactor: 'one', dstFactor: 'one-minus-src-alpha' },
    };
    const full = (type: string) => Number(/\d/.exec(type)?.[0] ?? 1);
    const format = (size: number) => (size === 1 ? 'float32' : `float32x${size}`) as GPUVertexFormat;
    made = this.device.createRenderPipeline({
      layout: this.device.createPipelineLayout({ bindGroupLayouts: program.layouts }),
      vertex: {
        module: program.stages.vertex,
        buffers: program.inputs.map(({ location, type }, i) => ({
          arrayStride: 4 * sizes[i],
          attributes: [{ shaderLocation: location, offset: 0, format: format(sizes[i] || full(type)) }],
        })),
      },
      fragment: { module: program.stages.fragment, targets: [{ format: kColor, blend: look.blended ? blend : undefined }] },
      primitive: { cullMode: look.doubleSided ? 'none' : 'back', frontFace: mirrored ? 'cw' : 'ccw' },
      depthStencil: { format: 'depth24plus', depthWriteEnabled: !look.blended, depthCompare: 'less' },
      multisample: { count: kSamples },
    });
    program.pipelines.set(key, made);
    return made;
  }

  private resource({ name, buffer, sampler }: Binding, view: Viewport, look: Look, environment: Environment, geometry: Geometry): GPUBindingResource {
    if (buffer) {
      if (name === 'Object') return { buffer: geometry.object };
      if (name !== 'Material') return { buffer: this.blocks.get(name)! };
      const made = once(this.materials, look, () => ({ buffer: this.buffer(look.block, GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST), version: look.version }));
      if (made.version !== look.version) this.device.queue.writeBuffer(made.buffer, 0, look.block as Uint8Array<ArrayBuffer>);
      made.version = look.version;
      return { buffer: made.buffer };
    }
    const of = sampler ? name.replace(/_sampler$/, '') : name;
    const slot = look.slots.get(of);
    const key = slot ? slotKey(slot) : '';
    if (sampler) return this.samplerOf(slot ? view.bitmaps.get(key)?.sampler : null);
    if (of === 'environment_irradiance') return this.cubeOf(environment.irradiance);
    if (of === 'environment_specular' || of === 'environment_charlie') return this.cubeOf(environment.specular);
    if (of === 'scene_behind') return this.target!.behind!.createView();
    return this.tables[of] ?? this.imageOf(view, key, slot?.srgb === true) ?? this.plain(neutral(of));
  }

  private present(encoder: GPUCommandEncoder, view: Viewport, target: Target, cut: number, onto: GPUTexture): void {
    this.device.queue.writeBuffer(this.shown, 0, new Float32Array([...view.back(), view.exposure, view.other ? cut : -10, 0, 0, 0]));
    const pass = encoder.beginRenderPass({
      colorAttachments: [{ view: onto.createView(), loadOp: 'clear', storeOp: 'store' }],
    });
    pass.setPipeline(this.show);
    const entries = [{ binding: 0, resource: { buffer: this.shown } }, { binding: 1, resource: target.resolved.createView() }];
    pass.setBindGroup(0, this.device.createBindGroup({ layout: this.show.getBindGroupLayout(0), entries }));
    pass.draw(3);
    pass.end();
  }

  // ---- objects of WebGPU

  private buffer(data: ArrayBufferView, usage: GPUBufferUsageFlags): GPUBuffer {
    const made = this.device.createBuffer({ size: Math.max(16, Math.ceil(data.byteLength / 4) * 4), usage, mappedAtCreation: true });
    new Uint8Array(made.getMappedRange()).set(new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
    made.unmap();
    return made;
  }
  private fill(name: string, bytes: Uint8Array): void {
    if (!kBlocks.includes(name)) throw new Error(`there is no block ${name}`);
    let made = this.blocks.get(name);
    if (!made) {
      made = this.device.createBuffer({ size: bytes.length, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST });
      this.blocks.set(name, made);
    }
    this.device.queue.writeBuffer(made, 0, bytes as Uint8Array<ArrayBuffer>);
  }

  private geometryOf(drawable: Drawable): Geometry {
    const made = once(this.geometries, drawable, () => this.makeGeometry(drawable));
    if (made.model !== drawable.model) this.device.queue.writeBuffer(made.object, 0, objectBlock(drawable));
    made.model = drawable.model;
    for (const numbers of made.moving) {
      if (this.versions.get(numbers) === numbers.version) continue;
      this.device.queue.writeBuffer(this.arrays.get(numbers.data)!, 0, numbers.data as Float32Array<ArrayBuffer>);
      this.versions.set(numbers, numbers.version!);
    }
    return made;
  }
  private makeGeometry(drawable: Drawable): Geometry {
    const arrayOf = (data: Float32Array | Uint32Array, usage: number) => once(this.arrays, data, () => this.buffer(data, usage | GPUBufferUsage.COPY_DST));
    const attributes: Geometry['attributes'] = new Map();
    const moving: Numbers[] = [];
    for (const [name, numbers] of drawable.attributes) {
      if (!kLocations.includes(name)) continue;
      attributes.set(name, { buffer: arrayOf(numbers.data, GPUBufferUsage.VERTEX), size: numbers.size });
      if (numbers.version !== undefined) moving.push(numbers);
    }
    return {
      attributes, object: this.buffer(objectBlock(drawable), GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST), count: drawable.indices.length,
      indices: arrayOf(drawable.indices, GPUBufferUsage.INDEX), model: drawable.model, moving,
    };
  }

  private write(texture: GPUTexture, data: ArrayBufferView, bytesPerRow: number, level = 0, layer = 0): void {
    const size = [Math.max(1, texture.width >> level), Math.max(1, texture.height >> level)];
    this.device.queue.writeTexture({ texture, mipLevel: level, origin: [0, 0, layer] }, data as Uint8Array<ArrayBuffer>, { bytesPerRow }, size);
  }
  private image(size: [number, number], format: GPUTextureFormat, data: ArrayBufferView, bytesPerRow: number): GPUTextureView {
    const texture = this.device.createTexture({ size, format, usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST });
    this.write(texture, data, bytesPerRow);
    return texture.createView();
  }
  private plain(rgba: number[]): GPUTextureView {
    const key = `color:${rgba}`;
    let made = this.textures.get(key);
    if (!made) this.textures.set(key, (made = this.image([1, 1], 'rgba8unorm', new Uint8Array(rgba), 4)));
    return made;
  }
  private imageOf(view: Viewport, key: string, srgb: boolean): GPUTextureView | null {
    const found = this.textures.get(key);
    const of = view.bitmaps.get(key);
    if (found || !of) return found ?? null;
    const size: [number, number] = [of.bitmap.width, of.bitmap.height];
    const made = this.withLevels(size, srgb ? 'rgba8unorm-srgb' : 'rgba8unorm', (texture) =>
      this.device.queue.copyExternalImageToTexture({ source: of.bitmap }, { texture }, size),
    );
    this.textures.set(key, made);
    return made;
  }

  /** A texture whose first level `fill` writes, and the others are drawn from the one before. */
  private withLevels(size: [number, number], format: GPUTextureFormat, fill: (texture: GPUTexture) => void): GPUTextureView {
    const { device } = this;
    const mipLevelCount = 1 + Math.floor(Math.log2(Math.max(...size)));
    const usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST | GPUTextureUsage.RENDER_ATTACHMENT;
    const texture = device.createTexture({ size, format, mipLevelCount, usage });
    fill(texture);
    const encoder = device.createCommandEncoder();
    this.shrinkLevels(encoder, texture);
    device.queue.submit([encoder.finish()]);
    return texture.createView();
  }
  /** Each level from the one before. */
  private shrinkLevels(encoder: GPUCommandEncoder, texture: GPUTexture): void {
    const { format, mipLevelCount } = texture;
    let pipeline = this.shrink.get(format);
    if (!pipeline) this.shrink.set(format, (pipeline = this.fullscreen(kShrink, format)));
    const of = (baseMipLevel: number) => texture.createView({ baseMipLevel, mipLevelCount: 1 });
    for (let level = 1; level < mipLevelCount; ++level) {
      this.onto(encoder, pipeline, of(level), [
        { binding: 0, resource: this.samplerOf({ wrapS: 33071, wrapT: 33071 }) }, { binding: 1, resource: of(level - 1) },
      ]);
    }
  }
  /** Fills all of a view by a pipeline of fullscreen(). */
  private onto(encoder: GPUCommandEncoder, pipeline: GPURenderPipeline, view: GPUTextureView, entries: GPUBindGroupEntry[]): void {
    const pass = encoder.beginRenderPass({ colorAttachments: [{ view, loadOp: 'clear', storeOp: 'store' }] });
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, this.device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries }));
    pass.draw(3);
    pass.end();
  }

  private cubeOf(cube: Cube): GPUTextureView {
    const { size, levels, version } = cube;
    let made = this.cubes.get(cube);
    if (made?.version === version) return made.view;
    if (!made) {
      const texture = this.device.createTexture({
        size: [size, size, 6], format: 'rgba16float', mipLevelCount: levels.length, usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST,
      });
      this.cubes.set(cube, (made = { texture, view: texture.createView({ dimension: 'cube' }), version }));
    }
    const { texture } = made;
    levels.forEach((faces, level) => faces.forEach((texels, i) => this.write(texture, halves(texels), 8 * Math.max(1, size >> level), level, i)));
    made.version = version;
    return made.view;
  }

  /** By the numbers of a glTF sampler; without one, as maps and tables are read. */
  private samplerOf(of: any): GPUSampler {
    const modes: Record<number, GPUAddressMode> = { 33071: 'clamp-to-edge', 33648: 'mirror-repeat', 10497: 'repeat' };
    const mode = (wrap: number | undefined) => (of === null ? 'clamp-to-edge' : modes[wrap ?? 10497] ?? 'repeat');
    const key = `${mode(of?.wrapS)} ${mode(of?.wrapT)} ${of?.magFilter}`;
    let made = this.samplers.get(key);
    if (!made) {
      made = this.device.createSampler({
        addressModeU: mode(of?.wrapS), addressModeV: mode(of?.wrapT), magFilter: of?.magFilter === 9728 ? 'nearest' : 'linear',
        minFilter: 'linear', mipmapFilter: 'linear',
      });
      this.samplers.set(key, made);
    }
    return made;
  }

  private fullscreen(code: string, format: GPUTextureFormat, more: Partial<GPURenderPipelineDescriptor> = {}): GPURenderPipeline {
    const module = this.device.createShaderModule({ code: kTriangle + code });
    return this.device.createRenderPipeline({ layout: 'auto', vertex: { module }, fragment: { module, targets: [{ format }] }, ...more });
  }

  private targetOf(width: number, height: number): Target {
    if (this.target?.width === width && this.target.height === height) return this.target;
    for (const each of this.target ? [this.target.color, this.target.depth, this.target.resolved, this.target.behind] : []) each?.destroy();
    const make = (format: GPUTextureFormat, sampleCount: number, usage: number) =>
      this.device.createTexture({ size: [width, height], format, sampleCount, usage: usage | GPUTextureUsage.RENDER_ATTACHMENT });
    this.target = {
      width, height, color: make(kColor, kSamples, 0), depth: make('depth24plus', kSamples, 0), resolved: make(kColor, 1, GPUTextureUsage.TEXTURE_BINDING), behind: null,
    };
    return this.target;
  }
}

const kTriangle = `
struct Corner { @builtin(position) place: vec4f, @location(0) uv: vec2f }
@vertex fn corner(@builtin(vertex_index) i: u32) -> Corner {
  let xy = vec2f(select(-1.0, 3.0, i == 1u), select(-1.0, 3.0, i == 2u));
  return Corner(vec4f(xy, 1.0, 1.0), vec2f(0.5 + 0.5 * xy.x, 0.5 - 0.5 * xy.y));
}`;

const kShrink = `
@group(0) @binding(0) var taken: sampler;
@group(0) @binding(1) var larger: texture_2d<f32>;
@fragment fn pixel(at: Corner) -> @location(0) vec4f { return textureSample(larger, taken, at.uv); }`;

const kTake = `
@group(0) @binding(0) var picture: texture_2d<f32>;
@fragment fn pixel(at: Corner) -> @location(0) vec4f {
  let c = textureLoad(picture, vec2i(at.place.xy), 0);
  let square = vec2i(floor(vec2f(at.uv.x, 1.0 - at.uv.y) * ${kBoard.squares.toFixed(1)}));
  let board = select(${kBoard.dark}, ${kBoard.light}, ((square.x + square.y) & 1) == 1);
  return vec4f(c.rgb + (1.0 - clamp(c.a, 0.0, 1.0)) * board, 1.0);
}`;

const kSurround = `
struct Around { right: vec3f, level: f32, up: vec3f, brightness: f32, ahead: vec3f }
@group(0) @binding(0) var<uniform> around: Around;
@group(0) @binding(1) var map: texture_cube<f32>;
@group(0) @binding(2) var taken: sampler;
@fragment fn pixel(at: Corner) -> @location(0) vec4f {
  let xy = vec2f(2.0 * at.uv.x - 1.0, 1.0 - 2.0 * at.uv.y);
  let along = xy.x * around.right + xy.y * around.up + around.ahead;
  return vec4f(around.brightness * textureSampleLevel(map, taken, along, around.level).rgb, 1.0);
}`;

/** The same as the viewport's in WebGL. */
const kShow = `
struct Shown { back: vec3f, exposure: f32, cut: f32 }
@group(0) @binding(0) var<uniform> shown: Shown;
@group(0) @binding(1) var picture: texture_2d<f32>;
fn neutral(linear: vec3f) -> vec3f {
  let start = 0.8 - 0.04;
  let least = min(linear.r, min(linear.g, linear.b));
  let c = linear - select(0.04, least - 6.25 * least * least, least < 0.08);
  let peak = max(c.r, max(c.g, c.b));
  if (peak < start) { return c; }
  let d = 1.0 - start;
  let new_peak = 1.0 - d * d / (peak + d - start);
  return mix(c * (new_peak / peak), vec3f(new_peak), 1.0 - 1.0 / (0.15 * (peak - new_peak) + 1.0));
}
fn encode(c: vec3f) -> vec3f {
  return mix(c * 12.92, 1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055, step(vec3f(0.0031308), c));
}
@fragment fn pixel(at: Corner) -> @location(0) vec4f {
  let c = textureLoad(picture, vec2i(at.place.xy), 0);
  let a = clamp(c.a, 0.0, 1.0);
  let lit = encode(clamp(neutral(max(c.rgb / max(a, 1e-4), vec3f(0.0)) * shown.exposure), vec3f(0.0), vec3f(1.0)));
  return vec4f(select(mix(shown.back, lit, a), vec3f(0.85), abs(at.place.x - shown.cut) < 1.0), 1.0);
}`;
