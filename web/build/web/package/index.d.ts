import { Instance, type Source } from './module.js';
import { type Attribute, type Evaluation, type GraphJson, type GraphSource, type Interface, type Message, type Options, type Parameter, type Point, type Stage, type Target } from './types.js';
export * from './types.js';
export type { Source };
/** What a material that no primitive uses is read with. */
export declare const kUnusedAttributes: Attribute[];
/** An object of the module. */
declare abstract class Handle {
    protected readonly it: Instance;
    private readonly release;
    /** Gives its memory back. It is empty from then on. */
    free(): void;
}
/** The code of a graph. */
export declare class Shader extends Handle {
    /** Equal for equal code and different for different code: "forward-coat-1f0a9b1c2d3e4f50". */
    get id(): string;
    get hasVertexStage(): boolean;
    /** Empty for a target that was not asked for or that has no text. */
    text(target: Target, stage: Stage): string;
    /** Empty when "spirv" was not asked for. */
    spirv(stage: Stage): Uint32Array;
    /** Its entry in manifest.json: blocks with their fields, textures, inputs. */
    get interface(): Interface;
    /** Bytes of the material's uniform block; 0 when there is none. */
    get uniformSize(): number;
    /** The preshader: the bytes of the material's uniform block. Parameters that are not given have today's value; names
     * that this shader has no parameter of are passed over. */
    pack(values?: Record<string, number | number[]>, messages?: Message[]): Uint8Array;
}
/** A node graph: one term of the specification is one node. An edit that fails throws, and leaves the graph as it was. */
export declare class Graph extends Handle {
    toJson(): GraphJson;
    /** The JSON form as the program writes it. */
    toText(): string;
    toDot(): string;
    parameters(): Parameter[];
    addNode(id: string, type: string, messages?: Message[]): void;
    removeNode(id: string, messages?: Message[]): void;
    connect(node: string, input: string, source: GraphSource, messages?: Message[]): void;
    setOutput(port: string, source: GraphSource, messages?: Message[]): void;
    setParameter(name: string, value: number | number[], messages?: Message[]): void;
    setRange(parameter: string, low: number, high: number, orZero?: boolean, messages?: Message[]): void;
    /** What is wrong with it and worth knowing; it may change the order of the nodes. */
    check(options?: Options): Message[];
    generate(options?: Options, messages?: Message[]): Shader;
    /** The values of the code with their rates, after the pass of that name; after the last without one. */
    dump(pass?: string, options?: Options, messages?: Message[]): string;
    private edit;
}
/** The materials of a glTF file. */
export declare class Scene extends Handle {
    get materialCount(): number;
    materialName(material: number): string;
    /** Of the primitives that use a material, each kind once. */
    uses(material: number): Attribute[][];
    /** On primitives with these attributes; those of its first use where none are named. */
    graph(material: number, options?: Options, attributes?: Attribute[], messages?: Message[]): Graph;
    /** Linear colours at points, as `lacquer eval`. */
    evaluate(material: number, points: Point[] | {
        points: Point[];
        uniforms?: Record<string, number | number[]>;
    }, options?: Options & {
        engine?: 'double' | 'float';
    }, messages?: Message[]): Evaluation;
    /** A lit ball of that many pixels on a side, from 16 to 2048: RGBA, for an ImageData. */
    preview(material: number, pixels: number, options?: Options, messages?: Message[]): Uint8ClampedArray;
}
/** The library. */
export declare class Lacquer {
    private readonly it;
    /** "0.2.0" */
    get version(): string;
    /** Bytes of memory that the module has. */
    get memory(): number;
    /** Reads .gltf or .glb; `name` stands for the file in messages. Images that are not in it are absent. */
    scene(bytes: Uint8Array | string, name: string, options?: Options, messages?: Message[]): Scene;
    /** Reads the JSON form of a graph. */
    graph(json: GraphJson | string, name?: string, messages?: Message[]): Graph;
    /** Nodes, templates, profiles, extensions and their properties, as `lacquer nodes --json`. */
    nodes(options?: Options): any;
    /** The table behind environment_dfg: `size` rows of `size` pairs. */
    environmentDfg(size: number): Float32Array;
    /** The table behind environment_sheen. */
    environmentSheen(size: number): Float32Array;
    private table;
}
/** Makes the library; without a source from lacquer.wasm beside this file. */
export declare function load(source?: Source): Promise<Lacquer>;
