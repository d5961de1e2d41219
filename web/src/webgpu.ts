/** What stands between the contract and WebGPU: the objects that a device's functions are given. It calls none of them, and
 * is what lacquer/vulkan.h is for Vulkan. docs/bindings.md says what the numbers mean. */
import type { ContractMaterial, ContractPrimitive, ContractTexture, Interface, Pass, Use } from './types.js';

// ---- vertex input

/** How a vertex buffer holds an attribute. */
export interface VertexStream {
  format: GPUVertexFormat;
  /** Bytes from one to the next, a multiple of four; 0 for one that all have. */
  arrayStride: number;
  /** What undoes a normalized format that stands for another: Skin.joint_scale and Quantization's fields. */
  scale: number;
}

const kIntegers: Record<string, { bytes: number; scale: number; format: string }> = {
  BYTE: { bytes: 1, scale: 127, format: 'snorm8' },
  UNSIGNED_BYTE: { bytes: 1, scale: 255, format: 'unorm8' },
  SHORT: { bytes: 2, scale: 32767, format: 'snorm16' },
  UNSIGNED_SHORT: { bytes: 2, scale: 65535, format: 'unorm16' },
};

/** The format for what an accessor stores; undefined where none makes floats of it: convert it. Integers that stand for
 * themselves come normalized, with the scale that undoes it. Three components of less than 32 bits are read as four, of which
 * the last is glTF's padding; the buffer needs that many bytes behind its last vertex. */
export function vertexStream(
  semantic: string,
  stored: { type?: string; component_type?: string; normalized?: boolean },
): VertexStream | undefined {
  const components = stored.type === 'SCALAR' ? 1 : Number(/^VEC([234])$/.exec(stored.type ?? '')?.[1] ?? 0);
  if (components === 0) return undefined;
  if (stored.component_type === 'FLOAT') {
    const format = (components === 1 ? 'float32' : `float32x${components}`) as GPUVertexFormat;
    return { format, arrayStride: 4 * components, scale: 1 };
  }
  const integer = kIntegers[stored.component_type ?? ''];
  // The padding would be the alpha that a colour of three components has not. Of one component there are no such formats.
  if (!integer || components === 1 || (components === 3 && semantic.startsWith('COLOR_'))) return undefined;
  return {
    format: `${integer.format}x${components === 3 ? 4 : components}` as GPUVertexFormat,
    arrayStride: Math.ceil((integer.bytes * components) / 4) * 4,
    scale: stored.normalized ? 1 : integer.scale,
  };
}

/** Once for each instance, not for each vertex. */
export const isOfInstance = (attribute: string): boolean => ['TRANSLATION', 'ROTATION', 'SCALE', 'DRAW'].includes(attribute);

/** What an attribute that a primitive has not is for all of its vertices. */
export function standIn(attribute: string): [number, number, number, number] {
  if (attribute === 'ROTATION') return [0, 0, 0, 1];
  if (attribute === 'SCALE' || attribute.startsWith('COLOR_')) return [1, 1, 1, 1];
  if (attribute === 'NORMAL') return [0, 0, 1, 0];
  return attribute === 'TANGENT' ? [1, 0, 0, 1] : [0, 0, 0, 0];
}

/** The `buffers` of a pipeline's vertex stage: a buffer for each of the shader's inputs, in their order. An attribute that the
 * primitive has not is one standIn() for all. `streams` may say how those are held that were converted, and instances. */
export function vertexBuffers(
  shader: Interface,
  primitive: ContractPrimitive,
  streams: Record<string, VertexStream> = {},
): GPUVertexBufferLayout[] {
  return (shader.inputs ?? []).map(({ name, location }) => {
    const stored = primitive.attributes[name];
    // The instance's numbers in the lists of objects and of materials (binding: 'bindless').
    const numbers = name === 'DRAW' ? { format: 'sint32x2', arrayStride: 8 } : undefined;
    const from = streams[name] ?? numbers ?? (stored && vertexStream(name, stored)) ?? { format: 'float32x4', arrayStride: 0 };
    return {
      arrayStride: from.arrayStride,
      stepMode: isOfInstance(name) && from.arrayStride > 0 ? 'instance' : 'vertex',
      attributes: [{ shaderLocation: location, offset: 0, format: from.format as GPUVertexFormat }],
    };
  });
}

// ---- numbers

/** A use's numbers as the `constants` of both stages (parameters: 'spec'); empty for a shader without. */
export function constants(shader: Interface, use: Use): Record<string, number> {
  const all = (shader.spec_constants ?? []) as { id: number; name: string; component: number; default: number | boolean }[];
  return Object.fromEntries(all.map(({ id, name, component, default: neutral }) => {
    const value = [use.parameters[name]?.value ?? []].flat()[component];
    return [String(id), Number(value ?? neutral)];
  }));
}

/** A light of KHR_lights_punctual, in world space. */
export interface PunctualLight {
  type: 'directional' | 'point' | 'spot';
  position?: [number, number, number];
  /** Unit: where the light goes. */
  direction?: [number, number, number];
  color?: [number, number, number];
  /** Lux of a directional light, else candela. */
  intensity?: number;
  /** Metres; 0 for none. */
  range?: number;
  innerConeAngle?: number;
  outerConeAngle?: number;
}

/** A light of EXT_lights_area, in world space: of the template forward_area. */
export interface AreaLight {
  type: 'rect' | 'disk';
  position?: [number, number, number];
  /** Unit: its node's x and y axes. It shines to the node's -z. */
  right?: [number, number, number];
  up?: [number, number, number];
  color?: [number, number, number];
  /** Nits. */
  intensity?: number;
  /** Metres: a rectangle's height, a disc's diameter. */
  size?: number;
  /** Of a rectangle: width over height. */
  aspect?: number;
}

/** As the kinds rect and disk of templates/forward_area.node say. */
function areaValues(light: AreaLight): Record<string, number | number[]> {
  const { type, position = [0, 0, 0], right = [1, 0, 0], up = [0, 1, 0], color = [1, 1, 1] } = light;
  const { intensity = 1, size = 1, aspect = 1 } = light;
  const [x, y, z] = [0, 1, 2].map((i) => right[(i + 2) % 3] * up[(i + 1) % 3] - right[(i + 1) % 3] * up[(i + 2) % 3]);
  return {
    position,
    positional: 1,
    radiance: [0, 0, 0],
    inverse_range_4: 0,
    direction: [x, y, z],
    spot_scale: 0,
    spot_offset: 1,
    area_x: right.map((r) => r * 0.5 * size * (type === 'rect' ? aspect : 1)),
    area_y: up.map((u) => u * 0.5 * size),
    area_radiance: color.map((c) => c * intensity),
    disk: type === 'disk' ? 1 : 0,
  };
}

const hasArea = (light: PunctualLight | AreaLight): light is AreaLight => light.type === 'rect' || light.type === 'disk';

/** An element of the lights, for Shader.block(): as the light kinds of templates/mesh.node and forward_area.node say. */
export function lightValues(light: PunctualLight | AreaLight): Record<string, number | number[]> {
  if (hasArea(light)) return areaValues(light);
  const { type, position = [0, 0, 0], direction = [0, 0, -1], color = [1, 1, 1], intensity = 1, range = 0 } = light;
  const { innerConeAngle = 0, outerConeAngle = Math.PI / 4 } = light;
  const positional = type !== 'directional';
  const outer = Math.cos(outerConeAngle);
  const scale = type === 'spot' ? 1 / Math.max(Math.cos(innerConeAngle) - outer, 0.001) : 0;
  return {
    position: positional ? position : direction.map((x) => -x),
    positional: positional ? 1 : 0,
    radiance: color.map((x) => x * intensity),
    inverse_range_4: positional && range > 0 ? range ** -4 : 0,
    direction,
    spot_scale: scale,
    spot_offset: type === 'spot' ? -outer * scale : 1,
    // What forward_clustered has beside: nothing dims the light.
    cookie: -1,
    profile: -1,
    mask: -1,
  };
}

/** A matrix of 16 numbers, column by column. */
export type Matrix = ArrayLike<number>;

function cofactors(m: Matrix): number[][] {
  const at = (row: number, column: number) => m[4 * column + row];
  return [0, 1, 2].map((r) => [0, 1, 2].map((c) => {
    const [r1, r2, c1, c2] = [(r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3];
    return at(r1, c1) * at(r2, c2) - at(r1, c2) * at(r2, c1);
  }));
}
const determinant = (m: Matrix, of: number[][]) => m[0] * of[0][0] + m[4] * of[0][1] + m[8] * of[0][2];

/** Object.normal_matrix for a model matrix: the inverse transpose of its upper 3x3. Of a matrix that flattens space, the
 * cofactors, which is that but for a factor. */
export function normalMatrix(m: Matrix): number[] {
  const of = cofactors(m);
  const scale = 1 / (determinant(m, of) || 1);
  const normal = new Array<number>(16).fill(0);
  for (let r = 0; r < 3; ++r) for (let c = 0; c < 3; ++c) normal[4 * c + r] = of[r][c] * scale;
  normal[15] = 1;
  return normal;
}
/** Whether it turns what is in front into what is behind: a negative determinant. */
export const mirrors = (m: Matrix): boolean => determinant(m, cofactors(m)) < 0;
/** The block Object, for Shader.block(). */
export const objectValues = (model: Matrix) => ({ model: Array.from(model), normal_matrix: normalMatrix(model) });

/** The block SeeThrough for a picture of that many mip levels, for Shader.block(). WebGPU's pictures begin at the upper edge,
 * where clip space's y is 1. */
export function seeThroughValues(viewProjection: Matrix, levels: number) {
  const row = (make: (x: number, y: number, w: number) => number) =>
    [0, 1, 2, 3].map((i) => make(viewProjection[4 * i], viewProjection[4 * i + 1], viewProjection[4 * i + 3]));
  return {
    scene_u: row((x, _, w) => 0.5 * (x + w)),
    scene_v: row((_, y, w) => 0.5 * (w - y)),
    scene_w: row((_x, _y, w) => w),
    scene_max_lod: levels - 1,
  };
}

// ---- textures

/** Of eight bits a channel. Of a shader that decodes sRGB itself (decode_srgb) no texture is "srgb". */
export const textureFormat = (colorSpace?: 'srgb' | 'linear'): GPUTextureFormat =>
  colorSpace === 'srgb' ? 'rgba8unorm-srgb' : 'rgba8unorm';

const kWraps: Record<string, GPUAddressMode> = { repeat: 'repeat', clamp: 'clamp-to-edge', mirror: 'mirror-repeat' };

/** A file's sampler, for createSampler(); what it leaves open is linear, between mip levels as well. */
export function samplerOf(from: ContractTexture['sampler']): GPUSamplerDescriptor {
  const min = from.min_filter ?? 'linear-mipmap-linear';
  const levels = min.includes('mipmap');
  return {
    addressModeU: kWraps[from.wrap_s],
    addressModeV: kWraps[from.wrap_t],
    magFilter: from.mag_filter === 'nearest' ? 'nearest' : 'linear',
    minFilter: min.startsWith('nearest') ? 'nearest' : 'linear',
    mipmapFilter: min.endsWith('mipmap-linear') ? 'linear' : 'nearest',
    lodMaxClamp: levels ? 32 : 0,
  };
}
/** The sampler of what is the frame's or the object's. */
export function frameSamplerOf(texture: Interface['textures'][number]): GPUSamplerDescriptor {
  const filter: GPUFilterMode = texture.role === 'object' ? 'nearest' : 'linear';
  return {
    magFilter: filter,
    minFilter: filter,
    mipmapFilter: filter,
    // An angle's turn begins again (docs/bindings.md, light_profiles).
    addressModeV: texture.name === 'light_profiles' ? 'repeat' : 'clamp-to-edge',
    ...(texture.type === 'sampler2DShadow' ? { compare: 'less-equal' as const } : {}),
  };
}

// ---- states

/** Where a colour is not a vec4. */
const kOutputFormats: Record<string, GPUTextureFormat> = { float: 'r16float', vec2: 'rg16float', int: 'r32sint', uint: 'r32uint' };

/** What createRenderPipeline() is given beside the stages' modules and the layout. `mirrored`: the object's matrix mirrors().
 * `format`: of the shader's colours that are a vec4. */
export function pipelineStates(
  shader: Interface,
  material: Pick<ContractMaterial, 'double_sided' | 'depth_write' | 'blend'>,
  { mirrored = false, format = 'rgba16float', depthFormat = 'depth24plus' }:
    { mirrored?: boolean; format?: GPUTextureFormat; depthFormat?: GPUTextureFormat } = {},
) {
  const array = shader.textures?.find((texture) => texture.array && !texture.layered)?.array;
  if (array !== undefined) {
    throw new Error(`the shader takes textures from the array '${array}', and WebGPU has no arrays of textures: make it with ` +
      "binding: 'sets'");
  }
  const component = ([srcFactor, dstFactor]: [string, string]): GPUBlendComponent => ({
    operation: 'add', srcFactor: srcFactor as GPUBlendFactor, dstFactor: dstFactor as GPUBlendFactor,
  });
  const { blend } = material;
  const target: GPUColorTargetState = {
    format, ...(blend ? { blend: { color: component(blend.color), alpha: component(blend.alpha) } } : {}),
  };
  return {
    primitive: {
      topology: 'triangle-list',
      cullMode: material.double_sided ? 'none' : 'back',
      frontFace: mirrored ? 'cw' : 'ccw',
    } satisfies GPUPrimitiveState,
    depthStencil: {
      format: depthFormat, depthWriteEnabled: material.depth_write, depthCompare: 'less-equal',
    } satisfies GPUDepthStencilState,
    targets: ((shader.outputs ?? []) as { type?: string }[]).map(({ type = 'vec4' }) => {
      const own = kOutputFormats[type];
      if (own === undefined) return target;
      return type.endsWith('int') ? { format: own } : { ...target, format: own };
    }),
  };
}

// ---- a frame

const kPasses: Pass[] = ['opaque', 'masked', 'looks_through', 'blended'];

/** Sorts what is drawn in a frame (docs/bindings.md, "A frame"): by passes, what looks through or is blended from back to front,
 * the others from front to back. `distance` is that of its middle along the view. */
export function drawOrder(a: { pass: Pass; distance: number }, b: { pass: Pass; distance: number }): number {
  const pass = kPasses.indexOf(a.pass) - kPasses.indexOf(b.pass);
  if (pass !== 0) return pass;
  return kPasses.indexOf(a.pass) >= 2 ? b.distance - a.distance : a.distance - b.distance;
}
