"""Lexicographic priorities: where constraints exclude each other, later ones are given up.

A weighted sum of squares shares a conflict among all that take part in it. A reader of the sign
wants the earlier constraint met and the later one missed, so the weight of the last unmet one is
lowered until the others are met.
"""

from __future__ import annotations

import math
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


TAKING_BACK = 4
"""Halvings of the interval, of logarithms of factors, in which the greatest harmless one lies."""


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


def take_back(
    result: Result,
    given_up: Mapping[int, float],
    factors: Mapping[int, float],
    again: Again,
    begin: Array,
    *,
    deepest_m: float,
) -> tuple[dict[int, float], Result]:
    """Return greater factors for the tasks given up, as far as the others stay met with them.

    With little weight a task counts less than comfort too: one that the body keeps from being met
    by two tolerances misses by ten, and a thumb flips to its other side. So each try begins where
    the task still had its weight.

    Args: result: of `give_up_later_tasks`, with its `given_up`. factors: of tasks given up before
        it, which stay. begin: (V,) the posture before any was given up. deepest_m: overlap that is
        better than a miss.
    """
    found = dict(given_up)
    if result.unmet():
        return found, result
    deepest_m = max(deepest_m, result.overlap_m)
    for i in sorted(given_up.keys() - factors.keys()):
        low, high = math.log(found[i]), 0.0
        for _ in range(TAKING_BACK):
            middle = 0.5 * (low + high)
            trial = again({**found, i: math.exp(middle)}, begin)
            if trial.unmet() or trial.overlap_m > deepest_m:
                high = middle
                continue
            low = middle
            if trial.ratios[i] < result.ratios[i]:
                found[i], result = math.exp(middle), trial
    return found, result
