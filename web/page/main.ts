// The page of `lacquer view`: a material's properties, its picture, its shaders and its node graph, all from one file that
// is edited in place.
import { LacquerError, type Graph, type GraphJson, type Lacquer, type Level, type Message, type Options } from '../src/index';
import { Around } from './around';
import { Cameras } from './cameras';
import { connectCode, selectTerm, showCode } from './code';
import { fillOthers, fillVariants, optionsOf, parseOther } from './compare';
import { compiler, graphOf, lookOf, withShader } from './compile';
import { connectPointer, connectTabs } from './controls';
import { costTable, errorTable, type Costs, type Errors } from './costs';
import { Document, type Input } from './document';
import { byId, download, h, tell } from './dom';
import { Files } from './files';
import { fromBase64 } from '../src/gltf';
import { Generated } from './generated';
import { GpuPainter } from './gpu';
import { GraphPane } from './graph';
import { kOwnNodes, NodeText } from './nodetext';
import { Player } from './player';
import { kOffered, Printed, type Stage } from './printed';
import { Properties } from './properties';
import { kRates, ratesOf } from './rates';
import { Viewport, type Look } from './viewport';

/** Milliseconds of work on other materials between two frames. */
const kSlice = 8;

/** As the material of geometry that has none. */
const kDefaultMaterial = -1;

/** What the page has in it beside the compiler. */
interface Figures {
  costs: Costs;
  errors: Errors;
  /** What its shaders are made with, where `lacquer view` was told. */
  options: Options;
}

export class Page {
  private of: Document | null = null;
  private readonly properties: Properties;
  private readonly graph: GraphPane;
  nodes: any;
  private readonly nodeText: NodeText;
  readonly files: Files;
  readonly around: Around;
  readonly cameras: Cameras;
  private readonly player: Player;
  readonly printed: Printed;
  graphJson: GraphJson | null = null;
  selected = '';
  private panelsPending = 0;
  private messages: Message[] = [];
  private notice: Message[] = []; // of what was done last, and not of the material
  private otherId = '';
  private othersOf = ''; // the structure whose words `compare` offers
  private painter: GpuPainter | null = null;
  private turns = 0;
  private nodesOf = ''; // the text whose nodes `nodes` has
  /** Done when all that is seen has its look. */
  others: Promise<void> = Promise.resolve();
  /** Milliseconds that the last compilation took, from the edited file to the block. */
  took = 0;

  constructor(readonly lacquer: Lacquer, readonly viewport: Viewport, private readonly figures: Figures) {
    this.nodes = lacquer.nodes();
    this.properties = new Properties(byId('properties'), this.extensions(), {
      changed: (structure) => {
        if (structure) this.properties.show(this.of!);
        this.compile();
      },
      setParameter: (name, value, done) => this.setParameter(name, value, done),
      forgetGraph: () => this.forgetGraph(),
      fail: (error) => this.fail(error),
    });
    this.nodeText = new NodeText(lacquer, () => this.useNodes());
    this.graph = new GraphPane(this);
    byId('version').textContent = lacquer.version;
    this.fillSelects();
    this.printed = new Printed(this, new Generated(this.nodes, () => this.showText()));
    this.connectControls();
    this.files = new Files(this);
    this.around = new Around(this);
    this.cameras = new Cameras(this);
    this.player = new Player(this);
    connectPointer(viewport, {
      turnAround: (angle, done) => this.around.turnBy(angle, done), pick: (x, y) => this.pick(x, y),
      play: () => this.player.play(), step: (by) => this.player.step(by),
      byHand: () => this.cameras.leave(),
    });
    connectCode(this);
  }

  /** glTF's own first. */
  private extensions(): any[] {
    const order = (name: string) => (name === 'gltf' ? '' : name);
    return [...this.nodes.extensions].sort((a, b) => (order(a.name) < order(b.name) ? -1 : 1));
  }
  /** The library with the nodes of the document's own. */
  private useNodes(): void {
    if (!this.of) return;
    this.of.touch();
    this.of.nodeText = this.nodesOf = this.nodeText.good;
    this.nodes = this.lacquer.nodes(this.texts());
    this.properties.extensions = this.extensions();
    if (this.of.names.length > 0) this.properties.show(this.of);
    this.compile();
  }
  private texts(): Options {
    return this.of?.nodeText ? { node_texts: { [kOwnNodes]: this.of.nodeText } } : {};
  }

  // ---- files

  /** The document of a file; null, and a message, where it cannot be read. */
  read(input: Input): Document | null {
    try {
      return new Document(this.lacquer, input);
    } catch (error) {
      this.fail(error);
      return null;
    }
  }
  open(input: Input): void {
    const of = this.read(input);
    if (of) this.show(of);
  }
  show(of: Document): void {
    this.of = of;
    const { viewport } = this;
    this.nodeText.set(of.nodeText);
    if (this.nodesOf !== of.nodeText) {
      this.nodes = this.lacquer.nodes(this.texts());
      this.properties.extensions = this.extensions();
    }
    this.nodesOf = of.nodeText;
    viewport.forgetTextures();
    viewport.looks.clear();
    viewport.useBall = of.drawables.length === 0;
    byId<HTMLSelectElement>('shape').value = viewport.useBall ? 'ball' : 'own';
    byId<HTMLSelectElement>('shape').disabled = of.drawables.length === 0;
    fillVariants(byId<HTMLSelectElement>('variant'), of);
    this.cameras.open();
    this.player.open();
    viewport.setScene(of.drawables);
    this.othersOf = '';
    this.around.open();
    const materials = byId<HTMLSelectElement>('material');
    materials.replaceChildren(...of.names.map((name, i) => h('option', { value: i }, name || `(material ${i})`)));
    if (of.names.length > 0) this.choose(0);
    else this.showNoMaterial();
    this.compileOthers();
    const refused = of.refused.map((text) => `${text}; the properties are shown`);
    for (const text of [...refused, ...of.said.map(({ text }) => text), ...of.moves.said, ...of.cameras.said]) this.noteMore(text);
    this.files.changed();
  }

  /** A file without materials is seen as glTF's default one; there is nothing to edit. */
  private showNoMaterial(): void {
    this.graphJson = null;
    this.shownOf.clear();
    this.othersOf = '';
    this.viewport.shown = kDefaultMaterial;
    this.viewport.other = null;
    byId<HTMLSelectElement>('compare').replaceChildren(h('option', { value: '' }, 'nothing'));
    byId('comparing').hidden = true;
    this.properties.clear();
    this.graph.clear();
    for (const id of ['code', 'skipped', 'measured', 'errors-of-terms']) byId(id).replaceChildren();
    for (const id of ['id', 'took', 'size', 'operations', 'sizes']) byId(id).textContent = '';
    this.showWays();
    clearTimeout(this.panelsPending);
    this.notice = [];
    this.messages = [messageOf('this file has no materials: it is seen with the default one', 'note')];
    this.showMessages();
    this.viewport.redraw();
  }

  /** The looks of the other materials that are seen, between frames: a file may have hundreds. */
  private compileOthers(): void {
    const of = this.of!;
    const { looks } = this.viewport;
    const seen = new Set(of.drawables.map(({ material }) => material));
    for (const material of looks.keys()) if (material !== of.material && !seen.has(material)) looks.delete(material);
    if (of.names.length === 0) return this.compileDefault();
    seen.delete(of.material);
    const turn = ++this.turns;
    this.others = (async () => {
      let begin = -Infinity;
      for (const material of seen) {
        if (performance.now() - begin > kSlice) {
          this.viewport.redraw();
          await new Promise((done) => setTimeout(done));
          begin = performance.now();
        }
        if (turn !== this.turns) return;
        if (material !== of.material) this.compileOther(material);
      }
      this.viewport.redraw();
    })();
  }

  /** The look of a material that is not the current one. */
  private compileOther(material: number): Look | undefined {
    const of = this.of!;
    if (material === kDefaultMaterial) this.compileDefault();
    else if (material < of.names.length) {
      const chosen = of.material;
      of.material = material;
      this.compileLook([]);
      of.material = chosen;
    }
    return this.viewport.looks.get(material);
  }

  /** What is seen of geometry without a material. */
  private compileDefault(): void {
    const of = this.of!;
    const bare = of.drawables.find(({ material }) => material === kDefaultMaterial);
    const scene = this.lacquer.scene('{"asset": {"version": "2.0"}, "materials": [{}]}', 'default.gltf');
    const graph = scene.graph(0, this.options(), bare?.attributes.has('COLOR_0') ? ['NORMAL', 'COLOR_0'] : ['NORMAL']);
    const shader = graph.generate(this.options());
    this.viewport.prepare(shader);
    this.viewport.looks.set(kDefaultMaterial, { id: shader.id, block: shader.pack(), slots: new Map(), doubleSided: false, blended: false, pass: 'opaque' });
    for (const handle of [shader, graph, scene]) handle.free();
  }

  choose(material: number): void {
    if (!this.of?.names.length) return;
    this.of.material = material;
    this.of.settle();
    byId<HTMLSelectElement>('material').value = String(material);
    this.viewport.shown = material;
    this.properties.show(this.of);
    this.compile();
  }

  /** Chooses the material that is seen there. */
  private pick(x: number, y: number): void {
    const material = this.viewport.materialAt(x, y);
    if (material === undefined || !this.of || material === this.of.material) return;
    if (material === kDefaultMaterial || material >= this.of.names.length) return this.note('what is seen there has no material: it is drawn with the default one');
    this.choose(material);
  }

  /** The picture as it is seen, without the page. */
  private async savePicture(): Promise<void> {
    const { viewport } = this;
    const { gpu } = viewport;
    viewport.draw();
    const { width, height } = gpu?.canvas ?? viewport.canvas;
    const canvas = new OffscreenCanvas(width, height);
    const pixels = gpu ? await gpu.pixels(viewport, width, height) : viewport.pixels();
    canvas.getContext('2d')!.putImageData(new ImageData(new Uint8ClampedArray(pixels), width, height), 0, 0);
    const bytes = new Uint8Array(await (await canvas.convertToBlob({ type: 'image/png' })).arrayBuffer());
    download(`${(this.of?.file.name ?? 'lacquer').replace(/\.[^.]*$/, '')}.png`, bytes, 'image/png');
  }

  // ---- compiling

  options(): Options {
    const profile = byId<HTMLSelectElement>('profile').value;
    return { ...this.figures.options, ...this.texts(), profile, targets: this.viewport.gpu ? ['essl', 'wgsl'] : ['essl'] };
  }

  /** The look of the current material; null, and what is wrong in `messages`, when it has an error. */
  private compileLook(messages: Message[], options = this.options()): { look: Look; graph: GraphJson } | null {
    const of = this.of!;
    try {
      return withShader(this.lacquer, of, options, messages, (shader, graph) => {
        const json = graph.toJson();
        const look = lookOf(of, shader, json);
        this.viewport.prepare(shader);
        this.viewport.looks.set(of.material, look);
        void this.viewport.loadTextures(of.file, look);
        return { look, graph: json };
      });
    } catch (error) {
      if (!(error instanceof LacquerError)) messages.push(messageOf(error)); // of the browser's driver
      return null;
    }
  }

  /** Those that have a place in the graph act, whether the graph has an error or not. */
  private markProperties({ parameters = {}, textures = {} }: Partial<GraphJson>): void {
    const pointers = new Set([...Object.values(parameters), ...Object.values(textures)].map(({ pointer }) => pointer ?? ''));
    this.properties.mark({ pointers, own: this.of!.graphs.has(this.of!.material) });
  }

  compile(): void {
    if (!this.of?.names.length) return this.viewport.redraw();
    const begin = performance.now();
    this.graph.pause();
    this.messages = [];
    this.notice = [];
    const made = this.compileLook(this.messages);
    this.took = performance.now() - begin;
    if (made) {
      this.graphJson = made.graph;
      this.markProperties(made.graph);
      tell('id', made.look.id);
      const key = `${this.of.material} ${made.look.id} ${this.of.names.length}`;
      if (key !== this.othersOf) fillOthers(byId<HTMLSelectElement>('compare'), this.of, made.graph, this.nodes);
      this.othersOf = key;
    } else {
      // A graph of its own is shown with what is wrong in it.
      const text = this.of.graphs.get(this.of.material);
      if (text !== undefined) this.markProperties((this.graphJson = JSON.parse(text) as GraphJson));
      if (text !== undefined && !this.viewport.looks.has(this.of.material)) this.compileProperties(text);
    }
    tell('took', `${this.took.toFixed(1)} ms`);
    this.compare();
    this.viewport.redraw();
    this.showMessages();
    this.showWays();
    clearTimeout(this.panelsPending);
    this.panelsPending = window.setTimeout(() => this.showPanels(), 120);
  }

  /** Of a graph that was wrong from the start: what the properties say is seen. */
  private compileProperties(graph: string): void {
    const { graphs, material } = this.of!;
    graphs.delete(material);
    this.compileLook([]);
    graphs.set(material, graph);
  }

  /** Whether there is something to take back. */
  showWays(): void {
    byId<HTMLButtonElement>('undo').disabled = !this.of?.canUndo;
    byId<HTMLButtonElement>('redo').disabled = !this.of?.canRedo;
    this.files.changed();
  }

  /** Another look of the material, right of the cut, and how far it is from the first. */
  private compare(): void {
    const other = parseOther(byId<HTMLSelectElement>('compare').value);
    const { viewport } = this;
    const mine = this.of && viewport.looks.get(this.of.material);
    viewport.other = null;
    this.otherId = '';
    byId('comparing').hidden = !other;
    if (!other || !mine) return;
    const figures = byId('figures');
    const messages: Message[] = [];
    const theirs = other.kind === 'material' ? viewport.looks.get(other.index) ?? this.compileOther(other.index) : this.compileLook(messages, optionsOf(other, this.options()))?.look;
    viewport.looks.set(this.of!.material, mine);
    figures.className = theirs ? '' : 'error';
    if (!theirs) {
      figures.textContent = messages.find(({ level }) => level === 'error')?.message ?? 'there is nothing to compare with';
      return;
    }
    const shown = byId<HTMLSelectElement>('compared');
    shown.disabled = viewport.gpu !== null; // it is WebGL that draws the difference
    if (shown.disabled) shown.value = 'split';
    viewport.other = { look: theirs, split: Number(byId<HTMLInputElement>('split').value), difference: shown.value === 'difference' };
    this.otherId = theirs.id;
    const { max, mean } = viewport.difference(mine, theirs);
    const same = mine.id === theirs.id ? ', one shader' : '';
    figures.textContent = `differ by at most ${max.toPrecision(3)}, ${mean.toPrecision(3)} in the mean${same}`;
  }

  // ---- panels

  /** Only what changes them makes the panels anew: a slider that keeps the structure leaves them as they are. */
  private showPanels(): void {
    if (!this.of || !this.graphJson) return;
    const tab = document.querySelector<HTMLElement>('[role=tab][aria-selected=true]')!.dataset.tab;
    if (tab === 'code') this.showText();
    if (tab === 'graph') {
      if (this.isNew('graph', `${this.structure()} ${this.of.layout}`)) this.showGraph();
      else this.graph.follow();
    }
    if (tab === 'cost' && this.isNew('cost', `${this.structure()} ${this.otherId}`)) this.showCost();
    if (this.isNew('skipped', JSON.stringify(this.graphJson.skipped))) this.showSkipped();
  }
  private shownOf = new Map<string, string>();
  isNew(panel: string, of: string): boolean {
    const before = this.shownOf.get(panel);
    this.shownOf.set(panel, of);
    return before !== of;
  }
  /** Equal where code and graph are; numbers of the material are in neither. */
  structure(): string {
    const { parameters, skipped: _, ...rest } = this.graphJson!;
    const kinds = Object.entries(parameters).map(([name, { value: _value, ...kind }]) => [name, kind]);
    return JSON.stringify([this.of!.file.name, this.of!.material, byId('id').textContent, rest, kinds]);
  }

  private showText(): void {
    const target = byId<HTMLSelectElement>('target').value;
    const stage = byId<HTMLSelectElement>('stage').value as Stage;
    const code = byId('code');
    if (!this.of?.names.length || !this.isNew('code', `${this.structure()} ${JSON.stringify(this.printed.options(target))} ${stage}`)) return;
    try {
      const text = this.printed.text(target, stage);
      showCode(code, text, (term) => this.select(term, 'code'));
      byId('size').textContent = target === 'spirv' ? `${text.split(/\s+/).length} words` : `${new TextEncoder().encode(text).length} bytes`;
      if (this.selected) this.showTerm(true);
    } catch (error) {
      if (!(error instanceof LacquerError)) throw error;
      code.replaceChildren(error.message);
      byId('size').textContent = '';
    }
  }

  private dump(): string {
    const graph = graphOf(this.lacquer, this.of!, this.options(), []);
    try {
      return graph.dump('', this.options());
    } catch (error) {
      if (!(error instanceof LacquerError)) throw error;
      return '';
    } finally {
      graph.free();
    }
  }

  private showGraph(): void {
    const { terms } = ratesOf(this.dump());
    this.graph.show(`${this.of!.file.name} ${this.of!.material}`, terms);
    this.graph.mark(this.messages);
  }

  private showCost(): void {
    const { operations } = ratesOf(this.dump());
    byId('operations').textContent = kRates
      .filter((rate) => operations.has(rate))
      .map((rate) => `${operations.get(rate)} ${rate}`)
      .join(', ');
    const shaders: [string, string][] = [['left', byId('id').textContent ?? '']];
    if (this.otherId) shaders.push(['right', this.otherId]);
    byId('measured').replaceChildren(costTable(this.figures.costs, shaders));
    byId('sizes').textContent = this.printed.sizes();
    const choose = (word: string) => {
      byId<HTMLSelectElement>('compare').value = `simplify:${word}`;
      this.compile();
    };
    byId('errors-of-terms').replaceChildren(errorTable(this.graphJson!, this.figures.errors, choose));
  }

  private showSkipped(): void {
    byId('skipped').replaceChildren(
      ...Object.entries(this.graphJson!.skipped ?? {}).map(([term, reason]) => h('li', {}, h('b', {}, term), ` ${reason}`)),
    );
  }

  /** A term of the code is that of a node, or a node's: its lines and its box are shown. */
  select(name: string, from: 'code' | 'graph'): void {
    this.selected = from === 'graph' ? this.termOf(name) : name;
    this.showTerm(from === 'graph');
    if (from === 'code') this.graph.lead(this.nodeOf(name));
  }
  private showTerm(scroll: boolean): void {
    const found = selectTerm(byId('code'), this.selected, scroll);
    const hasTerms = byId('code').querySelector('.term') !== null; // SPIR-V, say, has none
    tell('code-told', found || !hasTerms || !this.nodeIs(this.selected) ? '' : `${this.selected} has no lines here: it is computed once for the material, or in another stage`);
  }
  private nodeIs(term: string): boolean {
    return this.nodesNow().some(({ id }) => this.termOf(id) === term);
  }
  /** The comments of the code have a node's term, or the library's name of it. */
  private termOf(id: string): string {
    const node = this.nodesNow().find((each) => each.id === id);
    return node?.term ?? node?.node ?? id;
  }
  private nodeOf(term: string): string {
    const nodes = this.nodesNow();
    return (nodes.find((node) => node.term === term) ?? nodes.find((node) => !node.term && node.node === term))?.id ?? term;
  }
  private nodesNow(): { id: string; node?: string; term?: string }[] {
    return this.graphJson?.nodes ?? [];
  }

  /** Edits the graph itself: from then on the material's numbers are its parameters, and its terms stay. What is wrong, where
   * nothing was changed. */
  editGraph(edit: (graph: Graph) => void): Message[] {
    if (!this.of?.names.length) return [];
    const graph = graphOf(this.lacquer, this.of, this.options(), []);
    try {
      edit(graph);
      this.of.setGraph(graph.toText(), `graph ${performance.now()}`);
      this.of.settle();
      this.graphJson = graph.toJson();
    } catch (error) {
      if (!(error instanceof LacquerError)) throw error;
      return error.messages;
    } finally {
      graph.free();
    }
    this.properties.show(this.of);
    this.compile();
    this.showPanels();
    return [];
  }

  /** A number of the graph: of the property where it is one. Numbers in a row of one parameter are one step back. */
  setParameter(name: string, value: number | number[], done = true): void {
    const { of } = this;
    if (!of) return;
    const pointer = this.graphJson?.parameters[name]?.pointer;
    if (pointer && of.get(pointer) !== undefined) of.set(pointer, value, `set ${pointer}`);
    else {
      const graph = graphOf(this.lacquer, of, this.options(), []);
      try {
        graph.setParameter(name, value);
        of.setGraph(graph.toText(), `set ${name}`);
      } catch (error) {
        return this.fail(error);
      } finally {
        graph.free();
      }
    }
    if (done) of.settle();
    this.properties.update();
    this.compile();
  }

  /** The graph is made of the properties again. */
  private forgetGraph(): void {
    if (!this.of?.graphs.has(this.of.material)) return;
    this.of.setGraph(null, `graph ${performance.now()}`);
    this.of.settle();
    this.properties.show(this.of);
    this.compile();
  }

  /** Says the first in the line below the picture, and all under Notes. */
  note(...texts: string[]): void {
    this.notice = texts.map((text) => messageOf(text, 'note'));
    this.showMessages();
  }

  noteMore(text: string): void {
    this.notice.push(messageOf(text, 'note'));
    this.showMessages();
  }

  private showMessages(): void {
    const all = [...this.notice, ...this.messages];
    if (this.isNew('messages', JSON.stringify(all)))
      byId('messages').replaceChildren(...all.map(({ level, text }) => h('li', { class: level }, text)));
    const error = all.find(({ level }) => level === 'error');
    const told = all.length > 0 ? `${all.length} message${all.length > 1 ? 's' : ''}` : '';
    const [first, ...more] = this.notice;
    const noted = first && `${first.message}${more.length > 0 ? ` (and ${more.length} more, under Notes)` : ''}`;
    tell('status', error?.message ?? noted ?? told, error ? 'error' : '');
  }

  /** Says what is wrong and leaves everything as it is. */
  fail(error: unknown): void {
    this.notice = error instanceof LacquerError ? error.messages : [messageOf(error)];
    this.showMessages();
  }

  // ---- controls

  private fillSelects(): void {
    const profiles: { name: string; doc: string }[] = this.nodes.profiles;
    const option = ({ name, doc }: { name: string; doc: string }) => h('option', { value: name, title: doc }, name);
    byId('profile').replaceChildren(...profiles.map(option));
    byId<HTMLSelectElement>('profile').value = this.figures.options.profile ?? profiles[0].name;
    byId('target').replaceChildren(...kOffered.map((name) => h('option', {}, name)));
  }

  /** It stands in another light. */
  relight(): void {
    this.compare();
    this.viewport.redraw();
  }

  /** Exchanges WebGL 2 for WebGPU, or the other way; where there is no WebGPU it says so. */
  async paintWith(name: string): Promise<void> {
    const { viewport, lacquer } = this;
    const canvas = byId<HTMLCanvasElement>('viewport-gpu');
    const choice = byId<HTMLSelectElement>('painter');
    this.painter ??= name === 'webgpu' ? await GpuPainter.make(canvas, lacquer.environmentDfg(128), lacquer.environmentSheen(64)) : null;
    viewport.gpu = name === 'webgpu' ? this.painter : null;
    choice.value = viewport.gpu ? 'webgpu' : 'webgl';
    canvas.hidden = !viewport.gpu;
    viewport.canvas.hidden = !canvas.hidden;
    this.compile();
    if (viewport.gpu && this.of) this.compileOthers();
    await this.others;
    if (name === 'webgpu' && !viewport.gpu) this.fail(new Error('this browser has no WebGPU'));
  }

  private on(id: string, event: string, act: () => void): void {
    byId(id).addEventListener(event, act);
  }

  /** Seconds of the materials' time, which can be stopped and set: shown where a material asks for it. */
  private connectClock(): void {
    const { viewport } = this;
    const seconds = byId<HTMLInputElement>('seconds');
    viewport.onClock = (asked) => {
      byId('clock').hidden = !asked;
      byId('play').textContent = viewport.playing ? 'Pause' : 'Play';
      if (asked && document.activeElement !== seconds) seconds.value = viewport.seconds.toFixed(2);
    };
    this.on('play', 'click', () => {
      viewport.playing = !viewport.playing;
      viewport.redraw();
    });
    this.on('seconds', 'input', () => {
      if (!(seconds.valueAsNumber >= 0)) return;
      viewport.playing = false;
      viewport.seconds = seconds.valueAsNumber;
      viewport.redraw();
    });
  }

  private connectControls(): void {
    const step = (act: (of: Document) => void) => () => {
      if (!this.of) return;
      act(this.of);
      this.around.show();
      if (this.of.names.length > 0) this.choose(this.of.material);
      else this.showWays();
    };
    this.on('undo', 'click', step((of) => of.undo()));
    this.on('redo', 'click', step((of) => of.redo()));
    addEventListener('keydown', (event) => {
      if (!(event.ctrlKey || event.metaKey) || (event.target as HTMLElement).matches?.('input[type=text], input[type=number], textarea')) return;
      if (event.key.toLowerCase() !== 'z' && event.key.toLowerCase() !== 'y') return;
      event.preventDefault();
      step((of) => (event.key.toLowerCase() === 'y' || event.shiftKey ? of.redo() : of.undo()))();
    });
    this.on('material', 'change', () => this.choose(Number(byId<HTMLSelectElement>('material').value)));
    this.on('profile', 'change', () => {
      this.compile();
      if (this.of) this.compileOthers();
    });
    for (const id of ['compare', 'compared']) this.on(id, 'change', () => this.compile());
    this.on('split', 'input', () => {
      if (!this.viewport.other) return;
      this.viewport.other.split = Number(byId<HTMLInputElement>('split').value);
      this.viewport.redraw();
    });
    this.on('painter', 'change', () => void this.paintWith(byId<HTMLSelectElement>('painter').value));
    for (const id of ['target', 'stage']) this.on(id, 'change', () => this.showText());
    this.on('forget-graph', 'click', () => this.forgetGraph());
    this.on('shape', 'change', () => {
      this.viewport.useBall = byId<HTMLSelectElement>('shape').value === 'ball';
      this.viewport.fit();
    });
    this.on('variant', 'change', () => {
      if (!this.of) return;
      this.of.vary(byId<HTMLSelectElement>('variant').value);
      this.compileOthers();
      this.viewport.redraw();
    });
    this.on('save-picture', 'click', () => void this.savePicture().catch((error: unknown) => this.fail(error)));
    this.on('exposure', 'input', () => {
      this.viewport.exposure = 2 ** Number(byId<HTMLInputElement>('exposure').value);
      this.viewport.redraw();
    });
    this.connectClock();
    this.on('theme', 'click', () => {
      const dark = getComputedStyle(document.documentElement).colorScheme === 'dark';
      document.documentElement.dataset.theme = dark ? 'light' : 'dark';
      this.viewport.redraw();
    });
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.viewport.redraw());
    connectTabs(() => this.showPanels());
  }

  /** A graph in JSON in the place of the material's. */
  openGraph(name: string, text: string): void {
    if (!this.of) return;
    try {
      this.lacquer.graph(text, name, [], this.texts()).free();
    } catch (error) {
      return this.fail(error);
    }
    this.of.setGraph(text, `graph ${name}`);
    this.of.settle();
    this.properties.show(this.of);
    this.compile();
  }

  /** What a test asks. */
  get document(): Document | null {
    return this.of;
  }
  lookNow(): Look | undefined {
    return this.of ? this.viewport.looks.get(this.of.material) : undefined;
  }
}

function messageOf(error: unknown, level: Level = 'error'): Message {
  const message = error instanceof Error ? error.message : String(error);
  return { level, code: 'page', file: '', pointer: '', line: 0, column: 0, message, help: '', text: `${level}: ${message}` };
}

interface Embedded {
  name: string;
  bytes: string;
  /** Another spelling of a file before it has no bytes, but that one's. */
  resources: { uri: string; bytes?: string; same?: string }[];
}

function inputOf({ name, bytes, resources }: Embedded): Input {
  const all = new Map<string, Uint8Array>();
  for (const { uri, bytes, same } of resources) all.set(uri, same === undefined ? fromBase64(bytes!) : all.get(same)!);
  return { name, bytes: fromBase64(bytes), resources: all };
}

async function start(): Promise<void> {
  const embedded = (id: string): Embedded[] => JSON.parse(byId(id).textContent ?? '[]');
  const lacquer = await compiler(byId('wasm').textContent!.trim());
  const viewport = new Viewport(byId<HTMLCanvasElement>('viewport'), lacquer.environmentDfg(128), lacquer.environmentSheen(64));
  const json = (id: string) => JSON.parse(byId(id).textContent || '{}');
  const page = new Page(lacquer, viewport, { costs: json('costs'), errors: json('errors'), options: json('options') });
  (window as any).lacquerPage = page;
  const own = embedded('files');
  const samples = embedded('samples');
  const all = [...own, ...samples];
  const choice = byId<HTMLSelectElement>('sample');
  // It says what may be opened; what is open is said beside it, once, wherever that came from.
  choice.replaceChildren(h('option', { value: '', hidden: true }, 'Other files…'), ...all.map(({ name }, i) => h('option', { value: i }, name)));
  choice.addEventListener('change', () => {
    const input = inputOf(all[Number(choice.value)]);
    choice.value = '';
    void page.files.replace(input);
  });
  page.files.held = (name) => {
    const found = all.find((each) => each.name === name);
    return found ? inputOf(found) : null;
  };
  if (all.length > 0) page.open(inputOf(all[0]));
  await page.files.openAddress();
  await page.files.begin();
  document.body.classList.add('ready');
}

start().catch((error: unknown) => {
  byId('status').textContent = error instanceof Error ? error.message : String(error);
  byId('status').className = 'error';
  document.body.classList.add('ready');
});
