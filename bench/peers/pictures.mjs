// A sheet of balls: a row for each work, with ours, theirs one after the other, and four times the difference beside each.
import { writeFileSync } from 'node:fs';
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

/** `rows` as peers.mjs gathers them; `step` pixels of a side become one. */
export function writeSheet(file, rows, step) {
  const sheet = rows.map(balls), side = kSize / step;
  writeFileSync(file, png(sheet[0].length * side, sheet.length * side, (x, y) => {
    const ball = sheet[Math.floor(y / side)][Math.floor(x / side)];
    return ball ? mean(ball, (x % side) * step, (y % side) * step, step).map(encoded) : [0, 0, 0];
  }));
}
