// What the tests share: the module, the samples, the program.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = resolve(fileURLToPath(import.meta.url), '../../..');
export const output = process.env.LACQUER_WEB ?? join(root, 'build/web');
export const program = process.env.LACQUER_PROGRAM ?? join(root, 'build/release/lacquer');

export function lacquer(...args) {
  return execFileSync(program, args, { cwd: root, encoding: 'utf8', maxBuffer: 1 << 28, stdio: ['pipe', 'pipe', 'pipe'] });
}

/** Real files, of the assets folder; none where that is not there. */
export function realFiles() {
  const assets = process.env.LACQUER_ASSETS ?? join(root, '../shared/assets');
  if (!existsSync(assets)) return [];
  const found = readdirSync(assets).flatMap((folder) => readdirSync(join(assets, folder)).map((name) => join(assets, folder, name)));
  return found.filter((name) => /\.(gltf|glb)$/.test(name)).sort();
}

/** Files with materials: the examples, the benchmarks' works, and the real ones. */
export function inputs() {
  const found = realFiles();
  if (found.length === 0) console.log('# there is no assets folder: the real files are left out');
  for (const folder of ['examples', 'bench/works']) {
    for (const name of readdirSync(join(root, folder))) if (name.endsWith('.gltf')) found.push(join(folder, name));
  }
  return found.sort();
}

/** `use(folder)`; the folder goes when that is done, with its promise where it gives one. */
export function withFolder(use) {
  const folder = mkdtempSync(join(tmpdir(), 'lacquer-web-'));
  const clean = () => rmSync(folder, { recursive: true });
  let result;
  try {
    result = use(folder);
  } catch (error) {
    clean();
    throw error;
  }
  if (result instanceof Promise) return result.finally(clean);
  clean();
  return result;
}

/** A run over the examples for some targets: `use(folder, manifest)`, whose sources are named as seen from the folder. */
export function withExamples(targets, use) {
  return withFolder((folder) => {
    const files = readdirSync(join(root, 'examples')).filter((name) => name.endsWith('.gltf')).sort();
    const told = ['-q', '--no-validate', '--no-sync', '--target', targets.join(',')];
    lacquer('gen', ...told, ...files.map((name) => join('examples', name)), '-o', folder);
    return use(folder, JSON.parse(readFileSync(join(folder, 'manifest.json'), 'utf8')));
  });
}

/** A glTF file of examples/ with its images in it, or with those that one material has: a scene from memory reads no others. */
export function withImages(json, material) {
  const gltf = JSON.parse(json);
  const wanted = new Set();
  JSON.stringify(material === undefined ? gltf.materials : gltf.materials[material], (name, value) => {
    if (!/texture$/i.test(name) || !value) return value;
    const texture = gltf.textures[value.index];
    const swizzled = texture.extensions?.NV_texture_swizzle?.options.find(({ channels }) => channels.every((each) => each < 4));
    wanted.add(gltf.images[texture.source ?? swizzled.source]);
    return value;
  });
  for (const each of wanted) {
    if (each.uri.startsWith('data:')) continue;
    each.uri = `data:image/png;base64,${readFileSync(join(root, 'examples', each.uri)).toString('base64')}`;
  }
  return JSON.stringify(gltf);
}

export const read = (file) => readFileSync(resolve(root, file));

/** A .glb of its JSON and its bytes. */
export function glb(json, binary) {
  const pad = (bytes, with_) => Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, with_)]);
  const chunk = (kind, bytes) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(bytes.length, 0);
    head.writeUInt32LE(kind, 4);
    return Buffer.concat([head, bytes]);
  };
  const chunks = [chunk(0x4e4f534a, pad(Buffer.from(JSON.stringify(json)), ' ')), chunk(0x004e4942, pad(binary, 0))];
  const head = Buffer.alloc(12);
  head.write('glTF', 0);
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(12 + chunks[0].length + chunks[1].length, 8);
  return Buffer.concat([head, ...chunks]);
}
