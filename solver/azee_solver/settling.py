"""Where constraints exclude each other, the later ones give way to the earlier."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee_solver.result import Result

Array = NDArray[np.float64]
Again = Callable[[Mapping[int, float], Array], Result]
"""Solves once more: factors of tasks' weights, and the posture (V,) to begin with."""
Order = Callable[[int], tuple[Fraction, int, int]]

PULL = 0.1
"""With how much of a tolerance's force a constraint that has lost still pulls."""


def giving_way(
    result: Result, ease: Mapping[int, float], again: Again, order: Order
) -> tuple[dict[int, float], Result]:
    """Return who gives way, with factors of their weights, and what comes of it.

    One that misses alone keeps its weight: there is nobody to give way to.

    Args: result: with which constraints are lost. ease: those that have given way already.
        order: of constraints; the last that is lost gives way first.
    """
    eased = dict(ease)
    while len(lost := result.lost()) > (not eased):
        loser = max(lost, key=order)
        eased[loser] = PULL / result.ratios[loser]
        result = again(eased, result.q)
    candidates = sorted(eased.keys() - ease.keys(), key=order)
    for i in candidates:
        if len(eased) == 1:
            break
        fewer = {k: v for k, v in eased.items() if k != i}
        other = again(fewer, result.q)
        if not other.lost():
            eased, result = fewer, other
    return eased, result
