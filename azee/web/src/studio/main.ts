// The studio: text, signer, score and panels, linked.
import { Blocks } from './blocks';
import { TextDocument } from './document';
import { Editor } from './editor';
import { choice, h } from './elements';
import { Files, withSuffix } from './files';
import { Layout, type PanelName } from './layout';
import { broughtAlong, goTo, studioAddress } from './moving';
import { Notices } from './notices';
import { Film, Palette, Reasons, settingsPanel, Versions } from './panels';
import { Posing } from './posing';
import type { Answer, Block, Diagnostic, Listing, Options } from './protocol';
import { Score } from './score';
import { Live, server } from './server';
import type { Signer } from './signer';
import { SignerPane } from './signer-pane';
import { chosenLanguage, type Language, LANGUAGES, wordsOf } from './words';

const COMPILE_MS = 10; // after the last key; a newer text stops an older one
const RULES_MS = 700;
const parameters = new URLSearchParams(location.search);

const language = chosenLanguage();
const words = wordsOf(language);
document.documentElement.lang = language;
document.title = words.title;

class Studio {
  /** Milliseconds after an edit when its text was sent, its movement came and was drawn; for measuring. */
  readonly latencies: { sent: number; came: number; drawn: number }[] = [];
  /** Milliseconds that the steps of the server took, for each of them, and its processor. */
  readonly workerTimes: Record<string, number>[] = [];
  readonly notices = new Notices();
  readonly editor: Editor;
  readonly score: Score;
  readonly document: TextDocument;
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
  private sentAt = 0;
  private timer = 0;
  private rulesTimer = 0;
  private lsp = new Set<(message: string) => void>();
  private readonly layout: Layout;
  private readonly pane: SignerPane;
  readonly posing: Posing;
  private readonly palette: Palette;
  private readonly reasons: Reasons;
  private readonly versions: Versions;
  private readonly film = new Film(words);
  private readonly blockList: Blocks;
  private readonly settings = h('div');
  private readonly files: Files;
  private readonly problems = h('ul', { class: 'problems', 'aria-label': words.problems });
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
    this.files = new Files(words, () => this.document, () => this.editor, this.notices,
      () => this.opened(), () => this.compile());
    const header = this.header();
    this.pane = new SignerPane(words, () => this.tick(), () => this.options.dominant === 'left');
    this.posing = new Posing(words, {
      signer: this.signer,
      send: act => this.live.send({ ...(act.act === 'open' ? this.job() : {}), ...act, kind: 'pose' }),
      instant: () => (this.blocks.length > 0 && this.signer ? this.signer.time - this.lead : null),
      change: (from, to, insert) => this.editor.change(from, to, insert),
    });
    this.layout = new Layout(words, header, {
      rules: this.palette.element, blocks: this.blockList.element, pose: this.posing.element, reasons: this.reasons.element,
      versions: this.versions.element, film: this.film.element, settings: this.settings,
    }, panel => this.panelShown(panel));
    this.score = new Score(words.score, (block, play) => this.pick(block, play), time => this.signer?.seek(time));
    document.body.append(header, this.layout.main);
    const box = h('div', { class: 'editor' });
    this.layout.text.append(this.notices.element, box, this.problems);
    this.editor = new Editor(box, words.text, text => this.typed(text), offset => this.moved(offset), {
      'Mod-s': () => void this.files.save(), 'Mod-Enter': () => this.pane.toggle(),
    });
    this.layout.score.append(this.score.element);
    this.layout.signer.append(...this.pane.elements);
    this.document = new TextDocument(() => this.live, () => this.files.showState());
    this.live = new Live((answer, data) => this.got(answer, data), () => this.connected(),
      () => this.notices.show('offline', words.offline, 'warn', [[words.newAddress, () => this.move()]]));
    addEventListener('keydown', event => {
      if ((event.ctrlKey || event.metaKey) && event.key === 's') {
        event.preventDefault();
        void this.files.save();
      }
    });
  }

  get signer(): Signer | null {
    return this.pane?.signer ?? null;
  }

  async begin(): Promise<void> {
    this.listing = await server.listing();
    const { bodies } = this.listing;
    if (!bodies.includes(this.options.rig)) this.options.rig = bodies[0]!;
    this.settings.replaceChildren(settingsPanel(words, bodies, this.options, options => this.set(options)));
    this.film.show(this.listing.films);
    this.formats.replaceChildren(h('option', { value: '' }, `${words.export} …`),
      ...this.listing.formats.map(suffix => h('option', { value: suffix }, suffix)));
    this.layout.begin();
    void this.dress();
    const brought = broughtAlong();
    await this.files.begin(this.listing, parameters.get('file'));
    if (brought !== null) this.editor.replace(brought);
  }

  /** Goes to the address of a server that was started again; what is typed comes along. */
  private move(): void {
    const given = prompt(words.pasteAddress) ?? '';
    const address = studioAddress(given);
    if (address) goTo(address, this.document.file, this.editor.text);
    else if (given) this.notices.show('address', words.noAddress, 'calm');
  }

  private opened(): void {
    this.chosen = null;
    this.speak();
    this.compile();
    void this.loadRules();
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
        if (answer.file === this.document.file) this.files.changedOnDisk(answer);
        break;
      case 'score':
        if (answer.number !== this.sent) break;
        this.showProblems(answer.diagnostics);
        if (answer.blocks.length > 0) this.pane.status.textContent = words.solving;
        if (answer.blocks.length === 0) this.pane.status.textContent = this.editor.text.trim() ? '' : words.nothing;
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
      case 'posed':
        this.posing.got(answer);
        break;
      case 'stopped':
        this.posing.stopped();
        this.pane.status.textContent = `${words.stopped} ${answer.reason}`;
        break;
      case 'refused':
        this.posing.stopped();
        this.pane.status.textContent = answer.message ?? '';
        if (answer.diagnostics) this.showProblems(answer.diagnostics);
        break;
      default:
    }
  }

  private typed(text: string): void {
    this.document.typed(text);
    this.posing.outdated();
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
    this.sentAt = performance.now();
    this.live.send({ ...this.job(), kind: 'compile' });
  }

  private job(): object {
    return { ...this.options, number: this.sent, file: this.document.file, text: this.editor.text };
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
    const { begun, sentAt } = this;
    const came = performance.now();
    this.signer?.show(data, () => {
      const [sent, drawn] = [sentAt - begun, performance.now() - begun];
      this.latencies.push({ sent, came: came - begun, drawn });
      this.workerTimes.push({ ...answer.ms, processor: answer.processor_ms });
      this.shownNumber = answer.number;
    });
    this.score.show(answer.blocks, answer.lead_s, this.signer?.duration ?? 1);
    this.chosen = this.blocks[this.score.chosen] ?? null;
    this.pane.status.textContent = '';
    if (answer.diagnostics.length > 0) this.showProblems(answer.diagnostics);
    if (!matchMedia('(prefers-reduced-motion: reduce)').matches && this.signer?.time === 0
      && !this.posing.open) this.signer.play(true);
    this.tick();
    this.posing.moved();
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
    this.pane.go(block && [block.start_s + this.lead, block.end_s + this.lead], play);
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
    this.pane.update(this.lead);
    const innermost = running.at(-1)?.place;
    const mark = JSON.stringify([innermost, this.placeOf(this.chosen)]);
    if (mark !== this.marked) {
      this.marked = mark;
      this.editor.mark(innermost ? [innermost] : [], this.placeOf(this.chosen));
    }
    this.posing.ticked();
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
      const name = withSuffix(this.document.file, suffix);
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
    this.posing.show(this.layout.current === 'pose');
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
      h('h1', {}, words.title), this.files.list, this.files.button, this.files.state,
      h('span', { class: 'space' }), this.formats, tongues);
  }
}

declare global {
  interface Window {
    azeeStudio: Studio;
  }
}

window.azeeStudio = new Studio();
void window.azeeStudio.begin();
