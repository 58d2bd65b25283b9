// What the player says, in English and French.

const ENGLISH = {
  signer: 'Signer. Arrow keys turn the view, plus and minus move it, comma and full stop roll it, 0 resets it.',
  play: 'Play',
  pause: 'Pause',
  stop: 'Stop',
  quit: 'Quit',
  time: 'Time',
  speed: 'Speed',
  repeat: 'Repeat',
  text: 'What to sign',
  source: 'From',
  body: 'Body',
  now: 'Sign shown now',
  loading: 'Loading …',
  thinking: 'Solving …',
  waiting: 'The idle loop ends …',
  idle: 'idle',
  noWebGL: 'This browser cannot draw the signer: it has no WebGL 2.',
  unknown: 'Not known, left out:',
  nothing: 'None of this is known.',
  ended: 'The player has ended. This page can be closed.',
  unreachable: 'The player cannot be reached. Is it still running?',
  signs: 'signs',
};

export type Words = Readonly<typeof ENGLISH>;

const FRENCH: Words = {
  signer: 'Signeur. Les flèches tournent la vue, plus et moins la déplacent, virgule et point l’inclinent, 0 la rétablit.',
  play: 'Jouer',
  pause: 'Pause',
  stop: 'Arrêter',
  quit: 'Quitter',
  time: 'Temps',
  speed: 'Vitesse',
  repeat: 'En boucle',
  text: 'À signer',
  source: 'Depuis',
  body: 'Corps',
  now: 'Signe en cours',
  loading: 'Chargement …',
  thinking: 'Calcul …',
  waiting: 'La boucle de repos s’achève …',
  idle: 'au repos',
  noWebGL: 'Ce navigateur ne peut pas dessiner le signeur : il n’a pas WebGL 2.',
  unknown: 'Inconnu, omis :',
  nothing: 'Rien de cela n’est connu.',
  ended: 'Le lecteur est arrêté. Cette page peut être fermée.',
  unreachable: 'Le lecteur ne répond pas. Fonctionne-t-il encore ?',
  signs: 'signes',
};

/** Returns the words of a language tag such as `fr-CH`; English for any that is not known. */
export function wordsOf(language: string): Words {
  return language.toLowerCase().startsWith('fr') ? FRENCH : ENGLISH;
}
