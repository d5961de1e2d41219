// What is chosen, in words: names, sources and numbers of its inputs, and its values.
import type { GraphSource } from '../../src/index';
import { h } from '../dom';
import * as actions from './actions';
import type { Editor, LibraryNode } from './editor';
import { connectEdit, originOf, pathOf, sourceOf, type Box, type Port } from './view';
import { converts } from './palette';

const kSize: Record<string, number> = { float: 1, int: 1, vec2: 2, vec3: 3, vec4: 4 };

export class Inspector {
  constructor(private readonly root: HTMLElement, private readonly editor: Editor) {}

  show(): void {
    const { editor } = this;
    const boxes = editor.chosenBoxes;
    if (editor.wire) return this.root.replaceChildren(...this.ofWire());
    if (boxes.length === 1) return this.root.replaceChildren(...this.ofBox(boxes[0]));
    this.root.replaceChildren(h('p', { class: 'doc' }, boxes.length > 1
      ? `${boxes.length} boxes are chosen.`
      : 'Choose a node to see its inputs. Drag from a port to connect it, or press Enter on one; A adds a node, Delete removes, F shows all, arrow keys go from box to box and Enter into its ports.'));
  }
  /** What gives the focus back to the field that has it now. */
  focusNow(): (() => void) | null {
    const at = document.activeElement as HTMLElement | null;
    if (!at || !this.root.contains(at) || !at.dataset.field) return null;
    const { field } = at.dataset;
    return () => this.root.querySelector<HTMLElement>(`[data-field="${CSS.escape(field!)}"]`)?.focus();
  }

  private ofWire(): Node[] {
    const { from, output, to, input, swizzle } = this.editor.wire!;
    const name = from.outputs[output].name;
    return [
      h('h3', {}, `${from.name}${name ? ` ${name}` : ''}${swizzle ? `.${swizzle}` : ''} → ${to.name || 'output'} ${to.inputs[input].name}`),
      h('button', { type: 'button', click: () => actions.cut(this.editor, to, input) }, 'Disconnect'),
    ];
  }

  private ofBox(box: Box): Node[] {
    if (box.kind === 'outputs') {
      return [h('h3', {}, 'Outputs'), h('p', { class: 'doc' }, this.editor.group ? 'The results of the group. A wire to + makes a new one.' : 'The ports of the template. What is not connected has its default.'), ...this.inputs(box, undefined)];
    }
    const node = this.editor.host.nodes().find(({ name }) => name === box.type && box.kind === 'node');
    return [
      h('div', { class: 'headline' }, this.nameField(box), h('small', {}, ` ${box.kind === 'node' ? '' : `${box.kind} `}${box.type}`), h('span', { class: 'space' }), ...this.buttons(box)),
      ...(node ? [h('p', { class: 'doc' }, node.doc, ' ', h('small', {}, node.source))] : []),
      ...(node ? this.variants(box, node) : []),
      ...(box.kind === 'parameter' ? this.parameter(box) : []),
      ...this.inputs(box, node),
    ];
  }

  private buttons(box: Box): HTMLElement[] {
    const button = (text: string, act: () => void) => h('button', { type: 'button', click: act }, text);
    return [
      ...(box.kind === 'group' ? [button('Enter', () => this.editor.enter(box)), button('Dissolve', () => actions.dissolve(this.editor))] : []),
      button('Remove', () => actions.remove(this.editor)),
    ];
  }

  private nameField(box: Box): HTMLElement {
    const field = h('input', { type: 'text', value: box.name, 'aria-label': 'Name', spellcheck: 'false', 'data-field': 'name' });
    field.addEventListener('change', () => {
      if (field.value && field.value !== box.name && !actions.rename(this.editor, box, field.value)) field.value = box.name;
    });
    return field;
  }

  private variants(box: Box, node: LibraryNode): Node[] {
    const names = (node.variants as (string | { name: string })[]).map((each) => (typeof each === 'string' ? each : each.name));
    if (names.length === 0) return [];
    const now = this.editor.graph?.nodes(this.editor.group).find(({ id }) => id === box.name)?.variant ?? '';
    const select = h('select', { 'aria-label': 'Variant', 'data-field': 'variant' }, h('option', { value: '' }, 'the reference'), ...names.map((name) => h('option', { value: name, selected: name === now }, name)));
    select.addEventListener('change', () => this.editor.edit([{ do: 'set_variant', node: pathOf(this.editor.group, box.name), ...(select.value ? { variant: select.value } : {}) }], select));
    return [h('label', { class: 'row' }, h('span', { class: 'name' }, 'variant'), select)];
  }

  /** A parameter's value and range. */
  private parameter(box: Box): Node[] {
    const of = this.editor.json?.parameters[box.name];
    if (!of) return [];
    const value = this.editor.host.values()[box.name] ?? of.value;
    const rows: Node[] = [];
    if (typeof value !== 'boolean') {
      rows.push(h('div', { class: 'row' }, h('span', { class: 'name' }, 'value'), ...this.numbers('value', [value].flat() as number[], (next) => this.editor.host.setValue(box.name, next.length === 1 ? next[0] : next))));
      const [low, high] = of.range ?? [null, null];
      const ends = [low, high].map((end, i) => {
        const field = h('input', { type: 'number', step: 'any', value: end ?? '', placeholder: i === 0 ? '−∞' : '∞', 'aria-label': i === 0 ? 'lowest value' : 'highest value', 'data-field': `range ${i}` });
        field.addEventListener('change', () => {
          const range = [low, high];
          range[i] = field.value === '' ? null : Number(field.value);
          const { ui, ...rest } = of;
          this.editor.edit([{ do: 'set_parameter', parameter: box.name, as: { ...rest, value, range, ...(ui ? { ui } : {}) } }], field);
        });
        return field;
      });
      rows.push(h('div', { class: 'row' }, h('span', { class: 'name' }, 'range'), ...ends));
    }
    if (of.pointer) rows.push(h('p', { class: 'doc' }, `It is the property ${of.pointer.replace(/^\/materials\/\d+\//, '')}.`));
    return rows;
  }

  private inputs(box: Box, node: LibraryNode | undefined): HTMLElement[] {
    return box.inputs.filter(({ name }) => name !== '+').map((port) => {
      const declared = node?.inputs.find(({ name }) => name === port.name);
      const range = port.low !== null || port.high !== null ? ` in [${port.low ?? '−∞'}, ${port.high ?? '∞'}]` : '';
      const hint = [declared?.meaning, declared?.unit].filter(Boolean).join(', ');
      return h(
        'div', { class: 'row input', title: `${port.name}: ${port.type}${range}` },
        h('span', { class: 'name' }, port.name, h('small', {}, ` ${port.type}${range}${hint ? `: ${hint}` : ''}`)),
        this.sourceSelect(box, port, declared), ...this.literal(box, port, declared),
      );
    });
  }

  /** All that the input could be given. */
  private sourceSelect(box: Box, port: Port, declared?: LibraryNode['inputs'][number]): HTMLElement {
    const { editor } = this;
    const now = JSON.stringify(port.source);
    const options: { label: string; value: GraphSource | null }[] = [];
    const usual = declared?.default !== undefined ? ` (${JSON.stringify(declared.default)})` : declared?.given ? ` (${declared.given})` : '';
    options.push({ label: port.optional ? `its default${usual}` : 'nothing', value: null });
    const size = kSize[port.type];
    const isNumber = typeof port.source === 'number' || Array.isArray(port.source);
    if (size) options.push({ label: 'a number', value: isNumber ? port.source : size === 1 ? 0 : Array<number>(size).fill(0) });
    if (port.type === 'bool') options.push({ label: 'true', value: true }, { label: 'false', value: false });
    for (const { name, type } of editor.host.givens(editor.json?.template ?? '')) if (fitting(type, port.type)) options.push({ label: name, value: swizzled({ given: name }, type, port.type) });
    for (const from of editor.view!.boxes.values()) {
      if (from === box) continue;
      from.outputs.forEach((output, i) => {
        if (fitting(output.type, port.type)) options.push({ label: `${from.name}${output.name ? ` ${output.name}` : ''}`, value: swizzled(sourceOf(from, i), output.type, port.type) });
      });
    }
    if (!options.some(({ value }) => JSON.stringify(value) === now)) {
      const origin = originOf(editor.view!.boxes, port.source);
      const word = JSON.stringify(port.source).replace(/[{}"]/g, '');
      options.push({ label: origin ? `${origin.box.name} ${word.includes('swizzle') ? word.replace(/.*swizzle:/, '.') : ''}` : word, value: port.source });
    }
    const select = h('select', { 'aria-label': `source of ${port.name}`, 'data-field': `source ${port.name}` },
      ...options.map(({ label, value }, i) => h('option', { value: i, selected: JSON.stringify(value) === now }, label)));
    select.addEventListener('change', () => {
      const { value } = options[Number(select.value)];
      if (!editor.edit([connectEdit(editor.group, box, port.name, value)], select)) this.show();
    });
    return select;
  }

  private literal(box: Box, port: Port, declared?: LibraryNode['inputs'][number]): HTMLElement[] {
    const { source } = port;
    if (declared?.choices && (typeof source === 'number' || typeof source === 'string' || source === null)) return [this.choices(box, port, declared)];
    if (typeof source !== 'number' && !Array.isArray(source)) return [];
    const size = kSize[port.type] ?? 1;
    const list = typeof source === 'number' ? Array<number>(size).fill(source) : source;
    return this.numbers(port.name, list, (next) => {
      this.editor.edit([connectEdit(this.editor.group, box, port.name, next.length === 1 ? next[0] : next)], this.root);
    });
  }
  private choices(box: Box, port: Port, { choices = [] }: LibraryNode['inputs'][number]): HTMLElement {
    const now = typeof port.source === 'string' ? port.source : typeof port.source === 'number' ? choices[port.source] : '';
    const select = h('select', { 'aria-label': port.name, 'data-field': `choice ${port.name}` }, h('option', { value: '' }, '…'), ...choices.map((name) => h('option', { selected: name === now }, name)));
    select.addEventListener('change', () => this.editor.edit([connectEdit(this.editor.group, box, port.name, select.value ? (select.value as unknown as GraphSource) : null)], select));
    return select;
  }

  private numbers(name: string, list: number[], change: (next: number[]) => void): HTMLElement[] {
    return list.map((x, i) => {
      const field = h('input', { type: 'number', step: 'any', value: Number(x.toPrecision(7)), 'aria-label': list.length > 1 ? `${name} ${'xyzw'[i]}` : name, 'data-field': `${name} ${i}` });
      field.addEventListener('change', () => {
        if (field.value === '' || !Number.isFinite(Number(field.value))) return;
        change(list.map((each, k) => (k === i ? Number(field.value) : each)));
      });
      return field;
    });
  }
}

/** Whether the list of an input's sources has it: types that agree, and floats that stand for each component. */
const fitting = (from: string, to: string) => from === to || ((from === 'float' || from === 'vec4') && converts(from, to));

function swizzled(source: GraphSource, from: string, to: string): GraphSource {
  if (from === to || from === 'float' || typeof source !== 'object') return source;
  return { ...source, swizzle: 'rgba'.slice(0, kSize[to]) } as GraphSource;
}

