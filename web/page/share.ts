// A material in the address of the page: with its graph and nodes, without pictures.
import type { Document, Input } from './document';
import { fromBase64 } from '../src/gltf';

const kMark = '#share=';
/** Bytes of what an address unpacks to: it comes from anybody. */
const kMost = 4 * 1024 * 1024;

interface Shared {
  lacquer_share: 1;
  name: string;
  material: any;
  graph?: any;
  nodes?: string;
}

async function through(bytes: Uint8Array, stream: ReadableWritablePair<Uint8Array, any>, most = Infinity): Promise<Uint8Array> {
  const reader = new Blob([bytes.slice()]).stream().pipeThrough(stream).getReader();
  const parts: Uint8Array[] = [];
  let size = 0;
  for (let next = await reader.read(); !next.done; next = await reader.read()) {
    parts.push(next.value);
    size += next.value.length;
    if (size <= most) continue;
    await reader.cancel();
    throw new Error('it is too large');
  }
  const all = new Uint8Array(size);
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

/** The material without what names textures, and how many did. */
function withoutTextures(of: any): { bare: any; left: string[] } {
  const left: string[] = [];
  const bare = (value: any, name: string): any => {
    if (Array.isArray(value) || typeof value !== 'object' || value === null) return value;
    if (name.endsWith('Texture') && typeof value.index === 'number') {
      left.push(name);
      return undefined;
    }
    return Object.fromEntries(Object.entries(value).map(([key, each]) => [key, bare(each, key)]).filter(([, each]) => each !== undefined));
  };
  return { bare: bare(of, ''), left };
}

/** The address's end for the document's current material, and the textures that stay out. */
export async function shared(of: Document): Promise<{ hash: string; left: string[] }> {
  const { bare, left } = withoutTextures(of.json.materials[of.material]);
  const text = of.graphs.get(of.material);
  const graph = text === undefined ? undefined : JSON.parse(text);
  for (const [name, texture] of Object.entries<any>(graph?.textures ?? {})) {
    if (texture.texture === undefined && texture.file === undefined) continue;
    delete texture.texture;
    delete texture.file;
    if (!left.includes(name)) left.push(name);
  }
  const what: Shared = { lacquer_share: 1, name: of.names[of.material] || 'material', material: bare, graph, nodes: of.nodeText || undefined };
  const packed = await through(new TextEncoder().encode(JSON.stringify(what)), new CompressionStream('deflate-raw') as any);
  let binary = '';
  for (let i = 0; i < packed.length; i += 0x8000) binary += String.fromCharCode(...packed.subarray(i, i + 0x8000));
  return { hash: kMark + btoa(binary).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, ''), left };
}

/** The file that an address has; null where it has none. Throws where it cannot be read. */
export async function inputFrom(hash: string): Promise<Input | null> {
  if (!hash.startsWith(kMark)) return null;
  let of: Shared;
  try {
    const packed = fromBase64(hash.slice(kMark.length).replace(/-/g, '+').replace(/_/g, '/'));
    of = JSON.parse(new TextDecoder().decode(await through(packed, new DecompressionStream('deflate-raw') as any, kMost))) as Shared;
  } catch (error) {
    throw new Error(`the address has no material that can be read: ${error instanceof Error ? error.message : String(error)}`);
  }
  if (of?.lacquer_share !== 1 || typeof of.material !== 'object' || of.material === null) throw new Error('the address has no material that can be read');
  const used = new Set<string>();
  const extensions = (value: any): void => {
    if (typeof value !== 'object' || value === null) return;
    for (const [key, each] of Object.entries<any>(value)) {
      if (key === 'extensions' && typeof each === 'object' && each !== null) for (const name of Object.keys(each)) used.add(name);
      if (key !== 'extras') extensions(each);
    }
  };
  extensions(of.material);
  const json = {
    asset: { version: '2.0' }, ...(used.size > 0 && { extensionsUsed: [...used] }),
    materials: [{ ...of.material, ...(of.graph && { extras: { ...of.material.extras, lacquer: { graph: of.graph } } }) }],
    ...(typeof of.nodes === 'string' && { extras: { lacquer: { nodes: of.nodes } } }),
  };
  const name = `${String(of.name).replace(/[^\w .-]+/g, '_').slice(0, 80) || 'material'}.gltf`;
  return { name, bytes: new TextEncoder().encode(JSON.stringify(json)), resources: new Map() };
}
