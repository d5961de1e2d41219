// Lacquer in JavaScript, all of it.
import { Lacquer } from './library.js';
import { Instance, own, type Source } from './module.js';

export * from './library.js';
export type { Source };

/** Makes the library; without a source from lacquer.wasm beside this file. Where a server or a bundler does not give that
 * file away, from a copy of it that is a script. */
export async function load(source?: Source): Promise<Lacquer> {
  const place = () => new URL('./lacquer.wasm', import.meta.url);
  return new Lacquer(await Instance.make(source ?? (await own(place, () => import('./packed.js')))));
}
