// Generated text with its words coloured, in the sections that its comments begin: one for each term.
import { zipSync, type Zippable } from 'fflate';
import { LacquerError } from '../src/index';
import { byId, download, h } from './dom';
import type { Page } from './main';
import type { Described, Stage } from './printed';

const kWords =
  /(\/\/[^\n]*)|(#[^\n]*)|\b(const|in|out|inout|uniform|layout|precision|highp|struct|if|else|for|return|void|cbuffer|register|static|let|fn|var|switch|case)\b|\b(float[1-4]?(?:x[34])?|vec[234]|mat[34]|int|uint|bool|sampler\w*|Texture\w+|SamplerState|double)\b|(\b\d[\w.]*(?:e[+-]?\d+)?\b)/g;
const kKinds = ['comment', 'directive', 'keyword', 'type', 'number'];

function line(text: string): HTMLElement {
  const row = h('span', { class: 'line' });
  let at = 0;
  for (const match of text.matchAll(kWords)) {
    row.append(text.slice(at, match.index));
    const kind = kKinds[match.slice(1).findIndex((group) => group !== undefined)];
    row.append(h('span', { class: kind }, match[0]));
    at = match.index + match[0].length;
  }
  row.append(text.slice(at), '\n');
  return row;
}

/** The name of the term whose lines a comment begins: "coat.fresnel" of `// coat.fresnel: source`. */
export function termOf(text: string): string | null {
  const match = /^\s*\/\/ ([a-z_][\w.]*)(?::|$)/.exec(text);
  return match ? match[1] : null;
}

/** The text as elements; a click on a section tells its term. */
export function showCode(root: HTMLElement, text: string, chosen: (term: string) => void): void {
  let section: HTMLElement = root;
  const made: HTMLElement[] = [];
  for (const each of text.replace(/\n$/, '').split('\n')) {
    const term = termOf(each);
    if (term !== null || section === root || each.trim() === '') {
      section = h('span', term === null ? { class: 'section' } : { class: 'section term', 'data-term': term });
      if (term !== null) section.addEventListener('click', () => chosen(term));
      made.push(section);
    }
    section.append(line(each));
  }
  root.replaceChildren(...made);
}

/** Whether there were lines of it. */
export function selectTerm(root: HTMLElement, term: string, scroll: boolean): boolean {
  let first = true;
  for (const section of root.querySelectorAll<HTMLElement>('.section.term')) {
    const selected = section.dataset.term === term;
    section.classList.toggle('selected', selected);
    if (selected && first && scroll) section.scrollIntoView({ block: 'center' });
    if (selected) first = false;
  }
  return !first;
}

/** SPIR-V as numbers: it has no text of its own. */
export function hexOf(words: Uint32Array): string {
  const lines: string[] = [];
  for (let i = 0; i < words.length; i += 8) {
    lines.push(Array.from(words.subarray(i, i + 8), (word) => word.toString(16).padStart(8, '0')).join(' '));
  }
  return lines.join('\n');
}

/** As `lacquer gen` calls its files. */
const kEndings: Record<string, string> = { essl: 'glsl', glsl: 'glsl', 'glsl-gl': 'glsl', hlsl: 'hlsl', wgsl: 'wgsl', spirv: 'spv' };
const kWhole: Record<string, string> = { cpp: 'h', js: 'js' }; // of both stages

const endingOf = (target: string, stage: Stage): string =>
  kWhole[target] ?? `${stage === 'fragment' ? 'frag' : 'vert'}.${kEndings[target] ?? 'txt'}`;

/** Those that take the options: ESSL, say, has no arrays without an end. */
function targetsOf(page: Page): string[] {
  return [...byId<HTMLSelectElement>('target').options].map(({ value }) => value).filter((target) => {
    try {
      return page.printed.described(target).id !== '';
    } catch (error) {
      if (!(error instanceof LacquerError)) throw error;
      return false;
    }
  });
}

/** Targets' texts in the folders of `lacquer gen`, what is bound to them, and the graph; null where the material has an error. */
function folderOf(page: Page, targets: string[], { id, interface: about, graph, block }: Described): Uint8Array<ArrayBuffer> | null {
  const files: Zippable = {};
  for (const target of targets) {
    for (const stage of ['vertex', 'fragment'] as const) {
      const bytes = page.printed.bytes(target, stage);
      if (!bytes) return null;
      if (bytes.length > 0) files[`${target}/${id}.${endingOf(target, stage)}`] = bytes;
    }
  }
  const utf8 = new TextEncoder();
  files['interface.json'] = utf8.encode(`${JSON.stringify(about, null, 2)}\n`);
  files['graph.json'] = utf8.encode(graph);
  if (block.length > 0) files['material.bin'] = block;
  return zipSync(files, { mtime: kNoTime }) as Uint8Array<ArrayBuffer>;
}
/** The first that a ZIP knows: the same material has the same bytes. */
const kNoTime = new Date(1980, 0, 1);

/** The buttons that take the text away: to the clipboard, as the file that `lacquer gen` writes, or all of them in a folder. */
export function connectCode(page: Page): void {
  const chosen = () => ({ target: byId<HTMLSelectElement>('target').value, stage: byId<HTMLSelectElement>('stage').value as Stage });
  const told = byId('code-told');
  const say = (text: string) => {
    told.textContent = text;
    setTimeout(() => told.textContent === text && (told.textContent = ''), 4000);
  };
  byId('copy-code').addEventListener('click', () => void copy(byId('code').textContent ?? '').then((done) => say(done ? 'copied' : 'the browser lets nothing be copied')));
  byId('download-code').addEventListener('click', () => {
    const { target, stage } = chosen();
    const bytes = page.printed.bytes(target, stage);
    if (bytes) download(`${page.printed.described(target).id}.${endingOf(target, stage)}`, bytes, target === 'spirv' ? 'application/octet-stream' : 'text/plain');
  });
  byId('download-folder').addEventListener('click', () => {
    const targets = targetsOf(page);
    const about = targets.length > 0 ? page.printed.described(targets[0]) : page.printed.describedOrSaid();
    const bytes = about && folderOf(page, targets, about);
    if (!bytes) return;
    download(`${about.id}.zip`, bytes, 'application/zip');
    const without = [...byId<HTMLSelectElement>('target').options].filter(({ value }) => !targets.includes(value));
    if (without.length > 0) say(`without ${without.map(({ value }) => value).join(', ')}, which cannot have it so`);
  });
}

/** Also where the browser has no clipboard for the page. */
export async function copy(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const field = h('textarea', { 'aria-hidden': 'true', class: 'away' });
    field.value = text;
    document.body.append(field);
    field.select();
    const done = document.execCommand('copy');
    field.remove();
    return done;
  }
}
