// Messages above the text, with what can be done about them.
import { h } from './elements';

export class Notices {
  readonly element = h('div', { class: 'notices', role: 'status', 'aria-live': 'polite' });
  private readonly shown = new Map<string, HTMLElement>();

  /** Shows a message in place of the one with the same name. */
  show(
    name: string, text: string, kind: 'calm' | 'warn', actions: readonly [string, () => void][] = [],
  ): void {
    this.clear(name);
    const buttons = actions.map(([label, act]) =>
      h('button', { type: 'button', onclick: () => { this.clear(name); act(); } }, label));
    const notice = h('div', { class: `notice ${kind}`, 'data-name': name }, h('span', {}, text), ...buttons);
    this.shown.set(name, notice);
    this.element.append(notice);
    if (kind === 'calm' && actions.length === 0) setTimeout(() => this.remove(notice, name), 6000);
  }

  clear(name: string): void {
    this.shown.get(name)?.remove();
    this.shown.delete(name);
  }

  private remove(notice: HTMLElement, name: string): void {
    if (this.shown.get(name) === notice) this.clear(name);
  }
}
