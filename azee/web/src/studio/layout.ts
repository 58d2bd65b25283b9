// The parts of the page and where they are: beside each other, or one at a time on a phone.
import { h } from './elements';
import type { Words } from './words';

export type PanelName = 'rules' | 'blocks' | 'pose' | 'reasons' | 'versions' | 'film' | 'settings';
type Part = 'text' | 'signer' | 'score' | 'panel';

export class Layout {
  readonly text = h('section', { class: 'part text', 'data-part': 'text' });
  readonly signer = h('section', { class: 'part signer', 'data-part': 'signer' });
  readonly score = h('section', { class: 'part score-part', 'data-part': 'score' });
  readonly panel = h('aside', { class: 'part panel', 'data-part': 'panel', id: 'panel' });
  readonly main: HTMLElement;
  private readonly tabs = new Map<PanelName, HTMLButtonElement>();
  private open: PanelName | null;

  constructor(
    words: Words, header: HTMLElement, private readonly bodies: Record<PanelName, HTMLElement>,
    private readonly shown: (panel: PanelName | null) => void,
  ) {
    this.text.setAttribute('aria-label', words.text);
    this.signer.setAttribute('aria-label', words.signer);
    this.score.setAttribute('aria-label', words.score);
    this.panel.setAttribute('aria-label', words.panels);
    const names: PanelName[] = ['rules', 'blocks', 'pose', 'reasons', 'versions', 'film', 'settings'];
    const tablist = h('div', { class: 'tabs', role: 'group', 'aria-label': words.panels },
      ...names.map(name => {
        const tab = h('button', {
          type: 'button', id: `tab-${name}`, 'aria-controls': 'panel', 'aria-expanded': 'false',
          onclick: () => this.show(this.open === name ? null : name),
        }, words[name]);
        this.tabs.set(name, tab);
        return tab;
      }));
    header.append(tablist);
    this.main = h('main', { class: 'parts' }, this.text, this.signer, this.panel, this.score);
    this.open = matchMedia('(min-width: 1200px)').matches ? 'rules' : null;
    addEventListener('keydown', event => {
      if (event.key === 'F6') {
        event.preventDefault();
        this.next(event.shiftKey ? -1 : 1);
      } else if (event.key === 'Escape' && this.panel.contains(document.activeElement)
        && !matchMedia('(min-width: 1200px)').matches) {
        const tab = this.open && this.tabs.get(this.open);
        this.show(null);
        tab?.focus();
      }
    });
  }

  begin(): void {
    this.show(this.open);
  }

  show(panel: PanelName | null): void {
    this.open = panel;
    for (const [name, tab] of this.tabs) tab.setAttribute('aria-expanded', String(name === panel));
    this.panel.hidden = panel === null;
    this.main.dataset['panel'] = panel ?? '';
    this.main.classList.toggle('with-panel', panel !== null);
    if (panel) this.panel.replaceChildren(h('h2', {}, this.tabs.get(panel)!.textContent), this.bodies[panel]);
    this.shown(panel);
  }

  get current(): PanelName | null {
    return this.open;
  }

  /** Goes to the next part of the page that can be used by keys. */
  private next(direction: 1 | -1): void {
    const parts: Part[] = ['text', 'signer', 'panel', 'score'];
    const boxes = parts.map(part => this.main.querySelector<HTMLElement>(`[data-part=${part}]`)!)
      .filter(part => !part.hidden && part.offsetParent !== null);
    const now = boxes.findIndex(part => part.contains(document.activeElement));
    const goal = boxes[(now + direction + boxes.length) % boxes.length]!;
    goal.querySelector<HTMLElement>('.cm-content, button:not([disabled]), input, select, [tabindex="0"]')?.focus();
  }
}
