// From a peer's shader to its costs and its colours' distance from ours.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { vulkanGlsl } from './convert.mjs';

/** Runs a program; what it said is in the error where it fails. */
export function run(program, ...args) {
  try {
    return execFileSync(program, args, { encoding: 'utf8', maxBuffer: 1 << 28, stdio: ['ignore', 'pipe', 'pipe'] });
  } catch (error) {
    const said = `${error.stdout ?? ''}${error.stderr ?? ''}`.trim().split('\n').slice(0, 4).join('; ');
    throw new Error(`${program}: ${said || error.message}`);
  }
}

/** Writes `path`.frag, .spv and .frag.spv: GLSL 4.50, what glslang makes of it, and that after `spirv-opt -O`. */
export function compile(source, path) {
  mkdirSync(dirname(path), { recursive: true });
  writeFileSync(`${path}.es.frag`, source);
  writeFileSync(`${path}.frag`, vulkanGlsl(source));
  run('glslangValidator', '-V', '-R', '--auto-map-bindings', '--auto-map-locations', '-o', `${path}.spv`, `${path}.frag`);
  run('spirv-opt', '-O', `${path}.spv`, '-o', `${path}.frag.spv`);
  run('spirv-val', '--target-env', 'vulkan1.0', `${path}.frag.spv`);
  return `${path}.frag.spv`;
}

/** Bytes of a module without names. */
function bytesOf(module) {
  const bare = `${module}.bare`;
  run('spirv-opt', '--strip-debug', module, '-o', bare);
  const { size } = statSync(bare);
  rmSync(bare);
  return size;
}

/** Our fragment shader for a work, as bench/cost.json has its cost. */
export function ourModule(lacquer, file, ibl, folder) {
  rmSync(folder, { recursive: true, force: true });
  const flags = ['--lights', 'directional:1', '--target', 'spirv', '--quiet', ...(ibl ? [] : ['--no-ibl'])];
  run(lacquer, 'gen', file, '-o', folder, ...flags);
  const modules = readdirSync(join(folder, 'spirv')).filter((name) => name.endsWith('.frag.spv'));
  if (modules.length !== 1) throw new Error(`${file}: ${modules.length} fragment shaders, not one`);
  return join(folder, 'spirv', modules[0]);
}

/** What `lacquer gen` says of what it wrote into a folder. */
export const readManifest = (folder) => JSON.parse(readFileSync(join(folder, 'manifest.json'), 'utf8'));

/** Of modules, in their order: their bytes, and milliseconds in which the driver makes a pipeline of each. */
export function sizes(bench, modules) {
  const times = JSON.parse(run(bench, 'drivers', ...modules));
  return modules.map((module, i) => ({ bytes: bytesOf(module), driver_ms: Number(times[i].toPrecision(3)) }));
}

/** What `lacquer cost` says of modules, in their order, with the fields of bench/cost.json. */
export function costs(lacquer, modules) {
  const { shaders } = JSON.parse(run(lacquer, 'cost', '--json', ...modules));
  return shaders.map(({ shader, spirv_instructions, gpus }, i) => {
    const row = { spirv_instructions };
    for (const family of ['navi21', 'gfx1100']) {
      const got = gpus?.[family];
      if (!got?.instructions) throw new Error(`${modules[i]}: ${got?.problem ?? `${family} did not compile ${shader}`}`);
      const { instructions, inverse_throughput, latency, vgprs, sgprs, spilled_sgprs, spilled_vgprs } = got;
      row[family] = { instructions, inverse_throughput, latency, vgprs, sgprs, spilled: spilled_sgprs + spilled_vgprs };
    }
    return row;
  });
}

/** The driver that `lacquer cost` finds where Debian's is installed: "Mesa 22.3.6". */
export function driver() {
  const version = run('dpkg-query', '-W', '-f=${Version}', 'mesa-vulkan-drivers');
  return `Mesa ${/^[\d.]+/.exec(version)?.[0] ?? version}`;
}

/** Our colours at the points, in double: rows of RGBA. */
export function ourColors(lacquer, scene, points) {
  const file = join(dirname(scene), 'points.json');
  writeFileSync(file, JSON.stringify(points));
  return JSON.parse(run(lacquer, 'eval', scene, '--points', file)).rgba;
}

/** How far theirs are from ours, in linear RGB: mean and largest distance of a channel, and the mean of ours. */
export function distance(ours, theirs, pixels) {
  let sum = 0, sumOfOurs = 0, max = 0;
  for (const [i, pixel] of pixels.entries()) {
    for (let channel = 0; channel < 3; ++channel) {
      const apart = Math.abs(ours[i][channel] - theirs[4 * pixel + channel]);
      if (!Number.isFinite(apart)) throw new Error(`no number at pixel ${pixel}`);
      sum += apart;
      sumOfOurs += ours[i][channel];
      max = Math.max(max, apart);
    }
  }
  const count = 3 * pixels.length, rounded = (x) => Number(x.toPrecision(3));
  return { mean: rounded(sum / count), max: rounded(max), mean_of_ours: rounded(sumOfOurs / count) };
}

export const versionOf = (modules, name) => JSON.parse(readFileSync(join(modules, name, 'package.json'), 'utf8')).version;
