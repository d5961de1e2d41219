// Which of the file's nodes are seen (KHR_node_visibility): one is where it says so, and all above it.
import { hides, type Drawable } from '../src/gltf';
import { item, once } from '../src/json';

export class Visibility {
  private readonly hidden = new Set<number>();
  private readonly drawables = new Map<number, Drawable[]>();

  /** `order` has each node behind its parent. */
  constructor(private readonly nodes: any[], private readonly order: number[], private readonly parentOf: (node: number) => number, drawables: Drawable[]) {
    for (const drawable of drawables) if (drawable.node !== undefined) once(this.drawables, drawable.node, () => []).push(drawable);
    this.set(new Map());
  }

  /** What a clip says of nodes; the others are as the file has them. */
  set(said: ReadonlyMap<number, boolean>): void {
    this.hidden.clear();
    for (const index of this.order) {
      if (!(said.get(index) ?? !hides(item(this.nodes, index))) || this.hidden.has(this.parentOf(index))) this.hidden.add(index);
    }
    for (const [node, all] of this.drawables) for (const drawable of all) drawable.hidden = this.hidden.has(node);
  }
  hides(node: number): boolean {
    return this.hidden.has(node);
  }
}
