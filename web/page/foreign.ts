// MaterialX documents: opened as the glTF file that says the same, and written.
import type { Lacquer, Message } from '../src/index';
import type { Document, Input } from './document';
import { kOwnNodes } from './nodetext';

const kInclude = /<(?:xi:)?include\b[^>]*?\bhref\s*=\s*(?:"([^"]*)"|'([^']*)')/g;
const textOf = (bytes: Uint8Array) => new TextDecoder().decode(bytes);

export const isDocument = (name: string) => /\.mtlx$/i.test(name);
const includes = (text: string) => [...text.matchAll(kInclude)].map((match) => match[1] ?? match[2]);
const last = (path: string) => path.slice(path.lastIndexOf('/') + 1);

/** Of dropped documents the one that no other includes. */
export function mainDocument(documents: Map<string, Uint8Array>): string | undefined {
  const included = new Set([...documents.values()].flatMap((bytes) => includes(textOf(bytes)).map(last)));
  return [...documents.keys()].find((name) => !included.has(last(name))) ?? [...documents.keys()][0];
}

/** What a document includes, by its path as seen from the document: dropped files have their names alone. */
function includedTexts(input: Input): Record<string, string> {
  const texts: Record<string, string> = { '': '' }; // nothing is looked for elsewhere
  const left: [string, string][] = [['', textOf(input.bytes)]];
  for (let next = left.pop(); next; next = left.pop()) {
    const [folder, text] = next;
    for (const href of includes(text)) {
      const path = new URL(href, `http://x/${folder}`).pathname.slice(1);
      const bytes = input.resources.get(decodeURIComponent(path)) ?? input.resources.get(last(decodeURIComponent(path)));
      if (!bytes || path in texts) continue;
      texts[path] = textOf(bytes);
      left.push([path.slice(0, path.lastIndexOf('/') + 1), texts[path]]);
    }
  }
  return texts;
}

/** The glTF file that says what a document says; what it cannot say is added to `said`. Throws a LacquerError. */
export function asGltf(lacquer: Lacquer, input: Input, said: Message[]): Input {
  const scene = lacquer.scene(input.bytes, input.name, { document_texts: includedTexts(input) }, said);
  try {
    // Whoever does not know procedural textures is not on this page: the smallest images will do in their place.
    const bytes = new TextEncoder().encode(scene.toGltf({ size: 1 }, said));
    return { name: input.name.replace(/\.mtlx$/i, '.gltf'), bytes, resources: input.resources };
  } finally {
    scene.free();
  }
}

/** The document's materials for MaterialX, with the patterns of graphs that were edited. Throws a LacquerError. */
export function asDocument(lacquer: Lacquer, of: Document, said: Message[]): { name: string; bytes: Uint8Array<ArrayBuffer> } {
  const { name, bytes } = of.export();
  const options = of.nodeText ? { node_texts: { [kOwnNodes]: of.nodeText } } : undefined;
  const scene = lacquer.scene(bytes, name, options);
  const edited = new Map([...of.graphs].map(([material, text]) => [material, lacquer.graph(text, name, [], options)]));
  try {
    const text = scene.toMaterialX({ edited }, said);
    return { name: name.replace(/\.(gltf|glb)$/i, '') + '.mtlx', bytes: new TextEncoder().encode(text) as Uint8Array<ArrayBuffer> };
  } finally {
    for (const graph of edited.values()) graph.free();
    scene.free();
  }
}
