// The signer with what plays, steps, repeats and turns it.
import { choice, h } from './elements';
import { CAMERAS, Signer } from './signer';
import type { Words } from './words';

const SPEEDS = [0.1, 0.25, 0.5, 0.75, 1, 1.5, 2];
type CameraName = keyof typeof CAMERAS;

export class SignerPane {
  /** None where the browser has no WebGL. */
  readonly signer: Signer | null;
  readonly status = h('p', { class: 'status', role: 'status' });
  readonly elements: readonly HTMLElement[];
  private readonly button = h('button', { type: 'button', class: 'play' });
  private readonly slider: HTMLInputElement;
  private readonly clock = h('output', {});
  private readonly repeat: HTMLInputElement;
  private span: readonly [number, number] | null = null;

  /** `changed` is called when the time is another; `mirrored` tells whether the left hand is strong. */
  constructor(private readonly words: Words, changed: () => void, mirrored: () => boolean) {
    const canvas = h('canvas', { tabindex: 0, role: 'img', 'aria-label': words.signer });
    this.slider = h('input', { type: 'range', min: 0, max: 1, step: 0.01, 'aria-label': words.time });
    this.repeat = h('input', { type: 'checkbox', 'aria-label': words.loopBlock });
    const stage = h('div', { class: 'stage' }, canvas, this.status);
    this.signer = signerOn(canvas, changed);
    if (!this.signer) {
      this.status.textContent = words.noWebGL;
      this.elements = [stage];
      return;
    }
    const { signer } = this;
    this.button.onclick = () => signer.play(!signer.playing);
    this.slider.oninput = () => { signer.play(false); signer.seek(Number(this.slider.value)); };
    this.repeat.onchange = () => { signer.loop = this.repeat.checked ? this.span : null; };
    const step = (text: string, label: string, direction: 1 | -1): HTMLElement => h('button', {
      type: 'button', 'aria-label': label, title: label, onclick: () => signer.frame(direction),
    }, text);
    const cameras = Object.keys(CAMERAS) as CameraName[];
    this.elements = [stage, h('div', { class: 'controls', role: 'group', 'aria-label': words.signer },
      this.button, step('‹', words.before, -1), step('›', words.after, 1), this.slider, this.clock,
      choice(words.speed, SPEEDS.map(speed => [String(speed), `${speed}×`] as const), String(signer.speed),
        speed => { signer.speed = Number(speed); }),
      h('label', { class: 'check', title: words.loopBlock }, this.repeat, '⟲'),
      choice(words.camera, cameras.map(name => [name, words[name]] as const), 'front',
        name => signer.look(name as CameraName, mirrored())))];
    this.update(0);
  }

  toggle(): void {
    this.signer?.play(!this.signer.playing);
  }

  /** Goes to the beginning of a block, or takes no block any more; `play`: and repeats it. */
  go(span: readonly [number, number] | null, play: boolean): void {
    this.span = span;
    const { signer } = this;
    if (!signer) return;
    if (play) this.repeat.checked = true;
    signer.loop = this.repeat.checked ? span : null;
    if (!span) return;
    signer.seek(span[0]);
    signer.play(play || signer.playing);
  }

  /** Shows the time: `lead` is when the score begins. */
  update(lead: number): void {
    const { signer, words } = this;
    if (!signer) return;
    this.slider.max = String(signer.duration || 1);
    this.slider.value = String(signer.time);
    this.clock.textContent = `${(signer.time - lead).toFixed(2)} s`;
    const label = signer.playing ? words.pause : words.play;
    if (this.button.ariaLabel === label) return;
    this.button.ariaLabel = label;
    this.button.textContent = signer.playing ? '❚❚' : '▶';
  }
}

function signerOn(canvas: HTMLCanvasElement, changed: () => void): Signer | null {
  try {
    return new Signer(canvas, changed);
  } catch {
    return null;
  }
}
