// Files in and out: dropped, chosen, offered as drafts, replaced with a question, exported.
import { LacquerError, type Message } from '../src/index';
import { copy } from './code';
import type { Input } from './document';
import { byId, download, h } from './dom';
import { asDocument, isDocument, mainDocument } from './foreign';
import { Drafts, kMostBytes, type Draft } from './drafts';
import type { Page } from './main';
import { inputFrom, shared } from './share';
import { kPictures } from './textures';
import { missing } from '../src/gltf';

/** An address with the names of a file that the page has and of one of its materials: #open=FILE/MATERIAL. */
const kNamed = '#open=';

/** Milliseconds after an edit until its draft is kept. */
const kRest = 400;

export class Files {
  private drafts: Drafts | null = null;
  private timer = 0;
  /** The state of the document that the draft has; -1 for none. */
  private kept = -1;
  private keptCamera = '';
  private writing: Promise<void> = Promise.resolve();
  /** A file that came with the page. */
  held: (name: string) => Input | null = () => null;

  constructor(private readonly page: Page) {
    const picker = byId<HTMLInputElement>('picker');
    byId('open').addEventListener('click', () => picker.click());
    picker.addEventListener('change', () => {
      void this.take([...(picker.files ?? [])]);
      picker.value = '';
    });
    byId('export').addEventListener('click', () => this.export());
    byId('export-mtlx').addEventListener('click', () => this.exportMaterialX());
    byId('share').addEventListener('click', () => void this.share());
    addEventListener('hashchange', () => void this.openAddress());
    for (const event of ['dragover', 'dragenter']) {
      addEventListener(event, (drag) => {
        drag.preventDefault();
        document.body.classList.add('dropping');
      });
    }
    addEventListener('dragleave', () => document.body.classList.remove('dropping'));
    addEventListener('drop', (event) => {
      event.preventDefault();
      document.body.classList.remove('dropping');
      void this.take([...(event.dataTransfer?.files ?? [])]);
    });
    document.addEventListener('visibilitychange', () => {
      if (document.hidden) void this.keep();
    });
    addEventListener('beforeunload', (event) => {
      const { document: of } = page;
      if (of?.isEdited && this.kept !== of.state) event.preventDefault();
    });
  }

  /** Drafts of other visits are offered. */
  async begin(): Promise<void> {
    this.drafts = await Drafts.open();
    try {
      this.offer((await this.drafts?.others()) ?? []);
    } catch {
      this.drafts = null;
    }
  }

  /** Files that were dropped or picked: a .gltf with its buffers and images, a .glb, a .mtlx with its images and
   * what it includes, a graph in JSON, or an environment. */
  async take(files: File[]): Promise<void> {
    const { page } = this;
    const bytesOf = async (file: File) => new Uint8Array(await file.arrayBuffer());
    const graph = files.find(({ name }) => name.endsWith('.json'));
    if (graph && page.document?.names.length) return page.openGraph(graph.name, await graph.text());
    const around = files.find(({ name }) => /\.(hdr|exr)$/i.test(name));
    if (around) return page.around.surround(around.name, await bytesOf(around));
    if (files.length > 0 && files.every(({ name }) => kPictures.test(name))) return page.fail(new Error(`${files[0].name} is a picture: drop it on the slot of a texture, at the left`));
    const documents = new Map<string, Uint8Array>();
    for (const file of files) if (isDocument(file.name)) documents.set(file.name, await bytesOf(file));
    const first = mainDocument(documents);
    const main = files.find(({ name }) => /\.(gltf|glb)$/i.test(name)) ?? files.find(({ name }) => name === first) ?? files[0];
    if (!main) return;
    const resources = new Map<string, Uint8Array>();
    for (const file of files) if (file !== main) resources.set(file.name, await bytesOf(file));
    if (await this.replace({ name: main.name, bytes: await bytesOf(main), resources })) this.tellMissing();
    await page.others;
  }

  private tellMissing(): void {
    const { file } = this.page.document!;
    const named = missing(file);
    const [first, ...more] = named;
    if (named.length > 0) this.page.noteMore(`${file.name} names ${named.length === 1 ? `${first}, which is` : `${[first, ...more.slice(0, 9)].join(', ')}${named.length > 10 ? ` and ${named.length - 10} more, which are` : ', which are'}`} not there: drop all of them at once`);
  }

  /** Opens a file in the place of the one that is there: asks first where that has edits which no file has. */
  async replace(input: Input): Promise<boolean> {
    const { page } = this;
    const made = page.read(input);
    if (!made) return false;
    const of = page.document;
    if (of?.isEdited && !(await this.ask(of.file.name, input.name))) return false;
    await this.forget();
    page.show(made);
    return true;
  }
  private ask(name: string, next: string): Promise<boolean> {
    return new Promise((done) => {
      const button = (text: string, value: string) => h('button', { type: 'button', value, click: () => dialog.close(value) }, text);
      const dialog = h('dialog', { class: 'ask', 'aria-label': 'Replace the file' },
        h('p', {}, `${name} has edits that are in no file. ${next} would take its place.`),
        h('div', { class: 'offers' }, button('Keep it', ''), button('Export, then replace', 'export'), button('Replace it', 'replace')));
      dialog.addEventListener('close', () => {
        dialog.remove();
        if (dialog.returnValue === 'export') this.export();
        done(dialog.returnValue !== '');
      });
      document.body.append(dialog);
      dialog.showModal();
    });
  }

  private export(): void {
    const { document: of } = this.page;
    if (!of) return;
    const { name, bytes } = of.export();
    download(name, bytes, name.endsWith('.glb') ? 'model/gltf-binary' : 'model/gltf+json');
    of.saved();
    void this.forget();
    this.showName();
    const own = [...of.graphs.keys()].map((material) => of.names[material] || `material ${material}`);
    const graphs = own.length > 0 ? `; the graph of ${own.join(', ')} is in the file's extras: this page reads it, other programs see the properties alone` : '';
    this.page.note(`${name} is exported with all edits${graphs}`);
  }

  /** The materials as a MaterialX document, beside the file: that stays what is edited. */
  private exportMaterialX(): void {
    const { document: of } = this.page;
    if (!of) return;
    const said: Message[] = [];
    try {
      const { name, bytes } = asDocument(this.page.lacquer, of, said);
      download(name, bytes, 'application/xml');
    } catch (error) {
      return this.page.fail(error);
    }
    this.page.note(...(said.length > 0 ? said.map(({ text }) => text) : ['the document says all that the materials say']));
  }

  // ---- addresses

  /** The address has the material from now on, and is copied. */
  private async share(): Promise<void> {
    const { document: of } = this.page;
    if (!of?.names.length) return;
    const { hash, left } = await shared(of);
    this.address = hash;
    history.replaceState(null, '', hash);
    const copied = await copy(location.href);
    const without = left.length > 0 ? `; without its textures (${left.join(', ')}): an address has no room for pictures` : '';
    this.page.note(`the address of the page has ${of.names[of.material] || 'the material'}, ${location.href.length} characters${copied ? ', and is copied' : ''}${without}`);
  }
  private address = '';
  /** Opens what the address has, asking first; whether it had something. */
  async openAddress(): Promise<boolean> {
    if (location.hash === this.address) return false;
    this.address = location.hash;
    try {
      if (location.hash.startsWith(kNamed)) return await this.openNamed(decodeURIComponent(location.hash.slice(kNamed.length)));
      const input = await inputFrom(location.hash);
      return input !== null && (await this.replace(input));
    } catch (error) {
      this.page.fail(error);
      return false;
    }
  }

  private async openNamed(names: string): Promise<boolean> {
    const { page } = this;
    const [file] = names.split('/', 1), material = names.slice(file.length + 1);
    const held = this.held(file);
    if (!held) throw new Error(`the address opens ${file}, and the page has no such file`);
    if (!(await this.replace(held))) return false;
    const index = material === '' ? 0 : page.document!.names.indexOf(material);
    if (index < 0) throw new Error(`the address opens the material ${material}, and ${file} has none of this name`);
    page.choose(index);
    return true;
  }

  // ---- drafts

  /** The document may have changed. */
  changed(): void {
    this.showName();
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => (this.writing = this.writing.then(() => this.keep())), kRest);
  }
  private showName(): void {
    const { document: of } = this.page;
    const name = byId('file');
    const edited = of?.isEdited ?? false;
    if (name.textContent !== (of?.file.name ?? '')) name.textContent = of?.file.name ?? '';
    name.title = `${name.textContent}${edited ? ': it has edits that are in no file yet; a draft of them is kept' : ''}`;
    if (name.classList.contains('edited') !== edited) name.classList.toggle('edited', edited);
    const page = `${edited ? '• ' : ''}${of?.file.name ?? ''} – Lacquer`;
    if (document.title !== page) document.title = page;
  }
  private async keep(): Promise<void> {
    const { document: of } = this.page;
    const { value: camera } = this.page.cameras;
    if (!of || !this.drafts || (of.state === this.kept && camera === this.keptCamera)) return;
    if (!of.isEdited) return this.forget();
    const { state, material, file: { name, resources: all } } = of;
    const resources = [...all].filter(([uri]) => !uri.startsWith('data:'));
    const bytes = of.file.bytes.length > kMostBytes ? null : of.export().bytes;
    if (!bytes || resources.reduce((sum, [, each]) => sum + each.length, bytes.length) > kMostBytes) return this.page.note(`${name} is too large for a draft: export it to keep its edits`);
    try {
      await this.drafts.keep({ name, bytes, resources, material, camera, time: Date.now() });
      this.kept = state;
      this.keptCamera = camera;
    } catch (error) {
      this.page.note(`no draft can be kept here: ${error instanceof Error ? error.message : String(error)}`);
    }
  }
  private async forget(): Promise<void> {
    clearTimeout(this.timer);
    if (this.kept !== -1) await this.drafts?.remove();
    this.kept = -1;
  }

  private offer(drafts: Draft[]): void {
    const place = byId('drafts');
    place.hidden = drafts.length === 0;
    place.replaceChildren(...drafts.map((draft) => {
      const when = new Date(draft.time).toLocaleString(undefined, { dateStyle: 'medium', timeStyle: 'short' });
      const done = () => {
        row.remove();
        place.hidden = place.children.length === 0;
      };
      const row = h('div', {}, h('span', {}, `A draft of ${draft.name} from ${when} was kept. `),
        h('button', { type: 'button', click: () => void this.reopen(draft).then((opened) => opened && done()) }, 'Open the draft'), ' ',
        h('button', { type: 'button', class: 'quiet', click: () => void this.drafts?.remove(draft.id).then(done) }, 'Discard it'));
      return row;
    }));
  }
  private async reopen(draft: Draft): Promise<boolean> {
    try {
      if (!(await this.replace({ name: draft.name, bytes: draft.bytes, resources: new Map(draft.resources) }))) return false;
    } catch (error) {
      if (!(error instanceof LacquerError)) throw error;
      return false;
    }
    const { page } = this;
    page.document!.unsaved();
    if (draft.material > 0) page.choose(draft.material);
    page.cameras.choose(draft.camera ?? '');
    this.changed();
    await this.keep();
    await this.drafts?.remove(draft.id);
    return true;
  }
}
