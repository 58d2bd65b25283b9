"""Timed words from what users have: ELAN files, landmarks of a hand with their text, tables."""

from __future__ import annotations

import zipfile
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.corpus.annotations import Annotation, NotElanError, read_tiers
from azee.spelling.timing.alignment import aligned
from azee.spelling.timing.landmarks import JOINTS, LANDMARKS, joint_angles
from azee.spelling.timing.letter_poses import LetterPoses
from azee.spelling.timing.timed_word import TimedWord, TimesError, read_times

SUFFIXES = (".eaf", ".npz", ".csv")
WORDS_TIER, LETTERS_TIER = "words", "letters"
SHORTEST_S = 0.001
"""ELAN's times are whole milliseconds: letters that touch have a way of one."""


@dataclass(frozen=True, slots=True)
class Recorded:
    """A word and the second of its recording at which its first hold starts."""

    word: TimedWord
    start_s: float = 0.0


def read_recording(
    path: str | Path,
    poses: LetterPoses,
    tiers: tuple[str, str] = (WORDS_TIER, LETTERS_TIER),
) -> Sequence[Recorded]:
    """Read the words of a file; its suffix says what it is.

    Args: poses: of the letters, for landmarks; their joints are `landmarks.JOINTS`. tiers: of an
        ELAN file, that of words and that of the letters' holds.
    Raises: TimesError: the file cannot be used. NoElanLibraryError. OSError: it cannot be read.
    """
    match Path(path).suffix.lower():
        case ".eaf":
            found = _elan(path, *tiers)
        case ".npz":
            found = [_landmarks(path, poses)]
        case ".csv":
            return [Recorded(word) for word in read_times(path)]
        case _:
            raise TimesError(f"`{path}` is none of {' '.join(SUFFIXES)}")
    return _counted(found)


def _counted(found: Sequence[Recorded]) -> Sequence[Recorded]:
    """Count the spellings of each word."""
    seen: Counter[str] = Counter()
    counted = []
    for recorded in found:
        seen[recorded.word.word] += 1
        word = replace(recorded.word, spelling=seen[recorded.word.word])
        counted.append(replace(recorded, word=word))
    return counted


def _elan(path: str | Path, words_tier: str, letters_tier: str) -> Sequence[Recorded]:
    try:
        tiers = read_tiers(path)
    except NotElanError as error:
        raise TimesError(str(error)) from error
    words, holds = (_tier(path, tiers, name) for name in (words_tier, letters_tier))
    if not words:
        raise TimesError(f"`{path}`: the tier `{words_tier}` is empty")
    return [_annotated(path, word, holds) for word in words]


def _tier(
    path: str | Path, tiers: Mapping[str, Sequence[Annotation]], wanted: str
) -> Sequence[Annotation]:
    """Return a tier by its name in any case."""
    for name, tier in tiers.items():
        if name.lower() == wanted.lower():
            return tier
    known = ", ".join(f"`{name}`" for name in tiers) or "none"
    raise TimesError(f"`{path}` has no tier `{wanted}`; its tiers: {known}")


def _annotated(path: str | Path, word: Annotation, holds: Sequence[Annotation]) -> Recorded:
    """Return the word of an annotation, whose letters lie inside it."""
    inside = [h for h in holds if word.start_s <= (h.start_s + h.end_s) / 2 < word.end_s]
    name = word.text.strip().upper()
    spelled = "".join(hold.text.strip().upper() for hold in inside)
    place = f"`{path}`, {word.start_s:g} s"
    if not name or spelled != name:
        raise TimesError(f"{place}: the letters `{spelled}` stand under the word `{name}`")
    ways = tuple(max(SHORTEST_S, b.start_s - a.end_s) for a, b in pairwise(inside))
    try:
        timed = TimedWord(name, tuple(h.end_s - h.start_s for h in inside), ways)
    except TimesError as error:
        raise TimesError(f"{place}: {error}") from error
    return Recorded(timed, inside[0].start_s)


def _landmarks(path: str | Path, poses: LetterPoses) -> Recorded:
    """Align a word with the landmarks of a hand that spells it."""
    try:
        with np.load(path, allow_pickle=False) as file:
            missing = {"landmarks", "rate_hz", "text"} - set(file.files)
            if missing:
                raise TimesError(f"`{path}` has no array `{min(missing)}`")
            landmarks, rate_hz, text = file["landmarks"], float(file["rate_hz"]), str(file["text"])
    except TimesError:
        raise
    except (ValueError, KeyError, TypeError, AttributeError, EOFError, zipfile.BadZipFile) as error:
        raise TimesError(f"`{path}` is no NumPy archive, or a damaged one") from error
    if landmarks.ndim != 3 or landmarks.shape[1:] != (LANDMARKS, 3):
        raise TimesError(f"`{path}`: landmarks are (frames, 21, 3), not {landmarks.shape}")
    if not (np.isfinite(landmarks).all() and np.isfinite(rate_hz) and rate_hz > 0):
        raise TimesError(f"`{path}`: a landmark or the rate is no number")
    if poses.joints != JOINTS:
        raise TimesError("landmarks need letter poses of the same joints")
    frames = unwrapped(joint_angles(landmarks))
    word, start_s = aligned(text.strip().upper(), frames, rate_hz, poses)
    return Recorded(word, start_s)


def unwrapped(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return angles, (T, joints), without jumps by a whole turn between frames."""
    return np.asarray(np.unwrap(angles, axis=0))
