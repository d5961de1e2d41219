// Draws a view: boxes as elements, wires as SVG below them, all under one transformation.
import { h, svg } from '../dom';
import { boundsOf } from './place';
import { kHead, kNewOutput, kRow, type Box, type Place, type Port, type View, type Wire } from './view';

/** By hand; all of a large graph may be smaller still. */
const kNearest = 0.12;
const kLeast = 0.01;
const kLargest = 2.5;

/** What a port is of, as the attributes of its element say it. */
export interface PortAt {
  box: Box;
  index: number;
  side: 'in' | 'out';
  port: Port;
}

export class Canvas {
  readonly world = h('div', { class: 'world' });
  private readonly wires = svg('svg', { class: 'wires', 'aria-hidden': 'true' });
  readonly comments = h('div', { class: 'comments' });
  private readonly boxes = h('div', { class: 'boxes' });
  readonly loose = svg('path', { class: 'wire dragged' });
  readonly frame = h('div', { class: 'marquee', hidden: true });
  view: View | null = null;
  zoom = 1;
  pan: Place = { x: 0, y: 0 };
  /** Called for each box that is made: its value is drawn there. */
  drawValue: (box: Box, canvas: HTMLCanvasElement) => void = () => undefined;

  constructor(readonly root: HTMLElement) {
    this.world.append(this.comments, this.wires, this.boxes, this.frame);
    root.append(this.world);
  }

  /** Makes all elements anew; `rates` give boxes their colours. */
  draw(view: View, rates: Map<string, string>): void {
    this.view = view;
    this.boxes.replaceChildren(...[...view.boxes.values()].map((box) => this.element(box, rates.get(box.name) ?? 'none')));
    this.drawWires();
    this.move();
  }

  private element(box: Box, rate: string): HTMLElement {
    const value = h('canvas', { class: 'value', width: 56, height: 56, 'aria-hidden': 'true' });
    const title = box.kind === 'outputs' ? 'Outputs' : box.name;
    const kind = box.kind === 'node' ? '' : box.kind === 'group' ? 'group ' : `${box.kind} `;
    const element = h(
      'div',
      {
        class: `node ${box.kind === 'node' || box.kind === 'group' ? rate : 'plain'} ${box.kind}`, 'data-box': box.key, tabindex: -1, role: 'group',
        'aria-label': `${title}: ${kind}${box.type}${rate === 'none' ? '' : `, rate ${rate}`}`, title: `${title}\n${kind}${box.type}`,
      },
      h('div', { class: 'head' }, ...(box.kind === 'outputs' ? [] : [value]), h('div', {}, h('b', {}, title), h('small', {}, box.type))),
      ...box.inputs.map((port, index) => portElement(box, port, index, 'in')),
      ...box.outputs.map((port, index) => portElement(box, port, index, 'out')),
    );
    if (box.kind === 'node' || box.kind === 'group') element.dataset.node = box.name;
    Object.assign(element.style, { left: `${box.x}px`, top: `${box.y}px`, width: `${box.width}px`, height: `${box.height}px` });
    if (box.kind !== 'outputs') this.drawValue(box, value);
    return element;
  }

  drawWires(): void {
    if (!this.view) return;
    this.wires.replaceChildren(
      ...this.view.wires.flatMap((wire) => {
        const d = path(portPlace(wire.from, 'out', wire.output), portPlace(wire.to, 'in', wire.input));
        const name = wire.to.inputs[wire.input].name;
        const at = { d, 'data-from': wire.from.key, 'data-to': wire.to.key, 'data-port': name };
        return [svg('path', { class: `wire ${wire.from.outputs[wire.output].type}`, ...at }), svg('path', { class: 'hit', ...at })];
      }),
      this.loose,
    );
  }

  /** Puts boxes where they are now, without making them anew. */
  place(keys: Iterable<string>): void {
    for (const key of keys) {
      const [box, element] = [this.view?.boxes.get(key), this.elementOf(key)];
      if (box && element) Object.assign(element.style, { left: `${box.x}px`, top: `${box.y}px` });
    }
    this.drawWires();
  }

  elementOf(key: string): HTMLElement | null {
    return this.boxes.querySelector(`[data-box="${CSS.escape(key)}"]`);
  }
  boxAt(target: EventTarget | null): Box | null {
    const key = (target as Element | null)?.closest?.<HTMLElement>('[data-box]')?.dataset.box;
    return (key !== undefined && this.view?.boxes.get(key)) || null;
  }
  portAt(target: EventTarget | null): PortAt | null {
    const element = (target as Element | null)?.closest?.<HTMLElement>('[data-side]');
    const box = this.boxAt(element ?? null);
    if (!element || !box) return null;
    const side = element.dataset.side as 'in' | 'out';
    const index = Number(element.dataset.index);
    const port = (side === 'in' ? box.inputs : box.outputs)[index];
    return port ? { box, index, side, port } : null;
  }
  portElement({ box, side, index }: { box: Box; side: 'in' | 'out'; index: number }): HTMLElement | null {
    return this.elementOf(box.key)?.querySelector(`[data-side=${side}][data-index="${index}"]`) ?? null;
  }
  wireAt(target: EventTarget | null): Wire | null {
    const { from, to, port } = (target as HTMLElement | null)?.dataset ?? {};
    if (!from || !to) return null;
    return this.view?.wires.find((wire) => wire.from.key === from && wire.to.key === to && wire.to.inputs[wire.input].name === port) ?? null;
  }

  showSelected(keys: Set<string>, wire: Wire | null): void {
    let first = true;
    for (const element of this.boxes.querySelectorAll<HTMLElement>('[data-box]')) {
      const selected = keys.has(element.dataset.box!);
      element.classList.toggle('selected', selected);
      element.tabIndex = selected && first ? 0 : -1;
      if (selected) first = false;
    }
    const start = this.boxes.querySelector<HTMLElement>('[data-box]');
    if (first && start) start.tabIndex = 0;
    for (const element of this.wires.querySelectorAll<SVGElement>('.wire')) {
      const { from = '', to = '', port } = element.dataset;
      const chosen = wire !== null && wire.from.key === from && wire.to.key === to && wire.to.inputs[wire.input].name === port;
      element.classList.toggle('near', keys.has(from) || keys.has(to));
      element.classList.toggle('selected', chosen);
    }
  }

  // ---- where one looks

  move(): void {
    this.world.style.transform = `translate(${this.pan.x}px, ${this.pan.y}px) scale(${this.zoom})`;
    this.root.classList.toggle('far', this.zoom < 0.45);
  }
  /** A place of the window in the graph's own measure. */
  toWorld(clientX: number, clientY: number): Place {
    const { left, top } = this.root.getBoundingClientRect();
    return { x: (clientX - left - this.pan.x) / this.zoom, y: (clientY - top - this.pan.y) / this.zoom };
  }
  zoomBy(factor: number, clientX?: number, clientY?: number): void {
    const { left, top, width, height } = this.root.getBoundingClientRect();
    const [x, y] = [(clientX ?? left + width / 2) - left, (clientY ?? top + height / 2) - top];
    const zoom = Math.min(Math.max(this.zoom * factor, Math.min(kNearest, this.zoom)), kLargest);
    this.pan = { x: x - ((x - this.pan.x) * zoom) / this.zoom, y: y - ((y - this.pan.y) * zoom) / this.zoom };
    this.zoom = zoom;
    this.move();
  }
  /** All of it, or the boxes of that name, in the middle. */
  fit(keys?: Set<string>): void {
    const boxes = [...(this.view?.boxes.values() ?? [])].filter(({ key }) => !keys || keys.has(key));
    const { width, height } = this.root.getBoundingClientRect();
    if (boxes.length === 0 || width === 0) return;
    const bounds = boundsOf(keys ? boxes : [...boxes, ...this.view!.comments]);
    const zoom = Math.min((width - 24) / bounds.width, (height - 24) / bounds.height, keys ? 1 : 1.25);
    this.zoom = Math.min(Math.max(zoom, kLeast), kLargest);
    this.pan = {
      x: width / 2 - (bounds.x + bounds.width / 2) * this.zoom, y: height / 2 - (bounds.y + bounds.height / 2) * this.zoom,
    };
    this.move();
  }
  /** Moves only where the box is not seen. */
  reveal(key: string): void {
    const box = this.view?.boxes.get(key);
    const { width, height } = this.root.getBoundingClientRect();
    if (!box || width === 0) return;
    const [x, y] = [this.pan.x + box.x * this.zoom, this.pan.y + box.y * this.zoom];
    const shift = (at: number, size: number, room: number) => (at < 8 ? 8 - at : at + size > room - 8 ? Math.max(room - 8 - at - size, 8 - at) : 0);
    this.pan = { x: this.pan.x + shift(x, box.width * this.zoom, width), y: this.pan.y + shift(y, box.height * this.zoom, height) };
    this.move();
  }
  /** Whether the box is in the window at all. */
  isSeen(box: Box): boolean {
    const { width, height } = this.root.getBoundingClientRect();
    const [x, y] = [this.pan.x + box.x * this.zoom, this.pan.y + box.y * this.zoom];
    return x < width && y < height && x + box.width * this.zoom > 0 && y + box.height * this.zoom > 0;
  }
}

export function portPlace(box: Box, side: 'in' | 'out', index: number): Place {
  return { x: box.x + (side === 'in' ? 0 : box.width), y: box.y + kHead + kRow * (index + 0.5) };
}

export function path(from: Place, to: Place): string {
  const bend = Math.max(30, Math.abs(to.x - from.x) / 2);
  return `M${from.x} ${from.y}C${from.x + bend} ${from.y} ${to.x - bend} ${to.y} ${to.x} ${to.y}`;
}

/** What stands at an input that no wire goes to. */
export function written({ source, optional }: Port): string {
  if (source === null) return optional ? '' : 'nothing';
  if (typeof source === 'number') return String(Number(source.toPrecision(4)));
  if (typeof source === 'boolean') return String(source);
  if (Array.isArray(source)) return source.map((x) => Number(x.toPrecision(3))).join(' ');
  if ('value' in source) return [source.value].flat().join(' ');
  if ('given' in source) return source.given;
  if ('texture' in source) return source.texture;
  return '';
}

function portElement(box: Box, port: Port, index: number, side: 'in' | 'out'): HTMLElement {
  const label = port.name === kNewOutput ? 'new output' : port.name || 'result';
  const range = port.low !== null || port.high !== null ? ` in [${port.low ?? '−∞'}, ${port.high ?? '∞'}]` : '';
  const text = side === 'in' ? written(port) : '';
  const swizzle = typeof port.source === 'object' && port.source !== null && 'swizzle' in port.source && port.source.swizzle ? `.${port.source.swizzle}` : '';
  const element = h(
    'div',
    {
      class: `port ${side} ${port.type.replace(/\W/g, '')}${side === 'in' && port.source === null && !port.optional ? ' bare' : ''}`, 'data-side': side,
      'data-index': index, 'data-port': port.name, tabindex: -1, role: 'button', title: `${label}: ${port.type}${range}${text ? `\n${text}` : ''}`,
      'aria-label': `${side === 'in' ? 'input' : 'output'} ${label} of ${box.name || 'the outputs'}, ${port.type}${text ? `, ${text}` : ''}`,
    },
    h('i', {}), h('span', {}, label), ...(text || swizzle ? [h('em', {}, text || swizzle)] : []),
  );
  element.style.top = `${kHead + kRow * index}px`;
  return element;
}
