// The WebAssembly module: what it imports, and texts and numbers on their way in and out of its memory. Its exports are
// the functions of lacquer_c.h.

/** What the module can be made from: its bytes, compiled or not, or where they are. */
export type Source = BufferSource | WebAssembly.Module | Response | URL | string;

type Call = (...args: number[]) => number;

/** Thrown out of the module when it ends itself, which it should not. */
class Ended extends Error {}

const kNoSystem = 52; // ENOSYS of WASI: this system has no files, no environment, no processes

/** What the module imports. It has no system to call: files do not exist, and there is no environment. */
function importsOf(module: WebAssembly.Module, memory: () => WebAssembly.Memory): WebAssembly.Imports {
  const view = () => new DataView(memory().buffer);
  const random = (at: number, size: number) => {
    crypto.getRandomValues(new Uint8Array(memory().buffer, at, size));
    return 0;
  };
  const known: Record<string, (...args: any[]) => unknown> = {
    environ_sizes_get: (count: number, size: number) => {
      view().setUint32(count, 0, true);
      view().setUint32(size, 0, true);
      return 0;
    },
    environ_get: () => 0,
    clock_time_get: (_clock: number, _precision: bigint, at: number) => {
      view().setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
    random_get: random,
    getentropy: random,
    proc_exit: (status: number) => {
      throw new Ended(`the module ended with the status ${status}`);
    },
    abort: () => {
      throw new Ended('the module was aborted');
    },
    emscripten_notify_memory_growth: () => undefined,
  };
  const imports: WebAssembly.Imports = {};
  for (const { module: space, name, kind } of WebAssembly.Module.imports(module)) {
    if (kind !== 'function') throw new Error(`the module imports ${space}.${name}, which is no function`);
    const absent = name.startsWith('__syscall') ? () => -kNoSystem : () => kNoSystem;
    (imports[space] ??= {})[name] = known[name] ?? absent;
  }
  return imports;
}

/** Whatever it is made from. */
export async function compile(source: Source): Promise<WebAssembly.Module> {
  if (source instanceof WebAssembly.Module) return source;
  if (typeof source === 'string' || source instanceof URL) {
    const url = new URL(source, import.meta.url);
    if (url.protocol === 'file:' && typeof process !== 'undefined') {
      const files = 'node:fs/promises'; // a name that bundlers do not look for
      const { readFile } = await import(/* @vite-ignore */ files);
      return WebAssembly.compile(await readFile(url));
    }
    return compile(await fetch(url));
  }
  if (typeof Response !== 'undefined' && source instanceof Response) {
    if (!source.ok) throw new Error(`${source.url}: ${source.status} ${source.statusText}`);
    return WebAssembly.compile(await source.arrayBuffer());
  }
  return WebAssembly.compile(source as BufferSource);
}

/** A module from beside a script, or from a copy of it that is a script. */
export async function own(place: () => URL, copy: () => Promise<{ default: string }>): Promise<WebAssembly.Module> {
  try {
    return await compile(place());
  } catch {
    const { default: packed } = await copy();
    const bytes = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
    return compile(new Response(stream));
  }
}

/** The exports; a call of what is none of them comes to `absent`. */
function calls(exports: WebAssembly.Exports, absent?: (call: string) => never): Record<string, Call> {
  const all: object = absent ? new Proxy({}, { get: (_all, name) => () => absent(String(name)) }) : {};
  return Object.assign(Object.create(all), exports);
}

const encoder = new TextEncoder();
const decoder = new TextDecoder();

/** An instance with its memory. Addresses are numbers; 0 is none. */
export class Instance {
  readonly call: Record<string, Call>;
  private readonly memory: WebAssembly.Memory;

  private constructor(exports: WebAssembly.Exports, absent?: (call: string) => never) {
    this.call = calls(exports, absent);
    this.memory = exports.memory as WebAssembly.Memory;
  }

  /** `absent` is told what is called that the module has not. */
  static async make(source: Source, absent?: (call: string) => never): Promise<Instance> {
    const module = await compile(source);
    let memory: WebAssembly.Memory | undefined;
    const instance = await WebAssembly.instantiate(module, importsOf(module, () => memory!));
    memory = instance.exports.memory as WebAssembly.Memory;
    (instance.exports._initialize as () => void)();
    return new Instance(instance.exports, absent);
  }

  /** Bytes that the module may keep or write to; `use` is given their address, which holds as long as it runs. */
  withBytes<T>(bytes: Uint8Array | number, use: (at: number, size: number) => T): T {
    const size = typeof bytes === 'number' ? bytes : bytes.length;
    const at = this.call.malloc(size + 1);
    if (at === 0) throw new Error('there is not enough memory');
    try {
      const room = new Uint8Array(this.memory.buffer, at, size + 1);
      if (typeof bytes !== 'number') room.set(bytes);
      room[size] = 0;
      return use(at, size);
    } finally {
      this.call.free(at);
    }
  }

  /** A text of UTF-8, ended by a NUL. A name that holds one would end there: a TypeError. */
  withText<T>(text: string, use: (at: number, size: number) => T): T {
    return this.withTexts([text], ([at], size) => use(at, size - 1));
  }

  /** The addresses of all of them, in one block of `size` bytes. */
  withTexts<T>(texts: string[], use: (at: number[], size: number) => T): T {
    const nul = texts.find((text) => text.includes('\0'));
    if (nul !== undefined) throw new TypeError(`a NUL stands in ${JSON.stringify(nul)}`);
    const starts: number[] = [];
    let size = 0;
    const parts = texts.map((text) => {
      const part = encoder.encode(text);
      starts.push(size);
      size += part.length + 1;
      return part;
    });
    return this.withBytes(size, (at) => {
      const room = this.bytes(at, size).fill(0);
      parts.forEach((part, i) => room.set(part, starts[i]));
      return use(starts.map((start) => at + start), size);
    });
  }

  bytes(at: number, size: number): Uint8Array {
    return new Uint8Array(this.memory.buffer, at, size);
  }
  word(at: number): number {
    return new DataView(this.memory.buffer).getUint32(at, true);
  }
  text(at: number, size: number): string {
    return decoder.decode(this.bytes(at, size));
  }

  /** A text that a call gives with its size behind it. */
  sized(call: string, ...args: number[]): string {
    return this.withBytes(4, (size) => {
      const at = this.call[call](...args, size);
      return this.text(at, this.word(size));
    });
  }

  /** The text of a handle, which is freed. */
  taken(handle: number): string {
    if (handle === 0) return '';
    const text = this.text(this.call.lacquer_text_data(handle), this.call.lacquer_text_size(handle));
    this.call.lacquer_text_free(handle);
    return text;
  }
}
