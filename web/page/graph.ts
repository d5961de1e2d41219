// The panel with the node graph: the editor on the page's document, and its buttons.
import { LacquerError, type Graph, type GraphEdit, type Message, type Options } from '../src/index';
import { graphOf } from './compile';
import { byId, download } from './dom';
import * as actions from './editor/actions';
import { Editor, type Host, type LibraryNode } from './editor/editor';
import type { Place } from './editor/view';
import type { Page } from './main';
import { texturesOf } from './textures';

export class GraphPane implements Host {
  readonly editor: Editor;

  constructor(private readonly page: Page) {
    this.editor = new Editor(byId('graph'), byId('editor'), this);
    const { editor } = this;
    const on = (id: string, act: () => void) => byId(id).addEventListener('click', act);
    on('zoom-in', () => editor.canvas.zoomBy(1.25));
    on('zoom-out', () => editor.canvas.zoomBy(0.8));
    on('fit', () => editor.canvas.fit());
    on('tidy', () => actions.tidy(editor));
    on('align-left', () => actions.align(editor, 'left'));
    on('align-top', () => actions.align(editor, 'top'));
    on('make-group', () => actions.makeGroup(editor));
    on('dissolve', () => actions.dissolve(editor));
    on('add-comment', () => actions.comment(editor));
    on('add-node', () => {
      const { left, top } = byId('graph').getBoundingClientRect();
      editor.addAt(left + 40, top + 40);
    });
    on('wide', () => {
      const wide = document.body.classList.toggle('wide');
      byId('wide').setAttribute('aria-pressed', String(wide));
      editor.canvas.fit();
    });
    on('export-graph', () => this.export());
  }

  show(of: string, rates: Map<string, string>): void {
    try {
      this.editor.show(of, rates);
    } catch (error) {
      if (!(error instanceof LacquerError)) throw error;
      this.clear();
    }
  }
  /** Numbers are changing: no value is drawn before they rest. */
  pause(): void {
    this.editor.thumbs.stop();
  }
  /** Nothing of it changed but numbers. */
  follow(): void {
    this.editor.resume();
  }
  clear(): void {
    this.editor.clear();
    this.editor.canvas.draw({ group: '', boxes: new Map(), wires: [], comments: [], ui: {} }, new Map());
    byId('editor').replaceChildren();
  }
  lead(node: string): void {
    this.editor.lead(node);
  }
  mark(messages: Message[]): void {
    this.editor.mark(messages);
  }

  private export(): void {
    const { document: of } = this.page;
    if (!of?.names.length) return;
    const graph = this.open();
    download(`${of.names[of.material] || 'material'}.json`, graph.toText(), 'application/json');
    graph.free();
  }

  // ---- what the editor asks

  open(): Graph {
    const { page } = this;
    return graphOf(page.lacquer, page.document!, page.options(), []);
  }
  isOwn(): boolean {
    const { document: of } = this.page;
    return of !== null && of.graphs.has(of.material);
  }
  places(): Map<string, Place> {
    return new Map(Object.entries(JSON.parse(this.page.document?.layout || '{}') as Record<string, Place>));
  }
  keepPlaces(places: Map<string, Place>): void {
    const { page } = this;
    page.document?.setLayout(JSON.stringify(Object.fromEntries(places)));
    page.isNew('graph', `${page.structure()} ${page.document?.layout}`);
    page.showWays();
  }
  edit(edits: GraphEdit[]): Message[] {
    return this.page.editGraph((graph) => void graph.edit(edits));
  }
  chosen(term: string): void {
    this.page.select(term, 'graph');
  }
  options(): Options {
    return this.page.options();
  }
  values(): Record<string, number | number[]> {
    return Object.fromEntries(Object.entries(this.page.graphJson?.parameters ?? {}).map(([name, { value }]) => [name, value as number | number[]]));
  }
  setValue(parameter: string, value: number | number[]): void {
    this.page.setParameter(parameter, value);
  }
  nodes(): LibraryNode[] {
    return this.page.nodes.nodes;
  }
  givens(template: string): { name: string; type: string }[] {
    return this.page.nodes.templates.find(({ name }: { name: string }) => name === template)?.gives ?? [];
  }
  textures(): { index: number; name: string }[] {
    return this.page.document ? texturesOf(this.page.document) : [];
  }
  say(text: string): void {
    this.page.note(text);
  }
}
