// The page's side of the server: requests, and the live connection that comes back by itself.
import type { Answer, Diagnostic, Listing, Opened, Options, Rule } from './protocol';

const FIRST_WAIT_MS = 200, LONGEST_WAIT_MS = 3000;

/** A word of the text with the blocks of its operands; offsets are those of the editor. */
export interface TextBlock {
  path: number[];
  row: number;
  slot: string | null;
  kind: string;
  text: string;
  mark: string | null;
  from: number;
  to: number;
  above: string[];
  beside: string[];
  children: TextBlock[];
}

export type BlockEdit =
  | { edit: 'move'; path: readonly number[]; row: number; to_path: readonly number[]; to_row: number }
  | { edit: 'delete'; path: readonly number[]; row: number };

/** What the server refused. `data`: its answer. */
export class Refusal extends Error {
  constructor(readonly status: number, readonly data: Record<string, unknown>) {
    super(typeof data['message'] === 'string' ? data['message'] : firstOf(data) ?? `status ${status}`);
  }
}

function firstOf(data: Record<string, unknown>): string | undefined {
  return (data['diagnostics'] as Diagnostic[] | undefined)?.[0]?.message;
}

async function asked(path: string, init?: RequestInit): Promise<Response> {
  const answer = await fetch(path, init);
  if (answer.ok) return answer;
  throw new Refusal(answer.status, await answer.json().catch(() => ({})) as Record<string, unknown>);
}

async function json<T>(path: string, method = 'GET', body?: unknown): Promise<T> {
  const init: RequestInit = { method };
  if (body !== undefined) {
    init.body = JSON.stringify(body);
    init.headers = { 'Content-Type': 'application/json' };
  }
  return (await asked(path, init)).json() as Promise<T>;
}

const named = (path: string, name: string): string => `${path}?name=${encodeURIComponent(name)}`;

export const server = {
  listing: () => json<Listing>('api/files'),
  open: (name: string) => json<Opened>(named('api/file', name)),
  save: (name: string, text: string, digest: string | null) =>
    json<{ digest: string }>(named('api/file', name), 'PUT', { text, digest }),
  dropDraft: (name: string) => json<object>(named('api/draft', name), 'DELETE'),
  versions: (name: string) => json<{
    versions: { number: number; at: number; saved: boolean; characters: number }[];
  }>(named('api/versions', name)),
  version: (name: string, number: number) =>
    json<{ text: string }>(`${named('api/version', name)}&number=${number}`),
  rules: (file: string, text: string) => json<{ rules: Rule[] }>('api/rules', 'POST', { file, text }),
  blocks: (file: string, text: string) =>
    json<{ blocks: TextBlock[] }>('api/blocks', 'POST', { file, text }),
  edit: (file: string, text: string, edit: BlockEdit) =>
    json<{ from: number; to: number; insert: string; gone: string[] }>(
      'api/edit', 'POST', { file, text, edit }),
  picture: async (file: string, text: string, expression: string, options: Options) =>
    (await asked('api/picture', {
      method: 'POST', body: JSON.stringify({ ...options, number: 0, file, text, expression }),
    })).blob(),
  exported: async (file: string, text: string, suffix: string, options: Options) =>
    (await asked('api/export', {
      method: 'POST', body: JSON.stringify({ ...options, number: 0, file, text, suffix }),
    })).blob(),
  body: (name: string) => `body/${encodeURIComponent(name)}.glb`,
  film: (name: string) => named('film', name),
};

/** The live connection. What is sent while there is none is dropped: `opened` sends it again. */
export class Live {
  private socket: WebSocket | null = null;
  private wait = FIRST_WAIT_MS;

  constructor(
    private readonly got: (answer: Answer, data: ArrayBuffer) => void,
    private readonly opened: () => void,
    private readonly closed: () => void,
  ) {
    this.connect();
  }

  get open(): boolean {
    return this.socket?.readyState === WebSocket.OPEN;
  }

  send(message: object): void {
    if (this.open) this.socket!.send(JSON.stringify(message));
  }

  private connect(): void {
    const address = new URL('live', location.href);
    address.protocol = 'ws:';
    address.search = address.hash = '';
    const socket = new WebSocket(address);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.wait = FIRST_WAIT_MS;
      this.opened();
    };
    socket.onmessage = event => {
      if (typeof event.data === 'string') {
        this.got(JSON.parse(event.data) as Answer, new ArrayBuffer(0));
        return;
      }
      const data = event.data as ArrayBuffer;
      const length = new DataView(data).getUint32(0, true);
      const head = new TextDecoder().decode(new Uint8Array(data, 4, length));
      this.got(JSON.parse(head) as Answer, data.slice(4 + length));
    };
    socket.onclose = () => {
      if (this.socket !== socket) return;
      this.closed();
      setTimeout(() => this.connect(), this.wait);
      this.wait = Math.min(2 * this.wait, LONGEST_WAIT_MS);
    };
    this.socket = socket;
  }
}
