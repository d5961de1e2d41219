// An extension of Babylon.js's glTF loader: the meshes of a file get Lacquer's materials.
import { Texture } from '@babylonjs/core/Materials/Textures/texture.js';
import type { BaseTexture } from '@babylonjs/core/Materials/Textures/baseTexture.js';
import { Material } from '@babylonjs/core/Materials/material.js';
import type { AbstractMesh } from '@babylonjs/core/Meshes/abstractMesh.js';
import type { GLTFLoader } from '@babylonjs/loaders/glTF/2.0/glTFLoader.js';
import type { IGLTFLoaderExtension } from '@babylonjs/loaders/glTF/2.0/glTFLoaderExtension.js';
import type { IMaterial, ITextureInfo } from '@babylonjs/loaders/glTF/2.0/glTFLoaderInterfaces.js';
import type { Lacquer, Scene as LacquerScene } from '../index.js';
import { materialsAlone, swizzledImage, toConsole, unlessTold } from '../renderers/file.js';
import type { Attribute, GraphTexture, Message, Options } from '../types.js';
import { asSlot, LacquerMaterial, withStates } from './material.js';
import { kOptional } from './text.js';

export interface PluginOptions {
  options?: Options;
  /** Is told what the library says of the materials; without it warnings and errors go to the console. */
  onMessage?: (message: Message) => void;
}

/** What the loader adds to a file's objects. */
const bare = (objects?: object[]) => objects?.map((each) => ({ ...each, index: undefined }));
/** The name of the material that the loader gives to what has none. */
const kDefault = '__GLTFLoader._default';

/** `registerGLTFExtension('LACQUER', false, (loader) => new LacquerExtension(loader, lacquer))`: every extension that the library
 * knows is drawn. A material of which no shader can be made is told, and is Babylon.js's own. */
export class LacquerExtension implements IGLTFLoaderExtension {
  readonly name = 'LACQUER';
  enabled = true;
  /** Before the loader's own extensions. */
  order = 1;
  private readonly options: Options;
  private readonly tell: (message: Message) => void;
  private readonly file: LacquerScene | null;
  private readonly ours = new WeakSet<Material>();
  private readonly defaults = new Map<number, LacquerMaterial | null>();

  constructor(
    private readonly loader: GLTFLoader,
    private readonly lacquer: Lacquer,
    { options = {}, onMessage = toConsole }: PluginOptions = {},
  ) {
    this.options = options;
    this.tell = onMessage;
    const { gltf } = loader;
    const { materials, textures, images, samplers } = gltf;
    const alone = materialsAlone({ ...gltf, materials: bare(materials), textures: bare(textures), images: bare(images), samplers: bare(samplers) });
    this.file = this.told((messages) => lacquer.scene(JSON.stringify(alone), 'scene.gltf', options, messages));
    if (!this.file) return;
    // Whether the library knows what materials require it has said itself.
    const inMaterials = JSON.stringify(materials ?? []);
    const known = (name: string) => inMaterials.includes(`"${name}"`) || name === 'NV_texture_swizzle';
    if (gltf.extensionsRequired) gltf.extensionsRequired = gltf.extensionsRequired.filter((name) => !known(name));
    this.leaveOut();
    for (const texture of textures ?? []) texture.source ??= swizzledImage(texture) as number;
  }

  dispose(): void {
    this.defaults.clear();
  }

  onLoading(): void {
    this.loader.parent.onMeshLoadedObservable.add((mesh: AbstractMesh) => {
      const { material } = mesh;
      if (material?.name === kDefault) mesh.material = this.defaultOf(material.fillMode) ?? material;
    });
  }

  createMaterial(_context: string, material: IMaterial, drawMode: number): Material | null {
    return this.make(material.index, material.name || `material${material.index}`, material, drawMode);
  }

  loadMaterialPropertiesAsync(context: string, _: IMaterial, material: Material): Promise<void> | null {
    if (!this.ours.has(material)) return null;
    const made = material as LacquerMaterial;
    return Promise.all(made.textureSlots().map(async (slot) => {
      const missing = (error: unknown) => this.warn('picture-missing', `${context}/${slot.name}`, String(error));
      const picture = await this.picture(context, slot).catch(missing);
      if (picture) made.setTexture(slot.name, asSlot(picture, slot));
    })).then(() => undefined);
  }

  /** Animations of what Babylon.js's own materials have, by KHR_animation_pointer: these have it not. */
  private leaveOut(): void {
    (this.loader.gltf.animations ?? []).forEach((animation, index) => {
      const kept = animation.channels.filter(({ target }) => !/^\/(materials|textures)\//.test(target.extensions?.KHR_animation_pointer?.pointer ?? ''));
      if (kept.length === animation.channels.length) return;
      animation.channels = kept;
      this.warn('material-animation', `/animations/${index}`, 'what it animates of materials stays as it is');
    });
  }

  private defaultOf(drawMode: number): LacquerMaterial | null {
    const known = this.defaults.get(drawMode);
    if (known !== undefined) return known;
    const made = this.make(this.loader.gltf.materials?.length ?? 0, 'default', {}, drawMode);
    this.defaults.set(drawMode, made);
    return made;
  }

  /** Null, and a message, where the library makes no shader; null for points and lines. */
  private make(index: number, name: string, json: object, drawMode: number): LacquerMaterial | null {
    const { file, options } = this;
    const triangles = [Material.TriangleFillMode, Material.TriangleStripDrawMode, Material.TriangleFanDrawMode];
    if (!file || !triangles.includes(drawMode)) return null;
    return this.told((messages) => {
      const graph = (attributes: Attribute[]) => file.graph(index, options, attributes, messages);
      const scene = this.loader.babylonScene;
      const material = new LacquerMaterial(name, scene, this.lacquer, graph, { options, messages });
      // An asset container has its materials, and gives them to the scene later.
      if ((this.loader as { _assetContainer?: unknown })._assetContainer) scene.removeMaterial(material);
      try {
        for (const attributes of this.usesOf(index)) material.prepare(attributes);
      } catch (error) {
        material.dispose();
        throw error;
      }
      withStates(material, json);
      material.fillMode = drawMode;
      this.ours.add(material);
      return material;
    });
  }

  /** The attributes of the meshes of a material. */
  private usesOf(index: number): Attribute[][] {
    const { meshes = [], materials = [] } = this.loader.gltf;
    const primitives = meshes.flatMap((mesh) => mesh.primitives).filter(({ material = materials.length }) => material === index);
    const uses = primitives.map(({ attributes }) => kOptional.filter((name) => name in attributes));
    return uses.length ? uses : [kOptional];
  }

  private async picture(context: string, { name, texture, file, srgb }: GraphTexture): Promise<BaseTexture | null> {
    const { loader } = this;
    if (texture >= 0) {
      const info = { index: texture, nonColorData: !srgb } as ITextureInfo;
      return loader.loadTextureInfoAsync(`${context}/${name}`, info);
    }
    if (!file) return null;
    return new Promise((done, failed) => {
      const made: Texture = new Texture(`${loader.rootUrl ?? ''}${file}`, loader.babylonScene, {
        invertY: false, useSRGBBuffer: srgb, onLoad: () => done(made), onError: (text) => failed(new Error(`${file}: ${text}`)),
      });
    });
  }

  private warn(code: string, pointer: string, message: string): null {
    this.tell({ level: 'warning', code, file: '', pointer, line: 0, column: 0, message, help: '', text: `${pointer}: ${message}` });
    return null;
  }

  private told<T>(make: (messages: Message[]) => T): T | null {
    const messages: Message[] = [];
    try {
      return make(messages);
    } catch (error) {
      unlessTold(error);
      return null;
    } finally {
      messages.forEach(this.tell);
    }
  }
}
