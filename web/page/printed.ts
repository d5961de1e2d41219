// The current material's shader as `lacquer gen` writes it, and what an application needs beside it.
import { LacquerError, type Options } from '../src/index';
import { hexOf } from './code';
import { withShader } from './compile';
import { byId } from './dom';
import type { Generated } from './generated';
import type { Page } from './main';

/** Without MSL: SPIRV-Cross, which makes it, is not in the page. */
const kTargets = ['essl', 'wgsl', 'glsl', 'glsl-gl', 'hlsl', 'spirv', 'cpp', 'js'];
export const kOffered = [...kTargets, 'msl'];

export type Stage = 'vertex' | 'fragment';
export interface Described {
  id: string;
  interface: object;
  graph: string;
  block: Uint8Array<ArrayBuffer>;
}

export class Printed {
  constructor(private readonly page: Page, private readonly generated: Generated) {}

  options(target: string): Options {
    return { ...this.generated.options(this.page.options()), targets: [target] };
  }
  /** The text of a target and a stage; of MSL how the program makes it. */
  text(target: string, stage: Stage): string {
    const { lacquer, document: of } = this.page;
    if (target === 'msl') {
      const name = of!.names[of!.material];
      const words = ['lacquer', 'gen', of!.file.name, ...(name ? ['--material', name] : []), '--target', 'msl', '-o', 'shaders', ...this.generated.flags(this.page.options())];
      return `The program makes MSL of the SPIR-V; this page cannot:\n\n${words.map(quoted).join(' ')}`;
    }
    return withShader(lacquer, of!, this.options(target), [], (shader) =>
      target === 'spirv' ? hexOf(shader.spirv(stage)) : shader.text(target, stage),
    );
  }

  /** The file that `lacquer gen` writes of it; null, and a message, where the material has an error. */
  bytes(target: string, stage: Stage): Uint8Array<ArrayBuffer> | null {
    const { page } = this;
    return this.orSaid(() => withShader(page.lacquer, page.document!, this.options(target), [], (shader) =>
      target === 'spirv' ? new Uint8Array(shader.spirv(stage).slice().buffer) : new TextEncoder().encode(shader.text(target, stage)),
    ));
  }

  /** The manifest's entry, the graph, the bytes of the material's block. */
  described(target: string): Described {
    const { page } = this;
    return withShader(page.lacquer, page.document!, this.options(target), [], (shader, graph) => ({
      id: shader.id,
      interface: shader.interface,
      graph: graph.toText(),
      block: new Uint8Array(shader.packGraph(graph)),
    }));
  }
  /** The same for the chosen target; null, and a message, where the material has an error. */
  describedOrSaid(): Described | null {
    return this.orSaid(() => this.described(byId<HTMLSelectElement>('target').value));
  }
  private orSaid<T>(make: () => T): T | null {
    try {
      return make();
    } catch (error) {
      this.page.fail(error);
      return null;
    }
  }

  /** Bytes of the picture's fragment stage, target by target. */
  sizes(): string {
    const { page } = this;
    try {
      return withShader(page.lacquer, page.document!, { ...page.options(), targets: kTargets }, [], (shader) => {
        const sizeOf = (target: string) => (target === 'spirv' ? 4 * shader.spirv('fragment').length : shader.text(target, 'fragment').length);
        return kTargets.map((target) => `${target} ${sizeOf(target)}`).join(', ');
      });
    } catch (error) {
      if (!(error instanceof LacquerError)) throw error;
      return '';
    }
  }
}

/** A word of a command as a shell takes it. */
const quoted = (word: string) => (/^[\w.,:=/-]+$/.test(word) ? word : `'${word.replace(/'/g, "'\\''")}'`);
