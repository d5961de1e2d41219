// From the edited document to what the viewport draws and the panels show.
import { load, type Graph, type GraphJson, type Lacquer, type Message, type Options, type Shader } from '../src/index';
import type { Document } from './document';
import { fromBase64 } from '../src/gltf';
import type { Look, Slot } from './viewport';

/** The compiler that the page has in it, unpacked. */
export async function compiler(packed: string): Promise<Lacquer> {
  const stream = new Blob([fromBase64(packed).slice()]).stream().pipeThrough(new DecompressionStream('gzip'));
  return load(await new Response(stream).arrayBuffer());
}

export function graphOf(lacquer: Lacquer, of: Document, options: Options, messages: Message[]): Graph {
  const text = of.graphs.get(of.material);
  if (text !== undefined) {
    const graph = lacquer.graph(text, 'graph.json', messages, options.node_texts && { node_texts: options.node_texts });
    for (const { name, pointer } of graph.parameters()) {
      const value = pointer ? of.get(pointer) : undefined;
      if (typeof value === 'number' || Array.isArray(value)) graph.setParameter(name, value, messages);
    }
    for (const { name, pointer, texture } of graph.textures()) {
      const index = pointer ? of.get(`${pointer}/index`) : undefined;
      if (typeof index !== 'number' || index === texture) continue;
      const { [name]: as } = graph.toJson().textures;
      graph.edit({ do: 'set_texture', texture: name, as: { ...as, texture: index } }, messages);
    }
    return graph;
  }
  const scene = lacquer.scene(of.slim(), of.file.name, options, messages);
  try {
    return scene.graph(of.material, options, of.uses[of.material], messages);
  } finally {
    scene.free();
  }
}

/** Calls with the graph and the shader of a target, which are freed. */
export function withShader<T>(
  lacquer: Lacquer,
  of: Document,
  options: Options,
  messages: Message[],
  use: (shader: Shader, graph: Graph) => T,
): T {
  const graph = graphOf(lacquer, of, options, messages);
  try {
    const shader = graph.generate(options, messages);
    try {
      return use(shader, graph);
    } finally {
      shader.free();
    }
  } finally {
    graph.free();
  }
}

/** A procedural texture's image is looked up as its node says, which the graph has. */
function slotOf({ texture, srgb, file, wrap, filter }: GraphJson['textures'][string]): Slot {
  const slot: Slot = { texture: texture ?? -1, srgb };
  if (file || texture === undefined || (wrap === undefined && filter === undefined)) return slot;
  const kWraps = { repeat: 10497, clamp: 33071, mirror: 33648 };
  const [s, t] = Array.isArray(wrap) ? wrap : [wrap ?? 'repeat', wrap ?? 'repeat'];
  return { ...slot, sampler: { wrapS: kWraps[s], wrapT: kWraps[t], magFilter: filter === 'nearest' ? 9728 : 9729 } };
}

/** As the manifest has it. */
function passOf(shader: Shader, alphaMode: unknown): Look['pass'] {
  if (shader.interface.textures.some(({ name }) => name === 'scene_behind')) return 'looks_through';
  return alphaMode === 'BLEND' ? 'blended' : alphaMode === 'MASK' ? 'masked' : 'opaque';
}

export function lookOf(of: Document, shader: Shader, graph: GraphJson): Look {
  const material = of.json.materials[of.material] ?? {};
  return {
    id: shader.id,
    block: shader.pack(),
    slots: new Map(Object.entries(graph.textures ?? {}).map(([slot, of]) => [slot, slotOf(of)])),
    doubleSided: material.doubleSided === true,
    blended: material.alphaMode === 'BLEND',
    pass: passOf(shader, material.alphaMode),
  };
}
