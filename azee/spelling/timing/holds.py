"""How long a letter is held: the published classifier, and two models that miss by less."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from azee.spelling.timing.features import features
from azee.spelling.timing.published import FRAME_S

Array = NDArray[np.float64]
HoldName: TypeAlias = Literal["ridge", "naive-bayes", "naive-bayes-mean"]
HOLD_NAMES: tuple[HoldName, ...] = get_args(HoldName)

NO_SMOOTHING = 1e-9
"""In the place of counts of 0: equation 4.3 as printed has no answer where all its products are."""
LEAST_S = FRAME_S
"""No letter is held for less than a frame."""


@dataclass(frozen=True, eq=False)
class NaiveBayes:
    """Classes of hold times and how often each feature went with them.

    classes_s: (C,). class_counts: (C,) letters of each class. counts: for each feature, for each
    of its values that was seen, (C,) letters. smoothing: what is added to every count.
    answer: the class of the largest probability, as printed, or the mean over all of them.
    """

    classes_s: Array
    class_counts: Array
    counts: Mapping[str, Mapping[str, Array]]
    smoothing: float = NO_SMOOTHING
    answer: Literal["likeliest", "mean"] = "likeliest"

    def hold_s(self, word: str, index: int) -> float:
        """Return the hold time of a letter of a word in capitals."""
        return self.hold_of(features(word, index))

    def hold_of(self, traits: Mapping[str, str]) -> float:
        """Return the hold time of a letter with some features."""
        p = self.probabilities(traits)
        if self.answer == "likeliest":
            return float(self.classes_s[p.argmax()])
        return float(p @ self.classes_s)

    def probabilities(self, traits: Mapping[str, str]) -> Array:
        """Return the probability of each class, (C,).

        P(C|d) = P(d₁|C) … P(dₙ|C) P(C) / (P(d₁) … P(dₙ)) (Wheatland 2016, equation 4.3); the
        denominator is the same for all classes. A value that was never seen says nothing, so that
        the word counts only where it is known (section 4.2.1).
        """
        with np.errstate(divide="ignore"):
            log_p = np.log(self.class_counts / self.class_counts.sum())
        for name, by_value in self.counts.items():
            seen = by_value.get(traits[name])
            if seen is not None:
                whole = self.class_counts + self.smoothing * len(by_value)
                log_p += np.log((seen + self.smoothing) / whole)
        p = np.exp(log_p - log_p.max())
        return np.asarray(p / p.sum())

    def without(self, traits: Mapping[str, str], hold_s: float) -> NaiveBayes:
        """Return what would have been counted without one of the letters."""
        gone = np.zeros(len(self.classes_s))
        gone[np.abs(self.classes_s - hold_s).argmin()] = 1.0
        left = self.class_counts - gone
        kept = left > 0
        return replace(
            self,
            classes_s=self.classes_s[kept],
            class_counts=left[kept],
            counts={
                name: {
                    value: counted[kept]
                    for value, seen in by_value.items()
                    if (counted := seen - gone if value == traits[name] else seen).any()
                }
                for name, by_value in self.counts.items()
            },
        )

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON values; counts of each value by the number of the class."""
        return {
            "classes_ms": [round(1000 * float(t), 3) for t in self.classes_s],
            "class_counts": self.class_counts.astype(int).tolist(),
            "counts": {
                name: {
                    value: {str(i): int(n) for i, n in enumerate(seen) if n}
                    for value, seen in by_value.items()
                }
                for name, by_value in self.counts.items()
            },
            "smoothing": self.smoothing,
            "answer": self.answer,
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> NaiveBayes:
        """Read what `to_json` wrote. Raises: KeyError, TypeError, ValueError, IndexError."""
        number = len(data["classes_ms"])
        return cls(
            np.array(data["classes_ms"], dtype=np.float64) / 1000,
            np.array(data["class_counts"], dtype=np.float64),
            {
                name: {value: _spread(seen, number) for value, seen in by_value.items()}
                for name, by_value in data["counts"].items()
            },
            float(data["smoothing"]),
            data["answer"],
        )


def _spread(seen: Mapping[str, int], number: int) -> Array:
    counts = np.zeros(number)
    for index, count in seen.items():
        counts[int(index)] = count
    return counts


@dataclass(frozen=True, eq=False)
class Ridge:
    """A hold time as a sum: a mean and a part of each feature. Ours; not in the thesis.

    parts_s: for each feature and value, seconds; a value that was never seen adds nothing.
    """

    mean_s: float
    parts_s: Mapping[str, Mapping[str, float]]

    def hold_s(self, word: str, index: int) -> float:
        """Return the hold time of a letter of a word in capitals."""
        return self.hold_of(features(word, index))

    def hold_of(self, traits: Mapping[str, str]) -> float:
        """Return the hold time of a letter with some features."""
        parts = (by_value.get(traits[name], 0.0) for name, by_value in self.parts_s.items())
        return max(LEAST_S, self.mean_s + sum(parts))

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON values."""
        return {
            "mean_ms": round(1000 * self.mean_s, 4),
            "parts_ms": {
                name: {value: round(1000 * part, 4) for value, part in by_value.items()}
                for name, by_value in self.parts_s.items()
            },
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Ridge:
        """Read what `to_json` wrote. Raises: KeyError, TypeError, ValueError."""
        return cls(
            float(data["mean_ms"]) / 1000,
            {
                name: {value: float(part) / 1000 for value, part in by_value.items()}
                for name, by_value in data["parts_ms"].items()
            },
        )


HoldModel: TypeAlias = NaiveBayes | Ridge
