// How the texts are made that are taken away, where that is not how the picture is drawn: options of `lacquer gen`.
import type { Options } from '../src/index';
import { byId, h } from './dom';

/** By the names that `Options` has of them: what a control says of each value. */
const kChoices: { key: 'parameters' | 'lights' | 'binding' | 'relaxed'; name: string; title: string; values: Record<string, string> }[] = [
  {
    key: 'parameters', name: 'Numbers', title: '--params: where the material\'s numbers are',
    values: { uniform: 'in a block', baked: 'in the text', spec: 'specialization constants' },
  },
  { key: 'lights', name: 'Lamps', title: '--lights: how many there may be', values: { any: 'any number', scene: 'those of the file', fixed: 'so many of each kind', none: 'none' } },
  { key: 'binding', name: 'Binding', title: '--binding', values: { sets: 'sets', bindless: 'bindless', arrays: 'arrays' } },
  {
    key: 'relaxed', name: 'Half precision', title: '--relaxed: the part of a colour that half precision may change',
    values: { 0.002: '0.2 %', 0.01: '1 %', 0.02: '2 %' },
  },
];
/** What draws nothing of a material by itself. */
const kBases = ['mesh', 'sky'];
const kAsDrawn = 'as drawn';
/** Of a block of lamps in the node language. */
const kMostOfKind = 4096;

export class Generated {
  private readonly selects = new Map<string, HTMLSelectElement>();
  private readonly switches = new Map<string, HTMLSelectElement>();
  /** How many lamps there are of each kind, where that is fixed. */
  private readonly counts = new Map<string, HTMLInputElement>();

  constructor(private readonly nodes: any, changed: () => void) {
    const select = (name: string, title: string, values: Record<string, string>) => {
      const made = h('select', { change: changed, title }, h('option', { value: '' }, kAsDrawn), ...Object.entries(values).map(([value, text]) => h('option', { value }, text)));
      return [made, h('label', { title }, `${name} `, made)] as const;
    };
    const root = byId('generated');
    for (const { key, name, title, values } of kChoices) {
      const [made, label] = select(name, title, values);
      made.id = `gen-${key}`;
      this.selects.set(key, made);
      root.append(label);
      if (key === 'lights') root.append(this.fixed(made, changed));
    }
    const templates: { name: string; doc: string }[] = nodes.templates.filter(({ name }: { name: string }) => !kBases.includes(name));
    const [template, label] = select('Template', '--template', Object.fromEntries(templates.map(({ name }) => [name, name])));
    template.id = 'gen-template';
    templates.forEach(({ doc }, i) => (template.options[i + 1].title = doc));
    this.selects.set('template', template);
    root.append(label);
    const switches = h('div', { class: 'switches' });
    for (const { name, doc } of nodes.switches) {
      const [made, label] = select(name, doc, { on: 'on', off: 'off' });
      made.id = `switch-${name}`;
      this.switches.set(name, made);
      switches.append(label);
    }
    root.append(h('details', {}, h('summary', { title: '--switch: of the node library' }, 'Switches'), switches));
  }

  /** A number for each kind of lamp that a template has; they are shown where they count. */
  private fixed(choice: HTMLSelectElement, changed: () => void): HTMLElement {
    const place = h('span', { class: 'controls', id: 'gen-counts', hidden: true });
    const kinds = new Map<string, string>(this.nodes.templates.flatMap(({ lights }: { lights: { name: string; meaning: string }[] }) => lights.map(({ name, meaning }) => [name, meaning])));
    for (const [kind, meaning] of kinds) {
      const count = h('input', { type: 'number', min: 0, max: kMostOfKind, step: 1, value: kind === 'directional' ? 1 : 0, id: `gen-count-${kind}`, input: changed });
      this.counts.set(kind, count);
      place.append(h('label', { title: meaning }, `${kind} `, count));
    }
    choice.addEventListener('change', () => (place.hidden = choice.value !== 'fixed'));
    return place;
  }
  /** Of the kinds that the template has. */
  private lights(value: string, template: string | undefined): Options['lights'] {
    if (value === 'any' || value === 'scene') return value;
    const { templates } = this.nodes;
    const { lights } = templates.find(({ name }: { name: string }) => name === (template ?? 'forward')) ?? { lights: [] };
    const made: Record<string, number> = {};
    for (const { name } of value === 'fixed' ? lights : []) {
      const count = this.counts.get(name)?.valueAsNumber;
      if (count && Number.isInteger(count) && count > 0 && count <= kMostOfKind) made[name] = count;
    }
    return made;
  }

  /** What is other than in the picture. */
  options(drawn: Options): Options {
    const made: Options = { ...drawn };
    for (const [key, { value }] of this.selects) {
      if (value !== '' && key !== 'lights') Object.assign(made, { [key]: key === 'relaxed' ? Number(value) : value });
    }
    const { value } = this.selects.get('lights')!;
    if (value !== '') made.lights = this.lights(value, made.template);
    const set = [...this.switches].flatMap(([name, { value }]) => (value === '' ? [] : [[name, value === 'on'] as const]));
    if (set.length > 0) made.switches = { ...drawn.switches, ...Object.fromEntries(set) };
    return made;
  }
  /** The same as the program's flags. */
  flags(drawn: Options): string[] {
    const { parameters, lights, binding, relaxed, template, switches, profile } = this.options(drawn);
    const counts = typeof lights === 'object' ? Object.entries(lights).map(([kind, count]) => `${kind}:${count}`).join() || 'none' : lights;
    const flags = { profile, params: parameters, lights: counts, binding, relaxed, template };
    return [
      ...Object.entries(flags).flatMap(([name, value]) => (value === undefined || value === '' ? [] : [`--${name}`, String(value)])),
      ...Object.entries(switches ?? {}).flatMap(([name, on]) => ['--switch', `${name}=${on ? 'on' : 'off'}`]),
    ];
  }
}
