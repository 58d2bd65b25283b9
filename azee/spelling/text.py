"""Texts that are spelled: which of their characters an alphabet has, and the expression of them.

The libraries of the alphabets say by their rule `spelled-as` which rule spells a character. What
no rule spells is left out and told.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Literal, TypeAlias, get_args

from azee.lang.library import shipped_library
from azee.lang.program import load
from azee.lang.values import TextValue
from azee_grammar.source import Source

Language: TypeAlias = Literal["asl", "lsf", "tid"]
LANGUAGES: tuple[Language, ...] = get_args(Language)
TextMode: TypeAlias = Literal["letters", "thesis", "words"]
TEXT_MODES: tuple[TextMode, ...] = get_args(TextMode)

_THESIS = str.maketrans("iCGIOSU", "İÇĞIÖŞÜ")
"""Characters in the lists of Gürel (2010, section 5.2): small letters are those of English, and a
capital stands for the Turkish letter that is like it."""
_THESIS_LETTERS = frozenset("abcdefghijklmnoprstuvyzCGIOSU")
PAUSE_S = 0.5
"""Between words: Gürel (2010) has a sign for it, which is a pause."""


@dataclass(frozen=True, slots=True)
class Word:
    """A word of a text.

    characters: those that the alphabet has, one each, as the rule `fingerspelling` reads them.
    letters: what they are in the alphabet, such as `İ` or `5`. sign: the rule that signs the word
    as a whole; such a word is not spelled.
    """

    characters: tuple[str, ...]
    letters: tuple[str, ...]
    sign: str | None = None


@dataclass(frozen=True, slots=True)
class SpelledText:
    """The words of a text, and its characters that the alphabet lacks, each once, in order."""

    language: Language
    words: tuple[Word, ...]
    unknown: tuple[str, ...]

    def expression(self, times: Sequence[Sequence[tuple[float, float]]]) -> str:
        """Return the AZee expression of the text.

        Args: times: of each word a hold and the transition after it for every letter, seconds.
            Those of words that are signed are not read.
        """
        parts = [
            f":{word.sign}" if word.sign else _word(word, self.language, of)
            for word, of in zip(self.words, times, strict=True)
        ]
        return f"seq(list({', '.join(parts)}), 'gap = {PAUSE_S:g})" if len(parts) > 1 else parts[0]


def spelled(text: str, language: Language, mode: TextMode = "letters") -> SpelledText:
    """Read a text for an alphabet.

    Case follows the language: in Turkish `i` is the letter İ and `I` the letter I without a dot.

    Args: mode: letters: every word is spelled. thesis: as in Gürel (2010), where `g` is G and `G`
        stands for Ğ. words: words with a sign in the language's library are signed.
    """
    unknown: dict[str, None] = {}
    words = []
    for written in unicodedata.normalize("NFC", text).split():
        sign = _sign(written, language) if mode == "words" else None
        known = [] if sign else [*_known(written, language, mode, unknown)]
        if sign or known:
            words.append(Word(tuple(c for c, _ in known), tuple(n for _, n in known), sign))
    return SpelledText(language, tuple(words), tuple(unknown))


def _known(
    written: str, language: Language, mode: TextMode, unknown: dict[str, None]
) -> Iterator[tuple[str, str]]:
    """Yield the characters that the alphabet has with their letters; note the others."""
    for character in written:
        if mode == "thesis" and character not in _THESIS_LETTERS and not character.isdigit():
            unknown[character] = None
            continue
        meant = character.translate(_THESIS) if mode == "thesis" else character
        letter = _letter(meant, language)
        if letter is None:
            unknown[character] = None
        else:
            yield meant, letter


@cache
def _letter(character: str, language: Language) -> str | None:
    """Return what a character is in an alphabet, none if its library has no rule for it."""
    if not character.isalnum():
        return None
    asked = f'apply(rule("spelled-as", \'of = \'{language}), \'character = "{character}")'
    found = load(Source("<spelled>", "")).value(asked)
    name = found.content if isinstance(found, TextValue) else ""
    rules = shipped_library(language).namespace.rules
    return name.partition("-")[2] if name in rules else None


def _sign(written: str, language: Language) -> str | None:
    """Return the rule of a library that signs a word by itself."""
    rules = shipped_library(language).namespace.rules
    for name in (written, written.lower()):
        rule = rules.get(name)
        if rule is not None and not any(needed for _, needed in rule.parameters):
            return name
    return None


def _word(word: Word, language: Language, times: Sequence[tuple[float, float]]) -> str:
    rows = ", ".join(f"list({hold:.4f}, {way:.4f})" for hold, way in times)
    text = "".join(word.characters)
    return f":fingerspelling('text = \"{text}\", 'language = '{language}, 'times = list({rows}))"
