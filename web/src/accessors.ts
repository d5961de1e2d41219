// What is read of a file's accessors.
import { bufferView, type GltfFile, type Numbers } from './gltf.js';
import { isCount, isNear, item, once } from './json.js';

/** Numbers that are read of a file's accessors, or made for its primitives: 256 MB. */
const kMostNumbers = 2 ** 26;

type Stored = Int8Array | Uint8Array | Int16Array | Uint16Array | Uint32Array | Float32Array;
/** By component type: arrays, their elements' bytes, and the number that stands for 1 where it is normalized. */
const kArrays = new Map<unknown, [new (buffer: ArrayBuffer) => Stored, number, number]>([
  [5120, [Int8Array, 1, 127]], [5121, [Uint8Array, 1, 255]], [5122, [Int16Array, 2, 32767]], [5123, [Uint16Array, 2, 65535]],
  [5125, [Uint32Array, 4, 1]], [5126, [Float32Array, 4, 1]],
]);
const kSizes = new Map<unknown, number>([['SCALAR', 1], ['VEC2', 2], ['VEC3', 3], ['VEC4', 4], ['MAT4', 16]]);

/** What is read of a file: each accessor once, however many primitives have it. */
export class Reader {
  private left = kMostNumbers;
  private readonly floats = new Map<unknown, Numbers | null>();
  private readonly places = new Map<unknown, Float32Array | null>();
  private readonly corners = new Map<unknown, Uint32Array | null>();

  constructor(readonly file: GltfFile) {}

  /** Takes room for so many more numbers, if there is that much. */
  takes(count: number): boolean {
    if (count > this.left) return false;
    this.left -= count;
    return true;
  }
  /** An accessor as floats; what is normalized is from -1 or 0 to 1. */
  numbers(index: unknown): Numbers | null {
    return once(this.floats, index, () => numbers(this, index));
  }
  /** As the positions of vertices, each of them a place; null where one is none. */
  positions(index: unknown): Float32Array | null {
    return once(this.places, index, () => {
      const read = this.numbers(index);
      return read?.size === 3 && read.data.every(isNear) ? read.data : null;
    });
  }
  /** As the numbers of vertices. */
  indices(index: unknown): Uint32Array | null {
    return once(this.corners, index, () => {
      const read = stored(this, index);
      return read?.size === 1 ? new Uint32Array(read.data) : null;
    });
  }
}

/** The elements of an accessor one behind the other, as they are stored; null where it has none that can be read. */
function stored(from: Reader, index: unknown): { data: Stored; size: number; largest: number } | null {
  const { file } = from;
  const of = item(file.json.accessors, index);
  const [Kind, component, largest] = kArrays.get(of?.componentType) ?? [];
  const size = kSizes.get(of?.type);
  if (!Kind || !component || !largest || !size || !isCount(of.count) || of.count === 0) return null;
  // Without a bufferView of its own a sparse one begins with zeros.
  const bare = of.bufferView === undefined && of.sparse !== undefined;
  const bytes = bare ? null : bufferView(file, of.bufferView);
  if (!bytes && !bare) return null;
  const width = size * component;
  const stride = bare ? width : file.json.bufferViews[of.bufferView].byteStride ?? width;
  const start = of.byteOffset ?? 0;
  if (!isCount(start) || !isCount(stride) || stride < width || (bytes && start + stride * (of.count - 1) + width > bytes.length)) return null;
  if (!from.takes(of.count * size)) return null;
  const packed = new Uint8Array(width * of.count);
  if (bytes && stride === width) packed.set(bytes.subarray(start, start + packed.length));
  else if (bytes) for (let i = 0; i < of.count; ++i) packed.set(bytes.subarray(start + i * stride, start + i * stride + width), i * width);
  if (of.sparse !== undefined && !replace(from, of.sparse, packed, width)) return null;
  return { data: new Kind(packed.buffer), size, largest };
}

/** Puts a sparse accessor's elements in the place of those that it names; false where they cannot be read. */
function replace(from: Reader, sparse: any, packed: Uint8Array<ArrayBuffer>, width: number): boolean {
  const { count, indices, values } = sparse ?? {};
  const [Kind, component] = kArrays.get(indices?.componentType) ?? [];
  const [named, given] = [indices, values].map((part) => bufferView(from.file, part?.bufferView));
  const [first, begin] = [indices, values].map((part) => part?.byteOffset ?? 0);
  if (!Kind || !component || ![5121, 5123, 5125].includes(indices.componentType) || !named || !given) return false;
  if (!isCount(count) || !isCount(first) || !isCount(begin) || first + count * component > named.length || begin + count * width > given.length) return false;
  if (!from.takes(count * (1 + width / component))) return false;
  const places = new Kind(named.slice(first, first + count * component).buffer);
  return places.every((place, i) => {
    if (width * place >= packed.length) return false;
    packed.set(given.subarray(begin + i * width, begin + (i + 1) * width), width * place);
    return true;
  });
}

function numbers(from: Reader, index: unknown): Numbers | null {
  const read = stored(from, index);
  if (!read) return null;
  const { data, size, largest } = read;
  if (data instanceof Float32Array) return { data, size };
  if (from.file.json.accessors[index as number].normalized !== true) return { data: new Float32Array(data), size };
  const floats = new Float32Array(data.length);
  for (let i = 0; i < data.length; ++i) floats[i] = Math.max(data[i] / largest, -1);
  return { data: floats, size };
}
