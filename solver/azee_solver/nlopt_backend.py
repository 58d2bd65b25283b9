"""NLopt, behind one function: the only module that imports it.

NLopt's own verdict says nothing about constraints met, so nothing of it is handed on: callers
measure. What is guarded here: a start outside the bounds and a NaN both end in an exception
without a message, an optimum may lie outside the bounds by a rounding error, and a solver that
gives up loses the best point it had seen.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import nlopt
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ALGORITHMS = (nlopt.LD_LBFGS, nlopt.LD_VAR2, nlopt.LD_TNEWTON_PRECOND_RESTART)
"""Tried in this order until one gets anywhere (Nocedal 1980; Luksan's codes, as in NLopt)."""

MEMORY = 20
"""Steps that the quasi-Newton methods remember. NLopt's own choice, hundreds, costs more time than
the objective and saves hardly any evaluations."""

GIVES_UP = (
    RuntimeError,
    ValueError,
    nlopt.RoundoffLimited,
    getattr(nlopt, "exception", RuntimeError),
)
"""What NLopt raises when a descent ends early. Newer wheels have exceptions of their own, whose
base is none of Python's."""

UNDEFINED = 1e300
"""Stands for NaN, so that a line search backs off."""


@dataclass(frozen=True, slots=True, eq=False)
class Minimum:
    """A point inside the bounds, and the objective there."""

    x: Array
    value: float


def minimise(
    objective: Callable[[Array, Array], float],
    start: Array,
    lower: Array,
    upper: Array,
    *,
    max_evaluations: int,
    tolerance: float,
) -> Minimum:
    """Return the lowest point that a descent from `start` comes by.

    Args: objective: value at x; writes its gradient into the second argument unless that is
        empty. lower, upper: bounds, (n,). tolerance: relative change of the objective that ends
        the descent.
    """
    first = np.clip(start, lower, upper)
    best = _Best(objective, first)
    origin = best.value
    for algorithm in ALGORITHMS:
        optimiser = nlopt.opt(algorithm, len(first))
        optimiser.set_lower_bounds(lower)
        optimiser.set_upper_bounds(upper)
        optimiser.set_min_objective(best)
        optimiser.set_ftol_rel(tolerance)
        optimiser.set_maxeval(max_evaluations)
        optimiser.set_vector_storage(MEMORY)
        try:
            optimiser.optimize(first)
            gave_up = False
        except GIVES_UP:
            gave_up = best.value >= origin
        if not gave_up:
            break
    return Minimum(np.clip(best.x, lower, upper), best.value)


class _Best:
    """The objective, remembering the lowest point it was asked for."""

    def __init__(self, objective: Callable[[Array, Array], float], first: Array) -> None:
        self.objective = objective
        self.x = first.copy()
        self.value = math.inf
        self.value = self(first, np.empty(len(first)))

    def __call__(self, x: Array, gradient: Array) -> float:
        value = self.objective(x, gradient)
        if not math.isfinite(value):
            gradient[:] = 0.0
            return UNDEFINED
        if value < self.value:
            self.value = value
            self.x[:] = x
        return value
