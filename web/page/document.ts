// The file that is edited: what is read from it, what changes it, and the way back.
import type { Attribute, Lacquer, Message } from '../src/index';
import { geometry, openGltf, type Drawable, type GltfFile } from '../src/gltf';
import { item, list } from '../src/json';
import { asGltf, isDocument } from './foreign';
import { FileLights } from './lights';
import { Moves } from './moves';
import { kOwnNodes } from './nodetext';
import { kStage, stageOf, type Stage } from './stage';
import { FileCameras } from './view';

export interface Input {
  name: string;
  bytes: Uint8Array;
  resources: Map<string, Uint8Array>;
}

/** What the page's shaders do without: each instance is placed as a mesh of its own, what is stored as integers is read as floats,
 * and skins and morph targets have bent the vertices before. */
const kPlaced: Attribute[] = ['INSTANCES', 'QUANTIZED', 'JOINTS_0', 'JOINTS_1', 'MORPH_TARGETS'];

/** All that an edit may change of one material. */
interface Snapshot {
  index: number;
  material?: string; // JSON; none where the file has no materials
  extensionsUsed: string; // JSON
  graph: string | null;
  layout: string;
  stage: Stage;
  state: number;
}

export class Document {
  readonly file: GltfFile;
  readonly drawables: Drawable[];
  readonly moves: Moves;
  readonly lights: FileLights;
  readonly cameras: FileCameras;
  /** The drawables' materials outside of any variant. */
  private readonly plain: number[];
  readonly uses: Attribute[][] = [];
  readonly names: string[] = [];
  /** A node file of the document's own, which its graphs may use. */
  nodeText = '';
  /** What its `extras` had of graphs that cannot be read. */
  readonly refused: string[] = [];
  /** What reading a MaterialX document has said. */
  readonly said: Message[] = [];
  material = 0;
  /** What it stands in. */
  stage: Stage = kStage;
  /** The graph in its JSON form where it was edited itself; then the material only gives its parameters' values. */
  graphs = new Map<number, string>();
  /** JSON: where the boxes are of graphs that are made of properties. */
  private readonly layouts = new Map<number, string>();
  /** A number for each state that the document was in; a step back leads to the number that was. */
  state = 0;
  private states = 0;
  private savedState = 0;
  private past: Snapshot[] = [];
  private future: Snapshot[] = [];
  private last = '';
  private readonly own: { textures: number; images: number }; // how many the file came with
  private around: string | null = null; // what slim() begins with

  /** Throws a LacquerError for what the library cannot read. */
  constructor(lacquer: Lacquer, given: Input) {
    const input = isDocument(given.name) ? asGltf(lacquer, given, this.said) : given;
    const scene = lacquer.scene(input.bytes, input.name);
    for (let i = 0; i < scene.materialCount; ++i) {
      this.names.push(scene.materialName(i));
      this.uses.push(scene.uses(i)[0]?.filter((name) => !kPlaced.includes(name)) ?? ['NORMAL', 'TANGENT', 'TEXCOORD_0', 'TEXCOORD_1']);
    }
    scene.free();
    this.file = openGltf(input.name, input.bytes, input.resources);
    this.drawables = geometry(this.file, { hidden: true });
    this.moves = new Moves(this.file, this.drawables);
    this.lights = new FileLights(this.file);
    this.cameras = new FileCameras(this.file);
    this.plain = this.drawables.map(({ material }) => material);
    this.own = { textures: list(this.json.textures).length, images: list(this.json.images).length };
    this.takeExtras(lacquer);
  }

  /** Graphs and nodes that an exported file has in its `extras`: here they are the document's. */
  private takeExtras(lacquer: Lacquer): void {
    const nodes = this.json.extras?.lacquer?.nodes;
    if (typeof nodes === 'string') this.nodeText = nodes;
    if (this.json.extras?.lacquer?.stage !== undefined) this.stage = stageOf(this.json.extras.lacquer.stage);
    const options = this.nodeText ? { node_texts: { [kOwnNodes]: this.nodeText } } : undefined;
    forget(this.json);
    list(this.json.materials).forEach((material, i) => {
      const graph = material?.extras?.lacquer?.graph;
      if (graph === undefined) return;
      try {
        const read = lacquer.graph(JSON.stringify(graph), `${this.file.name}: the graph in extras of material ${i}`, [], options);
        this.graphs.set(i, read.toText());
        read.free();
        forget(material);
      } catch (error) {
        this.refused.push(error instanceof Error ? error.message : String(error));
      }
    });
  }
  /** The JSON with graphs and nodes of the document's own in `extras`. */
  private withExtras(): any {
    const materials = this.json.materials && list(this.json.materials).map((material, i) => {
      const graph = this.graphs.get(i);
      return graph === undefined ? material : withLacquer(material, { graph: JSON.parse(graph) });
    });
    const used = new Set<number>();
    indicesIn(materials, used);
    const json = materials ? withoutUnused({ ...this.json, materials }, this.own, used) : this.json;
    const stage = this.stage === kStage ? {} : { stage: this.stage };
    return this.nodeText || this.stage !== kStage ? withLacquer(json, { ...stage, ...(this.nodeText && { nodes: this.nodeText }) }) : json;
  }


  get json(): any {
    return this.file.json;
  }
  /** What the library is given: the file without what makes it large. Places and names stay. */
  slim(): string {
    this.around ??= JSON.stringify(this.unedited()).slice(0, -1);
    const { extensionsUsed, materials } = this.json;
    const edited = { extensionsUsed, materials: materials.map((each: any, i: number) => (i === this.material ? each : {})) };
    return `${this.around},${JSON.stringify(edited).slice(1)}`;
  }
  /** Of that what no edit changes; an animation of a material's property keeps the property's terms. */
  private unedited(): object {
    const { asset, textures, samplers, images, animations } = this.json;
    const procedurals = this.json.extensions?.KHR_texture_procedurals;
    const targets = (channels: any) => list(channels)
      .map((channel) => channel?.target)
      .filter((target) => {
        const pointer = target?.extensions?.KHR_animation_pointer?.pointer;
        return typeof pointer === 'string' && pointer.startsWith('/materials/');
      })
      .map((target) => ({ target }));
    return {
      asset, textures, samplers,
      images: images && list(images).map((each) => ({ mimeType: each?.mimeType, name: each?.name, uri: 'image' })),
      animations: animations && list(animations).map((each) => ({ channels: targets(each?.channels) })),
      extensions: procedurals && { KHR_texture_procedurals: procedurals },
    };
  }

  /** The value at a JSON pointer; undefined where there is none. */
  get(pointer: string): any {
    return parts(pointer).reduce(own, this.json);
  }
  /** Sets it, making the objects on the way; undefined removes it. Edits of one `key` in a row are one step back. A pointer
   * to what no JSON object has, or through what is none, changes nothing. */
  set(pointer: string, value: unknown, key: string): void {
    const path = parts(pointer);
    let at = this.json;
    for (const part of path) {
      if (!leads(at, part)) return;
      at = own(at, part) ?? {};
    }
    const last = path.pop();
    if (last === undefined) return;
    this.keep(key);
    at = path.reduce((object, part) => (object[part] = own(object, part) ?? {}), this.json);
    if (value === undefined) delete at[last];
    else at[last] = value;
  }
  /** Adds or removes an extension of the material, with an empty object as its value. */
  setExtension(pointer: string, name: string, on: boolean): void {
    this.set(pointer, on ? {} : undefined, `extension ${name} ${on}`);
    const used = new Set<string>(list(this.json.extensionsUsed));
    if (on) used.add(name);
    this.json.extensionsUsed = [...used];
  }
  /** Says that the file uses an extension. */
  use(name: string): void {
    this.json.extensionsUsed = [...new Set([...list(this.json.extensionsUsed), name])];
  }
  /** A picture as a new texture, which the exported file has in itself where something uses it. */
  addTexture(name: string, mimeType: string, bytes: Uint8Array): number {
    const uri = `data:${mimeType};base64,${toBase64(bytes)}`;
    const source = push(this.json, 'images', { name, mimeType, uri });
    this.around = null;
    return push(this.json, 'textures', { source });
  }
  /** The same picture with another sampler: other slots keep the one that they have. */
  resampled(texture: number, sampler: object): number {
    const same = list(this.json.samplers).findIndex((each) => JSON.stringify(each) === JSON.stringify(sampler));
    const index = same >= 0 ? same : push(this.json, 'samplers', sampler);
    const next = { ...this.json.textures[texture], sampler: index };
    const there = list(this.json.textures).findIndex((each) => JSON.stringify(each) === JSON.stringify(next));
    this.around = null;
    return there >= 0 ? there : push(this.json, 'textures', next);
  }
  setGraph(text: string | null, key: string): void {
    this.keep(key);
    if (text === null) this.graphs.delete(this.material);
    else this.graphs.set(this.material, text);
  }

  setStage(stage: Stage, key: string): void {
    this.keep(`stage ${key}`);
    this.stage = stage;
  }

  get layout(): string {
    return this.layouts.get(this.material) ?? '';
  }
  setLayout(text: string): void {
    this.keep(`layout ${performance.now()}`);
    this.layouts.set(this.material, text);
    this.settle();
  }

  /** Draws with the materials of a variant, by its number; with none, with the file's own. */
  vary(variant: string): void {
    this.drawables.forEach((drawable, i) => (drawable.material = (variant === '' ? undefined : drawable.variants?.get(Number(variant))) ?? this.plain[i]));
  }

  // ---- the way back

  get canUndo(): boolean {
    return this.past.length > 0;
  }
  get canRedo(): boolean {
    return this.future.length > 0;
  }
  undo(): void {
    this.travel(this.past, this.future);
  }
  redo(): void {
    this.travel(this.future, this.past);
  }
  /** The next edit is a step of its own. */
  settle(): void {
    this.last = '';
  }
  private keep(key: string): void {
    if (key !== this.last) this.past.push(this.snapshot(this.material));
    if (this.past.length > 500) this.past.shift();
    this.future = [];
    this.last = key;
    this.touch();
  }
  /** Something of it is to be another from now on. */
  touch(): void {
    this.state = ++this.states;
  }
  /** Whether it has edits that are in no file. */
  get isEdited(): boolean {
    return this.state !== this.savedState;
  }
  saved(): void {
    this.savedState = this.state;
  }
  unsaved(): void {
    this.savedState = -1;
  }
  private snapshot(index: number): Snapshot {
    return {
      index,
      material: JSON.stringify(item(this.json.materials, index)),
      extensionsUsed: JSON.stringify(this.json.extensionsUsed ?? []),
      graph: this.graphs.get(index) ?? null,
      layout: this.layouts.get(index) ?? '',
      stage: this.stage,
      state: this.state,
    };
  }
  private travel(from: Snapshot[], to: Snapshot[]): void {
    const target = from.pop();
    if (!target) return;
    to.push(this.snapshot(target.index));
    this.material = target.index;
    if (target.material !== undefined) this.json.materials[target.index] = JSON.parse(target.material);
    this.json.extensionsUsed = JSON.parse(target.extensionsUsed);
    if (target.graph === null) this.graphs.delete(target.index);
    else this.graphs.set(target.index, target.graph);
    this.layouts.set(target.index, target.layout);
    this.stage = target.stage;
    this.state = target.state;
    this.settle();
  }

  // ---- out again

  /** The edited file in the form that it came in: a .glb stays one. */
  export(): { name: string; bytes: Uint8Array<ArrayBuffer> } {
    const text = new TextEncoder().encode(JSON.stringify(this.withExtras(), null, this.file.binary ? 0 : 2));
    if (!this.file.binary) return { name: this.file.name, bytes: new Uint8Array(text) };
    const chunk = (kind: number, bytes: Uint8Array, pad: number) => {
      const size = Math.ceil(bytes.length / 4) * 4;
      const made = new Uint8Array(8 + size).fill(pad);
      new DataView(made.buffer).setUint32(0, size, true);
      new DataView(made.buffer).setUint32(4, kind, true);
      made.set(bytes, 8);
      return made;
    };
    const chunks = [chunk(0x4e4f534a, text, 0x20), chunk(0x004e4942, this.file.binary, 0)];
    const bytes = new Uint8Array(12 + chunks[0].length + chunks[1].length);
    const view = new DataView(bytes.buffer);
    [0x46546c67, 2, bytes.length].forEach((word, i) => view.setUint32(4 * i, word, true));
    bytes.set(chunks[0], 12);
    bytes.set(chunks[1], 12 + chunks[0].length);
    return { name: this.file.name, bytes };
  }
}

function push(json: any, list: string, what: object): number {
  return (json[list] = Array.isArray(json[list]) ? json[list] : []).push(what) - 1;
}
function toBase64(bytes: Uint8Array): string {
  let text = '';
  for (let i = 0; i < bytes.length; i += 0x8000) text += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
  return btoa(text);
}
/** Of textures that a page has added those that are used; the others were taken back. Added ones are the last. */
function withoutUnused(json: any, first: { textures: number; images: number }, used: Set<number>): any {
  const end = (all: any[], least: number, isUsed: (i: number) => boolean) => {
    let size = all.length;
    while (size > least && !isUsed(size - 1)) --size;
    return size === 0 ? undefined : all.slice(0, size);
  };
  const { textures, images, ...rest } = json;
  if (!Array.isArray(textures) || (textures.length === first.textures && images?.length === first.images)) return json;
  const kept = end(textures, first.textures, (i) => used.has(i));
  const pictures = new Set((kept ?? []).map((each) => each?.source));
  const seen = end(list(images), first.images, (i) => pictures.has(i));
  return { ...rest, ...(kept && { textures: kept }), ...(seen && { images: seen }) };
}
/** What textureInfos name. */
function indicesIn(of: unknown, to: Set<number>): void {
  if (typeof of !== 'object' || of === null) return;
  const { index, texture } = of as { index?: unknown; texture?: unknown };
  for (const each of [index, texture]) if (typeof each === 'number') to.add(each);
  for (const each of Object.values(of)) indicesIn(each, to);
}

const withLacquer = (of: any, what: object) => ({ ...of, extras: { ...of.extras, lacquer: { ...of.extras?.lacquer, ...what } } });
/** Takes out of `extras` what the document keeps itself. */
function forget(of: any): void {
  if (typeof of?.extras?.lacquer !== 'object' || of.extras.lacquer === null) return;
  delete of.extras.lacquer.graph;
  delete of.extras.lacquer.nodes;
  delete of.extras.lacquer.stage;
  if (Object.keys(of.extras.lacquer).length === 0) delete of.extras.lacquer;
  if (Object.keys(of.extras).length === 0) delete of.extras;
}

/** Whether a part of a pointer may lead on from there: to any key of an object, but the one that sets its prototype, and to
 * the elements of a list. */
function leads(at: any, part: string): boolean {
  if (typeof at !== 'object' || at === null || part === '__proto__') return false;
  return !Array.isArray(at) || (/^\d+$/.test(part) && Object.hasOwn(at, part));
}
/** What a value has itself: pointers come with files, and what all objects inherit is none of the file's. */
function own(at: any, part: string): any {
  return leads(at, part) && Object.hasOwn(at, part) ? at[part] : undefined;
}

function parts(pointer: string): string[] {
  return pointer.split('/').slice(1).map((part) => part.replace(/~1/g, '/').replace(/~0/g, '~'));
}
