// What can be done with what is chosen: each of it edits of the library, all of them or none.
import type { GraphEdit, GraphSource } from '../../src/index';
import type { Editor } from './editor';
import { fresh } from './editor';
import { addition } from './palette';
import { aligned, boundsOf, tidied } from './place';
import { connectEdit, originOf, pathOf, uiOf, type Box, type Full, type Place } from './view';

const kClipboard = 'lacquer_boxes';

/** Takes a wire away. */
export function cut(editor: Editor, to: Box, input: number): void {
  editor.edit([connectEdit(editor.group, to, to.inputs[input].name, null)], editor.canvas.portElement({ box: to, side: 'in', index: input }));
}

/** Removes what is chosen, and the wires that came from it; the focus goes to its neighbour. */
export function remove(editor: Editor): void {
  const { view, group } = editor;
  if (!view) return;
  if (editor.wire) return cut(editor, editor.wire.to, editor.wire.input);
  const boxes = editor.chosenBoxes.filter(({ kind }) => kind !== 'outputs');
  if (boxes.length === 0) return;
  const gone = new Set(boxes.map(({ key }) => key));
  const edits: GraphEdit[] = view.wires
    .filter(({ from, to }) => gone.has(from.key) && !gone.has(to.key))
    .map(({ to, input }) => connectEdit(group, to, to.inputs[input].name, null));
  // A wire within what goes would keep a parameter in use.
  for (const { kind, name } of [...boxes].sort((a, b) => Number(isNode(b)) - Number(isNode(a)))) {
    if (kind === 'node' || kind === 'group') edits.push({ do: 'remove_node', node: pathOf(group, name) });
    else if (kind === 'input') edits.push({ do: 'remove_input', input: pathOf(group, name) });
    else edits.push({ do: `remove_${kind}`, [kind]: name });
  }
  const [last] = boxes;
  const next = view.wires.find(({ from, to }) => from === last && !gone.has(to.key))?.to ?? [...view.boxes.values()].find(({ key }) => !gone.has(key));
  if (!editor.edit(edits, editor.canvas.elementOf(last.key))) return;
  editor.choose(next && editor.view?.boxes.has(next.key) ? [next.key] : []);
  if (next) editor.canvas.elementOf(next.key)?.focus({ preventScroll: true });
}
const isNode = ({ kind }: Box) => kind === 'node' || kind === 'group';

export function rename(editor: Editor, box: Box, to: string): boolean {
  const node = pathOf(editor.group, box.name);
  const edit: GraphEdit = isNode(box) ? { do: 'rename_node', node, to: pathOf(editor.group, to) }
    : box.kind === 'input' ? { do: 'rename_input', input: node, to: pathOf(editor.group, to) } : { do: `rename_${box.kind}`, [box.kind]: box.name, to };
  editor.selection = new Set([`${box.kind} ${to}`]);
  if (editor.edit([edit], editor.canvas.elementOf(box.key))) return true;
  editor.select([box.key]);
  return false;
}

// ---- groups

/** Puts the chosen nodes into a group of their own. */
export function makeGroup(editor: Editor): void {
  const nodes = editor.chosenBoxes.filter(isNode);
  if (nodes.length === 0) return;
  const group = fresh('group', new Set(Object.keys(editor.json?.groups ?? {})));
  const id = editor.freshId(group);
  const bounds = boundsOf(nodes);
  const ui = { x: Math.round(bounds.x + bounds.width / 2 - 94), y: Math.round(bounds.y + bounds.height / 2 - 40) };
  const node = pathOf(editor.group, id);
  editor.selection = new Set([`group ${id}`]);
  const made = editor.edit([
    { do: 'make_group', nodes: nodes.map(({ name }) => pathOf(editor.group, name)), group, node }, { do: 'set_ui', node, ui },
  ], editor.canvas.elementOf(nodes[0].key));
  if (!made) editor.select(nodes.map(({ key }) => key));
  else editor.canvas.elementOf(`group ${id}`)?.focus({ preventScroll: true });
}

/** Puts the nodes of the chosen instances in their places. */
export function dissolve(editor: Editor): void {
  const groups = editor.chosenBoxes.filter(({ kind }) => kind === 'group');
  if (groups.length > 0) editor.edit(groups.map(({ name }) => ({ do: 'expand', node: pathOf(editor.group, name) })), editor.canvas.elementOf(groups[0].key));
}

// ---- places

export function align(editor: Editor, side: 'left' | 'top'): void {
  put(editor, aligned(editor.chosenBoxes, side));
}
/** Lays out what is chosen, or all. */
export function tidy(editor: Editor): void {
  const { view } = editor;
  if (!view) return;
  const keys = editor.selection.size > 1 ? editor.selection : new Set(view.boxes.keys());
  const { x, y } = boundsOf([...view.boxes.values()].filter(({ key }) => keys.has(key)));
  put(editor, tidied(view, keys, { x, y }));
  editor.canvas.fit();
}
function put(editor: Editor, places: Map<string, Place>): void {
  for (const [key, place] of places) Object.assign(editor.view!.boxes.get(key)!, place);
  editor.canvas.place(places.keys());
  editor.keepPlaces(places.keys());
}
/** With the keyboard: so far to the side. */
export function nudge(editor: Editor, x: number, y: number): void {
  put(editor, new Map(editor.chosenBoxes.map((box) => [box.key, { x: box.x + x, y: box.y + y }])));
}

/** A frame with a text around what is chosen, or in the middle of the window. */
export function comment(editor: Editor): void {
  const { view, canvas } = editor;
  if (!view) return;
  const { left, top, width, height } = canvas.root.getBoundingClientRect();
  const middle = canvas.toWorld(left + width / 2 - 80, top + height / 2 - 50);
  const around = editor.selection.size > 0 ? boundsOf(editor.chosenBoxes) : { ...middle, width: 200, height: 90 };
  const made = { x: Math.round(around.x - 16), y: Math.round(around.y - 40), width: Math.round(around.width + 32), height: Math.round(around.height + 56), text: '' };
  editor.setComments([...view.comments, made]);
  canvas.comments.querySelector<HTMLElement>(`[data-comment="${editor.view!.comments.length - 1}"] input`)?.focus();
}

// ---- copy and paste

interface Copied {
  lacquer_boxes: 1;
  nodes: Record<string, unknown>[];
  parameters: Full['parameters'];
  textures: Full['textures'];
  groups: NonNullable<Full['groups']>;
}

/** What is chosen as JSON, with what it needs: parameters, textures, groups. */
export function copied(editor: Editor): string {
  const { json, group } = editor;
  const names = new Set(editor.chosenBoxes.filter(isNode).map(({ name }) => name));
  const body = group ? (json?.groups?.[group] as unknown as Full | undefined) : json;
  const nodes = ((body?.nodes ?? []) as unknown as Record<string, unknown>[]).filter(({ id }) => names.has(id as string)).map((node) => {
    const box = [...editor.view!.boxes.values()].find((each) => isNode(each) && each.name === node.id);
    return { ...node, ui: { ...uiOf(node.ui), ...(box ? { x: box.x, y: box.y } : {}) } };
  });
  const text = JSON.stringify(nodes);
  const chosen = (kind: string) => new Set([
    ...[...text.matchAll(new RegExp(`"${kind}":"([^"]+)"`, 'g'))].map((match) => match[1]),
    ...editor.chosenBoxes.filter((box) => box.kind === kind).map(({ name }) => name),
  ]);
  const some = <T>(all: Record<string, T> | undefined, wanted: Set<string>) => Object.fromEntries(Object.entries(all ?? {}).filter(([name]) => wanted.has(name)));
  const groups = chosen('group');
  for (const name of groups) for (const match of JSON.stringify(json?.groups?.[name] ?? {}).matchAll(/"group":"([^"]+)"/g)) groups.add(match[1]);
  const made: Copied = {
    [kClipboard]: 1, nodes, parameters: some(json?.parameters, chosen('parameter')), textures: some(json?.textures, chosen('texture')), groups: some(json?.groups, groups),
  };
  return nodes.length > 0 || Object.keys(made.parameters).length > 0 ? JSON.stringify(made) : '';
}

/** Whether the text was one of ours; what it has is added under new names, its wires to what is not there are said. */
export function paste(editor: Editor, text: string, shift = 32): boolean {
  let of: Copied;
  try {
    of = JSON.parse(text) as Copied;
  } catch {
    return false;
  }
  if (of?.[kClipboard] !== 1 || !Array.isArray(of.nodes) || !editor.view) return false;
  const { json, group, view } = editor;
  const edits: GraphEdit[] = [];
  for (const kind of ['group', 'parameter', 'texture'] as const) {
    const there = json?.[`${kind}s`] ?? {};
    for (const [name, as] of Object.entries(of[`${kind}s`] ?? {})) if (!(name in there)) edits.push({ do: `add_${kind}`, [kind]: name, as });
  }
  const taken = new Set([...view.boxes.values()].map(({ name }) => name));
  const ids = new Map<string, string>();
  for (const { id } of of.nodes) {
    const name = fresh(id as string, taken);
    taken.add(name);
    ids.set(id as string, name);
  }
  let lost = 0;
  const added: string[] = [];
  const connects: GraphEdit[] = [];
  for (const node of of.nodes) {
    const id = ids.get(node.id as string)!;
    const ui = uiOf(node.ui);
    const { term: _term, place: _place, ...rest } = node;
    added.push(`${node.group ? 'group' : 'node'} ${id}`);
    edits.push(addition(group, { ...rest, id, inputs: {}, ui: { ...ui, x: Number(ui.x ?? 0) + shift, y: Number(ui.y ?? 0) + shift } }));
    for (const [input, source] of Object.entries((node.inputs ?? {}) as Record<string, GraphSource>)) {
      const mapped = remapped(source, ids);
      if (isThere(editor, mapped, ids, of)) connects.push({ do: 'connect', node: pathOf(group, id), input, source: mapped });
      else ++lost;
    }
  }
  if (editor.edit([...edits, ...connects]) && added.length > 0) {
    editor.choose(added.filter((key) => editor.view?.boxes.has(key)));
    editor.canvas.elementOf(added[0])?.focus({ preventScroll: true });
  }
  if (lost > 0) editor.host.say(`${lost} input${lost > 1 ? 's' : ''} of what was pasted had a source that is not here, and have none now`);
  return true;
}
function remapped(source: GraphSource, ids: Map<string, string>): GraphSource {
  return typeof source === 'object' && 'node' in source && ids.has(source.node) ? { ...source, node: ids.get(source.node)! } : source;
}
function isThere(editor: Editor, source: GraphSource, ids: Map<string, string>, of: Copied): boolean {
  if (typeof source !== 'object' || Array.isArray(source) || 'value' in source || 'given' in source) return true;
  if ('parameter' in source) return source.parameter in (editor.json?.parameters ?? {}) || source.parameter in of.parameters;
  if ('texture' in source) return true;
  return originOf(editor.view!.boxes, source) !== null || ('node' in source && [...ids.values()].includes(source.node));
}

/** The same again, a little lower. */
export function duplicate(editor: Editor): void {
  const text = copied(editor);
  if (text) paste(editor, text);
}
