// The page of `azee play --page`, after Gürel 2010, A.2.2: a box for what is to be signed, a box
// that says what is signed now, Play, Quit, and the signer.
import './page.css';
import { made } from './bar';
import { AzeePlayer, type SignEvent } from './element';
import { NAMES, parametersOf } from './settings';
import { type Catalogue, Refused, fromFolder, fromServer } from './sources';
import { wordsOf } from './words';

const get = parametersOf(location.search);
const language = get('lang') ?? navigator.language;
const words = wordsOf(language);
document.documentElement.lang = language.toLowerCase().startsWith('fr') ? 'fr' : 'en';

const OWN: readonly string[] = ['text', 'src', 'autoplay', 'avatar']; // the page's, not the player's

const player = new AzeePlayer();
const text = made('textarea', { id: 'text', rows: '3', spellcheck: 'false', 'aria-label': words.text });
const known = made('details', { id: 'known', hidden: '' });
const source = made('select', { id: 'source', 'aria-label': words.source });
const body = made('select', { id: 'body', 'aria-label': words.body });
const now = made('output', { id: 'now', 'aria-label': words.now, 'aria-live': 'off' }, words.loading);
const play = made('button', { id: 'play', type: 'submit' }, words.play);
const stop = made('button', { id: 'stop', type: 'button' }, words.stop);
const quit = made('button', { id: 'quit', type: 'button' }, words.quit);
const told = made('ul', { id: 'told' });
const form = made('form', {},
  made('label', { for: 'text' }, words.text), text,
  made('div', { class: 'row' },
    made('label', {}, words.source, source), made('label', {}, words.body, body)),
  made('div', { class: 'row' }, play, stop, quit),
  made('div', { role: 'status' }, told), known);
document.body.append(made('main', {}, now, form));

function tell(messages: readonly string[]): void {
  told.replaceChildren(...messages.map(message => made('li', {}, message)));
}

async function begin(): Promise<void> {
  const catalogue = (await (await fetch('catalogue.json')).json()) as Catalogue;
  source.append(...catalogue.sources.map(one => made('option', { value: one.id }, one.title)));
  source.value = get('source') ?? catalogue.source;
  if (source.selectedIndex < 0) source.selectedIndex = 0;
  body.append(...catalogue.bodies.map(name => made('option', { value: name }, name)));
  body.value = get('avatar') ?? catalogue.body;
  if (body.selectedIndex < 0) body.value = catalogue.body;
  text.value = get('text') ?? catalogue.text;
  quit.hidden = !catalogue.live;
  const chosen = (): Catalogue['sources'][number] => catalogue.sources[source.selectedIndex]!;

  player.setAttribute('applyidle', 'true');
  for (const name of NAMES) {
    const value = get(name);
    if (value !== null && !OWN.includes(name)) player.setAttribute(name.toLowerCase(), value);
  }
  player.setAttribute('avatar', body.value);
  document.body.prepend(player); // not before it is known what it shows
  body.onchange = () => { player.setAttribute('avatar', body.value); };

  const list = (): void => {
    const names = Object.keys(chosen().signs ?? {});
    known.hidden = names.length === 0 || chosen().kind === 'letters';
    known.replaceChildren(made('summary', {}, `${names.length} ${words.signs}`),
      made('p', { tabindex: '0' }, names.join(' ')));
  };
  source.onchange = list;
  list();

  const perform = (catalogue.live ? fromServer : fromFolder)(player, words);
  let asking = 0;
  const submit = async (): Promise<void> => {
    const number = ++asking;
    tell([]);
    form.toggleAttribute('aria-busy', true);
    now.textContent = words.thinking;
    try {
      tell(await perform(text.value, chosen(), body.value));
    } catch (error) {
      if (number !== asking) return;
      tell(error instanceof Refused ? error.messages : [String(error)]);
    } finally {
      if (number === asking) form.toggleAttribute('aria-busy', false);
      state();
    }
  };
  form.onsubmit = event => {
    event.preventDefault();
    void submit();
  };
  text.onkeydown = event => {
    const plays = event.key === 'Enter' && !event.shiftKey && (event.ctrlKey || chosen().kind !== 'azee');
    if (!plays) return;
    event.preventDefault();
    form.requestSubmit();
  };
  document.addEventListener('keydown', event => {
    if (event.key === 'Escape') player.stop();
  });
  stop.onclick = () => { player.stop(); };
  quit.onclick = () => void leave();
  if (get('autoplay') !== null && get('autoplay') !== 'false') form.requestSubmit();
}

function state(): void {
  const { state } = player;
  if (state === 'waiting') now.textContent = words.waiting;
  else if (state === 'idle' && !form.hasAttribute('aria-busy')) now.textContent = words.idle;
  document.body.dataset['state'] = state;
}

async function leave(): Promise<void> {
  await fetch('quit', { method: 'POST' }).catch(() => undefined);
  player.remove();
  form.remove();
  now.textContent = words.ended;
}

player.addEventListener('azee-sign', event => {
  const { label } = (event as SignEvent).detail;
  if (label) now.textContent = label.text;
  state();
});
for (const kind of ['azee-ready', 'azee-end', 'azee-state']) player.addEventListener(kind, state);
player.addEventListener('azee-error', event => tell([(event as CustomEvent<{ message: string }>).detail.message]));
begin().catch((error: unknown) => tell([String(error)]));
