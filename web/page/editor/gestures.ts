// Mouse, fingers and keys on the canvas.
import * as actions from './actions';
import { path, portPlace, type PortAt } from './canvas';
import type { Editor } from './editor';
import { converts } from './palette';
import type { Box, Comment, Place } from './view';

/** Pixels within which a press is a click. */
const kStill = 4;
const kStep = 16;

interface Drag {
  move: (event: PointerEvent) => void;
  end: (event: PointerEvent, still: boolean) => void;
}

export function connectGestures(editor: Editor): void {
  const { root, canvas } = editor;
  let drag: Drag | null = null;
  let start: Place = { x: 0, y: 0 };
  const fingers = new Map<number, Place>();
  root.addEventListener('pointerdown', (event) => {
    const target = event.target as HTMLElement;
    if (target.closest('.bubble, input, textarea')) return;
    editor.closeBubble();
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    start = { x: event.clientX, y: event.clientY };
    drag = fingers.size > 1 ? pinch(editor, fingers) : begin(editor, event);
    if (drag) root.setPointerCapture(event.pointerId);
    if (!canvas.boxAt(target)) root.focus({ preventScroll: true });
  });
  root.addEventListener('pointermove', (event) => {
    if (!fingers.has(event.pointerId)) return;
    drag?.move(event);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  const end = (event: PointerEvent) => {
    if (!fingers.delete(event.pointerId)) return;
    const still = Math.hypot(event.clientX - start.x, event.clientY - start.y) < kStill;
    const done = drag;
    drag = null;
    done?.end(event, still);
  };
  root.addEventListener('pointerup', end);
  root.addEventListener('pointercancel', end);
  root.addEventListener('wheel', (event) => {
    event.preventDefault();
    if (event.shiftKey) {
      canvas.pan = { x: canvas.pan.x - event.deltaY, y: canvas.pan.y };
      canvas.move();
    } else canvas.zoomBy(Math.exp(-event.deltaY / 500), event.clientX, event.clientY);
    editor.thumbs.later();
  }, { passive: false });
  root.addEventListener('dblclick', (event) => {
    const under = document.elementFromPoint(event.clientX, event.clientY); // the target is what had the pointer
    const box = canvas.boxAt(under);
    if (box?.kind === 'group') editor.enter(box);
    else if (!box && !under?.closest('.note, .bubble')) editor.addAt(event.clientX, event.clientY);
  });
  root.addEventListener('focusin', (event) => {
    const box = canvas.boxAt(event.target);
    if (box && !editor.selection.has(box.key)) editor.choose([box.key]);
  });
  connectKeys(editor);
  connectClipboard(editor);
}

function begin(editor: Editor, event: PointerEvent): Drag | null {
  const { canvas } = editor;
  const port = event.button === 0 ? canvas.portAt(event.target) : null;
  if (port) return dragWire(editor, port);
  const box = event.button === 0 ? canvas.boxAt(event.target) : null;
  if (box) return dragBoxes(editor, box, event);
  const { comment, corner } = (event.target as HTMLElement).dataset;
  if (event.button === 0 && (comment ?? corner) !== undefined) return dragComment(editor, Number(comment ?? corner), corner !== undefined);
  if (event.button === 0 && event.shiftKey) return marquee(editor, event);
  return pan(editor, canvas.wireAt(event.target));
}

/** Moves the whole; a click on a wire chooses it, one on nothing chooses nothing. */
function pan(editor: Editor, wire: ReturnType<Editor['canvas']['wireAt']>): Drag {
  const { canvas } = editor;
  return {
    move: (event) => {
      canvas.pan = { x: canvas.pan.x + event.movementX, y: canvas.pan.y + event.movementY };
      canvas.move();
    },
    end: (_event, still) => (still ? editor.choose([], wire) : editor.thumbs.later()),
  };
}

function pinch(editor: Editor, fingers: Map<number, Place>): Drag {
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return { size: Math.hypot(a.x - b.x, a.y - b.y), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
  };
  return {
    move: (event) => {
      if (fingers.size < 2) return;
      const before = spread();
      fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      const now = spread();
      editor.canvas.pan = { x: editor.canvas.pan.x + now.x - before.x, y: editor.canvas.pan.y + now.y - before.y };
      editor.canvas.zoomBy(now.size / Math.max(before.size, 1), now.x, now.y);
    },
    end: () => editor.thumbs.later(),
  };
}

function dragBoxes(editor: Editor, box: Box, { shiftKey, ctrlKey, metaKey }: PointerEvent): Drag {
  const { canvas } = editor;
  const more = shiftKey || ctrlKey || metaKey;
  const had = editor.selection.has(box.key);
  if (more) editor.choose(had ? [...editor.selection].filter((key) => key !== box.key) : [...editor.selection, box.key]);
  else if (!had) editor.choose([box.key]);
  canvas.elementOf(box.key)?.focus({ preventScroll: true });
  let moved = { x: 0, y: 0 };
  const boxes = editor.chosenBoxes.map((each) => ({ each, x: each.x, y: each.y }));
  return {
    move: (event) => {
      moved = { x: moved.x + event.movementX / canvas.zoom, y: moved.y + event.movementY / canvas.zoom };
      for (const { each, x, y } of boxes) Object.assign(each, { x: x + moved.x, y: y + moved.y });
      canvas.place(boxes.map(({ each }) => each.key));
    },
    end: (_event, still) => {
      if (!still) return editor.keepPlaces(boxes.map(({ each }) => each.key));
      for (const { each, x, y } of boxes) Object.assign(each, { x, y });
      canvas.place(boxes.map(({ each }) => each.key));
      if (!more && had) editor.choose([box.key]);
    },
  };
}

/** A comment takes along the boxes that lie in it. */
function dragComment(editor: Editor, index: number, corner: boolean): Drag | null {
  const { canvas, view } = editor;
  const comment = view?.comments[index];
  const element = canvas.comments.querySelector<HTMLElement>(`[data-comment="${index}"]`);
  if (!view || !comment || !element) return null;
  const within = (box: Box, of: Comment) => box.x >= of.x && box.y >= of.y && box.x + box.width <= of.x + of.width && box.y + box.height <= of.y + of.height;
  const boxes = corner ? [] : [...view.boxes.values()].filter((box) => within(box, comment));
  return {
    move: (event) => {
      const [x, y] = [event.movementX / canvas.zoom, event.movementY / canvas.zoom];
      if (corner) Object.assign(comment, { width: Math.max(80, comment.width + x), height: Math.max(50, comment.height + y) });
      else Object.assign(comment, { x: comment.x + x, y: comment.y + y });
      for (const box of boxes) Object.assign(box, { x: box.x + x, y: box.y + y });
      Object.assign(element.style, { left: `${comment.x}px`, top: `${comment.y}px`, width: `${comment.width}px`, height: `${comment.height}px` });
      canvas.place(boxes.map(({ key }) => key));
    },
    end: (_event, still) => {
      if (!still) editor.keepPlaces(boxes.map(({ key }) => key), true);
    },
  };
}

function marquee(editor: Editor, { clientX, clientY }: PointerEvent): Drag {
  const { canvas } = editor;
  const from = canvas.toWorld(clientX, clientY);
  const before = [...editor.selection];
  return {
    move: (event) => {
      const to = canvas.toWorld(event.clientX, event.clientY);
      const [x, y] = [Math.min(from.x, to.x), Math.min(from.y, to.y)];
      const [width, height] = [Math.abs(from.x - to.x), Math.abs(from.y - to.y)];
      canvas.frame.hidden = false;
      Object.assign(canvas.frame.style, { left: `${x}px`, top: `${y}px`, width: `${width}px`, height: `${height}px` });
      const caught = [...editor.view!.boxes.values()].filter((box) => box.x < x + width && x < box.x + box.width && box.y < y + height && y < box.y + box.height);
      editor.select([...new Set([...before, ...caught.map(({ key }) => key)])]);
    },
    end: () => {
      canvas.frame.hidden = true;
    },
  };
}

/** From an output, or from an input backwards; a wire that an input has is taken off it. */
function dragWire(editor: Editor, port: PortAt): Drag {
  const { canvas } = editor;
  const had = port.side === 'in' ? editor.view!.wires.find(({ to, input }) => to === port.box && input === port.index) : undefined;
  const held: PortAt = had ? { box: had.from, index: had.output, side: 'out', port: had.from.outputs[had.output] } : port;
  const fixed = portPlace(held.box, held.side, held.index);
  canvas.portElement(port)?.focus({ preventScroll: true });
  let moved = false;
  return {
    move: (event) => {
      if (!moved) showFitting(editor, held);
      moved = true;
      const at = canvas.toWorld(event.clientX, event.clientY);
      canvas.loose.setAttribute('d', held.side === 'out' ? path(fixed, at) : path(at, fixed));
    },
    end: (event, still) => {
      canvas.loose.setAttribute('d', '');
      showFitting(editor, null);
      if (still) return editor.choose([port.box.key]);
      const under = document.elementFromPoint(event.clientX, event.clientY);
      drop(editor, held, canvas.portAt(under) ?? portOfBox(editor, held, under), under, event);
      if (had && canvas.portAt(under)?.port !== port.port && !canvas.boxAt(under)) actions.cut(editor, port.box, port.index);
    },
  };
}

/** On a box and not on one of its ports: the first that fits. */
function portOfBox(editor: Editor, held: PortAt, under: Element | null): PortAt | null {
  const box = editor.canvas.boxAt(under);
  if (!box || box === held.box) return null;
  const side = held.side === 'out' ? 'in' : 'out';
  const ports = side === 'in' ? box.inputs : box.outputs;
  const fits = (port: PortAt['port']) => (side === 'in' ? held.port.type === port.type : port.type === held.port.type);
  const found = ports.findIndex((port) => fits(port) && (side === 'out' || port.source === null));
  const index = found >= 0 ? found : ports.findIndex(fits);
  return index >= 0 ? { box, index, side, port: ports[index] } : null;
}

function drop(editor: Editor, held: PortAt, to: PortAt | null, under: Element | null, { clientX, clientY }: PointerEvent): void {
  if (to) return void join(editor, held, to);
  if (!editor.canvas.boxAt(under) && editor.root.contains(under)) editor.addAt(clientX, clientY, held);
}

export function join(editor: Editor, one: PortAt, other: PortAt): boolean {
  if (one.side === other.side) {
    const what = one.side === 'in' ? 'inputs' : 'outputs';
    editor.refuse([{ level: 'error', code: 'page', file: '', pointer: '', line: 0, column: 0, message: `both are ${what}`, help: 'a wire goes from an output to an input', text: '' }], editor.canvas.portElement(other));
    return false;
  }
  return one.side === 'out' ? editor.connect(one, other) : editor.connect(other, one);
}

/** While a wire is held: which ports take it as it is, which by a swizzle, which not. */
function showFitting(editor: Editor, held: PortAt | null): void {
  editor.root.classList.toggle('wiring', held !== null);
  for (const element of editor.root.querySelectorAll<HTMLElement>('.port')) {
    const port = held && editor.canvas.portAt(element);
    const [from, to] = held?.side === 'out' ? [held.port.type, port?.port.type] : [port?.port.type, held?.port.type];
    const can = port && held && port.side !== held.side && port.box !== held.box && (port.port.type === '' || converts(from ?? '', to ?? ''));
    element.classList.toggle('fits', Boolean(can));
  }
}

// ---- keys

function connectKeys(editor: Editor): void {
  const { root, canvas } = editor;
  let held: PortAt | null = null;
  const hold = (port: PortAt | null) => {
    held = port;
    showFitting(editor, port);
    for (const element of root.querySelectorAll('.held')) element.classList.remove('held');
    if (port) canvas.portElement(port)?.classList.add('held');
  };
  const onPort = (port: PortAt) => {
    if (held && held.port !== port.port) {
      const from = held;
      hold(null);
      join(editor, from, port);
    } else hold(held ? null : port);
  };
  root.addEventListener('keydown', (event) => {
    const target = event.target as HTMLElement;
    if (target.closest('.bubble, input, textarea')) return;
    const port = canvas.portAt(target);
    const done = () => {
      event.preventDefault();
      event.stopPropagation();
    };
    if (event.key === 'Escape') {
      if (held) hold(null);
      else if (port) canvas.elementOf(port.box.key)?.focus();
      else if (editor.path.length > 0) editor.goTo(editor.path.slice(0, -1));
      else editor.choose([]);
      return done();
    }
    if (port && (event.key === 'Enter' || event.key === ' ')) return onPort(port), done();
    if (port && event.key === 'Delete' && port.side === 'in') return actions.cut(editor, port.box, port.index), done();
    if (event.key.startsWith('Arrow')) return arrow(editor, event, port), done();
    if (command(editor, event)) done();
  });
}

const kArrows: Record<string, Place> = { ArrowLeft: { x: -1, y: 0 }, ArrowRight: { x: 1, y: 0 }, ArrowUp: { x: 0, y: -1 }, ArrowDown: { x: 0, y: 1 } };

/** From port to port in a box, from box to box else; with Alt the chosen boxes move. */
function arrow(editor: Editor, { key, altKey, shiftKey }: KeyboardEvent, port: PortAt | null): void {
  const { canvas } = editor;
  const way = kArrows[key];
  if (altKey) return actions.nudge(editor, way.x * kStep, way.y * kStep);
  if (port && way.y !== 0) {
    const ports = port.side === 'in' ? port.box.inputs : port.box.outputs;
    return canvas.portElement({ ...port, index: (port.index + way.y + ports.length) % ports.length })?.focus();
  }
  if (port) {
    const side = way.x < 0 ? 'in' : 'out';
    const inner = side !== port.side && canvas.portElement({ box: port.box, side, index: 0 });
    if (inner) return inner.focus();
  }
  const from = port?.box ?? editor.chosenBoxes[0] ?? editor.view?.boxes.values().next().value;
  const next = from && nearest(editor, from, way);
  if (!next) return;
  editor.choose(shiftKey ? [...new Set([...editor.selection, next.key])] : [next.key]);
  canvas.reveal(next.key);
  canvas.elementOf(next.key)?.focus({ preventScroll: true });
}

/** The next box that way: near, and not far to the side. */
function nearest(editor: Editor, from: Box, way: Place): Box | null {
  let best: Box | null = null;
  let least = Infinity;
  const middle = ({ x, y, width, height }: Box) => ({ x: x + width / 2, y: y + height / 2 });
  const here = middle(from);
  for (const box of editor.view!.boxes.values()) {
    if (box === from) continue;
    const there = middle(box);
    const along = (there.x - here.x) * way.x + (there.y - here.y) * way.y;
    const across = Math.abs((there.x - here.x) * way.y) + Math.abs((there.y - here.y) * way.x);
    const far = along + 2.5 * across;
    if (along > 1 && far < least) [best, least] = [box, far];
  }
  return best;
}

function command(editor: Editor, event: KeyboardEvent): boolean {
  const { canvas } = editor;
  const plain = !event.ctrlKey && !event.metaKey && !event.altKey;
  const key = event.key.toLowerCase();
  const at = canvas.root.getBoundingClientRect();
  if (plain) {
    const acts: Record<string, () => void> = {
      delete: () => actions.remove(editor), backspace: () => actions.remove(editor), f: () => canvas.fit(editor.selection.size > 1 ? editor.selection : undefined),
      a: () => editor.addAt(at.left + at.width / 3, at.top + at.height / 3), '/': () => editor.addAt(at.left + at.width / 3, at.top + at.height / 3),
      '+': () => canvas.zoomBy(1.25), '=': () => canvas.zoomBy(1.25), '-': () => canvas.zoomBy(0.8), c: () => actions.comment(editor),
      enter: () => enter(editor), tab: () => undefined,
    };
    if (!acts[key] || key === 'tab') return false;
    acts[key]();
    return true;
  }
  if (event.altKey) return false;
  const acts: Record<string, () => void> = {
    a: () => editor.choose([...editor.view!.boxes.keys()]), d: () => actions.duplicate(editor),
    g: () => (event.shiftKey ? actions.dissolve(editor) : actions.makeGroup(editor)), enter: () => editor.chosenBoxes[0] && editor.enter(editor.chosenBoxes[0]),
  };
  if (!acts[key]) return false;
  acts[key]();
  return true;
}

/** Into the ports of the chosen box. */
function enter(editor: Editor): void {
  const [box] = editor.chosenBoxes;
  if (!box) return;
  const { canvas } = editor;
  (canvas.portElement({ box, side: 'in', index: 0 }) ?? canvas.portElement({ box, side: 'out', index: 0 }))?.focus();
}

function connectClipboard(editor: Editor): void {
  const here = () => editor.root.contains(document.activeElement) && !document.activeElement!.matches('input, textarea');
  for (const kind of ['copy', 'cut'] as const) {
    document.addEventListener(kind, (event) => {
      const text = here() ? actions.copied(editor) : '';
      if (!text) return;
      event.clipboardData?.setData('text/plain', text);
      event.preventDefault();
      if (kind === 'cut') actions.remove(editor);
    });
  }
  document.addEventListener('paste', (event) => {
    if (here() && actions.paste(editor, event.clipboardData?.getData('text/plain') ?? '')) event.preventDefault();
  });
}
