// What the tests of /three and of /babylon share: when colours are alike, and which real files are drawn.
import assert from 'node:assert/strict';
import { existsSync, statSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { read, realFiles } from './native.mjs';

/** Floats may be off where a highlight is steep; nearly all of it is alike to what logarithms of software are good for. */
export function assertAlike(drawn, expected, what) {
  const off = [];
  for (let i = 0; i < expected.length; ++i) {
    if (i % 4 === 3) continue;
    const error = Math.abs(drawn[i] - expected[i]) / (1 + Math.abs(expected[i]));
    assert.ok(error < 0.02, `${what}: component ${i} is ${drawn[i]}, not ${expected[i]}`);
    off.push(error);
  }
  const middle = off.sort((a, b) => a - b)[Math.floor(off.length / 2)];
  assert.ok(middle < 5e-4, `${what}: off by ${middle} in the middle`);
}

/** Bytes of the real files that are drawn: larger ones take software minutes. */
const kLargest = 2 ** 21;

/** All that it names is beside it. */
function isWhole(file) {
  if (file.endsWith('.glb')) return true;
  const { buffers = [], images = [] } = JSON.parse(read(file));
  const names = [...buffers, ...images].map(({ uri }) => uri).filter((uri) => uri && !uri.startsWith('data:'));
  return names.every((uri) => existsSync(join(dirname(file), decodeURIComponent(uri))));
}

export const drawnFiles = () => realFiles().filter((file) => statSync(file).size < kLargest && isWhole(file));
