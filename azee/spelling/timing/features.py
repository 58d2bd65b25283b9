"""What a letter's hold time may depend on: the ten features of Wheatland (2016), table 4.2."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

VOWELS = frozenset("AEIOU")
CLOSED = frozenset("AEMNST")
"""Hands that are fists. Which letters are open, closed or between is not published: ours."""
OPEN = frozenset("BFUVWDLKHRPGYZ")
"""Hands with straight fingers; all others are between."""

FEATURES = (
    "letter",
    "length",
    "previous",
    "next",
    "place",
    "index",
    "vowel",
    "double",
    "shape",
    "word",
)
"""In the order of table 4.2."""
CHOSEN = tuple(name for name in FEATURES if name != "shape")
"""The nine of them that the thesis keeps."""
GENERAL = tuple(name for name in CHOSEN if name != "word")
"""Those that a word has that was never recorded."""
NOTHING = "-"
"""What stands before the first letter and behind the last."""


def features(word: str, index: int) -> dict[str, str]:
    """Return the features of one letter of a word in capitals, as categories."""
    letter = word[index]
    before = word[index - 1] if index else NOTHING
    after = word[index + 1] if index + 1 < len(word) else NOTHING
    return {
        "letter": letter,
        "length": str(len(word)),
        "previous": before,
        "next": after,
        "place": place(word, index),
        "index": str(index + 1),
        "vowel": "vowel" if letter in VOWELS else "consonant",
        "double": "double" if letter in (before, after) else "single",
        "shape": shape(letter),
        "word": word,
    }


def place(word: str, index: int) -> str:
    """Return first, middle or last; the only letter of a word is its last."""
    if index + 1 == len(word):
        return "last"
    return "middle" if index else "first"


def shape(letter: str) -> str:
    """Return closed, open or intermediate."""
    if letter in CLOSED:
        return "closed"
    return "open" if letter in OPEN else "intermediate"


def has_double(word: str) -> bool:
    """Whether a letter of the word follows itself."""
    return any(a == b for a, b in pairwise(word))


def table(words: Sequence[str]) -> list[dict[str, str]]:
    """Return the features of every letter of some words."""
    return [features(word, index) for word in words for index in range(len(word))]
