// The file's cameras: which one shows the picture, until it is turned by hand.
import { byId, h } from './dom';
import type { Page } from './main';
import { orbitFrom, type Camera } from './view';

export class Cameras {
  constructor(private readonly page: Page) {
    byId('camera').addEventListener('change', () => {
      this.follow();
      page.viewport.redraw();
      page.files.changed();
    });
  }
  /** Its number among the file's; empty where the hand turns the picture. */
  get value(): string {
    return byId<HTMLSelectElement>('camera').value;
  }
  choose(value: string): void {
    const choice = byId<HTMLSelectElement>('camera');
    if (![...choice.options].some((option) => option.value === value)) return;
    choice.value = value;
    this.follow();
    this.page.viewport.redraw();
  }
  private get chosen(): Camera | undefined {
    const { value } = this;
    return value === '' ? undefined : this.page.document?.cameras.all[Number(value)];
  }

  /** Of another document. */
  open(): void {
    const choice = byId<HTMLSelectElement>('camera');
    const all = this.page.document!.cameras.all;
    choice.replaceChildren(h('option', { value: '' }, 'Turned by hand'), ...all.map(({ name }, i) => h('option', { value: i }, name)));
    choice.parentElement!.hidden = all.length === 0;
    this.follow();
  }

  /** To where the camera is now. */
  follow(): void {
    const { document: of, viewport } = this.page;
    const { chosen } = this;
    viewport.camera = of && chosen ? of.cameras.at(chosen, of.moves) : null;
  }

  /** The hand takes over, from where the camera is. */
  leave(): void {
    const { viewport } = this.page;
    if (viewport.useBall || !viewport.camera) return;
    const { orbit, middle } = orbitFrom(viewport.camera, viewport.middle, viewport.radius);
    Object.assign(viewport.orbit, orbit);
    viewport.middle = middle;
    byId<HTMLSelectElement>('camera').value = '';
    viewport.camera = null;
    this.page.files.changed();
  }
}
