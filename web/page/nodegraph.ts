// The node graph as SVG, laid out by dagre, a colour for each rate.
import { graphlib, layout } from '@dagrejs/dagre';
import type { GraphJson, GraphSource } from '../src/index';
import { h, svg } from './dom';

export const kRates = ['constant', 'material', 'frame', 'vertex', 'fragment', 'light'];

/** The fastest rate of each term's values, and how many operations there are of each rate, from a dump. */
export function ratesOf(dump: string): { terms: Map<string, string>; operations: Map<string, number> } {
  const terms = new Map<string, string>();
  const operations = new Map<string, number>();
  let term = '';
  for (const line of dump.split('\n')) {
    const head = /^; ([\w.]+)/.exec(line);
    if (head) term = head[1];
    const rate = /; (\w+)(?: \S+)?$/.exec(line)?.[1];
    if (!line.startsWith('  ') || !rate || !kRates.includes(rate)) continue;
    operations.set(rate, (operations.get(rate) ?? 0) + 1);
    const before = terms.get(term);
    if (before === undefined || kRates.indexOf(rate) > kRates.indexOf(before)) terms.set(term, rate);
  }
  return { terms, operations };
}

const nodeOf = (source: GraphSource | undefined): string | null =>
  typeof source === 'object' && source !== null && 'node' in source ? source.node : null;

export class NodeGraph {
  private zoom = 1;
  private size = { width: 1, height: 1 };
  private picture: SVGElement | null = null;

  constructor(private readonly root: HTMLElement, private readonly chosen: (node: string) => void) {
    root.addEventListener('wheel', (event) => {
      if (!event.ctrlKey) return;
      event.preventDefault();
      this.setZoom(this.zoom * Math.exp(-event.deltaY / 300));
    }, { passive: false });
  }

  show(graph: GraphJson, rates: Map<string, string>): void {
    const laid = new graphlib.Graph();
    laid.setGraph({ rankdir: 'LR', nodesep: 14, ranksep: 46, marginx: 12, marginy: 12 });
    laid.setDefaultEdgeLabel(() => ({}));
    const widthOf = (text: string) => Math.max(70, 7.2 * text.length + 20);
    for (const { id } of graph.nodes) laid.setNode(id, { width: widthOf(id), height: 30 });
    for (const port of Object.keys(graph.outputs)) laid.setNode(`→${port}`, { width: widthOf(port), height: 30 });
    const edge = (from: string | null, to: string) => {
      if (from !== null && laid.hasNode(from)) laid.setEdge(from, to);
    };
    for (const { id, inputs } of graph.nodes) for (const source of Object.values(inputs ?? {})) edge(nodeOf(source), id);
    for (const [port, source] of Object.entries(graph.outputs)) edge(nodeOf(source), `→${port}`);
    layout(laid);
    const { width = 1, height = 1 } = laid.graph();
    this.size = { width, height };
    const edges = laid.edges().map(({ v, w }) => {
      const points = laid.edge(v, w).points as { x: number; y: number }[];
      const path = points.map(({ x, y }, i) => `${i === 0 ? 'M' : 'L'}${x.toFixed(1)} ${y.toFixed(1)}`).join('');
      return svg('path', { d: path, class: 'edge', 'data-from': v, 'data-to': w });
    });
    const nodes = laid.nodes().map((id) => this.box(graph, id, laid.node(id), rates.get(id)));
    this.picture = svg('svg', { viewBox: `0 0 ${width} ${height}`, role: 'group', 'aria-label': 'Node graph' }, ...edges, ...nodes);
    this.root.replaceChildren(this.picture);
    this.setZoom(this.zoom);
  }

  private box(graph: GraphJson, id: string, at: { x: number; y: number; width: number; height: number }, rate?: string): SVGElement {
    const of = graph.nodes.find((node) => node.id === id);
    const label = of ? `${id}: ${of.node}${of.variant ? `, variant ${of.variant}` : ''}${rate ? `, rate ${rate}` : ''}` : `port ${id.slice(1)}`;
    const choose = () => of && this.chosen(id);
    return svg(
      'g',
      {
        class: `node ${of ? rate ?? 'none' : 'port'}`, 'data-node': id, transform: `translate(${at.x - at.width / 2} ${at.y - at.height / 2})`,
        tabindex: of ? 0 : -1, role: 'button', 'aria-label': label, click: choose,
        keydown: (event: KeyboardEvent) => {
          if (event.key !== 'Enter' && event.key !== ' ') return;
          event.preventDefault();
          choose();
        },
      },
      svg('title', {}, label),
      svg('rect', { width: at.width, height: at.height, rx: 5 }),
      svg('text', { x: at.width / 2, y: 19 }, of ? id : id.slice(1)),
    );
  }

  select(id: string, scroll: boolean): void {
    for (const node of this.root.querySelectorAll<SVGElement>('.node')) {
      const selected = node.dataset.node === id;
      node.classList.toggle('selected', selected);
      if (selected && scroll) node.scrollIntoView({ block: 'nearest', inline: 'center' });
    }
    for (const edge of this.root.querySelectorAll<SVGElement>('.edge'))
      edge.classList.toggle('selected', edge.dataset.from === id || edge.dataset.to === id);
  }

  setZoom(zoom: number): void {
    this.zoom = Math.min(Math.max(zoom, 0.15), 3);
    this.picture?.setAttribute('width', String(this.size.width * this.zoom));
    this.picture?.setAttribute('height', String(this.size.height * this.zoom));
  }
  get zoomed(): number {
    return this.zoom;
  }
}

/** What can be done to a node: its inputs as text, and its removal. */
export function nodeEditor(
  graph: GraphJson,
  id: string,
  library: { name: string; doc: string; inputs: { name: string; type: string; range?: (number | null)[] }[] }[],
  act: { connect: (input: string, source: string) => void; remove: () => void },
): HTMLElement {
  const node = graph.nodes.find((each) => each.id === id);
  if (!node) return h('div');
  const declared = library.find(({ name }) => name === node.node);
  const names = declared?.inputs.map(({ name }) => name) ?? Object.keys(node.inputs ?? {});
  return h(
    'div',
    { class: 'editor' },
    h('h3', {}, id, h('small', {}, ` ${node.node}`)),
    h('p', { class: 'doc' }, declared?.doc ?? ''),
    ...names.map((name) => {
      const source = node.inputs?.[name];
      const field = h('input', { type: 'text', value: source === undefined ? '' : JSON.stringify(source), placeholder: 'its default', spellcheck: 'false', 'aria-label': `source of ${name}` });
      field.addEventListener('change', () => act.connect(name, field.value));
      const type = declared?.inputs.find((input) => input.name === name)?.type ?? '';
      return h('label', { class: 'row' }, h('span', { class: 'name' }, name, h('small', {}, ` ${type}`)), field);
    }),
    h('button', { type: 'button', click: act.remove }, 'Remove the node'),
  );
}
