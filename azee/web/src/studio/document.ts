// One text: what is typed, what the file has, what the server keeps.
import type { Answer, Opened } from './protocol';
import { type Live, Refusal, server } from './server';

const KEEP_MS = 100; // after the last key; at most a quarter of a second after the first
const LATEST_MS = 250;

export type State = 'saved' | 'kept' | 'keeping';

/** Another program has changed the file. `text`: what it is now, null where it is gone. */
export interface OnDisk {
  digest: string | null;
  text: string | null;
}

export class TextDocument {
  file = '';
  digest: string | null = null;
  private inFile = '';
  private text = '';
  private number = 0;
  private kept = 0;
  private timer = 0;
  private since = 0;

  constructor(private readonly live: () => Live, private readonly changed: () => void) {}

  get state(): State {
    if (this.text === this.inFile && this.digest !== null) return 'saved';
    return this.kept === this.number && this.live().open ? 'kept' : 'keeping';
  }

  opened(found: Opened, text: string): void {
    this.file = found.file;
    this.digest = found.digest;
    this.inFile = found.text;
    this.text = text;
    this.kept = this.number;
    this.watch();
    this.changed();
  }

  typed(text: string): void {
    this.text = text;
    this.number += 1;
    const now = performance.now();
    if (this.kept === this.number - 1) this.since = now;
    clearTimeout(this.timer);
    const wait = Math.max(0, Math.min(KEEP_MS, this.since + LATEST_MS - now));
    this.timer = window.setTimeout(() => this.send(), wait);
    this.changed();
  }

  /** Sends what is typed now, as before another text is opened. */
  flush(): void {
    clearTimeout(this.timer);
    if (this.file && this.state === 'keeping') this.send();
  }

  /** Sends everything that the server may not have, as after it came back. */
  resend(): void {
    this.watch();
    if (this.state !== 'saved') this.send();
  }

  private send(): void {
    this.since = performance.now();
    this.live().send({
      kind: 'draft', file: this.file, text: this.text, digest: this.digest, number: this.number,
    });
  }

  private watch(): void {
    this.live().send({ kind: 'watch', file: this.file, digest: this.digest });
  }

  keptUpTo(answer: Extract<Answer, { kind: 'kept' }>): void {
    if (answer.file === this.file) this.kept = Math.max(this.kept, answer.number);
    this.changed();
  }

  /** Saves; returns what is on the disk instead where that is another text. */
  async save(digest = this.digest): Promise<OnDisk | null> {
    const text = this.text;
    try {
      const saved = await server.save(this.file, text, digest);
      this.digest = saved.digest;
      this.inFile = text;
      this.watch();
      this.changed();
      return null;
    } catch (error) {
      if (error instanceof Refusal && error.status === 409 && 'digest' in error.data)
        return error.data as unknown as OnDisk;
      throw error;
    }
  }

  /** Takes what is on the disk as what the file has. */
  rebase(found: OnDisk, text: string): void {
    this.digest = found.digest;
    this.inFile = found.text ?? '';
    this.text = text;
    this.changed();
  }
}
