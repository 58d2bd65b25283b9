"""Times drawn from the published statistics: no recording of spelled letters is public.

Whatever is fitted to them agrees with the statistics, and says nothing beyond them. The published
figures leave some things open; `LAST_LONGER`, `LETTER_S` and `NOISE_S` are assumptions of ours.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from azee.spelling.timing.features import has_double, place
from azee.spelling.timing.letter_poses import LetterPoses, asl_poses, rmsd
from azee.spelling.timing.published import (
    A_AND_T_S,
    BY_DIFFICULTY,
    CLASSES,
    CORRELATION,
    ELEPHANT_FASTER,
    FRAME_S,
    HOLD_S,
    REPEATED,
    REPEATED_FASTER,
    T_TO_A_S,
    TRANSITION_ERROR_S,
    TRANSITION_MEAN_S,
    TRANSITION_RANGE_S,
    WORDS,
    Style,
    length_class,
)
from azee.spelling.timing.timed_word import TimedWord

Array = NDArray[np.float64]

SHIPPED_SEED = 1
"""Of the draw that the shipped model is fitted to."""
LAST_LONGER: Mapping[Style, float] = {"normal": 1.6, "careful": 1.1}
"""The last letter's hold by the others': figure 4.3, without numbers, says that it is longer."""
LETTER_S = 0.010
"""Deviation of the letters' own hold times: not published."""
NOISE_S = 0.012
"""Deviation of one hold from what its word and letter explain: not published."""
DOUBLE_HOLD: Mapping[Style, float] = {"normal": 0.75, "careful": 0.9}
"""Holds in words with doubles by other words': with short double transitions, they make the whole
words faster by about what is published."""
_WORD_DEVIATION = {3: 0.28, 4: 0.20, 5: 0.09}
"""Of the words' own factors before they are brought to table 4.1."""


def drawn_words(seed: int = SHIPPED_SEED, style: Style = "normal") -> Sequence[TimedWord]:
    """Draw the 64 words of appendix B that make up 304 letters.

    Word means are brought exactly to table 4.1, transitions of normal spelling to the published
    mean, correlation and error, before they are rounded to frames of 120 Hz.
    """
    rng = np.random.default_rng(seed)
    poses = asl_poses()
    holds = _holds(rng, style)
    ways = _transitions(rng, poses)
    words = []
    for word in WORDS:
        times = _frames(holds[word], CLASSES)
        passed = [next(ways[pair]) for pair in pairwise(word)]
        words.append(TimedWord(word, tuple(map(float, times)), tuple(passed)))
    return words


def drawn_repetitions(seed: int = SHIPPED_SEED) -> Sequence[TimedWord]:
    """Draw the words that a text repeats: each spelling faster, the last by what is published."""
    rng = np.random.default_rng(seed)
    words = []
    for word, times in REPEATED.items():
        holds = _class_mean(word, "normal") + rng.normal(0, NOISE_S, len(word))
        ways = TRANSITION_MEAN_S + rng.normal(0, TRANSITION_ERROR_S, len(word) - 1)
        for number in range(1, times + 1):
            factor = 1.0 - REPEATED_FASTER * (number - 1) / (times - 1)
            held, passed = _frames(factor * holds, CLASSES), _frames(factor * ways)
            words.append(
                TimedWord(word, tuple(map(float, held)), tuple(map(float, passed)), number)
            )
    return words


def _holds(rng: np.random.Generator, style: Style) -> Mapping[str, Array]:
    """Draw the holds of each word, seconds, not yet rounded."""
    own = dict(zip("ABCDEFGHIJKLMNOPQRSTUVWXYZ", rng.normal(0, LETTER_S, 26), strict=True))
    factor = {word: _word_factor(word, rng, style) for word in WORDS}
    found: dict[str, Array] = {}
    for size, (mean, deviation) in HOLD_S[style].items():
        words = [word for word in WORDS if length_class(word) == size]
        raw = np.array([factor[word] for word in words])
        means = mean + deviation * (raw - raw.mean()) / raw.std()
        for word, word_mean in zip(words, means, strict=True):
            pattern = np.array([_pattern(word, i, style) for i in range(len(word))])
            letters = np.array([own[letter] for letter in word])
            noise = rng.normal(0, NOISE_S, len(word))
            times = word_mean * pattern / pattern.mean() + letters + noise
            found[word] = times + word_mean - times.mean()
    return found


def _word_factor(word: str, rng: np.random.Generator, style: Style) -> float:
    factor = 1.0 + rng.normal(0, _WORD_DEVIATION[length_class(word)])
    if word in BY_DIFFICULTY:
        easy, hard = BY_DIFFICULTY.index("ELEPHANT"), BY_DIFFICULTY.index("CRYPTOGRAPHY")
        steps = (BY_DIFFICULTY.index(word) - (easy + hard) / 2) / (hard - easy)
        factor = float((1.0 - ELEPHANT_FASTER) ** -steps)
    return factor * (DOUBLE_HOLD[style] if has_double(word) else 1.0)


def _pattern(word: str, index: int, style: Style) -> float:
    """Return a hold by the word's first one."""
    return LAST_LONGER[style] if place(word, index) == "last" else 1.0


def _transitions(
    rng: np.random.Generator, poses: LetterPoses
) -> Mapping[tuple[str, str], Iterator[float]]:
    """Draw the transitions of all words, a queue of times for every two letters.

    Doubles take the least time, A and T what is published. All others are a + b · RMSD + c · n,
    with n normal, between the fastest of them and the longest, which one of them takes. a, b and c
    make the mean, the correlation and the mean error of the regression the published ones.
    """
    pairs = [pair for word in WORDS for pair in pairwise(word)]
    apart = poses.distances(rmsd)
    d = np.array([apart[pair] for pair in pairs])
    normal = rng.normal(0, 1, len(pairs))
    most = TRANSITION_RANGE_S[1]
    fixed = np.array([_published_transition(*pair) for pair in pairs])

    def times(of: Array) -> Array:
        wanted = of[0] + of[1] * d + of[2] * normal
        free = np.clip(wanted, T_TO_A_S, most)
        free[np.where(np.isnan(fixed), wanted, 0.0).argmax()] = most
        return np.asarray(np.where(np.isnan(fixed), free, fixed))

    def beside_the_published(of: Array) -> Array:
        t = times(of)
        slope, offset = np.polyfit(d, t, 1)
        error_s = np.abs(slope * d + offset - t).mean()
        r = np.corrcoef(d, t)[0, 1] if d.std() * t.std() else 0.0
        return np.array(
            [
                (t.mean() - TRANSITION_MEAN_S) / TRANSITION_MEAN_S,
                r - CORRELATION["RMSD"],
                (error_s - TRANSITION_ERROR_S) / TRANSITION_ERROR_S,
            ]
        )

    of = least_squares(beside_the_published, [0.17, 0.08, 0.056]).x
    queues: dict[tuple[str, str], list[float]] = {}
    for pair, time in zip(pairs, _frames(times(of)), strict=True):
        queues.setdefault(pair, []).append(float(time))
    return {pair: iter(queue) for pair, queue in queues.items()}


def _published_transition(a: str, b: str) -> float:
    """Return what is published about the way between two letters, seconds; else NaN."""
    if a == b:
        return TRANSITION_RANGE_S[0]
    return {("T", "A"): T_TO_A_S, ("A", "T"): 1.5 * A_AND_T_S - 0.5 * T_TO_A_S}.get((a, b), np.nan)


def _frames(times: Array | float, most: int | None = None) -> Array:
    """Round to whole frames, at least one."""
    return np.asarray(np.clip(np.round(np.asarray(times) / FRAME_S), 1, most) * FRAME_S)


def _class_mean(word: str, style: Style) -> float:
    return HOLD_S[style][length_class(word)][0]
