// What goes in and comes out, as lacquer_c.h and the documents say it.

export type Level = 'note' | 'warning' | 'error';

/** Something that is wrong with the input, or worth knowing. */
export interface Message {
  level: Level;
  /** Stable, lower-case, dash-separated: "factor-out-of-range". */
  code: string;
  file: string;
  /** JSON pointer into the file; may be empty. */
  pointer: string;
  /** From 1, the column in bytes; 0 where there is no place in a text. */
  line: number;
  column: number;
  /** What is wrong, and what is right. */
  message: string;
  help: string;
  /** All of it as the command line prints it. */
  text: string;
}

/** What a call throws that cannot do what it is for. */
export class LacquerError extends Error {
  constructor(readonly messages: Message[]) {
    super(messages.filter((m) => m.level === 'error').map((m) => m.text).join('\n') || 'the call failed');
    this.name = 'LacquerError';
  }
}

/** Names of targets; a library may know more of them. */
export type Target = 'glsl' | 'glsl-gl' | 'essl' | 'hlsl' | 'wgsl' | 'spirv' | 'cpp' | 'js' | (string & {});
export type Stage = 'vertex' | 'fragment';

/** How shaders are made; what is absent is as on the command line. */
export interface Options {
  profile?: string;
  /** Surfaces of MaterialX documents: by its formulas, the default without another profile, or translated to glTF's properties. */
  as?: 'materialx' | 'gltf';
  simplify?: string[];
  template?: string;
  targets?: Target[];
  parameters?: 'uniform' | 'baked' | 'spec';
  /** 'bindless': lists of objects and materials and an array of textures, by numbers of the instance. 'arrays': a material's
   * textures are layers of one. */
  binding?: 'sets' | 'bindless' | 'arrays';
  /** The samplers that the file says are a part of a shader's interface. */
  static_samplers?: boolean;
  lights?: 'any' | 'scene' | Record<string, number>;
  switches?: Record<string, boolean>;
  ibl?: boolean;
  multiple_scattering?: boolean;
  dfg_table?: boolean;
  decode_srgb?: boolean;
  permissive?: boolean;
  /** The part of a colour that half precision may change, 0 (none) to 0.5 (docs/intervals.md). */
  relaxed?: number;
  /** Of what `relaxed` allows, what is cheaper with types of 16 bits has them. */
  half?: boolean;
  debug?: boolean;
  live?: string[];
  /** More node files: their texts by the names that messages have of them. */
  node_texts?: Record<string, string>;
  /** MaterialX definitions that documents may use: their texts by the names that messages have of them. */
  materialx_texts?: Record<string, string>;
  /** What a MaterialX document includes, by its path as seen from the document. */
  document_texts?: Record<string, string>;
  limits?: string[];
  /** Of contracts: beside each material's shader one for all, with the same bindings and block (docs/builds.md). */
  fallback?: boolean;
  /** Of contracts: also materials that no primitive uses. */
  unused?: boolean;
  /** Of evaluations and previews: "SLOT=r,g,b,a", constants instead of images. */
  texels?: string[];
  /** Of the same: when it is looked at, for materials that ask for it. Seconds and a picture's number, 0 to 16,777,216. */
  time?: number;
  frame?: number;
}

/** Vertex attributes of a primitive beside POSITION. JOINTS_n come with WEIGHTS_n; the last three are morph targets,
 *  instances, and positions or texture coordinates that are stored as integers. */
export type Attribute =
  | 'NORMAL' | 'TANGENT' | 'COLOR_0' | 'TEXCOORD_0' | 'TEXCOORD_1' | 'TEXCOORD_2' | 'TEXCOORD_3'
  | 'JOINTS_0' | 'JOINTS_1' | 'MORPH_TARGETS' | 'INSTANCES' | 'QUANTIZED';

/** An editable number of a material. */
export interface Parameter {
  name: string;
  type: 'float' | 'vec2' | 'vec3' | 'vec4' | 'bool';
  value: number | number[];
  /** null: unbounded. */
  low: number | null;
  high: number | null;
  /** 0 is one of its values although `low` is above it. */
  or_zero: boolean;
  /** JSON pointer of the glTF property; may be empty. */
  pointer: string;
  /** The tool's own words; null for none. */
  ui: unknown;
}

/** A texture of a material. */
export interface GraphTexture {
  name: string;
  type: 'sampler2D' | 'samplerCube' | 'sampler2DArray';
  srgb: boolean;
  /** Index in the file's `textures`; -1 for none. */
  texture: number;
  /** JSON pointer of the textureInfo; may be empty. */
  pointer: string;
  /** The image of a graph's own, a URI; may be empty. */
  file: string;
  /** How it is looked up, where the graph says so: of a file, and in place of the sampler of the file's texture. */
  sampler?: { wrap_s: string; wrap_t: string; mag_filter?: string };
  ui: unknown;
  /** Pointers of the textureInfos of other properties that have the same texel. */
  also: string[];
}

/** A node of a graph: a `node` of the library, or a `group` of the graph. */
export interface GraphNode {
  id: string;
  node?: string;
  group?: string;
  /** Empty for the reference. */
  variant: string;
  stage: Stage;
  inputs: Record<string, GraphSource>;
  ui: unknown;
}

/** What a node or a template takes, or what a node gives. */
export interface Socket {
  /** Of an only output empty. */
  name: string;
  type: string;
  /** null: unbounded. */
  low: number | null;
  high: number | null;
  or_zero: boolean;
}
export interface Sockets {
  /** `optional`: it has a default. `source`: null for nothing. */
  inputs: (Socket & { optional: boolean; source: GraphSource | null })[];
  outputs: Socket[];
}

/** A property of a material. */
export interface PropertyUse {
  /** JSON pointer of the glTF property, or of the textureInfo. */
  pointer: string;
  change: Change;
  /** Of the parameter ("numbers") or the texture ("textures"). */
  name: string;
  /** Of "program": terms that, as `live` in the options, make a parameter of it whatever its value is. */
  live: string[];
}

/** An edit in its JSON form (docs/graph-format.md, "Edits"). */
export type GraphEdit = { do: string } & Record<string, unknown>;

/** What has changed of a graph since its shader was generated: nothing of it, the bytes of its block, images or samplers (and
 *  perhaps numbers), or the program. */
export type Change = 'nothing' | 'numbers' | 'textures' | 'program';

/** Where an input of a node comes from (docs/graph-format.md). */
export type GraphSource =
  | number
  | boolean
  | number[]
  | { node: string; output?: string; swizzle?: string }
  | { parameter: string; swizzle?: string }
  | { texture: string }
  | { given: string; swizzle?: string }
  | { input: string; swizzle?: string }
  | { value: number | number[]; swizzle: string };

/** A parameter in the JSON form of a graph; a `range` end of null is none. */
export interface ParameterJson {
  type: string;
  value: number | boolean | (number | boolean)[];
  range?: (number | null)[];
  /** 0 may stand beside a range above it. */
  or_zero?: boolean;
  pointer?: string;
  default?: number | boolean | (number | boolean)[];
  animated?: boolean;
  ui?: unknown;
}
export interface TextureJson {
  type: string;
  srgb: boolean;
  /** An index of the file's textures; -1 where it is absent. */
  texture?: number;
  /** Instead, an image's URI. */
  file?: string;
  /** With a texture: how it is looked up, whatever its sampler says. */
  wrap?: 'repeat' | 'clamp' | 'mirror' | ('repeat' | 'clamp' | 'mirror')[];
  filter?: 'linear' | 'nearest';
  /** Four linear numbers in the place of an image that is not there. */
  default?: number[];
  pointer?: string;
  /** The textureInfos of other properties that have the same texel. */
  also?: string[];
  ui?: unknown;
}
/** A node of the library, or with `group` an instance of a group. */
export interface NodeJson {
  id: string;
  node?: string;
  group?: string;
  variant?: string;
  /** "vertex": it is computed at the vertices. */
  stage?: 'vertex';
  /** The term of a specification that it is, and its place there. */
  term?: string;
  place?: number;
  inputs: Record<string, GraphSource>;
  ui?: unknown;
}
export interface GroupJson {
  inputs: Record<string, { type: string; default?: GraphSource; range?: (number | null)[]; or_zero?: boolean; ui?: unknown }>;
  nodes: NodeJson[];
  outputs: Record<string, GraphSource>;
  ui?: unknown;
}
/** The JSON form of a graph (docs/graph-format.md). */
export interface GraphJson {
  lacquer_graph: number;
  name: string;
  template: string;
  /** Vertex attributes that it is given. */
  attributes?: string[];
  parameters: Record<string, ParameterJson>;
  textures: Record<string, TextureJson>;
  groups?: Record<string, GroupJson>;
  nodes: NodeJson[];
  outputs: Record<string, GraphSource>;
  skipped?: Record<string, string>;
  /** Of a tool's, any JSON. */
  ui?: unknown;
}

/** A point of `evaluate` (docs/eval.md). */
export interface Point {
  n?: number[];
  t?: number[];
  v?: number[];
  l?: number[];
  uv0?: number[];
  uv1?: number[];
  uv2?: number[];
  uv3?: number[];
  color0?: number[];
  light?: number[];
  env?: number[];
  position?: number[];
  front_facing?: boolean;
}
export type Points = Point[] | { points: Point[]; uniforms?: Record<string, number | number[]> };
export type EvaluationOptions = Options & { engine?: 'double' | 'float' };

export interface Evaluation {
  material: string;
  engine: 'double' | 'float';
  /** Of a material; a graph has none. */
  profile?: string;
  /** Linear; null where the material drops the fragment or the number is not finite. */
  rgba: (number | null)[][];
  discarded?: boolean[];
}

/** A field of a uniform block. */
export interface Field {
  name: string;
  type: string;
  offset: number;
  array?: number;
  stride?: number;
  expression?: string;
  meaning?: string;
}
/** A shader's entry in manifest.json (docs/manifest.md), as far as the types say it. */
export interface Interface {
  template: string;
  /** Made with `binding: 'bindless'`. */
  bindless?: true;
  uniforms: { block: string; role: string; size: number; array?: number; stride?: number; fields: Field[] }[];
  parameters: { name: string; type: string; fields: string[] }[];
  textures: {
    name: string;
    type: string;
    role: 'material' | 'environment' | 'object';
    /** What of a texel the shader reads. */
    channels: string;
    color_space?: 'srgb' | 'linear';
    content?: 'color' | 'normal' | 'data';
    /** With `bindless`: the array that the material's is taken from, and the byte of its record with its number there. With
     * `layered` it is a layer of the array texture of that name. */
    array?: string;
    number?: number;
    layered?: true;
    /** With `static_samplers`. */
    static_sampler?: ContractTexture['sampler'];
    static_register?: number;
  }[];
  inputs?: { name: string; location: number; type: string }[];
  /** Of the target "hlsl": the root signature of Direct3D 12 (docs/bindings.md). */
  d3d12?: { root_signature: string; parameters: { kind: string; space: number; binding?: number; count?: number }[] };
  /** Of the target "wgsl": what createBindGroupLayout wants (docs/bindings.md). */
  webgpu?: { bindings: { name: string; group: number; binding: number; visibility: string[]; [kind: string]: unknown }[] };
  [key: string]: unknown;
}

/** When in a frame a material is drawn, in this order (docs/bindings.md). */
export type Pass = 'opaque' | 'masked' | 'looks_through' | 'blended';

/** A texture of a use: which of the file's, and how its coordinates are found. */
export interface UsedTexture {
  /** An index into the file's textures; -1 where a stand-in is bound. */
  texture: number;
  pointer: string;
  texcoord?: number;
  transform?: { offset: [number, number]; rotation: number; scale: [number, number] };
  stand_in?: { texel: [number, number, number, number]; color_space: 'srgb' | 'linear' };
  /** Of a graph's own texture: its image, and what is there without one. */
  file?: string;
  /** Of a graph's own texture, and of one that a procedural texture looks up: in place of the sampler of the file's texture. */
  sampler?: { wrap_s: string; wrap_t: string; mag_filter?: string };
  default?: number[];
}
/** A material on primitives with one set of attributes (docs/manifest.md). */
export interface Use {
  attributes: string[];
  /** The id of its shader. */
  shader: string;
  parameters: Record<string, { value: number | number[]; pointer: string; animated?: true; stand_in?: true }>;
  uniforms: Record<string, number | number[]>;
  textures: Record<string, UsedTexture>;
  stand_in_attributes?: string[];
  /** With `fallback`: what is drawn with until the pipeline of `shader` is there; the shader alone where that is the same one. */
  fallback?: Pick<Use, 'shader'> & Partial<Pick<Use, 'parameters' | 'uniforms' | 'textures' | 'stand_in_attributes'>>;
  absent_parameters: Record<string, string[]>;
  unfilled_ports: string[];
}
export interface ContractMaterial {
  /** In the file; -1 for the default material. */
  index: number;
  name: string;
  profile: string;
  alpha_mode: 'OPAQUE' | 'MASK' | 'BLEND';
  alpha_cutoff?: number;
  pass: Pass;
  depth_write: boolean;
  blend?: { color: [string, string]; alpha: [string, string] };
  double_sided: boolean;
  extensions?: Record<string, string>;
  uses: Use[];
  terms: string[];
  skipped: Record<string, string>;
  ignored: string[];
}
export interface ContractPrimitive {
  mesh: number;
  primitive: number;
  material: number;
  use?: number;
  attributes: Record<string, { type?: string; component_type?: string; normalized?: true }>;
  targets?: string[][];
  variants?: { variants: number[]; material: number; use?: number }[];
}
export interface ContractTexture {
  images: { image: number; extension?: string; channels?: number[]; layer?: number }[];
  /** Shaders take the channels of the first image themselves. */
  swizzled?: true;
  sampler: { wrap_s: string; wrap_t: string; mag_filter?: string; min_filter?: string };
}
/** The file's entry in manifest.json. */
export interface ContractFile {
  source: string;
  materials: ContractMaterial[];
  default_material?: ContractMaterial;
  variants?: string[];
  primitives?: ContractPrimitive[];
  textures?: ContractTexture[];
  images?: { uri?: string; buffer_view?: number; data_uri?: true; mime_type?: string }[];
  looks?: Look[];
  look_groups?: { name: string; looks: string[]; default?: string }[];
  collections?: { name: string; include?: string[]; collections?: string[]; exclude?: string[] }[];
  geometry?: (GeometryNames & { name: string; properties?: GeometryValue[]; tokens?: GeometryValue[] })[];
  material_variants?: { material: number; of: number; variants: string[] }[];
}
/** Names and expressions as a MaterialX document has them, or a collection's name. */
export interface GeometryNames {
  geometry?: string[];
  collection?: string;
}
export interface GeometryValue {
  name: string;
  type: string;
  value: string;
}
/** Which material is for which geometry, in a MaterialX document (docs/materialx.md). */
export interface Look {
  name: string;
  materials: (GeometryNames & { name?: string; material: number; exclusive: boolean })[];
  properties?: (GeometryNames & { property: string; type: string; value: string; target?: string })[];
  visibility?: (GeometryNames & { type?: string; visible: boolean; viewers?: string[]; viewer_collection?: string })[];
}
/** manifest.json, as far as the types say it. */
export interface Manifest {
  lacquer: string;
  schema: number;
  files: ContractFile[];
  shaders: Record<string, Interface>;
}

/** How an environment is filtered (docs/environments.md). */
export interface EnvironmentForm {
  /** Texels of an edge of environment_specular's faces: a power of two from 32 to 1024; else 256. */
  size?: number;
  /** About how many parts of the picture each texel is made of, from 64 to 65536; else 1024. */
  samples?: number;
  /** Files are DDS; else KTX2. */
  dds?: boolean;
  /** Texels of cubes are RGB9E5; else half floats. */
  shared_exponents?: boolean;
  /** Of a glTF file, from 0; absent: the one that it names. */
  scene?: number;
  /** For a first look: `size` and `samples` at most 64, tables of 32 × 32. */
  draft?: boolean;
}

/** What environment.json says, and the files' bytes by their textures: "environment_specular". */
export interface EnvironmentFiles {
  environment_max_lod: number;
  textures: Record<string, { file: string; type: string; format: string; size: number; levels: number }>;
  irradiance_harmonics: number[][];
  /** Of a glTF file's environment: what the switch local_environment reads. */
  box?: { min: number[]; max: number[] };
  files: Record<string, Uint8Array>;
}

/** Numbers by the names of a block's fields. */
export type Values = Record<string, number | ArrayLike<number>>;

/** A GPUBindGroupLayoutEntry, and what is bound there. */
export interface BindGroupLayoutEntry {
  name: string;
  binding: number;
  /** Bits of GPUShaderStage. */
  visibility: number;
  [kind: string]: unknown;
}
