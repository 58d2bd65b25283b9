"""How transition times go with distances of letter poses: the four metrics of section 4.2.2."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.spelling.timing.latent_space import latent_distances
from azee.spelling.timing.letter_poses import LetterPoses, chebyshev, manhattan, rmsd
from azee.spelling.timing.timed_word import TimedWord

Array = NDArray[np.float64]
Distances = Mapping[tuple[str, str], float]


@dataclass(frozen=True, eq=False)
class Regression:
    """Transition times, (N,) seconds, and distances of the letters, (N,); and the line of both."""

    distances: Array
    times_s: Array

    @property
    def line(self) -> tuple[float, float]:
        """Slope and offset."""
        slope, offset = np.polyfit(self.distances, self.times_s, 1)
        return float(slope), float(offset)

    @property
    def r(self) -> float:
        """Pearson's correlation."""
        return float(np.corrcoef(self.distances, self.times_s)[0, 1])

    @property
    def errors_s(self) -> Array:
        """|predicted − true|, (N,)."""
        return np.asarray(np.abs(np.polyval(self.line, self.distances) - self.times_s))


def all_distances(poses: LetterPoses) -> Mapping[str, Distances]:
    """Return the distances of every two letters, by the metric's name."""
    latent = latent_distances(poses.angles)
    return {
        "RMSD": poses.distances(rmsd),
        "MD": poses.distances(manhattan),
        "CD": poses.distances(chebyshev),
        "GPLVMD": {
            (a, b): float(latent[i, j])
            for i, a in enumerate(poses.letters)
            for j, b in enumerate(poses.letters)
        },
    }


def regressions(words: Sequence[TimedWord], poses: LetterPoses) -> Mapping[str, Regression]:
    """Fit transition times, doubles too, to each metric; letters without a pose are left out."""
    found = [
        (pair, time)
        for word in words
        for pair, time in zip(pairwise(word.word), word.transitions_s, strict=True)
        if pair[0] in poses and pair[1] in poses
    ]
    times = np.array([time for _, time in found])
    return {
        name: Regression(np.array([apart[pair] for pair, _ in found]), times)
        for name, apart in all_distances(poses).items()
    }
