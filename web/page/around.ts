// What is around the material: its environment, background and lamps, as the controls below the picture and the document have them.
import { byId, h } from './dom';
import { addEnvironment, kEnvironments } from './environment';
import { readExr } from './exr';
import { radianceOf, readHdr } from './hdr';
import { Lamps } from './lamps';
import { kStudioLights, type Light } from './lights';
import type { Page } from './main';
import { around, kStage, lightsOf, type Lamp, type Stage } from './stage';
import type { Viewport } from './viewport';

/** Texels of a side of the cube that an environment of one's own is filtered into. */
const kOwnEnvironment = 128;

export class Around {
  /** What was chosen before the lamps that are placed by hand. */
  private before = 'studio';
  private readonly lamps: Lamps;

  constructor(private readonly page: Page) {
    const { viewport } = page;
    byId('environment').replaceChildren(...Object.keys(kEnvironments).map((name) => h('option', {}, name)));
    this.lamps = new Lamps(viewport, () => this.stage, (index, to, done) => this.changeLamp(index, to, done));
    this.on('lamps', 'change', () => this.choose());
    this.on('environment', 'change', () => {
      viewport.environment = byId<HTMLSelectElement>('environment').value;
      page.relight();
    });
    this.on('background', 'change', () => {
      viewport.background = byId<HTMLSelectElement>('background').value as Viewport['background'];
      viewport.redraw();
    });
    const turn = byId<HTMLInputElement>('turn');
    this.on('turn', 'input', () => this.turnTo((turn.valueAsNumber * Math.PI) / 180, false));
    this.on('turn', 'change', () => this.turnTo(this.stage.turn, true));
    this.on('brightness', 'input', () => {
      viewport.brightness = Number(byId<HTMLInputElement>('brightness').value);
      page.relight();
    });
  }
  private on(id: string, event: string, act: () => void): void {
    byId(id).addEventListener(event, act);
  }

  private get stage(): Stage {
    return this.page.document?.stage ?? kStage;
  }

  /** Of another document. */
  open(): void {
    const { count } = this.page.document!.lights;
    const lamps = byId<HTMLSelectElement>('lamps');
    lamps.querySelector<HTMLOptionElement>('[value=own]')!.disabled = count === 0;
    if (count === 0) {
      if (this.before === 'own') this.before = 'studio';
      if (lamps.value === 'own') lamps.value = 'studio';
    }
    this.show();
  }

  /** As the document has it, after a step back, too. */
  show(): void {
    const { viewport } = this.page;
    const lamps = byId<HTMLSelectElement>('lamps');
    if (this.stage.placed) lamps.value = 'placed';
    else if (lamps.value === 'placed') lamps.value = this.before;
    if (lamps.value !== 'placed') this.before = lamps.value;
    const lights: Record<string, Light[]> = { studio: kStudioLights, own: this.ownLights(), none: [] };
    viewport.lights = lights[lamps.value] ?? lightsOf(this.stage);
    viewport.turn = this.stage.turn;
    byId<HTMLInputElement>('turn').valueAsNumber = Math.round((this.stage.turn * 180) / Math.PI);
    this.lamps.show();
    viewport.redraw();
  }

  private ownLights(): Light[] {
    const of = this.page.document;
    return of ? of.lights.at(of.moves) : [];
  }
  /** The file's own have moved. */
  follow(): void {
    if (byId<HTMLSelectElement>('lamps').value === 'own') this.page.viewport.lights = this.ownLights();
  }

  private choose(): void {
    const placed = byId<HTMLSelectElement>('lamps').value === 'placed';
    if (placed !== this.stage.placed) this.set({ ...this.stage, placed }, 'lamps', true);
    this.show();
    this.page.relight();
  }

  /** Turns what is around, by so much or to an angle. */
  turnBy(angle: number, done: boolean): void {
    this.turnTo(around(this.stage.turn + angle), done);
  }
  private turnTo(turn: number, done: boolean): void {
    this.set({ ...this.stage, turn }, 'turn', done);
  }

  private changeLamp(index: number, to: Partial<Lamp>, done: boolean): void {
    const { stage } = this;
    const lamps = stage.lamps.map((lamp, i) => (i === index ? { ...lamp, ...to } : lamp)) as Stage['lamps'];
    this.set({ ...stage, lamps }, `lamp ${index} ${Object.keys(to)}`, done);
  }

  /** Changes of one `key` in a row, until one is done, are one step back. */
  private set(stage: Stage, key: string, done: boolean): void {
    const { page } = this;
    const of = page.document;
    if (!of) return;
    const other = JSON.stringify(stage) !== JSON.stringify(of.stage);
    if (other) of.setStage(stage, key);
    if (done) of.settle();
    if (other) this.show();
    if (done) page.relight();
    if (other) page.showWays();
  }

  /** An environment of the user's own. */
  surround(name: string, bytes: Uint8Array): void {
    try {
      const picture = /\.exr$/i.test(name) ? readExr(bytes) : readHdr(bytes);
      addEnvironment(name, radianceOf(picture), kOwnEnvironment);
    } catch (error) {
      return this.page.fail(new Error(`${name}: ${error instanceof Error ? error.message : String(error)}`));
    }
    const choice = byId<HTMLSelectElement>('environment');
    if (![...choice.options].some(({ value }) => value === name)) choice.append(h('option', {}, name));
    choice.value = name;
    choice.dispatchEvent(new Event('change'));
  }
}
