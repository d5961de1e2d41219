// A material of Babylon.js whose shader is Lacquer's.
import '@babylonjs/core/Engines/Extensions/engine.uniformBuffer.js';
import '@babylonjs/core/Engines/Extensions/engine.rawTexture.js';
import { VertexBuffer } from '@babylonjs/core/Buffers/buffer.js';
import { Constants } from '@babylonjs/core/Engines/constants.js';
import { ImageProcessingConfiguration } from '@babylonjs/core/Materials/imageProcessingConfiguration.js';
import { ShaderMaterial } from '@babylonjs/core/Materials/shaderMaterial.js';
import { BaseTexture } from '@babylonjs/core/Materials/Textures/baseTexture.js';
import { RawTexture } from '@babylonjs/core/Materials/Textures/rawTexture.js';
import { Texture } from '@babylonjs/core/Materials/Textures/texture.js';
import type { Effect } from '@babylonjs/core/Materials/effect.js';
import { UniformBuffer } from '@babylonjs/core/Materials/uniformBuffer.js';
import { Matrix } from '@babylonjs/core/Maths/math.vector.js';
import type { AbstractMesh } from '@babylonjs/core/Meshes/abstractMesh.js';
import type { Mesh } from '@babylonjs/core/Meshes/mesh.js';
import type { SubMesh } from '@babylonjs/core/Meshes/subMesh.js';
import type { Light } from '@babylonjs/core/Lights/light.js';
import type { Scene } from '@babylonjs/core/scene.js';
import type { Nullable } from '@babylonjs/core/types.js';
import './includes.js';
import type { Graph, Lacquer } from '../index.js';
import { fileOf } from '../renderers/file.js';
import { behindValues, changedNumbers, clockValues, esslOf, type Essl } from '../renderers/shader.js';
import type { Attribute, GraphTexture, Message, Options, Parameter, Values } from '../types.js';
import { normalMatrix } from '../webgpu.js';
import { behindOf } from './behind.js';
import { surroundingsOf, tablesOf, type Environment } from './environment.js';
import { drawnLights, lightsOf } from './lights.js';
import { bindShadows, castingOn, prepareShadows } from './shadows.js';
import { babylonText, kindOf, kKinds, kOptional, kUniforms } from './text.js';

const hasColors = (mesh: AbstractMesh): boolean => mesh.useVertexColors && mesh.isVerticesDataPresent(VertexBuffer.ColorKind);
const hasInstanceColors = (mesh: AbstractMesh): boolean =>
  (mesh.hasInstances || mesh.hasThinInstances) && mesh.isVerticesDataPresent(VertexBuffer.ColorInstanceKind);

/** The attributes of a mesh that its shader may use. Skins, morph targets and instances are Babylon.js's matter. */
export function attributesOf(mesh: AbstractMesh): Attribute[] {
  return kOptional.filter((attribute) =>
    attribute === 'COLOR_0' ? hasColors(mesh) || hasInstanceColors(mesh) : mesh.isVerticesDataPresent(kKinds[attribute].kind));
}

/** What of colours ShaderMaterial does not say of a mesh: it knows those of thin instances. */
function colorsOf(mesh: AbstractMesh | undefined, instances: boolean | undefined): { attributes: string[]; defines: string[] } {
  const said = { attributes: [] as string[], defines: [] as string[] };
  if (!mesh) return said;
  if (hasColors(mesh)) said.defines.push('LACQUER_COLORS');
  if (instances && !mesh.hasThinInstances && hasInstanceColors(mesh)) {
    said.attributes.push(VertexBuffer.ColorInstanceKind);
    said.defines.push('INSTANCESCOLOR');
  }
  return said;
}

/** One texel in the place of an image that is not there. */
function texel(scene: Scene, name: string, rgba: number[]): BaseTexture {
  const made = RawTexture.CreateRGBATexture(new Uint8Array(rgba), 1, 1, scene, false, false);
  made.name = name;
  made.gammaSpace = false;
  return made;
}
const texels = new WeakMap<Scene, { white: BaseTexture; flat: BaseTexture }>();
function standIn(scene: Scene, content?: string): BaseTexture {
  let both = texels.get(scene);
  if (!both) {
    both = { white: texel(scene, 'lacquer: white', [255, 255, 255, 255]), flat: texel(scene, 'lacquer: flat', [128, 128, 255, 255]) };
    texels.set(scene, both);
  }
  return content === 'normal' ? both.flat : both.white;
}

/** What is made of a graph once for each kind of mesh, and shared by clones. */
interface Made extends Essl {
  graph: Graph;
  source: { vertexSource: string; fragmentSource: string };
  attributes: string[];
  defines: string[];
}

/** A graph, or what makes one for the attributes of a mesh. */
export type GraphSource = Graph | ((attributes: Attribute[]) => Graph);

/** The programs of a material. */
class Programs {
  private readonly made = new Map<string, Made>();
  constructor(
    private readonly of: GraphSource,
    private readonly options: Options,
    private readonly messages: Message[],
  ) {}

  /** One of them, whichever is there: its parameters and textures are those of all. */
  any(): Made {
    return this.made.values().next().value ?? this.for(kOptional);
  }
  for(attributes: Attribute[]): Made {
    const key = typeof this.of === 'function' ? attributes.join() : '';
    const known = this.made.get(key);
    if (known) return known;
    const graph = typeof this.of === 'function' ? this.of(attributes) : this.of;
    const { text, ...essl } = esslOf(graph, this.options, this.messages, 'Babylon.js');
    const inputs = essl.interface.inputs ?? [];
    const made = {
      ...essl, text, graph,
      source: babylonText(text, essl.interface),
      attributes: ['position', ...inputs.map(({ name }) => kindOf(name)).filter((kind) => kind !== 'position')],
      // Under these Babylon.js moves what morph targets have.
      defines: inputs.map(({ name }) => kKinds[name]?.moved?.under).filter((under) => under && under !== 'VERTEXCOLOR') as string[],
    };
    this.made.set(key, made);
    return made;
  }
}

/** The blocks of one program with the numbers of one material. */
class Blocks {
  private readonly buffers = new Map<string, UniformBuffer>();
  /** For what it was filled last. */
  now = { render: -1, numbers: -1, lights: [] as Light[] };

  constructor(scene: Scene, readonly made: Made) {
    for (const { block, size, array = 1, stride = 0 } of made.interface.uniforms) {
      if (block === 'Object') continue;
      const buffer = new UniformBuffer(scene.getEngine(), undefined, true, `lacquer: ${block}`);
      buffer.addUniform('all', 4, Math.ceil(Math.max(size, array * stride) / 16));
      buffer.create();
      this.buffers.set(block, buffer);
    }
  }
  fill(block: string, values: Values | Values[] | Uint8Array): void {
    const buffer = this.buffers.get(block);
    if (!buffer) return;
    const bytes = values instanceof Uint8Array ? values : this.made.shader.block(block, values);
    buffer.updateUniform('all', new Float32Array(bytes.buffer, bytes.byteOffset, bytes.byteLength / 4), bytes.byteLength / 4);
    buffer.update();
  }
  bind(effect: Effect): void {
    for (const [block, buffer] of this.buffers) effect.bindUniformBuffer(buffer.getBuffer()!, block);
  }
  get names(): string[] {
    return [...this.buffers.keys()];
  }
  dispose(): void {
    for (const buffer of this.buffers.values()) buffer.dispose();
    this.buffers.clear();
  }
}

export interface MaterialOptions {
  /** The pictures of the shader's texture slots, by their names (`graph.textures()`). Those of colours decode sRGB: they were made
   * with `useSRGBBuffer`. */
  textures?: Record<string, BaseTexture | null>;
  /** How the shader is made; the templates `forward` and what extends it are drawn. */
  options?: Options;
  messages?: Message[];
}

/** Draws a graph on any mesh. It has the lights, the fog and the image processing of its scene, clipping planes, skins, morph
 * targets, instances and thin instances with their colours; the surroundings are those of setEnvironment(), or the scene's `environmentTexture`. Shadows fall from it and on
 * it. */
export class LacquerMaterial extends ShaderMaterial {
  readonly isLacquerMaterial = true;
  /** Instead of the scene's. */
  environment: Environment | null = null;
  private readonly programs: Programs;
  private readonly blocks = new Map<Made, Blocks>();
  private readonly slots = new Map<string, BaseTexture>();
  private values: Record<string, number[]> = {};
  private changes = 0;
  private readonly normals = new Matrix();
  private readonly effects: Effect[] = [];

  constructor(
    name: string,
    scene: Scene,
    private readonly lacquer: Lacquer,
    graph: GraphSource,
    { textures = {}, options = {}, messages = [] }: MaterialOptions = {},
    programs = new Programs(graph, options, messages),
  ) {
    super(name, scene, {}, { attributes: [], uniforms: [], uniformBuffers: [], samplers: [], defines: [], useClipPlane: null });
    const engine = scene.getEngine();
    if (engine.isWebGPU || engine.version < 2) throw new TypeError('LacquerMaterial is drawn by an Engine with WebGL 2');
    this.programs = programs;
    this.onEffectCreatedObservable.add(({ effect }) => this.effects.push(effect));
    if (typeof graph !== 'function') this.programs.for([]); // what is wrong with it is said here
    for (const [slot, texture] of Object.entries(textures)) if (texture) this.slots.set(slot, texture);
  }

  override getClassName(): string {
    return 'LacquerMaterial';
  }
  /** The scene is drawn behind it, when it is seen through. */
  get looksThrough(): boolean {
    return this.programs.any().interface.uniforms.some(({ block }) => block === 'SeeThrough');
  }
  /** The numbers that set() takes. */
  parameters(): Parameter[] {
    return this.programs.any().graph.parameters();
  }
  /** Gives parameters other values: no program is made for it. Throws, and changes nothing, where a name is no parameter's or a
   * value no number. Values beyond a range are its ends. */
  set(values: Record<string, number | ArrayLike<number>>): void {
    const changed = changedNumbers(this.parameters(), this.values, values);
    this.programs.any().shader.pack(changed);
    this.values = changed;
    ++this.changes;
    this.getScene().resetCachedMaterial();
  }
  /** The slots that setTexture() takes. */
  textureSlots(): GraphTexture[] {
    return this.programs.any().graph.textures();
  }
  /** Makes the program for meshes with these attributes before one is drawn. Throws where there is none. */
  prepare(attributes: Attribute[]): void {
    this.programs.for(attributes);
  }
  /** The pictures in its slots, which dispose() leaves as they are. */
  pictures(): BaseTexture[] {
    return [...this.slots.values()];
  }
  /** Another picture for a slot; null for a neutral one. */
  override setTexture(slot: string, texture: BaseTexture | null): this {
    if (!this.textureSlots().some(({ name }) => name === slot)) throw new RangeError(`the shader reads no texture ${slot}`);
    if (texture) this.slots.set(slot, texture);
    else this.slots.delete(slot);
    this.getScene().resetCachedMaterial();
    return this;
  }

  /** Shares the programs, and has numbers of its own. */
  override clone(name: string): LacquerMaterial {
    const other = new LacquerMaterial(name, this.getScene(), this.lacquer, () => this.programs.any().graph, {}, this.programs);
    for (const [slot, texture] of this.slots) other.slots.set(slot, texture);
    const { alpha, alphaMode, backFaceCulling, environment, sideOrientation, transparencyMode, values } = this;
    Object.assign(other, { alpha, alphaMode, backFaceCulling, environment, sideOrientation, transparencyMode, values });
    return other;
  }

  override needAlphaBlending(): boolean {
    return this.transparencyMode === LacquerMaterial.MATERIAL_ALPHABLEND || this.alpha < 1;
  }
  override needAlphaTesting(): boolean {
    return this.transparencyMode === LacquerMaterial.MATERIAL_ALPHATEST;
  }
  override getActiveTextures(): BaseTexture[] {
    return [...super.getActiveTextures(), ...this.slots.values()];
  }
  override hasTexture(texture: BaseTexture): boolean {
    return super.hasTexture(texture) || [...this.slots.values()].includes(texture);
  }

  override isReady(mesh?: AbstractMesh, useInstances?: boolean, subMesh?: SubMesh): boolean {
    for (const texture of this.slots.values()) if (!texture.isReadyOrNotBlocking()) return false;
    const scene = this.getScene();
    const { imageProcessingConfiguration: processing } = scene;
    if (!processing.isReady()) return false;
    const made = this.programs.for(mesh ? attributesOf(mesh) : []);
    if (made.interface.uniforms.some(({ block }) => block === 'SeeThrough')) behindOf(scene);
    const colors = {} as Parameters<typeof processing.prepareDefines>[0] & Record<string, boolean | number>;
    processing.prepareDefines(colors);
    const uniforms = [...kUniforms];
    const samplers = made.interface.textures.map(({ name }) => name);
    ImageProcessingConfiguration.PrepareUniforms(uniforms, colors);
    ImageProcessingConfiguration.PrepareSamplers(samplers, colors);
    const uniformBuffers = this.blocksOf(made).names;
    const shadows = mesh ? prepareShadows(mesh, this.castingOn(mesh, made), { uniforms, samplers, uniformBuffers }) : [];
    const on = Object.entries(colors).filter(([, value]) => value !== false && value !== undefined);
    const colored = colorsOf(mesh, useInstances);
    Object.assign(this.options, {
      attributes: [...made.attributes, ...colored.attributes], uniforms, samplers, uniformBuffers,
      defines: [
        `LACQUER_${made.shader.id.replace(/\W/g, '_')}`, ...made.defines, ...colored.defines,
        ...on.map(([name, value]) => (value === true ? name : `${name} ${value}`)), ...shadows,
      ],
    });
    this.shaderPath = made.source;
    return super.isReady(mesh, useInstances, subMesh);
  }

  override bindOnlyWorldMatrix(world: Matrix, effectOverride?: Nullable<Effect>): void {
    const effect = effectOverride ?? this.getEffect();
    if (!effect) return;
    effect.setMatrix('world', world);
    effect.setMatrix('normalMatrix', Matrix.FromArrayToRef(normalMatrix(world.asArray()), 0, this.normals));
  }

  override bind(world: Matrix, mesh?: Mesh, effectOverride?: Nullable<Effect>, subMesh?: SubMesh): void {
    const effect = effectOverride ?? subMesh?.effect ?? this.getEffect();
    if (!effect || !mesh) return;
    const scene = this.getScene();
    const made = this.programs.for(attributesOf(mesh));
    const blocks = this.blocksOf(made);
    // A texture that is made takes the place of one that is bound: they are there before anything is bound.
    const around = surroundingsOf(scene, this.environment);
    const textures = this.texturesOf(made, around.textures);
    super.bind(world, mesh, effectOverride, subMesh);
    this.fillBlocks(blocks, mesh, around.levels, around.intensity);
    blocks.bind(effect);
    bindShadows(scene, this.castingOn(mesh, made), effect);
    effect.setMatrix('view', scene.getViewMatrix());
    effect.setFloat('lacquer_hand', scene.useRightHandedSystem ? 1 : -1);
    effect.setFloat('lacquer_visibility', mesh.visibility * this.alpha);
    effect.setMatrix3x3('lacquer_turn', around.turn);
    effect.setFloat4('lacquer_levels', ...around.steps);
    for (const [name, texture] of textures) effect.setTexture(name, texture);
    if (scene.fogEnabled && mesh.applyFog) effect.setColor3('vFogColor', scene.fogColor.toLinearSpace());
    scene.imageProcessingConfiguration.bind(effect);
  }

  override dispose(forceDisposeEffect?: boolean, forceDisposeTextures?: boolean, notBoundToMesh?: boolean): void {
    for (const blocks of this.blocks.values()) blocks.dispose();
    this.blocks.clear();
    if (forceDisposeTextures) for (const texture of this.slots.values()) texture.dispose();
    super.dispose(false, forceDisposeTextures, notBoundToMesh);
    // Of each it has one share, whether it is still on a mesh or not.
    if (forceDisposeEffect) this.effects.splice(0).forEach((effect) => effect.dispose());
  }

  private castingOn(mesh: AbstractMesh, made: Made): Map<number, Light> {
    if (!mesh.receiveShadows) return new Map();
    return castingOn(mesh, drawnLights(mesh.lightSources), made.interface.uniforms.find(({ block }) => block === 'Lights')?.array ?? 0);
  }

  private blocksOf(made: Made): Blocks {
    let blocks = this.blocks.get(made);
    if (!blocks) {
      blocks = new Blocks(this.getScene(), made);
      this.blocks.set(made, blocks);
    }
    return blocks;
  }

  private texturesOf(made: Made, around: Record<string, BaseTexture>): [string, BaseTexture][] {
    const scene = this.getScene();
    const frame: Record<string, BaseTexture> = { ...tablesOf(this.lacquer, scene), ...around };
    return made.interface.textures.map(({ name, content, role }) => {
      if (name === 'scene_behind') return [name, behindOf(scene)];
      return [name, (role === 'material' ? this.slots.get(name) : frame[name]) ?? standIn(scene, content)];
    });
  }

  /** What has changed since the last object. */
  private fillBlocks(blocks: Blocks, mesh: Mesh, levels: number, intensity: number): void {
    const { made, now } = blocks;
    const scene = this.getScene();
    if (now.numbers !== this.changes) {
      now.numbers = this.changes;
      if (made.interface.uniforms.some(({ block }) => block === 'Material')) blocks.fill('Material', made.shader.pack(this.values));
    }
    const lights = mesh.lightSources;
    const render = scene.getRenderId();
    if (now.render === render && now.lights.length === lights.length && lights.every((light, i) => light === now.lights[i])) return;
    now.render = render;
    now.lights = [...lights];
    const size = made.interface.uniforms.find(({ block }) => block === 'Lights')?.array ?? 0;
    const { elements, count } = lightsOf(lights, size);
    blocks.fill('Lights', elements);
    const eye = scene.bindEyePosition(null);
    const seen = scene.getTransformMatrix().asArray();
    blocks.fill('Frame', {
      view_projection: Array.from(seen), camera_position: [eye.x, eye.y, eye.z],
      environment_intensity: intensity, environment_max_lod: levels, light_count: count,
    });
    blocks.fill('EnvironmentTurn', { rotation: [0, 0, 0, 1] });
    blocks.fill('Clock', clockValues(scene.getFrameId()));
    if (made.interface.uniforms.some(({ block }) => block === 'SeeThrough')) {
      const { width, height } = behindOf(scene).getSize();
      blocks.fill('SeeThrough', behindValues(seen, width, height));
    }
  }
}

/** The look of a glTF material (its JSON). `textures` are the file's, by the indices that the JSON has, with glTF's orientation,
 * `invertY` false. */
export function materialFrom(
  lacquer: Lacquer,
  json: object,
  scene: Scene,
  { textures = [], options = {}, messages = [] }: { textures?: BaseTexture[]; options?: Options; messages?: Message[] } = {},
): LacquerMaterial {
  const file = lacquer.scene(JSON.stringify(fileOf(json, textures.length)), 'material.gltf', options, messages);
  const graph = (attributes: Attribute[]) => file.graph(0, options, attributes, messages);
  const material = new LacquerMaterial((json as { name?: string }).name ?? 'material', scene, lacquer, graph, { options, messages });
  for (const slot of material.textureSlots()) {
    if (textures[slot.texture]) material.setTexture(slot.name, asSlot(textures[slot.texture], slot));
  }
  return withStates(material, json);
}

const kWraps: Record<string, number> = {
  repeat: Constants.TEXTURE_WRAP_ADDRESSMODE, clamp: Constants.TEXTURE_CLAMP_ADDRESSMODE, mirror: Constants.TEXTURE_MIRROR_ADDRESSMODE,
};
/** The texture as a slot has it: with its sampler where the graph has one. */
export function asSlot(texture: BaseTexture, { sampler }: GraphTexture): BaseTexture {
  if (!sampler) return texture;
  const own = texture.clone() ?? texture;
  own.wrapU = kWraps[sampler.wrap_s];
  own.wrapV = kWraps[sampler.wrap_t];
  if (own instanceof Texture && sampler.mag_filter === 'nearest') own.updateSamplingMode(Constants.TEXTURE_NEAREST_LINEAR_MIPLINEAR);
  return own;
}

/** What of a glTF material is no matter of its shader. */
export function withStates(material: LacquerMaterial, json: { alphaMode?: string; doubleSided?: boolean; extras?: object }): LacquerMaterial {
  const modes: Record<string, number> = { BLEND: LacquerMaterial.MATERIAL_ALPHABLEND, MASK: LacquerMaterial.MATERIAL_ALPHATEST };
  material.transparencyMode = modes[json.alphaMode ?? ''] ?? LacquerMaterial.MATERIAL_OPAQUE;
  material.backFaceCulling = !json.doubleSided;
  if (json.extras) material.metadata = { ...material.metadata, gltf: { ...material.metadata?.gltf, extras: json.extras } };
  return material;
}
