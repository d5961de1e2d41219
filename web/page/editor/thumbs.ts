// The value of each box: on a small ball, or as a number where it is the same everywhere. One is drawn at a time when
// nothing else is to be done.
import { LacquerError, type Graph, type Options } from '../../src/index';
import type { Box, View } from './view';

/** Pixels of a ball's side. */
const kPixels = 28;
/** Milliseconds without a change until values are drawn again. */
const kRest = 200;

/** Places that differ in all that a value may depend on. */
const kPoints = [
  { n: [0, 0, 1], l: [0, 0.6, 0.8], uv0: [0.3, 0.6], uv1: [0.3, 0.6] },
  { n: [0.2, 0.3, 0.9327379], l: [0.36, 0.48, 0.8], uv0: [0.7, 0.1], uv1: [0.7, 0.1], position: [0.5, 0.2, 0.7], light: [1.5, 1.4, 1.3] },
  { n: [-0.6, 0, 0.8], l: [0, 0, 1], uv0: [0.1, 0.9], uv1: [0.1, 0.9], position: [-0.5, 0.4, 0.1], color0: [0.5, 0.25, 0.75, 1] },
];

type Value = number | number[];

export class Thumbs {
  private canvases = new Map<string, HTMLCanvasElement>();
  private waiting: Box[] = [];
  private timer = 0;
  private idle = 0;
  /** How many have been drawn, for tests. */
  drawn = 0;

  constructor(
    private readonly graph: () => { graph: Graph; view: View; within: string[]; options: Options; values: Record<string, Value> } | null,
    private readonly isSeen: (box: Box) => boolean,
  ) {}

  /** Whether all that is seen has its value. */
  get isDone(): boolean {
    return this.timer === 0 && this.waiting.length === 0 && this.idle === 0;
  }

  forget(): void {
    this.canvases.clear();
    this.waiting = [];
  }
  hold(box: Box, canvas: HTMLCanvasElement): void {
    this.canvases.set(box.key, canvas);
  }

  /** Something is being changed: values wait. */
  stop(): void {
    clearTimeout(this.timer);
    this.timer = 0;
    this.waiting = [];
  }

  /** Draws all that are seen once nothing has changed for a while. */
  later(): void {
    this.stop();
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      const of = this.graph();
      if (!of) return;
      this.waiting = [...of.view.boxes.values()].filter((box) => box.kind !== 'outputs' && this.isSeen(box));
      this.next();
    }, kRest);
  }

  private next(): void {
    if (this.idle || this.waiting.length === 0) return;
    const wait = window.requestIdleCallback ?? ((act: () => void) => window.setTimeout(act, 30));
    this.idle = wait(() => {
      this.idle = 0;
      const box = this.waiting.shift();
      const of = this.graph();
      if (box && of) this.draw(box, of);
      this.next();
    });
  }

  private draw(box: Box, of: NonNullable<ReturnType<typeof this.graph>>): void {
    const canvas = this.canvases.get(box.key);
    const context = canvas?.getContext('2d');
    if (!canvas || !context) return;
    context.clearRect(0, 0, canvas.width, canvas.height);
    ++this.drawn;
    if (box.kind === 'parameter') return show(context, of.values[box.name] ?? 0);
    if (box.kind === 'texture') return symbol(context, '▦');
    if (box.kind === 'input') return symbol(context, '·');
    const type = box.outputs[0]?.type ?? '';
    const options = { node_texts: of.options.node_texts, node: namedOutput(of.within, box), values: numbersOf(of.values) } as Options;
    try {
      const flat = type === 'float' || type === 'int' || type === 'bool' ? constant(of.graph, options) : null;
      if (flat !== null) return show(context, flat);
      const { width } = canvas;
      const pixels = of.graph.preview(kPixels, options);
      const picture = new ImageData(new Uint8ClampedArray(pixels), kPixels, kPixels);
      void createImageBitmap(picture).then((bitmap) => context.drawImage(bitmap, 0, 0, width, width));
    } catch (error) {
      if (!(error instanceof LacquerError)) throw error;
      symbol(context, type.startsWith('mat') ? '▦' : '–');
    }
  }
}

const numbersOf = (values: Record<string, Value>) => Object.fromEntries(Object.entries(values).filter(([, x]) => typeof x === 'number' || Array.isArray(x)));

/** Of a group that was entered it is the value in the instance that one came through. */
function namedOutput(within: string[], box: Box): string {
  const name = box.outputs[0]?.name;
  return `${[...within, box.name].join('/')}${name ? `.${name}` : ''}`;
}

/** The number, where it is the same at all points; null where it is not. */
function constant(graph: Graph, options: Options): Value | null {
  let values: number[][];
  try {
    ({ values } = graph.evaluate(kPoints, options) as unknown as { values: number[][] });
  } catch (error) {
    if (!(error instanceof LacquerError)) throw error;
    return null; // an image is wanted: the ball has a neutral one
  }
  if (!Array.isArray(values) || values.some((row) => row?.[0] !== values[0][0])) return null;
  return values[0];
}

function symbol(context: CanvasRenderingContext2D, text: string): void {
  write(context, text, 30);
}

function write(context: CanvasRenderingContext2D, text: string, size: number): void {
  const { canvas } = context;
  context.fillStyle = getComputedStyle(canvas).color;
  context.font = `${size}px system-ui, sans-serif`;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.fillText(text, canvas.width / 2, canvas.height / 2, canvas.width - 4);
}

/** One number as text, colours as one. */
function show(context: CanvasRenderingContext2D, value: Value): void {
  const list = [value].flat().map(Number);
  const { canvas } = context;
  if (list.length < 3) return write(context, list.map((x) => String(Number(x.toPrecision(3)))).join(' '), list.length > 1 ? 17 : 22);
  const [r, g, b] = list.map((x) => Math.round(255 * Math.min(Math.max(x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055, 0), 1)));
  context.fillStyle = `rgb(${r} ${g} ${b})`;
  context.beginPath();
  context.arc(canvas.width / 2, canvas.height / 2, canvas.width / 2 - 4, 0, 2 * Math.PI);
  context.fill();
}
