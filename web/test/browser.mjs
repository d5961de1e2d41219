// What the tests of the page and of the package share: Debian's Chromium, driven by playwright-core, and a static server.
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { chromium } from 'playwright-core';

const kChromium = process.env.LACQUER_CHROMIUM ?? '/usr/bin/chromium';
/** Milliseconds after which a page is given up: a machine may have much other work. */
export const kPatience = Number(process.env.LACQUER_PATIENCE ?? 120_000);

export const launch = (...more) => chromium.launch({
  executablePath: kChromium,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', ...more],
});
/** What software needs to show WebGPU. WebGL says in that browser how slow its readPixels is. */
export const kWebGpu = [
  '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--use-vulkan=swiftshader', '--enable-features=Vulkan',
  '--disable-vulkan-surface',
];
export const kSlow = /GPU stall due to ReadPixels/;

/** What a page says on its console and fails with, but for what `passed` matches. failure() rejects with the first of what
 * is no console message: what a test waits for would then never come. */
export function listen(page, passed = /^$/) {
  const said = [];
  let fail;
  const failed = new Promise((_, reject) => (fail = reject));
  failed.catch(() => undefined); // nobody may be waiting
  page.on('console', (message) => passed.test(message.text()) || said.push(message.text()));
  page.on('pageerror', (error) => {
    said.push(String(error));
    fail(error);
  });
  page.on('crash', () => fail(new Error('the page crashed')));
  return { said, unlessItFails: (wait) => Promise.race([wait, failed]) };
}

/** Whether a browser has WebGPU; it is asked where the page lies, for not every place may have it. */
export const hasWebGpu = (page) => page.evaluate(async () => Boolean(await navigator.gpu?.requestAdapter()));

/** Gives files of a folder away, but for those that `hidden` matches. */
export async function serve(place, hidden = /^$/) {
  const types = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm', '.json': 'application/json' };
  const server = createServer((request, response) => {
    const path = normalize(new URL(request.url, 'http://localhost').pathname);
    try {
      if (hidden.test(path)) throw new Error('hidden');
      const bytes = readFileSync(join(place, path));
      response.writeHead(200, { 'content-type': types[extname(path)] ?? 'application/octet-stream' });
      response.end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  return { url: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}
