// The page of `lacquer view` for tests: opened in a browser, edited as a person edits it, and what `lacquer eval` says of that.
import assert from 'node:assert/strict';
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { kPatience, kSlow, launch, listen } from './browser.mjs';
import { lacquer, output, root, withImages } from './native.mjs';

const { load } = await import(join(output, 'package/index.js'));

let browser;
/** Of this run: pages, and what is edited. */
export let folder;
/** The module in Node. */
export let library;

export async function begin() {
  library = await load();
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), 'lacquer-page-'));
  cpSync(join(root, 'examples/textures'), join(folder, 'textures'), { recursive: true });
}
export async function end() {
  await browser?.close();
  if (folder) rmSync(folder, { recursive: true });
}

/** Sizes of windows. Software draws the picture: with half of the pixels a test takes some third less. */
export const kSmall = { width: 960, height: 360 };
const kUsual = { width: 1120, height: 640 };
/** For what needs the room: large graphs, long names, pictures that are not mostly edges. */
export const kWide = { width: 1440, height: 900 };

/** A page made by `lacquer view`, from the disk; fails on any message on the console. */
export async function open(files, use, { flags = ['--no-cost'], url = null, size = kUsual, scheme = 'light', by = browser } = {}) {
  const html = join(folder, 'page.html');
  lacquer('view', ...files, '-o', html, '--page', join(output, 'view.html'), ...flags);
  const context = await by.newContext({ viewport: size, colorScheme: scheme, acceptDownloads: true });
  context.setDefaultTimeout(kPatience);
  const page = await context.newPage();
  const { said, unlessItFails } = listen(page, kSlow);
  try {
    await page.goto(url ?? pathToFileURL(html).href, { timeout: kPatience });
    await unlessItFails(page.waitForSelector('body.ready'));
    await unlessItFails(use(page));
  } finally {
    await context.close();
  }
  assert.deepEqual(said, []);
}

/** All that was asked for is on the canvas. */
export const painted = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

/** All that is seen has its look, and the current material its textures. */
export const settled = (page) => page.evaluate(async () => {
  const it = window.lacquerPage;
  await it.others;
  await it.viewport.loadTextures(it.document.file, it.lookNow());
});

const kPoint = { n: [0.2, 0.3, 0.9327379], t: [0.9777802, 0, -0.2096336, 1], l: [0.36, 0.48, 0.8], light: [1.5, 1.4, 1.3], uv: [0.3, 0.6] };

/** Sets sliders one after the other as a person does, and asks each time for the colour; the edited file stays in the page. */
export async function setAll(page, values) {
  return page.evaluate(([values, point]) => values.map(([id, value]) => {
    const it = window.lacquerPage;
    const slider = document.getElementById(id);
    slider.value = String(value);
    slider.dispatchEvent(new Event('input', { bubbles: true }));
    slider.dispatchEvent(new Event('change', { bubbles: true }));
    const look = it.lookNow();
    return {
      lamp: it.viewport.probe(look, { ...point, env: [0, 0, 0] }),
      id: look.id,
      json: JSON.stringify(it.document.json),
      name: it.document.names[it.document.material],
      status: document.getElementById('status').textContent,
    };
  }), [values, kPoint]);
}

export const set = async (page, id, value) => (await setAll(page, [[id, value]]))[0];

const kEvaluated = { n: kPoint.n, t: kPoint.t, v: [0, 0, 1], l: kPoint.l, light: kPoint.light, uv0: kPoint.uv, uv1: kPoint.uv, env: [0, 0, 0] };

/** A colour as a picture has it: nothing where the material drops the fragment. */
const seen = ({ rgba: [color], discarded: [dropped] = [false] }) => (dropped ? [0, 0, 0, 0] : color);

/** `lacquer eval` of an edited file, whose images lie beside the examples. */
export function evaluatedByProgram(json, name) {
  const file = join(folder, 'edited.gltf');
  writeFileSync(file, json);
  writeFileSync(join(folder, 'points.json'), JSON.stringify([kEvaluated]));
  return seen(JSON.parse(lacquer('eval', file, '--material', name, '--engine', 'float', '--points', join(folder, 'points.json'))));
}

/** The same by the module in Node, without a process for each: its images are put into the file. */
export function evaluated(json, material) {
  const scene = library.scene(withImages(json, material), 'edited.gltf');
  try {
    return seen(scene.evaluate(material, [kEvaluated], { engine: 'float' }));
  } finally {
    scene.free();
  }
}

/** The colour in the middle of the picture. */
export const middle = (page) => page.evaluate(() => {
  const { viewport } = window.lacquerPage;
  const { gl } = viewport;
  viewport.draw();
  const rgba = new Uint8Array(4);
  gl.readPixels(gl.drawingBufferWidth / 2, gl.drawingBufferHeight / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
  return [...rgba];
});

/** Files that fall on the page: names with bytes. */
export async function drop(page, files) {
  await page.evaluate(async (files) => {
    const bytesOf = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    await window.lacquerPage.files.take(files.map(([name, base64]) => new File([bytesOf(base64)], name)));
  }, files.map(([name, bytes]) => [name, Buffer.from(bytes).toString('base64')]));
}

/** What a button gives to save. */
export async function downloaded(page, button) {
  if (!(await page.isVisible(button))) await page.click('[data-tab=graph]');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click(button)]);
  return readFileSync(await download.path());
}
