// Values of a file's JSON, where nothing need be of the type that the format wants.

export const isCount = (x: unknown): x is number => Number.isInteger(x) && (x as number) >= 0;
export const list = (x: unknown): any[] => (Array.isArray(x) ? x : []);

/** The object at an index of a list; undefined where there is none. */
export function item(of: unknown, index: unknown): any {
  const found = isCount(index) ? list(of)[index] : undefined;
  return typeof found === 'object' && found !== null ? found : undefined;
}

/** Lengths from here on are as good as none: their squares are still numbers of 32 bits. */
const kFarthest = 1e15;
export const isNear = (x: unknown): x is number => typeof x === 'number' && Math.abs(x) < kFarthest;

/** So many numbers; undefined where it is anything else. */
export function numbersOf(x: unknown, size: number): number[] | undefined {
  return Array.isArray(x) && x.length === size && x.every((each) => typeof each === 'number') ? x : undefined;
}

/** What is known of a key; it is made where nothing is. */
export function once<K, V>(known: { has(key: K): boolean; get(key: K): V | undefined; set(key: K, value: V): unknown }, key: K, make: () => V): V {
  if (!known.has(key)) known.set(key, make());
  return known.get(key)!;
}

/** Of a file's nodes the numbers of those that are nobody's children, and then of all: some may only be in circles. */
export function rootsOf(nodes: any[]): number[] {
  const children = new Set(nodes.flatMap((node) => list(node?.children)));
  const all = nodes.map((_, i) => i);
  return [...all.filter((i) => !children.has(i)), ...all];
}
