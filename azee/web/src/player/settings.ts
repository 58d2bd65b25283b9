// Settings of a player, from the parameters of an address or the attributes of an element. Names and
// values are those of performs where it has the setting too (docs/player.md lists them).
import { Color } from 'three';
import { FASTEST, SLOWEST } from './playback';

export type Background = 'open' | 'studio' | 'photocall';
const BACKGROUNDS: readonly string[] = ['open', 'studio', 'photocall'];

export interface Settings {
  avatar: string | null; // name or address of a body
  src: string | null; // address of a clip
  text: string; // what the box of the page holds
  autoplay: boolean;
  loop: boolean;
  speed: number;
  applyIdle: boolean;
  controls: boolean;
  restrictView: boolean;
  color: Color | null;
  background: Background;
  img: string | null;
  offset: number;
  cloth: Color | null;
  light: Color;
  lightpos: [number, number, number];
  position: [number, number, number];
  rotation: [number, number, number, number];
  scale: number;
}

type Get = (name: string) => string | null;

/** The names of all settings. */
export const NAMES = [
  'avatar', 'src', 'text', 'autoplay', 'loop', 'speed', 'applyIdle', 'controls', 'restrictView',
  'color', 'background', 'img', 'offset', 'cloth', 'light', 'lightpos', 'position', 'rotation',
  'scale',
] as const;

/**
 * Reads settings.
 *
 * `get` returns the text of a setting, or null; `complain` is told of each that has no meaning, and
 * the default takes its place.
 */
export function readSettings(get: Get, complain: (message: string) => void): Settings {
  const wrong = (name: string, allowed: string): void =>
    complain(`${name}="${get(name)}" has no meaning: ${allowed}`);

  const flag = (name: string, otherwise: boolean): boolean => {
    const text = get(name)?.toLowerCase();
    if (text === undefined) return otherwise;
    if (['', 'true', '1', name.toLowerCase()].includes(text)) return true;
    if (['false', '0'].includes(text)) return false;
    wrong(name, 'true or false');
    return otherwise;
  };
  const number = (name: string, otherwise: number, least: number, most: number): number => {
    const text = get(name);
    if (text === null) return otherwise;
    const value = Number(text);
    if (text.trim() !== '' && value >= least && value <= most) return value;
    wrong(name, `a number from ${least} to ${most}`);
    return otherwise;
  };
  const numbers = <T extends number[]>(name: string, otherwise: T): T => {
    const text = get(name);
    if (text === null) return otherwise;
    const values = text.split(',').map(part => (part.trim() === '' ? NaN : Number(part)));
    if (values.length === otherwise.length && values.every(Number.isFinite)) return values as T;
    wrong(name, `${otherwise.length} numbers with commas between`);
    return otherwise;
  };
  const colour = (name: string): Color | null => {
    const text = get(name);
    if (text === null) return null;
    const css = text.trim().replace(/^0x/i, '#');
    if (CSS.supports('color', css)) return new Color().setStyle(css);
    wrong(name, 'rgb(…), 0x…, #…, hsl(…) or the name of a colour');
    return null;
  };
  const background = (): Background => {
    const text = get('background');
    if (text === null) return get('img') ? 'photocall' : 'open';
    if (BACKGROUNDS.includes(text)) return text as Background;
    wrong('background', BACKGROUNDS.join(', '));
    return 'open';
  };

  return {
    avatar: get('avatar'),
    src: get('src'),
    text: get('text') ?? '',
    autoplay: flag('autoplay', false),
    loop: flag('loop', false),
    speed: number('speed', 1, SLOWEST, FASTEST),
    applyIdle: flag('applyIdle', false),
    controls: flag('controls', true),
    restrictView: flag('restrictView', false),
    color: colour('color'),
    background: background(),
    img: get('img'),
    offset: number('offset', 0, 0, 1),
    cloth: colour('cloth'),
    light: colour('light') ?? new Color(0xfff4e6),
    lightpos: numbers('lightpos', [1.2, 3, 3.2]),
    position: numbers('position', [0, 0, 0]),
    rotation: numbers('rotation', [0, 0, 0, 1]),
    scale: number('scale', 1, 0.01, 100),
  };
}

/** Returns how to read settings from an element's attributes, whose names have no capitals. */
export function attributesOf(element: Element): Get {
  return name => element.getAttribute(name.toLowerCase());
}

/** Returns how to read settings from the parameters of an address, capitals or not. */
export function parametersOf(search: string): Get {
  const found = new Map<string, string>();
  for (const [name, value] of new URLSearchParams(search)) found.set(name.toLowerCase(), value);
  return name => found.get(name.toLowerCase()) ?? null;
}
