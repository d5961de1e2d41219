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

/** Mouse, fingers and keys turn what is on either canvas; with Shift `turnAround` is told by how much what is around turns, and
 * whether that is all for now. */
export function connectPointer(viewport: Viewport, turnAround: (angle: number, done: boolean) => void): void {
  const { orbit } = viewport;
  const turn = (x: number, y: number) => {
    orbit.yaw -= x;
    orbit.pitch = Math.min(Math.max(orbit.pitch + y, -1.5), 1.5);
    viewport.redraw();
  };
  const near = (by: number) => {
    orbit.distance = Math.min(Math.max(orbit.distance * by, 1.2), 20);
    viewport.redraw();
  };
  const steps: Record<string, () => void> = {
    ArrowLeft: () => turn(0.1, 0), ArrowRight: () => turn(-0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1),
    '+': () => near(0.9), '-': () => near(1.1),
  };
  const shifted: Record<string, () => void> = { ArrowLeft: () => turnAround(-0.1, false), ArrowRight: () => turnAround(0.1, false) };
  for (const canvas of [byId('viewport'), byId('viewport-gpu')]) {
    let turning = false;
    const settle = () => {
      if (turning) turnAround(0, true);
      turning = false;
    };
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      turning = event.shiftKey;
    });
    canvas.addEventListener('pointermove', (event) => {
      if (!(event.buttons & 1)) return;
      if (turning) turnAround(event.movementX / 150, false);
      else turn(event.movementX / 150, event.movementY / 150);
    });
    for (const end of ['pointerup', 'pointercancel', 'keyup', 'blur']) canvas.addEventListener(end, settle);
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      near(Math.exp(event.deltaY / 900));
    }, { passive: false });
    canvas.addEventListener('keydown', (event) => {
      const act = (event.shiftKey ? shifted[event.key] : undefined) ?? steps[event.key];
      if (!act || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      turning ||= act === shifted[event.key];
      act();
    });
    new ResizeObserver(() => viewport.redraw()).observe(canvas);
  }
}
