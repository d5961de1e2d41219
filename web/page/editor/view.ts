// A graph as boxes with ports and wires: the graph itself, or the inside of one of its groups.
import type { Graph, GraphEdit, GraphJson, GraphSource, Socket } from '../../src/index';

export type Kind = 'node' | 'group' | 'parameter' | 'texture' | 'input' | 'outputs';

export interface Port {
  name: string;
  type: string;
  low: number | null;
  high: number | null;
  orZero: boolean;
  /** Of an input: what it is given; null for nothing. */
  source: GraphSource | null;
  optional: boolean;
}
export interface Box {
  /** Unique in a view: "node coat.fresnel", "parameter glow". */
  key: string;
  kind: Kind;
  name: string;
  /** Of a node that of the library, of an instance its group, of a parameter its GLSL type. */
  type: string;
  inputs: Port[];
  outputs: Port[];
  x: number;
  y: number;
  width: number;
  height: number;
  /** It has no place of its own yet. */
  loose: boolean;
  ui: Ui;
}
export interface Wire {
  from: Box;
  output: number;
  to: Box;
  input: number;
  swizzle: string;
}
export interface Comment {
  x: number;
  y: number;
  width: number;
  height: number;
  text: string;
}
export type Ui = Record<string, unknown>;
export type Place = { x: number; y: number };
export interface View {
  /** The group that is looked into; empty for the graph itself. */
  group: string;
  boxes: Map<string, Box>;
  wires: Wire[];
  comments: Comment[];
  ui: Ui;
}

/** The JSON form of the graph that is edited. */
export type Full = GraphJson;

export const kWidth = 188;
export const kHead = 34;
export const kRow = 19;
/** The port of a group's outputs that makes a new one. */
export const kNewOutput = '+';

export const uiOf = (ui: unknown): Ui => (typeof ui === 'object' && ui !== null && !Array.isArray(ui) ? (ui as Ui) : {});
const numberOf = (x: unknown): number | null => (typeof x === 'number' && Number.isFinite(x) ? x : null);

/** How the library names a node of the view: those of a group with the group before them. */
export const pathOf = (group: string, id: string): string => (group ? `${group}/${id}` : id);

const portOf = ({ name, type, low, high, or_zero }: Socket, source: GraphSource | null = null, optional = true): Port => ({
  name, type, low, high, orZero: or_zero, source, optional,
});
const plain = (name: string, type: string, range?: (number | null)[], source: GraphSource | null = null): Port => ({
  name, type, low: range?.[0] ?? null, high: range?.[1] ?? null, orZero: false, source, optional: true,
});

function boxOf(kind: Kind, name: string, type: string, inputs: Port[], outputs: Port[], ui: unknown): Box {
  const own = uiOf(ui);
  const [x, y] = [numberOf(own.x), numberOf(own.y)];
  const rows = Math.max(inputs.length, outputs.length, 1);
  return {
    key: `${kind} ${name}`, kind, name, type, inputs, outputs, x: x ?? 0, y: y ?? 0, width: kWidth, height: kHead + kRow * rows + 6,
    loose: x === null || y === null, ui: own,
  };
}

/** The box and the port that a source names; null for what is written at its input. */
export function originOf(boxes: Map<string, Box>, source: GraphSource | null): { box: Box; output: number } | null {
  if (typeof source !== 'object' || source === null || Array.isArray(source)) return null;
  for (const [kind, kinds] of [['node', ['node', 'group']], ['parameter', ['parameter']], ['texture', ['texture']], ['input', ['input']]] as const) {
    if (!(kind in source)) continue;
    const name = (source as Record<string, string>)[kind];
    const box = kinds.map((each) => boxes.get(`${each} ${name}`)).find((each) => each);
    if (!box) return null;
    const wanted = (source as { output?: string }).output ?? '';
    const output = kind === 'node' && wanted ? box.outputs.findIndex((each) => each.name === wanted) : 0;
    return output < 0 ? null : { box, output };
  }
  return null;
}

/** The source that an output of a box is. */
export function sourceOf(box: Box, output: number): GraphSource {
  if (box.kind === 'parameter') return { parameter: box.name };
  if (box.kind === 'texture') return { texture: box.name };
  if (box.kind === 'input') return { input: box.name };
  const name = box.outputs[output]?.name ?? '';
  return name ? { node: box.name, output: name } : { node: box.name };
}

export function typeOfSource(boxes: Map<string, Box>, source: GraphSource): string {
  const swizzle = typeof source === 'object' && 'swizzle' in source ? source.swizzle : undefined;
  if (swizzle) return swizzle.length === 1 ? 'float' : `vec${swizzle.length}`;
  if (typeof source === 'number') return 'float';
  if (Array.isArray(source)) return `vec${source.length}`;
  const origin = originOf(boxes, source);
  return origin ? origin.box.outputs[origin.output].type : '';
}

/** What the sources of a body name of one kind. */
function named(sources: (GraphSource | null)[], kind: 'parameter' | 'texture'): Set<string> {
  const names = new Set<string>();
  for (const source of sources)
    if (typeof source === 'object' && source !== null && kind in source) names.add((source as Record<string, string>)[kind]);
  return names;
}

/** Of a group's body, in its JSON form. */
const sourcesOf = ({ nodes, outputs }: { nodes?: { inputs?: Record<string, GraphSource> }[]; outputs?: Record<string, GraphSource> }): GraphSource[] =>
  [...(nodes ?? []).flatMap(({ inputs }) => Object.values(inputs ?? {})), ...Object.values(outputs ?? {})];

export function viewOf(graph: Graph, json: Full, group: string): View {
  const boxes = new Map<string, Box>();
  const add = (box: Box) => boxes.set(box.key, box);
  for (const node of graph.nodes(group)) {
    const sockets = graph.sockets(pathOf(group, node.id));
    const kind = node.group ? 'group' : 'node';
    add(boxOf(
      kind, node.id, node.group ?? node.node ?? '', sockets.inputs.map((each) => portOf(each, each.source, each.optional)),
      sockets.outputs.map((each) => portOf(each)), node.ui,
    ));
  }
  const body = group ? json.groups?.[group] : json;
  const outputs = graph.outputs(group);
  const sources = [...[...boxes.values()].flatMap(({ inputs }) => inputs.map(({ source }) => source)), ...Object.values(outputs)];
  // What only other bodies name stands there; what none names, in the graph itself.
  const elsewhere = group ? [] : Object.values(json.groups ?? {}).flatMap(sourcesOf);
  const standsHere = (kind: 'parameter' | 'texture') => {
    const [here, there] = [named(sources, kind), named(elsewhere, kind)];
    return (name: string) => here.has(name) || (!group && !there.has(name));
  };
  const parameterStands = standsHere('parameter');
  for (const [name, { type, range, ui }] of Object.entries(json.parameters ?? {}))
    if (parameterStands(name)) add(boxOf('parameter', name, type, [], [plain('', type, range)], ui));
  const textureStands = standsHere('texture');
  for (const [name, { type, ui }] of Object.entries(json.textures ?? {}))
    if (textureStands(name)) add(boxOf('texture', name, type, [], [plain('', type)], ui));
  if (group) {
    for (const [name, { type, range, ui }] of Object.entries(json.groups?.[group]?.inputs ?? {}))
      add(boxOf('input', name, type, [], [plain('', type, range)], ui));
  }
  const ui = uiOf(body?.ui);
  const ports = group
    ? [...Object.entries(outputs).map(([name, source]) => plain(name, typeOfSource(boxes, source), undefined, source)), plain(kNewOutput, '')]
    : graph.sockets('').inputs.map((each) => portOf(each, each.source, each.optional));
  add(boxOf('outputs', '', group ? 'of the group' : json.template, ports, [], uiOf(ui.outputs)));
  return { group, boxes, wires: wiresOf(boxes), comments: commentsOf(ui), ui };
}

function wiresOf(boxes: Map<string, Box>): Wire[] {
  const wires: Wire[] = [];
  for (const to of boxes.values()) {
    to.inputs.forEach(({ source }, input) => {
      const origin = originOf(boxes, source);
      const swizzle = typeof source === 'object' && source !== null && 'swizzle' in source ? source.swizzle ?? '' : '';
      if (origin) wires.push({ from: origin.box, output: origin.output, to, input, swizzle });
    });
  }
  return wires;
}

function commentsOf(ui: Ui): Comment[] {
  const list = Array.isArray(ui.comments) ? ui.comments : [];
  return list.map(uiOf).map(({ x, y, width, height, text }) => ({
    x: numberOf(x) ?? 0, y: numberOf(y) ?? 0, width: numberOf(width) ?? 200, height: numberOf(height) ?? 120, text: typeof text === 'string' ? text : '',
  }));
}

/** The edit that keeps places of boxes in the graph's `ui`. */
export function placeEdits(view: View, places: Map<string, Place>): GraphEdit[] {
  const edits: GraphEdit[] = [];
  for (const [key, { x, y }] of places) {
    const box = view.boxes.get(key);
    if (!box) continue;
    const at = { x: Math.round(x), y: Math.round(y) };
    if (box.kind === 'outputs') {
      view.ui = { ...view.ui, outputs: { ...uiOf(view.ui.outputs), ...at } };
      edits.push(bodyEdit(view));
      continue;
    }
    const thing = box.kind === 'group' ? 'node' : box.kind;
    const name = thing === 'node' || thing === 'input' ? pathOf(view.group, box.name) : box.name;
    edits.push({ do: 'set_ui', [thing]: name, ui: { ...box.ui, ...at } });
  }
  return edits;
}

/** The edit that keeps what a view has in the `ui` of its graph or group: comments, and where its outputs are. */
export const bodyEdit = ({ group, ui }: View): GraphEdit => (group ? { do: 'set_ui', group, ui } : { do: 'set_ui', ui });

/** The edit that gives an input of a box a source; without one it has its default again. */
export function connectEdit(group: string, box: Box, port: string, source: GraphSource | null): GraphEdit {
  if (box.kind === 'outputs') {
    const output = pathOf(group, port);
    return source === null ? { do: 'remove_output', output } : { do: 'set_output', output, source };
  }
  const node = pathOf(group, box.name);
  return source === null ? { do: 'disconnect', node, input: port } : { do: 'connect', node, input: port, source };
}
