"""Joint angles of the letters of an alphabet, and how far they are from each other."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Metric: TypeAlias = Callable[[Array, Array], float]


@dataclass(frozen=True, eq=False)
class LetterPoses:
    """letters: one character each. joints: names of the angles. angles: (letters, joints) radians.

    Raises: ValueError: the arrays do not fit each other.
    """

    letters: tuple[str, ...]
    joints: tuple[str, ...]
    angles: Array

    def __post_init__(self) -> None:
        if self.angles.shape != (len(self.letters), len(self.joints)):
            raise ValueError("letter poses have one row a letter and one angle a joint")
        if not np.isfinite(self.angles).all():
            raise ValueError("an angle of a letter pose is no number")
        angles = np.array(self.angles)
        angles.setflags(write=False)
        object.__setattr__(self, "angles", angles)

    def __contains__(self, letter: str) -> bool:
        return letter in self.letters

    def of(self, letters: Iterable[str]) -> Array:
        """Return the angles of some letters, a row each. Raises: KeyError: one is unknown."""
        rows = dict(zip(self.letters, self.angles, strict=True))
        return np.array([rows[letter] for letter in letters]).reshape(-1, len(self.joints))

    def distances(self, metric: Metric) -> Mapping[tuple[str, str], float]:
        """Return the distance of every two letters, either way; 0 of a letter from itself."""
        return {
            (a, b): metric(p, q)
            for a, p in zip(self.letters, self.angles, strict=True)
            for b, q in zip(self.letters, self.angles, strict=True)
        }


def rmsd(a: Array, b: Array) -> float:
    """Root mean-squared deviation, √(Σ (aᵢ − bᵢ)² / n), radians (Wheatland 2016, section 4.2.2)."""
    return float(np.sqrt(np.mean((a - b) ** 2)))


def manhattan(a: Array, b: Array) -> float:
    """Manhattan distance, Σ |aᵢ − bᵢ|, radians (Wheatland 2016, section 4.2.2)."""
    return float(np.abs(a - b).sum())


def chebyshev(a: Array, b: Array) -> float:
    """Chebyshev distance, max |aᵢ − bᵢ|, radians (Wheatland 2016, section 4.2.2)."""
    return float(np.abs(a - b).max())


@cache
def asl_poses() -> LetterPoses:
    """Return the poses of the 26 ASL letters that ship: medians over one signer's frames."""
    text = files("azee.spelling.timing").joinpath("data/asl_letter_poses.csv").read_text("utf-8")
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    joints = tuple(name for name in rows[0] if name != "letter")
    angles = np.radians([[float(row[name]) for name in joints] for row in rows])
    return LetterPoses(tuple(row["letter"] for row in rows), joints, angles)
