// The text as nested blocks: seen, moved, removed and replaced; every edit is one of the text.
import { h } from './elements';
import { server, type BlockEdit, type TextBlock } from './server';
import type { Words } from './words';

type Path = readonly number[];
const key = (path: Path): string => path.join('.');
const parentOf = (path: Path): Path => path.slice(0, -1);

export class Blocks {
  readonly element = h('div', { class: 'panel-body' });
  private readonly tree = h('div', { role: 'tree', class: 'blocks' });
  private readonly message = h('p', { class: 'quiet', role: 'status' });
  private shown: TextBlock[] = [];
  private chosen: string | null = null;
  private dragged: TextBlock | null = null;

  constructor(
    private readonly words: Words, private readonly text: () => { file: string; text: string },
    private readonly change: (from: number, to: number, insert: string) => void,
    private readonly goTo: (from: number) => void,
  ) {
    this.tree.setAttribute('aria-label', words.blocks);
    this.tree.addEventListener('keydown', event => this.key(event));
    this.element.append(h('p', { class: 'quiet' }, words.blockHelp), this.message, this.tree);
  }

  async show(): Promise<void> {
    const { file, text } = this.text();
    const { blocks } = await server.blocks(file, text);
    if (text !== this.text().text) return;
    this.shown = blocks;
    const hadFocus = this.tree.contains(document.activeElement);
    this.tree.replaceChildren(...this.level(blocks, 1));
    const items = this.items();
    const now = items.find(item => item.dataset['path'] === this.chosen) ?? items[0];
    if (now) this.choose(now, hadFocus);
  }

  private items(): HTMLElement[] {
    return [...this.tree.querySelectorAll<HTMLElement>('[role=treeitem]')];
  }

  /** Makes items of one level and, after each, those inside it. */
  private level(blocks: readonly TextBlock[], level: number): HTMLElement[] {
    return blocks.flatMap((block, i) =>
      [this.item(block, level, i + 1, blocks.length), ...this.level(block.children, level + 1)]);
  }

  private item(block: TextBlock, level: number, position: number, size: number): HTMLElement {
    const row = h('div', { class: 'block-row', draggable: block.kind !== 'mistake' },
      block.slot ? h('span', { class: 'slot' }, `${block.slot} `) : null,
      block.mark ? h('span', { class: 'mark', 'aria-hidden': 'true' }, block.mark) : null,
      h('code', {}, block.text),
      ...[...block.above, ...block.beside].map(text => h('small', {}, text)));
    const item = h('div', {
      role: 'treeitem', tabindex: -1, 'aria-level': level, 'aria-posinset': position,
      'aria-setsize': size, 'data-path': key(block.path), class: `block-item ${block.kind}`,
      style: `margin-left: ${1.1 * (level - 1)}rem`,
    }, row);
    row.addEventListener('click', () => { this.choose(item, true); this.goTo(block.from); });
    row.addEventListener('dragstart', event => {
      this.dragged = block;
      event.dataTransfer?.setData('text/plain', block.text);
    });
    row.addEventListener('dragover', event => { if (this.fits(block)) event.preventDefault(); });
    row.addEventListener('drop', event => {
      event.preventDefault();
      const { dragged } = this;
      if (!dragged || !this.fits(block)) return;
      void this.edit({
        edit: 'move', path: parentOf(dragged.path), row: dragged.row,
        to_path: parentOf(block.path), to_row: block.row,
      });
    });
    return item;
  }

  private fits(target: TextBlock): boolean {
    const from = this.dragged?.path;
    return from !== undefined && !key(target.path).startsWith(key(from));
  }

  private choose(item: HTMLElement, focus: boolean): void {
    for (const other of this.items()) {
      other.tabIndex = -1;
      other.setAttribute('aria-selected', 'false');
    }
    item.tabIndex = 0;
    item.setAttribute('aria-selected', 'true');
    this.chosen = item.dataset['path'] ?? null;
    if (focus) item.focus();
  }

  private find(path: string): TextBlock | undefined {
    const all = (blocks: TextBlock[]): TextBlock[] => blocks.flatMap(b => [b, ...all(b.children)]);
    return all(this.shown).find(block => key(block.path) === path);
  }

  private key(event: KeyboardEvent): void {
    const items = this.items();
    const at = items.findIndex(item => item.dataset['path'] === this.chosen);
    const block = this.chosen === null ? undefined : this.find(this.chosen);
    if (!block || event.ctrlKey || event.metaKey) return;
    const path = parentOf(block.path);
    const move = (to_row: number): void =>
      void this.edit({ edit: 'move', path, row: block.row, to_path: path, to_row });
    const act: Record<string, () => void> = event.altKey
      ? {
        ArrowUp: () => { if (block.row > 0) move(block.row - 1); },
        ArrowDown: () => move(block.row + 2),
      }
      : {
        ArrowDown: () => this.go(items[at + 1]),
        ArrowUp: () => this.go(items[at - 1]),
        ArrowRight: () => { if (block.children.length > 0) this.go(items[at + 1]); },
        ArrowLeft: () => this.go(items.find(item => item.dataset['path'] === key(path))),
        Home: () => this.go(items[0]),
        End: () => this.go(items.at(-1)),
        Delete: () => void this.edit({ edit: 'delete', path, row: block.row }),
        Enter: () => this.goTo(block.from),
      };
    const done = act[event.key];
    if (!done) return;
    event.preventDefault();
    done();
  }

  private go(item: HTMLElement | null | undefined): void {
    if (item) this.choose(item, true);
  }

  private async edit(edit: BlockEdit): Promise<void> {
    const { file, text } = this.text();
    try {
      const found = await server.edit(file, text, edit);
      if (text !== this.text().text) return;
      this.change(found.from, found.to, found.insert);
      this.message.textContent = found.gone.length > 0 ? `${this.words.commentsGone} ${found.gone.join(' ')}` : '';
      await this.show();
    } catch (error) {
      this.message.textContent = (error as Error).message;
    }
  }
}
