// A pane for a node file of one's own: checked as it is written, and used as soon as it is good.
import type { Lacquer, Message } from '../src/index';
import { byId, h, tell } from './dom';

/** What messages call the file. */
export const kOwnNodes = 'mine.node';
/** Milliseconds after the last key until the text is checked. */
const kRest = 150;

const kFirst = `/// What it does, in a sentence.
/// source: where its formula stands
node mine(
    vec3  color in [0, 1],
    float amount in [0, 1] = 0.5
) -> vec3 in [0, 1] {
    return color * amount;
}
`;

export class NodeText {
  private readonly field = byId<HTMLTextAreaElement>('node-text');
  private timer = 0;
  /** The last text that was good: the library has it. */
  good = '';

  constructor(private readonly lacquer: Lacquer, private readonly changed: () => void) {
    this.field.addEventListener('input', () => {
      this.number();
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => this.check(), kRest);
    });
    this.field.addEventListener('scroll', () => (byId('node-lines').scrollTop = this.field.scrollTop));
    byId('node-start').addEventListener('click', () => {
      this.field.value = this.field.value.trim() === '' ? kFirst : `${this.field.value.trimEnd()}\n\n${kFirst}`;
      this.field.dispatchEvent(new Event('input'));
      this.field.focus();
    });
    this.number();
  }

  /** The text of a file that was opened; not yet the library's. */
  set(text: string): void {
    if (this.field.value === text && this.good === text) return;
    this.field.value = text;
    this.number();
    const [messages] = this.messages(text);
    this.good = messages ? '' : text;
    this.tell();
  }
  get text(): string {
    return this.field.value;
  }

  private check(): void {
    const { value } = this.field;
    const [wrong] = this.messages(value);
    this.tell();
    if (wrong || value === this.good) return;
    this.good = value;
    this.changed();
  }
  /** Whether there is an error, and all that there is to say. */
  private messages(text: string): [boolean, Message[]] {
    if (text.trim() === '') return [false, []];
    const messages = this.lacquer.checkNodes({ node_texts: { [kOwnNodes]: text } });
    return [messages.some(({ level }) => level === 'error'), messages];
  }

  private tell(): void {
    const { value } = this.field;
    const [wrong, messages] = this.messages(value);
    const names = [...value.matchAll(/^node\s+(\w+)/gm)].map((match) => match[1]);
    tell('node-told', wrong ? 'The library has the text as it was before, until this one is good.'
      : names.length > 0 ? `The palette has ${names.join(', ')}.` : 'Nodes that are written here are in the palette of the graph.', wrong ? 'error' : '');
    byId('node-messages').replaceChildren(...messages.map(({ level, line, column, message, help }) => h(
      'li', { class: level },
      h('button', { type: 'button', class: 'quiet', title: 'Go there', click: () => this.goTo(line, column) }, `${line}:${column}`),
      ` ${message}`, ...(help ? [h('small', {}, ` ${help}`)] : []),
    )));
    const lines = new Set(messages.filter(({ level }) => level === 'error').map(({ line }) => line));
    [...byId('node-lines').children].forEach((row, i) => row.classList.toggle('wrong', lines.has(i + 1)));
  }

  private number(): void {
    const count = this.field.value.split('\n').length;
    const lines = byId('node-lines');
    while (lines.children.length > count) lines.lastChild!.remove();
    while (lines.children.length < count) lines.append(h('span', {}, `${lines.children.length + 1}`));
  }
  /** The column counts bytes, the field UTF-16. */
  private goTo(line: number, column: number): void {
    const lines = this.field.value.split('\n');
    const before = lines.slice(0, line - 1).reduce((sum, each) => sum + each.length + 1, 0);
    const bytes = new TextEncoder().encode(lines[line - 1] ?? '').slice(0, Math.max(0, column - 1));
    const at = before + new TextDecoder().decode(bytes).length;
    this.field.focus();
    this.field.setSelectionRange(at, at);
  }
}
