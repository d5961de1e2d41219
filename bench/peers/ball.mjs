// The scene in which a work is drawn: a ball, one directional light and a camera, as glTF and as points for `lacquer eval`.
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { deflateSync } from 'node:zlib';

/** Pixels of the picture's side. */
export const kSize = 128;
/** Indices of the ball's mesh: no other draw call of a page has as many. */
export const kColumns = 256, kRows = 128, kIndices = kColumns * kRows * 6;
/** Radiance of the environment, which is the same from all sides, and irradiance of the light at a right angle. */
export const kEnvironment = 0.5, kLight = 3;
/** Cosine of the view angle from which on pixels are compared: at the rim a mesh is not a ball. */
const kLeastCosine = 0.1;
const kFieldOfView = Math.PI / 6;
const kDistance = 1.05 / Math.sin(kFieldOfView / 2);

const normalize = (v) => v.map((x) => x / Math.hypot(...v));
export const kToLight = normalize([0.4, 0.5, 0.77]);
/** Where the camera stands. */
export const kViewer = [0, 0, kDistance];

/** What the images of the works hold, one colour each: every filter gives it back. */
const kTexels = {
  'base_color.png': [200, 180, 160],
  'metallic_roughness.png': [255, 200, 220],
  'normal.png': [150, 110, 250],
  'coat.png': [230, 230, 230],
  'coat_roughness.png': [180, 180, 180],
  'coat_normal.png': [105, 140, 250],
};

/** Along growing u, which is the longitude. */
const tangentOf = ([x, , z]) => (Math.hypot(x, z) < 1e-9 ? [0, 0, -1] : normalize([z, 0, -x]));

function vertices() {
  const data = { POSITION: [], NORMAL: [], TANGENT: [], TEXCOORD_0: [] };
  for (let row = 0; row <= kRows; ++row) {
    for (let column = 0; column <= kColumns; ++column) {
      const longitude = (2 * Math.PI * column) / kColumns, polar = (Math.PI * row) / kRows;
      const n = [Math.sin(polar) * Math.sin(longitude), Math.cos(polar), Math.sin(polar) * Math.cos(longitude)];
      data.POSITION.push(...n);
      data.NORMAL.push(...n);
      data.TANGENT.push(Math.cos(longitude), 0, -Math.sin(longitude), 1);
      data.TEXCOORD_0.push(column / kColumns, row / kRows);
    }
  }
  return data;
}

function indices() {
  const list = [];
  for (let row = 0; row < kRows; ++row) {
    for (let column = 0; column < kColumns; ++column) {
      const a = row * (kColumns + 1) + column, b = a + kColumns + 1;
      list.push(a, b, a + 1, a + 1, b, b + 1);
    }
  }
  return Uint16Array.from(list);
}

/** The checksum of PNG's chunks: zlib's own is newer than some Node that runs this. */
function crc32(bytes) {
  let crc = -1;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

/** A PNG with 8 bits for each of RGB; `texel(x, y)` gives three. */
export function png(width, height, texel) {
  const chunk = (type, body) => {
    const data = Buffer.concat([Buffer.from(type), body]);
    const framed = Buffer.alloc(data.length + 8);
    framed.writeUInt32BE(body.length, 0);
    data.copy(framed, 4);
    framed.writeUInt32BE(crc32(data), data.length + 4);
    return framed;
  };
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([8, 2], 8);  // bits, RGB
  const line = 3 * width + 1, rows = Buffer.alloc(height * line);
  let above = new Uint8Array(3 * width);
  for (let y = 0; y < height; ++y) {
    const now = Uint8Array.from([...Array(width).keys()].flatMap((x) => texel(x, y)));
    rows[y * line] = 2;  // what follows is the difference to the row above
    for (let i = 0; i < now.length; ++i) rows[y * line + 1 + i] = now[i] - above[i];
    above = now;
  }
  const pixels = deflateSync(rows, { level: 9 });
  const magic = Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]);
  return Buffer.concat([magic, chunk('IHDR', header), chunk('IDAT', pixels), chunk('IEND', Buffer.alloc(0))]);
}

/** The ball's buffers, views and accessors, for the attributes that the work's primitive has. */
function mesh(attributes) {
  const kTypes = { POSITION: 'VEC3', NORMAL: 'VEC3', TANGENT: 'VEC4', TEXCOORD_0: 'VEC2' };
  const all = vertices(), parts = [], gltf = { bufferViews: [], accessors: [] };
  let offset = 0;
  const add = (bytes, target, accessor) => {
    gltf.accessors.push({ bufferView: gltf.bufferViews.length, ...accessor });
    gltf.bufferViews.push({ buffer: 0, byteOffset: offset, byteLength: bytes.length, target });
    parts.push(bytes);
    offset += bytes.length;
  };
  const places = {};
  for (const name of attributes) {
    const values = Float32Array.from(all[name]), count = (kColumns + 1) * (kRows + 1);
    places[name] = gltf.accessors.length;
    const range = name === 'POSITION' ? { min: [-1, -1, -1], max: [1, 1, 1] } : {};
    add(Buffer.from(values.buffer), 34962, { componentType: 5126, count, type: kTypes[name], ...range });
  }
  const list = indices();
  add(Buffer.from(list.buffer), 34963, { componentType: 5123, count: list.length, type: 'SCALAR' });
  gltf.buffers = [{ uri: 'ball.bin', byteLength: offset }];
  return { gltf, bytes: Buffer.concat(parts), primitive: { attributes: places, indices: gltf.accessors.length - 1 } };
}

/** The rotation that takes +Z to the light: a light shines along -Z. */
function lightRotation() {
  const [x, y, z] = kToLight;
  return normalize([-y, x, 0, 1 + z]);
}

/** What lets light through. */
const kClear = ['KHR_materials_transmission', 'ADOBE_materials_thin_transparency'];

/** A wall behind the ball that shines as the environment does, so that who looks through the ball sees what is around it. */
function addWall(scene, buffer) {
  const corners = [-1, -1, 1, -1, 1, 1, -1, -1, 1, 1, -1, 1].map((x) => 30 * x);
  const bytes = Buffer.from(Float32Array.from(corners.flatMap((x, i) => (i % 2 ? [x, -2] : [x]))).buffer);
  const view = scene.bufferViews.length, accessor = scene.accessors.length;
  scene.bufferViews.push({ buffer: 0, byteOffset: buffer.length, byteLength: bytes.length, target: 34962 });
  scene.accessors.push({ bufferView: view, componentType: 5126, count: 6, type: 'VEC3', min: [-30, -30, -2], max: [30, 30, -2] });
  scene.buffers[0].byteLength += bytes.length;
  const shines = { baseColorFactor: [kEnvironment, kEnvironment, kEnvironment, 1] };
  scene.materials = [...scene.materials, { name: 'wall', pbrMetallicRoughness: shines, extensions: { KHR_materials_unlit: {} } }];
  scene.meshes.push({ primitives: [{ attributes: { POSITION: accessor }, material: scene.materials.length - 1 }] });
  scene.nodes.push({ mesh: 1 });
  scene.scenes[0].nodes.push(scene.nodes.length - 1);
  scene.extensionsUsed = [...new Set([...scene.extensionsUsed, 'KHR_materials_unlit'])];
  return Buffer.concat([buffer, bytes]);
}

/** Writes the ball in the material of a work; its path. Materials may be exchanged before: see works.mjs. */
export function writeScene(folder, work) {
  mkdirSync(folder, { recursive: true });
  const made = mesh(Object.keys(work.meshes[0].primitives[0].attributes)), { gltf, primitive } = made;
  let { bytes } = made;
  const scene = {
    ...work, ...gltf,
    extensionsUsed: [...(work.extensionsUsed ?? []), 'KHR_lights_punctual'],
    extensions: { KHR_lights_punctual: { lights: [{ type: 'directional', color: [1, 1, 1], intensity: kLight }] } },
    scenes: [{ nodes: [0, 1, 2] }],
    nodes: [
      { mesh: 0 },
      { camera: 0, translation: [0, 0, kDistance] },
      { rotation: lightRotation(), extensions: { KHR_lights_punctual: { light: 0 } } },
    ],
    meshes: [{ primitives: [{ ...primitive, material: 0 }] }],
    cameras: [{ type: 'perspective', perspective: { yfov: kFieldOfView, aspectRatio: 1, znear: 0.1, zfar: 100 } }],
  };
  if (work.wall && kClear.some((name) => work.extensionsUsed.includes(name))) bytes = addWall(scene, bytes);
  delete scene.wall;
  writeFileSync(join(folder, 'ball.bin'), bytes);
  for (const [i, { uri }] of (work.images ?? []).entries()) {
    // What is in the file itself lies beside it, too, under the name that a MaterialX document of it says.
    const inside = /^data:image\/png;base64,(.*)$/.exec(uri);
    if (inside) writeFileSync(join(folder, `image_${i}.png`), Buffer.from(inside[1], 'base64'));
    else writeFileSync(join(folder, uri), png(4, 4, () => kTexels[uri]));
  }
  writeFileSync(join(folder, 'ball.gltf'), JSON.stringify(scene, null, 1));
  return join(folder, 'ball.gltf');
}

/** A Radiance picture of the environment: exponent 128 means a factor of 1/256. */
export function writeEnvironment(file) {
  const width = 64, height = 32;
  const texel = Buffer.from([kEnvironment * 256, kEnvironment * 256, kEnvironment * 256, 128]);
  const header = `#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`;
  const line = Buffer.concat([Buffer.from([2, 2, 0, width]), ...[...texel].map((byte) => Buffer.from([128 + width, byte]))]);
  writeFileSync(file, Buffer.concat([Buffer.from(header), ...Array(height).fill(line)]));
}

/** What a sheen of white reflects of an environment of radiance 1: KHR_materials_sheen's distribution and masking. */
function sheenAlbedo(cosine, roughness) {
  const alpha = Math.max(roughness * roughness, 1e-3), kSteps = 24;
  const fit = (x) => {
    const t = (1 - alpha) ** 2, mix = (p, q) => t * p + (1 - t) * q;
    const steep = mix(25.3245, 21.5473) / (1 + mix(3.32435, 3.82987) * x ** mix(0.16801, 0.19823));
    return steep + mix(-1.27393, -1.9776) * x + mix(-4.85967, -4.32054);
  };
  const lambda = (x) => Math.exp(x < 0.5 ? fit(x) : 2 * fit(0.5) - fit(1 - x));
  const sine = Math.sqrt(1 - cosine * cosine);
  let sum = 0;
  for (let i = 0; i < kSteps; ++i) {
    for (let j = 0; j < kSteps; ++j) {
      const z = (i + 0.5) / kSteps, r = Math.sqrt(1 - z * z), phi = (Math.PI * (j + 0.5)) / kSteps;
      const h = normalize([r * Math.cos(phi) + sine, r * Math.sin(phi), z + cosine]);
      const distribution = ((2 + 1 / alpha) * (1 - h[2] * h[2]) ** (0.5 / alpha)) / (2 * Math.PI);
      sum += distribution / ((1 + lambda(z) + lambda(cosine)) * 4 * cosine);
    }
  }
  return (sum * 2 * Math.PI) / (kSteps * kSteps);
}

/** The table that the Khronos renderer is handed by its application: columns are cosines, rows are roughness. */
export function writeSheenTable(file) {
  const kTable = 32;
  writeFileSync(file, png(kTable, kTable, (x, y) => {
    const value = Math.round(255 * Math.min(1, sheenAlbedo((x + 0.5) / kTable, (y + 0.5) / kTable)));
    return [value, value, value];
  }));
}

/** What of the ball each pixel shows, from below as WebGL reads it: points for `lacquer eval`, and their pixels' numbers. */
export function points(environment) {
  const list = [], pixels = [];
  const slope = Math.tan(kFieldOfView / 2);
  for (let pixel = 0; pixel < kSize * kSize; ++pixel) {
    const x = ((pixel % kSize) + 0.5) / kSize, y = (Math.floor(pixel / kSize) + 0.5) / kSize;
    const ray = normalize([(2 * x - 1) * slope, (2 * y - 1) * slope, -1]);
    const along = -ray[2] * kDistance, inside = along * along - (kDistance * kDistance - 1);
    if (inside < 0) continue;
    const n = ray.map((r, axis) => r * (along - Math.sqrt(inside)) + (axis === 2 ? kDistance : 0));
    const v = ray.map((r) => -r);
    if (n[0] * v[0] + n[1] * v[1] + n[2] * v[2] < kLeastCosine) continue;
    const point = { n, t: [...tangentOf(n), 1], v, l: kToLight, light: [kLight, kLight, kLight] };
    if (environment) point.env = [kEnvironment, kEnvironment, kEnvironment];
    list.push(point);
    pixels.push(pixel);
  }
  return { list, pixels };
}

export const readWork = (file) => JSON.parse(readFileSync(file, 'utf8'));
