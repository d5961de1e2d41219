// The control of the file's animations: which one, whether it plays, and where it is.
import { bounds, type Vec3 } from '../src/gltf';
import type { Clip } from './clips';
import { byId, h } from './dom';
import { Drives } from './drives';
import { kPicturesPerSecond } from './frame';
import type { Page } from './main';

/** Moments of a clip at which it is looked where it comes to. */
const kLooks = 5;

type Ball = { middle: Vec3; radius: number };

/** The smallest ball around two. */
function around(a: Ball, b: Ball): Ball {
  const apart = Math.hypot(...a.middle.map((x, i) => b.middle[i] - x));
  if (apart + b.radius <= a.radius) return a;
  if (apart + a.radius <= b.radius) return b;
  const radius = (apart + a.radius + b.radius) / 2;
  return { radius, middle: a.middle.map((x, i) => x + ((b.middle[i] - x) * (radius - a.radius)) / apart) as Vec3 };
}

export class Player {
  private clip: Clip | null = null;
  private seconds = 0;
  private playing = !matchMedia('(prefers-reduced-motion: reduce)').matches;
  /** When the picture before was drawn; 0: it stood. */
  private ticked = 0;
  private readonly drives: Drives;

  constructor(private readonly page: Page) {
    this.drives = new Drives(page);
    const { viewport } = page;
    viewport.onMoment = () => this.tick();
    const choice = byId<HTMLSelectElement>('clip');
    choice.addEventListener('change', () => {
      this.choose(choice.value === '' ? null : this.clips[Number(choice.value)] ?? null);
      viewport.redraw();
    });
    byId('play-clip').addEventListener('click', () => this.play());
    const moment = byId<HTMLInputElement>('moment');
    moment.addEventListener('input', () => this.stopAt(moment.valueAsNumber));
  }
  private get clips(): Clip[] {
    return this.page.document?.moves.clips ?? [];
  }

  /** Of another document: its first clip. */
  open(): void {
    const { clips } = this;
    byId('moves').hidden = clips.length === 0;
    byId('clip').replaceChildren(...clips.map(({ name }, i) => h('option', { value: i }, name)), h('option', { value: '' }, 'None: at rest'));
    this.page.viewport.reach = null;
    this.choose(clips[0] ?? null);
  }

  private choose(clip: Clip | null): void {
    this.clip = clip;
    byId<HTMLInputElement>('moment').max = String(clip?.duration ?? 0);
    if (this.clips.length > 0) this.page.viewport.reach = this.reach();
    this.show(0);
  }

  /** Where all is in the clip, and where it is at rest. */
  private reach(): Ball | null {
    const { drawables, moves } = this.page.document!;
    if (drawables.length === 0) return null;
    const at = (clip: Clip | null, seconds: number) => {
      moves.pose(clip, seconds);
      return bounds(drawables);
    };
    let ball = at(null, 0);
    const { clip } = this;
    for (let i = 0; clip && i < kLooks; ++i) ball = around(ball, at(clip, (clip.duration * i) / (kLooks - 1)));
    return ball;
  }

  play(): void {
    if (!this.clip) return;
    this.playing = !this.playing;
    this.tell();
    this.page.viewport.redraw();
  }
  step(by: number): void {
    if (!this.clip) return;
    // Whole pictures of the clip, so that steps back lead where one was.
    const picture = Math.round(this.seconds * kPicturesPerSecond) + by;
    this.stopAt(Math.min(Math.max(picture / kPicturesPerSecond, 0), this.clip.duration));
  }
  private stopAt(seconds: number): void {
    this.playing = false;
    this.show(seconds);
    this.page.viewport.redraw();
  }

  /** Before a picture: whether the next one is of another moment. */
  private tick(): boolean {
    const { clip } = this;
    const running = this.playing && clip !== null && clip.duration > 0;
    const now = performance.now();
    // A page that was hidden goes on where it was.
    if (running && this.ticked > 0) this.show((this.seconds + Math.min(now - this.ticked, 250) / 1000) % clip.duration);
    this.ticked = running ? now : 0;
    this.drives.set(clip, this.seconds);
    return running;
  }

  private show(seconds: number): void {
    this.seconds = seconds;
    this.page.document?.moves.pose(this.clip, seconds);
    this.page.around.follow();
    this.page.cameras.follow();
    this.tell();
  }
  private tell(): void {
    byId('play-clip').textContent = this.playing ? 'Pause' : 'Play';
    for (const id of ['play-clip', 'moment']) byId<HTMLButtonElement>(id).disabled = !this.clip;
    byId<HTMLInputElement>('moment').valueAsNumber = this.seconds;
    byId('moment-told').textContent = `${this.seconds.toFixed(2)} of ${(this.clip?.duration ?? 0).toFixed(2)} s`;
  }
}
