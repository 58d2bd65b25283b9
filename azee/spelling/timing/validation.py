"""How well hold times are foretold: for letters that were learnt, left out, or in unknown words.

Naive Bayes and ridge regression are fitted anew for every letter or word that is left out. Needs
scikit-learn (extra `spelling`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray
from sklearn.model_selection import LeaveOneGroupOut, LeaveOneOut
from threadpoolctl import threadpool_limits

from azee.spelling.timing.features import CHOSEN
from azee.spelling.timing.fitting import (
    SMOOTHING,
    Rows,
    fit_naive_bayes,
    fit_ridge,
    letters,
)
from azee.spelling.timing.holds import NO_SMOOTHING, HoldModel, HoldName, NaiveBayes
from azee.spelling.timing.published import CONSTANT_HOLD_S, CONSTANT_LAST_S, FRAME_S
from azee.spelling.timing.timed_word import TimedWord

Array = NDArray[np.float64]
Fit: TypeAlias = Callable[[Rows, Array, Sequence[str]], HoldModel]
Scheme: TypeAlias = Literal["resubstitution", "one left out", "words held out"]
SCHEMES: tuple[Scheme, ...] = get_args(Scheme)


def _printed(rows: Rows, holds_s: Array, features: Sequence[str]) -> HoldModel:
    return fit_naive_bayes(rows, holds_s, features, smoothing=NO_SMOOTHING)


def _mean(rows: Rows, holds_s: Array, features: Sequence[str]) -> HoldModel:
    return fit_naive_bayes(rows, holds_s, features, smoothing=SMOOTHING, answer="mean")


FITS: dict[HoldName, Fit] = {
    "naive-bayes": _printed,
    "naive-bayes-mean": _mean,
    "ridge": fit_ridge,
}


@dataclass(frozen=True, eq=False)
class Errors:
    """predicted_s and true_s: (N,) hold times of letters; they are compared by class and time."""

    predicted_s: Array
    true_s: Array

    @property
    def accuracy(self) -> float:
        """Share of letters whose hold is right to the frame of 120 Hz."""
        return float(np.mean(_frame(self.predicted_s) == _frame(self.true_s)))

    @property
    def error_s(self) -> float:
        """Mean of |predicted − true|."""
        return float(np.abs(self.predicted_s - self.true_s).mean())

    @property
    def bias_s(self) -> float:
        """Mean of true − predicted: above 0 where predictions are too fast, as in the thesis."""
        return float((self.true_s - self.predicted_s).mean())

    @property
    def standard_error_s(self) -> float:
        """Standard error of `error_s`."""
        return _standard_error(np.abs(self.predicted_s - self.true_s))

    @property
    def accuracy_standard_error(self) -> float:
        """Standard error of `accuracy`."""
        return _standard_error((_frame(self.predicted_s) == _frame(self.true_s)).astype(float))

    def to_json(self) -> dict[str, Any]:
        """Return the figures in per cent and milliseconds."""
        return {
            "letters": len(self.true_s),
            "accuracy_percent": round(100 * self.accuracy, 2),
            "error_ms": round(1000 * self.error_s, 2),
            "bias_ms": round(1000 * self.bias_s, 2),
        }


def validated(
    words: Sequence[TimedWord],
    model: HoldName,
    scheme: Scheme,
    features: Sequence[str] = CHOSEN,
) -> Errors:
    """Foretell every hold by a model that has, or has not, learnt it."""
    rows, holds_s = letters(words)
    features = [name for name in features if scheme != "words held out" or name != "word"]
    predicted = np.zeros(len(rows))
    with threadpool_limits(1):  # tables of this size only wait for more threads
        whole = FITS[model](rows, holds_s, features)
        if scheme == "one left out" and isinstance(whole, NaiveBayes):
            one_gone = (whole.without(row, t) for row, t in zip(rows, holds_s, strict=True))
            predicted[:] = [m.hold_of(row) for m, row in zip(one_gone, rows, strict=True)]
            return Errors(predicted, holds_s)
        for learnt, told in _splits(words, scheme, len(rows)):
            fitted = FITS[model]([rows[i] for i in learnt], holds_s[learnt], features)
            predicted[told] = [fitted.hold_of(rows[i]) for i in told]
    return Errors(predicted, holds_s)


def _splits(
    words: Sequence[TimedWord], scheme: Scheme, count: int
) -> Iterator[tuple[NDArray[np.intp], NDArray[np.intp]]]:
    """Yield the letters to learn from and those to foretell."""
    everything = np.arange(count)
    match scheme:
        case "resubstitution":
            yield everything, everything
        case "one left out":
            yield from LeaveOneOut().split(everything)
        case "words held out":
            groups = [word.word for word in words for _ in word.word]
            yield from LeaveOneGroupOut().split(everything, groups=groups)


def with_training_share(
    words: Sequence[TimedWord],
    model: HoldName,
    letters_kept: int,
    rng: np.random.Generator,
    times: int = 10,
) -> Errors:
    """Foretell all letters from some of them, as figure 4.6 does; drawn anew so many times."""
    rows, holds_s = letters(words)
    predicted = []
    for _ in range(times):
        kept = rng.permutation(len(rows))[:letters_kept]
        fitted = FITS[model]([rows[i] for i in kept], holds_s[kept], CHOSEN)
        predicted.append([fitted.hold_of(row) for row in rows])
    return Errors(np.concatenate(predicted), np.tile(holds_s, times))


def constant_errors(words: Sequence[TimedWord], *, last_longer: bool) -> Errors:
    """Return the errors of the constant model, with its 800 ms for the last letter or without."""
    last = CONSTANT_LAST_S if last_longer else CONSTANT_HOLD_S
    predicted = [t for w in words for t in [CONSTANT_HOLD_S] * (len(w.word) - 1) + [last]]
    return Errors(np.array(predicted), letters(words)[1])


def _frame(times_s: Array) -> NDArray[np.int64]:
    return np.asarray(np.round(times_s / FRAME_S), dtype=np.int64)


def _standard_error(values: Array) -> float:
    return float(values.std(ddof=1) / np.sqrt(len(values)))
