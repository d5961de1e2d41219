// Lacquer in JavaScript: glTF materials to shaders. The way is Scene -> Graph -> Shader.
import { Instance } from './module.js';
import {
  LacquerError,
  type Attribute,
  type BindGroupLayoutEntry,
  type Change,
  type EnvironmentFiles,
  type EnvironmentForm,
  type Evaluation,
  type EvaluationOptions,
  type GraphEdit,
  type GraphJson,
  type GraphNode,
  type GraphSource,
  type GraphTexture,
  type Interface,
  type Level,
  type Message,
  type Options,
  type Parameter,
  type Points,
  type PropertyUse,
  type Sockets,
  type Stage,
  type Target,
  type Values,
} from './types.js';

export * from './types.js';

const kLevels: Level[] = ['note', 'warning', 'error'];
const kAttributes: Attribute[] = [
  'NORMAL', 'TANGENT', 'COLOR_0', 'TEXCOORD_0', 'TEXCOORD_1', 'TEXCOORD_2', 'TEXCOORD_3', 'JOINTS_0', 'JOINTS_1',
  'MORPH_TARGETS', 'INSTANCES', 'QUANTIZED',
];
/** What a material that no primitive uses is read with. */
export const kUnusedAttributes: Attribute[] = ['NORMAL', 'TANGENT', 'TEXCOORD_0', 'TEXCOORD_1'];
const kStages: Record<Stage, number> = { vertex: 0, fragment: 1 };
/** GPUShaderStage, which Node does not have. */
const kVisibility: Record<string, number> = { vertex: 1, fragment: 2 };
const kInterfaceVersion = 1;
const kChanges: Change[] = ['nothing', 'numbers', 'textures', 'program'];

function readMessages(it: Instance, handle: number): Message[] {
  const part = (index: number, which: number) => it.sized('lacquer_message_part', handle, index, which);
  return Array.from({ length: it.call.lacquer_messages_count(handle) }, (_, i) => ({
    level: kLevels[it.call.lacquer_message_level(handle, i)],
    code: part(i, 0),
    file: part(i, 1),
    pointer: part(i, 2),
    line: it.call.lacquer_message_line(handle, i),
    column: it.call.lacquer_message_column(handle, i),
    message: part(i, 3),
    help: part(i, 4),
    text: part(i, 5),
  }));
}

/** Calls with messages and, where there are any, options. What it said is appended to `to`; an error among it is thrown
 * when the call gives 0. */
function calling(it: Instance, options: Options | undefined, to: Message[], call: (messages: number, options: number) => number) {
  const handle = it.call.lacquer_messages_new();
  let made = 0;
  let result = 0;
  try {
    if (options) made = it.withText(JSON.stringify(options), (at, size) => it.call.lacquer_options_new(at, size, handle));
    if (!options || made) result = call(handle, made);
    const said = readMessages(it, handle);
    to.push(...said);
    if (result === 0) throw new LacquerError(said);
    return result;
  } finally {
    it.call.lacquer_options_free(made);
    it.call.lacquer_messages_free(handle);
  }
}

/** Frees what nobody has any more; `free()` does it at once. */
const forgotten = new FinalizationRegistry<() => void>((free) => free());

/** An object of the module. */
abstract class Handle {
  /** @internal */
  protected at: number;
  /** @internal */
  get address(): number {
    return this.at;
  }
  private readonly release: (at: number) => void;

  /** @internal */
  constructor(protected readonly it: Instance, at: number, free: string) {
    this.at = at;
    this.release = (address) => it.call[free](address);
    const release = this.release;
    forgotten.register(this, () => release(at), this);
  }
  /** Gives its memory back. It is empty from then on. */
  free(): void {
    if (this.at === 0) return;
    forgotten.unregister(this);
    this.release(this.at);
    this.at = 0;
  }
}

/** The code of a graph. */
export class Shader extends Handle {
  /** @internal */
  constructor(it: Instance, at: number) {
    super(it, at, 'lacquer_shader_free');
  }
  /** Equal for equal code and different for different code: "forward-coat-1f0a9b1c2d3e4f50". */
  get id(): string {
    const at = this.it.call.lacquer_shader_id(this.at);
    let size = 0;
    while (this.it.bytes(at + size, 1)[0] !== 0) ++size;
    return this.it.text(at, size);
  }
  get hasVertexStage(): boolean {
    return this.it.call.lacquer_shader_has_vertex_stage(this.at) === 1;
  }
  /** Empty for a target that was not asked for or that has no text. */
  text(target: Target, stage: Stage): string {
    return this.it.withText(target, (name) => this.it.sized('lacquer_shader_text', this.at, name, kStages[stage]));
  }
  /** Empty when "spirv" was not asked for. */
  spirv(stage: Stage): Uint32Array {
    return this.it.withBytes(4, (count) => {
      const at = this.it.call.lacquer_shader_spirv(this.at, kStages[stage], count);
      return new Uint32Array(this.it.bytes(at, 4 * this.it.word(count)).slice().buffer);
    });
  }
  /** Its entry in manifest.json: blocks with their fields, textures, inputs. */
  get interface(): Interface {
    return JSON.parse(this.it.sized('lacquer_shader_interface', this.at));
  }
  /** The bytes of a uniform block that the application fills, from numbers by the names of its fields: what is not named is 0,
   * names that the block has no field of are passed over. Of the lights a list, with the numbers of each. The material's
   * block is what pack() gives. */
  block(name: string, values: Values | Values[] = {}): Uint8Array {
    const of = this.interface.uniforms.find(({ block }) => block === name);
    if (!of) throw new RangeError(`the shader has no block ${name}`);
    const data = new DataView(new ArrayBuffer(of.size));
    (Array.isArray(values) ? values : [values]).slice(0, of.array ?? 1).forEach((each, element) => {
      for (const { name: field, type, offset } of of.fields) {
        const at = element * (of.stride ?? 0) + offset;
        const value = each[field] ?? [];
        const numbers = typeof value === 'number' ? [value] : Array.from(value);
        numbers.forEach((x, i) => data[type === 'int' ? 'setInt32' : 'setFloat32'](at + 4 * i, x, true));
      }
    });
    return new Uint8Array(data.buffer);
  }
  /** Of the target "wgsl": what createBindGroupLayout() wants of each group, from 0 on. Each entry has the `name` of what is
   * bound there, too: a block, a texture, or a texture's sampler. */
  bindGroupLayouts(): { entries: BindGroupLayoutEntry[] }[] {
    const groups: { entries: BindGroupLayoutEntry[] }[] = [];
    for (const { group, visibility, ...entry } of this.interface.webgpu?.bindings ?? []) {
      while (groups.length <= group) groups.push({ entries: [] });
      groups[group].entries.push({ ...entry, visibility: visibility.reduce((bits, stage) => bits | kVisibility[stage], 0) });
    }
    return groups;
  }
  /** Bytes of the material's uniform block; 0 when there is none. */
  get uniformSize(): number {
    return this.it.call.lacquer_shader_uniform_size(this.at);
  }
  /** The preshader: the bytes of the material's uniform block. Parameters that are not given have today's value; names
   * that this shader has no parameter of are passed over. */
  pack(values: Record<string, number | number[]> = {}, messages: Message[] = []): Uint8Array {
    const entries = Object.entries(values).map(([name, value]) => [name, [value].flat()] as const);
    const numbers = entries.flatMap(([, value]) => value);
    return this.it.withTexts(entries.map(([name]) => name), (names) =>
      this.it.withBytes(new Uint8Array(new Float64Array(numbers).buffer), (doubles) => {
        const rows = new Uint32Array(3 * entries.length);
        let used = 0;
        entries.forEach(([, value], i) => {
          rows.set([names[i], doubles + 8 * used, value.length], 3 * i);
          used += value.length;
        });
        return this.it.withBytes(new Uint8Array(rows.buffer), (list) =>
          this.it.withBytes(this.uniformSize, (block, size) => {
            calling(this.it, undefined, messages, (said) =>
              this.it.call.lacquer_shader_pack(this.at, list, entries.length, block, size, said),
            );
            return this.it.bytes(block, size).slice();
          }),
        );
      }),
    );
  }
  /** The same with a graph's numbers as they are now: one whose shader this is, changes() says. */
  packGraph(graph: Graph, messages: Message[] = []): Uint8Array {
    return this.it.withBytes(this.uniformSize, (block, size) => {
      calling(this.it, undefined, messages, (said) =>
        this.it.call.lacquer_shader_pack_graph(this.at, graph.address, block, size, said),
      );
      return this.it.bytes(block, size).slice();
    });
  }
}

function evaluated(
  it: Instance,
  points: Points,
  options: EvaluationOptions | undefined,
  messages: Message[],
  call: (at: number, size: number, engine: number, how: number, said: number) => number,
): Evaluation {
  const { engine, ...rest } = options ?? {};
  return it.withText(JSON.stringify(points), (at, size) =>
    JSON.parse(it.taken(calling(it, rest, messages, (said, how) => call(at, size, engine === 'float' ? 1 : 0, how, said)))),
  );
}

function drawn(
  it: Instance,
  pixels: number,
  options: Options | undefined,
  messages: Message[],
  call: (at: number, size: number, how: number, said: number) => number,
): Uint8ClampedArray {
  return it.withBytes(3 * pixels * pixels, (at, size) => {
    calling(it, options, messages, (said, how) => call(at, size, how, said));
    const rgb = it.bytes(at, size);
    const rgba = new Uint8ClampedArray(4 * pixels * pixels).fill(255);
    for (let i = 0; i < pixels * pixels; ++i) rgba.set(rgb.subarray(3 * i, 3 * i + 3), 4 * i);
    return rgba;
  });
}

/** A node graph: one term of the specification is one node. An edit that fails throws, and leaves the graph as it was. Nodes,
 * inputs and outputs of a group are named with the group and a slash: "worn/mix". */
export class Graph extends Handle {
  /** @internal */
  constructor(it: Instance, at: number) {
    super(it, at, 'lacquer_graph_free');
  }
  toJson(): GraphJson {
    return JSON.parse(this.toText());
  }
  /** The JSON form as the program writes it. */
  toText(): string {
    return this.it.taken(this.it.call.lacquer_graph_json(this.at));
  }
  toDot(): string {
    return this.it.taken(this.it.call.lacquer_graph_dot(this.at));
  }
  parameters(): Parameter[] {
    return JSON.parse(this.it.taken(this.it.call.lacquer_graph_parameters(this.at)) || '[]');
  }
  textures(): GraphTexture[] {
    return JSON.parse(this.it.taken(this.it.call.lacquer_graph_textures(this.at)) || '[]');
  }
  /** The names of its groups. */
  groups(): string[] {
    return JSON.parse(this.it.taken(this.it.call.lacquer_graph_groups(this.at)) || '[]');
  }
  /** Its nodes, or those of a group. */
  nodes(group = ''): GraphNode[] {
    return this.it.withText(group, (at) => JSON.parse(this.it.taken(this.it.call.lacquer_graph_nodes(this.at, at)) || '[]'));
  }
  /** The ports of the template that are connected, or the outputs of a group. */
  outputs(group = ''): Record<string, GraphSource> {
    return this.it.withText(group, (at) => JSON.parse(this.it.taken(this.it.call.lacquer_graph_outputs(this.at, at)) || '{}'));
  }
  /** What a node takes and gives; without a node the template's ports, as inputs. */
  sockets(node = '', messages: Message[] = []): Sockets {
    return this.it.withText(node, (at) =>
      JSON.parse(
        this.it.taken(
          calling(this.it, undefined, messages, (said) => this.it.call.lacquer_graph_sockets(this.at, at, said)),
        ),
      ),
    );
  }
  addNode(id: string, type: string, messages?: Message[]): void {
    this.call('lacquer_graph_add_node', [id, type], messages);
  }
  /** A node that is a group of the graph. */
  addInstance(id: string, group: string, messages?: Message[]): void {
    this.call('lacquer_graph_add_instance', [id, group], messages);
  }
  removeNode(id: string, messages?: Message[]): void {
    this.call('lacquer_graph_remove_node', [id], messages);
  }
  /** And in all that takes values from it. */
  renameNode(id: string, to: string, messages?: Message[]): void {
    this.call('lacquer_graph_rename_node', [id, to], messages);
  }
  /** The input has its default again. */
  disconnect(node: string, input: string, messages?: Message[]): void {
    this.call('lacquer_graph_disconnect', [node, input], messages);
  }
  removeOutput(port: string, messages?: Message[]): void {
    this.call('lacquer_graph_remove_output', [port], messages);
  }
  /** Puts nodes into a new group, and an instance of it in their place. */
  makeGroup(nodes: string[], group: string, instance: string, messages: Message[] = []): void {
    this.it.withTexts([group, instance, ...nodes], ([name, id, ...ids]) =>
      this.it.withBytes(new Uint8Array(new Uint32Array(ids).buffer), (list) =>
        calling(this.it, undefined, messages, (said) =>
          this.it.call.lacquer_graph_make_group(this.at, list, ids.length, name, id, said),
        ),
      ),
    );
  }
  /** A graph as a group of this one: its parameters and textures are inputs. */
  addGroup(group: string, graph: Graph, messages: Message[] = []): void {
    this.it.withText(group, (at) =>
      calling(this.it, undefined, messages, (said) =>
        this.it.call.lacquer_graph_add_group(this.at, at, graph.address, said),
      ),
    );
  }
  /** Puts the nodes of an instance's group in its place. */
  expand(node: string, messages?: Message[]): void {
    this.call('lacquer_graph_expand', [node], messages);
  }
  /** Any edit in its JSON form, or several, all or none (docs/graph-format.md, "Edits"): what takes it back, after which the
   * graph has the same bytes. */
  edit(edit: GraphEdit | GraphEdit[], messages: Message[] = []): GraphEdit | GraphEdit[] {
    return this.it.withBytes(new TextEncoder().encode(JSON.stringify(edit)), (at, size) =>
      JSON.parse(
        this.it.taken(
          calling(this.it, undefined, messages, (said) => this.it.call.lacquer_graph_edit(this.at, at, size, said)),
        ),
      ),
    );
  }
  /** What has changed since generate(), the gravest. */
  changes(): Change {
    return kChanges[this.it.call.lacquer_graph_changes(this.at)];
  }
  connect(node: string, input: string, source: GraphSource, messages?: Message[]): void {
    this.call('lacquer_graph_connect', [node, input, JSON.stringify(source)], messages);
  }
  setOutput(port: string, source: GraphSource, messages?: Message[]): void {
    this.call('lacquer_graph_set_output', [port, JSON.stringify(source)], messages);
  }
  setParameter(name: string, value: number | number[], messages: Message[] = []): void {
    const numbers = [value].flat();
    this.it.withText(name, (at) =>
      this.it.withBytes(new Uint8Array(new Float64Array(numbers).buffer), (list) =>
        calling(this.it, undefined, messages, (said) =>
          this.it.call.lacquer_graph_set_parameter(this.at, at, list, numbers.length, said),
        ),
      ),
    );
  }
  setRange(parameter: string, low: number, high: number, orZero = false, messages: Message[] = []): void {
    this.it.withText(parameter, (at) =>
      calling(this.it, undefined, messages, (said) =>
        this.it.call.lacquer_graph_set_range(this.at, at, low, high, orZero ? 1 : 0, said),
      ),
    );
  }
  /** What is wrong with it and worth knowing. */
  check(options?: Options): Message[] {
    const messages: Message[] = [];
    try {
      calling(this.it, options, messages, (said, how) => this.it.call.lacquer_graph_check(this.at, how, said));
    } catch (error) {
      if (!(error instanceof LacquerError)) throw error;
    }
    return messages;
  }
  /** As Scene's, of the graph as it is now. */
  evaluate(points: Points, options?: EvaluationOptions, messages: Message[] = []): Evaluation {
    return evaluated(this.it, points, options, messages, (at, size, engine, how, said) =>
      this.it.call.lacquer_graph_evaluate(this.at, at, size, engine, how, said),
    );
  }
  /** As Scene's, of the graph as it is now. */
  preview(pixels: number, options?: Options, messages: Message[] = []): Uint8ClampedArray {
    return drawn(this.it, pixels, options, messages, (at, size, how, said) =>
      this.it.call.lacquer_graph_preview(this.at, pixels, at, size, how, said),
    );
  }
  generate(options?: Options, messages: Message[] = []): Shader {
    const call = (said: number, how: number) => this.it.call.lacquer_graph_generate(this.at, how, said);
    return new Shader(this.it, calling(this.it, options, messages, call));
  }
  /** The values of the code with their rates, after the pass of that name; after the last without one. */
  dump(pass = '', options?: Options, messages: Message[] = []): string {
    return this.it.withText(pass, (at) =>
      this.it.taken(
        calling(this.it, options, messages, (said, how) => this.it.call.lacquer_graph_dump(this.at, at, how, said)),
      ),
    );
  }

  private call(call: string, texts: string[], messages: Message[] = []): void {
    this.it.withTexts(texts, (at) =>
      calling(this.it, undefined, messages, (said) => this.it.call[call](this.at, ...at, said)),
    );
  }
}

/** The materials of a glTF file. */
export class Scene extends Handle {
  /** @internal */
  constructor(it: Instance, at: number) {
    super(it, at, 'lacquer_scene_free');
  }
  get materialCount(): number {
    return this.it.call.lacquer_scene_material_count(this.at);
  }
  materialName(material: number): string {
    return this.it.sized('lacquer_scene_material_name', this.at, material);
  }
  /** Of the primitives that use a material, each kind once. */
  uses(material: number): Attribute[][] {
    const count = this.it.call.lacquer_scene_use_count(this.at, material);
    return Array.from({ length: count }, (_, i) => {
      const bits = this.it.call.lacquer_scene_use(this.at, material, i);
      return kAttributes.filter((_name, bit) => (bits >> bit) & 1);
    });
  }
  /** On primitives with these attributes; those of its first use where none are named. */
  graph(material: number, options?: Options, attributes?: Attribute[], messages: Message[] = []): Graph {
    const bits = this.bits(material, attributes);
    const call = (said: number, how: number) => this.it.call.lacquer_scene_graph(this.at, material, bits, how, said);
    return new Graph(this.it, calling(this.it, options, messages, call));
  }
  /** What a change of each property of a material is to its shader: a number of its block, another image, or another program. */
  properties(material: number, options?: Options, attributes?: Attribute[], messages: Message[] = []): PropertyUse[] {
    const bits = this.bits(material, attributes);
    const call = (said: number, how: number) =>
      this.it.call.lacquer_scene_properties(this.at, material, bits, how, said);
    return JSON.parse(this.it.taken(calling(this.it, options, messages, call)));
  }
  /** A MaterialX document of the materials: of those of the names, or all. `surface` is "gltf_pbr", "open_pbr_surface", or left out
   * for the one that says more of a material. Of materials whose graphs were edited, by their numbers, it has what computes texels
   * in the graph, with its numbers and images. What it cannot say is a warning. */
  toMaterialX(what: { materials?: string[]; surface?: string; edited?: Map<number, Graph> } = {}, messages: Message[] = []): string {
    const edited = [...(what.edited ?? [])];
    const numbers = new Uint8Array(new Uint32Array(edited.map(([material]) => material)).buffer);
    const graphs = new Uint8Array(new Uint32Array(edited.map(([, graph]) => graph.address)).buffer);
    return this.named(what.materials, (names, count) =>
      this.it.withTexts([what.surface ?? ''], ([surface]) =>
        this.it.withBytes(numbers, (first) =>
          this.it.withBytes(graphs, (list) =>
            this.it.taken(
              calling(this.it, undefined, messages, (said) =>
                this.it.call.lacquer_scene_materialx(this.at, names, count, surface, first, list, edited.length, 0, said),
              ),
            ),
          ),
        ),
      ),
    );
  }
  /** A glTF file whose procedural textures are KHR_texture_procedurals, each with a baked fallback of `size` by `size` texels. */
  toGltf(what: { materials?: string[]; size?: number } = {}, messages: Message[] = []): string {
    return this.named(what.materials, (names, count) =>
      this.it.taken(
        calling(this.it, undefined, messages, (said) =>
          this.it.call.lacquer_scene_gltf(this.at, names, count, what.size ?? 256, 0, said),
        ),
      ),
    );
  }
  /** Names as a list of C's. */
  private named<T>(names: string[] | undefined, call: (at: number, count: number) => T): T {
    return this.it.withTexts(names ?? [], (each) =>
      this.it.withBytes(new Uint8Array(new Uint32Array(each).buffer), (list) => call(list, each.length)),
    );
  }
  private bits(material: number, attributes?: Attribute[]): number {
    const names = attributes ?? this.uses(material)[0] ?? kUnusedAttributes;
    return names.reduce((sum, name) => sum | (1 << kAttributes.indexOf(name)), 0);
  }
  /** Linear colours at points, as `lacquer eval`. */
  evaluate(
    material: number,
    points: Points,
    options?: EvaluationOptions,
    messages: Message[] = [],
  ): Evaluation {
    return evaluated(this.it, points, options, messages, (at, size, engine, how, said) =>
      this.it.call.lacquer_scene_evaluate(this.at, material, at, size, engine, how, said),
    );
  }
  /** A lit ball of that many pixels on a side, from 16 to 2048: RGBA, for an ImageData. */
  preview(material: number, pixels: number, options?: Options, messages: Message[] = []): Uint8ClampedArray {
    return drawn(this.it, pixels, options, messages, (at, size, how, said) =>
      this.it.call.lacquer_scene_preview(this.at, material, pixels, at, size, how, said),
    );
  }
}

/** The library. */
export class Lacquer {
  /** @internal */
  constructor(private readonly it: Instance) {
    const version = it.call.lacquer_c_version();
    if (version !== kInterfaceVersion) throw new Error(`lacquer.wasm has the interface ${version}, not ${kInterfaceVersion}`);
  }
  /** "0.2.0" */
  get version(): string {
    const at = this.it.call.lacquer_version();
    let size = 0;
    while (this.it.bytes(at + size, 1)[0] !== 0) ++size;
    return this.it.text(at, size);
  }
  /** Bytes of memory that the module has. */
  get memory(): number {
    return (this.it.call as unknown as { memory: WebAssembly.Memory }).memory.buffer.byteLength;
  }
  /** Reads .gltf or .glb; `name` stands for the file in messages. Images that are not in it are absent. */
  scene(bytes: Uint8Array | string, name: string, options?: Options, messages: Message[] = []): Scene {
    const data = typeof bytes === 'string' ? new TextEncoder().encode(bytes) : bytes;
    const handle = this.it.withBytes(data, (at, size) =>
      this.it.withText(name, (named) =>
        calling(this.it, options, messages, (said, how) => this.it.call.lacquer_scene_read(at, size, named, how, said)),
      ),
    );
    return new Scene(this.it, handle);
  }
  /** Reads the JSON form of a graph. Of the options, `limits`. */
  graph(json: GraphJson | string, name = 'graph.json', messages: Message[] = [], options?: Options): Graph {
    const text = typeof json === 'string' ? json : JSON.stringify(json);
    const handle = this.it.withBytes(new TextEncoder().encode(text), (at, size) =>
      this.it.withText(name, (named) =>
        calling(this.it, options, messages, (said, how) =>
          this.it.call.lacquer_graph_read_with(at, size, named, how, said),
        ),
      ),
    );
    return new Graph(this.it, handle);
  }
  /** Nodes, templates, profiles, extensions and their properties, as `lacquer nodes --json`. */
  nodes(options?: Options): any {
    return JSON.parse(this.it.taken(calling(this.it, options, [], (said, how) => this.it.call.lacquer_nodes(how, said))));
  }
  /** What is wrong with the options' own node files and MaterialX definitions, `node_texts` and `materialx_texts`, and worth knowing. */
  checkNodes(options: Options): Message[] {
    const messages: Message[] = [];
    try {
      calling(this.it, options, messages, (said, how) => this.it.call.lacquer_check_nodes(how, said));
    } catch (error) {
      // Where nothing was said, it was not looked at.
      if (!(error instanceof LacquerError) || messages.length === 0) throw error;
    }
    return messages;
  }
  /** The table behind environment_dfg: `size` rows of `size` pairs. */
  environmentDfg(size: number): Float32Array {
    return this.table('lacquer_environment_dfg', size);
  }
  /** The table behind environment_sheen. */
  environmentSheen(size: number): Float32Array {
    return this.table('lacquer_environment_sheen', size);
  }

  /** The files of `lacquer environment` from a picture of the surroundings, Radiance HDR; `name` stands for it in messages. */
  environment(picture: Uint8Array, name: string, how: EnvironmentForm = {}, messages: Message[] = [], options?: Options): EnvironmentFiles {
    const { call } = this.it;
    const at = this.it.withBytes(picture, (data, size) =>
      this.it.withTexts([name, JSON.stringify(how)], ([named, form]) =>
        calling(this.it, options, messages, (said, opts) => call.lacquer_environment_filter(data, size, named, form, opts, said)),
      ),
    );
    try {
      const made = JSON.parse(this.it.sized('lacquer_environment_description', at)) as EnvironmentFiles;
      made.files = {};
      for (const slot of Object.keys(made.textures)) {
        made.files[slot] = this.it.withText(slot, (named) =>
          this.it.withBytes(4, (size) => {
            const file = call.lacquer_environment_file(at, named, size);
            return this.it.bytes(file, this.it.word(size)).slice();
          }),
        );
      }
      return made;
    } finally {
      call.lacquer_environment_free(at);
    }
  }

  private table(name: string, size: number): Float32Array {
    return this.it.withBytes(8 * size * size, (at, bytes) => {
      calling(this.it, undefined, [], (said) => this.it.call[name](size, at, bytes / 4, said));
      return new Float32Array(this.it.bytes(at, bytes).slice().buffer);
    });
  }
}
