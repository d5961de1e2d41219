// forward-coat-366254765f4abdbc42c8bf7f977722c5
// Lacquer 0.2.0, template forward
//
// The material's uniform block from its parameters: an ES module. It computes in double what the library's
// pack() computes, and rounds each component to float once.

/** The shader that this belongs to. */
export const id = "forward-coat-366254765f4abdbc42c8bf7f977722c5";

/** What can be edited, with glTF's defaults, which belong to no material. */
export const defaults = Object.freeze({
    base_color_factor: Object.freeze([1, 1, 1, 1]),
    coat_factor: 0,
    coat_roughness_factor: 0,
    metallic_factor: 1,
    roughness_factor: 1,
});

/** Bytes of the block; 0 where the shader has none. */
export const blockSize = 112;

/** Where the fields of the block `Material` lie, in bytes, and how many floats each has. */
export const fields = Object.freeze({
    base_color_factor: Object.freeze({ offset: 0, components: 3 }),
    metallic_factor: Object.freeze({ offset: 12, components: 1 }),
    base_color_complement: Object.freeze({ offset: 16, components: 3 }),
    roughness_factor: Object.freeze({ offset: 28, components: 1 }),
    metal_repeated: Object.freeze({ offset: 32, components: 3 }),
    coat_factor: Object.freeze({ offset: 44, components: 1 }),
    F0: Object.freeze({ offset: 48, components: 3 }),
    coat_roughness_factor: Object.freeze({ offset: 60, components: 1 }),
    alpha2: Object.freeze({ offset: 64, components: 1 }),
    alpha2_ratio: Object.freeze({ offset: 68, components: 1 }),
    weight_times_ggx_peak: Object.freeze({ offset: 72, components: 1 }),
    lambert: Object.freeze({ offset: 76, components: 1 }),
    least_f0: Object.freeze({ offset: 80, components: 1 }),
    inverse_metallic: Object.freeze({ offset: 84, components: 1 }),
    inverse_clear: Object.freeze({ offset: 88, components: 1 }),
    dielectric_repeated: Object.freeze({ offset: 92, components: 1 }),
    white_F0: Object.freeze({ offset: 96, components: 1 }),
});

const inversesqrt = (a) => (1) / Math.sqrt(a);
const max = (a, b) => (a < b ? b : a);
// A number outside of a range counts as the nearest one in it.
const within = (x, low, high, otherwise) => (x >= low ? (x <= high ? x : high) : x < low ? low : otherwise);
// The parameters as they are packed.
const packed = (given) => ({
    base_color_factor: [within(Number(Object(given.base_color_factor)[0]), 0, 1, 1), within(Number(Object(given.base_color_factor)[1]), 0, 1, 1), within(Number(Object(given.base_color_factor)[2]), 0, 1, 1), within(Number(Object(given.base_color_factor)[3]), 0, 1, 1)],
    coat_factor: within(Number(given.coat_factor), 0, 1, 0),
    coat_roughness_factor: within(Number(given.coat_roughness_factor), 0, 1, 0),
    metallic_factor: within(Number(given.metallic_factor), 0, 1, 1),
    roughness_factor: within(Number(given.roughness_factor), 0, 1, 1),
});

/** Writes the block to the first blockSize bytes of `bytes`, which it returns. What `parameters` does not
 *  name has its default, and so has what is no number; one outside of its parameter's range is packed as
 *  the nearest in it. Throws a RangeError where there are fewer bytes. */
export function pack(parameters = {}, bytes = new Uint8Array(blockSize)) {
    if (bytes.byteLength < blockSize) throw new RangeError(`the block takes ${blockSize} bytes`);
    const p = packed({ ...defaults, ...parameters });
    const view = new DataView(bytes.buffer, bytes.byteOffset, blockSize);
    // A field is as large as a float at most; one that is no number becomes 0, and so does -0.
    const put = (at, x) => view.setFloat32(at, x === 0 ? 0 : within(x, -3.4028234663852886e+38, 3.4028234663852886e+38, 0), true);
    new Uint8Array(bytes.buffer, bytes.byteOffset, blockSize).fill(0);
    // base.alpha: glTF 2.0, Appendix B, "Microfacet Surfaces" and "Specular BRDF" (note on alpha = 0)
    const alpha = max(p.roughness_factor * p.roughness_factor, 0.001);
    // base.distribution: glTF 2.0, Appendix B, "Specular BRDF" (D)
    const alpha2 = alpha * alpha;
    const ggx_peak = alpha2 / 3.141592653589793;
    // base.visibility: glTF 2.0, Appendix B, "Specular BRDF" (V); Heitz 2014
    const alpha2_complement = max(1 - alpha2, 1e-12);
    const alpha2_ratio = alpha2 / alpha2_complement;
    const weight = 0.5 * inversesqrt(alpha2_complement);
    // base.direct: glTF 2.0, Appendix B, "Metal BRDF and Dielectric BRDF"
    const dielectric = 1 - p.metallic_factor;
    const lambert = dielectric * 0.30557749073643903;
    const least_f0 = 0.04 * dielectric;
    // base.indirect: Fdez-Aguera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting"
    const base_color_complement_x = 1 - p.base_color_factor[0];
    const base_color_complement_y = 1 - p.base_color_factor[1];
    const base_color_complement_z = 1 - p.base_color_factor[2];
    const inverse_metallic = 1 / max(p.metallic_factor, 1e-07);
    const mean_fresnel_x = 0.999999 - base_color_complement_x * 0.9523809523809523;
    const mean_fresnel_y = 0.999999 - base_color_complement_y * 0.9523809523809523;
    const mean_fresnel_z = 0.999999 - base_color_complement_z * 0.9523809523809523;
    const metal_repeated_x = mean_fresnel_x * inverse_metallic;
    const metal_repeated_y = mean_fresnel_y * inverse_metallic;
    const metal_repeated_z = mean_fresnel_z * inverse_metallic;
    const inverse_clear = 1 / max(dielectric * 0.96, 1e-07);
    const dielectric_repeated = 0.08571328571428583 * inverse_clear;
    const F0_x = p.base_color_factor[0] * p.metallic_factor + least_f0;
    const F0_y = p.base_color_factor[1] * p.metallic_factor + least_f0;
    const F0_z = p.base_color_factor[2] * p.metallic_factor + least_f0;
    const white_F0 = least_f0 + p.metallic_factor;
    put(0, p.base_color_factor[0]);
    put(4, p.base_color_factor[1]);
    put(8, p.base_color_factor[2]);
    put(12, p.metallic_factor);
    put(16, base_color_complement_x);
    put(20, base_color_complement_y);
    put(24, base_color_complement_z);
    put(28, p.roughness_factor);
    put(32, metal_repeated_x);
    put(36, metal_repeated_y);
    put(40, metal_repeated_z);
    put(44, p.coat_factor);
    put(48, F0_x);
    put(52, F0_y);
    put(56, F0_z);
    put(60, p.coat_roughness_factor);
    put(64, alpha2);
    put(68, alpha2_ratio);
    put(72, weight * ggx_peak);
    put(76, lambert);
    put(80, least_f0);
    put(84, inverse_metallic);
    put(88, inverse_clear);
    put(92, dielectric_repeated);
    put(96, white_F0);
    return bytes;
}

/** The names of the parameters that are packed otherwise than they are given, for they are outside of
 *  their ranges or no numbers. */
export function outside(parameters = {}) {
    const given = { ...defaults, ...parameters };
    const p = packed(given);
    return Object.keys(p).filter((name) => Array.isArray(p[name])
        ? p[name].some((x, i) => x !== Object(given[name])[i])
        : Number(p[name]) !== Number(given[name]));
}

/** The blocks that the shader reads, by their names in GLSL. `set` and `binding` are Vulkan's and WebGPU's,
 *  `flat` where there are no sets. */
export const blocks = Object.freeze([
    Object.freeze({ name: "Frame", set: 0, binding: 0, flat: 0, size: 96 }),
    Object.freeze({ name: "Lights", set: 0, binding: 1, flat: 1, size: 1024 }),
    Object.freeze({ name: "Object", set: 2, binding: 0, flat: 3, size: 128 }),
    Object.freeze({ name: "Material", set: 1, binding: 0, flat: 2, size: 112 }),
]);

/** `srgb`: to be given an sRGB format. `environment`: the frame's, not the material's. */
export const textures = Object.freeze([
    Object.freeze({ name: "environment_specular", type: "samplerCube", set: 0, binding: 2, flat: 0, srgb: false, environment: true }),
    Object.freeze({ name: "environment_irradiance", type: "samplerCube", set: 0, binding: 3, flat: 1, srgb: false, environment: true }),
    Object.freeze({ name: "environment_dfg", type: "sampler2D", set: 0, binding: 4, flat: 2, srgb: false, environment: true }),
    Object.freeze({ name: "coat_texture", type: "sampler2D", set: 1, binding: 1, flat: 3, srgb: false, environment: false }),
]);
