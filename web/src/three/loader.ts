// A plugin of three.js's GLTFLoader: the meshes of a file get Lacquer's materials.
import { MeshBasicMaterial, TextureLoader, type Group, type Material, type Mesh, type Object3D, type Texture } from 'three';
import type { Lacquer, Scene as LacquerScene } from '../index.js';
import { materialsAlone, swizzledImage, toConsole, unlessTold } from '../renderers/file.js';
import type { GraphTexture, Message, Options } from '../types.js';
import { asSlot, attributesOf, LacquerMaterial, withStates } from './material.js';

/** What the plugin uses of GLTFLoader's parser. */
interface Parser {
  json: any;
  options: { path: string; manager: any };
  associations: Map<unknown, { materials?: number }>;
  textureLoader: unknown;
  getDependency(type: string, index: number): Promise<any>;
  loadTextureImage(texture: number, source: number, loader: unknown): Promise<Texture | null>;
}

export interface PluginOptions {
  options?: Options;
  /** Is told what the library says of the materials; without it warnings and errors go to the console. */
  onMessage?: (message: Message) => void;
}

/** `loader.register((parser) => new LacquerPlugin(parser, lacquer))`: every extension that the library knows is drawn. A material
 * of which no shader can be made is told, and drawn in its base colour. */
export class LacquerPlugin {
  readonly name = 'LACQUER';
  private readonly parser: Parser;
  private readonly options: Options;
  private readonly tell: (message: Message) => void;
  private readonly made = new Map<string, Promise<Material | null>>();
  private file: LacquerScene | null = null;

  constructor(parser: unknown, private readonly lacquer: Lacquer, { options = {}, onMessage = toConsole }: PluginOptions = {}) {
    this.parser = parser as Parser;
    this.options = options;
    this.tell = onMessage;
  }

  /** In the place of three.js's own, whose textures would be loaded for nothing. */
  async loadMaterial(index: number): Promise<Material> {
    const json = this.parser.json.materials[index];
    const [r, g, b, opacity] = json.pbrMetallicRoughness?.baseColorFactor ?? [1, 1, 1, 1];
    const plain = withStates(new MeshBasicMaterial({ opacity }), json);
    plain.color.setRGB(r, g, b);
    this.parser.associations.set(plain, { materials: index });
    return plain;
  }

  /** NV_texture_swizzle: the image whose channels the shader takes. Null: the texture is three.js's. */
  loadTexture(index: number): Promise<Texture | null> | null {
    const image = swizzledImage(this.parser.json.textures[index]);
    return image === undefined ? null : this.parser.loadTextureImage(index, image, this.parser.textureLoader);
  }

  async afterRoot(result: { scenes: Group[] }): Promise<void> {
    const meshes: Mesh[] = [];
    for (const scene of result.scenes) scene.traverse((object: Object3D) => (object as Mesh).isMesh && meshes.push(object as Mesh));
    await Promise.all(meshes.map(async (mesh) => {
      const index = this.parser.associations.get(mesh.material)?.materials;
      const material = await this.materialOf(index ?? this.defaultIndex(), mesh);
      if (!material) return;
      mesh.material = material;
      if (index !== undefined) this.parser.associations.set(material, { materials: index });
    }));
    this.file?.free();
    this.file = null;
  }

  /** Behind the file's own. */
  private defaultIndex(): number {
    return this.parser.json.materials?.length ?? 0;
  }

  /** A material of the file on a mesh of it, of variants for instance; once made, the same one again. Null, and a message, where no
   * shader can be made. */
  materialOf(index: number, mesh: Mesh): Promise<Material | null> {
    const key = [index, ...attributesOf(mesh)].join();
    const known = this.made.get(key);
    if (known) return known;
    const made = this.make(index, mesh);
    this.made.set(key, made);
    return made;
  }

  /** Null, and a message, where the library makes no shader. */
  private async make(index: number, mesh: Mesh): Promise<Material | null> {
    const messages: Message[] = [];
    let material: LacquerMaterial | null = null;
    try {
      this.file ??= this.lacquer.scene(JSON.stringify(materialsAlone(this.parser.json)), 'scene.gltf', this.options, messages);
      const graph = this.file.graph(index, this.options, attributesOf(mesh), messages);
      const slots = graph.textures();
      const pictures = await Promise.all(slots.map((slot) => this.picture(slot)));
      const textures = Object.fromEntries(slots.map(({ name }, i) => [name, pictures[i]]));
      material = new LacquerMaterial(this.lacquer, graph, { textures, options: this.options, messages });
      withStates(material, this.parser.json.materials?.[index] ?? {});
    } catch (error) {
      unlessTold(error);
    }
    messages.forEach(this.tell);
    return material;
  }

  private async picture(slot: GraphTexture): Promise<Texture | null> {
    const { texture, file } = slot;
    const { manager, path } = this.parser.options;
    const load = async (): Promise<Texture | null> => {
      if (texture >= 0) return this.parser.getDependency('texture', texture);
      return file ? new TextureLoader(manager).loadAsync(path + file) : null;
    };
    const found = await load().catch(() => null); // the loader has told
    if (!found) return null;
    if (file) found.flipY = false;
    return asSlot(found, slot);
  }
}
