// Bundles the ES module of the npm package, and the page of `lacquer view` with everything in it.
//   node build.mjs WASM OUTPUT EXAMPLES
import { build } from 'esbuild';
import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { existsSync, copyFileSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';

const [wasm, output, examples] = process.argv.slice(2).map((path) => resolve(path));
const here = dirname(fileURLToPath(import.meta.url));
const tsc = (...args) => execFileSync(process.execPath, [join(here, 'node_modules/typescript/bin/tsc'), ...args], { cwd: here, stdio: 'inherit' });

const packedOf = (file) => gzipSync(readFileSync(file), { level: 9 }).toString('base64');
const packed = packedOf(wasm);
/** The compiler's module, which stands beside. */
const compiler = join(dirname(wasm), 'lacquer-compiler.wasm');

/** A file with what it names, as `lacquer view` puts it into the page. */
function embedded(file) {
  const json = JSON.parse(readFileSync(file, 'utf8'));
  const uris = [...(json.buffers ?? []), ...(json.images ?? [])].map(({ uri }) => uri).filter((uri) => uri && !uri.startsWith('data:'));
  // An image in a format that browsers do not read need not be there.
  const there = [...new Set(uris)].filter((uri) => existsSync(join(dirname(file), decodeURIComponent(uri))));
  const resources = there.map((uri) => ({ uri, bytes: readFileSync(join(dirname(file), decodeURIComponent(uri))).toString('base64') }));
  return { name: file.slice(file.lastIndexOf('/') + 1), bytes: readFileSync(file).toString('base64'), resources };
}

/** An example as it stands in the package: it depends on the version that it is of. */
function copyExample(example, place) {
  mkdirSync(place, { recursive: true });
  const from = join(here, 'examples', example);
  const { name, version } = JSON.parse(readFileSync(join(here, 'package/package.json'), 'utf8'));
  for (const entry of readdirSync(from, { withFileTypes: true })) {
    if (entry.isFile() && entry.name !== 'package-lock.json') copyFileSync(join(from, entry.name), join(place, entry.name));
  }
  const description = JSON.parse(readFileSync(join(from, 'package.json'), 'utf8'));
  description.dependencies[name] = `^${version}`;
  writeFileSync(join(place, 'package.json'), `${JSON.stringify(description, null, 2)}\n`);
}

async function makePackage() {
  const folder = join(output, 'package');
  mkdirSync(folder, { recursive: true });
  for (const [name, source] of Object.entries({ library: 'library', index: 'index', compiler: 'compiler', gltf: 'gltf', webgpu: 'webgpu', three: 'three/index', babylon: 'babylon/index' })) {
    await build({
      entryPoints: [join(here, `src/${source}.ts`)], outfile: join(folder, `${name}.js`), bundle: true, format: 'esm', target: 'es2022',
      // Both entries have the same classes.
      external: ['./library.js', './packed.js', './packed-compiler.js', 'three', '@babylonjs/*'],
    });
  }
  tsc('-p', '.', '--noEmit');
  tsc('-p', 'tsconfig.types.json', '--outDir', folder);
  copyFileSync(wasm, join(folder, 'lacquer.wasm'));
  copyFileSync(compiler, join(folder, 'lacquer-compiler.wasm'));
  writeFileSync(join(folder, 'packed.js'), `export default '${packed}';\n`);
  writeFileSync(join(folder, 'packed-compiler.js'), `export default '${packedOf(compiler)}';\n`);
  for (const file of ['package.json', 'README.md']) copyFileSync(join(here, 'package', file), join(folder, file));
  for (const example of ['webgl2', 'webgpu', 'three', 'babylon']) copyExample(example, join(folder, 'examples', example));
  copyFileSync(join(here, '../LICENSE'), join(folder, 'LICENSE'));
}

/** What the page shows of bench/error.json: three numbers of each error, as texts. */
function errors() {
  const { gpu, nodes } = JSON.parse(readFileSync(join(here, '../bench/error.json'), 'utf8'));
  const spread = (of) => of && [of.max, of.p999, of.rms];
  const body = ({ e1, e2, e3, alone }) => ({
    e1: spread(e1?.ulp), e2: spread(e2?.absolute), e3: spread(e3?.absolute), against: e3?.against,
    alone: alone && [alone.instructions, alone.inverse_throughput],
  });
  const bodies = (of) => Object.fromEntries(Object.entries(of).map(([name, each]) => [name, body(each)]));
  return { gpu, nodes: Object.fromEntries(Object.entries(nodes).map(([name, of]) => [name, bodies(of)])) };
}

/** The page runs this script and has this style, decodes pictures that it was given, and asks nobody for anything. */
function policy(script, style) {
  const hash = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;
  return [
    "default-src 'none'", `script-src ${hash(script)} 'wasm-unsafe-eval'`, `style-src ${hash(style)}`, 'img-src data: blob:',
    "base-uri 'none'", "form-action 'none'",
  ].join('; ');
}

async function makePage() {
  const bundle = await build({
    entryPoints: [join(here, 'page/main.ts')], bundle: true, format: 'esm', target: 'es2022', minify: true, write: false,
    define: { 'import.meta.url': 'location.href' }, legalComments: 'inline', external: ['./packed.js'],
    plugins: [{ name: 'three', setup: ({ onResolve }) => onResolve({ filter: /^three$/ }, () => ({ path: join(here, 'page/exr_parts.ts') })) }],
  });
  const inScript = (text) => text.replace(/<\/script/gi, '<\\/script');
  const samples = readdirSync(examples).filter((name) => name.endsWith('.gltf')).sort().map((name) => embedded(join(examples, name)));
  samples.push(embedded(join(here, '../bench/peers/gallery.gltf')));
  const style = readFileSync(join(here, 'page/style.css'), 'utf8');
  const script = inScript(bundle.outputFiles[0].text);
  const parts = {
    '<!--policy-->': policy(script, style),
    '/*style*/': style,
    '<!--samples-->': JSON.stringify(samples).replace(/</g, '\\u003c'),
    '<!--errors-->': JSON.stringify(errors()).replace(/</g, '\\u003c'),
    '<!--wasm-->': packed,
    '<!--script-->': script,
  };
  let page = readFileSync(join(here, 'page/index.html'), 'utf8');
  for (const [mark, text] of Object.entries(parts)) page = page.replace(mark, () => text);
  writeFileSync(join(output, 'view.html'), page);
}

await makePackage();
await makePage();
