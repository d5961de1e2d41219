// The gallery: the materials of gallery.gltf on the same ball, ours and the peers', and what each makes of an extension: the
// picture with it, and without.
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { kIndices, kSize, points, readWork, writeScene } from './ball.mjs';
import { distance, ourColors, run } from './measure.mjs';
import { kGalleryPeers } from './works.mjs';

const kFile = 'gallery.gltf';
/** A change of the mean of the picture below which nobody sees what an extension does. */
const kLeastEffect = 1e-4;

/** A value without the extensions that are named, wherever they stand, and without what is empty then. */
export function withoutExtensions(value, names) {
  if (Array.isArray(value)) return value.map((each) => withoutExtensions(each, names));
  if (typeof value !== 'object' || value === null) return value;
  const rest = Object.entries(value).flatMap(([key, each]) => {
    if (key !== 'extensions') return [[key, withoutExtensions(each, names)]];
    const kept = Object.entries(each).filter(([name]) => !names.includes(name));
    return kept.length ? [[key, withoutExtensions(Object.fromEntries(kept), names)]] : [];
  });
  return Object.fromEntries(rest);
}

/** The names of all extensions in a value. */
export function extensionsIn(value) {
  if (typeof value !== 'object' || value === null) return [];
  return [...new Set(Object.entries(value).flatMap(([key, each]) => [...(key === 'extensions' ? Object.keys(each) : []), ...extensionsIn(each)]))];
}

const nameTextures = (material) => /"[a-z]\w*Texture":/i.test(JSON.stringify(material));

/** A material as a work: what writeScene() puts on the ball. */
function workOf(file, { extras, name, ...material }, drop) {
  const textures = nameTextures(material) && { textures: withoutExtensions(file.textures, drop), images: file.images };
  const parts = { materials: [withoutExtensions({ name: 'ball', ...material }, drop)], ...textures };
  return {
    asset: { version: '2.0' }, wall: true, ...parts, extensionsUsed: extensionsIn(parts),
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1, TANGENT: 2, TEXCOORD_0: 3 } }] }],
  };
}

/** The materials: { name, of, section, says, work, without }; `without` is null for core glTF. */
export function readGallery(folder) {
  const file = readWork(join(folder, kFile));
  return file.materials.map((material) => {
    const { name, extras: { of, section, says } } = material;
    return { name, of, section, says, work: workOf(file, material, []), without: of.length ? workOf(file, material, of) : null };
  });
}

/**
 * How far the extension's effect on their picture is from its effect on ours, as a part of the latter, and the latter: means of
 * all channels and pixels. `pictures` are functions of a pixel's place in the list.
 */
export function effect(count, { ours, oursWithout, theirs, theirsWithout }) {
  let apart = 0, own = 0;
  for (let i = 0; i < count; ++i) {
    for (let channel = 0; channel < 3; ++channel) {
      const does = ours(i)[channel] - oursWithout(i)[channel];
      own += Math.abs(does);
      apart += Math.abs(theirs(i)[channel] - theirsWithout(i)[channel] - does);
    }
  }
  return { own: own / (3 * count), apart: own / (3 * count) < kLeastEffect ? null : apart / own };
}

const rounded = (x) => (x === null ? null : Number(x.toPrecision(3)));

class Gallery {
  constructor({ root, lacquer, output, mx, shadersOf, asFor }) {
    Object.assign(this, { root, lacquer, output, mx, shadersOf, asFor });
    this.points = points(true);
    this.points.list.forEach((point) => (point.uv0 = uvOf(point.n)));
    this.pictures = new Map();
  }

  key(work) {
    return createHash('sha256').update(JSON.stringify(work)).digest('hex').slice(0, 12);
  }

  scene(who, work) {
    const folder = join('scenes/gallery', who, this.key(work));
    return { file: writeScene(join(this.output, folder), work), url: `/${folder}/ball.gltf` };
  }

  ours(work) {
    const key = `ours ${this.key(work)}`;
    if (!this.pictures.has(key)) this.pictures.set(key, ourColors(this.lacquer, this.scene('ours', { ...work, wall: false }).file, this.points.list));
    return this.pictures.get(key);
  }

  /** { pixels, text }, or { problem } where the peer cannot; `text` is all that its shader is given. */
  async theirs(page, peer, work) {
    const key = `${peer.name} ${this.key(work)}`;
    if (!this.pictures.has(key)) this.pictures.set(key, await this.draw(page, peer, work).catch((error) => ({ problem: error.message })));
    return this.pictures.get(key);
  }

  async draw(page, peer, work) {
    const { url } = this.scene(peer.name, this.asFor(peer, '', work));
    let shaders = null;
    if (peer.environment) {
      const { file } = this.scene('document', { ...work, wall: false });
      shaders = await this.shadersOf(this.mx, run(this.lacquer, 'graph', file, '--format', 'mtlx'), peer.environment);
    }
    const asked = { scene: url, environment: true, size: kSize, indices: kIndices, openpbr: Boolean(peer.openpbr), shaders };
    const { source, bound, pixels } = await page.draw(asked);
    return { pixels, source, text: JSON.stringify([source, bound]) };
  }
}

/** As the ball's mesh has it: along the longitude, and from the upper pole. */
function uvOf([x, y, z]) {
  const turn = Math.atan2(x, z) / (2 * Math.PI);
  return [turn < 0 ? turn + 1 : turn, Math.acos(Math.max(-1, Math.min(1, y))) / Math.PI];
}

const knows = (drawn, plain) => drawn.text !== plain.text || drawn.pixels.some((x, i) => x !== plain.pixels[i]);

/** What is recorded of a peer's picture of a material. */
function figures(gallery, entry, drawn, plain) {
  const { pixels } = gallery.points, ours = gallery.ours(entry.work);
  const { mean, max } = distance(ours, drawn.pixels, pixels);
  if (!plain) return { mean, max };
  const at = (picture) => (i) => picture.slice(4 * pixels[i], 4 * pixels[i] + 3);
  const before = gallery.ours(entry.without);
  const { apart } = effect(pixels.length, {
    ours: (i) => ours[i], oursWithout: (i) => before[i], theirs: at(drawn.pixels), theirsWithout: at(plain.pixels),
  });
  return { mean, max, effect_apart: rounded(apart), knows: knows(drawn, plain) };
}

async function drawAll(gallery, entries, peer, page) {
  const found = {};
  for (const entry of entries) {
    const drawn = await gallery.theirs(page, peer, entry.work);
    const plain = entry.without && (await gallery.theirs(page, peer, entry.without));
    const problem = drawn.problem ?? plain?.problem;
    found[entry.name] = problem ? { problem } : figures(gallery, entry, drawn, plain);
    if (problem) console.error(`bench peers: gallery: ${peer.title}: ${entry.name}: ${problem}`);
  }
  return found;
}

/** Ours alone: the mean of the picture, and what the extension changes in it. */
function ownFigures(gallery, entry) {
  const ours = gallery.ours(entry.work), count = gallery.points.pixels.length;
  const mean = ours.reduce((sum, [r, g, b]) => sum + r + g + b, 0) / (3 * count);
  if (!entry.without) return { mean: rounded(mean) };
  const before = gallery.ours(entry.without), same = (i) => ours[i];
  const { own } = effect(count, { ours: same, oursWithout: (i) => before[i], theirs: same, theirsWithout: same });
  return { mean: rounded(mean), effect: rounded(own) };
}

/**
 * Draws all of it: the record's `materials`, and the rows of the sheets. `pageOf(name)` opens a peer's page.
 */
export async function drawGallery({ peers, pageOf, ...how }) {
  const gallery = new Gallery(how), entries = readGallery(join(how.root, 'bench/peers'));
  const materials = Object.fromEntries(entries.map((entry) => [entry.name, { ours: ownFigures(gallery, entry), peers: {} }]));
  const shown = kGalleryPeers.filter(({ name }) => peers.some((peer) => peer.name === name));
  for (const peer of shown) {
    const page = await pageOf(peer.page);
    const found = await drawAll(gallery, entries, peer, page);
    for (const [name, each] of Object.entries(found)) materials[name].peers[peer.name] = each;
    await page.close();
    console.error(`bench peers: gallery: ${peer.title}`);
  }
  const rows = entries.map(({ work }) => ({
    ours: gallery.ours(work), pixels: gallery.points.pixels,
    theirs: shown.map((peer) => gallery.pictures.get(`${peer.name} ${gallery.key(work)}`)?.pixels),
  }));
  keep(gallery);
  return { materials, rows };
}

/** The pictures as they were drawn, 32-bit floats, and the shaders, for whoever looks closer. */
function keep({ output, pictures, key }) {
  mkdirSync(join(output, 'gallery'), { recursive: true });
  for (const [name, picture] of pictures) {
    const numbers = picture.pixels ?? (Array.isArray(picture) ? picture.flat() : null);
    const file = join(output, 'gallery', name.replace(' ', '-'));
    if (numbers) writeFileSync(`${file}.f32`, Buffer.from(Float32Array.from(numbers).buffer));
    if (picture.source) writeFileSync(`${file}.frag`, picture.source);
  }
}
