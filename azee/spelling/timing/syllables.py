"""Where a word written in letters can be parted into syllables, by its letters alone."""

from __future__ import annotations

VOWELS = frozenset("AEIOUYÄÖÜÂÎÛÀÉÈÊËÏÔÙŒIİ")
_ONSETS = "BL BR CH CL CR DR FL FR GL GR GH PH PL PR SC SH SK SL SM SN SP ST SW TH TR TW WH WR"
ONSETS = frozenset(_ONSETS.split())
"""Two consonants that begin a syllable together in English."""


def starts(word: str) -> tuple[int, ...]:
    """Return the index of the first letter of each syllable but the first.

    A syllable begins with one consonant, or two that may begin a word, before a vowel (the
    principle of maximal onsets). Neighbouring vowels stay together, and a last E makes none.
    """
    found = []
    vowel = [letter in VOWELS for letter in word]
    for index in range(2, len(word)):
        before = [i for i in range(index) if vowel[i]]
        if not vowel[index] or vowel[index - 1] or not before or word[index:] == "E":
            continue
        gap = index - before[-1] - 1
        onset = 2 if gap >= 2 and word[index - 2 : index] in ONSETS else 1
        found.append(index - onset)
    return tuple(found)
