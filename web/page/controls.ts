// What the page's parts have in common: tabs, and turning what the viewport shows.
import { byId } from './dom';
import type { Viewport } from './viewport';

/** Tabs as the pattern of WAI-ARIA has them: arrow keys go from one to the next. */
export function connectTabs(changed: () => void): void {
  const tabs = [...document.querySelectorAll<HTMLElement>('[role=tab]')];
  const show = (tab: HTMLElement) => {
    for (const each of tabs) {
      each.setAttribute('aria-selected', String(each === tab));
      each.tabIndex = each === tab ? 0 : -1;
      byId(`panel-${each.dataset.tab}`).hidden = each !== tab;
    }
    changed();
  };
  tabs.forEach((tab, i) => {
    tab.addEventListener('click', () => show(tab));
    tab.addEventListener('keydown', (event) => {
      const step = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0;
      if (step === 0) return;
      const next = tabs[(i + step + tabs.length) % tabs.length];
      next.focus();
      show(next);
    });
  });
}

/** Pixels that a pointer may go between down and up, and it is still a click. */
const kClick = 4;

interface Acts {
  /** Turns what is around; whether that is all for now. */
  turnAround(angle: number, done: boolean): void;
  /** A click at a place of the picture, from -1 to 1, y up. */
  pick(x: number, y: number): void;
  /** The file's animation goes on, or stands. */
  play(): void;
  /** By so many pictures of it. */
  step(by: number): void;
  /** Before the picture is turned, moved or brought nearer. */
  byHand(): void;
}

/** What a mouse, fingers and keys do on either canvas: a drag turns the picture, with Shift what is around; with Ctrl, the right button
 * or two fingers it moves it; a wheel or two fingers come nearer. */
export function connectPointer(viewport: Viewport, acts: Acts): void {
  const { orbit } = viewport;
  const turn = (x: number, y: number) => {
    acts.byHand();
    orbit.yaw -= x;
    orbit.pitch = Math.min(Math.max(orbit.pitch + y, -1.5), 1.5);
    viewport.redraw();
  };
  const near = (by: number) => {
    acts.byHand();
    orbit.distance = Math.min(Math.max(orbit.distance * by, 1.2), 20);
    viewport.redraw();
  };
  const pan = (right: number, up: number) => {
    acts.byHand();
    viewport.pan(right, up);
  };
  const whole = () => {
    acts.byHand();
    viewport.fit();
  };
  byId('whole').addEventListener('click', whole);
  const steps: Record<string, () => void> = {
    ArrowLeft: () => turn(0.1, 0), ArrowRight: () => turn(-0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1),
    '+': () => near(0.9), '-': () => near(1.1), f: whole, F: whole,
    ' ': () => acts.play(), ',': () => acts.step(-1), '.': () => acts.step(1),
  };
  const shifted: Record<string, () => void> = { ArrowLeft: () => acts.turnAround(-0.1, false), ArrowRight: () => acts.turnAround(0.1, false) };
  const held: Record<string, () => void> = {
    ArrowLeft: () => pan(-0.1, 0), ArrowRight: () => pan(0.1, 0), ArrowUp: () => pan(0, 0.1), ArrowDown: () => pan(0, -0.1),
  };
  for (const canvas of [byId('viewport'), byId('viewport-gpu')]) {
    const down = new Map<number, { x: number; y: number }>();
    let turning = false;
    let panning = false;
    /** How far the pointer has gone; no number once it is no click. */
    let gone = NaN;
    const settle = () => {
      if (turning) acts.turnAround(0, true);
      turning = false;
    };
    /** The middle of the pointers, and how far they are apart. */
    const span = () => {
      const [a, b = a] = [...down.values()];
      return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.hypot(a.x - b.x, a.y - b.y) };
    };
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      down.set(event.pointerId, { x: event.clientX, y: event.clientY });
      gone = down.size === 1 && event.button === 0 && !event.shiftKey && !event.ctrlKey ? 0 : NaN;
      turning = event.shiftKey;
      panning = event.ctrlKey || event.button !== 0;
    });
    canvas.addEventListener('pointermove', (event) => {
      const last = down.get(event.pointerId);
      if (!last || down.size > 2) return;
      const before = span();
      down.set(event.pointerId, { x: event.clientX, y: event.clientY });
      const { x, y, apart } = span();
      const [across, along] = [x - before.x, y - before.y];
      gone += Math.hypot(across, along);
      if (down.size === 2 || panning) pan((-2 * across) / canvas.clientHeight, (2 * along) / canvas.clientHeight);
      else if (turning) acts.turnAround(across / 150, false);
      else turn(across / 150, along / 150);
      if (down.size === 2) near(Math.max(before.apart, 1) / Math.max(apart, 1));
    });
    for (const end of ['pointerup', 'pointercancel'] as const) {
      canvas.addEventListener(end, (event) => {
        down.delete(event.pointerId);
        settle();
        if (end === 'pointercancel' || !(gone < kClick)) return;
        const { left, top, width, height } = canvas.getBoundingClientRect();
        acts.pick((2 * (event.clientX - left)) / width - 1, 1 - (2 * (event.clientY - top)) / height);
      });
    }
    for (const end of ['keyup', 'blur']) canvas.addEventListener(end, settle);
    canvas.addEventListener('contextmenu', (event) => event.preventDefault()); // the right button moves the picture
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      near(Math.exp(event.deltaY / 900));
    }, { passive: false });
    canvas.addEventListener('keydown', (event) => {
      const act = event.ctrlKey || event.metaKey ? held[event.key] : (event.shiftKey ? shifted[event.key] : undefined) ?? steps[event.key];
      if (!act) return;
      event.preventDefault();
      turning ||= act === shifted[event.key];
      act();
    });
    new ResizeObserver(() => viewport.redraw()).observe(canvas);
  }
}
