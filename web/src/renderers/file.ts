// What of a glTF file the materials need, which a renderer's loader has read.
import type { Message } from '../types.js';

/** Extensions of a file's buffers, which the loader has undone: what is in the materials' way is left out of the JSON. */
const kGeometry = new Set([
  'KHR_draco_mesh_compression', 'EXT_meshopt_compression', 'KHR_meshopt_compression', 'KHR_mesh_quantization', 'EXT_mesh_gpu_instancing',
]);

/** A file without its geometry. The last of its materials is glTF's default. */
export function materialsAlone(file: any): object {
  const { asset, extensionsUsed, extensionsRequired, extensions, materials, textures, images, samplers } = file;
  const shown = (names?: string[]) => names?.filter((name) => !kGeometry.has(name));
  return {
    asset, textures, samplers, extensions,
    materials: [...(materials ?? []), {}],
    // Pictures in buffers are the loader's.
    images: images?.map((image: any, i: number) => (image.uri?.startsWith('data:') || !image.uri ? { uri: `${i}.png` } : image)),
    extensionsUsed: shown(extensionsUsed), extensionsRequired: shown(extensionsRequired),
  };
}

/** The file of one material and that many textures, each of its own image. */
export function fileOf(material: object, textures: number): object {
  const each = Array.from({ length: textures }, (_, i) => i);
  return {
    asset: { version: '2.0' }, materials: [material],
    images: each.map((i) => ({ uri: `${i}.png` })), textures: each.map((source) => ({ source })),
  };
}

/** Of an image that a browser decodes. */
const kChannels = 4;
/** NV_texture_swizzle: the image whose channels the shader takes, where a texture has none beside. */
export function swizzledImage(texture: any): number | undefined {
  const options: { source: number; channels: number[] }[] = texture.extensions?.NV_texture_swizzle?.options ?? [];
  const image = options.find(({ channels }) => channels.every((channel) => channel < kChannels));
  return texture.source === undefined ? image?.source : undefined;
}

export function toConsole({ level, text }: Message): void {
  if (level === 'error') console.error(text);
  else if (level === 'warning') console.warn(text);
}

/** Lets what the library throws pass, whose messages are told; nothing else. */
export function unlessTold(error: unknown): void {
  if (!Array.isArray((error as { messages?: unknown }).messages)) throw error;
}
