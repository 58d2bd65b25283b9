// The controls of a player: play, time, speed, repeat.
import type { AzeePlayer } from './element';
import { FASTEST, SLOWEST } from './playback';
import type { Words } from './words';

const SPEEDS = [SLOWEST, 0.25, 0.5, 0.75, 1, 1.5, FASTEST];

/** Makes an element with attributes and children. */
export function made<Name extends keyof HTMLElementTagNameMap>(
  name: Name, attributes: Record<string, string> = {}, ...children: (Node | string)[]
): HTMLElementTagNameMap[Name] {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

export class Bar {
  readonly element: HTMLElement;
  private readonly button = made('button', { type: 'button' });
  private readonly slider: HTMLInputElement;
  private readonly output = made('output', { 'aria-live': 'off' });
  private readonly speed: HTMLSelectElement;
  private readonly repeat: HTMLInputElement;

  constructor(private readonly player: AzeePlayer, private readonly words: Words) {
    this.slider = made('input', {
      type: 'range', min: '0', max: '1', step: '0.01', 'aria-label': words.time,
    });
    this.speed = made('select', { 'aria-label': words.speed },
      ...SPEEDS.map(speed => made('option', { value: String(speed) }, `${speed}×`)));
    this.repeat = made('input', { type: 'checkbox', 'aria-label': words.repeat });
    this.element = made('div', { class: 'bar', role: 'group' }, this.button, this.slider, this.output,
      this.speed, made('label', { title: words.repeat }, this.repeat, '⟲'));
    this.button.onclick = () => {
      if (this.player.state === 'playing' && !this.player.paused) this.player.pause();
      else this.player.play();
    };
    this.slider.oninput = () => {
      this.player.pause();
      this.player.currentTime = Number(this.slider.value);
    };
    this.speed.onchange = () => { this.player.speed = Number(this.speed.value); };
    this.repeat.onchange = () => { this.player.toggleAttribute('loop', this.repeat.checked); };
    this.update();
  }

  update(): void {
    const { player, words } = this;
    const running = player.state === 'playing' && !player.paused;
    const text = running ? '❚❚' : '▶';
    if (this.button.textContent !== text) {
      this.button.textContent = text;
      this.button.ariaLabel = running ? words.pause : words.play;
    }
    this.slider.max = String(player.duration || 1);
    this.slider.value = String(player.currentTime);
    this.slider.disabled = player.duration === 0;
    this.output.textContent = `${player.currentTime.toFixed(2)} s`;
    if (Number(this.speed.value) !== player.speed) this.speed.value = String(player.speed);
    this.repeat.checked = player.hasAttribute('loop');
  }
}
