"""What an exported page can play: letters of an alphabet, texts in AZee, signs of a database."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from azee.compilation import Compilation, perform, score_of
from azee.lang.program import load
from azee.player.export import Entry, Vocabulary
from azee.player.performing import LOCALES, TITLES
from azee.signs.database import SignDatabase
from azee.signs.query import Query
from azee.signs.sign import Sign
from azee.spelling.text import Language, spelled
from azee_grammar.files import read_source
from azee_grammar.source import Source as Text
from azee_rig.rig import Rig

HOLD_S = 0.25
"""How long a letter is held; a transition from one to the next comes on top."""
CHARACTERS = "ABCÇDEFGĞHIİJKLMNOÖPQRSŞTUÜVWXYZ0123456789"
"""Characters that any of the alphabets has."""


def letters(language: Language, rig: Rig, characters: str = CHARACTERS) -> Vocabulary:
    """Return those letters and digits that an alphabet has of some characters, a clip each."""
    found = {w.letters[0]: w for c in characters for w in spelled(c, language).words}

    def entries() -> Iterator[Entry]:
        for letter in found:
            expression = spelled(letter, language).expression([[(HOLD_S, 0.0)]])
            yield _entry(
                letter, perform(load(Text("<letter>", "")).evaluate(expression).score, rig)
            )

    title, locale = TITLES[language], LOCALES[language]
    return Vocabulary(language, "letters", title, locale, len(found), entries)


def texts(paths: Sequence[Path], rig: Rig, libraries: Sequence[Path] = ()) -> Vocabulary:
    """Return texts in AZee, each by the name of its file. Entries raise AZeeError."""

    def entries() -> Iterator[Entry]:
        for path in paths:
            program = load(read_source(path), libraries)
            yield _entry(path.stem, perform(score_of(program, None, None), rig))

    return Vocabulary("texts", "words", "AZee", "", len(paths), entries)


def signs(database: SignDatabase, rig: Rig, language: str | None = None) -> Vocabulary:
    """Return the signs of a database, of each name the first. Entries raise SignsError."""
    found: dict[str, Sign] = {}
    for sign in database.find(Query(language=language)):
        found.setdefault(sign.identity.name, sign)

    def entries() -> Iterator[Entry]:
        for name, sign in found.items():
            timing = sign.facts.timing
            yield Entry(name, database.clip(sign, rig), timing.attack_s, timing.decay_s)

    name = database.store.name
    return Vocabulary("signs", "words", Path(name).name, language or "", len(found), entries)


def _entry(name: str, made: Compilation) -> Entry:
    lead_s, score_s = made.report.lead_s, made.report.score_s
    return Entry(name, made.clip, lead_s, max(0.0, made.clip.duration_s - lead_s - score_s))
