// Environments in OpenEXR (.exr): checked here, decoded by three.js' EXRLoader, which believes what a file says of itself.
import { FloatType } from 'three';
import { EXRLoader } from 'three/examples/jsm/loaders/EXRLoader.js';
import type { Picture } from './hdr';

/** Above it nothing is read: a picture of 8192 by 4096. */
const kMostPixels = 1 << 25;
/** The largest number of a half float: what is larger, or none, would be all that is seen. */
const kLargest = 65504;
const kTooEarly = 'the picture ends too early';

interface Header {
  width: number;
  height: number;
  tiled: boolean;
  /** Where the places of its chunks begin. */
  end: number;
}

/** Throws an Error that says what is wrong. */
function headerOf(view: DataView): Header {
  if (view.byteLength < 8 || view.getUint32(0, true) !== 20000630) throw new Error('this is no OpenEXR picture (.exr)');
  const version = view.getUint32(4, true);
  if ((version & 0xff) !== 2) throw new Error(`version ${version & 0xff} of OpenEXR is not read: 2 is`);
  if (version & 0x1800) throw new Error('an OpenEXR picture with several parts or depths is not read: one with a single flat part is');
  let at = 8;
  const text = () => {
    const from = at;
    while (view.getUint8(at++) !== 0);
    return String.fromCharCode(...new Uint8Array(view.buffer, view.byteOffset + from, Math.min(at - from - 1, 255)));
  };
  let size: [number, number] | null = null;
  for (let name = text(); name !== ''; name = text()) {
    text(); // its type
    const length = view.getUint32(at, true);
    at += 4;
    if (name === 'dataWindow') size = [view.getInt32(at + 8, true) - view.getInt32(at, true) + 1, view.getInt32(at + 12, true) - view.getInt32(at + 4, true) + 1];
    at += length;
  }
  if (!size) throw new Error('the picture has no size (dataWindow)');
  const [width, height] = size;
  if (width < 1 || height < 1 || width * height > kMostPixels) throw new Error(`a picture of ${width} by ${height} is not read`);
  return { width, height, tiled: (version & 0x200) !== 0, end: at };
}

/** Each chunk has to be there: the decoder takes what is beyond the end for black. */
function checkChunks(view: DataView, { tiled, end }: Header): void {
  const head = tiled ? 20 : 8;
  let first = view.byteLength;
  for (let at = end; at < first; at += 8) {
    const place = Number(view.getBigUint64(at, true));
    if (place <= end) throw new Error('the picture says wrongly where its rows are: it was not written to its end');
    if (place + head > view.byteLength || place + head + view.getUint32(place + head - 4, true) > view.byteLength) throw new Error(kTooEarly);
    first = Math.min(first, place);
  }
}

/** Reads a .exr file. Throws an Error that says what is wrong. */
export function readExr(data: Uint8Array): Picture {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  try {
    checkChunks(view, headerOf(view));
  } catch (error) {
    throw error instanceof RangeError ? new Error(kTooEarly) : error;
  }
  const loader = new EXRLoader();
  loader.type = FloatType;
  let read: { width?: number; height?: number; data?: any };
  try {
    read = loader.parse(data.slice().buffer);
  } catch (error) {
    const said = (error instanceof Error ? error.message : String(error)).replace(/^THREE\.EXRLoader: /, '');
    throw new Error(`the picture cannot be decoded: ${said}`);
  }
  const { width = 0, height = 0, data: rgba } = read;
  if (rgba?.length !== 4 * width * height) throw new Error('the picture cannot be decoded: it has no colours');
  const pixels = new Float32Array(3 * width * height);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      // Its rows run from below.
      for (let i = 0; i < 3; ++i) pixels[3 * (y * width + x) + i] = Math.min(Math.max(rgba[4 * ((height - 1 - y) * width + x) + i] || 0, 0), kLargest);
    }
  }
  return { width, height, pixels };
}
