// What a shader costs and what its terms are wrong by: operations, sizes, the driver's numbers, the tables of errors.
import type { GraphJson } from '../src/index';
import { h } from './dom';

/** By the shader's id, as `lacquer view` has measured them. */
export type Costs = Record<string, { spirv: number; gpus: Record<string, Record<string, number>> }>;

/** Largest, 99.9th percentile, root mean square, as texts. */
type Spread = [string, string, string];
/** Of a body of a node (docs/error.md). */
export interface Body {
  e1?: Spread; // units in the last place
  e2?: Spread;
  e3?: Spread;
  against?: string;
  alone?: [number, number]; // instructions, inverse throughput
}
export interface Errors {
  gpu: string;
  nodes: Record<string, Record<string, Body>>;
}

const kColumns: [string, string, string][] = [
  ['instructions', 'instructions', 'of the final code'],
  ['inverse_throughput', 'inv. throughput', 'cycles that a busy GPU needs for each wave, a static estimate'],
  ['latency', 'latency', 'cycles from the start of a wave to its end, a static estimate'],
  ['vgprs', 'VGPRs', 'registers of each lane'],
];

/** The driver's table for a shader, beside another's where one is compared. */
export function costTable(costs: Costs, shaders: [string, string][]): HTMLElement {
  const known = shaders.filter(([, id]) => costs[id]);
  if (known.length === 0) {
    return h('p', { class: 'doc' }, 'Not measured. `lacquer view` measures the shaders of the files that it is given, as they are, where Mesa’s compiler is there.');
  }
  const rows = known.flatMap(([label, id]) =>
    Object.entries(costs[id].gpus).map(([gpu, row]) =>
      h('tr', {}, h('th', { scope: 'row' }, known.length > 1 ? `${label}, ${gpu}` : gpu), ...kColumns.map(([key]) => h('td', {}, String(row[key] ?? '–')))),
    ),
  );
  const head = h('tr', {}, h('td'), ...kColumns.map(([, name, title]) => h('th', { scope: 'col', title }, name)));
  const counts = known.map(([label, id]) => `${known.length > 1 ? `${label}: ` : ''}${costs[id].spirv} SPIR-V instructions`).join(', ');
  return h('div', {}, h('table', { class: 'figures' }, h('thead', {}, head), h('tbody', {}, ...rows)), h('p', { class: 'doc' }, counts));
}

const spread = (of: Spread | undefined) => h('td', {}, of ? of.join(' / ') : '');

/** The bodies that the graph's terms have, and could have, with their errors. `choose` is given a word for --simplify. */
export function errorTable(graph: GraphJson, errors: Errors, choose: (word: string) => void): HTMLElement {
  const rows: HTMLElement[] = [];
  for (const { id, node, variant } of graph.nodes) {
    const used = variant ?? 'reference';
    const bodies = Object.entries(errors.nodes[node ?? ''] ?? {}).sort(([a], [b]) => Number(b === used) - Number(a === used));
    bodies.forEach(([name, body], i) => {
      const other = name !== used;
      const pick = h('button', { type: 'button', class: 'quiet', title: 'Compare with this body', click: () => choose(`variant:${id}=${name}`) }, name);
      rows.push(
        h(
          'tr', { class: other ? 'other' : 'used', title: body.against ? `E3 against ${body.against}` : undefined },
          h('th', { scope: 'row' }, i === 0 ? id : ''), h('td', {}, other && name !== 'reference' ? pick : name),
          spread(body.e1), spread(body.e2), spread(body.e3), h('td', {}, body.alone ? body.alone.join(' / ') : ''),
        ),
      );
    });
  }
  if (rows.length === 0) return h('p', { class: 'doc' }, 'No term of this material has a body beside the reference.');
  const heads: [string, string][] = [
    ['term', ''], ['body', ''], ['E1, ULP', 'float32 against double'], ['E2', 'a variant against the reference'], ['E3', 'against physics'],
    ['alone', `instructions / inverse throughput on ${errors.gpu}`],
  ];
  return h('table', { class: 'figures' }, h('thead', {}, h('tr', {}, ...heads.map(([name, title]) => h('th', { scope: 'col', title }, name)))), h('tbody', {}, ...rows));
}
