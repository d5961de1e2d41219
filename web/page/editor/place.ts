// Places for boxes that have none, and boxes in line.
import { graphlib, layout } from '@dagrejs/dagre';
import type { Box, Place, View } from './view';

/** Where dagre puts boxes and the wires between them, from `at` on. */
export function tidied(view: View, keys: Set<string>, at: Place = { x: 0, y: 0 }): Map<string, Place> {
  const laid = new graphlib.Graph();
  laid.setGraph({ rankdir: 'LR', nodesep: 18, ranksep: 70 });
  laid.setDefaultEdgeLabel(() => ({}));
  const boxes = [...view.boxes.values()].filter(({ key }) => keys.has(key));
  for (const { key, width, height } of boxes) laid.setNode(key, { width, height });
  for (const { from, to } of view.wires) if (keys.has(from.key) && keys.has(to.key)) laid.setEdge(from.key, to.key);
  layout(laid);
  const places = new Map<string, Place>();
  const corner = { x: Infinity, y: Infinity };
  for (const { key, width, height } of boxes) {
    const { x = 0, y = 0 } = laid.node(key) as { x?: number; y?: number };
    places.set(key, { x: x - width / 2, y: y - height / 2 });
    corner.x = Math.min(corner.x, x - width / 2);
    corner.y = Math.min(corner.y, y - height / 2);
  }
  for (const place of places.values()) {
    place.x = Math.round(place.x - corner.x + at.x);
    place.y = Math.round(place.y - corner.y + at.y);
  }
  return places;
}

/** Gives boxes without a place one: all by dagre where none has one; else left of what they go to, or below the others. */
export function settle(view: View, known: Map<string, Place>): void {
  const all = [...view.boxes.values()];
  for (const box of all) {
    const place = known.get(box.key);
    if (!box.loose || !place) continue;
    Object.assign(box, place);
    box.loose = false;
  }
  const loose = all.filter((box) => box.loose);
  if (loose.length === 0) return;
  if (loose.length === all.length) {
    const places = tidied(view, new Set(view.boxes.keys()));
    for (const box of all) Object.assign(box, places.get(box.key));
    return;
  }
  const bounds = boundsOf(all.filter((box) => !box.loose));
  let below = bounds.y + bounds.height + 24;
  for (const box of loose) {
    const user = view.wires.find(({ from, to }) => from === box && !to.loose)?.to;
    const maker = view.wires.find(({ from, to }) => to === box && !from.loose)?.from;
    if (user) Object.assign(box, { x: user.x - box.width - 60, y: user.y });
    else if (maker) Object.assign(box, { x: maker.x + maker.width + 60, y: maker.y });
    else {
      Object.assign(box, { x: bounds.x, y: below });
      below += box.height + 16;
    }
    while (all.some((other) => other !== box && !other.loose && overlap(other, box))) box.y += 24;
    box.loose = false;
  }
}

const overlap = (a: Box, b: Box) => a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;

export interface Bounds {
  x: number;
  y: number;
  width: number;
  height: number;
}

export function boundsOf(boxes: Bounds[]): Bounds {
  if (boxes.length === 0) return { x: 0, y: 0, width: 1, height: 1 };
  const x = Math.min(...boxes.map((box) => box.x));
  const y = Math.min(...boxes.map((box) => box.y));
  return {
    x, y, width: Math.max(...boxes.map((box) => box.x + box.width)) - x, height: Math.max(...boxes.map((box) => box.y + box.height)) - y,
  };
}

/** Boxes with one edge in common. */
export function aligned(boxes: Box[], side: 'left' | 'top'): Map<string, Place> {
  const { x, y } = boundsOf(boxes);
  return new Map(boxes.map((box) => [box.key, side === 'left' ? { x, y: box.y } : { x: box.x, y }]));
}
