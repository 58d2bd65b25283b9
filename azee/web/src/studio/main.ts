// The studio: text, signer, score and panels, linked.
import { Blocks } from './blocks';
import { TextDocument, type OnDisk } from './document';
import { Editor } from './editor';
import { choice, h } from './elements';
import { Layout, type PanelName } from './layout';
import { Notices } from './notices';
import { Film, Palette, Reasons, settingsPanel, Versions } from './panels';
import type { Answer, Block, Diagnostic, Listing, Options } from './protocol';
import { Score } from './score';
import { Live, Refusal, server } from './server';
import { CAMERAS, Signer } from './signer';
import { chosenLanguage, type Language, LANGUAGES, wordsOf } from './words';

const COMPILE_MS = 40; // after the last key
const RULES_MS = 700;
const SPEEDS = [0.1, 0.25, 0.5, 0.75, 1, 1.5, 2];
const FIRST = 'untitled.azee';
const TEXT_SUFFIX = /\.az(ee)?$/;
const parameters = new URLSearchParams(location.search);

const language = chosenLanguage();
const words = wordsOf(language);
document.documentElement.lang = language;
document.title = words.title;

class Studio {
  /** Milliseconds from keys to the picture with the movement that they made; for measuring. */
  readonly latencies: number[] = [];
  /** Milliseconds that the steps of the server took, for each of them. */
  readonly workerTimes: Record<string, number>[] = [];
  readonly notices = new Notices();
  readonly editor: Editor;
  readonly score: Score;
  readonly document: TextDocument;
  signer: Signer | null = null;
  /** The number of the newest text that was sent, and of the newest that is shown. */
  sent = 0;
  shownNumber = 0;
  private listing: Listing | null = null;
  private live: Live;
  private options: Options;
  private blocks: readonly Block[] = [];
  private lead = 0;
  private chosen: Block | null = null;
  private lastTyped = 0;
  private begun = 0;
  private timer = 0;
  private rulesTimer = 0;
  private lsp = new Set<(message: string) => void>();
  private readonly layout: Layout;
  private readonly palette: Palette;
  private readonly reasons: Reasons;
  private readonly versions: Versions;
  private readonly film = new Film(words);
  private readonly blockList: Blocks;
  private readonly settings = h('div');
  private readonly files = choice(words.file, [], '', name => void this.pickFile(name));
  private readonly state = h('span', { class: 'state', role: 'status' });
  private readonly status = h('p', { class: 'status', role: 'status' });
  private readonly problems = h('ul', { class: 'problems', 'aria-label': words.problems });
  private readonly button = h('button', { type: 'button', class: 'play' });
  private readonly slider = h('input', { type: 'range', min: 0, max: 1, step: 0.01, 'aria-label': words.time });
  private readonly clock = h('output', {});
  private readonly repeat = h('input', { type: 'checkbox', 'aria-label': words.loopBlock });
  private readonly formats = choice(words.export, [], '', suffix => void this.export(suffix));

  constructor() {
    this.options = {
      rig: parameters.get('avatar') ?? 'signer', dominant: 'right', rest: 'hanging', tempo: 1,
      life: true, precise: false,
    };
    this.palette = new Palette(words, (text, select) => this.editor.insert(text, select),
      expression => server.picture(this.document.file, this.editor.text, expression, this.options));
    this.reasons = new Reasons(words, () => this.mark());
    this.versions = new Versions(words, language, text => this.editor.replace(text));
    this.blockList = new Blocks(words, () => ({ file: this.document.file, text: this.editor.text }),
      (from, to, insert) => this.editor.change(from, to, insert),
      from => this.editor.view.dispatch({ selection: { anchor: from }, scrollIntoView: true }));
    const header = this.header();
    this.layout = new Layout(words, header, {
      rules: this.palette.element, blocks: this.blockList.element, reasons: this.reasons.element, versions: this.versions.element,
      film: this.film.element, settings: this.settings,
    }, panel => this.panelShown(panel));
    this.score = new Score(words.score, (block, play) => this.pick(block, play), time => this.signer?.seek(time));
    document.body.append(header, this.layout.main);
    const box = h('div', { class: 'editor' });
    this.layout.text.append(this.notices.element, box, this.problems);
    this.editor = new Editor(box, words.text, text => this.typed(text), offset => this.moved(offset), {
      'Mod-s': () => void this.save(), 'Mod-Enter': () => this.signer?.play(!this.signer.playing),
    });
    this.layout.score.append(this.score.element);
    this.makeSigner();
    this.document = new TextDocument(() => this.live, () => this.showState());
    this.live = new Live((answer, data) => this.got(answer, data), () => this.connected(),
      () => this.notices.show('offline', words.offline, 'warn'));
    addEventListener('keydown', event => {
      if ((event.ctrlKey || event.metaKey) && event.key === 's') {
        event.preventDefault();
        void this.save();
      }
    });
  }

  async begin(): Promise<void> {
    this.listing = await server.listing();
    const { files, first, drafts, bodies } = this.listing;
    if (!bodies.includes(this.options.rig)) this.options.rig = bodies[0]!;
    this.settings.replaceChildren(settingsPanel(words, bodies, this.options, options => this.set(options)));
    this.film.show(this.listing.films);
    this.formats.replaceChildren(h('option', { value: '' }, `${words.export} …`),
      ...this.listing.formats.map(suffix => h('option', { value: suffix }, suffix)));
    this.layout.begin();
    void this.dress();
    await this.open(parameters.get('file') ?? first ?? files[0] ?? drafts[0] ?? FIRST);
  }

  // --- Files -----------------------------------------------------------------------------------

  private listFiles(): void {
    const { files, drafts } = this.listing!;
    const names = [...new Set([...files, ...drafts, this.document.file])].sort();
    this.files.replaceChildren(...names.map(name => h('option', { value: name }, name)),
      h('option', { value: '' }, words.newFile));
    this.files.value = this.document.file;
  }

  private async pickFile(name: string): Promise<void> {
    const wanted = name || prompt(words.newName) || this.document.file;
    const file = TEXT_SUFFIX.test(wanted) ? wanted : `${wanted}.azee`;
    if (file !== this.document.file) await this.open(file);
    this.listFiles();
  }

  private async open(name: string): Promise<void> {
    let found;
    try {
      found = await server.open(name);
    } catch (error) {
      if (!(error instanceof Refusal) || error.status !== 404) {
        this.notices.show('file', String((error as Error).message), 'warn');
        return;
      }
      found = { file: name, text: '', digest: null, draft: null };
    }
    const { draft } = found;
    const text = draft?.text ?? found.text;
    this.editor.open(text, `${words.text}: ${name}`);
    this.document.opened(found, text);
    this.notices.clear('conflict');
    if (draft && draft.digest !== found.digest) this.conflict({ digest: found.digest, text: found.text });
    else if (draft)
      this.notices.show('draft', words.restored, 'calm', [
        [words.keep, () => undefined],
        [words.discard, () => {
          this.editor.replace(found.text);
          void server.dropDraft(name);
        }],
      ]);
    this.listFiles();
    this.chosen = null;
    this.speak();
    this.compile();
    void this.loadRules();
  }

  async save(): Promise<void> {
    try {
      const other = await this.document.save();
      if (other) this.conflict(other);
      else this.notices.clear('draft');
    } catch (error) {
      this.notices.show('save', (error as Error).message, 'warn');
    }
  }

  private conflict(other: OnDisk): void {
    const text = other.text === null ? words.conflictGone : words.conflict;
    const take: [string, () => void][] = other.text === null ? [] : [[words.takeTheirs, () => {
      this.document.rebase(other, other.text!);
      this.editor.replace(other.text!);
    }]];
    this.notices.show('conflict', text, 'warn', [...take, [words.keepMine, () => {
      this.document.rebase(other, this.editor.text);
      void this.save();
    }]]);
  }

  private showState(): void {
    const text = { saved: words.saved, kept: words.unsaved, keeping: words.keeping }[this.document.state];
    if (this.state.textContent !== text) this.state.textContent = text;
    this.state.dataset['state'] = this.document.state;
  }

  // --- The live connection ---------------------------------------------------------------------

  private connected(): void {
    if (this.document.file) {
      this.notices.clear('offline');
      this.document.resend();
      this.speak();
      this.compile();
    }
  }

  /** Connects the editor with the language server. */
  private speak(): void {
    if (!this.listing || !this.live.open) return;
    this.lsp = new Set();
    const handlers = this.lsp;
    this.editor.connect({
      send: message => this.live.send({ kind: 'lsp', message: JSON.parse(message) as object }),
      subscribe: handler => handlers.add(handler),
      unsubscribe: handler => handlers.delete(handler),
    }, this.listing.root, `${this.listing.root}/${this.document.file.split('/').map(encodeURIComponent).join('/')}`);
  }

  private got(answer: Answer, data: ArrayBuffer): void {
    switch (answer.kind) {
      case 'lsp': {
        const text = JSON.stringify(answer.message);
        for (const handler of this.lsp) handler(text);
        break;
      }
      case 'kept':
        this.document.keptUpTo(answer);
        break;
      case 'disk':
        if (answer.file === this.document.file) this.changedOnDisk(answer);
        break;
      case 'score':
        if (answer.number !== this.sent) break;
        this.showProblems(answer.diagnostics);
        if (answer.blocks.length > 0) this.status.textContent = words.solving;
        if (answer.blocks.length === 0) this.status.textContent = this.editor.text.trim() ? '' : words.nothing;
        break;
      case 'clip':
        if (answer.number === this.sent) this.showClip(answer, data);
        break;
      case 'report':
        if (answer.number !== this.sent) break;
        this.score.report(answer.constraints);
        this.reasons.report(answer.constraints, answer.marks);
        this.mark();
        break;
      case 'stopped':
        this.status.textContent = `${words.stopped} ${answer.reason}`;
        break;
      case 'refused':
        this.status.textContent = answer.message ?? '';
        if (answer.diagnostics) this.showProblems(answer.diagnostics);
        break;
      default:
    }
  }

  private changedOnDisk(other: OnDisk): void {
    if (other.digest === this.document.digest) return;
    if (this.document.state === 'saved' && other.text !== null) {
      this.document.rebase(other, other.text);
      this.editor.replace(other.text, true);
      this.compile();
      this.notices.show('refreshed', words.refreshed, 'calm');
    } else this.conflict(other);
  }

  private typed(text: string): void {
    this.document.typed(text);
    this.lastTyped = performance.now();
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.compile(this.lastTyped), COMPILE_MS);
    clearTimeout(this.rulesTimer);
    this.rulesTimer = window.setTimeout(() => void this.loadRules(), RULES_MS);
  }

  private compile(since = performance.now()): void {
    if (!this.live.open || !this.document.file) return;
    this.sent += 1;
    this.begun = since;
    this.live.send({
      ...this.options, kind: 'compile', number: this.sent, file: this.document.file, text: this.editor.text,
    });
  }

  private async loadRules(): Promise<void> {
    this.panelShown(this.layout.current === 'blocks' ? 'blocks' : null);
    try {
      this.palette.show((await server.rules(this.document.file, this.editor.text)).rules);
    } catch {
      // the server is away; it is asked again after the next key
    }
  }

  // --- Score, signer, text ---------------------------------------------------------------------

  private showClip(answer: Extract<Answer, { kind: 'clip' }>, data: ArrayBuffer): void {
    this.blocks = answer.blocks;
    this.lead = answer.lead_s;
    const { begun } = this;
    this.signer?.show(data, () => {
      this.latencies.push(performance.now() - begun);
      this.workerTimes.push(answer.ms);
      this.shownNumber = answer.number;
    });
    this.score.show(answer.blocks, answer.lead_s, this.signer?.duration ?? 1);
    this.chosen = this.blocks[this.score.chosen] ?? null;
    this.slider.max = String(this.signer?.duration ?? 1);
    this.status.textContent = '';
    if (answer.diagnostics.length > 0) this.showProblems(answer.diagnostics);
    if (!matchMedia('(prefers-reduced-motion: reduce)').matches && this.signer?.time === 0)
      this.signer.play(true);
    this.tick();
  }

  private showProblems(found: readonly Diagnostic[]): void {
    this.problems.replaceChildren(...found.slice(0, 50).map(d => h('li', { class: d.severity },
      h('button', { type: 'button', disabled: d.line === null, onclick: () => this.editor.goTo(d.line!, d.column!) },
        d.line === null ? '' : h('span', { class: 'at' }, `${d.line}:${d.column} `),
        d.message, d.help ? h('small', {}, d.help) : null))));
    this.problems.hidden = found.length === 0;
  }

  private pick(block: Block | null, play: boolean): void {
    this.chosen = block;
    this.reasons.choose(block);
    if (block && this.signer) {
      const start = block.start_s + this.lead, end = block.end_s + this.lead;
      this.signer.loop = this.repeat.checked || play ? [start, end] : null;
      if (play) this.repeat.checked = true;
      this.signer.seek(start);
      this.signer.play(play || this.signer.playing);
    } else if (this.signer) this.signer.loop = null;
    this.tick();
  }

  /** The place in the text of a block, else of the nearest block around it. */
  private placeOf(block: Block | null): [number, number] | null {
    for (let found = block; found; found = this.blocks[found.parent] ?? null)
      if (found.place) return found.place;
    return null;
  }

  /** The cursor has moved: the innermost block that is written before it is chosen. */
  private moved(offset: number): void {
    const [line, column] = this.editor.place(offset);
    let best = -1;
    this.blocks.forEach(({ place }, index) => {
      if (!place || place[0] > line || (place[0] === line && place[1] > column)) return;
      const before = this.blocks[best]?.place;
      if (!before || place[0] > before[0] || (place[0] === before[0] && place[1] > before[1])) best = index;
    });
    if (best === this.score.chosen) return;
    this.score.choose(best);
    this.chosen = this.blocks[best] ?? null;
    this.reasons.choose(this.chosen);
    this.tick();
  }

  /** The time is another, or what is shown at it. */
  private tick(): void {
    const { signer } = this;
    if (!signer) return;
    const running = this.score.now(signer.time);
    this.slider.value = String(signer.time);
    this.clock.textContent = `${(signer.time - this.lead).toFixed(2)} s`;
    const label = signer.playing ? words.pause : words.play;
    if (this.button.ariaLabel !== label) {
      this.button.ariaLabel = label;
      this.button.textContent = signer.playing ? '❚❚' : '▶';
    }
    const innermost = running.at(-1)?.place;
    const mark = JSON.stringify([innermost, this.placeOf(this.chosen)]);
    if (mark !== this.marked) {
      this.marked = mark;
      this.editor.mark(innermost ? [innermost] : [], this.placeOf(this.chosen));
    }
    this.film.follow(signer.time, signer.playing, signer.speed);
    this.mark();
  }

  private marked = '';

  private mark(): void {
    if (this.signer) this.signer.mark(this.reasons.marks(this.signer.time, this.lead));
  }

  private set(options: Options): void {
    const other = options.rig !== this.options.rig;
    this.options = options;
    if (other) void this.dress();
    this.compile();
  }

  private async dress(): Promise<void> {
    try {
      await this.signer?.dress(server.body(this.options.rig));
    } catch (error) {
      this.notices.show('body', (error as Error).message, 'warn');
    }
  }

  private async export(suffix: string): Promise<void> {
    this.formats.value = '';
    if (!suffix) return;
    this.notices.show('export', words.exporting, 'calm');
    try {
      const data = await server.exported(this.document.file, this.editor.text, suffix, this.options);
      const name = this.document.file.split('/').at(-1)!.replace(TEXT_SUFFIX, suffix);
      const link = h('a', { href: URL.createObjectURL(data), download: name });
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
      this.notices.show('export', `${words.exported}: ${name}`, 'calm');
    } catch (error) {
      this.notices.show('export', `${words.exportFailed} ${(error as Error).message}`, 'warn');
    }
  }

  private panelShown(panel: PanelName | null): void {
    if (!this.document?.file) return;
    if (panel === 'versions') void this.versions.show(this.document.file);
    if (panel === 'blocks') void this.blockList.show().catch(() => undefined);
  }

  // --- Parts of the page -----------------------------------------------------------------------

  private header(): HTMLElement {
    const tongues = choice(words.language, Object.entries(LANGUAGES), language, value => {
      localStorage.setItem('azee-lang', value satisfies string as Language);
      const address = new URL(location.href);
      address.searchParams.set('lang', value);
      address.searchParams.set('file', this.document.file);
      location.assign(address);
    });
    return h('header', { class: 'bar' },
      h('h1', {}, words.title), this.files,
      h('button', { type: 'button', class: 'save', onclick: () => void this.save() }, words.save),
      this.state, h('span', { class: 'space' }), this.formats, tongues);
  }

  private makeSigner(): void {
    const canvas = h('canvas', { tabindex: 0, role: 'img', 'aria-label': words.signer });
    const stage = h('div', { class: 'stage' }, canvas, this.status);
    this.layout.signer.append(stage);
    try {
      this.signer = new Signer(canvas, () => this.tick());
    } catch {
      this.status.textContent = words.noWebGL;
      return;
    }
    const { signer } = this;
    const cameras = Object.keys(CAMERAS) as (keyof typeof CAMERAS)[];
    this.button.onclick = () => signer.play(!signer.playing);
    this.button.ariaLabel = words.play;
    this.button.textContent = '▶';
    this.slider.oninput = () => { signer.play(false); signer.seek(Number(this.slider.value)); };
    this.repeat.onchange = () => {
      const { chosen } = this;
      signer.loop = this.repeat.checked && chosen
        ? [chosen.start_s + this.lead, chosen.end_s + this.lead] : null;
    };
    const step = (text: string, label: string, direction: 1 | -1): HTMLElement => h('button', {
      type: 'button', 'aria-label': label, title: label, onclick: () => signer.frame(direction),
    }, text);
    this.layout.signer.append(h('div', { class: 'controls', role: 'group', 'aria-label': words.signer },
      this.button, step('‹', words.before, -1), step('›', words.after, 1), this.slider, this.clock,
      choice(words.speed, SPEEDS.map(speed => [String(speed), `${speed}×`] as const), String(signer.speed),
        speed => { signer.speed = Number(speed); }),
      h('label', { class: 'check', title: words.loopBlock }, this.repeat, '⟲'),
      choice(words.camera, cameras.map(name => [name, words[name]] as const), 'front',
        name => signer.look(name as keyof typeof CAMERAS, this.options.dominant === 'left'))));
  }
}

declare global {
  interface Window {
    azeeStudio: Studio;
  }
}

window.azeeStudio = new Studio();
void window.azeeStudio.begin();
