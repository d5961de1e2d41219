// What the tests share: the module, the samples, the program.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = resolve(fileURLToPath(import.meta.url), '../../..');
export const output = process.env.LACQUER_WEB ?? join(root, 'build/web');
export const program = process.env.LACQUER_PROGRAM ?? join(root, 'build/release/lacquer');

export function lacquer(...args) {
  return execFileSync(program, args, { cwd: root, encoding: 'utf8', maxBuffer: 1 << 28, stdio: ['pipe', 'pipe', 'pipe'] });
}

/** Files with materials: the examples, the benchmarks' works, and what the assets folder has. */
export function inputs() {
  const found = [];
  for (const folder of ['examples', 'bench/works']) {
    for (const name of readdirSync(join(root, folder))) if (name.endsWith('.gltf')) found.push(join(folder, name));
  }
  const assets = process.env.LACQUER_ASSETS ?? join(root, '../shared/assets');
  try {
    for (const folder of readdirSync(assets)) {
      for (const name of readdirSync(join(assets, folder))) if (/\.(gltf|glb)$/.test(name)) found.push(join(assets, folder, name));
    }
  } catch {
    console.log('# there is no assets folder: the real files are left out');
  }
  return found.sort();
}

export function withFolder(use) {
  const folder = mkdtempSync(join(tmpdir(), 'lacquer-web-'));
  try {
    return use(folder);
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** A glTF file of examples/ with its images in it, or with those that one material has: a scene from memory reads no others. */
export function withImages(json, material) {
  const gltf = JSON.parse(json);
  const wanted = new Set();
  JSON.stringify(material === undefined ? gltf.materials : gltf.materials[material], (name, value) => {
    if (/texture$/i.test(name) && value) wanted.add(gltf.images[gltf.textures[value.index].source]);
    return value;
  });
  for (const each of wanted) {
    if (each.uri.startsWith('data:')) continue;
    each.uri = `data:image/png;base64,${readFileSync(join(root, 'examples', each.uri)).toString('base64')}`;
  }
  return JSON.stringify(gltf);
}

export const read = (file) => readFileSync(resolve(root, file));
