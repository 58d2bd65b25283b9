"""Timed words from what users have: ELAN files, landmarks of a hand with their text, tables."""

from __future__ import annotations

import zipfile
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.spelling.timing.alignment import aligned
from azee.spelling.timing.landmarks import JOINTS, LANDMARKS, joint_angles
from azee.spelling.timing.letter_poses import LetterPoses
from azee.spelling.timing.timed_word import TimedWord, TimesError, read_times

SUFFIXES = (".eaf", ".npz", ".csv")
WORDS_TIER, LETTERS_TIER = "words", "letters"
SHORTEST_S = 0.001
"""ELAN's times are whole milliseconds: letters that touch have a way of one."""


class NoElanReaderError(Exception):
    """pympi, which reads ELAN files, is not installed."""


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
    Raises: TimesError: the file cannot be used. NoElanReaderError. OSError: it cannot be read.
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
        from pympi import Eaf
    except ImportError as error:
        raise NoElanReaderError("reading ELAN files needs pympi") from error
    with Path(path).open("rb"):
        pass  # pympi has no error of its own for a file that cannot be opened
    try:
        file = Eaf(str(path), suppress_version_warning=True)
        tiers = {name.lower(): name for name in file.get_tier_names()}
    except Exception as error:  # of any class: pympi does not check what it reads
        raise TimesError(f"`{path}` is no ELAN file, or a damaged one") from error
    for name in (words_tier, letters_tier):
        if name.lower() not in tiers:
            known = ", ".join(f"`{tier}`" for tier in tiers.values()) or "none"
            raise TimesError(f"`{path}` has no tier `{name}`; its tiers: {known}")
    words, holds = (
        sorted(row[:3] for row in file.get_annotation_data_for_tier(tiers[name.lower()]))
        for name in (words_tier, letters_tier)
    )
    if not words:
        raise TimesError(f"`{path}`: the tier `{words_tier}` is empty")
    return [_annotated(path, row, holds) for row in words]


def _annotated(
    path: str | Path, word: tuple[int, int, str], holds: Sequence[tuple[int, int, str]]
) -> Recorded:
    """Return the word of an annotation, whose letters lie inside it."""
    begin, end, text = word
    inside = [(a / 1000, b / 1000, t) for a, b, t in holds if begin <= (a + b) / 2 < end]
    name = text.strip().upper()
    spelled = "".join(letter.strip().upper() for _, _, letter in inside)
    place = f"`{path}`, {begin / 1000:g} s"
    if not name or spelled != name:
        raise TimesError(f"{place}: the letters `{spelled}` stand under the word `{name}`")
    ways = tuple(max(SHORTEST_S, later[0] - earlier[1]) for earlier, later in pairwise(inside))
    try:
        timed = TimedWord(name, tuple(b - a for a, b, _ in inside), ways)
    except TimesError as error:
        raise TimesError(f"{place}: {error}") from error
    return Recorded(timed, inside[0][0])


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
