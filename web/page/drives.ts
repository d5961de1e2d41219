// Numbers of materials that a clip moves (KHR_animation_pointer): fields of the blocks that their shaders have already.
import { LacquerError, type Graph, type Shader } from '../src/index';
import { valueAt, type Clip } from './clips';
import { graphOf } from './compile';
import type { Page } from './main';
import type { Look } from './viewport';

/** A material that is moved: its shader and its graph, as long as it has this look. */
interface Drive {
  look: Look;
  /** The block without the clip. */
  rest: Uint8Array;
  graph: Graph;
  shader: Shader;
  /** Of its parameters, by their pointers; the numbers that each has. */
  names: Map<string, { name: string; size: number }[]>;
}

export class Drives {
  /** By materials. */
  private readonly made = new Map<number, Drive | null>();
  /** The looks for which there is nothing to move. */
  private readonly idle = new WeakSet<Look>();

  constructor(private readonly page: Page) {}

  /** Takes the materials to a moment of a clip; those that it does not move have their own numbers. */
  set(clip: Clip | null, seconds: number): void {
    const moved = new Set(clip?.materials.map(({ material }) => material));
    for (const material of this.made.keys()) if (!moved.has(material)) this.drop(material);
    for (const material of moved) {
      const drive = this.driveOf(material);
      if (!drive) continue;
      const { graph, shader, names, look } = drive;
      for (const channel of clip!.materials) {
        if (channel.material !== material) continue;
        const value = valueAt(channel, seconds, false);
        for (const { name, size } of names.get(channel.pointer) ?? []) if (value.length === size) this.put(graph, name, value);
      }
      look.block.set(shader.packGraph(graph));
      look.version = (look.version ?? 0) + 1;
    }
  }
  private put(graph: Graph, name: string, value: number[]): void {
    try {
      graph.setParameter(name, value);
    } catch (error) {
      if (!(error instanceof LacquerError)) throw error; // a number that the parameter does not take: it stays
    }
  }
  /** Gives a look its own numbers back. */
  private drop(material: number): void {
    const drive = this.made.get(material);
    this.made.delete(material);
    if (!drive) return;
    drive.look.block.set(drive.rest);
    drive.look.version = (drive.look.version ?? 0) + 1;
    drive.shader.free();
    drive.graph.free();
  }

  /** An edit gives a material another look: then all is made anew. */
  private driveOf(material: number): Drive | null {
    const look = this.page.viewport.looks.get(material);
    const known = this.made.get(material);
    if (known && known.look === look) return known;
    this.drop(material);
    if (!look || this.idle.has(look)) return null;
    const made = this.make(material, look);
    if (made) this.made.set(material, made);
    else this.idle.add(look);
    return made;
  }
  private make(material: number, look: Look): Drive | null {
    const of = this.page.document!;
    const options = this.page.options();
    const chosen = of.material;
    of.material = material;
    let graph: Graph | null = null;
    try {
      graph = graphOf(this.page.lacquer, of, options, []);
      const shader = graph.generate(options);
      const names: Drive['names'] = new Map();
      for (const { name, pointer, value } of graph.parameters()) {
        if (pointer) names.set(pointer, [...(names.get(pointer) ?? []), { name, size: [value].flat().length }]);
      }
      if (shader.id === look.id) return { look, rest: look.block.slice(), graph, shader, names };
      shader.free();
    } catch (error) {
      if (!(error instanceof LacquerError)) throw error; // the page has said it when it made the look
    } finally {
      of.material = chosen;
    }
    graph?.free();
    return null;
  }
}
