// The material's properties as the node library declares them, with sliders.
import type { Document } from './document';
import { h } from './dom';
import { sourceOf } from '../src/gltf';
import { item } from '../src/json';

interface Property {
  name: string;
  type: string;
  range?: [number | null, number | null];
  or_zero?: boolean;
  /** Larger values are valid, but no contract of the library speaks of them. */
  tested_to?: number;
  default?: number | number[] | string;
  meaning?: string;
  values?: string[];
  members?: Property[];
}
export interface Extension {
  name: string;
  doc: string;
  status?: string;
  inside?: string;
  properties: Property[];
}

/** What the shader says of the material, to mark properties with. */
export interface InShader {
  /** Pointers of the parameters that it has. */
  pointers: Set<string>;
}

interface Row {
  pointer: string;
  update: () => void;
  mark: (shader: InShader) => void;
}

const kComponents: Record<string, number> = { float: 1, vec2: 2, vec3: 3, vec4: 4 };
const kLetters: Record<string, string[]> = { color: ['red', 'green', 'blue', 'alpha'], other: ['x', 'y', 'z', 'w'] };

export class Properties {
  private rows: Row[] = [];
  private readonly closed = new Set<string>();

  constructor(
    private readonly root: HTMLElement,
    private readonly extensions: Extension[],
    private readonly changed: (structure: boolean) => void,
  ) {}

  /** Builds the groups of a material anew; the focus stays, and so do groups that were closed. */
  show(of: Document): void {
    this.rows = [];
    const at = `/materials/${of.material}`;
    const groups: Node[] = [];
    for (const extension of this.extensions) {
      const pointer = pointerOf(at, extension);
      if (extension.name !== 'gltf' && of.get(pointer) === undefined) continue;
      groups.push(this.group(of, extension, pointer));
    }
    const focused = this.root.contains(document.activeElement) ? document.activeElement!.id : '';
    this.root.replaceChildren(...groups, this.adder(of, at));
    if (focused) document.getElementById(focused)?.focus();
  }
  clear(): void {
    this.rows = [];
    this.root.replaceChildren();
  }
  /** Shows today's values again, after a step back. */
  update(): void {
    for (const row of this.rows) row.update();
  }
  mark(shader: InShader): void {
    for (const row of this.rows) row.mark(shader);
  }

  private group(of: Document, extension: Extension, pointer: string): HTMLElement {
    const rows: Node[] = [];
    this.addRows(of, extension.properties, pointer, rows);
    const title = extension.name === 'gltf' ? 'Base' : extension.name.replace(/_materials_/, ' ');
    const remove = h(
      'button',
      {
        class: 'quiet', type: 'button', 'aria-label': `Remove ${extension.name}`, title: 'Remove the extension',
        click: (event: Event) => {
          event.preventDefault();
          of.setExtension(pointer, extension.name, false);
          this.changed(true);
        },
      },
      '×',
    );
    return h(
      'details',
      {
        open: !this.closed.has(extension.name), class: 'group', 'data-extension': extension.name,
        toggle: ({ target }: { target: HTMLDetailsElement }) => this.closed[target.open ? 'delete' : 'add'](extension.name),
      },
      h('summary', { title: extension.doc }, h('span', {}, title), ...(extension.name === 'gltf' ? [] : [remove])),
      h('p', { class: 'doc' }, extension.doc),
      ...rows,
    );
  }

  private addRows(of: Document, properties: Property[], at: string, rows: Node[]): void {
    for (const property of properties) {
      const pointer = `${at}/${property.name}`;
      if (property.type === 'object') this.addRows(of, property.members ?? [], pointer, rows);
      else if (property.type === 'texture') {
        if (of.get(pointer) === undefined) continue;
        rows.push(this.texture(of, property, pointer));
        this.addRows(of, property.members ?? [], pointer, rows);
      } else if (property.type === 'choice' || property.type === 'bool') rows.push(this.choice(of, property, pointer));
      else rows.push(this.numbers(of, property, pointer));
    }
  }

  private texture(of: Document, property: Property, pointer: string): HTMLElement {
    const index = of.get(`${pointer}/index`);
    const source = sourceOf(item(of.json.textures, index));
    const image = item(of.json.images, source);
    const name = image?.name ?? (typeof image?.uri === 'string' && !image.uri.startsWith('data:') ? image.uri : `texture ${index}`);
    const remove = () => {
      of.set(pointer, undefined, `remove ${pointer}`);
      this.changed(true);
    };
    return h(
      'div',
      { class: 'row texture', title: pointer },
      h('span', { class: 'name' }, property.name),
      h('span', { class: 'image' }, name),
      h('button', { class: 'quiet', type: 'button', 'aria-label': `Remove ${property.name}`, click: remove }, '×'),
    );
  }

  private choice(of: Document, property: Property, pointer: string): HTMLElement {
    const values = property.type === 'bool' ? ['false', 'true'] : property.values ?? [];
    const select = h('select', { id: `p:${pointer}` }, ...values.map((value) => h('option', {}, value)));
    const update = () => {
      const now = of.get(pointer); // an object may have no text
      select.value = String((typeof now === 'object' ? null : now) ?? (property.type === 'bool' ? 'false' : property.default));
    };
    select.addEventListener('change', () => {
      of.set(pointer, property.type === 'bool' ? select.value === 'true' : select.value, `set ${pointer}`);
      of.settle();
      this.changed(false);
    });
    update();
    this.rows.push({ pointer, update, mark: () => undefined });
    return h('div', { class: 'row', title: pointer }, h('label', { class: 'name', for: select.id }, property.name), select);
  }

  private numbers(of: Document, property: Property, pointer: string): HTMLElement {
    const count = kComponents[property.type] ?? 1;
    const usual = [property.default ?? 0].flat() as number[];
    const value = () => {
      const now = of.get(pointer);
      const list = (now === undefined ? usual : [now].flat()) as number[];
      return Array.from({ length: count }, (_, i) => (typeof list[i] === 'number' ? list[i] : Number(usual[i] ?? usual[0])));
    };
    const isColor = count >= 3 && /colou?r|emissive|tint/i.test(property.name);
    const change = (i: number, x: number, done: boolean) => {
      const next = value();
      next[i] = x;
      of.set(pointer, count === 1 ? next[0] : next, `set ${pointer}`);
      if (done) of.settle();
      update();
      this.changed(false);
    };
    const lines = Array.from({ length: count }, (_, i) => {
      const label = count === 1 ? property.name : `${property.name} ${kLetters[isColor ? 'color' : 'other'][i]}`;
      return sliderLine(property, label, count === 1 ? `p:${pointer}` : `p:${pointer}/${i}`, (x, done) => change(i, x, done));
    });
    const swatch = h('input', { type: 'color', 'aria-label': `${property.name} as a colour` });
    swatch.addEventListener('input', () => {
      const next = value();
      for (let i = 0; i < 3; ++i) next[i] = toLinear(parseInt(swatch.value.slice(1 + 2 * i, 3 + 2 * i), 16) / 255);
      of.set(pointer, next, `set ${pointer}`);
      update();
      this.changed(false);
    });
    swatch.addEventListener('change', () => of.settle());
    const update = () => {
      const now = value();
      lines.forEach((line, i) => line.show(now[i]));
      if (isColor) swatch.value = `#${now.slice(0, 3).map((x) => toByte(x).toString(16).padStart(2, '0')).join('')}`;
    };
    const tag = h('span', { class: 'gone', hidden: true, title: 'At this value the term needs no code: the slider brings it back' }, 'left the shader');
    const row = h(
      'div',
      { class: 'row numbers', 'data-pointer': pointer, title: [property.meaning, pointer].filter(Boolean).join('\n') },
      h('div', { class: 'head' }, h('span', { class: 'name' }, property.name), tag, ...(isColor ? [swatch] : [])),
      ...lines.map((line) => line.element),
      ...(property.meaning ? [h('p', { class: 'meaning' }, property.meaning)] : []),
    );
    update();
    this.rows.push({
      pointer,
      update,
      mark: ({ pointers }) => {
        const there = pointers.has(pointer);
        if (tag.hidden === there) return;
        tag.hidden = there;
        row.classList.toggle('absent', !there);
      },
    });
    return row;
  }

  private adder(of: Document, at: string): HTMLElement {
    const addable = this.extensions.filter(
      (each) =>
        each.name !== 'gltf' && of.get(pointerOf(at, each)) === undefined &&
        (!each.inside || of.get(`${at}/extensions/${each.inside}`) !== undefined),
    );
    const select = h(
      'select',
      { 'aria-label': 'Add an extension' },
      h('option', { value: '' }, 'Add an extension…'),
      ...addable.map(({ name, doc }) => h('option', { value: name, title: doc }, name)),
    );
    select.addEventListener('change', () => {
      const chosen = addable.find(({ name }) => name === select.value);
      if (!chosen) return;
      of.setExtension(pointerOf(at, chosen), chosen.name, true);
      of.settle();
      this.changed(true);
    });
    return h('div', { class: 'row adder' }, select);
  }
}

function pointerOf(material: string, extension: Extension): string {
  if (extension.name === 'gltf') return material;
  return `${material}/extensions/${extension.inside ? `${extension.inside}/extensions/` : ''}${extension.name}`;
}

/** The ends of a slider: those of the range, or some that are of use. */
export function sliderEnds(property: Property): [number, number] {
  const [low, high] = property.range ?? [null, null];
  const usual = Math.abs(([property.default ?? 0].flat() as number[])[0]) || 1;
  if (property.name.endsWith('Rotation') && low === null) return [-Math.PI, Math.PI];
  const from = low ?? -2 * usual;
  if (property.tested_to !== undefined) return [from, property.tested_to];
  if (high !== null && high - from <= 1000) return [from, high];
  return [property.or_zero ? Math.max(from, 1) : from, Math.max(from + 2, Math.min(4 * usual, 3000))];
}

interface Line {
  element: HTMLElement;
  show: (x: number) => void;
}

function sliderLine(property: Property, label: string, id: string, change: (x: number, done: boolean) => void): Line {
  const [low, high] = sliderEnds(property);
  const [least, most] = property.range ?? [null, null];
  const slider = h('input', { type: 'range', id, min: low, max: high, step: (high - low) / 1000, 'aria-label': label });
  const number = h('input', {
    type: 'number', step: 'any', 'aria-label': `${label}, as a number`,
    min: property.or_zero ? 0 : least ?? undefined, max: most !== null && most < 1e6 ? most : undefined,
  });
  slider.addEventListener('input', () => change(Number(slider.value), false));
  slider.addEventListener('change', () => change(Number(slider.value), true));
  number.addEventListener('change', () => {
    if (number.value !== '' && Number.isFinite(Number(number.value))) change(Number(number.value), true);
  });
  const show = (x: number) => {
    if (document.activeElement !== slider || Number(slider.value) !== x) slider.value = String(x);
    const text = String(Number(x.toPrecision(6)));
    if (number.value !== text) number.value = text;
  };
  return { element: h('div', { class: 'slider' }, slider, number), show };
}

const toLinear = (c: number) => Number((c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4).toPrecision(6));
const toByte = (x: number) => {
  const c = Math.min(Math.max(x, 0), 1);
  return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
};
