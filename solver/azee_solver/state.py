"""A posture for a whole moment while it is being solved."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_solver.groups import Group
from azee_solver.result import Result

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """A posture (V,), and the groups that it came of, in the order in which they were solved."""

    q: Array
    groups: tuple[Group, ...]
    results: tuple[Result, ...]

    def missed(self) -> frozenset[int]:
        """Tasks that are not met."""
        return frozenset().union(*(r.missed() for r in self.results))
