// forward-coat-366254765f4abdbc42c8bf7f977722c5
// Lacquer 0.2.0, template forward
//
// The types of the module beside this file.

export declare const id: "forward-coat-366254765f4abdbc42c8bf7f977722c5";

/** What can be edited. */
export interface Parameters {
    base_color_factor: readonly [number, number, number, number] | Float32Array | Float64Array;
    coat_factor: number;
    coat_roughness_factor: number;
    metallic_factor: number;
    roughness_factor: number;
}

/** glTF's defaults, which belong to no material. */
export declare const defaults: Readonly<Parameters>;

/** Bytes of the block; 0 where the shader has none. */
export declare const blockSize: 112;

/** Where the block's fields lie, in bytes, and how many floats each has. */
export interface Field { readonly offset: number; readonly components: number; }
export declare const fields: {
    readonly base_color_factor: Field;
    readonly metallic_factor: Field;
    readonly base_color_complement: Field;
    readonly roughness_factor: Field;
    readonly metal_repeated: Field;
    readonly coat_factor: Field;
    readonly F0: Field;
    readonly coat_roughness_factor: Field;
    readonly alpha2: Field;
    readonly alpha2_ratio: Field;
    readonly weight_times_ggx_peak: Field;
    readonly lambert: Field;
    readonly least_f0: Field;
    readonly inverse_metallic: Field;
    readonly inverse_clear: Field;
    readonly dielectric_repeated: Field;
    readonly white_F0: Field;
};

/** Writes the block to the first blockSize bytes of `bytes`, which it returns. What `parameters` does not
 *  name has its default, and so has what is no number; one outside of its parameter's range is packed as
 *  the nearest in it. Throws a RangeError where there are fewer bytes. */
export declare function pack<T extends ArrayBufferView = Uint8Array>(parameters?: Partial<Parameters>, bytes?: T): T;

/** The names of the parameters that are packed otherwise than they are given, for they are outside of
 *  their ranges or no numbers. */
export declare function outside(parameters?: Partial<Parameters>): (keyof Parameters)[];

/** Where something is bound: `set` and `binding` for Vulkan and WebGPU, `flat` where there are no sets. */
export interface Binding { readonly set: number; readonly binding: number; readonly flat: number; }
export interface Block extends Binding { readonly name: string; readonly size: number; }
export declare const blocks: readonly Block[];
/** `srgb`: to be given an sRGB format. `environment`: the frame's, not the material's. */
export interface Texture extends Binding {
    readonly name: string;
    readonly type: string;
    readonly srgb: boolean;
    readonly environment: boolean;
}
export declare const textures: readonly Texture[];
