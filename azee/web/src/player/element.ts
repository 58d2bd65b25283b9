// <azee-player src="clip.azwc">: a signer in any page. docs/player.md describes it.
import { Bar } from './bar';
import { type Body, loadBody } from './body';
import { type Label, type Movement, WebClip } from './clip';
import { Playback } from './playback';
import type { Pose } from './pose';
import { NAMES, type Settings, attributesOf, readSettings } from './settings';
import { Stage } from './stage';
import { STYLE } from './style';
import { type Words, wordsOf } from './words';

const LONGEST_STEP_S = 0.5; // a page that slept does not jump over signs
const BESIDE = new URL(/* @vite-ignore */ '.', import.meta.url); // where body/ and idle/ are

/** What an `azee-sign` event tells: the sign that is shown from now on, null while idle. */
export type SignEvent = CustomEvent<{ label: Label | null }>;

export class AzeePlayer extends HTMLElement {
  static readonly observedAttributes = [...NAMES.map(name => name.toLowerCase()), 'lang'];

  private settings: Settings = readSettings(() => null, () => undefined);
  private words: Words = wordsOf('en');
  private stage: Stage | null = null;
  private bar: Bar | null = null;
  private body: Body | null = null;
  private pose: Pose | null = null;
  private playback = new Playback(0, 0);
  private shown: Label | null = null;
  private told: Playback['state'] = 'idle';
  private readonly complaints = new Set<string>(); // that were told
  private last: Movement | null = null;
  private lastFrame: number | null = null;
  private frame = 0;
  private loading: Promise<void> = Promise.resolve();
  private seen = false;
  private observer: IntersectionObserver | null = null;
  private wanted: string | null = null; // clip, body and idle loop that were asked for last
  private worn: string | null = null; // body and idle loop that are shown, or being loaded

  connectedCallback(): void {
    if (!this.shadowRoot) this.build();
    this.observer = new IntersectionObserver(entries => {
      this.seen = entries.some(entry => entry.isIntersecting);
      if (this.seen) this.appear();
    });
    this.observer.observe(this);
  }

  disconnectedCallback(): void {
    this.observer?.disconnect();
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    this.stage?.close();
    this.stage = this.body = this.wanted = this.worn = null;
    this.shadowRoot?.querySelector('canvas')?.replaceWith(this.canvas());
  }

  attributeChangedCallback(): void {
    if (this.stage) this.refresh();
  }

  // --- What a page may do --------------------------------------------------------------------

  /** Resolves when everything that was asked for is loaded; rejects where that failed. */
  get ready(): Promise<void> {
    return this.loading;
  }

  get state(): Playback['state'] {
    return this.playback.state;
  }

  get paused(): boolean {
    return this.playback.paused;
  }

  get duration(): number {
    return this.playback.duration;
  }

  /** Seconds into the idle loop. */
  get idleTime(): number {
    return this.playback.idling;
  }

  get currentTime(): number {
    return this.playback.time;
  }

  set currentTime(time: number) {
    this.playback.seek(time);
    this.update();
  }

  get speed(): number {
    return this.playback.speed;
  }

  set speed(speed: number) {
    this.setAttribute('speed', String(speed));
  }

  /** Plays bytes of a web clip, once the idle loop ends. */
  async perform(data: ArrayBuffer): Promise<void> {
    const clip = new WebClip(data);
    await this.dress(this.settings.avatar ?? clip.header.rig);
    if (this.body) this.start(clip.on(this.body));
  }

  /** Plays what is made of a body's joints and units, once the idle loop ends. */
  async performOn(make: (body: Body) => Movement): Promise<void> {
    await this.loading;
    if (!this.body) await this.dress(this.settings.avatar ?? 'signer');
    if (this.body) this.start(make(this.body));
  }

  /** Goes on where it was paused, or plays the last movement again. */
  play(): void {
    if (this.playback.state === 'idle' || !this.playback.playing) {
      if (this.last) this.start(this.last);
      else if (this.settings.src) this.fetching(this.fetchClip(false));
    } else {
      if (this.playback.time >= this.playback.duration) this.playback.seek(0);
      this.playback.paused = false;
    }
    this.update();
  }

  pause(): void {
    this.playback.paused = true;
    this.update();
  }

  stop(): void {
    this.playback.stop();
    this.update();
  }

  home(): void {
    this.stage?.view.home();
  }

  /** Whether time passes only by `advance`: for tests, and for whoever films a page. */
  held = false;

  /** Lets seconds pass, whatever the clock says. */
  advance(seconds: number): void {
    const ended = this.playback.advance(seconds);
    this.update();
    if (ended) this.dispatchEvent(new CustomEvent('azee-end'));
  }

  /** For tests and measurements: joints in the world, what draws, milliseconds a frame. */
  inspect(frames = 0): {
    joints: Record<string, number[]>; device: string; frames_ms: number[]; view: number[];
  } {
    const { stage, body } = this;
    if (!stage || !body) throw Error('nothing is shown yet');
    const frames_ms: number[] = [];
    for (let i = 0; i < frames; i++) {
      this.advance(1 / 30);
      frames_ms.push(stage.timed());
    }
    const { turn, tilt, roll, away } = stage.view;
    return { joints: body.places(), device: stage.device, frames_ms, view: [turn, tilt, roll, away] };
  }

  // --- How it is done ------------------------------------------------------------------------

  private build(): void {
    const root = this.attachShadow({ mode: 'open' });
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(STYLE);
    root.adoptedStyleSheets = [sheet];
    root.append(this.canvas(), document.createElement('slot'));
  }

  private canvas(): HTMLCanvasElement {
    const canvas = document.createElement('canvas');
    canvas.tabIndex = 0;
    canvas.setAttribute('role', 'img');
    return canvas;
  }

  private appear(): void {
    if (!this.stage) {
      this.words = wordsOf(this.closest('[lang]')?.getAttribute('lang') ?? navigator.language);
      const canvas = this.shadowRoot!.querySelector('canvas')!;
      canvas.setAttribute('aria-label', this.words.signer);
      try {
        this.stage = new Stage(canvas);
      } catch {
        this.fail(Error(this.words.noWebGL));
        return;
      }
      this.refresh();
    }
    if (!this.frame) {
      this.lastFrame = null;
      this.frame = requestAnimationFrame(now => this.step(now));
    }
  }

  private refresh(): void {
    this.settings = readSettings(attributesOf(this), message => {
      if (!this.complaints.has(message)) console.warn(`azee-player: ${message}`);
      this.complaints.add(message);
    });
    this.playback.speed = this.settings.speed;
    this.playback.loop = this.settings.loop;
    if (this.settings.controls && !this.bar) {
      this.bar = new Bar(this, this.words);
      this.shadowRoot!.append(this.bar.element);
    } else if (!this.settings.controls && this.bar) {
      this.bar.element.remove();
      this.bar = null;
    }
    const { src, avatar } = this.settings;
    const wanted = JSON.stringify([src, avatar, this.settings.applyIdle]);
    if (wanted !== this.wanted) {
      this.wanted = wanted;
      this.fetching(src ? this.fetchClip(!this.settings.autoplay) : this.dress(avatar ?? 'signer'));
    }
    void this.loading.then(() => this.stage?.arrange(this.settings), () => undefined)
      .catch((error: unknown) => this.fail(error));
    this.update();
  }

  private fetching(loading: Promise<void>): void {
    this.loading = loading;
    loading.catch((error: unknown) => this.fail(error));
  }

  private async fetchClip(paused: boolean): Promise<void> {
    const address = this.settings.src!, { wanted } = this;
    const answer = await fetch(new URL(address, document.baseURI));
    if (!answer.ok) throw Error(`${address}: ${answer.status} ${answer.statusText}`);
    const clip = new WebClip(await answer.arrayBuffer());
    await this.dress(this.settings.avatar ?? clip.header.rig);
    if (!this.body || this.wanted !== wanted) return; // something else was asked for meanwhile
    const movement = clip.on(this.body);
    if (this.settings.applyIdle && paused) this.last = movement; // until then the loop is shown
    else this.start(movement, paused);
  }

  private start(movement: Movement, paused = false): void {
    this.last = movement;
    this.playback.play(movement, paused);
    this.update();
  }

  private bodyOf(avatar: string): string {
    const named = !/[/.]/.test(avatar);
    return named ? new URL(`body/${avatar}.glb`, BESIDE).href : new URL(avatar, document.baseURI).href;
  }

  /** Shows a body, by name or address, with its idle loop. */
  private async dress(avatar: string): Promise<void> {
    const address = this.bodyOf(avatar);
    const wear = `${address} ${this.settings.applyIdle}`;
    if (wear === this.worn && this.body) return;
    this.worn = wear;
    this.toggleAttribute('data-loading', true);
    try {
      const idle = this.settings.applyIdle ? fetch(address.replace(/body\/([^/]*)\.glb$/, 'idle/$1.azwc')) : null;
      const body = await loadBody(address);
      if (this.worn !== wear || !this.stage) return;
      this.body = body;
      this.pose = body.pose();
      this.last = null;
      this.playback = new Playback(body.joints.length, body.units.length);
      this.playback.speed = this.settings.speed;
      this.playback.loop = this.settings.loop;
      const answer = await idle;
      if (answer?.ok) this.playback.setIdle(new WebClip(await answer.arrayBuffer()).on(body));
      this.stage.show(body);
      await this.stage.arrange(this.settings);
      this.update();
      this.dispatchEvent(new CustomEvent('azee-ready'));
    } finally {
      if (this.worn === wear) this.toggleAttribute('data-loading', false);
    }
  }

  private step(now: number): void {
    this.frame = this.seen ? requestAnimationFrame(next => this.step(next)) : 0;
    const { stage, pose, playback } = this;
    if (!stage || !pose) return;
    const seconds = this.lastFrame === null ? 0 : Math.min((now - this.lastFrame) / 1000, LONGEST_STEP_S);
    this.lastFrame = now;
    stage.fit();
    const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
    if (playback.moving && !this.held && !(still && playback.state === 'idle')) this.advance(seconds);
    if (stage.dirty) stage.draw();
  }

  /** Brings picture, bar and listeners up to date. */
  private update(): void {
    this.bar?.update();
    if (this.pose && this.body && this.stage) {
      this.playback.sample(this.pose);
      this.body.apply(this.pose);
      this.stage.dirty = true;
    }
    const { label, state } = this.playback;
    if (state !== this.told) {
      this.told = state;
      this.dispatchEvent(new CustomEvent('azee-state', { detail: { state } }));
    }
    if (label === this.shown) return;
    this.shown = label;
    this.dispatchEvent(new CustomEvent('azee-sign', { detail: { label } }) satisfies SignEvent);
  }

  private fail(error: unknown): void {
    const message = error instanceof Error ? error.message : String(error);
    let shown = this.shadowRoot!.querySelector('[role=alert]');
    if (!shown) {
      shown = document.createElement('p');
      shown.setAttribute('role', 'alert');
      this.shadowRoot!.append(shown);
    }
    shown.textContent = message;
    this.dispatchEvent(new CustomEvent('azee-error', { detail: { message } }));
  }
}

customElements.define('azee-player', AzeePlayer);

declare global {
  interface HTMLElementTagNameMap {
    'azee-player': AzeePlayer;
  }
}
