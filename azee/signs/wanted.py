"""Which signs a text asks for: one a character, or one a word.

Gürel (2010, section 5.2) types a sign as a character, a space among them: small letters as in
English, and a capital for the Turkish letter that is like it, so that `G` asks for ğ.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

TextMode: TypeAlias = Literal["thesis", "turkish", "words"]
TEXT_MODES: tuple[TextMode, ...] = get_args(TextMode)

SPACE = "space"
"""The name of the sign for a space, which a database has as little as any other by itself."""
_THESIS = str.maketrans({"C": "ç", "G": "ğ", "I": "ı", "O": "ö", "S": "ş", "U": "ü", " ": SPACE})
_THESIS_CAPITALS = frozenset("CGIOSU")
_SMALL = str.maketrans({"I": "ı", "İ": "i"})
_CAPITAL = str.maketrans({"ı": "I", "i": "İ"})
_AROUND = "\"'.,;:!?()[]{}<>«»“”„‘’…¡¿-–—"
"""Punctuation that is no part of a word at its ends."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """A sign that a text asks for. names: what it may be called, the best first."""

    text: str
    names: tuple[str, ...]


def wanted(text: str, mode: TextMode) -> tuple[Wanted, ...]:
    """Return the signs that a text asks for, in order.

    thesis: a sign a character; capitals that stand for no Turkish letter have no sign. turkish: a
    sign a character, whose case does not matter: the small letter of I is ı, that of İ is i. words:
    a sign a word, whose case does not matter.
    """
    composed = unicodedata.normalize("NFC", text)
    if mode == "words":
        words = (word.strip(_AROUND) for word in composed.split())
        return tuple(Wanted(word, _distinct(_cases(word))) for word in words if word)
    characters = (" " if c.isspace() else c for c in composed.strip())
    if mode == "thesis":
        return tuple(Wanted(c, _thesis_names(c)) for c in characters)
    return tuple(Wanted(c, (SPACE,) if c == " " else _turkish_names(c)) for c in characters)


def _thesis_names(character: str) -> tuple[str, ...]:
    if character.isupper() and character not in _THESIS_CAPITALS:
        return ()
    if character.isascii():
        meant = character.translate(_THESIS)
        # A database as the thesis has it calls the sign of ğ by what is typed.
        return _distinct((character if character != " " else meant, meant, turkish_capital(meant)))
    return ()


def _turkish_names(character: str) -> tuple[str, ...]:
    small = turkish_small(character)
    return _distinct((small, turkish_capital(small)))


def turkish_small(text: str) -> str:
    """Return a text in small letters, as Turkish has them; `str.lower` makes i of I."""
    return text.translate(_SMALL).lower()


def turkish_capital(text: str) -> str:
    """Return a text in capitals, as Turkish has them."""
    return text.translate(_CAPITAL).upper()


def _cases(word: str) -> Iterator[str]:
    yield word
    yield word.lower()
    yield word.upper()
    yield turkish_small(word)
    yield turkish_capital(word)
    yield word.capitalize()


def _distinct(names: Iterator[str] | tuple[str, ...]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(names))
