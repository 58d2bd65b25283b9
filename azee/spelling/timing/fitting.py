"""Fits a timing model to timed words. Needs scikit-learn (extra `spelling`)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from sklearn.feature_extraction import DictVectorizer
from sklearn.linear_model import Ridge as RidgeRegression
from sklearn.naive_bayes import CategoricalNB
from sklearn.preprocessing import OrdinalEncoder

from azee.spelling.timing.features import CHOSEN, table
from azee.spelling.timing.holds import NO_SMOOTHING, NaiveBayes, Ridge
from azee.spelling.timing.letter_poses import LetterPoses, asl_poses, rmsd
from azee.spelling.timing.model import TimingModel
from azee.spelling.timing.published import FRAME_S, REPEATED, REPEATED_FASTER
from azee.spelling.timing.timed_word import TimedWord, TimesError
from azee.spelling.timing.transitions import Transitions

Array = NDArray[np.float64]
Rows = Sequence[Mapping[str, str]]

SMOOTHING = 0.05
"""Added to counts by `naive-bayes-mean`; 1, Laplace's, drowns what 304 letters say."""
PENALTY = 3.0
"""Of the ridge regression: 1 to 10 differ by less than .2 ms on held-out words."""
LEAST_LETTERS = 20
"""Fewer say nothing about ten features."""


def fit_model(
    words: Sequence[TimedWord], origin: str, poses: LetterPoses | None = None
) -> TimingModel:
    """Fit hold times and transitions.

    Raises: TimesError: there are too few letters, or no transitions between two known letters.
    """
    rows, holds_s = letters(words)
    if len(rows) < LEAST_LETTERS:
        raise TimesError(f"{len(rows)} letters are too few; a model needs {LEAST_LETTERS}")
    return TimingModel(
        origin,
        tuple(words),
        {
            "ridge": fit_ridge(rows, holds_s),
            "naive-bayes": fit_naive_bayes(rows, holds_s),
            "naive-bayes-mean": fit_naive_bayes(rows, holds_s, smoothing=SMOOTHING, answer="mean"),
        },
        fit_transitions(words, poses or asl_poses()),
        fit_practice(words),
    )


def letters(words: Sequence[TimedWord]) -> tuple[Rows, Array]:
    """Return the features of all letters and their hold times, (N,) seconds."""
    return table([w.word for w in words]), np.array([t for w in words for t in w.holds_s])


def fit_naive_bayes(
    rows: Rows,
    holds_s: Array,
    features: Sequence[str] = CHOSEN,
    *,
    smoothing: float = NO_SMOOTHING,
    answer: Literal["likeliest", "mean"] = "likeliest",
) -> NaiveBayes:
    """Count which features went with which class of hold times, frames of 120 Hz."""
    classes = np.maximum(1, np.round(holds_s / FRAME_S)).astype(int)
    encoder = OrdinalEncoder()
    values = encoder.fit_transform([[row[name] for name in features] for row in rows])
    counted = CategoricalNB(alpha=smoothing, force_alpha=True).fit(values, classes)
    return NaiveBayes(
        counted.classes_ * FRAME_S,
        counted.class_count_,
        {
            name: dict(zip(map(str, known), seen.T, strict=True))
            for name, known, seen in zip(
                features, encoder.categories_, counted.category_count_, strict=True
            )
        },
        smoothing,
        answer,
    )


def fit_ridge(
    rows: Rows, holds_s: Array, features: Sequence[str] = CHOSEN, penalty: float = PENALTY
) -> Ridge:
    """Fit a mean and a part of each value of each feature; the mean is not penalised."""
    vectorizer = DictVectorizer(sparse=False, separator="\0")
    ones = vectorizer.fit_transform([{name: row[name] for name in features} for row in rows])
    fitted = RidgeRegression(penalty).fit(ones, holds_s)
    parts: dict[str, dict[str, float]] = {name: {} for name in features}
    for column, part in zip(vectorizer.get_feature_names_out(), fitted.coef_, strict=True):
        name, _, value = column.partition("\0")
        parts[name][value] = float(part)
    return Ridge(float(fitted.intercept_), parts)


def fit_transitions(
    words: Sequence[TimedWord], poses: LetterPoses
) -> dict[Literal["with-doubles", "regression"], Transitions]:
    """Fit transition times to RMSD: to all of them, and to those without doubles.

    Raises: TimesError: there are not three transitions between letters whose poses are known.
    """
    found = [
        (rmsd(*poses.of((a, b))), time, a == b)
        for word in words
        for (a, b), time in zip(pairwise(word.word), word.transitions_s, strict=True)
        if a in poses and b in poses
    ]
    apart, times, double = (
        (np.array(column) for column in zip(*found, strict=True)) if found else (np.zeros(0),) * 3
    )
    single = double == 0
    if len(set(apart[single].round(9))) < 3:
        raise TimesError("transitions between three different pairs of known letters are needed")
    slope, offset = np.polyfit(apart, times, 1)
    own_slope, own_offset = np.polyfit(apart[single], times[single], 1)
    mean = float(times[single].mean())
    double_s = float(times[~single].mean()) if (~single).any() else None
    return {
        "with-doubles": Transitions(float(own_offset), float(own_slope), mean, double_s),
        "regression": Transitions(float(offset), float(slope), mean),
    }


def fit_practice(words: Sequence[TimedWord]) -> float:
    """Return the exponent p by which the n-th spelling of a word is faster, n ** -p.

    Where no word is spelled repeatedly, it is that of the published figures.
    """
    spellings: dict[str, list[tuple[int, float]]] = defaultdict(list)
    for word in words:
        spellings[word.word].append((word.spelling, word.duration_s))
    ways = [
        (np.log(number / first[0]), np.log(first[1] / duration))
        for (first, *later) in (sorted(found) for found in spellings.values())
        for number, duration in later
        if number > first[0]
    ]
    if not ways:
        return published_practice()
    n, faster = np.array(ways).T
    return float((n @ faster) / (n @ n))


def published_practice() -> float:
    """Return the exponent of the published figures: 20 % faster after 3 and after 5 spellings."""
    n = np.log(list(REPEATED.values()))
    return float(n.sum() * -np.log(1 - REPEATED_FASTER) / (n @ n))
