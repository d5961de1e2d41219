// Slots of textures: a picture for each, how it lies and how it is read.
import type { Document } from './document';
import { h } from './dom';
import { image, sourceOf, type GltfFile } from '../src/gltf';
import { item, list } from '../src/json';

/** Pixels of a thumbnail's side. */
const kThumbnail = 40;
const kWraps: [number, string][] = [[10497, 'repeats'], [33648, 'mirrored'], [33071, 'clamped']];
const kFilters: [number, string][] = [[9729, 'linear'], [9728, 'nearest']];
const kTransform = 'KHR_texture_transform';
export const kPictures = /\.(png|jpe?g|webp|avif)$/i;

export interface Slot {
  name: string;
  /** Of the textureInfo. */
  pointer: string;
  srgb: boolean;
  channels: string;
  meaning: string;
}
export interface SlotActs {
  changed: (structure: boolean) => void;
  fail: (error: unknown) => void;
}

const nameOfTexture = (of: Document, index: number): string => {
  const picture = item(of.json.images, sourceOf(item(of.json.textures, index)));
  const { name, uri } = picture ?? {};
  return String(name || (typeof uri === 'string' && !uri.startsWith('data:') ? decoded(uri) : `texture ${index}`));
};
const decoded = (uri: string) => {
  try {
    return decodeURIComponent(uri);
  } catch {
    return uri;
  }
};

/** Every texture of the file, as a choice. */
export const texturesOf = (of: Document): { index: number; name: string }[] => list(of.json.textures).map((_, index) => ({ index, name: nameOfTexture(of, index) }));

export function slotRow(of: Document, slot: Slot, acts: SlotActs): { element: HTMLElement; mark: (taken: boolean) => void } {
  const index: unknown = of.get(`${slot.pointer}/index`);
  const is = typeof index === 'number';
  const picker = h('input', { type: 'file', hidden: true, accept: 'image/png,image/jpeg,image/webp,image/avif', 'aria-label': `${slot.name}, a file` });
  picker.addEventListener('change', () => picker.files?.[0] && void put(of, slot, picker.files[0], acts));
  const choice = h('select', { id: `t:${slot.pointer}`, 'aria-label': `Picture of ${slot.name}` },
    h('option', { value: '' }, is ? 'no picture' : 'no picture: drop one here'), ...texturesOf(of).map(({ index: i, name }) => h('option', { value: i, selected: i === index }, name)), h('option', { value: 'file' }, 'Choose a file…'));
  choice.addEventListener('change', () => {
    if (choice.value === 'file') {
      picker.click();
      choice.value = is ? String(index) : '';
      return;
    }
    if (choice.value === '') of.set(slot.pointer, undefined, `remove ${slot.pointer}`);
    else of.set(slot.pointer, { ...of.get(slot.pointer), index: Number(choice.value) }, `texture ${slot.pointer}`);
    of.settle();
    acts.changed(true);
  });
  const thumbnail = h('canvas', { width: kThumbnail, height: kThumbnail, class: 'thumbnail', 'aria-hidden': 'true', click: () => choice.disabled || picker.click() });
  if (is) void drawThumbnail(of.file, sourceOf(item(of.json.textures, index)), thumbnail);
  const space = slot.srgb ? 'sRGB, a colour' : 'linear data';
  const tag = h('span', { class: 'gone', hidden: true });
  const element = h(
    'div', { class: `row texture${is ? '' : ' empty'}`, 'data-slot': slot.pointer, title: [slot.meaning, slot.pointer].filter(Boolean).join('\n') },
    thumbnail,
    h('div', { class: 'about' }, h('label', { class: 'name', for: choice.id }, slot.name), tag, h('small', {}, `${space}, ${slot.channels}${slot.meaning ? `: ${slot.meaning}` : ''}`), choice, picker),
    ...(is ? [lying(of, slot, acts)] : []), ...packing(of, slot, acts),
  );
  element.addEventListener('dragover', () => element.classList.add('over'));
  element.addEventListener('dragleave', () => element.classList.remove('over'));
  element.addEventListener('drop', (event) => {
    element.classList.remove('over');
    const file = [...(event.dataTransfer?.files ?? [])].find(({ name, type }) => type.startsWith('image/') || kPictures.test(name));
    if (!file || choice.disabled) return;
    event.preventDefault();
    event.stopPropagation();
    document.body.classList.remove('dropping');
    void put(of, slot, file, acts);
  });
  return {
    element,
    mark: (taken) => {
      for (const field of element.querySelectorAll<HTMLInputElement | HTMLSelectElement | HTMLButtonElement>('input, select, button')) if (field.disabled !== taken) field.disabled = taken;
    },
  };
}

/** A picture becomes an image and a texture of the file, in its bytes; one that the browser cannot decode is refused. */
async function put(of: Document, slot: Slot, file: File, acts: SlotActs): Promise<void> {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const type = file.type || `image/${/\.jpe?g$/i.test(file.name) ? 'jpeg' : file.name.split('.').pop()!.toLowerCase()}`;
  try {
    (await createImageBitmap(new Blob([bytes], { type }))).close();
  } catch {
    return acts.fail(new Error(`${file.name} is no picture that this browser reads: PNG, JPEG, WebP or AVIF`));
  }
  const texture = of.addTexture(file.name, type, bytes);
  of.set(slot.pointer, { ...of.get(slot.pointer), index: texture }, `texture ${slot.pointer} ${texture}`);
  of.settle();
  acts.changed(true);
}

const kPacked = ['red', 'green', 'blue'];

/** For data in channels: each may come from a grey picture of its own, the others stay as they are, or 1. */
function packing(of: Document, slot: Slot, acts: SlotActs): HTMLElement[] {
  const channels = kPacked.filter((name) => slot.channels.includes(name[0]));
  if (slot.srgb || channels.length < 2 || /normal/i.test(slot.name)) return [];
  const rows = channels.map((name) => {
    const picker = h('input', { type: 'file', hidden: true, accept: 'image/png,image/jpeg,image/webp,image/avif', 'aria-label': `${slot.name}, ${name} from a grey picture` });
    picker.addEventListener('change', () => picker.files?.[0] && void fill(of, slot, kPacked.indexOf(name), picker.files[0], acts));
    return h('div', {}, h('span', {}, name), h('button', { type: 'button', 'aria-label': `${slot.name}, ${name}: choose a grey picture`, click: () => picker.click() }, 'Grey picture…'), picker);
  });
  return [h('details', { class: 'lying' }, h('summary', {}, 'channels from grey pictures'), ...rows)];
}

/** The red of a picture as one channel of the slot's; the larger of both gives the size. What is made is opaque: a canvas
 * keeps no colours where alpha is 0. */
async function fill(of: Document, slot: Slot, channel: number, file: File, acts: SlotActs): Promise<void> {
  const untouched = { premultiplyAlpha: 'none', colorSpaceConversion: 'none' } as const;
  let grey: ImageBitmap;
  try {
    grey = await createImageBitmap(file, untouched);
  } catch {
    return acts.fail(new Error(`${file.name} is no picture that this browser reads: PNG, JPEG, WebP or AVIF`));
  }
  const index = of.get(`${slot.pointer}/index`);
  const before = typeof index === 'number' ? await image(of.file, sourceOf(item(of.json.textures, index))) : null;
  const [width, height] = [Math.max(grey.width, before?.width ?? 1), Math.max(grey.height, before?.height ?? 1)];
  const pixelsOf = (bitmap: ImageBitmap): Uint8ClampedArray => {
    const context = new OffscreenCanvas(width, height).getContext('2d')!;
    context.drawImage(bitmap, 0, 0, width, height);
    return context.getImageData(0, 0, width, height).data;
  };
  const made = before ? pixelsOf(before) : new Uint8ClampedArray(4 * width * height).fill(255);
  const from = pixelsOf(grey);
  if (slot.channels.includes('a') && made.some((x, i) => i % 4 === 3 && x < 255)) return acts.fail(new Error(`the picture of ${slot.name} has an alpha of its own, which filling a channel would lose: take it away first`));
  for (let i = 0; i < made.length; i += 4) {
    made[i + channel] = from[i];
    made[i + 3] = 255;
  }
  const canvas = new OffscreenCanvas(width, height);
  canvas.getContext('2d')!.putImageData(new ImageData(new Uint8ClampedArray(made), width, height), 0, 0);
  const packed = new File([await canvas.convertToBlob({ type: 'image/png' })], `${slot.name}.png`, { type: 'image/png' });
  grey.close();
  before?.close();
  await put(of, slot, packed, acts);
}

/** Set, transform and sampler of a slot's texture. */
function lying(of: Document, slot: Slot, acts: SlotActs): HTMLElement {
  const { pointer } = slot;
  const transform = `${pointer}/extensions/${kTransform}`;
  const set = (at: string, value: unknown, structure = false) => {
    of.set(at, value, `set ${at}`);
    if (at.startsWith(transform)) of.use(kTransform);
    of.settle();
    acts.changed(structure);
  };
  const pair = (name: string, usual: number) => [0, 1].map((i) => {
    const now = [of.get(`${transform}/${name}`)].flat()[i];
    const field = h('input', { type: 'number', step: 'any', value: typeof now === 'number' ? now : usual, 'aria-label': `${slot.name} ${name} ${'uv'[i]}` });
    field.addEventListener('change', () => {
      const [u = usual, v = usual] = [of.get(`${transform}/${name}`)].flat() as (number | undefined)[];
      if (field.value !== '' && Number.isFinite(Number(field.value))) set(`${transform}/${name}`, i === 0 ? [Number(field.value), v] : [u, Number(field.value)]);
    });
    return field;
  });
  const rotation = h('input', { type: 'number', step: 'any', value: Number((((of.get(`${transform}/rotation`) ?? 0) * 180) / Math.PI).toPrecision(6)), 'aria-label': `${slot.name} rotation, degrees` });
  rotation.addEventListener('change', () => rotation.value !== '' && set(`${transform}/rotation`, (Number(rotation.value) * Math.PI) / 180));
  const texCoord = select(`${slot.name} texture set`, [0, 1, 2, 3].map((i) => [i, `TEXCOORD_${i}`]), of.get(`${transform}/texCoord`) ?? of.get(`${pointer}/texCoord`) ?? 0, (i) => {
    if (of.get(`${transform}/texCoord`) !== undefined) set(`${transform}/texCoord`, i);
    else set(`${pointer}/texCoord`, i === 0 ? undefined : i);
  });
  const sampler = item(of.json.samplers, item(of.json.textures, of.get(`${pointer}/index`))?.sampler) ?? {};
  const sampled = (key: string, label: string, choices: [number, string][], usual: number) => select(`${slot.name} ${label}`, choices, sampler[key] ?? usual, (value) => {
    of.set(`${pointer}/index`, of.resampled(of.get(`${pointer}/index`), { ...sampler, [key]: value }), `sampler ${pointer} ${key} ${value}`);
    of.settle();
    acts.changed(true);
  });
  return h(
    'details', { class: 'lying' }, h('summary', {}, 'set, place, sampler'),
    h('div', {}, h('span', {}, 'set'), texCoord), h('div', {}, h('span', {}, 'offset'), ...pair('offset', 0)), h('div', {}, h('span', {}, 'rotation°'), rotation),
    h('div', {}, h('span', {}, 'scale'), ...pair('scale', 1)),
    h('div', {}, h('span', {}, 'beyond its edge'), sampled('wrapS', 'across', kWraps, 10497), sampled('wrapT', 'along', kWraps, 10497)),
    h('div', {}, h('span', {}, 'filter'), sampled('magFilter', 'filter', kFilters, 9729)),
  );
}

function select(label: string, choices: [number, string][], now: number, act: (value: number) => void): HTMLElement {
  const made = h('select', { 'aria-label': label }, ...choices.map(([value, text]) => h('option', { value, selected: value === now }, text)));
  made.addEventListener('change', () => act(Number(made.value)));
  return made;
}

const thumbnails = new WeakMap<GltfFile, Map<number, Promise<ImageBitmap | null>>>();

async function drawThumbnail(file: GltfFile, source: number, canvas: HTMLCanvasElement): Promise<void> {
  const of = thumbnails.get(file) ?? new Map<number, Promise<ImageBitmap | null>>();
  thumbnails.set(file, of);
  if (!of.has(source)) of.set(source, image(file, source, 2 * kThumbnail));
  const bitmap = await of.get(source);
  if (!bitmap) return;
  const by = kThumbnail / Math.max(bitmap.width, bitmap.height);
  const [width, height] = [bitmap.width * by, bitmap.height * by];
  canvas.getContext('2d')?.drawImage(bitmap, (kThumbnail - width) / 2, (kThumbnail - height) / 2, width, height);
}
