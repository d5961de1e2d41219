// Drafts: the edited file as it would be exported, in the browser's own storage, until it is exported or given up.
import type { Input } from './document';

export interface Draft extends Omit<Input, 'resources'> {
  /** Of the page's visit that made it. */
  id: string;
  resources: [string, Uint8Array][];
  /** Milliseconds since 1970. */
  time: number;
  material: number;
  /** As Cameras has it; drafts of earlier pages have none. */
  camera?: string;
}

/** Larger files are not kept: a message says so. */
export const kMostBytes = 64 * 1024 * 1024;
/** Of one page; older ones give way. */
const kMostDrafts = 5;
const kStore = 'drafts';

const answer = <T>(request: IDBRequest<T>): Promise<T> => new Promise((done, fail) => {
  request.onsuccess = () => done(request.result);
  request.onerror = () => fail(request.error ?? new Error('the storage fails'));
});

export class Drafts {
  /** Of this visit: it overwrites none of another's. */
  readonly id = `${location.pathname} ${performance.timeOrigin}`;
  private constructor(private readonly base: IDBDatabase) {}

  /** null where the browser keeps nothing, as in some private windows. */
  static async open(): Promise<Drafts | null> {
    try {
      const request = indexedDB.open('lacquer', 1);
      request.onupgradeneeded = () => request.result.createObjectStore(kStore, { keyPath: 'id' });
      return new Drafts(await answer(request));
    } catch {
      return null;
    }
  }
  private store(mode: IDBTransactionMode): IDBObjectStore {
    return this.base.transaction(kStore, mode).objectStore(kStore);
  }

  async keep(draft: Omit<Draft, 'id'>): Promise<void> {
    await answer(this.store('readwrite').put({ ...draft, id: this.id }));
  }
  async remove(id = this.id): Promise<void> {
    await answer(this.store('readwrite').delete(id));
  }
  /** Of this page from other visits, the latest first. */
  async others(): Promise<Draft[]> {
    const all: Draft[] = await answer(this.store('readonly').getAll());
    const mine = all.filter(({ id }) => id.startsWith(`${location.pathname} `) && id !== this.id).sort((a, b) => b.time - a.time);
    for (const { id } of mine.slice(kMostDrafts)) await this.remove(id);
    return mine.slice(0, kMostDrafts);
  }
}
