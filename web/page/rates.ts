// How often values are computed, as the dump of a graph's code says it.
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
