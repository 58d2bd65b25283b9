"""Damped Gauss-Newton steps inside the bounds (Levenberg 1944, Marquardt 1963)."""

from __future__ import annotations

import math

from numba import njit

from azee_rig.pointers import INNER
from azee_solver.kernels.sections import along


@njit(**INNER)
def _pivot(factor, r, count):
    """Scale a row of a Cholesky factor by the root of its first number."""
    scale = 1.0 / math.sqrt(max(factor[r, r], 1e-300))
    for c in along(r, count + 1):
        factor[r, c] *= scale


@njit(**INNER)
def _newton_step(free, count, moved, damping, gradient, hessian, factor, step):
    """Solve (H + damping · diag H) p = −g for some coordinates; `step` holds the others' moves.

    By Cholesky's factor, two rows at a time: one loop over columns is quicker than two.

    Args: moved: whether any of the others moves.
    """
    n = gradient.shape[0]
    for r in range(count):
        i = free[r]
        rhs = -gradient[i]
        for j in range(n if moved else 0):
            if step[j] != 0.0:
                rhs -= (hessian[i, j] if j >= i else hessian[j, i]) * step[j]
        factor[r, count] = rhs
        for c in range(r, count):
            factor[r, c] = hessian[i, free[c]]
        factor[r, r] += damping * factor[r, r] + 1e-12
    for r in range(0, count - 1, 2):
        _pivot(factor, r, count)
        share = factor[r, r + 1]
        for c in along(r + 1, count + 1):
            factor[r + 1, c] -= share * factor[r, c]
        _pivot(factor, r + 1, count)
        for i in range(r + 2, count):
            one, two = factor[r, i], factor[r + 1, i]
            if one != 0.0 or two != 0.0:
                for c in along(i, count + 1):
                    factor[i, c] -= one * factor[r, c] + two * factor[r + 1, c]
    if count % 2:
        _pivot(factor, count - 1, count)
    for r in range(count - 1, -1, -1):
        solved = factor[r, count]
        for c in range(r + 1, count):
            solved -= factor[r, c] * step[free[c]]
        step[free[r]] = solved / factor[r, r]


@njit(**INNER)
def bounded_step(x, bounds, free, damping, gradient, hessian, factor, step):
    """Step towards the model's least value inside the bounds, by an active set; what it gains."""
    lower, upper = bounds[0], bounds[1]
    count = 0
    for k in range(x.shape[0]):
        step[k] = 0.0
        stuck = (x[k] <= lower[k] and gradient[k] >= 0.0) or (
            x[k] >= upper[k] and gradient[k] <= 0.0
        )
        if not stuck:
            free[count] = k
            count += 1
    moved = False
    while count > 0:
        for r in range(count):
            step[free[r]] = 0.0
        _newton_step(free, count, moved, damping, gradient, hessian, factor, step)
        left = 0
        for r in range(count):
            k = free[r]
            if x[k] + step[k] < lower[k]:
                step[k] = lower[k] - x[k]
            elif x[k] + step[k] > upper[k]:
                step[k] = upper[k] - x[k]
            else:
                free[left] = k
                left += 1
        if left == count:
            break
        count, moved = left, True
    return _foreseen(gradient, hessian, factor[0], step)


@njit(**INNER)
def _foreseen(gradient, hessian, bent, step):
    """Return what a step gains by the model, −2 gᵀp − pᵀ H p; `bent`: room to work in, (≥ n,)."""
    n = step.shape[0]
    bent[:n] = 0.0
    for i in range(n):
        if step[i] != 0.0:
            bent[i] += 0.5 * hessian[i, i] * step[i]
            for j in along(i + 1, n):
                bent[j] += hessian[i, j] * step[i]
    gain = 0.0
    for i in range(n):
        gain -= 2.0 * step[i] * (gradient[i] + bent[i])
    return gain
