// What stands beside the signer: rules, reasons, versions, film, settings.
import { choice, h } from './elements';
import type { Block, Constraint, Marked, Options, Rule } from './protocol';
import { server } from './server';
import type { Words } from './words';

const MOST_SHOWN = 60;
const plain = (text: string): string => text.normalize('NFD').replace(/\p{M}/gu, '').toLowerCase();

/** The expression that applies a rule, with a hole for every mandatory argument. */
export function application(rule: Rule): { text: string; select: [number, number] } {
  const needed = rule.arguments.filter(argument => argument.default === null);
  const first = needed[0];
  const text = [`:${rule.name}`, ...needed.map(({ name }) => `\n    '${name}\n    …`)].join('');
  if (!first) return { text, select: [text.length, text.length] };
  const at = text.indexOf('…');
  return { text, select: [at, at + 1] };
}

/** The rules that the text may use: searched by name, meaning and source. */
export class Palette {
  readonly element: HTMLElement;
  private rules: Rule[] = [];
  private readonly search: HTMLInputElement;
  private readonly library: HTMLSelectElement;
  private readonly list = h('ul', { class: 'rules' });
  private readonly count = h('p', { class: 'quiet', role: 'status' });
  private readonly pictures = new Map<string, Promise<string>>();
  private readonly seen: IntersectionObserver;

  constructor(
    private readonly words: Words,
    private readonly insert: (text: string, select: [number, number]) => void,
    private readonly picture: (expression: string) => Promise<Blob>,
  ) {
    this.search = h('input', { type: 'search', 'aria-label': words.search, placeholder: words.search });
    this.search.addEventListener('input', () => this.draw());
    this.library = choice(words.allRules, [], '', () => this.draw());
    this.element = h('div', { class: 'panel-body' },
      h('div', { class: 'row' }, this.search, this.library), this.count, this.list);
    this.seen = new IntersectionObserver(entries => {
      for (const { isIntersecting, target } of entries)
        if (isIntersecting) void this.load(target as HTMLElement);
    });
  }

  show(rules: Rule[]): void {
    this.rules = rules;
    const names = [...new Set(rules.map(rule => rule.library ?? ''))].sort();
    const before = this.library.value;
    this.library.replaceChildren(
      h('option', { value: '*' }, this.words.allRules),
      ...names.map(name => h('option', { value: name }, name || this.words.ownRules)),
    );
    this.library.value = names.includes(before) ? before : '*';
    this.draw();
  }

  focus(): void {
    this.search.focus();
  }

  private draw(): void {
    const wanted = plain(this.search.value).split(/\s+/).filter(Boolean);
    const library = this.library.value;
    const ranked = this.rules
      .filter(rule => library === '*' || (rule.library ?? '') === library)
      .map(rule => ({ rule, rank: rank(rule, wanted) }))
      .filter(({ rank: found }) => found < Infinity)
      .sort((a, b) => a.rank - b.rank);
    this.count.textContent = `${ranked.length} ${this.words.found}`;
    this.seen.disconnect();
    this.list.replaceChildren(...ranked.slice(0, MOST_SHOWN).map(({ rule }) => this.row(rule)));
  }

  private row(rule: Rule): HTMLLIElement {
    const { text, select } = application(rule);
    const needs = rule.arguments.some(argument => argument.default === null);
    const shows = rule.gives === 'a score' && !needs;
    const frame = h('span', { class: 'thumb', 'aria-hidden': 'true' });
    if (shows) {
      frame.dataset['expression'] = text;
      this.seen.observe(frame);
    }
    return h('li', {},
      h('button', { type: 'button', class: 'rule', onclick: () => this.insert(text, select) },
        frame,
        h('span', { class: 'rule-text' },
          h('code', {}, rule.signature),
          rule.meaning ? h('span', {}, rule.meaning) : null,
          h('small', {}, [rule.library ?? this.words.ownRules, rule.status].filter(Boolean).join(' · ')))));
  }

  private async load(frame: HTMLElement): Promise<void> {
    this.seen.unobserve(frame);
    const expression = frame.dataset['expression']!;
    let address = this.pictures.get(expression);
    if (!address) {
      address = this.picture(expression).then(blob => URL.createObjectURL(blob));
      this.pictures.set(expression, address);
    }
    try {
      frame.replaceChildren(h('img', { src: await address, alt: '' }));
    } catch {
      this.pictures.delete(expression);
    }
  }
}

/** How far a rule is from what is searched: 0 the same name, then names, then meanings. */
function rank(rule: Rule, wanted: readonly string[]): number {
  if (wanted.length === 0) return 5;
  const name = plain(rule.name), meaning = plain(rule.meaning);
  const rest = plain(`${rule.source} ${rule.signature} ${rule.library ?? ''}`);
  if (!wanted.every(word => name.includes(word) || meaning.includes(word) || rest.includes(word)))
    return Infinity;
  const whole = wanted.join(' ');
  if (name === whole) return 0;
  if (name.startsWith(whole)) return 1;
  if (meaning.split(/[^\p{L}\p{N}]+/u).includes(whole)) return 2;
  if (name.includes(whole)) return 3;
  return wanted.every(word => meaning.includes(word)) ? 4 : 5;
}

/** What became of each constraint of a block. */
export class Reasons {
  readonly element = h('div', { class: 'panel-body' });
  readonly drawn: HTMLInputElement;
  private constraints: Constraint[] = [];
  private marked: Marked[] = [];
  private block: Block | null = null;

  constructor(private readonly words: Words, changed: () => void) {
    this.drawn = h('input', { type: 'checkbox', onchange: changed });
    this.draw();
  }

  report(constraints: Constraint[], marked: Marked[]): void {
    this.constraints = constraints;
    this.marked = marked;
    this.draw();
  }

  choose(block: Block | null): void {
    this.block = block;
    this.draw();
  }

  /** Returns the marks of what runs at a time of the clip, of the chosen block if there is one. */
  marks(time: number, lead: number): Marked['marks'] {
    if (!this.drawn.checked) return [];
    return this.marked.filter(row => (this.block ? inside(row.path, this.block.path) : true))
      .filter(row => this.runs(row.path, time - lead))
      .flatMap(row => {
        const nearest = Math.min(...row.marks.map(mark => Math.abs(mark.time_s - time)));
        return row.marks.filter(mark => Math.abs(mark.time_s - time) <= nearest + 1e-9);
      });
  }

  private runs(path: string[], time: number): boolean {
    return this.constraints.some(c => same(c.path, path) && c.start_s <= time && time <= c.end_s);
  }

  private draw(): void {
    const { words, block } = this;
    const order = { missed: 0, eased: 1, met: 2 };
    const shown = this.constraints.filter(c => !block || inside(c.path, block.path))
      .sort((a, b) => order[a.outcome] - order[b.outcome] || a.start_s - b.start_s);
    const all = shown.length > 0 && shown.every(c => c.outcome === 'met');
    this.element.replaceChildren(
      h('p', {}, `${words.chooseBlock} `, h('strong', {}, block ? block.title : words.wholeText)),
      h('label', { class: 'check' }, this.drawn, words.showMarks),
      all ? h('p', { class: 'good' }, words.allMet) : '',
      h('ul', { class: 'reasons' }, ...shown.slice(0, 200).map(c => this.row(c))),
    );
  }

  private row(c: Constraint): HTMLLIElement {
    const { words } = this;
    const off = c.residual === null ? '' : `${words.off} ${amount(c.residual, c.unit)}`;
    const facts = [off, `${words.allowed} ${amount(c.tolerance, c.unit)}`,
      `${c.start_s.toFixed(2)}–${c.end_s.toFixed(2)} s`].filter(Boolean).join(' · ');
    return h('li', { class: c.outcome },
      h('span', { class: 'outcome' }, words[c.outcome]),
      h('code', {}, `${c.subject} ${c.target}`),
      h('small', {}, `${c.path.join(' / ')} · ${facts}`),
      c.reason ? h('span', {}, c.reason) : null);
  }
}

const same = (a: readonly string[], b: readonly string[]): boolean => a.join('/') === b.join('/');
const inside = (path: readonly string[], outer: readonly string[]): boolean =>
  outer.every((name, i) => path[i] === name);
const amount = (value: number, unit: 'm' | 'rad'): string =>
  unit === 'm' ? `${(1000 * value).toFixed(1)} mm` : `${((180 / Math.PI) * value).toFixed(1)}°`;

/** Earlier texts of the file. */
export class Versions {
  readonly element = h('div', { class: 'panel-body' });

  constructor(
    private readonly words: Words, private readonly language: string,
    private readonly take: (text: string) => void,
  ) {}

  async show(file: string): Promise<void> {
    const { versions } = await server.versions(file);
    const { words } = this;
    const when = new Intl.DateTimeFormat(this.language, { dateStyle: 'medium', timeStyle: 'medium' });
    if (versions.length === 0) {
      this.element.replaceChildren(h('p', { class: 'quiet' }, words.noVersions));
      return;
    }
    const preview = h('pre', { class: 'preview', tabindex: 0, hidden: true });
    this.element.replaceChildren(preview, h('ul', { class: 'versions' }, ...versions.map(version =>
      h('li', {},
        h('span', {}, when.format(1000 * version.at)),
        h('small', {}, `${version.saved ? words.savedVersion : words.typedVersion} · `
          + `${version.characters} ${words.characters}`),
        h('button', { type: 'button', onclick: () => void this.text(file, version.number).then(text => {
          preview.textContent = text;
          preview.hidden = false;
        }) }, words.show),
        h('button', { type: 'button', onclick: () =>
          void this.text(file, version.number).then(this.take) }, words.restore)))));
  }

  private async text(file: string, number: number): Promise<string> {
    return (await server.version(file, number)).text;
  }
}

/** A film of the folder beside the signer, on the same time line. */
export class Film {
  readonly element = h('div', { class: 'panel-body' });
  private readonly video = h('video', { muted: true, playsinline: true, preload: 'auto' });
  private offset = 0;

  constructor(private readonly words: Words) {}

  show(films: readonly string[]): void {
    const { words } = this;
    if (films.length === 0) {
      this.element.replaceChildren(h('p', { class: 'quiet' }, words.noFilms));
      return;
    }
    const offset = h('input', {
      type: 'number', step: 0.04, value: 0, 'aria-label': words.offset,
      oninput: event => { this.offset = Number((event.target as HTMLInputElement).value) || 0; },
    });
    const pick = choice(words.chooseFilm, [['', '–'], ...films.map(name => [name, name] as const)], '',
      name => { this.video.hidden = !name; if (name) this.video.src = server.film(name); });
    this.video.hidden = true;
    this.video.setAttribute('aria-label', words.film);
    this.element.replaceChildren(h('label', { class: 'field' }, words.chooseFilm, pick),
      h('label', { class: 'field' }, words.offset, offset), this.video);
  }

  /** Brings the film to the signer's time. */
  follow(time: number, playing: boolean, speed: number): void {
    const { video } = this;
    if (video.hidden || !video.src) return;
    const wanted = Math.max(0, time - this.offset);
    if (Math.abs(video.currentTime - wanted) > (playing ? 0.15 : 0.01)) video.currentTime = wanted;
    video.playbackRate = Math.min(4, Math.max(0.1, speed));
    if (playing && video.paused) void video.play().catch(() => undefined);
    if (!playing && !video.paused) video.pause();
  }
}

/** Body and ways to sign. */
export function settingsPanel(
  words: Words, bodies: readonly string[], options: Options, changed: (options: Options) => void,
): HTMLElement {
  const field = (label: string, control: HTMLElement): HTMLElement =>
    h('label', { class: 'field' }, label, control);
  const set = (part: Partial<Options>): void => { options = { ...options, ...part }; changed(options); };
  const check = (label: string, name: 'life' | 'precise'): HTMLElement => {
    const box = h('input', { type: 'checkbox', onchange: () => set({ [name]: box.checked }) });
    box.checked = options[name];
    return h('label', { class: 'check' }, box, label);
  };
  const tempo = h('input', {
    type: 'number', min: 0.2, max: 3, step: 0.1, value: options.tempo,
    onchange: () => set({ tempo: Math.min(3, Math.max(0.2, Number(tempo.value) || 1)) }),
  });
  return h('div', { class: 'panel-body' },
    field(words.body, choice(words.body, bodies.map(name => [name, name] as const), options.rig,
      rig => set({ rig }))),
    field(words.hand, choice(words.hand, [['right', words.right], ['left', words.left]],
      options.dominant, value => set({ dominant: value as Options['dominant'] }))),
    field(words.rest, choice(words.rest,
      [['hanging', words.hanging], ['folded', words.folded], ['ready', words.ready]],
      options.rest, value => set({ rest: value as Options['rest'] }))),
    field(words.tempo, tempo),
    check(words.life, 'life'), check(words.precise, 'precise'),
    h('h3', {}, words.help),
    h('dl', { class: 'keys' }, ...words.keys.flatMap(([key, text]) =>
      [h('dt', {}, h('kbd', {}, key!)), h('dd', {}, text!)])),
  );
}
