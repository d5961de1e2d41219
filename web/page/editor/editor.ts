// The graph editor: what is looked at and chosen, and the edits that the library makes of what a person does.
import type { Graph, GraphEdit, GraphSource, Message, Options } from '../../src/index';
import { byId, h } from '../dom';
import { Canvas, type PortAt } from './canvas';
import { connectGestures } from './gestures';
import { Inspector } from './inspector';
import { openPalette, type Entry } from './palette';
import { settle } from './place';
import { Thumbs } from './thumbs';
import {
  connectEdit, kNewOutput, placeEdits, sourceOf, viewOf, type Box, type Full, type Place, type View, type Wire,
} from './view';

/** A node of the library, as `nodes()` lists it. */
export interface LibraryNode {
  name: string;
  doc: string;
  source: string;
  category: string;
  file: string;
  inputs: { name: string; type: string; range?: (number | null)[]; default?: unknown; given?: string; meaning?: string; choices?: string[]; unit?: string; soft?: number[]; color?: boolean }[];
  outputs: { name: string; type: string; range?: (number | null)[]; meaning?: string }[];
  variants: { name: string }[] | string[];
}

/** What the editor needs of the page. */
export interface Host {
  /** The graph as it is now; the caller frees it. */
  open(): Graph;
  /** Whether the graph is the file's own, or made of the material's properties. */
  isOwn(): boolean;
  /** Where boxes are of a graph that is made of properties: it has no place for that itself. */
  places(): Map<string, Place>;
  keepPlaces(places: Map<string, Place>): void;
  /** All of them or none; what is wrong. */
  edit(edits: GraphEdit[]): Message[];
  chosen(term: string): void;
  options(): Options;
  /** Of the parameters, as the picture has them now. */
  values(): Record<string, number | number[]>;
  setValue(parameter: string, value: number | number[]): void;
  nodes(): LibraryNode[];
  /** Names of what the template gives, with their types. */
  givens(template: string): { name: string; type: string }[];
  /** The file's. */
  textures(): { index: number; name: string }[];
  say(text: string): void;
}

/** Something that a refused wire offers instead. */
export interface Offer {
  label: string;
  act: () => void;
}

export class Editor {
  readonly canvas: Canvas;
  readonly inspector: Inspector;
  readonly thumbs: Thumbs;
  graph: Graph | null = null;
  json: Full | null = null;
  selection = new Set<string>();
  wire: Wire | null = null;
  /** Groups that were entered, the last one innermost. */
  path: string[] = [];
  /** The instances through which they were entered. */
  private instances: string[] = [];
  private bubble: HTMLElement | null = null;
  private fitted = '';
  private leading = ''; // a node that the code led to while this was not seen
  private rates = new Map<string, string>();

  constructor(readonly root: HTMLElement, inspector: HTMLElement, readonly host: Host) {
    this.canvas = new Canvas(root);
    this.inspector = new Inspector(inspector, this);
    this.thumbs = new Thumbs(
      () => this.graph && this.view && { graph: this.graph, view: this.view, within: this.instances, options: this.host.options(), values: this.host.values() },
      (box) => root.offsetParent !== null && this.canvas.isSeen(box),
    );
    this.canvas.drawValue = (box, canvas) => this.thumbs.hold(box, canvas);
    connectGestures(this);
  }

  get view(): View | null {
    return this.canvas.view;
  }
  get group(): string {
    return this.path[this.path.length - 1] ?? '';
  }
  get chosenBoxes(): Box[] {
    return [...this.selection].map((key) => this.view?.boxes.get(key)).filter((box): box is Box => box !== undefined);
  }

  /** Shows the graph of the page anew. `of` names it: what is looked at stays as long as that does. */
  show(of: string, rates: Map<string, string>): void {
    const focused = this.focusNow();
    this.clear();
    this.graph = this.host.open();
    this.json = JSON.parse(this.graph.toText()) as Full;
    this.path = this.path.filter((group) => this.json?.groups?.[group]);
    this.rates = rates;
    this.draw();
    if (this.fitted !== of) {
      this.canvas.fit();
      this.selection.clear();
      this.fitted = of;
    }
    this.select([...this.selection].filter((key) => this.view?.boxes.has(key)));
    focused?.();
    if (this.leading) this.lead(this.leading);
  }
  /** It is seen again, or numbers have changed. */
  resume(): void {
    if (this.leading) this.lead(this.leading);
    this.thumbs.later();
  }
  clear(): void {
    this.closeBubble();
    this.thumbs.forget();
    this.graph?.free();
    this.graph = null;
    this.wire = null;
  }
  private draw(): void {
    const view = viewOf(this.graph!, this.json!, this.group);
    settle(view, this.host.isOwn() ? new Map() : this.host.places());
    this.canvas.draw(view, this.rates);
    this.drawComments();
    this.showPath();
    this.thumbs.later();
  }

  private drawComments(): void {
    const { comments } = this.view!;
    this.canvas.comments.replaceChildren(
      ...comments.map(({ x, y, width, height, text }, i) => {
        const field = h('input', { type: 'text', value: text, 'aria-label': 'Comment', placeholder: 'a comment' });
        field.addEventListener('change', () => this.setComments(comments.map((each, k) => (k === i ? { ...each, text: field.value } : each))));
        const element = h('div', { class: 'note', 'data-comment': i }, field, h('i', { class: 'corner', 'data-corner': i }));
        Object.assign(element.style, { left: `${x}px`, top: `${y}px`, width: `${width}px`, height: `${height}px` });
        return element;
      }),
    );
  }
  setComments(comments: View['comments'], more: GraphEdit[] = []): void {
    const { view } = this;
    if (!view) return;
    view.ui = { ...view.ui, comments: comments.length > 0 ? comments : undefined };
    this.edit([...more, view.group ? { do: 'set_ui', group: view.group, ui: view.ui } : { do: 'set_ui', ui: view.ui }]);
  }

  /** What has the focus, so that it has it again when all is made anew. */
  private focusNow(): (() => void) | null {
    const at = document.activeElement;
    if (!at || !this.root.contains(at)) return this.inspector.focusNow();
    const box = this.canvas.boxAt(at);
    const port = this.canvas.portAt(at);
    return () => {
      const element = (port && this.canvas.portElement(port)) ?? (box && this.canvas.elementOf(box.key)) ?? this.root;
      element.focus({ preventScroll: true });
    };
  }

  // ---- what is chosen

  select(keys: string[], wire: Wire | null = null): void {
    this.selection = new Set(keys);
    this.wire = wire;
    this.canvas.showSelected(this.selection, wire);
    this.inspector.show();
    this.showCounts();
  }
  /** As a person does: the code follows. */
  choose(keys: string[], wire: Wire | null = null): void {
    this.select(keys, wire);
    const [box] = this.chosenBoxes;
    if (box && keys.length === 1 && (box.kind === 'node' || box.kind === 'group')) this.host.chosen(box.name);
  }
  /** A node that the code leads to. */
  lead(node: string): void {
    this.leading = '';
    if (!this.graph || this.root.offsetParent === null) {
      this.leading = node;
      return;
    }
    const key = [`node ${node}`, `group ${node}`].find((each) => this.view?.boxes.has(each));
    if (!key) return;
    this.select([key]);
    this.canvas.reveal(key);
  }
  private showCounts(): void {
    const nodes = this.chosenBoxes.filter(({ kind }) => kind === 'node' || kind === 'group');
    const set = (id: string, on: boolean) => (byId<HTMLButtonElement>(id).disabled = !on);
    set('make-group', nodes.length > 0);
    set('dissolve', nodes.some(({ kind }) => kind === 'group'));
    for (const id of ['align-left', 'align-top']) set(id, this.selection.size > 1);
  }

  // ---- groups as places to be

  enter(instance: Box): void {
    if (instance.kind !== 'group') return;
    this.goTo([...this.path, instance.type], [...this.instances, instance.name]);
  }
  goTo(path: string[], instances = this.instances.slice(0, path.length)): void {
    this.path = path;
    this.instances = instances;
    this.closeBubble();
    this.thumbs.forget();
    this.selection.clear();
    this.draw();
    this.canvas.fit();
    this.select([]);
    this.root.focus();
  }
  private showPath(): void {
    const names = ['Graph', ...this.path];
    byId('path').replaceChildren(
      ...names.map((name, i) => h('button', { type: 'button', class: 'quiet', disabled: i === names.length - 1, click: () => this.goTo(this.path.slice(0, i)) }, name)),
    );
    byId('path').hidden = this.path.length === 0;
  }

  // ---- edits

  /** Makes them, or says at the place why not; whether they were made. */
  edit(edits: GraphEdit[], near?: HTMLElement | null, offers: (messages: Message[]) => Offer[] = () => []): boolean {
    const messages = this.host.edit([...this.ownPlaces(), ...edits]);
    if (messages.length === 0) return true;
    this.refuse(messages, near ?? null, offers(messages));
    return false;
  }
  /** A graph that is made of properties has its boxes' places from now on. */
  private ownPlaces(): GraphEdit[] {
    if (this.host.isOwn() || !this.view || this.view.group) return [];
    return placeEdits(this.view, new Map([...this.view.boxes.values()].map((box) => [box.key, { x: box.x, y: box.y }])));
  }

  /** Boxes are where they are now: kept in the graph, or beside it while it is made of properties. */
  keepPlaces(keys: Iterable<string>, comments = false): void {
    const view = this.view!;
    const places = new Map([...keys].map((key) => [key, view.boxes.get(key)!]).filter(([, box]) => box) as [string, Box][]);
    if (!this.host.isOwn() && !comments) return this.host.keepPlaces(new Map([...view.boxes].map(([key, { x, y }]) => [key, { x, y }])));
    const edits = placeEdits(view, places);
    if (comments) this.setComments(view.comments, edits);
    else if (edits.length > 0) this.edit(edits);
  }

  /** Connects an output with an input; what the library says against it is told at the input, with what would do. */
  connect(from: PortAt, to: PortAt): boolean {
    const source = sourceOf(from.box, from.index);
    const port = to.port.name === kNewOutput ? this.freshOutput(from.port.name || from.box.name) : to.port.name;
    const made = (given: GraphSource) => connectEdit(this.group, to.box, port, given);
    return this.edit([made(source)], this.canvas.portElement(to), (messages) => this.offers(messages, from, to, (given) => this.edit([made(given)], this.canvas.portElement(to))));
  }
  private freshOutput(wanted: string): string {
    const names = new Set(this.view?.boxes.get('outputs ')?.inputs.map(({ name }) => name));
    return fresh(wanted.replace(/\W+/g, '_'), names);
  }
  /** The swizzles, and the nodes between, that the library names. */
  private offers(messages: Message[], from: PortAt, to: PortAt, connect: (source: GraphSource) => void): Offer[] {
    const error = messages.find(({ code }) => code === 'wrong-type');
    if (!error) return [];
    const source = sourceOf(from.box, from.index) as { node: string };
    const offers: Offer[] = [];
    const named = /"swizzle": "(\w+)"/.exec(error.help)?.[1];
    if (named) {
      const all = named.length === 1 ? [...'rgba'.slice(0, Number(from.port.type.slice(3)))] : [named];
      for (const swizzle of all) offers.push({ label: `.${swizzle}`, act: () => connect({ ...source, swizzle }) });
    }
    const between = [...error.help.matchAll(/'([^']+)'/g)].map((match) => match[1]);
    const nodes = between.map((name) => this.host.nodes().find((each) => each.name === name)).filter((node) => node !== undefined);
    const gives = (node: LibraryNode) => node.outputs.some(({ type }) => type === to.port.type);
    for (const node of nodes.sort((a, b) => Number(gives(b)) - Number(gives(a)))) {
      const { name } = node;
      const input = node.inputs.find(({ type }) => type === from.port.type);
      if (!input) continue;
      offers.push({
        label: `through ${name}`,
        act: () => {
          const id = this.freshId(name);
          const at = { x: Math.round((from.box.x + to.box.x) / 2), y: Math.round((from.box.y + to.box.y) / 2) };
          const output = node.outputs.length > 1 ? { output: node.outputs.find(({ type }) => type === to.port.type)?.name ?? node.outputs[0].name } : {};
          this.edit([
            { do: 'add_node', node: { id, node: name, inputs: { [input.name]: source }, ui: at } as unknown as string },
            connectEdit(this.group, to.box, to.port.name, { node: id, ...output }),
          ], this.canvas.portElement(to));
        },
      });
    }
    return offers;
  }

  /** An id that no node of the view has. */
  freshId(type: string): string {
    return fresh(type.replace(/[^\w.]+/g, '_').replace(/_+$/, ''), new Set([...(this.view?.boxes.values() ?? [])].map(({ name }) => name)));
  }

  /** Says at a place what is wrong, and offers what would do. */
  refuse(messages: Message[], near: HTMLElement | null, offers: Offer[] = []): void {
    this.closeBubble();
    const errors = messages.filter(({ level }) => level === 'error');
    const said = (errors.length > 0 ? errors : messages).slice(0, 3);
    const close = () => this.closeBubble();
    const bubble = h(
      'div',
      { class: 'bubble', role: 'alert', keydown: (event: KeyboardEvent) => event.key === 'Escape' && (close(), this.root.focus()) },
      ...said.map(({ message, help }) => h('p', {}, message, ...(help ? [h('small', {}, help)] : []))),
      h('div', { class: 'offers' }, ...offers.map(({ label, act }) => h('button', { type: 'button', click: () => (close(), act()) }, label)),
        h('button', { type: 'button', class: 'quiet', click: close }, 'Leave it')),
    );
    this.root.append(bubble);
    const frame = this.root.getBoundingClientRect();
    const at = near?.getBoundingClientRect();
    const left = at ? at.left - frame.left + 12 : 12;
    const top = at ? at.bottom - frame.top + 4 : 12;
    bubble.style.left = `${Math.max(8, Math.min(left, frame.width - bubble.offsetWidth - 8))}px`;
    bubble.style.top = `${Math.max(8, Math.min(top, frame.height - bubble.offsetHeight - 8))}px`;
    this.bubble = bubble;
    bubble.querySelector('button')?.focus();
  }
  closeBubble(): void {
    this.bubble?.remove();
    this.bubble = null;
  }

  /** Marks what messages point at: nodes and their inputs. */
  mark(messages: Message[]): void {
    for (const element of this.root.querySelectorAll('.wrong')) element.classList.remove('wrong');
    for (const { level, pointer, message } of messages) {
      const at = /^\/(?:groups\/([^/]+)\/)?nodes\/(\d+)(?:\/inputs\/([^/]+))?/.exec(pointer);
      if (level !== 'error' || !at || (at[1] ?? '') !== this.group) continue;
      const id = this.graph?.nodes(this.group)[Number(at[2])]?.id;
      const element = this.canvas.elementOf(`node ${id}`) ?? this.canvas.elementOf(`group ${id}`);
      if (!element) continue;
      element.classList.add('wrong');
      element.title = message;
      if (at[3]) element.querySelector(`[data-port="${CSS.escape(at[3])}"]`)?.classList.add('wrong');
    }
  }

  // ---- adding

  /** The palette at a place of the window; with a port what fits it, which is then connected. */
  addAt(clientX: number, clientY: number, port: PortAt | null = null): void {
    const place = this.canvas.toWorld(clientX, clientY);
    openPalette(this, clientX, clientY, port, (entry) => this.add(entry, place, port));
  }
  private add(entry: Entry, place: Place, port: PortAt | null): void {
    const { edits, key, source, input } = entry.make(this, { x: Math.round(place.x), y: Math.round(place.y) }, port);
    const join: GraphEdit[] = [];
    if (port?.side === 'in' && source) join.push(connectEdit(this.group, port.box, port.port.name === kNewOutput ? this.freshOutput('result') : port.port.name, source));
    if (port?.side === 'out' && input) join.push({ do: 'connect', ...input, source: sourceOf(port.box, port.index) });
    const near = port && this.canvas.portElement(port);
    if (!this.edit([...edits, ...join], near)) return;
    if (key && this.view?.boxes.has(key)) {
      this.choose([key]);
      this.canvas.reveal(key);
      this.canvas.elementOf(key)?.focus({ preventScroll: true });
    }
  }
}

/** A name that is not among them. */
export function fresh(wanted: string, names: Set<string>): string {
  if (wanted && !names.has(wanted)) return wanted;
  for (let i = 2; ; ++i) if (!names.has(`${wanted}_${i}`)) return `${wanted}_${i}`;
}
