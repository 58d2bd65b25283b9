"""Sounds of speech as a mouth shows them: SAMPA, visemes, and spellings of French and English.

SAMPA (Wells 1997) writes a sound with a letter or two. A viseme is what can be seen of a sound.
Few can be told apart, so few rules of spelling are enough; where they are wrong, a text gives the
sounds itself. Both tables are ours.
"""

from __future__ import annotations

import csv
import re
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

_DATA = Path(__file__).parent / "data"
LANGUAGES = ("fr", "en")
"""Languages whose spelling is known."""
VOWEL = "aàâäeéèêëiîïoôöuùûüyœæ"
CONSONANT = "bcçdfghjklmnpqrstvwxz"
_IGNORED = frozenset("\"%'.-|_ \t")
"""Marks of stress, syllables and words, which no mouth shows, and blanks."""


class UnknownSoundError(Exception):
    """A sign that stands for no sound that is known; `sign` is that sign."""

    def __init__(self, sign: str) -> None:
        super().__init__(sign)
        self.sign = sign


@dataclass(frozen=True, slots=True)
class Viseme:
    """What is seen of a sound: weights of facial morphs by name, and whether it is a vowel."""

    is_vowel: bool
    weights: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Sound:
    """A sound as SAMPA writes it, without its mark of length."""

    sampa: str
    is_long: bool = False

    @property
    def viseme(self) -> Viseme:
        """What is seen of it."""
        return visemes()[self.sampa]


@cache
def visemes() -> Mapping[str, Viseme]:
    """Return the viseme of every sound."""
    found: dict[str, Viseme] = {}
    with (_DATA / "visemes.csv").open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            names, weights = row["morphs"].split()[::2], row["morphs"].split()[1::2]
            shown = dict(zip(names, map(float, weights), strict=True))
            viseme = Viseme(row["kind"] == "vowel", shown)
            found |= dict.fromkeys(row["sounds"].split(), viseme)
    return found


def sounds_of(sampa: str) -> tuple[Sound, ...]:
    """Return the sounds that a text in SAMPA writes; `:` lengthens the one before it.

    Raises: UnknownSoundError: a sign is none of SAMPA, or `:` follows none.
    """
    known = visemes()
    found: list[Sound] = []
    i = 0
    while i < len(sampa):
        sign = sampa[i : i + 2] if sampa[i : i + 2] in known else sampa[i]
        i += len(sign)
        if sign in known:
            found.append(Sound(sign))
        elif sign == ":" and found:
            found[-1] = Sound(found[-1].sampa, is_long=True)
        elif sign not in _IGNORED:
            raise UnknownSoundError(sign)
    return tuple(found)


def spelled(text: str, language: str) -> str:
    """Return SAMPA for a text in the spelling of a language: `fr` or `en`.

    Raises: UnknownSoundError: a character has no sound, such as a digit.
    """
    words = re.findall(r"[^\W\d_]+|[\d_]|[^\w\s]", unicodedata.normalize("NFC", text).casefold())
    return " ".join(_word(word, language) for word in words if not _is_mark(word))


def _is_mark(word: str) -> bool:
    """Whether something is no word but punctuation, as an apostrophe or a full stop."""
    return len(word) == 1 and unicodedata.category(word).startswith("P")


def _word(word: str, language: str) -> str:
    padded = f"#{word}#"
    i, found = 1, ""
    while i <= len(word):
        for rule in _spellings()[language]:
            if rule.fits(padded, i):
                found += rule.sampa
                i += len(rule.letters)
                break
        else:
            raise UnknownSoundError(padded[i])
    return found


@dataclass(frozen=True, slots=True)
class _Spelling:
    """Letters that are read as sounds after and before what two patterns match."""

    letters: str
    after: re.Pattern[str]
    before: re.Pattern[str]
    sampa: str

    def fits(self, word: str, place: int) -> bool:
        end = place + len(self.letters)
        return (
            word.startswith(self.letters, place)
            and self.before.match(word, end) is not None
            and self.after.search(word[:place]) is not None
        )


@cache
def _spellings() -> Mapping[str, tuple[_Spelling, ...]]:
    """Return the spellings of each language: more letters first, else in the order of the table."""
    found: dict[str, list[_Spelling]] = {language: [] for language in LANGUAGES}
    for row in _rows():
        after, before = _pattern(row["after"]), _pattern(row["before"])
        rule = _Spelling(
            row["letters"], re.compile(f"(?:{after})$"), re.compile(before), row["sounds"]
        )
        found[row["language"]].append(rule)
    return {
        language: tuple(sorted(rules, key=lambda rule: -len(rule.letters)))
        for language, rules in found.items()
    }


def _rows() -> Iterator[dict[str, str]]:
    with (_DATA / "spellings.csv").open(encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file)


def _pattern(context: str) -> str:
    """Return the regular expression of a context: `V` and `C` are vowels and consonants.

    `#` is the end of the word, `.` any letter.
    """
    inside, out = False, ""
    for sign in context:
        inside = sign == "[" or (inside and sign != "]")
        letters = {"V": VOWEL, "C": CONSONANT, ".": VOWEL + CONSONANT}.get(sign)
        out += sign if letters is None else letters if inside else f"[{letters}]"
    return out
