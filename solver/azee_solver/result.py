"""What a descent ended in, and which of two ends is better."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from azee_solver.options import SolveOptions
from azee_solver.outcome import FREE, Price

Array = NDArray[np.float64]

SAME = 0.01
"""Costs that differ by no more than this part are those of one and the same end."""


@dataclass(frozen=True, slots=True, eq=False)
class Result:
    """A posture that a group of problems ended in.

    q: (V,) radians. ratios: residual per task, in tolerances. cost: sum of their squares.
    overlap_m: deepest overlap of two capsules. undefined: tasks whose target has no direction.
    given_up: tasks whose weight was lowered in favour of others; they are not in the cost.
    repeats: how many other descents ended there too. eased: what it would have cost to meet tasks
    that comfort has not met. strain: what the posture costs. strained_for: the tasks for
    whose sake.
    """

    q: Array
    ratios: Mapping[int, float]
    cost: float
    overlap_m: float
    undefined: frozenset[int]
    given_up: frozenset[int] = frozenset()
    repeats: int = 0
    eased: Mapping[int, Price] = field(default_factory=dict)
    strain: Price = FREE
    strained_for: frozenset[int] = frozenset()

    def missed(self) -> frozenset[int]:
        """Tasks that are not met."""
        return frozenset(i for i, r in self.ratios.items() if not r <= 1.0) | self.undefined

    def unmet(self) -> frozenset[int]:
        """Tasks that are not met and should be: neither undefined nor given up."""
        return self.missed() - self.undefined - self.given_up

    def worst(self) -> float:
        """Greatest miss of a task that was not given up, in tolerances."""
        return max((r for i, r in self.ratios.items() if i not in self.given_up), default=0.0)


def excess(result: Result, options: SolveOptions) -> float:
    """Overlap beyond what is tolerated, in tolerances."""
    return max(result.overlap_m - options.overlap_m, 0.0) / options.tolerance.length_m


def merit(result: Result, options: SolveOptions) -> tuple[int, float]:
    """Return the number of unmet tasks, then the cost with overlap: the less the better."""
    return len(result.unmet()), result.cost + excess(result, options) ** 2


def is_repeat(one: tuple[int, float], best: tuple[int, float]) -> bool:
    """Whether two merits are, as far as one can tell, those of one and the same end."""
    return one[0] == best[0] and abs(one[1] - best[1]) <= SAME * best[1]
