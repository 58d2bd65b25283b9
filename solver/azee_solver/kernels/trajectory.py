"""Damped Gauss-Newton steps of all postures of a movement at once.

With d = x − ref, the kernel lowers

    F(x) = Σ_t f_t(x_t) + Σ_v s_v |D d_v|²

f_t being the objective of frame t and D differences of neighbouring frames. Every term is a square,
so that the model of F about a point needs first derivatives only; its matrix has a band, since a
difference couples near frames only.
"""

from __future__ import annotations

import math

import numpy as np
from numba import cfunc, njit

from azee_rig.machine_code import KEEPS
from azee_rig.pointers import INNER, WORDS, carray, integers, reals
from azee_solver.block import (
    CODES,
    DEEPEST,
    MISS_SHARE,
    MOST_DAMPING,
    NUMBERS,
    OVERLAP_WEIGHT,
    POSTURE,
    ROW_NUMBERS,
    ROWS,
)
from azee_solver.kernels.band import factorise, solve
from azee_solver.kernels.model import gauss_newton
from azee_solver.kernels.objective import objective
from azee_solver.kernels.sections import matrix


@njit(**INNER)
def _frame(
    t, block, x, ref, keep, weight, counts, places, numbers, shares, three, hessian, gradient
):
    """Return f_t at x (n,); write its model too if `hessian` has a size."""
    n = x.shape[0]
    size = integers(block, (1,))[0]
    ints, words = integers(block, (size,)), reals(block, (size,))
    posture = matrix(words, ints, POSTURE, n, 5)
    for k in range(n):
        posture[k, 0] = ref[k]
        posture[k, 1] = keep[k]
    rows = (ints[ROWS + 1] - ints[ROWS]) // 3
    row_numbers = matrix(words, ints, ROW_NUMBERS, rows, 2)
    for r in range(rows):
        row_numbers[r, 0] = weight[r]
    entries = matrix(words, ints, NUMBERS, (ints[CODES + 1] - ints[CODES]) // 4, 5)
    for j in range(counts[t]):
        for c in range(5):
            entries[places[t, j], c] = numbers[t, j, c]
    words[ints[MISS_SHARE]] = shares[0]
    words[ints[OVERLAP_WEIGHT]] = shares[1]
    value, contacts = objective(x, gradient, False, ints, words)
    if hessian.shape[0]:
        gauss_newton(x, contacts, three, gradient, hessian, ints, words)
    return value, words[ints[DEEPEST]]


@njit(**INNER)
def _roughness(t, x, ref, bands, smooth, v):
    """Return row t of Dᵀ D d_v, times s_v."""
    count, total = x.shape[0], bands[0, t] * (x[t, v] - ref[t, v])
    for o in range(1, bands.shape[0]):
        if t + o < count:
            total += bands[o, t] * (x[t + o, v] - ref[t + o, v])
        if t >= o:
            total += bands[o, t - o] * (x[t - o, v] - ref[t - o, v])
    return smooth[v] * total


@njit(**INNER)
def _couple(hessian, component):
    """Write for each coordinate the first one that any frame's term couples it with, (n,)."""
    n = component.shape[0]
    for v in range(n):
        component[v] = v
    for i in range(n):
        for j in range(i + 1, n):
            one, other = component[i], component[j]
            if one == other:
                continue
            for t in range(hessian.shape[0]):
                if hessian[t, i, j] != 0.0:
                    first, last = min(one, other), max(one, other)
                    for v in range(n):
                        if component[v] == last:
                            component[v] = first
                    break


@njit(**INNER)
def _step(
    first, component, members, hessian, gradient, bands, smooth, stuck, damping, room, spare, step
):  # fmt: skip
    """Write the step (T, n) of the coordinates that are coupled with one."""
    T, n, order = stuck.shape[0], stuck.shape[1], bands.shape[0] - 1
    m = 0
    for v in range(n):
        if component[v] == first:
            members[m] = v
            m += 1
    band, x = reals(room, (T * m, order * m + 1)), reals(spare, (T * m,))
    for t in range(T):
        for a in range(m):
            i, row = members[a], band[t * m + a]
            row[:] = 0.0
            if stuck[t, i] != 0:
                row[0] = 1.0
                x[t * m + a] = 0.0
                continue
            for b in range(a, m):
                if stuck[t, members[b]] == 0:
                    row[b - a] = hessian[t, i, members[b]]
            row[0] += damping * row[0] + bands[0, t] * smooth[i] + 1e-12
            for o in range(1, order + 1):
                if t + o < T and stuck[t + o, i] == 0:
                    row[o * m] += bands[o, t] * smooth[i]
            x[t * m + a] = -gradient[t, i]
    factorise(band)
    solve(band, x)
    for t in range(T):
        for a in range(m):
            step[t, members[a]] = x[t * m + a]


@cfunc(WORDS, cache=not KEEPS, error_model="numpy")
def project(words):
    """Lower F from x by at most so many steps; write where they lead, and how deep bodies overlap.

    Words: T, n, R, K, order, most steps; blocks (T,) of all n coordinates; x, ref, keep (T, n);
    row weights (T, R); how many entries of a tape are refilled (T,), which (T, K) and with what
    (T, K, 5); bands (order + 1, T) of Dᵀ D; s, lower, upper (n,); fixed (T, n); the shares
    σ and w_o, the relative gain that ends it and the first damping (4,); room: matrices (T, n, n),
    band (T n, order n + 1), gradient, step, trial, spare (T, n) and (3, n); results: deepest (T,),
    value and steps (2,).
    """
    w = carray(words, (33,))
    T, n, R, K, order, rounds = w[0], w[1], w[2], w[3], w[4], w[5]
    blocks = integers(w[6], (T,))
    x, ref, keep = reals(w[7], (T, n)), reals(w[8], (T, n)), reals(w[9], (T, n))
    weight = reals(w[10], (T, R))
    counts, places = integers(w[11], (T,)), integers(w[12], (T, K))
    numbers, bands = reals(w[13], (T, K, 5)), reals(w[14], (order + 1, T))
    smooth, lower, upper = reals(w[15], (n,)), reals(w[16], (n,)), reals(w[17], (n,))
    fixed, options = integers(w[18], (T, n)), reals(w[19], (4,))
    hessian = reals(w[20], (T, n, n))
    gradient, step = reals(w[22], (T, n)), reals(w[23], (T, n))
    trial, spare = reals(w[24], (T, n)), reals(w[25], (T, n))
    three, deepest, result = reals(w[26], (3, n)), reals(w[27], (T,)), reals(w[28], (2,))
    nothing = reals(w[26], (0, 0))
    stuck = integers(w[29], (T, n))
    component, members = integers(w[31], (n,)), integers(w[32], (n,))
    damping, growth = options[3], 2.0
    value, fresh, steps = np.inf, False, 0
    for t in range(T):
        for k in range(n):
            trial[t, k] = x[t, k]
    while True:
        other = 0.0
        for t in range(T):
            f, deep = _frame(
                t, blocks[t], trial[t], ref[t], keep[t], weight[t], counts, places, numbers,
                options, three, nothing, spare[t],
            )  # fmt: skip
            other += f
            deepest[t] = deep
            for v in range(n):
                other += (trial[t, v] - ref[t, v]) * _roughness(t, trial, ref, bands, smooth, v)
        gain = value - other
        if gain > 0.0:
            if fresh:
                foreseen = 0.0
                for t in range(T):
                    for k in range(n):
                        foreseen -= (trial[t, k] - x[t, k]) * gradient[t, k]
                ratio = min(1.0, gain / max(foreseen, 1e-300))
                damping = max(1e-9, damping * max(1.0 / 3.0, 1.0 - (2.0 * ratio - 1.0) ** 3))
                growth = 2.0
            value = other
            for t in range(T):
                for k in range(n):
                    x[t, k] = trial[t, k]
            if fresh and gain <= options[2] * other:
                break
            fresh = True
            for t in range(T):
                _frame(
                    t, blocks[t], x[t], ref[t], keep[t], weight[t], counts, places, numbers,
                    options, three, hessian[t], gradient[t],
                )  # fmt: skip
            for t in range(T):
                for v in range(n):
                    gradient[t, v] += _roughness(t, x, ref, bands, smooth, v)
                    g = gradient[t, v]
                    at_limit = (x[t, v] <= lower[v] and g >= 0.0) or (
                        x[t, v] >= upper[v] and g <= 0.0
                    )
                    stuck[t, v] = 1 if fixed[t, v] != 0 or at_limit else 0
        else:
            damping = max(damping, 1e-6) * growth
            growth *= 2.0
        if steps >= rounds or damping > MOST_DAMPING or not math.isfinite(value):
            break
        steps += 1
        _couple(hessian, component)
        for c in range(n):
            if component[c] == c:
                _step(
                    c, component, members, hessian, gradient, bands, smooth, stuck, damping,
                    w[21], w[30], step,
                )  # fmt: skip
        for t in range(T):
            for k in range(n):
                trial[t, k] = min(max(x[t, k] + step[t, k], lower[k]), upper[k])
    result[0] = value
    result[1] = steps
