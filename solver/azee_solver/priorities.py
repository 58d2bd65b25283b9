"""Lexicographic priorities: where constraints exclude each other, later ones are given up.

A weighted sum of squares shares a conflict among all that take part in it. A reader of the sign
wants the earlier constraint met and the later one missed, so the weight of the last unmet one is
lowered until the others are met.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee_solver.result import Result

Array = NDArray[np.float64]
Again = Callable[[Mapping[int, float], Array], Result]
"""Solves once more: factors of the tasks' weights, and the posture (V,) to begin with."""
Order = Callable[[int], tuple[Any, ...]]

GIVEN_UP_PULL = 0.1
"""How steeply the cost of a constraint that is given up falls with its residual: a tenth
as steeply as that of one that is missed by a tolerance."""


def give_up_later_tasks(
    result: Result, factors: Mapping[int, float], again: Again, order: Order
) -> tuple[dict[int, float], Result]:
    """Return factors of the weights of the tasks that are given up, and what comes of it.

    A task that misses alone keeps its weight: nothing else gains by giving it up. Once all others
    are met, a task that was given up early and need not have been is taken back.

    Args: result: with which tasks are unmet. factors: of tasks given up already. order: of tasks;
        the last unmet one is given up first.
    """
    given_up = dict(factors)
    while len(unmet := result.unmet()) > (0 if given_up else 1):
        last = max(unmet, key=order)
        given_up[last] = GIVEN_UP_PULL / result.ratios[last]
        result = again(given_up, result.q)
    for i in sorted(given_up.keys() - factors.keys(), key=order):
        if len(given_up) == 1:
            break
        fewer = {k: v for k, v in given_up.items() if k != i}
        other = again(fewer, result.q)
        if not other.unmet():
            given_up, result = fewer, other
    return given_up, result
