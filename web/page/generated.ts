// How the texts are made that are taken away, where that is not how the picture is drawn: options of `lacquer gen`.
import type { Options } from '../src/index';
import { byId, h } from './dom';

/** By the names that `Options` has of them: what a control says of each value. */
const kChoices: { key: 'parameters' | 'lights' | 'binding' | 'relaxed'; name: string; title: string; values: Record<string, string> }[] = [
  {
    key: 'parameters', name: 'Numbers', title: '--params: where the material\'s numbers are',
    values: { uniform: 'in a block', baked: 'in the text', spec: 'specialization constants' },
  },
  { key: 'lights', name: 'Lamps', title: '--lights', values: { any: 'any number', scene: 'those of the file', none: 'none' } },
  { key: 'binding', name: 'Binding', title: '--binding', values: { sets: 'sets', bindless: 'bindless', arrays: 'arrays' } },
  {
    key: 'relaxed', name: 'Half precision', title: '--relaxed: the part of a colour that half precision may change',
    values: { 0.002: '0.2 %', 0.01: '1 %', 0.02: '2 %' },
  },
];
/** What draws nothing of a material by itself. */
const kBases = ['mesh', 'sky'];
const kAsDrawn = 'as drawn';

export class Generated {
  private readonly selects = new Map<string, HTMLSelectElement>();
  private readonly switches = new Map<string, HTMLSelectElement>();

  constructor(nodes: any, changed: () => void) {
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

  /** What is other than in the picture. */
  options(drawn: Options): Options {
    const made: Options = { ...drawn };
    for (const [key, { value }] of this.selects) {
      if (value === '') continue;
      Object.assign(made, { [key]: key === 'relaxed' ? Number(value) : key === 'lights' && value === 'none' ? {} : value });
    }
    const set = [...this.switches].flatMap(([name, { value }]) => (value === '' ? [] : [[name, value === 'on'] as const]));
    if (set.length > 0) made.switches = { ...drawn.switches, ...Object.fromEntries(set) };
    return made;
  }
}
