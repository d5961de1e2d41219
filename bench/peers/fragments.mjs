// What a fragment of a shader takes on a driver that runs shaders on the processor: the module's interface, and for each part
// of it what the page had bound when it drew the ball.
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { kEnvironment, kLight, kToLight, kViewer } from './ball.mjs';
import { run } from './measure.mjs';

/** Turns that each shader has; the least counts. */
const kRounds = 12;

const kOp = { name: 5, memberName: 6, int: 21, float: 22, vector: 23, matrix: 24, image: 25, sampledImage: 27, array: 28, struct: 30,
  pointer: 32, constant: 43, variable: 59, decorate: 71, memberDecorate: 72 };
const kDecoration = { arrayStride: 6, matrixStride: 7, location: 30, binding: 33, set: 34, offset: 35 };
const kStorage = { constant: 0, input: 1, uniform: 2 };

const textAt = (words, from) => {
  const bytes = Buffer.from(words.buffer, words.byteOffset + 4 * from);
  return bytes.toString('utf8', 0, bytes.indexOf(0));
};

/** The instructions before the first function, by what they say of an id. */
function read(words) {
  const said = { names: {}, members: {}, types: {}, constants: {}, marks: {}, memberMarks: {}, variables: [] };
  const known = new Set([kOp.int, kOp.float, kOp.vector, kOp.matrix, kOp.image, kOp.sampledImage, kOp.array, kOp.struct, kOp.pointer]);
  for (let at = 5; at < words.length; at += words[at] >>> 16) {
    const op = words[at] & 0xffff, rest = words.subarray(at + 1, at + (words[at] >>> 16));
    if (op === kOp.name) said.names[rest[0]] = textAt(words, at + 2);
    else if (op === kOp.memberName) (said.members[rest[0]] ??= {})[rest[1]] = textAt(words, at + 3);
    else if (op === kOp.decorate) (said.marks[rest[0]] ??= {})[rest[1]] = rest[2];
    else if (op === kOp.memberDecorate) ((said.memberMarks[rest[0]] ??= {})[rest[1]] ??= {})[rest[2]] = rest[3];
    else if (op === kOp.constant) said.constants[rest[1]] = rest[2];
    else if (op === kOp.variable) said.variables.push({ id: rest[1], type: rest[0], storage: rest[2] });
    else if (known.has(op)) said.types[rest[0]] = { op, of: [...rest.subarray(1)] };
  }
  return said;
}

/** A type's tree: { kind: 'number', whole }, { kind: 'vector', count, of }, … with offsets and strides. */
function typeOf(said, id) {
  const { op, of } = said.types[id], marks = said.marks[id] ?? {};
  if (op === kOp.float || op === kOp.int) return { kind: 'number', whole: op === kOp.int };
  if (op === kOp.vector) return { kind: 'vector', of: typeOf(said, of[0]), count: of[1] };
  if (op === kOp.matrix) return { kind: 'matrix', of: typeOf(said, of[0]), count: of[1] };
  if (op === kOp.array) {
    return { kind: 'array', of: typeOf(said, of[0]), count: said.constants[of[1]], stride: marks[kDecoration.arrayStride] };
  }
  if (op !== kOp.struct) throw new Error(`${said.names[id] ?? id} is of a type that no block has`);
  return {
    kind: 'struct', name: said.names[id],
    members: of.map((member, i) => {
      const marked = said.memberMarks[id]?.[i] ?? {};
      const type = { ...typeOf(said, member), step: marked[kDecoration.matrixStride] };
      return { name: said.members[id]?.[i] ?? `${i}`, offset: marked[kDecoration.offset] ?? 0, type };
    }),
  };
}

/** By SPIR-V's dimensions: two, three, a cube. */
function shapeOf([, dimension, , arrayed]) {
  return arrayed ? 'array' : ({ 1: 'plane', 2: 'volume', 3: 'cube' })[dimension];
}

/** What a module reads: { inputs, blocks, textures }. */
export function interfaceOf(bytes) {
  const words = new Uint32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  const said = read(words), found = { inputs: [], blocks: [], textures: [] };
  for (const { id, type, storage } of said.variables) {
    const marks = said.marks[id] ?? {}, to = said.types[type].of[1], name = said.names[id] ?? '';
    const place = { set: marks[kDecoration.set] ?? 0, binding: marks[kDecoration.binding] };
    if (storage === kStorage.input && kDecoration.location in marks) {
      found.inputs.push({ name, location: marks[kDecoration.location], type: typeOf(said, to) });
    } else if (storage === kStorage.uniform) {
      found.blocks.push({ ...place, type: typeOf(said, to) });
    } else if (storage === kStorage.constant) {
      const { op, of } = said.types[to];
      if (op !== kOp.sampledImage) throw new Error(`${name} is no texture with a sampler`);
      found.textures.push({ name, ...place, shape: shapeOf(said.types[of[0]].of) });
    }
  }
  found.inputs.sort((a, b) => a.location - b.location);
  return found;
}

const sizeOf = (type) => {
  if (type.kind === 'number') return 4;
  if (type.kind === 'vector') return 4 * type.count;
  if (type.kind === 'matrix') return (type.step ?? 16) * type.count;
  if (type.kind === 'array') return type.stride * type.count;
  return Math.max(...type.members.map(({ offset, type: of }) => offset + sizeOf(of)));
};

/** A block's bytes of values by their paths, `lights[0].direction`; what has none is nought. */
export function blockBytes(type, values) {
  const bytes = Buffer.alloc(sizeOf(type));
  const put = (of, at, path) => {
    if (of.kind === 'struct') {
      for (const member of of.members) put(member.type, at + member.offset, path ? `${path}.${member.name}` : member.name);
    } else if (of.kind === 'array') {
      for (let i = 0; i < of.count; ++i) put({ ...of.of, step: of.step }, at + i * of.stride, `${path}[${i}]`);
    } else {
      const given = [values[path] ?? []].flat(), rows = of.kind === 'matrix' ? of.of.count : of.count ?? 1;
      const whole = of.whole ?? of.of.whole ?? of.of.of?.whole;
      given.forEach((x, i) => {
        const to = at + Math.floor(i / rows) * (of.step ?? 16) + (i % rows) * 4;
        if (whole) bytes.writeInt32LE(Number(x), to);
        else bytes.writeFloatLE(Number(x), to);
      });
    }
  };
  put(type, 0, '');
  return bytes;
}

const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);

/** The ball's surface at a place of its picture, -1 to 1: what shaders get of it, in the world, which is the camera's space but for its place. */
function surface(x, y) {
  const z = Math.sqrt(1 - x * x - y * y), normal = [x, y, z], along = Math.hypot(x, z);
  const tangent = [z / along, 0, -x / along];
  return { normal, tangent: [...tangent, 1], bitangent: cross(normal, tangent), position: [...normal, 1], uv: [0.5 + x / 2, 0.5 + y / 2],
    toEye: kViewer.map((e, i) => e - normal[i]), color: [1, 1, 1, 1],
    irradiance: [kEnvironment, kEnvironment, kEnvironment], one: [1] };
}

/** The middle of the ball: upper left, upper right, lower left. Between them inputs are affine. */
const kCorners = [surface(-0.5, 0.5), surface(0.5, 0.5), surface(-0.5, -0.5)];

/** What inputs are called, by all who are measured; Babylon.js makes the diffuse environment in its vertex stage. */
const kMeanings = [
  [/uv|texcoord/i, 'uv'], [/to_?eye|viewposition/i, 'toEye'], [/bitangent|binormal/i, 'bitangent'], [/tangent/i, 'tangent'],
  [/normal/i, 'normal'], [/position/i, 'position'], [/irradiance/i, 'irradiance'], [/color/i, 'color'], [/volume_length/, 'one'],
];

/** The values of an input at the corners, one entry for each location that it takes. */
export function inputValues({ name, type }) {
  const one = (meaning, count) => ({ components: count, values: kCorners.flatMap((corner) => corner[meaning].slice(0, count)) });
  if (type.kind === 'matrix' && /tbn/i.test(name)) return ['tangent', 'bitangent', 'normal'].map((meaning) => one(meaning, 3));
  const meaning = kMeanings.find(([pattern]) => pattern.test(name))?.[1];
  if (!meaning || type.kind === 'matrix') throw new Error(`nobody knows what the input ${name} is`);
  return [one(meaning, type.count ?? 1)];
}

/**
 * A sweep of `lacquer_bench fragments`. `bound` has what the draw had: `uniforms` by path, and `blocks`, bytes by the block's
 * name. Blocks that it does not name are filled from the uniforms.
 */
export function sweepOf(file, { uniforms, blocks }) {
  const found = interfaceOf(readFileSync(file));
  return {
    file, textures: found.textures,
    inputs: found.inputs.flatMap(inputValues),
    blocks: found.blocks.map(({ set, binding, type }) => ({ set, binding, bytes: [...(blocks[type.name] ?? blockBytes(type, uniforms))] })),
  };
}

/** What is bound to one of our shaders: the fields of the forward template's blocks, and the material's. */
export function ourBound(manifest) {
  const [use] = manifest.files[0].materials[0].uses, unit = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  return {
    blocks: {},
    uniforms: {
      view_projection: unit, model: unit, view: unit, camera_position: kViewer, environment_intensity: 1, environment_max_lod: 4, light_count: 1,
      'lights[0].position': kToLight, 'lights[0].radiance': [kLight, kLight, kLight], ...use.uniforms,
    },
  };
}

/** Nanoseconds of a fragment for each of the sweeps, in turns, and the device. */
export function fragmentTimes(bench, sweeps, folder) {
  const file = join(folder, 'fragments.json');
  writeFileSync(file, JSON.stringify({ rounds: kRounds, sweeps }));
  const { device, nanoseconds } = JSON.parse(run(bench, 'fragments', file));
  return { device, nanoseconds: nanoseconds.map((x) => Number(x.toPrecision(3))) };
}
