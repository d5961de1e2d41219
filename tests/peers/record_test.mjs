// `node --test tests/peers/record_test.mjs`: what is made of the peers' figures.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { kSize, points } from '../../bench/peers/ball.mjs';
import { distance } from '../../bench/peers/measure.mjs';
import { pages, record } from '../../bench/peers/report.mjs';

const kRoot = join(dirname(fileURLToPath(import.meta.url)), '../..');

test('the pages say what the records in bench/ say', () => {
  const kHow = '`node bench/peers/peers.mjs .` renews the pages from bench/peers.json and bench/cost.json';
  for (const [path, text] of Object.entries(pages(kRoot))) assert.equal(readFileSync(path, 'utf8'), text, `${path}: ${kHow}`);
});

test('the best is of peers that do all of a work, each number for itself', () => {
  const costing = (instructions, inverse_throughput) => ({ navi21: { instructions, inverse_throughput } });
  const peers = { khronos: costing(10, 80), three: costing(20, 70), babylon: costing(30, 90), babylon_openpbr: costing(40, 100) };
  const names = Object.keys(JSON.parse(readFileSync(join(kRoot, 'bench/peers.json'), 'utf8')).works);
  const { works } = record({ versions: {}, driver: '', ours: {}, results: Object.fromEntries(names.map((name) => [name, peers])) });
  assert.deepEqual(works.W0.best, { instructions: 10, inverse_throughput: 70 });
  // The others have no coat, or not all of it.
  assert.deepEqual(works.W3.best, { instructions: 40, inverse_throughput: 100 });
});

test('distances are of the pixels that show the points', () => {
  const { list, pixels } = points(false);
  assert.ok(list.length > 10_000 && list.length === pixels.length);
  const ours = list.map(({ n }) => [n[0] + 1, n[1] + 1, n[2], 1]);
  // To the right x grows, upwards y, as WebGL counts pixels; the middle looks along z.
  const theirs = new Float64Array(4 * kSize * kSize);
  pixels.forEach((pixel, i) => theirs.set(ours[i], 4 * pixel));
  assert.equal(distance(ours, theirs, pixels).max, 0);
  const at = (x, y) => theirs.subarray(4 * (y * kSize + x), 4 * (y * kSize + x) + 3);
  assert.ok(at(100, 64)[0] > 1.4 && at(30, 64)[0] < 0.6 && at(64, 100)[1] > 1.4 && at(64, 30)[1] < 0.6 && at(64, 64)[2] > 0.99);
  theirs[4 * pixels[7] + 1] += 0.25;
  const one = distance(ours, theirs, pixels);
  assert.equal(one.max, 0.25);
  assert.ok(Math.abs(one.mean - 0.25 / (3 * list.length)) < 1e-7);
  theirs[4 * pixels[8]] = Number.NaN;
  assert.throws(() => distance(ours, theirs, pixels), /no number at pixel/);
});
