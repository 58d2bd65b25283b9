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
    AT_DISTANCE,
    BAND_PAD,
    CODES,
    COLUMN,
    FREE,
    HESSIAN,
    MISS_SHARE,
    MOST_DAMPING,
    NUMBERS,
    OVERLAP_WEIGHT,
    PERPENDICULAR,
    POSTURE,
    ROW_NUMBERS,
    ROWS,
    VALUES,
    VECTORS,
    Q,
)
from azee_solver.kernels.band import factorise, solve
from azee_solver.kernels.model import gauss_newton
from azee_solver.kernels.objective import objective
from azee_solver.kernels.residuals import beyond_slack
from azee_solver.kernels.sections import along, matrix, part


@njit(**INNER)
def _frame(t, block, x, ref, keep, weight, counts, places, numbers, shares, hessian, gradient):
    """Return f_t at x (V,) and its largest miss; write its model too if `hessian` has a size.

    The miss is w e² of the row that is farthest from being met, in squared tolerances. A program
    knows the coordinates that its terms hang on; the others cost only to leave the reference.
    """
    size = integers(block, (1,))[0]
    ints, words = integers(block, (size,)), reals(block, (size,))
    q, free = part(words, ints, Q), part(ints, ints, FREE)
    n = free.shape[0]
    posture = matrix(words, ints, POSTURE, n, 5)
    vectors = matrix(words, ints, VECTORS, 6, n)
    own = vectors[5]
    for v in range(x.shape[0]):
        q[v] = x[v]
    for k in range(n):
        own[k] = x[free[k]]
        posture[k, 0] = ref[free[k]]
        posture[k, 1] = keep[free[k]]
    rows = (ints[ROWS + 1] - ints[ROWS]) // 3
    row_numbers = matrix(words, ints, ROW_NUMBERS, rows, 3)
    for r in range(rows):
        row_numbers[r, 0] = weight[r]
    entries = matrix(words, ints, NUMBERS, (ints[CODES + 1] - ints[CODES]) // 4, 5)
    for j in range(counts[t]):
        for c in range(5):
            entries[places[t, j], c] = numbers[t, j, c]
    words[ints[MISS_SHARE]] = shares[0]
    words[ints[OVERLAP_WEIGHT]] = shares[1]
    value, contacts = objective(own, vectors[4], False, ints, words)
    column = part(ints, ints, COLUMN)
    for v in range(x.shape[0]):
        if column[v] < 0:
            value += keep[v] * (x[v] - ref[v]) ** 2
    if hessian.shape[0]:
        model, curvature = vectors[3], matrix(words, ints, HESSIAN, n, n)
        gauss_newton(own, contacts, vectors[:3], model, curvature, ints, words)
        hessian[:] = 0.0
        for v in range(x.shape[0]):
            if column[v] < 0:
                gradient[v] = keep[v] * (x[v] - ref[v])
                hessian[v, v] = keep[v]
        for i in range(n):
            gradient[free[i]] = model[i]
            for j in range(i, n):
                hessian[free[i], free[j]] = curvature[i, j]
    return value, _largest_miss(ints, words)


@njit(**INNER)
def _largest_miss(ints, words):
    """Return the largest w e² of all rows at the point that was evaluated last."""
    count = (ints[ROWS + 1] - ints[ROWS]) // 3
    rows = matrix(ints, ints, ROWS, count, 3)
    row_numbers = matrix(words, ints, ROW_NUMBERS, count, 3)
    values = matrix(words, ints, VALUES, (ints[CODES + 1] - ints[CODES]) // 4, 3)
    largest = 0.0
    for r in range(count):
        a, b = rows[r, 1], rows[r, 2]
        square, dot = 0.0, 0.0
        for i in range(3):
            square += (values[a, i] - values[b, i]) ** 2
            dot += values[a, i] * values[b, i]
        if rows[r, 0] == PERPENDICULAR:
            square = beyond_slack(dot, row_numbers[r, 2]) ** 2
        elif rows[r, 0] == AT_DISTANCE:
            square = beyond_slack(math.sqrt(square) - row_numbers[r, 1], row_numbers[r, 2]) ** 2
        largest = max(largest, row_numbers[r, 0] * square)
    return largest


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
def _couple(hessian, coupled, component):
    """Write for each coordinate the first one that any frame's term couples it with, (n,).

    Args: coupled: (n, n) room to work in.
    """
    n = component.shape[0]
    coupled[:] = 0
    for t in range(hessian.shape[0]):
        for i in range(n):
            for j in along(i + 1, n):
                if hessian[t, i, j] != 0.0:
                    coupled[i, j] = 1
    for v in range(n):
        component[v] = v
    for i in range(n):
        for j in range(i + 1, n):
            one, other = component[i], component[j]
            if coupled[i, j] != 0 and one != other:
                first, last = min(one, other), max(one, other)
                for v in range(n):
                    if component[v] == last:
                        component[v] = first


@njit(**INNER)
def _is_stuck(stuck, v):
    """Whether a coordinate may move in no frame."""
    frames = 0
    for t in range(stuck.shape[0]):
        frames += stuck[t, v]
    return frames == stuck.shape[0]


@njit(**INNER)
def _step(
    first, component, members, hessian, gradient, bands, smooth, stuck, damping, room, spare, step
):  # fmt: skip
    """Write the step (T, n) of the coordinates that are coupled with one."""
    T, n, order = stuck.shape[0], stuck.shape[1], bands.shape[0] - 1
    m = 0
    for v in range(n):
        if component[v] == first and not _is_stuck(stuck, v):
            members[m] = v
            m += 1
    width = order * m + 1
    band, x = reals(room, (T * m, width + BAND_PAD)), reals(spare, (T * m,))
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
    factorise(band, width)
    solve(band, width, x)
    for t in range(T):
        for a in range(m):
            step[t, members[a]] = x[t * m + a]


@cfunc(WORDS, cache=not KEEPS, error_model="numpy")
def project(words):
    """Lower F from x by at most so many steps; write where they lead, and what is missed there.

    Words: T, n, R, K, order, most steps; blocks (T,) of all n coordinates; x, ref, keep (T, n);
    row weights (T, R); how many entries of a tape are refilled (T,), which (T, K) and with what
    (T, K, 5); bands (order + 1, T) of Dᵀ D; s, lower, upper (n,); fixed (T, n); the shares
    σ and w_o, the relative gain that ends it and the first damping (4,); room: matrices
    (2, T, n, n), band (T n, order n + 1 + BAND_PAD), gradients (2, T, n), step, trial, spare
    (T, n), and a pointer to nothing; results: largest miss (T,), value and steps (2,); more room:
    (T, n) integers, two of (n,) integers, (T,), (n, n) integers.
    """
    w = carray(words, (34,))
    T, n, R, K, order, rounds = w[0], w[1], w[2], w[3], w[4], w[5]
    blocks = integers(w[6], (T,))
    x, ref, keep = reals(w[7], (T, n)), reals(w[8], (T, n)), reals(w[9], (T, n))
    weight = reals(w[10], (T, R))
    counts, places = integers(w[11], (T,)), integers(w[12], (T, K))
    numbers, bands = reals(w[13], (T, K, 5)), reals(w[14], (order + 1, T))
    smooth, lower, upper = reals(w[15], (n,)), reals(w[16], (n,)), reals(w[17], (n,))
    fixed, options = integers(w[18], (T, n)), reals(w[19], (4,))
    hessians = reals(w[20], (2, T, n, n))
    gradients, step = reals(w[22], (2, T, n)), reals(w[23], (T, n))
    trial = reals(w[24], (T, n))
    misses, result = reals(w[27], (T,)), reals(w[28], (2,))
    nothing = reals(w[26], (0, 0))
    stuck = integers(w[29], (T, n))
    component, members = integers(w[30], (n,)), integers(w[31], (n,))
    trial_misses, coupled = reals(w[32], (T,)), integers(w[33], (n, n))
    damping, growth = options[3], 2.0
    value, steps, now = np.inf, 0, 0
    for t in range(T):
        for k in range(n):
            trial[t, k] = x[t, k]
    while True:
        other, then = 0.0, 1 - now
        for t in range(T):
            f, missed = _frame(
                t, blocks[t], trial[t], ref[t], keep[t], weight[t], counts, places, numbers,
                options, hessians[then, t] if steps < rounds else nothing, gradients[then, t],
            )  # fmt: skip
            other += f
            trial_misses[t] = missed
            for v in range(n):
                other += (trial[t, v] - ref[t, v]) * _roughness(t, trial, ref, bands, smooth, v)
        gain = value - other
        if gain > 0.0:
            if steps > 0:
                foreseen = 0.0
                for t in range(T):
                    for k in range(n):
                        foreseen -= (trial[t, k] - x[t, k]) * gradients[now, t, k]
                ratio = min(1.0, gain / max(foreseen, 1e-300))
                damping = max(1e-9, damping * max(1.0 / 3.0, 1.0 - (2.0 * ratio - 1.0) ** 3))
                growth = 2.0
            value, now = other, then
            for t in range(T):
                misses[t] = trial_misses[t]
                for k in range(n):
                    x[t, k] = trial[t, k]
            if steps > 0 and gain <= options[2] * other:
                break
            for t in range(T):
                for v in range(n):
                    gradients[now, t, v] += _roughness(t, x, ref, bands, smooth, v)
                    g = gradients[now, t, v]
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
        _couple(hessians[now], coupled, component)
        for t in range(T):
            for v in range(n):
                step[t, v] = 0.0
        for c in range(n):
            if component[c] == c:
                _step(
                    c, component, members, hessians[now], gradients[now], bands, smooth, stuck,
                    damping, w[21], w[25], step,
                )  # fmt: skip
        for t in range(T):
            for k in range(n):
                trial[t, k] = min(max(x[t, k] + step[t, k], lower[k]), upper[k])
    result[0] = value
    result[1] = steps
