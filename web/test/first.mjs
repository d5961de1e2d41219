// How long the module takes, in a process that has compiled nothing of it yet: milliseconds of this thread on a processor,
// where the system tells them (a machine may have other work), else by the clock. Prints JSON.
//   node web/test/first.mjs [FILE [index|compiler]]
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { output, read } from './native.mjs';

function spent() {
  try {
    return Number(readFileSync('/proc/thread-self/schedstat', 'utf8').split(' ')[0]) / 1e6;
  } catch {
    return performance.now();
  }
}

const entry = process.argv[3] ?? 'index';
const { load } = await import(join(output, `package/${entry}.js`));
const bytes = read(process.argv[2] ?? 'examples/car_paint.gltf');
const wasm = readFileSync(join(output, entry === 'compiler' ? 'package/lacquer-compiler.wasm' : 'package/lacquer.wasm'));
const begin = spent();
const library = await load(await WebAssembly.compile(wasm));
const loaded = spent() - begin;

/** From the file to the ESSL of its first material: reading it, its graph, its shader. */
function once() {
  const times = [spent()];
  const scene = library.scene(bytes, 'file.gltf');
  times.push(spent());
  const graph = scene.graph(0);
  times.push(spent());
  const shader = graph.generate({ targets: ['essl'] });
  shader.text('essl', 'fragment');
  times.push(spent());
  for (const handle of [shader, graph, scene]) handle.free();
  const parts = times.slice(1).map((time, i) => time - times[i]);
  return { all: times[3] - times[0], parts };
}

const first = once();
/** Of several: the system may count in ticks. */
function mean() {
  const kRuns = 10;
  const begin = spent();
  for (let i = 0; i < kRuns; ++i) once();
  return (spent() - begin) / kRuns;
}
// So many that the engine has optimized what there is to optimize.
const later = Math.min(...Array.from({ length: 40 }, mean));
console.log(JSON.stringify({ loaded, first: first.all, parts: first.parts, later }));
