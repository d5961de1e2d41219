// The two lamps that are placed by hand: their handles in the picture, and a row of controls for each.
import { byId, h } from './dom';
import { add, dot, point, scale, sub, unit, type Vec3 } from '../src/math';
import { anglesTo, around, kMostStrength, kSteepest, towards, type Lamp, type Stage } from './stage';
import type { Viewport } from './viewport';

/** Of the sphere that the handles are on, in radii of what is seen. */
const kSphere = 1.12;
/** Pixels that a handle stays away from the picture's edge. */
const kEdge = 16;
/** Of an arrow key, in radians; of plus and minus. */
const kStep = 0.05;
const kStronger = 1.1;

interface Row {
  handle: HTMLElement;
  on: HTMLInputElement;
  color: HTMLInputElement;
  strength: HTMLInputElement;
}

export class Lamps {
  private readonly rows: Row[];

  /** `change` is told the lamp's number, what is other of it, and whether that is all for now. */
  constructor(
    private readonly viewport: Viewport,
    private readonly stage: () => Stage,
    private readonly change: (index: number, to: Partial<Lamp>, done: boolean) => void,
  ) {
    this.rows = [0, 1].map((index) => this.row(index));
    const earlier = viewport.onDrawn;
    viewport.onDrawn = () => {
      earlier();
      this.place();
    };
  }

  private row(index: number): Row {
    const { change } = this;
    const name = `Lamp ${index + 1}`;
    const on = h('input', { type: 'checkbox', 'aria-label': `${name} is on`, change: () => change(index, { on: on.checked }, true) });
    const color = h('input', {
      type: 'color', 'aria-label': `Colour of lamp ${index + 1}`,
      input: () => change(index, { color: color.value }, false), change: () => change(index, { color: color.value }, true),
    });
    const strength = h('input', {
      type: 'range', min: 0, max: kMostStrength, step: 0.05, 'aria-label': `Strength of lamp ${index + 1}`,
      input: () => change(index, { strength: strength.valueAsNumber }, false), change: () => change(index, { strength: strength.valueAsNumber }, true),
    });
    const handle = h('div', {
      class: 'lamp', tabindex: 0, role: 'application',
      'aria-label': `${name}: arrow keys move it, plus and minus make it stronger and weaker, Space puts it out or on`,
      title: `${name}: drag it; over the edge and back it is behind`,
    }, String(index + 1));
    this.connect(handle, index);
    byId('picture').append(handle);
    byId('placed').append(h('span', { class: 'controls' }, h('label', {}, on, ` ${name}`), color, strength));
    return { handle, on, color, strength };
  }

  private connect(handle: HTMLElement, index: number): void {
    let behind = false;
    let outside = false;
    const move = (event: PointerEvent, done: boolean) => {
      const found = this.under(event, behind);
      if (outside && !found.outside) {
        behind = !behind;
        found.to = this.under(event, behind).to;
      }
      outside = found.outside;
      this.change(index, anglesTo(found.to), done);
    };
    let held: number | null = null;
    handle.addEventListener('pointerdown', (event) => {
      if (event.button !== 0 || held !== null) return;
      handle.setPointerCapture(event.pointerId);
      held = event.pointerId;
      behind = handle.classList.contains('behind');
      outside = false;
    });
    handle.addEventListener('pointermove', (event) => event.pointerId === held && move(event, false));
    for (const end of ['pointerup', 'pointercancel'] as const) {
      handle.addEventListener(end, (event) => {
        if (event.pointerId !== held) return;
        held = null;
        this.change(index, {}, true);
      });
    }
    handle.addEventListener('keydown', (event) => {
      const lamp = this.stage().lamps[index];
      const steps: Record<string, Partial<Lamp>> = {
        ArrowLeft: { yaw: around(lamp.yaw - kStep) }, ArrowRight: { yaw: around(lamp.yaw + kStep) },
        ArrowUp: { pitch: Math.min(lamp.pitch + kStep, kSteepest) }, ArrowDown: { pitch: Math.max(lamp.pitch - kStep, -kSteepest) },
        '+': { strength: Math.min(Math.max(lamp.strength, kStep) * kStronger, kMostStrength) }, '-': { strength: lamp.strength / kStronger },
        ' ': { on: !lamp.on },
      };
      if (!steps[event.key] || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      this.change(index, steps[event.key], false);
    });
    // Keys in a row are one step back.
    for (const end of ['keyup', 'blur']) handle.addEventListener(end, () => held === null && this.change(index, {}, true));
  }

  /** The direction to the place on the sphere under a pointer, in front or behind; the nearest where it is beside the sphere. */
  private under({ clientX, clientY }: PointerEvent, behind: boolean): { to: Vec3; outside: boolean } {
    const { viewport } = this;
    const { left, top, width, height } = byId('picture').getBoundingClientRect();
    const rays = viewport.rays(width / height);
    const [x, y] = [(2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height];
    const along = unit([0, 1, 2].map((i) => x * rays[i] + y * rays[3 + i] + rays[6 + i]) as Vec3);
    const from = sub(viewport.eye(), viewport.middle);
    const b = dot(from, along);
    const under = b * b - dot(from, from) + (kSphere * viewport.radius) ** 2;
    const at = -b + Math.sqrt(Math.max(under, 0)) * (behind ? 1 : -1);
    return { to: unit(add(from, scale(along, at))), outside: under < 0 };
  }

  /** Shows what the stage says. */
  show(): void {
    const { placed, lamps } = this.stage();
    byId('placed').hidden = !placed;
    lamps.forEach(({ on, color, strength }, i) => {
      const row = this.rows[i];
      row.on.checked = on;
      row.color.value = color;
      row.strength.valueAsNumber = strength;
      row.handle.hidden = !placed;
      row.handle.classList.toggle('off', !on);
      row.handle.style.setProperty('--lamp', color);
    });
    this.place();
  }

  private place(): void {
    const { placed, lamps } = this.stage();
    if (!placed) return;
    const { viewport } = this;
    const { clientWidth: width, clientHeight: height } = byId('picture');
    const seen = viewport.viewProjection(width / Math.max(height, 1));
    const from = sub(viewport.eye(), viewport.middle);
    lamps.forEach((lamp, i) => {
      const to = scale(towards(lamp), kSphere * viewport.radius);
      const at = add(viewport.middle, to);
      const w = seen[3] * at[0] + seen[7] * at[1] + seen[11] * at[2] + seen[15];
      const [x, y] = point(seen, at).map((each) => each / Math.max(w, 1e-6));
      const within = (place: number, size: number) => Math.min(Math.max(place, kEdge), Math.max(size - kEdge, kEdge));
      const { handle } = this.rows[i];
      // The half of a sphere that is seen from a place is less than half of it.
      handle.classList.toggle('behind', dot(from, to) < (kSphere * viewport.radius) ** 2);
      handle.style.left = `${within((0.5 + 0.5 * x) * width, width)}px`;
      handle.style.top = `${within((0.5 - 0.5 * y) * height, height)}px`;
    });
  }
}
