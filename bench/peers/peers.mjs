// `./dev bench peers`: builds other renderers' fragment shaders for the works as an application would, in a browser, measures
// them as ours are measured, compares the colours, and renews bench/peers.json, docs/cost.md and README.md.
//   node peers.mjs ROOT LACQUER OUTPUT      OUTPUT has node_modules
//   node peers.mjs ROOT                     the pages alone, from the records in bench/
import { copyFileSync, mkdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { kIndices, kSize, points, readWork, writeEnvironment, writeScene, writeSheenTable } from './ball.mjs';
import { bundle, open, pageOf } from './browser.mjs';
import { compile, costs, distance, driver, ourColors, versionOf } from './measure.mjs';
import { writeSheet } from './pictures.mjs';
import { writePages, writeRecord } from './report.mjs';
import { asFor, kNotDrawn, kPeers, kWorks } from './works.mjs';

const [root, lacquer, output = root] = process.argv.slice(2).map((path) => resolve(path));
const modules = join(output, 'node_modules');
const require = createRequire(join(output, 'package.json'));

function prepare() {
  mkdirSync(join(output, 'khronos'), { recursive: true });
  copyFileSync(join(modules, '@khronosgroup/gltf-viewer/dist/libs/mikktspace_bg.wasm'), join(output, 'khronos/mikktspace_bg.wasm'));
  writeEnvironment(join(output, 'environment.hdr'));
  writeSheenTable(join(output, 'sheen.png'));
}

/** Theirs for one work: the costs come later, for all modules at once. */
async function draw(page, peer, work) {
  const glTF = readWork(join(root, 'bench/works', `${work.file}.gltf`));
  const folder = `scenes/${peer.name}/${work.file}`;
  writeScene(join(output, folder), asFor(peer, work.file, glTF));
  const asked = { scene: `/${folder}/ball.gltf`, environment: work.ibl, size: kSize, indices: kIndices, openpbr: Boolean(peer.openpbr) };
  const { source, pixels } = await page.draw(asked);
  return { work: work.name, peer: peer.name, pixels, module: compile(source, join(output, 'shaders', peer.name, work.name)) };
}

/** All works of one peer; what fails is said, and the others go on. */
async function drawAll(context, peer) {
  const found = [];
  const page = await pageOf(context, peer.page);
  for (const work of kWorks) {
    try {
      found.push(await draw(page, peer, work));
      console.error(`bench peers: ${peer.title}: ${work.name}`);
    } catch (error) {
      console.error(`bench peers: ${peer.title}: ${work.name} failed: ${error.message}`);
      process.exitCode = 1;
    }
  }
  await page.close();
  return found;
}

async function drawEverything() {
  const { chromium } = require('playwright-core');
  const { context, close } = await open(chromium, output);
  const found = [];
  try {
    for (const peer of kPeers) {
      try {
        found.push(...(await drawAll(context, peer)));
      } catch (error) {
        console.error(`bench peers: ${peer.title} does not run: ${error.message}`);
        process.exitCode = 1;
      }
    }
  } finally {
    await close();
  }
  return found;
}

/** Adds the colours' distances; what the pictures are drawn from. */
function compare(found, results) {
  const rows = [];
  for (const work of kWorks.filter(({ name }) => !kNotDrawn.has(name))) {
    const scene = join(output, 'scenes/ours', work.file);
    const { list, pixels } = points(work.ibl);
    const ours = ourColors(lacquer, writeScene(scene, readWork(join(root, 'bench/works', `${work.file}.gltf`))), list);
    const theirs = found.filter((each) => each.work === work.name);
    for (const each of theirs) results[work.name][each.peer].colors = distance(ours, each.pixels, pixels);
    rows.push({ ours, pixels, theirs: kPeers.map(({ name }) => theirs.find((each) => each.peer === name)?.pixels) });
  }
  return rows;
}

async function main() {
  if (!lacquer) return writePages(root);
  prepare();
  await bundle(require('esbuild'), join(root, 'bench/peers/pages'), [...new Set(kPeers.map(({ page }) => page))], join(output, 'pages'));
  const found = await drawEverything();
  if (found.length === 0) throw new Error('no peer drew anything');
  const results = Object.fromEntries(kWorks.map(({ name }) => [name, {}]));
  const rows = costs(lacquer, found.map(({ module }) => module));
  found.forEach(({ work, peer }, i) => (results[work][peer] = rows[i]));
  const balls = compare(found, results);
  const versions = Object.fromEntries(kPeers.map((peer) => [peer.package, versionOf(modules, peer.package)]));
  if (process.exitCode) throw new Error('something failed; bench/peers.json and the pages stay as they were');
  writeRecord(root, { versions, driver: driver(), results });
  writePages(root);
  writeSheet(join(root, 'docs/images/peers.png'), balls, 2);
  writeSheet(join(output, 'balls.png'), balls, 1);
  console.error(`bench peers: docs/cost.md has the tables, ${join(output, 'balls.png')} ours, theirs and the differences, ` +
    `${join(output, 'shaders')} their shaders`);
}

main().catch((error) => {
  console.error(`bench peers: ${error.message}`);
  process.exit(1);
});
