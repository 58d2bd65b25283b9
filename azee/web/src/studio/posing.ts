// Posing: drag the body, and choose what is written for it.
import { choice, h } from './elements';
import { GripView } from './grip-view';
import type { Grip, Place, PoseAct, Posed, Proposal } from './protocol';
import type { Signer } from './signer';
import type { Words } from './words';

const STEP_M = 0.01; // for a key
const STILL_MS = 250; // after the last change of time
const ATTEMPTS = 3; // to open a session that was lost

export interface Around {
  readonly signer: Signer | null;
  /** Sends an act for a session, with the text where it opens one. */
  send(act: PoseAct & { session: number; serial: number }): void;
  /** The instant that is shown, seconds of the score; null where nothing is signed. */
  instant(): number | null;
  /** Changes the text in one step that can be undone. */
  change(from: number, to: number, insert: string): void;
}

export class Posing {
  readonly element: HTMLElement;
  /** Whether somebody poses. */
  open = false;
  /** Milliseconds from a drag that was sent to its posture on the screen; for measuring. */
  readonly answers: number[] = [];
  private readonly view: GripView | null;
  private readonly handles: HTMLSelectElement;
  private readonly morphs: HTMLSelectElement;
  private readonly weight: HTMLInputElement;
  private readonly told = h('p', { class: 'quiet', role: 'status' });
  private readonly list = h('ul', { class: 'proposals' });
  private timer = 0;
  private at: number | null = null; // the instant that is posed
  private session = 0;
  private serial = 0;
  private under = 0; // the serial of the act that is not answered yet
  private began = 0;
  private waiting: PoseAct[] = [];
  private goals = new Map<string, readonly number[]>();
  private grips: readonly Grip[] = [];
  private lost = 0;

  constructor(private readonly words: Words, private readonly around: Around) {
    this.view = around.signer && new GripView(around.signer, {
      taken: handle => this.choose(handle),
      led: (handle, place) => this.lead(handle, place),
      left: handle => this.propose(handle),
    });
    this.handles = choice(words.part, [], '', handle => this.choose(handle));
    this.handles.addEventListener('keydown', event => this.key(event));
    this.morphs = choice(words.shape, [], '', () => { this.weight.value = '0'; });
    this.weight = h('input', { type: 'range', min: -1, max: 1, step: 0.05, value: 0, 'aria-label': words.weight });
    this.weight.addEventListener('input', () => this.drag(this.morphs.value, [Number(this.weight.value)]));
    this.weight.addEventListener('change', () => this.propose(this.morphs.value));
    this.element = h('div', { class: 'panel-body posing' },
      h('p', { class: 'quiet' }, words.poseHelp),
      h('label', { class: 'field' }, words.part, this.handles),
      h('label', { class: 'field' }, words.shape, this.morphs),
      h('label', { class: 'field' }, words.weight, this.weight),
      h('button', { type: 'button', onclick: () => this.begin() }, words.poseAgain),
      this.told, this.list);
  }

  /** Begins or ends posing. */
  show(on: boolean): void {
    if (on === this.open) return;
    this.open = on;
    if (on) this.begin();
    else this.end();
  }

  /** The movement is another: what was dragged is given up. */
  moved(): void {
    if (this.open) this.begin();
  }

  /** The text is another: what could be written does not fit it. */
  outdated(): void {
    if (!this.open) return;
    this.pause();
    this.list.replaceChildren();
  }

  /** The time may be another: then another instant is posed, as soon as the body stands still. */
  ticked(): void {
    if (!this.open || this.around.instant() === this.at) return;
    this.pause();
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.moved(), STILL_MS);
  }

  private pause(): void {
    this.session += 1; // answers to what was asked before are not for this one
    this.under = 0;
    this.waiting = [];
    this.goals.clear();
    this.view?.show([]);
  }

  /** Takes an answer of the server. */
  got(answer: Posed): void {
    if (!this.open || answer.session !== this.session || answer.serial !== this.under) return;
    this.under = 0;
    if (answer.lost) {
      this.recover();
      return;
    }
    this.lost = 0;
    if (answer.rotations && answer.weights) {
      this.around.signer?.hold({ rotations: answer.rotations, weights: answer.weights });
      if (answer.act === 'drag') this.answers.push(performance.now() - this.began);
    }
    if (answer.grips) {
      this.grips = answer.grips;
      this.view?.show(answer.grips, this.handles.value);
    }
    if (answer.act === 'open') this.opened(answer);
    const { words } = this;
    if (answer.message) this.told.textContent = answer.message;
    else if (answer.act === 'drag') this.told.textContent = answer.blocked?.join('; ') ?? '';
    if (answer.act === 'propose') {
      this.told.textContent = answer.missed?.join('; ') || (answer.proposals?.length ? words.chooseProposal : words.noProposal);
      this.list.replaceChildren(...(answer.proposals ?? []).map(proposal => this.row(proposal)));
    }
    this.next();
  }

  /** The worker has given the act up. */
  stopped(): void {
    if (this.open && this.under) this.recover();
  }

  /** Where a part is on the page, pixels; for tests. */
  onPage(handle: string): [number, number] | null {
    return this.view?.onPage(handle) ?? null;
  }

  /** Where a part is on the body, metres. */
  place(handle: string): Place | null {
    return this.grips.find(grip => grip.handle === handle)?.at ?? null;
  }

  get idle(): boolean {
    return this.open && this.under === 0 && this.waiting.length === 0;
  }

  private begin(): void {
    const at = this.at = this.around.instant();
    clearTimeout(this.timer);
    this.pause();
    this.list.replaceChildren();
    this.told.textContent = at === null ? this.words.nothing : '';
    if (at === null) return;
    this.around.signer?.play(false);
    this.waiting.push({ act: 'open', at_s: at });
    this.next();
  }

  private end(): void {
    clearTimeout(this.timer);
    this.around.send({ act: 'close', session: this.session, serial: (this.serial += 1) });
    this.pause();
    this.around.signer?.hold(null);
  }

  /** Opens a session again and drags everything to where it was. */
  private recover(): void {
    const goals = [...this.goals];
    const at = this.around.instant();
    this.under = 0;
    if ((this.lost += 1) > ATTEMPTS || at === null) return;
    this.session += 1;
    this.waiting = [{ act: 'open', at_s: at },
      ...goals.map(([handle, target]): PoseAct => ({ act: 'drag', handle, target })), ...this.waiting];
    this.next();
  }

  private opened(answer: Posed): void {
    const before = this.handles.value, shape = this.morphs.value;
    const options = (names: readonly string[]): HTMLElement[] =>
      names.map(name => h('option', { value: name }, name));
    this.handles.replaceChildren(...options(this.grips.map(grip => grip.handle)));
    if (before) this.handles.value = before;
    this.morphs.replaceChildren(
      h('optgroup', { label: this.words.fingers }, ...options(answer.fingers ?? [])),
      h('optgroup', { label: this.words.face }, ...options(answer.face ?? [])));
    if (shape) this.morphs.value = shape;
    this.weight.value = '0';
    this.view?.show(this.grips, this.handles.value);
  }

  private choose(handle: string): void {
    this.handles.value = handle;
    this.view?.show(this.grips, handle);
  }

  /** Leads a grip to a place: an arrow is turned there from its foot. */
  private lead(handle: string, place: Place): void {
    const base = this.grips.find(grip => grip.handle === handle)?.base;
    const turns = base && handle !== 'gaze';
    this.drag(handle, turns ? place.map((x, i) => x - base[i]!) : place);
  }

  private drag(handle: string, target: readonly number[]): void {
    if (!handle) return;
    this.goals.set(handle, target);
    const act: PoseAct = { act: 'drag', handle, target };
    const last = this.waiting.at(-1);
    if (last?.act === 'drag' && last.handle === handle) this.waiting.pop(); // the newest place counts
    this.waiting.push(act);
    this.next();
  }

  private propose(handle: string): void {
    if (!this.goals.has(handle)) return;
    this.waiting.push({ act: 'propose', handle });
    this.next();
  }

  private next(): void {
    if (this.under || this.waiting.length === 0) return;
    const act = this.waiting.shift()!;
    this.under = this.serial += 1;
    this.began = performance.now();
    this.around.send({ ...act, session: this.session, serial: this.serial });
  }

  private row(proposal: Proposal): HTMLLIElement {
    const { change } = proposal;
    const off = proposal.unit === null || proposal.off < 5e-4 ? ''
      : ` · ${this.words.off} ${proposal.unit === 'm' ? `${(1000 * proposal.off).toFixed(0)} mm`
        : `${((180 / Math.PI) * proposal.off).toFixed(1)}°`}`;
    return h('li', {}, h('button', {
      type: 'button', 'data-kind': proposal.kind,
      onclick: () => this.around.change(change.from, change.to, change.insert),
    }, h('code', {}, proposal.written), h('small', {}, `${proposal.fixes} · ${proposal.where}${off}`)));
  }

  /** Keys on the list of parts move the chosen one: Alt with arrows, Page Up and Page Down. */
  private key(event: KeyboardEvent): void {
    if (event.key === 'Enter') {
      this.propose(this.handles.value);
      return;
    }
    const steps: Record<string, Place> = {
      ArrowLeft: [-STEP_M, 0, 0], ArrowRight: [STEP_M, 0, 0], ArrowUp: [0, STEP_M, 0],
      ArrowDown: [0, -STEP_M, 0], PageUp: [0, 0, -STEP_M], PageDown: [0, 0, STEP_M],
    };
    const step = event.altKey ? steps[event.key] : undefined;
    const grip = this.grips.find(one => one.handle === this.handles.value);
    if (!step || !grip) return;
    event.preventDefault();
    this.lead(grip.handle, grip.at.map((x, i) => x + step[i]!) as Place);
  }
}
