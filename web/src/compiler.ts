// The compiler alone, from a module that is a third smaller: glTF files and graphs to shaders, what they are made of, and packed
// numbers.
import { Lacquer, LacquerError } from './library.js';
import { Instance, own, type Source } from './module.js';

export * from './library.js';
export type { Source };

/** What lacquer-compiler.wasm has not. */
function beyond(call: string): never {
  const message = `the compiler's module has no ${call.replace(/^lacquer_/, '')}()`;
  const instead = call === 'lacquer_graph_edit' ? '; numbers are set by setParameter() and setRange()' : '';
  const help = `\`load()\` of the package's main entry, lacquer.wasm, has it${instead}`;
  const text = `error: ${message} [not-in-compiler]\n  help: ${help}`;
  throw new LacquerError([{ level: 'error', code: 'not-in-compiler', file: '', pointer: '', line: 0, column: 0, message, help, text }]);
}

/** As the main entry's, from lacquer-compiler.wasm. What that has not throws a LacquerError with the code "not-in-compiler" (docs/web.md). */
export async function load(source?: Source): Promise<Lacquer> {
  const place = () => new URL('./lacquer-compiler.wasm', import.meta.url);
  return new Lacquer(await Instance.make(source ?? (await own(place, () => import('./packed-compiler.js'))), beyond));
}
