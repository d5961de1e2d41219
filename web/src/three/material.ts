// A material of three.js whose shader is Lacquer's.
import {
  ClampToEdgeWrapping, DataArrayTexture, DataTexture, DoubleSide, FloatType, GLSL3, LinearFilter, Material, Matrix4, MirroredRepeatWrapping,
  NearestFilter, Quaternion, RepeatWrapping, RGBAFormat, ShaderMaterial, SRGBColorSpace, UniformsLib, UniformsUtils, Vector2, type BatchedMesh, type BufferAttribute,
  type BufferGeometry, type Camera, type InstancedMesh, type Mesh, type Object3D, type Scene, type SkinnedMesh, type Texture, type WebGLRenderer, type Wrapping,
} from 'three';
import type { Graph, Lacquer } from '../index.js';
import type { Attribute, Field, GraphTexture, Message, Options, Parameter, Values } from '../types.js';
import { fileOf } from '../renderers/file.js';
import { changedNumbers, clockValues, esslOf, type Essl } from '../renderers/shader.js';
import { environmentIn, tablesOf, type Environment } from './environment.js';
import { lightsOf } from './lights.js';
import { sceneBehind } from './behind.js';
import { kShadows } from './shadows.js';
import { instancesOf, threeText } from './text.js';

/** The attributes of a mesh that its shader may use. */
export function attributesOf(mesh: Mesh): Attribute[] {
  const { attributes, morphAttributes } = mesh.geometry;
  const named: [string, Attribute][] = [
    ['normal', 'NORMAL'], ['tangent', 'TANGENT'], ['color', 'COLOR_0'], ['uv', 'TEXCOORD_0'], ['uv1', 'TEXCOORD_1'],
    ['uv2', 'TEXCOORD_2'], ['uv3', 'TEXCOORD_3'],
  ];
  const has = named.filter(([name]) => attributes[name]).map(([, attribute]) => attribute);
  // three.js's own shaders ask a batch in this way, too.
  const batched = (mesh as BatchedMesh).isBatchedMesh && (mesh as unknown as { _colorsTexture: object | null })._colorsTexture;
  if (((mesh as InstancedMesh).instanceColor || batched) && !attributes.color) has.push('COLOR_0');
  if ((mesh as SkinnedMesh).isSkinnedMesh) has.push('JOINTS_0', ...(attributes.joints_1 ? ['JOINTS_1' as const] : []));
  if (Object.keys(morphAttributes).length > 0) has.push('MORPH_TARGETS');
  return has;
}

type Uniform = number | number[] | Float32Array;
const kCounts: Record<string, number> = { float: 1, int: 1, uint: 1, bool: 1, vec2: 2, vec3: 3, vec4: 4, mat4: 16 };

/** What a field of a block is in its bytes. */
function fieldOf(bytes: Uint8Array, { type, offset, array = 1, stride = 0 }: Field): Uniform {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const count = kCounts[type];
  const at = (i: number) => offset + Math.floor(i / count) * stride + 4 * (i % count);
  const whole = type === 'int' || type === 'bool' || type === 'uint';
  const numbers = Array.from({ length: count * array }, (_, i) => (whole ? view.getInt32(at(i), true) : view.getFloat32(at(i), true)));
  return numbers.length === 1 ? numbers[0] : numbers;
}

const kZeros = (fields: Field[]): Record<string, Uniform> =>
  Object.fromEntries(fields.map(({ name, type, array = 1 }) => {
    const count = kCounts[type] * array;
    return [name, count === 1 ? 0 : new Array<number>(count).fill(0)];
  }));

/** One texel in the place of an image that is not there. */
function texel(rgba: [number, number, number, number]): DataTexture {
  const texture = new DataTexture(new Uint8Array(rgba), 1, 1);
  texture.needsUpdate = true;
  return texture;
}
let white: DataTexture | undefined;
let flat: DataTexture | undefined;
const standIn = (content?: string): Texture =>
  content === 'normal' ? (flat ??= texel([128, 128, 255, 255])) : (white ??= texel([255, 255, 255, 255]));

/** What is made of a graph once, and shared by clones. */
interface Made extends Essl {
  graph: Graph;
  /** The uniforms that blocks are. */
  instances: Map<string, string>;
}

function make(graph: Graph, options: Options, messages: Message[]): Made {
  const { text: essl, ...rest } = esslOf(graph, options, messages, 'three.js');
  return {
    ...rest, graph,
    instances: new Map([...instancesOf(essl.vertex), ...instancesOf(essl.fragment)]),
    text: { vertex: threeText(essl.vertex, 'vertex', rest.interface), fragment: threeText(essl.fragment, 'fragment', rest.interface) },
  };
}

export interface MaterialOptions {
  /** The pictures of the shader's texture slots, by their names (`graph.textures()`); three.js's own colour spaces hold. */
  textures?: Record<string, Texture | null>;
  /** How the shader is made; the templates `forward` and what extends it are drawn. */
  options?: Options;
  messages?: Message[];
}

/** Draws a graph. It has the lights, the fog, the tone mapping and the colour space of the renderer and its scene, skins, morph
 * targets, instances, batches and clipping planes; the surroundings are those of setEnvironment(). Shadows fall from it and on it. */
export class LacquerMaterial extends ShaderMaterial {
  readonly isLacquerMaterial = true;
  /** Instead of the scene's. */
  environment: Environment | null = null;
  /** The scene is drawn behind it once a frame, when it is seen through. */
  readonly looksThrough: boolean;
  private readonly made: Made;
  private values: Record<string, number[]> = {};
  private readonly objects = new WeakMap<Object3D, ObjectTextures>();
  private readonly textures = new Set<ObjectTextures>();
  private readonly gone = new FinalizationRegistry<ObjectTextures>((of) => {
    of.dispose();
    this.textures.delete(of);
  });
  private drawn = { renderer: null as WebGLRenderer | null, frame: -1, camera: null as Camera | null };

  constructor(
    private readonly lacquer: Lacquer,
    graph: Graph,
    { textures = {}, options = {}, messages = [] }: MaterialOptions = {},
    made = make(graph, options, messages),
  ) {
    super({ glslVersion: GLSL3, vertexShader: made.text.vertex, fragmentShader: made.text.fragment, fog: true, clipping: true });
    this.type = 'LacquerMaterial';
    this.made = made;
    this.name = made.shader.id;
    for (const block of made.interface.uniforms) {
      const name = made.instances.get(block.block);
      if (name) this.uniforms[name] = { value: block.array ? [] : kZeros(block.fields) };
    }
    for (const { name, content } of made.interface.textures) this.uniforms[name] = { value: textures[name] ?? standIn(content) };
    for (const [name, table] of Object.entries(tablesOf(lacquer))) if (this.uniforms[name]) this.uniforms[name].value = table;
    Object.assign(this.uniforms, UniformsUtils.clone(UniformsLib.fog));
    if (made.instances.has('Lights')) this.takeShadows();
    this.looksThrough = made.instances.has('SeeThrough');
    this.set({});
    this.addEventListener('dispose', () => this.textures.forEach((each) => each.dispose()));
  }

  /** Has three.js give it what its own lit materials have. */
  private takeShadows(): void {
    this.lights = true;
    Object.assign(this.uniforms, UniformsUtils.clone(UniformsLib.lights));
    for (const uniform of Object.keys(kShadows)) this.uniforms[uniform] = { value: [] };
  }

  /** The numbers that set() takes. */
  parameters(): Parameter[] {
    return this.made.graph.parameters();
  }
  /** Gives parameters other values: no program is made for it. Throws, and changes nothing, where a name is no parameter's or a
   * value no number. Values beyond a range are its ends. */
  set(values: Record<string, number | ArrayLike<number>>): void {
    const changed = changedNumbers(this.made.graph.parameters(), this.values, values);
    const block = this.made.interface.uniforms.find(({ block }) => block === 'Material');
    const bytes = block ? this.made.shader.pack(changed) : new Uint8Array();
    this.values = changed;
    if (!block) return;
    this.fill('Material', Object.fromEntries(block.fields.map((field) => [field.name, fieldOf(bytes, field)])));
  }
  /** The pictures in its slots, which dispose() leaves as they are. */
  pictures(): Texture[] {
    const slots = this.made.interface.textures.filter(({ role }) => role === 'material');
    return slots.map(({ name }) => this.uniforms[name].value as Texture).filter((texture) => texture !== white && texture !== flat);
  }
  /** Another picture for a slot; null for a neutral one. */
  setTexture(slot: string, texture: Texture | null): void {
    const of = this.made.interface.textures.find(({ name, role }) => name === slot && role === 'material');
    if (!of) throw new RangeError(`the shader reads no texture ${slot}`);
    this.uniforms[slot].value = texture ?? standIn(of.content);
    this.uniformsNeedUpdate = true;
  }

  /** Shares the program, and has numbers of its own. */
  override clone(): this {
    const textures = Object.fromEntries(this.made.interface.textures.map(({ name }) => [name, this.uniforms[name].value as Texture]));
    const other = new LacquerMaterial(this.lacquer, this.made.graph, { textures }, this.made);
    Material.prototype.copy.call(other, this);
    other.environment = this.environment;
    other.set(this.values);
    return other as this;
  }

  override onBeforeRender(renderer: WebGLRenderer, scene: Scene, camera: Camera, _: BufferGeometry, object: Object3D): void {
    const { frame } = renderer.info.render;
    if (this.drawn.renderer !== renderer || this.drawn.frame !== frame || this.drawn.camera !== camera) {
      this.drawn = { renderer, frame, camera };
      this.fillFrame(renderer, scene, camera, frame);
    }
    this.fillObject(object as Mesh);
  }

  private fill(block: string, values: Values): void {
    const name = this.made.instances.get(block);
    if (!name) return;
    Object.assign(this.uniforms[name].value as object, values);
    this.uniformsNeedUpdate = true;
  }

  private fillFrame(renderer: WebGLRenderer, scene: Scene, camera: Camera, frame: number): void {
    const lights = this.made.instances.get('Lights');
    const { array: size = 0, fields = [] } = this.made.interface.uniforms.find(({ block }) => block === 'Lights') ?? {};
    const areas = fields.some(({ name }) => name === 'area_radiance');
    const { elements, count, shadows } = lights ? lightsOf(renderer, scene, camera, size, areas) : { elements: [], count: 0, shadows: {} };
    if (lights) this.uniforms[lights].value = elements;
    for (const [uniform, from] of Object.entries(shadows)) this.uniforms[uniform].value = from;
    const environment = this.environment ?? environmentIn(scene);
    for (const [name, texture] of Object.entries(environment.textures)) if (this.uniforms[name]) this.uniforms[name].value = texture;
    const { environmentIntensity = 1, environmentRotation } = scene;
    this.fill('Frame', { environment_intensity: environmentIntensity, environment_max_lod: environment.levels, light_count: count });
    if (environmentRotation) {
      const turn = new Quaternion().setFromEuler(environmentRotation).invert();
      this.fill('EnvironmentTurn', { rotation: turn.toArray() });
    }
    this.fill('Clock', clockValues(frame));
    if (this.looksThrough) {
      const { texture, values } = sceneBehind(renderer, scene, camera);
      this.uniforms.scene_behind.value = texture;
      this.fill('SeeThrough', values);
    }
    this.uniformsNeedUpdate = true;
  }

  private fillObject(mesh: Mesh): void {
    const { instances } = this.made;
    if (!instances.has('Skin') && !instances.has('Morph')) return;
    let own = this.objects.get(mesh);
    if (!own) {
      own = new ObjectTextures();
      this.objects.set(mesh, own);
      this.textures.add(own);
      this.gone.register(mesh, own);
    }
    if (instances.has('Skin')) {
      this.uniforms.joint_matrices.value = own.skin(mesh as SkinnedMesh);
      this.fill('Skin', { joint_count: (mesh as SkinnedMesh).skeleton.bones.length, joint_scale: 1 });
    }
    if (instances.has('Morph')) {
      this.uniforms.morph_deltas.value = own.morph(mesh);
      this.fill('Morph', own.weights(mesh));
    }
  }
}

const kMostTargets = 8;
const kRow = 1024;

/** What the vertex stage of one object reads: its skeleton's matrices, its morph targets. */
class ObjectTextures {
  private joints: DataTexture | null = null;
  private deltas: DataArrayTexture | null = null;
  private readonly size = new Vector2();

  dispose(): void {
    this.joints?.dispose();
    this.deltas?.dispose();
    this.joints = this.deltas = null;
  }

  /** A row for each joint: three rows of the matrix from the mesh to where three.js's `modelMatrix` begins. */
  skin({ skeleton, bindMatrix, bindMatrixInverse }: SkinnedMesh): DataTexture {
    const count = skeleton.bones.length;
    this.joints ??= new DataTexture(new Float32Array(16 * count), 4, count, RGBAFormat, FloatType);
    const data = this.joints.image.data as Float32Array;
    const matrix = new Matrix4();
    const bone = new Matrix4();
    for (let i = 0; i < count; ++i) {
      bone.fromArray(skeleton.boneMatrices as unknown as number[], 16 * i);
      const m = matrix.multiplyMatrices(bindMatrixInverse, bone).multiply(bindMatrix).elements;
      for (let row = 0; row < 3; ++row) for (let column = 0; column < 4; ++column) data[16 * i + 4 * row + column] = m[4 * column + row];
    }
    this.joints.needsUpdate = true;
    return this.joints;
  }

  /** Of each target its differences of positions, normals and tangents. */
  morph({ geometry }: Mesh): DataArrayTexture {
    if (this.deltas) return this.deltas;
    const { attributes, morphTargetsRelative } = geometry;
    const morphAttributes = geometry.morphAttributes as Record<string, BufferAttribute[] | undefined>;
    const vertices = attributes.position.count;
    this.size.set(Math.min(vertices, kRow), Math.ceil(vertices / kRow));
    const kinds = ['position', 'normal', 'tangent'];
    const targets = Math.max(...kinds.map((kind) => morphAttributes[kind]?.length ?? 0));
    const texels = this.size.x * this.size.y;
    const data = new Float32Array(4 * texels * 3 * targets);
    for (let target = 0; target < targets; ++target) {
      kinds.forEach((kind, k) => {
        const to = morphAttributes[kind]?.[target];
        if (!to) return;
        const from = morphTargetsRelative ? null : (attributes[kind] as BufferAttribute);
        const start = 4 * texels * (3 * target + k);
        for (let v = 0; v < vertices; ++v) {
          for (let i = 0; i < 3; ++i) data[start + 4 * v + i] = to.getComponent(v, i) - (from?.getComponent(v, i) ?? 0);
        }
      });
    }
    this.deltas = new DataArrayTexture(data, this.size.x, this.size.y, 3 * targets);
    this.deltas.type = FloatType;
    this.deltas.needsUpdate = true;
    return this.deltas;
  }

  /** Of the targets that count most. */
  weights({ morphTargetInfluences: influences = [] }: Mesh): Values {
    const most = influences.map((weight, target) => ({ weight, target }))
      .sort((a, b) => Math.abs(b.weight) - Math.abs(a.weight)).slice(0, kMostTargets);
    const padded = (pick: (of: { weight: number; target: number }) => number) =>
      Array.from({ length: kMostTargets }, (_, i) => (most[i] ? pick(most[i]) : 0));
    return { weights: padded(({ weight }) => weight), targets: padded(({ target }) => target), width: this.size.x, height: this.size.y };
  }
}

/** The look of a glTF material (its JSON) on a mesh. `textures` are the file's, by the indices that the JSON has, with glTF's
 * `flipY`, false. */
export function materialFrom(
  lacquer: Lacquer,
  json: object,
  mesh: Mesh,
  { textures = [], options = {}, messages = [] }: { textures?: Texture[]; options?: Options; messages?: Message[] } = {},
): LacquerMaterial {
  const scene = lacquer.scene(JSON.stringify(fileOf(json, textures.length)), 'material.gltf', options, messages);
  try {
    const graph = scene.graph(0, options, attributesOf(mesh), messages);
    const slots = Object.fromEntries(graph.textures().map((slot) => [slot.name, asSlot(textures[slot.texture], slot)]));
    return withStates(new LacquerMaterial(lacquer, graph, { textures: slots, options, messages }), json);
  } finally {
    scene.free();
  }
}

/** The texture as a slot has it: with its colour space, as the same picture may be read as numbers elsewhere, and with its
 * sampler where the graph has one. */
export function asSlot(texture: Texture | null | undefined, { srgb, sampler }: GraphTexture): Texture | null {
  if (!texture || (!sampler && (!srgb || texture.colorSpace === SRGBColorSpace))) return texture ?? null;
  const own = texture.clone();
  if (srgb) own.colorSpace = SRGBColorSpace;
  if (sampler) {
    const kWraps: Record<string, Wrapping> = { repeat: RepeatWrapping, clamp: ClampToEdgeWrapping, mirror: MirroredRepeatWrapping };
    own.wrapS = kWraps[sampler.wrap_s];
    own.wrapT = kWraps[sampler.wrap_t];
    own.magFilter = sampler.mag_filter === 'nearest' ? NearestFilter : LinearFilter;
  }
  return own;
}

/** What of a glTF material is no matter of its shader. */
export function withStates<T extends Material>(material: T, json: { alphaMode?: string; doubleSided?: boolean; name?: string; extras?: object }): T {
  material.transparent = json.alphaMode === 'BLEND';
  material.depthWrite = json.alphaMode !== 'BLEND';
  if (json.doubleSided) material.side = DoubleSide;
  if (json.name) material.name = json.name;
  if (json.extras) Object.assign(material.userData, json.extras);
  return material;
}
