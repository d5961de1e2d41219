// Environments of one's own: Radiance pictures (.hdr), equirectangular, filtered for the roughnesses that shaders ask for.
import type { Radiance } from './environment';
import { cross, dot, unit, type Vec3 } from '../src/math';

export interface Picture {
  width: number;
  height: number;
  /** Three numbers for each pixel, rows from the top. */
  pixels: Float32Array;
}

/** Above it nothing is read: a picture of 16384 by 8192. */
const kMostPixels = 1 << 27;

class Bytes {
  at = 0;
  constructor(private readonly bytes: Uint8Array) {}
  left(): number {
    return this.bytes.length - this.at;
  }
  next(): number {
    if (this.at >= this.bytes.length) throw new Error('the picture ends too early');
    return this.bytes[this.at++];
  }
  line(): string {
    let text = '';
    for (let c = this.next(); c !== 10; c = this.next()) text += String.fromCharCode(c);
    return text;
  }
}

/** What a row takes at least: of each of four planes runs of two bytes, as long as there are, or plain pixels. */
function leastBytes(width: number): number {
  return width < 8 || width > 32767 ? 4 * width : 8 * Math.ceil(width / 127);
}

/** A row of four planes, each run-length coded, or of plain pixels as old writers have them. */
function readRow(bytes: Bytes, width: number, row: Uint8Array): void {
  const head = [bytes.next(), bytes.next(), bytes.next(), bytes.next()];
  if (head[0] !== 2 || head[1] !== 2 || head[2] * 256 + head[3] !== width || width < 8 || width > 32767) {
    row.set(head);
    for (let i = 4; i < 4 * width; ++i) row[i] = bytes.next();
    return;
  }
  for (let plane = 0; plane < 4; ++plane) {
    for (let x = 0; x < width; ) {
      const count = bytes.next();
      const run = count > 128;
      const length = run ? count - 128 : count;
      if (length === 0 || x + length > width) throw new Error('a row of the picture is longer than the picture is wide');
      const value = run ? bytes.next() : 0;
      for (let i = 0; i < length; ++i) row[4 * x++ + plane] = run ? value : bytes.next();
    }
  }
}

/** Reads a .hdr (RGBE) file. Throws an Error that says what is wrong. */
export function readHdr(data: Uint8Array): Picture {
  const bytes = new Bytes(data);
  if (!/^#\?(RADIANCE|RGBE)/.test(bytes.line())) throw new Error('this is no Radiance picture (.hdr)');
  let text = bytes.line();
  for (; text.trim() !== ''; text = bytes.line()) {
    if (text.startsWith('FORMAT=') && !text.includes('32-bit_rle_rgbe')) throw new Error(`${text} is not read: 32-bit_rle_rgbe is`);
  }
  const size = /^-Y (\d+) \+X (\d+)/.exec(bytes.line());
  if (!size) throw new Error('the picture has no size, or its rows do not run from the top left');
  const [height, width] = [Number(size[1]), Number(size[2])];
  if (width < 1 || height < 1 || width * height > kMostPixels) throw new Error(`a picture of ${width} by ${height} is not read`);
  // Before any room is taken for the pixels.
  if (height * leastBytes(width) > bytes.left()) throw new Error('the picture ends too early');
  const pixels = new Float32Array(3 * width * height);
  const row = new Uint8Array(4 * width);
  for (let y = 0; y < height; ++y) {
    readRow(bytes, width, row);
    for (let x = 0; x < width; ++x) {
      const scale = row[4 * x + 3] === 0 ? 0 : 2 ** (row[4 * x + 3] - 136);
      for (let i = 0; i < 3; ++i) pixels[3 * (y * width + x) + i] = row[4 * x + i] * scale;
    }
  }
  return { width, height, pixels };
}

/** Half as wide and high, each pixel the mean of those that it covers. */
function halved({ width, height, pixels }: Picture): Picture {
  const made = { width: Math.max(1, width >> 1), height: Math.max(1, height >> 1), pixels: new Float32Array(0) };
  made.pixels = new Float32Array(3 * made.width * made.height);
  for (let y = 0; y < made.height; ++y) {
    for (let x = 0; x < made.width; ++x) {
      for (let i = 0; i < 3; ++i) {
        let sum = 0;
        for (const [dx, dy] of [[0, 0], [1, 0], [0, 1], [1, 1]]) {
          sum += pixels[3 * (Math.min(2 * y + dy, height - 1) * width + Math.min(2 * x + dx, width - 1)) + i];
        }
        made.pixels[3 * (y * made.width + x) + i] = sum / 4;
      }
    }
  }
  return made;
}

/** The picture in a direction, between its pixels: -z is in the middle, +x right of it. */
function lookup({ width, height, pixels }: Picture, [x, y, z]: Vec3, to: Vec3, weight: number): void {
  const u = (Math.atan2(x, -z) / (2 * Math.PI) + 0.5) * width - 0.5;
  const v = (Math.acos(Math.min(Math.max(y, -1), 1)) / Math.PI) * height - 0.5;
  const [u0, v0] = [Math.floor(u), Math.floor(v)];
  for (let dy = 0; dy < 2; ++dy) {
    const row = Math.min(Math.max(v0 + dy, 0), height - 1) * width;
    const wy = weight * (dy ? v - v0 : 1 - v + v0);
    for (let dx = 0; dx < 2; ++dx) {
      const at = 3 * (row + ((u0 + dx + width) % width));
      const w = wy * (dx ? u - u0 : 1 - u + u0);
      for (let i = 0; i < 3; ++i) to[i] += w * pixels[at + i];
    }
  }
}

const kSamples = 64;

/** The half vectors of GGX around +z, evenly by their probability (a Hammersley set), and that probability. */
function halves(alpha: number): { h: Vec3; density: number }[] {
  return Array.from({ length: kSamples }, (_, i) => {
    let bits = i;
    let radical = 0;
    for (let b = 0.5; bits > 0; b /= 2, bits >>= 1) radical += b * (bits & 1);
    const cosine = Math.sqrt((1 - radical) / (1 + (alpha * alpha - 1) * radical));
    const sine = Math.sqrt(1 - cosine * cosine);
    const angle = (2 * Math.PI * (i + 0.5)) / kSamples;
    const d = (alpha * alpha) / (Math.PI * ((cosine * cosine) * (alpha * alpha - 1) + 1) ** 2);
    return { h: [sine * Math.cos(angle), sine * Math.sin(angle), cosine] as Vec3, density: d / 4 };
  });
}

/** What a GGX lobe of a roughness gathers, seen along its normal (Karis 2013). Each sample takes the level of the picture
 * whose pixels are as large as its share of the lobe, so that no bright pixel is missed (Krivanek and Colbert 2008). */
export function radianceOf(picture: Picture): Radiance {
  const levels = [picture];
  while (levels[levels.length - 1].height > 1) levels.push(halved(levels[levels.length - 1]));
  const made = new Map<number, { h: Vec3; density: number }[]>();
  const pixel = (2 * Math.PI * Math.PI) / (picture.width * picture.height); // at the horizon
  const levelOf = (solid: number) => levels[Math.min(Math.max(Math.round(0.5 * Math.log2(solid / pixel)), 0), levels.length - 1)];
  return (direction, roughness) => {
    const sum: Vec3 = [0, 0, 0];
    if (roughness <= 0) {
      lookup(picture, direction, sum, 1);
      return sum;
    }
    let list = made.get(roughness);
    if (!list) made.set(roughness, (list = halves(roughness * roughness)));
    const across = unit(cross(Math.abs(direction[1]) < 0.99 ? [0, 1, 0] : [1, 0, 0], direction));
    const up = cross(direction, across);
    let total = 0;
    for (const { h, density } of list) {
      const to = [0, 1, 2].map((i) => {
        const half = h[0] * across[i] + h[1] * up[i] + h[2] * direction[i];
        return 2 * h[2] * half - direction[i];
      }) as Vec3;
      const cosine = dot(to, direction);
      if (cosine <= 0) continue;
      lookup(levelOf(1 / (kSamples * density)), to, sum, cosine);
      total += cosine;
    }
    return sum.map((x) => x / total) as Vec3;
  };
}
