// `./dev bench peers`: builds other renderers' fragment shaders for the works as an application would, in a browser, measures
// them as ours are measured, compares the colours, and renews bench/peers.json, docs/cost.md and README.md; then the gallery:
// bench/gallery.json and docs/gallery.md with its pictures.
//   node peers.mjs ROOT LACQUER OUTPUT MATERIALX [PART]   LACQUER has bench/lacquer_bench beside it, OUTPUT has node_modules, MATERIALX
//                                                         its module for JavaScript, or nothing; PART is `works` or `gallery`
//   node peers.mjs ROOT                                   the pages alone, from the records in bench/
import { copyFileSync, mkdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { kIndices, kSize, points, readWork, writeEnvironment, writeScene, writeSheenTable } from './ball.mjs';
import { bundle, open, pageOf } from './browser.mjs';
import { drawGallery } from './gallery.mjs';
import { writeGallery, writeGalleryPages } from './gallery_page.mjs';
import { fragmentTimes, ourBound, sweepOf } from './fragments.mjs';
import { openMaterialX, shadersOf } from './materialx.mjs';
import { compile, costs, distance, driver, ourColors, ourModule, readManifest, run, sizes, versionOf } from './measure.mjs';
import { writeSheet, writeSheets } from './pictures.mjs';
import { writePages, writeRecord } from './report.mjs';
import { asFor, kNotDrawn, kPeers, kWorks } from './works.mjs';

const [root, lacquer, output = root, materialX = root] = process.argv.slice(2, 6).map((path) => resolve(path));
const part = process.argv[6];
const modules = join(output, 'node_modules');
const require = createRequire(join(output, 'package.json'));

function prepare() {
  mkdirSync(join(output, 'khronos'), { recursive: true });
  copyFileSync(join(modules, '@khronosgroup/gltf-viewer/dist/libs/mikktspace_bg.wasm'), join(output, 'khronos/mikktspace_bg.wasm'));
  writeEnvironment(join(output, 'environment.hdr'));
  writeSheenTable(join(output, 'sheen.png'));
}

/** MaterialX's module, and the peers that there are. */
async function whoIsThere() {
  const mx = await openMaterialX(materialX);
  if (!mx) console.error(`bench peers: there is no MaterialX in ${materialX}: the tables and pictures go without it`);
  return { mx, peers: kPeers.filter(({ environment }) => mx || !environment) };
}

/** What MaterialX draws of a work is the document that we write of it. */
function ownShaders(mx, peer, work, file) {
  if (!peer.environment) return null;
  return shadersOf(mx, run(lacquer, 'graph', file, '--format', 'mtlx'), work.ibl ? peer.environment : 'none');
}

/** Theirs for one work: the costs come later, for all modules at once. */
async function draw(page, mx, peer, work) {
  const file = join(root, 'bench/works', `${work.file}.gltf`), glTF = readWork(file);
  const folder = `scenes/${peer.name}/${work.file}`;
  writeScene(join(output, folder), asFor(peer, work.file, glTF));
  const asked = {
    scene: `/${folder}/ball.gltf`, environment: work.ibl, size: kSize, indices: kIndices, openpbr: Boolean(peer.openpbr),
    shaders: await ownShaders(mx, peer, work, file),
  };
  const { source, pixels, bound } = await page.draw(asked);
  return { work: work.name, peer: peer.name, pixels, bound, module: compile(source, join(output, 'shaders', peer.name, work.name)) };
}

/** All works of one peer; what fails is said, and the others go on. */
async function drawAll(context, mx, peer) {
  const found = [];
  const page = await pageOf(context, peer.page);
  for (const work of kWorks) {
    try {
      found.push(await draw(page, mx, peer, work));
      console.error(`bench peers: ${peer.title}: ${work.name}`);
    } catch (error) {
      console.error(`bench peers: ${peer.title}: ${work.name} failed: ${error.message}`);
      process.exitCode = 1;
    }
  }
  await page.close();
  return found;
}

async function drawEverything({ mx, peers }) {
  const { chromium } = require('playwright-core');
  const { context, close } = await open(chromium, output);
  const found = [];
  try {
    for (const peer of peers) {
      try {
        found.push(...(await drawAll(context, mx, peer)));
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
function compare(found, results, peers) {
  const rows = [];
  for (const work of kWorks.filter(({ name }) => !kNotDrawn.has(name))) {
    const scene = join(output, 'scenes/ours', work.file);
    const { list, pixels } = points(work.ibl);
    const ours = ourColors(lacquer, writeScene(scene, readWork(join(root, 'bench/works', `${work.file}.gltf`))), list);
    const theirs = found.filter((each) => each.work === work.name);
    for (const each of theirs) results[work.name][each.peer].colors = distance(ours, each.pixels, pixels);
    rows.push({ ours, pixels, theirs: peers.map(({ name }) => theirs.find((each) => each.peer === name)?.pixels) });
  }
  return rows;
}

/** Adds the nanoseconds of a fragment, all shaders of all in turns; the device. */
function time(found, own, results, ours) {
  const sweeps = [
    ...found.map(({ module, bound }) => sweepOf(module, bound)),
    ...own.map((module, i) => sweepOf(module, ourBound(readManifest(join(output, 'shaders/ours', kWorks[i].name))))),
  ];
  const { device, nanoseconds } = fragmentTimes(join(dirname(lacquer), 'bench/lacquer_bench'), sweeps, output);
  found.forEach(({ work, peer }, i) => (results[work][peer].fragment_ns = nanoseconds[i]));
  kWorks.forEach(({ name }, i) => (ours[name].fragment_ns = nanoseconds[found.length + i]));
  return device;
}

const versionsOf = ({ mx, peers }) => {
  const version = ({ environment, package: name }) => (environment ? mx.getVersionString() : versionOf(modules, name));
  return Object.fromEntries(peers.map((peer) => [peer.package, version(peer)]));
};

async function measureWorks(there) {
  const { peers } = there, found = await drawEverything(there);
  if (found.length === 0) throw new Error('no peer drew anything');
  const results = Object.fromEntries(kWorks.map(({ name }) => [name, {}]));
  const theirs = found.map(({ module }) => module), bench = join(dirname(lacquer), 'bench/lacquer_bench');
  const rows = costs(lacquer, theirs), more = sizes(bench, theirs);
  found.forEach(({ work, peer }, i) => (results[work][peer] = { ...rows[i], ...more[i] }));
  const balls = compare(found, results, peers);
  const own = kWorks.map(({ name, file, ibl }) => {
    return ourModule(lacquer, join(root, 'bench/works', `${file}.gltf`), ibl, join(output, 'shaders/ours', name));
  });
  const ownSizes = sizes(bench, own);
  const ours = Object.fromEntries(kWorks.map(({ name }, i) => [name, ownSizes[i]]));
  const device = time(found, own, results, ours);
  if (process.exitCode) throw new Error('something failed; bench/peers.json and the pages stay as they were');
  writeRecord(root, { versions: versionsOf(there), driver: driver(), device, results, ours });
  writePages(root);
  writeSheet(join(root, 'docs/images/peers.png'), balls, 2);
  writeSheet(join(output, 'balls.png'), balls, 1);
  console.error(`bench peers: docs/cost.md has the tables, ${join(output, 'balls.png')} ours, theirs and the differences, ` +
    `${join(output, 'shaders')} their shaders`);
}

async function showGallery(there) {
  const { chromium } = require('playwright-core');
  const { context, close } = await open(chromium, output);
  try {
    const pages = (name) => pageOf(context, name);
    const { materials, rows } = await drawGallery({ ...there, root, lacquer, output, shadersOf, asFor, pageOf: pages });
    await writeSheets(context, join(root, 'docs/images'), rows);
    writeGallery(root, { versions: versionsOf(there), materials });
  } finally {
    await close();
  }
  console.error('bench peers: docs/gallery.md has the gallery');
}

async function main() {
  if (!lacquer) {
    writePages(root);
    return writeGalleryPages(root);
  }
  prepare();
  const there = await whoIsThere(), { peers } = there;
  await bundle(require('esbuild'), join(root, 'bench/peers/pages'), [...new Set(peers.map(({ page }) => page))], join(output, 'pages'));
  if (part !== 'gallery') await measureWorks(there);
  if (part !== 'works') await showGallery(there);
}

main().catch((error) => {
  console.error(`bench peers: ${error.message}`);
  process.exit(1);
});
