// What the page says, in English and French: one table.

const ENGLISH = {
  title: 'azee studio',
  file: 'File', newFile: 'New …', newName: 'Name of the new text, such as greeting.azee',
  save: 'Save', saved: 'Saved', unsaved: 'Not saved; kept as a draft', keeping: 'Keeping …',
  offline: 'The server does not answer. Your text is kept here until it does.',
  back: 'The server is back.',
  restored: 'Typed before and not saved. It is restored here; the file is as it was.',
  discard: 'Go back to the file', keep: 'Go on with it',
  conflict: 'Another program has changed this file.',
  conflictGone: 'Another program has removed this file.',
  takeTheirs: 'Take the file from the disk', keepMine: 'Keep mine and save over it',
  refreshed: 'Read again: another program has changed this file.',
  text: 'Text', signer: 'Signer', score: 'Score', problems: 'Problems', none: 'No problems.',
  rules: 'Rules', reasons: 'Reasons', versions: 'Versions', film: 'Film', settings: 'Settings',
  blocks: 'Blocks', commentsGone: 'Comments that went with it:',
  blockHelp: 'Drag a block, or choose one: Alt ↑ ↓ moves it, Delete removes it, Enter shows it in the text.',
  play: 'Play', pause: 'Pause', speed: 'Speed', time: 'Time', loopBlock: 'Repeat the block',
  before: 'One frame back', after: 'One frame on', camera: 'Camera',
  front: 'Front', side: 'Strong side', above: 'Above', hands: 'Hands', face: 'Face',
  search: 'Search rules by name or meaning', insert: 'Insert', found: 'found',
  noPicture: 'needs arguments', allRules: 'all libraries', ownRules: 'this text',
  body: 'Body', hand: 'Strong hand', right: 'right', left: 'left', rest: 'Arms at rest',
  hanging: 'hanging', folded: 'folded', ready: 'ready', tempo: 'Tempo', life: 'Breathe and blink',
  precise: 'Meet everything exactly', light: 'Background',
  export: 'Export', exporting: 'Writing …', exported: 'Downloaded', exportFailed: 'Not written:',
  met: 'met', eased: 'eased for comfort', missed: 'missed', off: 'off by', allowed: 'allowed',
  allMet: 'All constraints of this block are met.', chooseBlock: 'Constraints of',
  wholeText: 'the whole text', showMarks: 'Draw them on the body',
  solving: 'Solving …', loadingBody: 'Loading the body …', preparing: 'Starting the solver …',
  stopped: 'Given up:', mistakes: 'mistakes', mistake: 'mistake', warnings: 'warnings',
  warning: 'warning', nothing: 'Write a text; its signing appears here.',
  show: 'Look at it', restore: 'Take it', savedVersion: 'saved', typedVersion: 'typed',
  characters: 'characters', noVersions: 'No versions yet: each save makes one.',
  noFilms: 'There is no film in this folder (.mp4, .webm). ELAN’s films may lie beside the text.',
  chooseFilm: 'Film beside the signer', offset: 'The film starts at (seconds of the signing)',
  language: 'Language', close: 'Close', panels: 'Panels', help: 'Keys',
  noWebGL: 'This browser cannot draw the signer: it has no WebGL 2.',
  keys: [
    ['Ctrl S', 'save'], ['Ctrl Enter', 'play or pause'], ['Ctrl Space', 'complete'],
    ['F8', 'next problem'], ['F12', 'go to a definition'], ['F2', 'rename'],
    ['Shift Alt F', 'lay the text out'], ['F6', 'next part of the page'],
    ['← → ↑ ↓ in the score', 'go from block to block; Enter plays one'],
    ['Esc, then Tab', 'leave the editor'],
  ],
};

export type Words = Readonly<typeof ENGLISH>;

const FRENCH: Words = {
  title: 'azee studio',
  file: 'Fichier', newFile: 'Nouveau …', newName: 'Nom du nouveau texte, par exemple bonjour.azee',
  save: 'Enregistrer', saved: 'Enregistré', unsaved: 'Non enregistré ; gardé en brouillon',
  keeping: 'Mise de côté …',
  offline: 'Le serveur ne répond pas. Votre texte est gardé ici en attendant.',
  back: 'Le serveur répond de nouveau.',
  restored: 'Tapé auparavant et non enregistré. Repris ici ; le fichier est inchangé.',
  discard: 'Revenir au fichier', keep: 'Continuer',
  conflict: 'Un autre programme a modifié ce fichier.',
  conflictGone: 'Un autre programme a supprimé ce fichier.',
  takeTheirs: 'Prendre le fichier du disque', keepMine: 'Garder le mien et remplacer',
  refreshed: 'Relu : un autre programme a modifié ce fichier.',
  text: 'Texte', signer: 'Signeur', score: 'Partition', problems: 'Problèmes',
  none: 'Aucun problème.',
  rules: 'Règles', reasons: 'Raisons', versions: 'Versions', film: 'Film', settings: 'Réglages',
  blocks: 'Blocs', commentsGone: 'Commentaires partis avec :',
  blockHelp: 'Glissez un bloc, ou choisissez-en un : Alt ↑ ↓ le déplace, Suppr l’enlève, Entrée le montre dans le texte.',
  play: 'Jouer', pause: 'Pause', speed: 'Vitesse', time: 'Temps', loopBlock: 'Répéter le bloc',
  before: 'Image précédente', after: 'Image suivante', camera: 'Caméra',
  front: 'Face', side: 'Côté fort', above: 'Dessus', hands: 'Mains', face: 'Visage',
  search: 'Chercher une règle par nom ou sens', insert: 'Insérer', found: 'trouvées',
  noPicture: 'attend des arguments', allRules: 'toutes les bibliothèques', ownRules: 'ce texte',
  body: 'Corps', hand: 'Main forte', right: 'droite', left: 'gauche', rest: 'Bras au repos',
  hanging: 'pendants', folded: 'croisés', ready: 'prêts', tempo: 'Tempo',
  life: 'Respirer et cligner', precise: 'Tout atteindre exactement', light: 'Fond',
  export: 'Exporter', exporting: 'Écriture …', exported: 'Téléchargé',
  exportFailed: 'Non écrit :',
  met: 'atteinte', eased: 'relâchée par confort', missed: 'manquée', off: 'écart', allowed: 'permis',
  allMet: 'Toutes les contraintes de ce bloc sont atteintes.', chooseBlock: 'Contraintes de',
  wholeText: 'tout le texte', showMarks: 'Les dessiner sur le corps',
  solving: 'Calcul …', loadingBody: 'Chargement du corps …', preparing: 'Démarrage du calcul …',
  stopped: 'Abandonné :', mistakes: 'erreurs', mistake: 'erreur', warnings: 'avertissements',
  warning: 'avertissement', nothing: 'Écrivez un texte ; il est signé ici.',
  show: 'Regarder', restore: 'Reprendre', savedVersion: 'enregistrée', typedVersion: 'tapée',
  characters: 'caractères', noVersions: 'Aucune version : chaque enregistrement en fait une.',
  noFilms: 'Aucun film dans ce dossier (.mp4, .webm). Ceux d’ELAN peuvent être à côté du texte.',
  chooseFilm: 'Film à côté du signeur', offset: 'Le film commence à (secondes de la signation)',
  language: 'Langue', close: 'Fermer', panels: 'Volets', help: 'Touches',
  noWebGL: 'Ce navigateur ne peut pas dessiner le signeur : il n’a pas WebGL 2.',
  keys: [
    ['Ctrl S', 'enregistrer'], ['Ctrl Entrée', 'jouer ou arrêter'], ['Ctrl Espace', 'compléter'],
    ['F8', 'problème suivant'], ['F12', 'aller à une définition'], ['F2', 'renommer'],
    ['Maj Alt F', 'mettre en forme'], ['F6', 'partie suivante de la page'],
    ['← → ↑ ↓ dans la partition', 'aller de bloc en bloc ; Entrée en joue un'],
    ['Échap, puis Tab', 'quitter l’éditeur'],
  ],
};

export const LANGUAGES = { en: 'English', fr: 'Français' } as const;
export type Language = keyof typeof LANGUAGES;

export const wordsOf = (language: Language): Words => (language === 'fr' ? FRENCH : ENGLISH);

/** Returns the language that was chosen before, else the browser's if the page speaks it. */
export function chosenLanguage(): Language {
  const known = new URLSearchParams(location.search).get('lang') ?? localStorage.getItem('azee-lang');
  return (known ?? navigator.language).toLowerCase().startsWith('fr') ? 'fr' : 'en';
}
