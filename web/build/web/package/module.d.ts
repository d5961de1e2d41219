/** What the module can be made from: its bytes, compiled or not, or where they are. */
export type Source = BufferSource | WebAssembly.Module | Response | URL | string;
type Call = (...args: number[]) => number;
/** An instance with its memory. Addresses are numbers; 0 is none. */
export declare class Instance {
    readonly call: Record<string, Call>;
    private readonly memory;
    private constructor();
    static make(source: Source): Promise<Instance>;
    /** Bytes that the module may keep or write to; `use` is given their address, which holds as long as it runs. */
    withBytes<T>(bytes: Uint8Array | number, use: (at: number, size: number) => T): T;
    /** A text of UTF-8, ended by a NUL. */
    withText<T>(text: string, use: (at: number, size: number) => T): T;
    /** The addresses of all of them. */
    withTexts<T>(texts: string[], use: (at: number[]) => T, done?: number[]): T;
    bytes(at: number, size: number): Uint8Array;
    word(at: number): number;
    text(at: number, size: number): string;
    /** A text that a call gives with its size behind it. */
    sized(call: string, ...args: number[]): string;
    /** The text of a handle, which is freed. */
    taken(handle: number): string;
}
export {};
