// Draws materials with their own shaders: the Essl texts, blocks by the offsets that the shader's interface tells.
import type { Interface, Shader } from '../src/index';
import type { Pass } from '../src/types';
import { Behind, backgroundLevel, kTriangleVertex, lastLod, type Background, type Copy } from './behind';
import { constantEnvironment, environmentOf, Turned, type Cube, type Environment } from './environment';
import { bounds, image, sourceOf, type Drawable, type GltfFile, type Numbers } from '../src/gltf';
import type { GpuPainter } from './gpu';
import { isCount, item, list } from '../src/json';
import { frameBlocks, kPicturesPerSecond, type Surroundings } from './frame';
import { directional, kStudioLights, type Light } from './lights';
import { identity, mirrors, multiply, point, type Mat4, type Vec3 } from '../src/math';
import { firstMet } from './pick';
import { ball, cornersUv, flatDrawable, neutral } from './shapes';
import { kShowFragment } from './tone';
import { orbiting, type View } from './view';

/** A glTF texture's index, its colour space, and where the graph has it how it is looked up, as a glTF sampler: else as the file's
 * sampler says. */
export interface Slot {
  texture: number;
  srgb: boolean;
  sampler?: { wrapS: number; wrapT: number; magFilter: number };
}
export const slotKey = ({ texture, srgb, sampler }: Slot) => `${texture}:${srgb}:${sampler ? JSON.stringify(sampler) : ''}`;

/** A material to draw with: its program, and its textures by slot. */
export interface Look {
  id: string;
  block: Uint8Array;
  /** Another one each time that the block is written anew. */
  version?: number;
  /** By slot. */
  slots: Map<string, Slot>;
  doubleSided: boolean;
  blended: boolean;
  /** As the manifest has it. */
  pass: Pass;
}

interface Program {
  program: WebGLProgram;
  interface: Interface;
  inputs: { name: string; location: number }[];
  samplers: { name: string; type: string; unit: number }[];
}

interface Mesh {
  drawable: Drawable;
  arrays: WebGLVertexArrayObject;
  /** None where they are another mesh's. */
  buffers: WebGLBuffer[];
  /** Of numbers that change: those that are in the buffers. */
  moving: Moving[];
  count: number;
  /** Of its box, before its place in the world. */
  middle: Vec3;
}
interface Moving {
  numbers: Numbers;
  buffer: WebGLBuffer;
  version: number;
}
/** What is drawn in columns of the picture: with `instead` in place of the shown material's look. */
interface Side {
  instead: Look | null;
  from: number;
  to: number;
}

/** Radii from the middle to the eye, at first. */
const kDistance = 3.4;
/** Programs that are kept; of more, the oldest that nothing is drawn with goes. */
export const kMostPrograms = 48;
export const kBlocks = ['Frame', 'Lights', 'Object', 'Material', 'SeeThrough', 'Clock'];
/** Where the time begins anew: beyond, a float counts no single pictures. */
const kLastSecond = 2 ** 24 / kPicturesPerSecond;
const kInputs: Record<string, string> = {
  in_position: 'POSITION', in_normal: 'NORMAL', in_tangent: 'TANGENT', in_color_0: 'COLOR_0',
  in_texcoord_0: 'TEXCOORD_0', in_texcoord_1: 'TEXCOORD_1', in_texcoord_2: 'TEXCOORD_2', in_texcoord_3: 'TEXCOORD_3',
};
/** Where the vertex shaders have their attributes (docs/bindings.md). */
export const kLocations = ['POSITION', 'NORMAL', 'TANGENT', 'TEXCOORD_0', 'TEXCOORD_1', 'TEXCOORD_2', 'TEXCOORD_3', 'COLOR_0'];
export const kSolid: Pass[] = ['opaque', 'masked'];
export const kSorted: Pass[] = ['looks_through', 'blended'];
const kPasses: Pass[] = [...kSolid, ...kSorted];
/** Linear colours with several samples for each pixel, and without. */
interface Target {
  frame: WebGLFramebuffer;
  resolved: WebGLFramebuffer;
  color: WebGLTexture;
  /** What is seen through glass, once something is. */
  behind?: Copy;
  width: number;
  height: number;
}

/** The maps of an environment, uploaded. */
interface Maps {
  specular: WebGLTexture;
  irradiance: WebGLTexture;
  /** Of the environment's specular map. */
  version: number;
  /** What is seen through what transmits. */
  behind?: WebGLTexture;
}

/** Takes out of a map of programs, oldest first, what is too much of it; what is in use stays. */
export function dropOldest<T>(programs: Map<string, T>, used: Set<string>): T[] {
  const dropped: T[] = [];
  for (const [id, program] of programs) {
    if (programs.size < kMostPrograms) break;
    if (used.has(id)) continue;
    programs.delete(id);
    dropped.push(program);
  }
  return dropped;
}

/** Texels that all images of a file may have together: 256 MB. */
const kMostTexels = 2 ** 26;

/** Pixels of a side that each of so many images may have, a power of two; larger ones are shown smaller. */
export function mostPixels(images: number): number {
  return 2 ** Math.floor(Math.log2(Math.sqrt(kMostTexels / Math.max(images, 1))));
}

export class Viewport {
  readonly gl: WebGL2RenderingContext;
  private programs = new Map<string, Program>();
  private meshes: Mesh[] = [];
  private ballMesh: Mesh;
  private maps = new WeakMap<Environment, Maps>();
  private textures = new Map<string, WebGLTexture>();
  /** Textures that were asked for; another file has another map. */
  private loading = new Map<string, Promise<void>>();
  /** The images of the textures above, for another painter. */
  readonly bitmaps = new Map<string, { bitmap: ImageBitmap; sampler: any }>();
  private blocks: WebGLBuffer[] = [];
  private show: WebGLProgram;
  private target: Target | null = null;
  private tables: { dfg: WebGLTexture; sheen: WebGLTexture };
  private behind: Behind;
  private second: Target | null = null;
  private pending = 0;

  /** Of the file's own, in place of the orbit. */
  camera: View | null = null;
  orbit = { yaw: 0.35, pitch: 0.2, distance: kDistance };
  middle: Vec3 = [0, 0, 0];
  radius = 1;
  environment = 'Studio';
  /** Of what is around, about +y. */
  turn = 0;
  private readonly turned = new Turned();
  exposure = 1;
  background: Background = 'plain';
  /** What is around is as bright. */
  brightness = 1;
  /** Of the materials' time, which runs while something that is drawn asks for it. */
  seconds = 0;
  playing = !matchMedia('(prefers-reduced-motion: reduce)').matches;
  /** Told before each picture whether something asks for the time. */
  onClock: (asked: boolean) => void = () => {};
  /** Told after each picture. */
  onDrawn: () => void = () => {};
  /** Told before each picture; whether the next one is another. */
  onMoment: () => boolean = () => false;
  /** Where what moves comes to; null where nothing does. */
  reach: { middle: Vec3; radius: number } | null = null;
  private ticked = 0;
  useBall = true;
  lights: Light[] = kStudioLights;
  /** Draws in place of this, on a canvas of its own. */
  gpu: GpuPainter | null = null;
  /** What to draw of each material; -1 stands for the default one. */
  looks = new Map<number, Look>();
  /** The material that the ball shows. */
  shown = 0;
  /** Another look of the shown material, right of the place (0 to 1 of the width), or by how much it differs. */
  other: { look: Look; split: number; difference?: boolean } | null = null;

  constructor(readonly canvas: HTMLCanvasElement, dfg: Float32Array, sheen: Float32Array) {
    const gl = canvas.getContext('webgl2', { alpha: false, antialias: false, preserveDrawingBuffer: true });
    if (!gl) throw new Error('this browser has no WebGL 2');
    this.gl = gl;
    if (!gl.getExtension('EXT_color_buffer_float')) throw new Error('this browser cannot draw to floating point');
    this.blocks = kBlocks.map(() => gl.createBuffer()!);
    this.ballMesh = this.upload(ball());
    this.tables = { dfg: this.pairs(dfg), sheen: this.pairs(sheen) };
    this.behind = new Behind(gl, (vertex, fragment) => this.link(vertex, fragment));
    this.show = this.link(kTriangleVertex, kShowFragment);
  }

  // ---- what there is to draw

  setScene(drawables: Drawable[]): void {
    for (const mesh of this.meshes) this.dropMesh(mesh);
    // What is at several places is uploaded once, and so are the numbers that several primitives have.
    const shapes = new Map<Drawable['attributes'], Mesh>();
    const uploaded = new Map<ArrayBufferView, WebGLBuffer>();
    this.meshes = drawables.map((drawable) => {
      const same = shapes.get(drawable.attributes);
      const mesh = same ? { ...same, drawable, buffers: [] } : this.upload(drawable, uploaded);
      shapes.set(drawable.attributes, mesh);
      drawable.mirrored ??= mirrors(drawable.model);
      return mesh;
    });
    this.fit();
  }
  fit(): void {
    const own = !this.useBall && this.meshes.length > 0;
    const { middle, radius } = own ? this.reach ?? bounds(this.meshes.map((m) => m.drawable)) : { middle: [0, 0, 0] as Vec3, radius: 1 };
    this.middle = middle;
    this.radius = radius;
    this.orbit.distance = kDistance;
    this.redraw();
  }
  /** Moves what is looked at to the right and up, by halves of the picture's height. */
  pan(right: number, up: number): void {
    const { view } = orbiting(this.orbit, this.middle, this.radius);
    const by = this.orbit.distance * this.radius * Math.tan(0.36);
    this.middle = this.middle.map((x, i) => x + by * (right * view[4 * i] + up * view[4 * i + 1])) as Vec3;
    this.redraw();
  }
  /** The material of the file's own that is seen at a place of the picture, from -1 to 1. */
  materialAt(x: number, y: number): number | undefined {
    if (this.useBall) return undefined;
    const canvas = this.gpu?.canvas ?? this.canvas;
    const rays = this.rays(canvas.clientWidth / Math.max(canvas.clientHeight, 1));
    const along = [0, 1, 2].map((i) => x * rays[i] + y * rays[3 + i] + rays[6 + i]) as Vec3;
    return firstMet(this.meshes.map(({ drawable }) => drawable).filter(({ hidden }) => !hidden), this.eye(), along)?.material;
  }

  /** Loads the file's textures that a look has, then draws again. */
  async loadTextures(file: GltfFile, look: Look): Promise<void> {
    await Promise.all([...look.slots.values()].map((slot) => {
      const key = slotKey(slot);
      if (!this.loading.has(key)) this.loading.set(key, this.loadTexture(file, slot, key));
      return this.loading.get(key);
    }));
    this.redraw();
  }
  private async loadTexture(file: GltfFile, { texture, srgb, sampler: own }: Slot, key: string): Promise<void> {
    const { loading, gl } = this;
    const of = item(file.json.textures, texture);
    const most = Math.min(mostPixels(list(file.json.images).length), gl.getParameter(gl.MAX_TEXTURE_SIZE));
    const bitmap = of ? await image(file, sourceOf(of), most) : null;
    if (!bitmap) return;
    if (this.loading !== loading) return bitmap.close(); // of a file that has gone
    const sampler = own ?? Object.fromEntries(Object.entries(item(file.json.samplers, of.sampler) ?? {}).filter(([, x]) => isCount(x)));
    this.bitmaps.set(key, { bitmap, sampler });
    this.textures.set(key, this.imageTexture(bitmap, srgb, sampler));
  }
  forgetTextures(): void {
    this.loading = new Map();
    for (const texture of this.textures.values()) this.gl.deleteTexture(texture);
    for (const { bitmap } of this.bitmaps.values()) bitmap.close();
    this.textures.clear();
    this.bitmaps.clear();
    this.gpu?.forgetTextures();
  }

  /** Makes the program of a shader where there is none yet. Throws what the driver says. */
  prepare(shader: Shader): void {
    const id = shader.id;
    this.gpu?.prepare(shader, this.idsDrawn());
    if (this.programs.has(id)) return;
    const { gl } = this;
    const program = this.link(shader.text('essl', 'vertex'), shader.text('essl', 'fragment'));
    const inputs: Program['inputs'] = [];
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_ATTRIBUTES); ++i) {
      const { name } = gl.getActiveAttrib(program, i)!;
      inputs.push({ name: kInputs[name] ?? name, location: gl.getAttribLocation(program, name) });
    }
    kBlocks.forEach((name, binding) => {
      const index = gl.getUniformBlockIndex(program, name);
      if (index !== gl.INVALID_INDEX) gl.uniformBlockBinding(program, index, binding);
    });
    gl.useProgram(program);
    const samplers = shader.interface.textures.map(({ name, type }, unit) => {
      gl.uniform1i(gl.getUniformLocation(program, name), unit);
      return { name, type, unit };
    });
    for (const { program } of dropOldest(this.programs, this.idsDrawn())) gl.deleteProgram(program);
    this.programs.set(id, { program, interface: shader.interface, inputs, samplers });
  }
  /** Of the shaders that something is drawn with. */
  idsDrawn(): Set<string> {
    const ids = new Set([...this.looks.values()].map(({ id }) => id));
    if (this.other) ids.add(this.other.look.id);
    return ids;
  }
  get programCount(): number {
    return this.programs.size;
  }

  // ---- drawing

  redraw(): void {
    if (this.pending === 0) this.pending = requestAnimationFrame(() => this.draw());
  }

  /** The canvas that is seen, with as many pixels as its place on the page has. */
  private sized(canvas: HTMLCanvasElement): { width: number; height: number } {
    const ratio = Math.min(devicePixelRatio, 2);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    return { width, height };
  }

  /** Lets the time go on, and asks for the next picture where this one is of its moment alone. */
  private tick(): void {
    const asks = (look: Look) => this.programs.get(look.id)?.interface.uniforms.some(({ block }) => block === 'Clock') === true;
    const asked = [...this.drawn(null)].some(({ look }) => asks(look)) || (this.other !== null && asks(this.other.look));
    this.onClock(asked);
    const now = performance.now();
    const running = asked && this.playing;
    // A page that was hidden goes on where it was.
    if (running && this.ticked > 0) this.seconds = (this.seconds + Math.min(now - this.ticked, 250) / 1000) % kLastSecond;
    this.ticked = running ? now : 0;
    if (running) this.redraw();
  }

  draw(): void {
    this.pending = 0;
    this.tick();
    if (this.onMoment()) this.redraw();
    if (this.gpu) this.gpu.paint(this, this.sized(this.gpu.canvas));
    else this.drawHere();
    this.onDrawn();
  }
  private drawHere(): void {
    const { width, height } = this.sized(this.canvas);
    const target = this.targetOf(width, height);
    const environment = this.around();
    if (this.other?.difference) return this.drawDifference(target, environment, this.other.look);
    const cut = this.cut(width);
    const sides: Side[] = [{ instead: null, from: 0, to: cut }];
    if (this.other) sides.push({ instead: this.other.look, from: cut, to: width });
    this.drawAll(target, environment, sides);
    this.present(target, cut, target);
  }

  /** What draw() shows with as many pixels as there are now, rows from the top, RGBA. */
  pixels(): Uint8Array {
    const { gl } = this;
    this.draw();
    const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const rows = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rows);
    const pixels = new Uint8Array(rows.length);
    for (let y = 0; y < height; ++y) pixels.set(rows.subarray(4 * width * y, 4 * width * (y + 1)), 4 * width * (height - 1 - y));
    return pixels;
  }

  private drawDifference(target: Target, environment: Environment, look: Look): void {
    const { width, height } = target;
    this.drawAll(target, environment, [{ instead: null, from: 0, to: width }]);
    if (this.second?.width !== width || this.second.height !== height) {
      if (this.second) this.dropTarget(this.second);
      this.second = this.makeTarget(width, height);
    }
    this.drawAll(this.second, environment, [{ instead: look, from: 0, to: width }]);
    this.resolve(this.second);
    this.present(target, -10, this.second);
  }

  /** The environment, turned. */
  around(): Environment {
    return this.turned.of(environmentOf(this.environment), this.turn);
  }
  /** The column from which on the other look is seen. */
  cut(width: number): number {
    return this.other ? Math.round(width * this.other.split) : width;
  }
  /** The page's colour behind the material. */
  back(): number[] {
    return getComputedStyle(this.canvas).getPropertyValue('--viewport').trim().split(' ').map((x) => Number(x) / 255);
  }

  /** What is drawn in those passes, and how it looks, in order; `instead` is another look of the shown material. */
  *drawn(instead: Look | null, passes: Pass[] = kPasses): Generator<{ mesh: Mesh; look: Look }> {
    const own = !this.useBall && this.meshes.length > 0;
    for (const pass of passes) {
      const found: { mesh: Mesh; look: Look }[] = [];
      for (const mesh of own ? this.meshes : [this.ballMesh]) {
        if (own && mesh.drawable.hidden) continue;
        const material = own ? mesh.drawable.material : this.shown;
        const look = instead && material === this.shown ? instead : this.looks.get(material);
        if (look?.pass === pass) found.push({ mesh, look });
      }
      yield* kSorted.includes(pass) ? this.fromBack(found) : found;
    }
  }
  /** By their middles along the view. */
  private fromBack<T extends { mesh: Mesh }>(found: T[]): T[] {
    if (found.length < 2) return found;
    const { view } = this.view();
    const [x, y, z] = [-view[2], -view[6], -view[10]];
    const far = new Map(found.map(({ mesh }) => {
      const at = point(mesh.drawable.model, mesh.middle);
      return [mesh, x * at[0] + y * at[1] + z * at[2]];
    }));
    return found.sort((a, b) => far.get(b.mesh)! - far.get(a.mesh)!);
  }

  /** A frame by its passes, as docs/bindings.md has them, onto a target. */
  private drawAll(target: Target, environment: Environment, sides: Side[]): void {
    const { gl, background, brightness } = this;
    const { width, height } = target;
    const maps: Maps = { ...this.mapsOf(environment) };
    const aspect = width / height;
    this.frame(this.eye(), this.viewProjection(aspect), environment, this.lights, { lod: lastLod(width, height), brightness });
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.drawSides(sides, kSolid, maps, height);
    if (background !== 'plain') this.behind.surround(maps.specular, this.rays(aspect), backgroundLevel(background, environment.lastLevel), brightness);
    if (sides.some(({ instead }) => !this.drawn(instead, ['looks_through']).next().done)) {
      this.resolve(target);
      target.behind ??= this.behind.make(width, height);
      this.behind.take(target.color, target.behind);
      maps.behind = target.behind.texture;
      gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
    }
    this.drawSides(sides, kSorted, maps, height);
  }
  private drawSides(sides: Side[], passes: Pass[], maps: Maps, height: number): void {
    const { gl } = this;
    gl.enable(gl.SCISSOR_TEST);
    for (const { instead, from, to } of sides) {
      gl.scissor(from, 0, to - from, height);
      for (const { mesh, look } of this.drawn(instead, passes)) this.drawMesh(mesh, look, maps);
    }
    gl.disable(gl.SCISSOR_TEST);
  }

  private drawMesh(mesh: Mesh, look: Look, maps: Maps): void {
    const { gl } = this;
    const made = this.programs.get(look.id);
    if (!made) return;
    gl.useProgram(made.program);
    gl.enable(gl.DEPTH_TEST);
    gl[look.doubleSided ? 'disable' : 'enable'](gl.CULL_FACE);
    gl.frontFace(mesh.drawable.mirrored ? gl.CW : gl.CCW);
    gl[look.blended ? 'enable' : 'disable'](gl.BLEND);
    gl.depthMask(!look.blended);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.fill('Material', look.block);
    const object = new Float32Array(32);
    object.set(mesh.drawable.model);
    object.set(mesh.drawable.normal, 16);
    this.fill('Object', new Uint8Array(object.buffer));
    for (const { name, type, unit } of made.samplers) {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(type === 'samplerCube' ? gl.TEXTURE_CUBE_MAP : gl.TEXTURE_2D, this.textureOf(name, look, maps));
    }
    this.refresh(mesh);
    gl.bindVertexArray(mesh.arrays);
    gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
    gl.depthMask(true);
  }

  private refresh({ moving }: Mesh): void {
    const { gl } = this;
    for (const each of moving) {
      if (each.version === each.numbers.version) continue;
      gl.bindBuffer(gl.ARRAY_BUFFER, each.buffer);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, each.numbers.data as Float32Array<ArrayBuffer>);
      each.version = each.numbers.version!;
    }
  }

  private textureOf(name: string, look: Look, maps: Maps): WebGLTexture {
    if (name === 'environment_irradiance') return maps.irradiance;
    if (name === 'environment_specular' || name === 'environment_charlie') return maps.specular;
    if (name === 'environment_dfg') return this.tables.dfg;
    if (name === 'environment_sheen') return this.tables.sheen;
    if (name === 'scene_behind') return maps.behind!;
    const slot = look.slots.get(name);
    return (slot && this.textures.get(slotKey(slot))) ?? this.colorTexture(neutral(name));
  }

  private frame(eye: Vec3, viewProjection: Mat4, environment: Environment, lights: Light[], around: Surroundings = {}): void {
    for (const [name, bytes] of Object.entries(frameBlocks(eye, viewProjection, environment, lights, this.seconds, around))) this.fill(name, bytes);
  }

  private fill(block: string, bytes: Uint8Array): void {
    const { gl } = this;
    const binding = kBlocks.indexOf(block);
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.blocks[binding]);
    gl.bufferData(gl.UNIFORM_BUFFER, bytes.length > 0 ? bytes : new Uint8Array(16), gl.DYNAMIC_DRAW);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, binding, this.blocks[binding]);
  }

  /** The ball is no part of the file, whose cameras may stand anywhere. */
  private view(): View {
    return (this.useBall ? null : this.camera) ?? orbiting(this.orbit, this.middle, this.radius);
  }
  eye(): Vec3 {
    return this.view().eye;
  }
  viewProjection(aspect: number): Mat4 {
    const { projection, view } = this.view();
    return multiply(projection(aspect), view);
  }
  rays(aspect: number): Float32Array {
    return this.view().rays(aspect);
  }

  private resolve({ frame, resolved, width, height }: Target): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, frame);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, resolved);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
  }

  /** The picture on the canvas; where the second is another, by how much they differ. */
  private present(target: Target, cut: number, second: Target): void {
    const { gl } = this;
    this.resolve(target);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.disable(gl.CULL_FACE);
    gl.useProgram(this.show);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, target.color);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, second.color);
    gl.uniform1i(gl.getUniformLocation(this.show, 'second'), 1);
    gl.uniform1i(gl.getUniformLocation(this.show, 'difference'), second === target ? 0 : 1);
    gl.uniform1f(gl.getUniformLocation(this.show, 'exposure'), this.exposure);
    gl.uniform1f(gl.getUniformLocation(this.show, 'cut'), this.other ? cut : -10);
    gl.uniform3fv(gl.getUniformLocation(this.show, 'back'), this.back());
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  // ---- single colours

  /** What a look's shader gives for a point seen from +z under one light, in a constant environment or one of that name:
   * the linear colour as `lacquer eval` has it. */
  probe(look: Look, at: { n: Vec3; t: number[]; l: Vec3; light: Vec3; env?: Vec3; uv: number[] }, around = ''): number[] {
    const { gl } = this;
    const corners = [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0];
    const four = (x: number[]) => [...x, ...x, ...x, ...x];
    const mesh = this.upload(flatDrawable(corners, four(at.n), four(at.t), cornersUv(at), [0, 1, 2, 0, 2, 3]));
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, 1, 1);
    const frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.viewport(0, 0, 1, 1);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    const environment = around === '' ? constantEnvironment(at.env ?? [0, 0, 0]) : environmentOf(around);
    const maps = { ...this.mapsOf(environment), behind: this.grey() };
    const flat = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -0.01, 0, 0, 0, 0, 1]);
    this.frame([0, 0, 1], flat, environment, [directional(at.l, at.light)]);
    this.drawMesh(mesh, { ...look, blended: false, doubleSided: true }, maps);
    const rgba = new Float32Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.FLOAT, rgba);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.deleteFramebuffer(frame);
    gl.deleteTexture(texture);
    gl.deleteTexture(maps.behind);
    if (around === '') for (const map of [maps.specular, maps.irradiance]) gl.deleteTexture(map);
    this.dropMesh(mesh);
    this.redraw();
    return [...rgba];
  }

  /** How two looks of the shown material differ over the ball's linear colours: the largest and the mean difference. */
  difference(a: Look, b: Look): { max: number; mean: number } {
    const size = 96;
    const draw = (look: Look) => {
      const { gl } = this;
      const target = this.makeTarget(size, size);
      this.drawAll(target, this.around(), [{ instead: look, from: 0, to: size }]);
      this.resolve(target);
      gl.bindFramebuffer(gl.FRAMEBUFFER, target.resolved);
      const pixels = new Float32Array(4 * size * size);
      gl.readPixels(0, 0, size, size, gl.RGBA, gl.FLOAT, pixels);
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
      this.dropTarget(target);
      return pixels;
    };
    const [x, y] = [draw(a), draw(b)];
    let max = 0;
    let sum = 0;
    let count = 0;
    for (let i = 0; i < x.length; ++i) {
      if (i % 4 === 3 || (x[i | 3] === 0 && y[i | 3] === 0)) continue;
      const d = Math.abs(x[i] - y[i]);
      max = Math.max(max, d);
      sum += d;
      ++count;
    }
    return { max, mean: count > 0 ? sum / count : 0 };
  }

  // ---- objects of WebGL

  private mapsOf(environment: Environment): Maps {
    let made = this.maps.get(environment);
    const { specular, irradiance } = environment;
    if (!made) {
      made = { specular: this.cubeTexture(specular), irradiance: this.cubeTexture(irradiance), version: specular.version };
      this.maps.set(environment, made);
    }
    if (made.version !== specular.version) {
      this.fillCube(made.specular, specular);
      this.fillCube(made.irradiance, irradiance);
      made.version = specular.version;
    }
    return made;
  }
  private cubeTexture(cube: Cube): WebGLTexture {
    const { gl } = this;
    const texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_CUBE_MAP, texture);
    gl.texStorage2D(gl.TEXTURE_CUBE_MAP, cube.levels.length, gl.RGBA16F, cube.size, cube.size);
    gl.texParameteri(gl.TEXTURE_CUBE_MAP, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    this.fillCube(texture, cube);
    return texture;
  }
  private fillCube(texture: WebGLTexture, { size, levels }: Cube): void {
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_CUBE_MAP, texture);
    levels.forEach((faces, level) => {
      const width = Math.max(1, size >> level);
      faces.forEach((texels, i) =>
        gl.texSubImage2D(gl.TEXTURE_CUBE_MAP_POSITIVE_X + i, level, 0, 0, width, width, gl.RGBA, gl.FLOAT, texels),
      );
    });
  }

  private upload(drawable: Drawable, uploaded = new Map<ArrayBufferView, WebGLBuffer>()): Mesh {
    const { gl } = this;
    const arrays = gl.createVertexArray()!;
    const buffers: WebGLBuffer[] = [];
    const fill = (kind: number, data: Float32Array | Uint32Array) => {
      const known = uploaded.get(data);
      if (known) gl.bindBuffer(kind, known);
      if (known) return known;
      const buffer = gl.createBuffer()!;
      buffers.push(buffer);
      uploaded.set(data, buffer);
      gl.bindBuffer(kind, buffer);
      gl.bufferData(kind, data as Float32Array<ArrayBuffer>, gl.STATIC_DRAW);
      return buffer;
    };
    const moving: Moving[] = [];
    gl.bindVertexArray(arrays);
    kLocations.forEach((name, location) => {
      const attribute = drawable.attributes.get(name);
      if (!attribute) {
        // Generic values: what a primitive without the attribute is drawn with.
        gl.vertexAttrib4f(location, ...(name === 'COLOR_0' ? [1, 1, 1, 1] : [1, 0, 0, 1]) as [number, number, number, number]);
        return;
      }
      const buffer = fill(gl.ARRAY_BUFFER, attribute.data);
      if (attribute.version !== undefined) moving.push({ numbers: attribute, buffer, version: attribute.version });
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, attribute.size, gl.FLOAT, false, 0, 0);
    });
    fill(gl.ELEMENT_ARRAY_BUFFER, drawable.indices);
    gl.bindVertexArray(null);
    return { drawable, arrays, buffers, moving, count: drawable.indices.length, middle: bounds([{ ...drawable, model: identity() }]).middle };
  }
  private dropMesh({ arrays, buffers }: Mesh): void {
    this.gl.deleteVertexArray(arrays); // where it is another's, too, the second time does nothing
    for (const buffer of buffers) this.gl.deleteBuffer(buffer);
  }

  private compile(kind: number, text: string): WebGLShader {
    const { gl } = this;
    const shader = gl.createShader(kind)!;
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader) ?? 'no shader');
    return shader;
  }
  private link(vertex: string, fragment: string): WebGLProgram {
    const { gl } = this;
    const program = gl.createProgram()!;
    const parts = [this.compile(gl.VERTEX_SHADER, vertex), this.compile(gl.FRAGMENT_SHADER, fragment)];
    for (const part of parts) gl.attachShader(program, part);
    for (const [name, attribute] of Object.entries(kInputs))
      gl.bindAttribLocation(program, kLocations.indexOf(attribute), name);
    gl.linkProgram(program);
    for (const part of parts) gl.deleteShader(part);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) ?? 'no program');
    return program;
  }

  private pairs(data: Float32Array): WebGLTexture {
    const { gl } = this;
    const size = Math.sqrt(data.length / 2);
    const texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RG16F, size, size, 0, gl.RG, gl.FLOAT, data);
    for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    return texture;
  }

  private colorTexture(rgba: [number, number, number, number]): WebGLTexture {
    const key = `color:${rgba}`;
    let made = this.textures.get(key);
    if (!made) {
      const { gl } = this;
      made = gl.createTexture()!;
      gl.bindTexture(gl.TEXTURE_2D, made);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 1, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(rgba));
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      this.textures.set(key, made);
    }
    return made;
  }

  private imageTexture(bitmap: ImageBitmap, srgb: boolean, sampler: any): WebGLTexture {
    const { gl } = this;
    const texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    gl.texImage2D(gl.TEXTURE_2D, 0, srgb ? gl.SRGB8_ALPHA8 : gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, sampler.wrapS ?? gl.REPEAT);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, sampler.wrapT ?? gl.REPEAT);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, sampler.magFilter ?? gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    return texture;
  }

  /** What `lacquer eval` sees through what transmits. */
  private grey(): WebGLTexture {
    const { gl } = this;
    const texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, 1, 1, 0, gl.RGBA, gl.FLOAT, new Float32Array([0.5, 0.5, 0.5, 1]));
    return texture;
  }

  private targetOf(width: number, height: number): Target {
    if (this.target?.width === width && this.target.height === height) return this.target;
    if (this.target) this.dropTarget(this.target);
    return (this.target = this.makeTarget(width, height));
  }
  private makeTarget(width: number, height: number): Target {
    const { gl } = this;
    const samples = Math.min(4, gl.getParameter(gl.MAX_SAMPLES));
    const frame = gl.createFramebuffer()!;
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    const buffer = (format: number, attachment: number) => {
      const made = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, made);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, made);
    };
    buffer(gl.RGBA16F, gl.COLOR_ATTACHMENT0);
    buffer(gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT);
    const color = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, color);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA16F, width, height);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    const resolved = gl.createFramebuffer()!;
    gl.bindFramebuffer(gl.FRAMEBUFFER, resolved);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, color, 0);
    return { frame, resolved, color, width, height };
  }
  private dropTarget(target: Target): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
    for (const attachment of [gl.COLOR_ATTACHMENT0, gl.DEPTH_ATTACHMENT]) {
      const name = gl.getFramebufferAttachmentParameter(gl.FRAMEBUFFER, attachment, gl.FRAMEBUFFER_ATTACHMENT_OBJECT_NAME);
      gl.deleteRenderbuffer(name);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.deleteFramebuffer(target.frame);
    gl.deleteFramebuffer(target.resolved);
    gl.deleteTexture(target.color);
    if (target.behind) this.behind.drop(target.behind);
  }
}
