// A sheet of balls: a row for each work, with ours, theirs one after the other, and four times the difference beside each.
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { kSize, png } from './ball.mjs';

const kAmplified = 4;
const encoded = (x) => Math.round(255 * Math.min(1, x <= 0.0031308 ? 12.92 * Math.max(x, 0) : 1.055 * x ** (1 / 2.4) - 0.055));

/** Pictures of one row: functions of a pixel's number, or null for what is not there. */
function balls({ ours, pixels, theirs }) {
  const placeOf = new Map(pixels.map((pixel, i) => [pixel, i]));
  const own = (pixel) => (placeOf.has(pixel) ? ours[placeOf.get(pixel)].slice(0, 3) : [0, 0, 0]);
  const shown = [own];
  for (const picture of theirs) {
    const other = (pixel) => (placeOf.has(pixel) ? picture.slice(4 * pixel, 4 * pixel + 3) : [0, 0, 0]);
    const apart = (pixel) => own(pixel).map((x, channel) => kAmplified * Math.abs(x - other(pixel)[channel]));
    shown.push(...(picture ? [other, apart] : [null, null]));
  }
  return shown;
}

/** The mean of a square of pixels, from below as WebGL counts. */
function mean(ball, left, top, step) {
  const sum = [0, 0, 0];
  for (let i = 0; i < step * step; ++i) {
    const x = left + (i % step), y = kSize - 1 - (top + Math.floor(i / step));
    ball(y * kSize + x).forEach((value, channel) => (sum[channel] += Math.min(1, value) / (step * step)));
  }
  return sum;
}

/** { width, height, texel } of `rows` as peers.mjs gathers them; `step` pixels of a side become one. */
function sheetOf(rows, step) {
  const sheet = rows.map(balls), side = kSize / step;
  return {
    width: sheet[0].length * side, height: sheet.length * side,
    texel: (x, y) => {
      const ball = sheet[Math.floor(y / side)][Math.floor(x / side)];
      return ball ? mean(ball, (x % side) * step, (y % side) * step, step).map(encoded) : [0, 0, 0];
    },
  };
}

export function writeSheet(file, rows, step) {
  const { width, height, texel } = sheetOf(rows, step);
  writeFileSync(file, png(width, height, texel));
}

/** Rows of a sheet of the gallery. */
export const kSheetRows = 9;
const kQuality = 0.8;
export const sheetName = (i) => `gallery-${Math.floor(i / kSheetRows) + 1}.webp`;

/** The gallery's sheets, which a browser encodes. */
export async function writeSheets(context, folder, rows) {
  const page = await context.newPage();
  await page.goto('http://peers/empty.html');
  for (let i = 0; i < rows.length; i += kSheetRows) {
    const { width, height, texel } = sheetOf(rows.slice(i, i + kSheetRows), 1);
    const rgba = [...Array(width * height).keys()].flatMap((at) => [...texel(at % width, Math.floor(at / width)), 255]);
    const asked = { width, height, rgba: Buffer.from(rgba).toString('base64'), quality: kQuality };
    const url = await page.evaluate(({ width: w, height: h, rgba: text, quality }) => {
      const canvas = document.createElement('canvas');
      canvas.width = w;
      canvas.height = h;
      const bytes = Uint8ClampedArray.from(atob(text), (c) => c.charCodeAt(0));
      canvas.getContext('2d').putImageData(new ImageData(bytes, w, h), 0, 0);
      return canvas.toDataURL('image/webp', quality);
    }, asked);
    if (!url.startsWith('data:image/webp;base64,')) throw new Error('the browser writes no WebP');
    writeFileSync(join(folder, sheetName(i)), Buffer.from(url.slice(url.indexOf(',') + 1), 'base64'));
  }
  await page.close();
}
