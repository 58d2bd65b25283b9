// Which text is open: choosing, opening and saving, and what to do when the disk has another one.
import type { OnDisk, TextDocument } from './document';
import type { Editor } from './editor';
import { choice, h } from './elements';
import type { Notices } from './notices';
import type { Listing } from './protocol';
import { Refusal, server } from './server';
import type { Words } from './words';

const FIRST = 'untitled.azee';
const SUFFIX = /\.az(ee)?$/;

/** Returns the name of a text with another suffix, without its folder. */
export const withSuffix = (file: string, suffix: string): string =>
  file.split('/').at(-1)!.replace(SUFFIX, suffix);

export class Files {
  readonly list: HTMLSelectElement;
  readonly state = h('span', { class: 'state', role: 'status' });
  readonly button: HTMLButtonElement;
  private listing: Listing | null = null;

  /** `opened` is called when another text is in the editor, `replaced` when the disk's is. */
  constructor(
    private readonly words: Words, private readonly document: () => TextDocument,
    private readonly editor: () => Editor, private readonly notices: Notices,
    private readonly opened: () => void, private readonly replaced: () => void,
  ) {
    this.list = choice(words.file, [], '', name => void this.pick(name));
    this.button = h('button', { type: 'button', class: 'save', onclick: () => void this.save() }, words.save);
  }

  async begin(listing: Listing, wanted: string | null): Promise<void> {
    this.listing = listing;
    const { files, first, drafts } = listing;
    await this.open(wanted ?? first ?? files[0] ?? drafts[0] ?? FIRST);
  }

  async save(): Promise<void> {
    try {
      const other = await this.document().save();
      if (other) this.conflict(other);
      else this.notices.clear('draft');
    } catch (error) {
      this.notices.show('save', (error as Error).message, 'warn');
    }
  }

  showState(): void {
    const { words } = this;
    const { state } = this.document();
    const text = { saved: words.saved, kept: words.unsaved, keeping: words.keeping }[state];
    if (this.state.textContent !== text) this.state.textContent = text;
    this.state.dataset['state'] = state;
  }

  changedOnDisk(other: OnDisk): void {
    const document = this.document();
    if (other.digest === document.digest) return;
    if (document.state !== 'saved' || other.text === null) {
      this.conflict(other);
      return;
    }
    document.rebase(other, other.text);
    this.editor().replace(other.text, true);
    this.replaced();
    this.notices.show('refreshed', this.words.refreshed, 'calm');
  }

  private names(): void {
    const { files, drafts } = this.listing!;
    const { file } = this.document();
    const names = [...new Set([...files, ...drafts, file])].sort();
    this.list.replaceChildren(...names.map(name => h('option', { value: name }, name)),
      h('option', { value: '' }, this.words.newFile));
    this.list.value = file;
  }

  private async pick(name: string): Promise<void> {
    const { file } = this.document();
    const wanted = name || prompt(this.words.newName) || file;
    const whole = SUFFIX.test(wanted) ? wanted : `${wanted}.azee`;
    if (whole !== file) await this.open(whole);
    this.names();
  }

  private async open(name: string): Promise<void> {
    this.document().flush();
    let found;
    try {
      found = await server.open(name);
    } catch (error) {
      if (!(error instanceof Refusal) || error.status !== 404) {
        this.notices.show('file', (error as Error).message, 'warn');
        return;
      }
      found = { file: name, text: '', digest: null, draft: null };
    }
    const { draft } = found;
    const text = draft?.text ?? found.text;
    this.editor().open(text, `${this.words.text}: ${name}`);
    this.document().opened(found, text);
    for (const notice of ['conflict', 'draft', 'file']) this.notices.clear(notice);
    if (draft && draft.digest !== found.digest) this.conflict({ digest: found.digest, text: found.text });
    else if (draft)
      this.notices.show('draft', this.words.restored, 'calm', [
        [this.words.keep, () => undefined],
        [this.words.discard, () => {
          this.editor().replace(found.text);
          void server.dropDraft(name);
        }],
      ]);
    this.names();
    this.opened();
  }

  private conflict(other: OnDisk): void {
    const { words } = this;
    const text = other.text === null ? words.conflictGone : words.conflict;
    const take: [string, () => void][] = other.text === null ? [] : [[words.takeTheirs, () => {
      this.document().rebase(other, other.text!);
      this.editor().replace(other.text!);
    }]];
    this.notices.show('conflict', text, 'warn', [...take, [words.keepMine, () => {
      this.document().rebase(other, this.editor().text);
      void this.save();
    }]]);
  }
}
