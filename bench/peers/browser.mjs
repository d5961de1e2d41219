// Runs the peers' pages in Chromium, with WebGL 2 by SwiftShader.
import { existsSync } from 'node:fs';
import { join, normalize } from 'node:path';

const kChromium = process.env.LACQUER_CHROMIUM ?? '/usr/bin/chromium';
/** Milliseconds after which a page is given up: a machine may have much other work. */
const kPatience = 300_000;
const kTypes = { html: 'text/html', js: 'text/javascript', wasm: 'application/wasm', png: 'image/png', gltf: 'model/gltf+json' };

/** One script for each page: the page and the peer that it uses. */
export async function bundle(esbuild, pages, names, output) {
  await esbuild.build({
    entryPoints: names.map((name) => join(pages, `${name}.js`)), outdir: output, bundle: true, format: 'esm', target: 'es2022',
    splitting: true, nodePaths: [join(output, '../node_modules')], logLevel: 'error', define: { 'process.env.NODE_ENV': '"production"' },
  });
}

/** A browser whose pages see the folder, and nothing of the network, as one host. */
export async function open(chromium, folder) {
  if (!existsSync(kChromium)) throw new Error(`there is no ${kChromium}; LACQUER_CHROMIUM may name a browser`);
  const browser = await chromium.launch({
    executablePath: kChromium,
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
  });
  const context = await browser.newContext();
  context.setDefaultTimeout(kPatience);
  await context.route('**/*', (route) => {
    const url = new URL(route.request().url());
    if (url.protocol === 'blob:' || url.protocol === 'data:') return route.continue();
    if (url.pathname === '/empty.html') return route.fulfill({ contentType: 'text/html', body: '<body></body>' });
    const path = join(folder, normalize(decodeURIComponent(url.pathname)));
    if (url.hostname !== 'peers' || !existsSync(path)) return route.abort();
    return route.fulfill({ path, contentType: kTypes[path.slice(path.lastIndexOf('.') + 1)] ?? 'application/octet-stream' });
  });
  return { context, close: () => browser.close() };
}

/** A page with a peer; `draw(request)` gives the fragment shader's text and the colours: { source, pixels }. */
export async function pageOf(context, name) {
  const page = await context.newPage();
  let said = [];
  page.on('console', (message) => message.type() === 'error' && said.push(message.text()));
  page.on('pageerror', (error) => said.push(String(error)));
  const explained = async (does) => {
    const patience = new Promise((_, fail) => setTimeout(() => fail(new Error('the page took too long')), kPatience).unref());
    said = [];
    try {
      return await Promise.race([does(), patience]);
    } catch (error) {
      throw new Error([error.message.split('\n')[0], ...said.slice(0, 3)].join('; '));
    }
  };
  await explained(async () => {
    await page.goto('http://peers/empty.html');
    await page.addScriptTag({ url: `http://peers/pages/${name}.js`, type: 'module' });
    await page.waitForFunction(() => window.draw);
  });
  const draw = (request) => explained(() => page.evaluate((asked) => window.draw(asked), request));
  return { draw, close: () => page.close() };
}
