"""The posture of a whole moment, and the groups of problems that it came of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_solver.groups import Group
from azee_solver.problems import Reach
from azee_solver.result import Result

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """A posture q (V,), and its groups with their results, in the order in which they were solved.

    reach: how much of the body each problem was allowed to move.
    """

    q: Array
    reach: tuple[Reach, ...]
    groups: tuple[Group, ...]
    results: tuple[Result, ...]

    def missed(self) -> frozenset[int]:
        """Tasks that are not met."""
        return frozenset().union(*(r.missed() for r in self.results))
