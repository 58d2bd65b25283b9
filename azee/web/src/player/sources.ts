// Where the page takes movements from: a server that makes them, or a folder that has them.
import type { AzeePlayer } from './element';
import { WebClip } from './clip';
import { type Sign, sequence } from './sequence';
import type { Words } from './words';

export interface Source {
  readonly id: string;
  readonly kind: 'azee' | 'letters' | 'words';
  readonly title: string;
  /** Whose case letters have, such as `tr`. */
  readonly locale?: string;
  /** Addresses of clips by name, in a folder. */
  readonly signs?: Readonly<Record<string, string>>;
}

export interface Catalogue {
  readonly live: boolean;
  readonly bodies: readonly string[];
  readonly body: string;
  readonly sources: readonly Source[];
  readonly source: string;
  readonly text: string;
}

/** A text that cannot be played; each message is for whoever typed it. */
export class Refused extends Error {
  constructor(readonly messages: readonly string[]) {
    super(messages.join('\n'));
  }
}

interface Diagnostic {
  severity: string;
  message: string;
  help?: string | null;
  line?: number | null;
  column?: number | null;
}

/** Plays a text; returns what is to be told of it. Throws Refused. */
export type Play = (text: string, source: Source, avatar: string) => Promise<readonly string[]>;

/** Asks the server of the page for a clip. */
export function fromServer(player: AzeePlayer, words: Words): Play {
  return async (text, source, avatar) => {
    const answer = await fetch('perform', {
      method: 'POST',
      headers: { 'content-type': 'application/json' },
      body: JSON.stringify({ text, source: source.id, body: avatar }),
    }).catch(() => { throw new Refused([words.unreachable]); });
    if (answer.ok) {
      const data = await answer.arrayBuffer();
      await player.perform(data);
      return (new WebClip(data).header.extras['told'] as string[] | undefined) ?? [];
    }
    if (answer.status !== 422) throw new Refused([await answer.text()]);
    const { diagnostics } = (await answer.json()) as { diagnostics: Diagnostic[] };
    throw new Refused(diagnostics.map(d => {
      const place = d.line ? `${d.line}:${d.column ?? 1}: ` : '';
      return `${place}${d.message}${d.help ? ` (${d.help})` : ''}`;
    }));
  };
}

/** Joins the clips of a folder; each is fetched when it is first needed, and kept. */
export function fromFolder(player: AzeePlayer, words: Words): Play {
  const kept = new Map<string, Promise<WebClip>>();
  const clip = (address: string): Promise<WebClip> => {
    let found = kept.get(address);
    if (!found) {
      found = fetch(address).then(async answer => {
        if (!answer.ok) throw new Refused([`${address}: ${answer.status}`]);
        return new WebClip(await answer.arrayBuffer());
      });
      kept.set(address, found);
      found.catch(() => kept.delete(address));
    }
    return found;
  };
  return async (text, source) => {
    const { wanted, unknown } = asked(text, source);
    const told = unknown.length > 0 ? [`${words.unknown} ${unknown.join(' ')}`] : [];
    if (wanted.length === 0) throw new Refused([...told, words.nothing]);
    const signs: Sign[] = await Promise.all(wanted.map(async ({ name, address, pause }) =>
      ({ name, pause, clip: await clip(address) })));
    await player.performOn(body => sequence(signs, body));
    return told;
  };
}

interface Asked {
  wanted: { name: string; address: string; pause: boolean }[];
  unknown: string[];
}

/** Returns the signs of a text: one a word, or one a character with pauses for spaces. */
export function asked(text: string, source: Source): Asked {
  const signs = source.signs ?? {};
  const letters = source.kind === 'letters';
  const found: Asked = { wanted: [], unknown: [] };
  const composed = text.normalize('NFC');
  for (const part of letters ? composed.trim() : composed.split(/\s+/).filter(Boolean)) {
    const last = found.wanted[found.wanted.length - 1];
    if (letters && /\s/.test(part)) {
      if (last) last.pause = true;
      continue;
    }
    const names = [part, part.toLocaleUpperCase(source.locale), part.toLocaleLowerCase(source.locale)];
    const name = names.find(one => Object.hasOwn(signs, one));
    if (name) found.wanted.push({ name, address: signs[name]!, pause: false });
    else if (!found.unknown.includes(part)) found.unknown.push(part);
  }
  return found;
}
