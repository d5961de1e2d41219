// What can stand beside the shown material: it under another profile or made simpler, or another material.
import type { GraphJson, Options } from '../src/index';
import type { Document } from './document';
import { h } from './dom';
import { list } from '../src/json';

/** Parsed from the value of the page's selection. */
export type Other = { kind: 'profile'; name: string } | { kind: 'material'; index: number } | { kind: 'simplify'; word: string };

export function parseOther(value: string): Other | null {
  const [, kind, rest] = /^(profile|material|simplify):(.*)$/s.exec(value) ?? [];
  if (kind === 'profile') return { kind, name: rest };
  if (kind === 'material') return { kind, index: Number(rest) };
  return kind === 'simplify' ? { kind, word: rest } : null;
}

/** The options under which the other one is made. */
export function optionsOf(other: Other, options: Options): Options {
  if (other.kind === 'profile') return { ...options, profile: other.name };
  return other.kind === 'simplify' ? { ...options, simplify: [...(options.simplify ?? []), other.word] } : options;
}

interface Library {
  profiles: { name: string; doc: string }[];
  live: string[];
  switches: { name: string; doc: string; default: boolean }[];
  lods: { name: string; doc: string }[];
  nodes: { name: string; variants: { name: string; doc: string }[] }[];
}

/** Words that say what is simpler of this graph (docs/lod.md), with what they mean. */
function words(graph: GraphJson, library: Library): [string, string][] {
  const found: [string, string][] = [];
  for (const term of library.live) {
    if (graph.nodes.some(({ id }) => id === term || id.startsWith(`${term}.`))) found.push([`without:${term}`, `${term} left out`]);
  }
  for (const { id, node, variant } of graph.nodes) {
    for (const { name, doc } of library.nodes.find((each) => each.name === node)?.variants ?? []) {
      if (name !== variant) found.push([`variant:${id}=${name}`, doc]);
    }
  }
  for (const { name, doc, default: on } of library.switches) found.push([`switch:${name}=${on ? 'off' : 'on'}`, doc]);
  for (const { name, doc } of library.lods) found.push([`lod:${name}`, doc]);
  return found;
}

/** Fills the selection and keeps what is chosen, where that is still there. */
export function fillOthers(select: HTMLSelectElement, of: Document, graph: GraphJson, library: Library): void {
  const chosen = select.value;
  const group = (label: string, options: [string, string, string][]) =>
    h('optgroup', { label }, ...options.map(([value, text, title]) => h('option', { value, title }, text)));
  const groups = [
    group('Profiles', library.profiles.map(({ name, doc }) => [`profile:${name}`, name, doc])),
    group('Materials', of.names.map((name, i): [string, string, string] => [`material:${i}`, name || `(material ${i})`, '']).filter((_, i) => i !== of.material)),
    group('Simpler', words(graph, library).map(([word, doc]) => [`simplify:${word}`, word, doc])),
  ];
  select.replaceChildren(h('option', { value: '' }, 'nothing'), ...groups.filter(({ childElementCount }) => childElementCount > 0));
  if ([...select.options].some(({ value }) => value === chosen)) select.value = chosen;
}

/** Offers the file's variants, where it has some that something is drawn in. */
export function fillVariants(select: HTMLSelectElement, of: Document): void {
  const named = list(of.json.extensions?.KHR_materials_variants?.variants);
  const used = new Set(of.drawables.flatMap(({ variants }) => [...(variants?.keys() ?? [])]));
  const names = named.flatMap((each, i) => (used.has(i) ? [h('option', { value: i }, typeof each?.name === 'string' && each.name ? each.name : `(variant ${i})`)] : []));
  select.replaceChildren(h('option', { value: '' }, 'The file\'s own'), ...names);
  select.parentElement!.hidden = names.length === 0;
}
