"""The objective of one inverse-kinematics problem and its gradient, compiled.

    f(x) = Σ_k w_k e_k²  +  Σ_v λ_v (q_v − ref_v)²  +  Σ_v κ_v max(0, |u_v| − 0.8)²  +  μ Σ overlap²

with u_v the place of q_v in its range, −1 to 1. A residual e_k compares two entries a and b of a
tape: a − b for places and parallels, |a − b| − d for places at a distance, a · b for
perpendiculars. The gradient costs one backward sweep: every pull on a point or direction becomes a
force and a moment about the world's origin on its node, both are added up towards the root, and a
coordinate that turns about axis u through o feels u · (M − o × F).

All that a problem is lies in two flat arrays, one of integers and one of reals, which `program`
lays out: four arguments cost a microsecond to hand over where forty cost ten, and the same
arrays can be handed to a C callback. The first entries of `ints` say where each section starts.
Fast-math is off: the same bytes on every run. Signatures are given, so that compiling happens
once, when this module is first imported, and the result is kept on disk.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

Reals = NDArray[np.float64]
Ints = NDArray[np.int64]

# Operations of a tape; its table is in `tape`. They stand here, as all that compiled code is made
# of, because the kept result is made anew only when this file changes.
CONSTANT, POINT, VECTOR, COMBINE, UNIT, CROSS, TURN = range(7)

# Kinds of residual.
MEET, AT_DISTANCE, PERPENDICULAR = range(3)

# Sections of `ints`.
(
    PARENTS,
    DOF_START,
    DOF_AXIS,
    DOF_COORDINATE,
    ACTIVE,
    FREE,
    CODES,
    ROWS,
    CAPSULE_NODE,
    PAIRS,
    INTS_END,
) = range(11)

# Sections of `reals`; their starts stand in `ints` after those of the integers.
(
    Q,
    OFFSETS,
    ZERO,
    DOF_SCALE,
    NUMBERS,
    ROW_NUMBERS,
    CAPSULE_ENDS,
    PAIR_REACH,
    POSTURE,
    OVERLAP_WEIGHT,
    POSITIONS,
    ROTATIONS,
    AXES,
    FORCES,
    MOMENTS,
    VALUES,
    PULLS,
    ENDS,
    DEEPEST,
    PULL_ON_Q,
    REALS_END,
) = range(11, 32)

COMFORTABLE = 0.8
"""Part of a coordinate's range, about its middle, that costs nothing."""

SHORT = 1e-12


@njit
def _part(array, ints, section):  # type: ignore[no-untyped-def]
    return array[ints[section] : ints[section + 1]]


@njit
def _forward(  # type: ignore[no-untyped-def]
    q, active, parents, offsets, zero, start, axis, scale, coordinate, positions, rotations, axes
):
    """Frames of the active nodes; those of all others stand in the arrays already."""
    M = np.empty((3, 3))
    for node in active:
        p = parents[node]
        if p < 0:
            for i in range(3):
                positions[node, i] = offsets[node, i]
                for j in range(3):
                    M[i, j] = zero[node, i, j]
        else:
            for i in range(3):
                a, b, c = rotations[p, i, 0], rotations[p, i, 1], rotations[p, i, 2]
                positions[node, i] = (
                    positions[p, i]
                    + a * offsets[node, 0]
                    + b * offsets[node, 1]
                    + c * offsets[node, 2]
                )
                for j in range(3):
                    M[i, j] = a * zero[node, 0, j] + b * zero[node, 1, j] + c * zero[node, 2, j]
        for d in range(start[node], start[node + 1]):
            angle = scale[d] * q[coordinate[d]]
            cos, sin = math.cos(angle), math.sin(angle)
            j, k = (axis[d] + 1) % 3, (axis[d] + 2) % 3
            for i in range(3):
                axes[d, i] = M[i, axis[d]]
                u, w = M[i, j], M[i, k]
                M[i, j] = cos * u + sin * w
                M[i, k] = cos * w - sin * u
        for i in range(3):
            for j in range(3):
                rotations[node, i, j] = M[i, j]


@njit
def _play(codes, numbers, positions, rotations, values):  # type: ignore[no-untyped-def]
    """Values of the tape's entries; see the table in `tape`."""
    for t in range(codes.shape[0]):
        code, a, b, node = codes[t, 0], codes[t, 1], codes[t, 2], codes[t, 3]
        if code == CONSTANT:
            for i in range(3):
                values[t, i] = numbers[t, i]
        elif code in (POINT, VECTOR):
            for i in range(3):
                values[t, i] = (
                    rotations[node, i, 0] * numbers[t, 0]
                    + rotations[node, i, 1] * numbers[t, 1]
                    + rotations[node, i, 2] * numbers[t, 2]
                )
                if code == POINT:
                    values[t, i] += positions[node, i]
        elif code == COMBINE:
            for i in range(3):
                values[t, i] = numbers[t, i] + numbers[t, 3] * values[a, i]
                if b >= 0:
                    values[t, i] += numbers[t, 4] * values[b, i]
        elif code == UNIT:
            n = math.sqrt(values[a, 0] ** 2 + values[a, 1] ** 2 + values[a, 2] ** 2)
            for i in range(3):
                values[t, i] = values[a, i] / n if n > SHORT else 0.0
        elif code == CROSS:
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                values[t, i] = values[a, j] * values[b, k] - values[a, k] * values[b, j]
        elif code == TURN:
            cos, sin = numbers[t, 3], numbers[t, 4]
            along = 0.0
            for i in range(3):
                along += values[b, i] * values[a, i]
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                across = values[b, j] * values[a, k] - values[b, k] * values[a, j]
                values[t, i] = (
                    cos * values[a, i] + sin * across + (1.0 - cos) * along * values[b, i]
                )


@njit
def _rewind(codes, numbers, values, pulls, forces, moments):  # type: ignore[no-untyped-def]
    """Carry ∂f / ∂entry back to the nodes, as forces and moments about the world's origin."""
    for t in range(codes.shape[0] - 1, -1, -1):
        code, a, b, node = codes[t, 0], codes[t, 1], codes[t, 2], codes[t, 3]
        gx, gy, gz = pulls[t, 0], pulls[t, 1], pulls[t, 2]
        if code in (POINT, VECTOR):
            # A moment is the same for both: the value is a point, or an arrow at the origin.
            if code == POINT:
                forces[node, 0] += gx
                forces[node, 1] += gy
                forces[node, 2] += gz
            moments[node, 0] += values[t, 1] * gz - values[t, 2] * gy
            moments[node, 1] += values[t, 2] * gx - values[t, 0] * gz
            moments[node, 2] += values[t, 0] * gy - values[t, 1] * gx
        elif code == COMBINE:
            for i in range(3):
                pulls[a, i] += numbers[t, 3] * pulls[t, i]
                if b >= 0:
                    pulls[b, i] += numbers[t, 4] * pulls[t, i]
        elif code == UNIT:
            n = math.sqrt(values[a, 0] ** 2 + values[a, 1] ** 2 + values[a, 2] ** 2)
            if n > SHORT:
                along = values[t, 0] * gx + values[t, 1] * gy + values[t, 2] * gz
                for i in range(3):
                    pulls[a, i] += (pulls[t, i] - along * values[t, i]) / n
        elif code == CROSS:
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                pulls[a, i] += values[b, j] * pulls[t, k] - values[b, k] * pulls[t, j]
                pulls[b, i] += pulls[t, j] * values[a, k] - pulls[t, k] * values[a, j]
        elif code == TURN:
            cos, sin = numbers[t, 3], numbers[t, 4]
            along, back = 0.0, 0.0
            for i in range(3):
                along += values[b, i] * values[a, i]
                back += values[b, i] * pulls[t, i]
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                unturned = pulls[t, j] * values[b, k] - pulls[t, k] * values[b, j]
                pulls[a, i] += (
                    cos * pulls[t, i] + sin * unturned + (1.0 - cos) * back * values[b, i]
                )
                pulls[b, i] += sin * (values[a, j] * pulls[t, k] - values[a, k] * pulls[t, j]) + (
                    1.0 - cos
                ) * (along * pulls[t, i] + back * values[a, i])


@njit
def _compare(rows, row_numbers, values, pulls):  # type: ignore[no-untyped-def]
    """Sum of w e² over the residuals, and its pulls on the entries they compare."""
    f = 0.0
    for k in range(rows.shape[0]):
        kind, a, b = rows[k, 0], rows[k, 1], rows[k, 2]
        weight = row_numbers[k, 0]
        if kind == PERPENDICULAR:
            e = 0.0
            for i in range(3):
                e += values[a, i] * values[b, i]
            f += weight * e * e
            for i in range(3):
                pulls[a, i] += 2.0 * weight * e * values[b, i]
                pulls[b, i] += 2.0 * weight * e * values[a, i]
            continue
        square = 0.0
        for i in range(3):
            square += (values[a, i] - values[b, i]) ** 2
        if kind == MEET:
            f += weight * square
            factor = 2.0 * weight
        else:
            gap = math.sqrt(square)
            e = gap - row_numbers[k, 1]
            f += weight * e * e
            factor = 2.0 * weight * e / gap if gap > SHORT else 0.0
        for i in range(3):
            pull = factor * (values[a, i] - values[b, i])
            pulls[a, i] += pull
            pulls[b, i] -= pull
    return f


@njit
def _nearest(ends, i, j):  # type: ignore[no-untyped-def]
    """Parameters of the nearest points of two capsules' axes (Ericson 2005, §5.1.9)."""
    a, b, c, d, e = 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        u = ends[i, 3 + k] - ends[i, k]
        v = ends[j, 3 + k] - ends[j, k]
        w = ends[i, k] - ends[j, k]
        a += u * u
        b += u * v
        c += v * v
        d += u * w
        e += v * w
    s = 0.0
    if a * c - b * b > SHORT:
        s = min(max((b * e - c * d) / (a * c - b * b), 0.0), 1.0)
    t = (b * s + e) / c if c > SHORT else 0.0
    if t < 0.0:
        t = 0.0
        s = min(max(-d / a, 0.0), 1.0) if a > SHORT else 0.0
    elif t > 1.0:
        t = 1.0
        s = min(max((b - d) / a, 0.0), 1.0) if a > SHORT else 0.0
    return s, t


@njit
def _collide(  # type: ignore[no-untyped-def]
    weight, nodes, local, pairs, reach, positions, rotations, ends, deepest, forces, moments
):
    """Sum of μ overlap² over the pairs of capsules, the deepest, and its forces on their nodes."""
    for c in range(nodes.shape[0]):
        node = nodes[c]
        for i in range(3):
            for end in range(2):
                ends[c, 3 * end + i] = (
                    positions[node, i]
                    + rotations[node, i, 0] * local[c, 3 * end]
                    + rotations[node, i, 1] * local[c, 3 * end + 1]
                    + rotations[node, i, 2] * local[c, 3 * end + 2]
                )
    f = 0.0
    deepest[0] = 0.0
    gap = np.empty(3)
    for n in range(pairs.shape[0]):
        i, j = pairs[n, 0], pairs[n, 1]
        # A box around both axes that is wide enough to miss nothing.
        apart = False
        for k in range(3):
            low_i, high_i = min(ends[i, k], ends[i, 3 + k]), max(ends[i, k], ends[i, 3 + k])
            low_j, high_j = min(ends[j, k], ends[j, 3 + k]), max(ends[j, k], ends[j, 3 + k])
            if low_i - high_j > reach[n] or low_j - high_i > reach[n]:
                apart = True
        if apart:
            continue
        s, t = _nearest(ends, i, j)
        square = 0.0
        for k in range(3):
            gap[k] = (
                ends[i, k]
                + s * (ends[i, 3 + k] - ends[i, k])
                - ends[j, k]
                - t * (ends[j, 3 + k] - ends[j, k])
            )
            square += gap[k] * gap[k]
        distance = math.sqrt(square)
        overlap = reach[n] - distance
        if overlap <= 0.0:
            continue
        f += weight * overlap * overlap
        deepest[0] = max(deepest[0], overlap)
        if distance <= SHORT:
            continue
        factor = -2.0 * weight * overlap / distance
        for side in range(2):
            c = i if side == 0 else j
            r = s if side == 0 else t
            sign = factor if side == 0 else -factor
            node = nodes[c]
            px = ends[c, 0] + r * (ends[c, 3] - ends[c, 0])
            py = ends[c, 1] + r * (ends[c, 4] - ends[c, 1])
            pz = ends[c, 2] + r * (ends[c, 5] - ends[c, 2])
            fx, fy, fz = sign * gap[0], sign * gap[1], sign * gap[2]
            forces[node, 0] += fx
            forces[node, 1] += fy
            forces[node, 2] += fz
            moments[node, 0] += py * fz - pz * fy
            moments[node, 1] += pz * fx - px * fz
            moments[node, 2] += px * fy - py * fx
    return f


@njit
def _gather(  # type: ignore[no-untyped-def]
    active, parents, start, scale, coordinate, positions, axes, forces, moments, pull_on_q
):
    """Add up forces and moments towards the root; what each coordinate feels of them."""
    for n in range(active.shape[0] - 1, -1, -1):
        node = active[n]
        o, F, M = positions[node], forces[node], moments[node]
        mx = M[0] - (o[1] * F[2] - o[2] * F[1])
        my = M[1] - (o[2] * F[0] - o[0] * F[2])
        mz = M[2] - (o[0] * F[1] - o[1] * F[0])
        for d in range(start[node], start[node + 1]):
            felt = axes[d, 0] * mx + axes[d, 1] * my + axes[d, 2] * mz
            pull_on_q[coordinate[d]] += scale[d] * felt
        p = parents[node]
        if p >= 0:
            for i in range(3):
                forces[p, i] += F[i]
                moments[p, i] += M[i]


@njit(
    types.float64(
        types.Array(types.float64, 1, "C", readonly=True),
        types.Array(types.float64, 1, "C"),
        types.Array(types.int64, 1, "C"),
        types.Array(types.float64, 1, "C"),
    ),
    cache=True,
)
def objective(x, gradient, ints, reals):  # type: ignore[no-untyped-def]
    """Return f at the free coordinates x (n,); its gradient goes into `gradient` (n,) or (0,)."""
    q = _part(reals, ints, Q)
    free, active = _part(ints, ints, FREE), _part(ints, ints, ACTIVE)
    parents, start = _part(ints, ints, PARENTS), _part(ints, ints, DOF_START)
    axis, coordinate = _part(ints, ints, DOF_AXIS), _part(ints, ints, DOF_COORDINATE)
    scale = _part(reals, ints, DOF_SCALE)
    count, entries = parents.shape[0], (ints[CODES + 1] - ints[CODES]) // 4
    positions = _part(reals, ints, POSITIONS).reshape((count, 3))
    rotations = _part(reals, ints, ROTATIONS).reshape((count, 3, 3))
    axes = _part(reals, ints, AXES).reshape((axis.shape[0], 3))
    forces = _part(reals, ints, FORCES).reshape((count, 3))
    moments = _part(reals, ints, MOMENTS).reshape((count, 3))
    codes = _part(ints, ints, CODES).reshape((entries, 4))
    numbers = _part(reals, ints, NUMBERS).reshape((entries, 5))
    values = _part(reals, ints, VALUES).reshape((entries, 3))
    pulls = _part(reals, ints, PULLS).reshape((entries, 3))

    for k in range(free.shape[0]):
        q[free[k]] = x[k]
    offsets = _part(reals, ints, OFFSETS).reshape((count, 3))
    zero = _part(reals, ints, ZERO).reshape((count, 3, 3))
    _forward(
        q, active, parents, offsets, zero, start, axis, scale, coordinate, positions, rotations,
        axes,
    )  # fmt: skip
    _play(codes, numbers, positions, rotations, values)

    pulls[:] = 0.0
    forces[:] = 0.0
    moments[:] = 0.0
    residuals = (ints[ROWS + 1] - ints[ROWS]) // 3
    f = _compare(
        _part(ints, ints, ROWS).reshape((residuals, 3)),
        _part(reals, ints, ROW_NUMBERS).reshape((residuals, 2)),
        values,
        pulls,
    )
    _rewind(codes, numbers, values, pulls, forces, moments)
    nodes = _part(ints, ints, CAPSULE_NODE)
    collisions = (ints[PAIRS + 1] - ints[PAIRS]) // 2
    f += _collide(
        reals[ints[OVERLAP_WEIGHT]],
        nodes,
        _part(reals, ints, CAPSULE_ENDS).reshape((nodes.shape[0], 6)),
        _part(ints, ints, PAIRS).reshape((collisions, 2)),
        _part(reals, ints, PAIR_REACH),
        positions,
        rotations,
        _part(reals, ints, ENDS).reshape((nodes.shape[0], 6)),
        _part(reals, ints, DEEPEST),
        forces,
        moments,
    )
    pull_on_q = _part(reals, ints, PULL_ON_Q)
    pull_on_q[:] = 0.0
    _gather(active, parents, start, scale, coordinate, positions, axes, forces, moments, pull_on_q)

    posture = _part(reals, ints, POSTURE).reshape((free.shape[0], 5))
    for k in range(free.shape[0]):
        reference, keep, middle, half, comfort = posture[k]
        away = x[k] - reference
        u = (x[k] - middle) / half
        beyond = u - COMFORTABLE if u > COMFORTABLE else min(u + COMFORTABLE, 0.0)
        f += keep * away * away + comfort * beyond * beyond
        if gradient.shape[0] > 0:
            gradient[k] = pull_on_q[free[k]] + 2.0 * keep * away + 2.0 * comfort * beyond / half
    return f
