// The material's properties as the node library declares them, with sliders.
import type { GraphJson } from '../src/index';
import type { Document } from './document';
import { h } from './dom';
import { slotRow } from './textures';

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
  color_space?: string;
  channels?: string;
  members?: Property[];
}
export interface Extension {
  name: string;
  doc: string;
  status?: string;
  inside?: string;
  needs?: string[];
  excludes?: string[];
  yields_to?: string[];
  loses_to?: string[];
  properties: Property[];
}

/** What the shader says of the material, to mark properties with. */
export interface InShader {
  /** Pointers of the parameters that it has. */
  pointers: Set<string>;
  /** It is a graph of its own: what has no place in it acts no more. */
  own: boolean;
}

/** What the page does. */
export interface Acts {
  changed: (structure: boolean) => void;
  setParameter: (name: string, value: number | number[], done: boolean) => void;
  forgetGraph: () => void;
  fail: (error: unknown) => void;
}

type Parameter = { type: string; value: number | number[]; range?: (number | null)[]; pointer?: string };

interface Row {
  pointer: string;
  update: () => void;
  mark: (shader: InShader) => void;
}

const kComponents: Record<string, number> = { float: 1, vec2: 2, vec3: 3, vec4: 4 };
const kLetters: Record<string, string[]> = { color: ['red', 'green', 'blue', 'alpha'], other: ['x', 'y', 'z', 'w'] };

const kTaken = 'taken over by the graph';
const kTakenTitle = 'The graph is no longer made of this property: it is kept in the file, and acts no more';
const kLeft = 'left the shader';
const kLeftTitle = 'At this value the term needs no code: the slider brings it back';
/** What is also for those who draw. */
const kInPart: Record<string, [string, string]> = {
  alphaMode: ['blending alone', "It still says whether the picture is blended; alpha itself is the graph's"],
  doubleSided: ['culling alone', "It still says which sides are drawn; their normals are the graph's"],
};

/** Whether that is something else than before. */
function showTag(tag: HTMLElement, text: string, title: string): boolean {
  if (tag.hidden === (text === '') && (text === '' || tag.textContent === text)) return false;
  tag.hidden = text === '';
  if (text !== '') {
    tag.textContent = text;
    tag.title = title;
  }
  return true;
}

export class Properties {
  private rows: Row[] = [];
  private readonly closed = new Set<string>();

  constructor(
    private readonly root: HTMLElement,
    public extensions: Extension[],
    private readonly acts: Acts,
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
    this.root.replaceChildren(...this.ownGraph(of), ...groups, this.adder(of, at));
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

  /** Of a graph of the document's own: that it is one, and its parameters that are no properties. */
  private ownGraph(of: Document): Node[] {
    const text = of.graphs.get(of.material);
    if (text === undefined) return [];
    const { parameters = {} } = JSON.parse(text) as GraphJson;
    const rows = Object.entries(parameters).filter(([, { pointer, type }]) => type !== 'bool' && (!pointer || of.get(pointer) === undefined)).map(([name, parameter]) => {
      const { type, value, range = [null, null] } = parameter as Parameter;
      const count = kComponents[type] ?? 1;
      let now = [value].flat() as number[];
      const property: Property = { name, type, range: [range[0] ?? null, range[1] ?? null], default: now };
      const change = (i: number, x: number, done: boolean) => {
        now = now.map((each, k) => (k === i ? x : each));
        this.acts.setParameter(name, count === 1 ? now[0] : now, done);
        lines.forEach((line, k) => line.show(now[k]));
      };
      const lines = now.map((x, i) => {
        const line = sliderLine(property, count === 1 ? name : `${name} ${kLetters.other[i]}`, count === 1 ? `g:${name}` : `g:${name}/${i}`, (next, done) => change(i, next, done));
        line.show(x);
        return line;
      });
      return h('div', { class: 'row numbers', 'data-parameter': name }, h('div', { class: 'head' }, h('span', { class: 'name' }, name)), ...lines.map(({ element }) => element));
    });
    return [
      h('div', { class: 'taken', role: 'note' }, 'This material is drawn by a graph of its own. Properties that have a place in it still act; the others are taken over by the graph. ',
        h('br'), h('button', { type: 'button', click: () => this.acts.forgetGraph() }, 'Back to the properties')),
      ...(rows.length > 0 ? [h('details', { open: true, class: 'group', 'data-extension': 'graph' }, h('summary', {}, h('span', {}, 'Graph')), ...rows)] : []),
    ];
  }

  private group(of: Document, extension: Extension, pointer: string): HTMLElement {
    const rows: Node[] = [];
    this.addRows(of, extension.properties, pointer, rows);
    const title = extension.name === 'gltf' ? 'Base' : extension.name.replace(/_materials_/, ' ');
    const remove = h(
      'button',
      {
        class: 'quiet', type: 'button', 'aria-label': `Remove ${extension.name}`, disabled: of.graphs.has(of.material),
        title: of.graphs.has(of.material) ? 'The graph has taken over: go back to the properties first' : 'Remove the extension',
        click: (event: Event) => {
          event.preventDefault();
          of.setExtension(pointer, extension.name, false);
          this.acts.changed(true);
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
        rows.push(this.texture(of, property, pointer));
        if (of.get(pointer) !== undefined) this.addRows(of, property.members ?? [], pointer, rows);
      } else if (property.type === 'choice' || property.type === 'bool') rows.push(this.choice(of, property, pointer));
      else rows.push(this.numbers(of, property, pointer));
    }
  }

  private texture(of: Document, property: Property, pointer: string): HTMLElement {
    const slot = { name: property.name, pointer, srgb: property.color_space === 'srgb', channels: property.channels ?? 'rgba', meaning: property.meaning ?? '' };
    const { element, mark } = slotRow(of, slot, this.acts);
    const tag = element.querySelector<HTMLElement>('.gone')!;
    this.rows.push({
      pointer, update: () => undefined,
      mark: ({ pointers, own }) => {
        const taken = own && !pointers.has(pointer);
        mark(taken);
        showTag(tag, taken ? kTaken : '', kTakenTitle);
      },
    });
    return element;
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
      this.acts.changed(false);
    });
    update();
    const tag = h('span', { class: 'gone', hidden: true });
    const [word, title] = kInPart[property.name] ?? [kTaken, kTakenTitle];
    this.rows.push({
      pointer, update,
      mark: ({ own }) => {
        select.disabled = own && word === kTaken;
        showTag(tag, own ? word : '', title);
      },
    });
    return h('div', { class: 'row', title: pointer }, h('label', { class: 'name', for: select.id }, property.name), tag, select);
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
      this.acts.changed(false);
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
      this.acts.changed(false);
    });
    swatch.addEventListener('change', () => of.settle());
    const update = () => {
      const now = value();
      lines.forEach((line, i) => line.show(now[i]));
      if (isColor) swatch.value = `#${now.slice(0, 3).map((x) => toByte(x).toString(16).padStart(2, '0')).join('')}`;
    };
    const tag = h('span', { class: 'gone', hidden: true });
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
      mark: ({ pointers, own }) => {
        const there = pointers.has(pointer);
        if (!showTag(tag, there ? '' : own ? kTaken : kLeft, own ? kTakenTitle : kLeftTitle)) return;
        row.classList.toggle('absent', !there);
        for (const field of row.querySelectorAll('input')) field.disabled = own && !there;
      },
    });
    return row;
  }

  /** Extensions that can stand with what is there, and the others with what is against it. */
  private adder(of: Document, at: string): HTMLElement {
    if (of.graphs.has(of.material)) {
      return h('div', { class: 'row adder' }, h('select', { disabled: true, 'aria-label': 'Add an extension' }, h('option', {}, 'The graph has taken over: no extension would act')));
    }
    const has = (each: Extension) => of.get(pointerOf(at, each)) !== undefined;
    const there = new Set(this.extensions.filter((each) => each.name !== 'gltf' && has(each)).map(({ name }) => name));
    const offers = this.extensions.filter((each) => each.name !== 'gltf' && !has(each)).map((each) => ({ each, against: against(each, there, this.extensions) }));
    const option = ({ each: { name, doc, yields_to: _ }, against: why }: (typeof offers)[number]) => {
      const replaced = this.extensions.find((other) => there.has(other.name) && other.yields_to?.includes(name));
      const text = why ? `${name}: ${why}` : replaced ? `${name}, in place of ${replaced.name}` : name;
      return h('option', { value: name, title: [doc, why].filter(Boolean).join('\n'), disabled: why !== '' }, text);
    };
    const some = (label: string, list: typeof offers) => (list.length > 0 ? [h('optgroup', { label }, ...list.map(option))] : []);
    const select = h(
      'select',
      { 'aria-label': 'Add an extension' },
      h('option', { value: '' }, 'Add an extension…'),
      ...some('These can stand with what is there', offers.filter(({ against: why }) => !why)),
      ...some('These cannot', offers.filter(({ against: why }) => why)),
    );
    select.addEventListener('change', () => {
      const chosen = offers.find(({ each, against: why }) => each.name === select.value && !why)?.each;
      if (!chosen) return;
      of.setExtension(pointerOf(at, chosen), chosen.name, true);
      of.settle();
      this.acts.changed(true);
    });
    return h('div', { class: 'row adder' }, select);
  }
}

/** Why an extension cannot stand with those that are there; empty where it can. */
export function against({ name, inside, needs = [], excludes = [], yields_to = [], loses_to = [] }: Extension, there: Set<string>, all: Extension[]): string {
  if (inside && !there.has(inside)) return `it stands in ${inside}`;
  const lacking = needs.find((each) => !there.has(each));
  if (lacking) return `it needs ${lacking}`;
  const not = excludes.find((each) => there.has(each)) ?? all.find((each) => there.has(each.name) && each.excludes?.includes(name))?.name;
  if (not) return `not with ${not}`;
  const stronger = [...yields_to, ...loses_to].find((each) => there.has(each));
  return stronger ? `${stronger} stands in its place` : '';
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
