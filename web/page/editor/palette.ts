// The palette: a search over all nodes of the library, the graph's groups, new parameters and comments.
import type { GraphEdit, GraphSource } from '../../src/index';
import { h } from '../dom';
import type { PortAt } from './canvas';
import { fresh, type Editor, type LibraryNode } from './editor';
import { pathOf, type Place } from './view';

/** What choosing an entry makes. */
interface Made {
  edits: GraphEdit[];
  /** Of the box that it becomes. */
  key?: string;
  /** What an input is connected with, where one asked. */
  source?: GraphSource;
  /** The input that an output is connected with. */
  input?: { node: string; input: string };
}
export interface Entry {
  name: string;
  kind: string;
  doc: string;
  category: string;
  details: () => Node[];
  /** Types of what it takes and gives. */
  takes: string[];
  gives: string[];
  make: (editor: Editor, place: Place, port: PortAt | null) => Made;
}

const kShown = 60;
const kNewTypes = ['float', 'vec2', 'vec3', 'vec4', 'bool'];

/** Whether a value of one type can be given where another is wanted, as it is or by a swizzle. */
export function converts(from: string, to: string): boolean {
  if (from === to) return true;
  const size = (type: string) => (type === 'float' ? 1 : /^vec[234]$/.test(type) ? Number(type[3]) : 0);
  const [a, b] = [size(from), size(to)];
  return a > 0 && b > 0 && (a === 1 || a >= b);
}

function nodeEntry(node: LibraryNode): Entry {
  const text = (range?: (number | null)[]) => (range ? ` in [${range[0] ?? '−∞'}, ${range[1] ?? '∞'}]` : '');
  const line = ({ name, type, range, default: usual, given, meaning, unit, choices }: LibraryNode['inputs'][number]) =>
    h('li', {}, h('b', {}, name || 'result'), ` ${type}${text(range)}${unit ? ` ${unit}` : ''}`,
      usual !== undefined ? ` = ${JSON.stringify(usual)}` : given ? ` = ${given}` : '', h('small', {}, [choices?.join(', '), meaning].filter(Boolean).map((each) => ` ${each}`).join(';')));
  return {
    name: node.name, kind: 'node', doc: node.doc, category: node.category || node.file.replace(/^.*\/|\.node$/g, ''),
    takes: node.inputs.map(({ type }) => type), gives: node.outputs.map(({ type }) => type),
    details: () => [h('p', {}, node.doc), h('ul', {}, ...node.inputs.map(line)), h('ul', { class: 'gives' }, ...node.outputs.map(line)), h('small', {}, node.source)],
    make: (editor, place, port) => {
      const id = editor.freshId(node.name);
      const output = port?.side === 'in' ? node.outputs.find(({ type }) => type === port.port.type) ?? node.outputs[0] : undefined;
      const input = port?.side === 'out' ? node.inputs.find(({ type }) => type === port.port.type) ?? node.inputs.find(({ type }) => port.port.type === 'float' && /^vec/.test(type)) : undefined;
      return {
        edits: [addition(editor.group, { id, node: node.name, inputs: startOf(node, input?.name), ui: place })],
        key: `node ${id}`,
        source: output && (output.name && node.outputs.length > 1 ? { node: id, output: output.name } : { node: id }),
        input: input && { node: pathOf(editor.group, id), input: input.name },
      };
    },
  };
}

/** Numbers for the inputs that must have something, so that a graph stays good while its wires are drawn. */
function startOf({ inputs }: LibraryNode, connected?: string): Record<string, GraphSource> {
  const start: Record<string, GraphSource> = {};
  for (const { name, type, range, default: usual, given } of inputs) {
    if (usual !== undefined || given !== undefined || name === connected) continue;
    if (type === 'bool') start[name] = false;
    else if (type === 'int') start[name] = Math.max(0, Math.ceil(range?.[0] ?? 0));
    else if (/^(float|vec[234])$/.test(type)) start[name] = Math.min(Math.max(0.5, range?.[0] ?? -Infinity), range?.[1] ?? Infinity);
  }
  return start;
}

/** The edit that adds a node to the graph, or to a group. */
export function addition(group: string, node: { id: string } & Record<string, unknown>): GraphEdit {
  return { do: 'add_node', node: { ...node, id: pathOf(group, node.id) } };
}

function groupEntries(editor: Editor): Entry[] {
  return Object.entries(editor.json?.groups ?? {}).filter(([name]) => name !== editor.group).map(([name, of]) => ({
    name, kind: 'group', doc: 'A group of this graph.', category: 'groups', takes: Object.values(of.inputs).map(({ type }) => type), gives: Object.keys(of.outputs).map(() => ''),
    details: () => [h('p', {}, 'A group of this graph.'), h('ul', {}, ...Object.entries(of.inputs).map(([input, { type }]) => h('li', {}, h('b', {}, input), ` ${type}`)))],
    make: (at, place) => {
      const id = at.freshId(name);
      return { edits: [addition(at.group, { id, group: name, inputs: {}, ui: place })], key: `group ${id}` };
    },
  }));
}

/** In a group: what its instances are given, with a default so that those that are there stay good. */
function inputEntries(editor: Editor, port: PortAt | null): Entry[] {
  if (!editor.group || port?.side === 'out') return [];
  return kNewTypes.filter((type) => !port || type === port.port.type).map((type) => ({
    name: `group input: ${type}`, kind: 'new', doc: 'What each instance of the group may be given.', category: 'groups', takes: [], gives: [type],
    details: () => [h('p', {}, 'A new input of the group. Instances that are there have its default.')],
    make: (at, place) => {
      const name = fresh(port ? port.port.name : 'input', new Set(Object.keys(at.json?.groups?.[at.group]?.inputs ?? {})));
      const source = port?.port.source;
      const start = typeof source === 'number' || Array.isArray(source) ? source : port?.port.low ?? 0;
      const as: Record<string, unknown> = { type, default: type === 'bool' ? false : start, ui: place };
      if (port && (port.port.low !== null || port.port.high !== null)) as.range = [port.port.low, port.port.high];
      return { edits: [{ do: 'add_input', input: pathOf(at.group, name), as }], key: `input ${name}`, source: { input: name } };
    },
  }));
}

/** Parameters of a type; where an input asks, of its name, its range and its value now. */
function parameterEntries(port: PortAt | null): Entry[] {
  const types = port?.side === 'in' && kNewTypes.includes(port.port.type) ? [port.port.type] : kNewTypes;
  return types.map((type) => ({
    name: `parameter: ${type}`, kind: 'new', doc: 'A new number that is edited while the shader runs: a slider.', category: 'parameters', takes: [], gives: [type],
    details: () => [h('p', {}, 'A new parameter of the material, with a slider among its properties.')],
    make: (at, place) => {
      const name = fresh(port?.side === 'in' ? port.port.name : 'parameter', new Set(Object.keys(at.json?.parameters ?? {})));
      const { low = null, high = null, source = null, orZero = false } = port?.side === 'in' ? port.port : {};
      const count = type === 'float' ? 1 : Number(type[3]);
      const start = typeof source === 'number' ? source : Math.min(Math.max(0.5, low ?? -Infinity), high ?? Infinity);
      const value = type === 'bool' ? false : count === 1 ? start : Array.isArray(source) && source.length === count ? source : Array(count).fill(start);
      const as: Record<string, unknown> = { type, value, ui: place };
      if (type !== 'bool') as.range = low !== null || high !== null ? [low, high] : [0, 1];
      if (orZero) as.or_zero = true;
      return { edits: [{ do: 'add_parameter', parameter: name, as }], key: `parameter ${name}`, source: { parameter: name } };
    },
  }));
}

/** Pictures of the file, as colours and as data. */
function textureEntries(editor: Editor): Entry[] {
  return editor.host.textures().flatMap(({ index, name }) => [true, false].map((srgb): Entry => ({
    name: `texture: ${name}${srgb ? '' : ', data'}`, kind: 'new', doc: srgb ? 'A picture of the file, a colour: it is decoded from sRGB.' : 'A picture of the file: its numbers as they are.', category: 'textures',
    takes: [], gives: ['sampler2D'], details: () => [h('p', {}, 'texture_sample reads it at texture coordinates.')],
    make: (at, place) => {
      const texture = fresh(name.replace(/\.\w+$/, '').replace(/\W+/g, '_').replace(/^(?=\d)/, '_').toLowerCase() || 'picture', new Set(Object.keys(at.json?.textures ?? {})));
      return { edits: [{ do: 'add_texture', texture, as: { type: 'sampler2D', srgb, texture: index, ui: place } }], key: `texture ${texture}`, source: { texture } };
    },
  })));
}

/** What the template gives: no box, but what is written at an input. */
function givenEntries(editor: Editor, port: PortAt | null): Entry[] {
  if (port?.side !== 'in') return [];
  return editor.host.givens(editor.json?.template ?? '').map(({ name, type }) => ({
    name, kind: 'given', doc: 'The template gives it.', category: 'given', takes: [], gives: [type], details: () => [h('p', {}, `${type}: given by the template.`)],
    make: () => ({ edits: [], source: { given: name } }),
  }));
}

function commentEntry(): Entry {
  return {
    name: 'comment', kind: 'new', doc: 'A frame with a text.', category: 'comments', takes: [], gives: [], details: () => [h('p', {}, 'A frame with a text, around what is chosen.')],
    make: (editor, place) => {
      const view = editor.view!;
      view.ui = { ...view.ui, comments: [...view.comments, { ...place, width: 260, height: 140, text: 'comment' }] };
      return { edits: [view.group ? { do: 'set_ui', group: view.group, ui: view.ui } : { do: 'set_ui', ui: view.ui }] };
    },
  };
}

/** How well an entry answers a search: 0 not at all. Words may stand in its name, its category or its prose. */
export function rank(entry: Entry, words: string[]): number {
  let sum = 1;
  for (const word of words) {
    const name = entry.name.toLowerCase();
    const at = name === word ? 100 : name.replace(/<.*/, '') === word ? 90 : name.startsWith(word) ? 40 : name.includes(word) ? 20 : entry.category.toLowerCase().includes(word) ? 6 : entry.doc.toLowerCase().includes(word) ? 3 : 0;
    if (at === 0) return 0;
    sum += at;
  }
  return sum;
}

export function openPalette(editor: Editor, clientX: number, clientY: number, port: PortAt | null, done: (entry: Entry) => void): void {
  const wanted = port?.port.type ?? '';
  const fits = (entry: Entry) => !wanted || (port!.side === 'in' ? entry.gives.some((type) => type === '' || type === wanted || (type === 'float' && converts(type, wanted))) : entry.takes.some((type) => type === wanted || (wanted === 'float' && converts(wanted, type))));
  const all = [...inputEntries(editor, port), ...parameterEntries(port), ...givenEntries(editor, port), ...groupEntries(editor), ...textureEntries(editor), ...(port ? [] : [commentEntry()]), ...editor.host.nodes().map(nodeEntry)].filter(fits);
  const field = h('input', { type: 'text', role: 'combobox', 'aria-label': 'Search nodes', 'aria-expanded': 'true', 'aria-controls': 'palette-list', placeholder: 'Search nodes…', spellcheck: 'false' });
  const categories = [...new Set(all.map(({ category }) => category))].sort();
  const category = h('select', { 'aria-label': 'Category' }, h('option', { value: '' }, 'all'), ...categories.map((name) => h('option', {}, name)));
  const list = h('div', { id: 'palette-list', role: 'listbox', 'aria-label': 'Nodes', class: 'entries' });
  const details = h('div', { class: 'details' });
  const count = h('small', { class: 'count' });
  const dialog = h('dialog', { class: 'palette', 'aria-label': 'Add' }, h('div', { class: 'bar' }, field, category, count), h('div', { class: 'two' }, list, details));
  let shown: Entry[] = [];
  let at = 0;
  const point = (index: number) => {
    at = Math.min(Math.max(index, 0), shown.length - 1);
    [...list.children].forEach((row, i) => row.setAttribute('aria-selected', String(i === at)));
    list.children[at]?.scrollIntoView({ block: 'nearest' });
    field.setAttribute('aria-activedescendant', list.children[at]?.id ?? '');
    details.replaceChildren(...(shown[at]?.details() ?? []));
  };
  const take = (entry: Entry | undefined) => {
    if (!entry) return;
    dialog.close();
    done(entry);
  };
  const search = () => {
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    const found = all
      .filter((entry) => category.value === '' || entry.category === category.value)
      .map((entry) => ({ entry, score: rank(entry, words) })).filter(({ score }) => score > 0);
    if (words.length > 0) found.sort((a, b) => b.score - a.score || a.entry.name.length - b.entry.name.length);
    shown = found.slice(0, kShown).map(({ entry }) => entry);
    count.textContent = `${found.length}`;
    list.replaceChildren(...shown.map((entry, i) => h(
      'div', { role: 'option', id: `palette-${i}`, 'data-entry': entry.name, click: () => take(entry), pointermove: () => at !== i && point(i) },
      h('b', {}, entry.name), h('small', {}, ` ${entry.category}`), h('span', {}, entry.doc.split('\n')[0]),
    )));
    point(0);
  };
  field.addEventListener('input', search);
  category.addEventListener('change', search);
  dialog.addEventListener('keydown', (event) => {
    event.stopPropagation();
    if (event.key === 'Enter' && event.target !== category) (event.preventDefault(), take(shown[at]));
    const step = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 }[event.key];
    if (step && event.target === field) (event.preventDefault(), point(at + step));
  });
  dialog.addEventListener('click', (event) => event.target === dialog && dialog.close());
  // The dialog gives the focus back when it is closed, and the box that was added takes it then. This event comes later: it must leave the focus alone.
  dialog.addEventListener('close', () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
  dialog.style.left = `${Math.max(8, Math.min(clientX, innerWidth - dialog.offsetWidth - 8))}px`;
  dialog.style.top = `${Math.max(8, Math.min(clientY, innerHeight - dialog.offsetHeight - 8))}px`;
  search();
  field.focus();
}
