"""The entry that NLopt calls: value and gradient, or Gauss-Newton steps in place."""

from __future__ import annotations

import math

import numpy as np
from numba import cfunc, njit

from azee_rig.machine_code import KEEPS
from azee_rig.pointers import INNER, carray, types
from azee_solver.block import (
    BEST,
    BOUNDS,
    DAMPING,
    FACTOR,
    HESSIAN,
    MOST_DAMPING,
    ROUNDS,
    TOLERANCE,
    UNDEFINED,
    VECTORS,
)
from azee_solver.kernels.model import gauss_newton
from azee_solver.kernels.objective import objective
from azee_solver.kernels.sections import matrix, part
from azee_solver.kernels.steps import bounded_step


@njit(**INNER, inline="always")
def improve(x, gradient, ints, reals):
    """Polish x (n,) for the block's number of rounds; return f, with its gradient if that is 0."""
    n = x.shape[0]
    hessian = matrix(reals, ints, HESSIAN, n, n)
    factor = matrix(reals, ints, FACTOR, n, n + 1)
    vectors = matrix(reals, ints, VECTORS, 6, n)
    model, step, trial = vectors[3], vectors[4], vectors[5]
    free = ints[ints[VECTORS] + 6 * n : ints[VECTORS] + 7 * n]
    bounds = matrix(reals, ints, BOUNDS, 2, n)
    rounds, tolerance = ints[ints[ROUNDS]], reals[ints[TOLERANCE]]
    damping, growth, foreseen, value = reals[ints[DAMPING]], 2.0, 0.0, np.inf
    for k in range(n):
        trial[k] = x[k]
    while True:
        other, contacts = objective(trial, gradient, rounds == 0, ints, reals)
        gain = value - other
        done = rounds <= 0
        if gain > 0.0:
            done = done or gain <= tolerance * other
            value = other
            for k in range(n):
                x[k] = trial[k]
            if foreseen > 0.0:
                damping *= max(1.0 / 3.0, 1.0 - (2.0 * gain / foreseen - 1.0) ** 3)
                growth = 2.0
            if not done:
                gauss_newton(x, contacts, vectors[:3], model, hessian, ints, reals)
        else:
            damping *= growth
            growth *= 2.0
        if done or damping > MOST_DAMPING:
            reals[ints[DAMPING]] = damping
            return value
        rounds -= 1
        foreseen = bounded_step(x, bounds, free, damping, model, hessian, factor, step)
        for k in range(n):
            trial[k] = min(max(x[k] + step[k], bounds[0, k]), bounds[1, k])


@cfunc(
    types.float64(
        types.uint32, types.CPointer(types.float64), types.CPointer(types.float64), types.voidptr
    ),
    cache=not KEEPS,
    error_model="numpy",
)
def evaluate(count, place, slope, block):
    """Return f at x (n,) and write its gradient (n,): NLopt's `nlopt_func`.

    The lowest point so far is kept in the block: a method that gives up loses it. Where f is
    undefined a huge value without slope makes a line search step back.

    With rounds in the block x first goes, never to a higher value, by damped
    Gauss-Newton steps inside the bounds (Levenberg 1944, Marquardt 1963; damped as by Nielsen
    1999): every term of f is a square, so that its model needs first derivatives only. A relative
    gain below the block's tolerance ends it, or as many rounds. It is the same entry because
    every entry is a copy of the whole objective, to be compiled once and loaded by every process.
    """
    n = np.int64(count)
    size = carray(block, (1,), np.int64)[0]
    ints, reals = carray(block, (size,), np.int64), carray(block, (size,), np.float64)
    x, gradient = carray(place, (n,)), carray(slope, (n,))
    value = improve(x, gradient, ints, reals)
    if not math.isfinite(value):
        for k in range(n):
            gradient[k] = 0.0
        return UNDEFINED
    best = part(reals, ints, BEST)
    if value < best[0]:
        best[0] = value
        for k in range(n):
            best[1 + k] = x[k]
    return value
