"""Principal components of poses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from azee.capture.markers import Floats
from azee_rig.skeleton import frozen


@dataclass(frozen=True, eq=False)
class Components:
    """Principal components of vectors of D numbers.

    mean: (D,). directions: (D, C), columns of length one, the strongest first. variances: (C,).
    """

    mean: Floats
    directions: Floats
    variances: Floats

    def __post_init__(self) -> None:
        for name in ("mean", "directions", "variances"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64))

    def of(self, vectors: Floats) -> Floats:
        """Return the components (T, C) of vectors (T, D)."""
        return np.asarray((vectors - self.mean) @ self.directions)

    def back(self, components: Floats) -> Floats:
        """Return the vectors (T, D) with some components, (T, C)."""
        return np.asarray(self.mean + components @ self.directions.T)


def principal_components(vectors: Floats, count: int | None = None) -> Components:
    """Return the components of vectors (N, D); all of them, or the `count` strongest."""
    mean = vectors.mean(axis=0)
    _, sizes, rows = np.linalg.svd(vectors - mean, full_matrices=False)
    variances = sizes**2 / max(len(vectors) - 1, 1)
    return Components(mean, rows[:count].T, variances[:count])
