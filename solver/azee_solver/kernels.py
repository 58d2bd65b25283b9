"""The objective of one inverse-kinematics problem, its gradient and its polish, compiled.

    f(x) = σ Σ_k w_k e_k² + Σ_v λ_v (q_v − ref_v)² + Σ_v κ_v max(0, |u_v| − 0.8)² + μ Σ overlap²

with u_v the place of q_v in its range, −1 to 1, and a share σ that is less than 1 far from the
goal. Where a coordinate follows another, as a finger's last joint follows the one before, ref_v is
2/3 of the other's angle. A residual e_k compares two
entries a and b of a tape: a − b for places and parallels, |a − b| − d for places at a distance,
a · b for perpendiculars. The gradient costs one backward sweep: every pull on a point or direction
becomes a force and a moment about the world's origin on its node, both are added up towards the
root, and a coordinate that turns about axis u through o feels u · (M − o × F).

`evaluate` is what NLopt calls, through its C interface or through Python: the same machine code.
All that a problem is lies in one block of eight-byte words that `layout` lays out, read as
integers or as reals; the first words say where each section starts. Fast-math is off: the same
bytes on every run. Nothing here allocates. Signatures are given, so that compiling happens once,
when this module is first imported, and the result is kept on disk.

numba optimises each function, and again whatever it is linked into: few levels and few variants
keep the first import short. `_part` has its two types given, for it would be compiled anew for
every section; what is called from one place only is better left apart, unless it is the outermost.

The file is longer than others because numba keeps compiled code for as long as the file that
names it stays the same: all that goes into one entry must stand in one file.
"""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np
from numba import cfunc, njit

carray: Any = getattr(numba, "carray")  # noqa: B009 - its stubs hide the name
types: Any = numba.types

# Operations of a tape; its table is in `tape`.
CONSTANT, POINT, VECTOR, COMBINE, UNIT, CROSS, TURN = range(7)

# Kinds of residual.
MEET, AT_DISTANCE, PERPENDICULAR = range(3)

# Sections of integers, then of reals; word s of a block says where section s starts. What is
# needed only while working stands last and is never set up.
(
    SIZE,
    COUNT,
    ROUNDS,
    PARENTS,
    DOF_START,
    DOF_AXIS,
    DOF_COORDINATE,
    ACTIVE,
    FREE,
    COLUMN,
    FOLLOWED,
    CODES,
    ROWS,
    CAPSULE_NODE,
    PAIRS,
    BALL_NODE,
    RUNS,
    Q,
    OFFSETS,
    ZERO,
    DOF_SCALE,
    NUMBERS,
    ROW_NUMBERS,
    CAPSULE_ENDS,
    PAIR_REACH,
    BALLS,
    RUN_REACH,
    POSTURE,
    BOUNDS,
    MISS_SHARE,
    OVERLAP_WEIGHT,
    TOLERANCE,
    DAMPING,
    POSITIONS,
    ROTATIONS,
    AXES,
    DEEPEST,
    BEST,
    FORCES,
    MOMENTS,
    VALUES,
    PULLS,
    ENDS,
    CENTRES,
    CONTACTS,
    PULL_ON_Q,
    SLOPES,
    HESSIAN,
    FACTOR,
    VECTORS,
    SECTIONS_END,
) = range(51)

COMFORTABLE = 0.8
"""Part of a coordinate's range, about its middle, that costs nothing."""

FOLLOWING = 2.0 / 3.0
"""Angle of a finger's last joint over that of the one before (Rijpkema and Girard 1991)."""

SHORT = 1e-12

FIRST_DAMPING, MOST_DAMPING = 1e-3, 1e6
"""Of Gauss-Newton steps: at first, as parts of the curvature, and where they are given up."""

UNDEFINED = 1e300
"""Stands for NaN, so that a line search backs off."""


@njit(
    [
        words(words, types.int64[::1], types.int64)
        for words in (types.int64[::1], types.float64[::1])
    ],
    cache=True,
    error_model="numpy",
)
def _part(array, ints, section):  # type: ignore[no-untyped-def]
    return array[ints[section] : ints[section + 1]]


@njit(error_model="numpy")
def _forward(q, ints, reals):  # type: ignore[no-untyped-def]
    """Frames of the active nodes; those of all others stand in the block already."""
    active, parents = _part(ints, ints, ACTIVE), _part(ints, ints, PARENTS)
    start, axis = _part(ints, ints, DOF_START), _part(ints, ints, DOF_AXIS)
    coordinate, scale = _part(ints, ints, DOF_COORDINATE), _part(reals, ints, DOF_SCALE)
    count = parents.shape[0]
    offsets = _part(reals, ints, OFFSETS).reshape((count, 3))
    zero = _part(reals, ints, ZERO).reshape((count, 3, 3))
    positions = _part(reals, ints, POSITIONS).reshape((count, 3))
    rotations = _part(reals, ints, ROTATIONS).reshape((count, 3, 3))
    axes = _part(reals, ints, AXES).reshape((axis.shape[0], 3))
    for node in active:
        p = parents[node]
        for i in range(3):
            if p < 0:
                positions[node, i] = offsets[node, i]
                for j in range(3):
                    rotations[node, i, j] = zero[node, i, j]
            else:
                a, b, c = rotations[p, i, 0], rotations[p, i, 1], rotations[p, i, 2]
                positions[node, i] = (
                    positions[p, i]
                    + a * offsets[node, 0]
                    + b * offsets[node, 1]
                    + c * offsets[node, 2]
                )
                for j in range(3):
                    rotations[node, i, j] = (
                        a * zero[node, 0, j] + b * zero[node, 1, j] + c * zero[node, 2, j]
                    )
        for d in range(start[node], start[node + 1]):
            angle = scale[d] * q[coordinate[d]]
            cos, sin = math.cos(angle), math.sin(angle)
            j, k = (axis[d] + 1) % 3, (axis[d] + 2) % 3
            for i in range(3):
                axes[d, i] = rotations[node, i, axis[d]]
                u, w = rotations[node, i, j], rotations[node, i, k]
                rotations[node, i, j] = cos * u + sin * w
                rotations[node, i, k] = cos * w - sin * u


@njit(error_model="numpy")
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


@njit(error_model="numpy")
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


@njit(error_model="numpy")
def _compare(rows, row_numbers, share, values, pulls):  # type: ignore[no-untyped-def]
    """Sum of σ w e² over the residuals, and its pulls on the entries they compare."""
    f = 0.0
    for k in range(rows.shape[0]):
        kind, a, b = rows[k, 0], rows[k, 1], rows[k, 2]
        weight = share * row_numbers[k, 0]
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


@njit(error_model="numpy")
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


@njit(error_model="numpy")
def _spread(balls, nodes, positions, rotations, centres):  # type: ignore[no-untyped-def]
    """Where points of nodes' frames lie, some reals per row, of which the first three are one."""
    for c in range(nodes.shape[0]):
        node = nodes[c]
        for i in range(3):
            centres[c, i] = (
                positions[node, i]
                + rotations[node, i, 0] * balls[c, 0]
                + rotations[node, i, 1] * balls[c, 1]
                + rotations[node, i, 2] * balls[c, 2]
            )


@njit(error_model="numpy")
def _touch(ints, reals, positions, rotations):  # type: ignore[no-untyped-def]
    """Find the pairs of capsules that overlap; return how many, and the sum of overlap².

    Contacts are rows of: one capsule's node, the nearest point of its axis, the other's, the
    unit vector from the second to the first, and the overlap.
    """
    if ints[PAIRS] == ints[PAIRS + 1]:
        reals[ints[DEEPEST]] = 0.0
        return 0, 0.0
    nodes = _part(ints, ints, CAPSULE_NODE)
    local = _part(reals, ints, CAPSULE_ENDS).reshape((nodes.shape[0], 6))
    ends = _part(reals, ints, ENDS).reshape((nodes.shape[0], 6))
    _spread(local, nodes, positions, rotations, ends)
    _spread(local[:, 3:], nodes, positions, rotations, ends[:, 3:])
    ball_nodes = _part(ints, ints, BALL_NODE)
    centres = _part(reals, ints, CENTRES).reshape((ball_nodes.shape[0], 3))
    _spread(
        _part(reals, ints, BALLS).reshape((ball_nodes.shape[0], 3)),
        ball_nodes,
        positions,
        rotations,
        centres,
    )
    runs = _part(ints, ints, RUNS).reshape(((ints[RUNS + 1] - ints[RUNS]) // 4, 4))
    pairs = _part(ints, ints, PAIRS).reshape(((ints[PAIRS + 1] - ints[PAIRS]) // 2, 2))
    run_reach, reach = _part(reals, ints, RUN_REACH), _part(reals, ints, PAIR_REACH)
    contacts = _part(reals, ints, CONTACTS).reshape((pairs.shape[0], 12))
    deepest, total, found = 0.0, 0.0, 0
    for run in range(runs.shape[0]):
        one, other = runs[run, 0], runs[run, 1]
        if one != other:
            away = 0.0
            for k in range(3):
                away += (centres[one, k] - centres[other, k]) ** 2
            if away > run_reach[run] * run_reach[run]:
                continue
        for n in range(runs[run, 2], runs[run, 3]):
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
            contact = contacts[found]
            square = 0.0
            for k in range(3):
                contact[2 + k] = ends[i, k] + s * (ends[i, 3 + k] - ends[i, k])
                contact[5 + k] = ends[j, k] + t * (ends[j, 3 + k] - ends[j, k])
                square += (contact[2 + k] - contact[5 + k]) ** 2
            distance = math.sqrt(square)
            overlap = reach[n] - distance
            if overlap <= 0.0:
                continue
            total += overlap * overlap
            deepest = max(deepest, overlap)
            if distance <= SHORT:
                continue
            contact[0], contact[1], contact[11] = nodes[i], nodes[j], overlap
            for k in range(3):
                contact[8 + k] = (contact[2 + k] - contact[5 + k]) / distance
            found += 1
    reals[ints[DEEPEST]] = deepest
    return found, total


@njit(error_model="numpy")
def _press(contacts, count, weight, forces, moments):  # type: ignore[no-untyped-def]
    """Push nodes of capsules that overlap apart, with forces and moments."""
    for n in range(count):
        contact = contacts[n]
        for side in range(2):
            factor = -2.0 * weight * contact[11] if side == 0 else 2.0 * weight * contact[11]
            node = int(contact[side])
            px, py, pz = contact[2 + 3 * side], contact[3 + 3 * side], contact[4 + 3 * side]
            fx, fy, fz = factor * contact[8], factor * contact[9], factor * contact[10]
            forces[node, 0] += fx
            forces[node, 1] += fy
            forces[node, 2] += fz
            moments[node, 0] += py * fz - pz * fy
            moments[node, 1] += pz * fx - px * fz
            moments[node, 2] += px * fy - py * fx


@njit(error_model="numpy")
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


@njit(error_model="numpy")
def _value(x, gradient, wanted, ints, reals):  # type: ignore[no-untyped-def]
    """Work out f at the free coordinates x (n,), its gradient too if wanted; count contacts."""
    q = _part(reals, ints, Q)
    free, active = _part(ints, ints, FREE), _part(ints, ints, ACTIVE)
    parents = _part(ints, ints, PARENTS)
    count, entries = parents.shape[0], (ints[CODES + 1] - ints[CODES]) // 4
    positions = _part(reals, ints, POSITIONS).reshape((count, 3))
    rotations = _part(reals, ints, ROTATIONS).reshape((count, 3, 3))
    codes = _part(ints, ints, CODES).reshape((entries, 4))
    numbers = _part(reals, ints, NUMBERS).reshape((entries, 5))
    values = _part(reals, ints, VALUES).reshape((entries, 3))
    pulls = _part(reals, ints, PULLS).reshape((entries, 3))
    ints[ints[COUNT]] += 1

    for k in range(free.shape[0]):
        q[free[k]] = x[k]
    _forward(q, ints, reals)
    _play(codes, numbers, positions, rotations, values)
    pulls[:] = 0.0
    residuals = (ints[ROWS + 1] - ints[ROWS]) // 3
    f = _compare(
        _part(ints, ints, ROWS).reshape((residuals, 3)),
        _part(reals, ints, ROW_NUMBERS).reshape((residuals, 2)),
        reals[ints[MISS_SHARE]],
        values,
        pulls,
    )
    weight = reals[ints[OVERLAP_WEIGHT]]
    contacts, overlaps = _touch(ints, reals, positions, rotations)
    f += weight * overlaps

    pull_on_q = _part(reals, ints, PULL_ON_Q)
    if wanted:
        forces = _part(reals, ints, FORCES).reshape((count, 3))
        moments = _part(reals, ints, MOMENTS).reshape((count, 3))
        forces[:] = 0.0
        moments[:] = 0.0
        pull_on_q[:] = 0.0
        _rewind(codes, numbers, values, pulls, forces, moments)
        touching = _part(reals, ints, CONTACTS)
        _press(touching.reshape((touching.shape[0] // 12, 12)), contacts, weight, forces, moments)
        _gather(
            active,
            parents,
            _part(ints, ints, DOF_START),
            _part(reals, ints, DOF_SCALE),
            _part(ints, ints, DOF_COORDINATE),
            positions,
            _part(reals, ints, AXES).reshape(((ints[AXES + 1] - ints[AXES]) // 3, 3)),
            forces,
            moments,
            pull_on_q,
        )

    posture = _part(reals, ints, POSTURE).reshape((free.shape[0], 5))
    followed = _part(ints, ints, FOLLOWED)
    for k in range(free.shape[0]):
        reference, keep, middle, half, comfort = posture[k]
        away = _away(x, k, followed[k], reference)
        beyond = _beyond((x[k] - middle) / half)
        f += keep * away * away + comfort * beyond * beyond
        if wanted:
            gradient[k] = pull_on_q[free[k]] + 2.0 * keep * away + 2.0 * comfort * beyond / half
    if wanted:
        for k in range(free.shape[0]):
            if followed[k] >= 0:
                away = _away(x, k, followed[k], posture[k, 0])
                gradient[followed[k]] -= 2.0 * FOLLOWING * posture[k, 1] * away
    return f, contacts


@njit(error_model="numpy")
def _away(x, k, leader, reference):  # type: ignore[no-untyped-def]
    return x[k] - (FOLLOWING * x[leader] if leader >= 0 else reference)


@njit(error_model="numpy")
def _beyond(u):  # type: ignore[no-untyped-def]
    return u - COMFORTABLE if u > COMFORTABLE else min(u + COMFORTABLE, 0.0)


# Polishing: damped Gauss-Newton steps inside the bounds -----------------------------------------


@njit(error_model="numpy")
def _lever(node, point, direction, factor, row, ints, reals):  # type: ignore[no-untyped-def]
    """Add to a row (n,) what coordinates do to a point of a node, along a direction."""
    parents, start = _part(ints, ints, PARENTS), _part(ints, ints, DOF_START)
    coordinate, scale = _part(ints, ints, DOF_COORDINATE), _part(reals, ints, DOF_SCALE)
    column, positions = _part(ints, ints, COLUMN), _part(reals, ints, POSITIONS)
    axes = _part(reals, ints, AXES)
    while node >= 0:
        ax = point[0] - positions[3 * node]
        ay = point[1] - positions[3 * node + 1]
        az = point[2] - positions[3 * node + 2]
        mx = factor * (ay * direction[2] - az * direction[1])
        my = factor * (az * direction[0] - ax * direction[2])
        mz = factor * (ax * direction[1] - ay * direction[0])
        for d in range(start[node], start[node + 1]):
            k = column[coordinate[d]]
            if k >= 0:
                row[k] += scale[d] * (
                    axes[3 * d] * mx + axes[3 * d + 1] * my + axes[3 * d + 2] * mz
                )
        node = parents[node]


@njit(error_model="numpy")
def _turned(node, value, is_point, slope, ints, reals):  # type: ignore[no-untyped-def]
    """Slopes (3, n) of a point or direction that a node carries: axis × arm for each coordinate."""
    parents, start = _part(ints, ints, PARENTS), _part(ints, ints, DOF_START)
    coordinate, scale = _part(ints, ints, DOF_COORDINATE), _part(reals, ints, DOF_SCALE)
    column, positions = _part(ints, ints, COLUMN), _part(reals, ints, POSITIONS)
    axes = _part(reals, ints, AXES)
    ax, ay, az = value[0], value[1], value[2]
    while node >= 0:
        if is_point:
            ax = value[0] - positions[3 * node]
            ay = value[1] - positions[3 * node + 1]
            az = value[2] - positions[3 * node + 2]
        for d in range(start[node], start[node + 1]):
            k = column[coordinate[d]]
            if k >= 0:
                ux, uy, uz = axes[3 * d], axes[3 * d + 1], axes[3 * d + 2]
                slope[0, k] += scale[d] * (uy * az - uz * ay)
                slope[1, k] += scale[d] * (uz * ax - ux * az)
                slope[2, k] += scale[d] * (ux * ay - uy * ax)
        node = parents[node]


@njit(error_model="numpy")
def _add(slopes, t, i, factor, a, j):  # type: ignore[no-untyped-def]
    for v in range(slopes.shape[2]):
        slopes[t, i, v] += factor * slopes[a, j, v]


@njit(error_model="numpy")
def _slopes(codes, numbers, values, slopes, ints, reals):  # type: ignore[no-untyped-def]
    """Work out derivatives (entries, 3, n) of the tape's entries by the free coordinates."""
    slopes[:] = 0.0
    for t in range(codes.shape[0]):
        code, a, b, node = codes[t, 0], codes[t, 1], codes[t, 2], codes[t, 3]
        if code in (POINT, VECTOR):
            _turned(node, values[t], code == POINT, slopes[t], ints, reals)
        elif code == COMBINE:
            for i in range(3):
                _add(slopes, t, i, numbers[t, 3], a, i)
                if b >= 0:
                    _add(slopes, t, i, numbers[t, 4], b, i)
        elif code == UNIT:
            length = math.sqrt(values[a, 0] ** 2 + values[a, 1] ** 2 + values[a, 2] ** 2)
            if length > SHORT:
                for i in range(3):
                    for k in range(3):
                        same = 1.0 if i == k else 0.0
                        _add(slopes, t, i, (same - values[t, i] * values[t, k]) / length, a, k)
        elif code == CROSS:
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                _add(slopes, t, i, values[b, k], a, j)
                _add(slopes, t, i, -values[b, j], a, k)
                _add(slopes, t, i, values[a, j], b, k)
                _add(slopes, t, i, -values[a, k], b, j)
        elif code == TURN:
            cos, sin = numbers[t, 3], numbers[t, 4]
            along = 0.0
            for i in range(3):
                along += values[b, i] * values[a, i]
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                _add(slopes, t, i, cos, a, i)
                _add(slopes, t, i, (1.0 - cos) * along, b, i)
                _add(slopes, t, i, sin * values[b, j], a, k)
                _add(slopes, t, i, -sin * values[b, k], a, j)
                _add(slopes, t, i, sin * values[a, k], b, j)
                _add(slopes, t, i, -sin * values[a, j], b, k)
                for m in range(3):
                    _add(slopes, t, i, (1.0 - cos) * values[b, i] * values[b, m], a, m)
                    _add(slopes, t, i, (1.0 - cos) * values[b, i] * values[a, m], b, m)


@njit(error_model="numpy")
def _add_square(row, error, weight, hessian, gradient):  # type: ignore[no-untyped-def]
    """Add w e² with slope `row` to the quadratic model; of the matrix only the upper triangle."""
    for i in range(row.shape[0]):
        if row[i] != 0.0:
            c = weight * row[i]
            gradient[i] += c * error
            for j in range(i, row.shape[0]):
                hessian[i, j] += c * row[j]


@njit(error_model="numpy")
def _model(x, contacts, row, gradient, hessian, ints, reals):  # type: ignore[no-untyped-def]
    """Gauss-Newton model of f / 2 about the point that was evaluated last."""
    n, entries = x.shape[0], (ints[CODES + 1] - ints[CODES]) // 4
    codes = _part(ints, ints, CODES).reshape((entries, 4))
    numbers = _part(reals, ints, NUMBERS).reshape((entries, 5))
    values = _part(reals, ints, VALUES).reshape((entries, 3))
    slopes = _part(reals, ints, SLOPES).reshape((entries, 3, n))
    _slopes(codes, numbers, values, slopes, ints, reals)
    gradient[:] = 0.0
    hessian[:] = 0.0
    rows, row_numbers = _part(ints, ints, ROWS), _part(reals, ints, ROW_NUMBERS)
    share = reals[ints[MISS_SHARE]]
    for r in range(rows.shape[0] // 3):
        kind, a, b = rows[3 * r], rows[3 * r + 1], rows[3 * r + 2]
        weight = share * row_numbers[2 * r]
        if kind == MEET:
            for i in range(3):
                for v in range(n):
                    row[v] = slopes[a, i, v] - slopes[b, i, v]
                _add_square(row, values[a, i] - values[b, i], weight, hessian, gradient)
            continue
        row[:] = 0.0
        error = 0.0
        if kind == PERPENDICULAR:
            for i in range(3):
                error += values[a, i] * values[b, i]
                for v in range(n):
                    row[v] += values[b, i] * slopes[a, i, v] + values[a, i] * slopes[b, i, v]
        else:
            square = 0.0
            for i in range(3):
                square += (values[a, i] - values[b, i]) ** 2
            gap = math.sqrt(square)
            error = gap - row_numbers[2 * r + 1]
            if gap > SHORT:
                for i in range(3):
                    share = (values[a, i] - values[b, i]) / gap
                    for v in range(n):
                        row[v] += share * (slopes[a, i, v] - slopes[b, i, v])
        _add_square(row, error, weight, hessian, gradient)
    touching = _part(reals, ints, CONTACTS)
    overlap_weight = reals[ints[OVERLAP_WEIGHT]]
    for c in range(contacts):
        contact = touching[12 * c : 12 * c + 12]
        row[:] = 0.0
        _lever(int(contact[0]), contact[2:5], contact[8:11], -1.0, row, ints, reals)
        _lever(int(contact[1]), contact[5:8], contact[8:11], 1.0, row, ints, reals)
        _add_square(row, contact[11], overlap_weight, hessian, gradient)
    posture, followed = _part(reals, ints, POSTURE), _part(ints, ints, FOLLOWED)
    for k in range(n):
        reference, keep = posture[5 * k], posture[5 * k + 1]
        middle, half, comfort = posture[5 * k + 2], posture[5 * k + 3], posture[5 * k + 4]
        beyond = _beyond((x[k] - middle) / half)
        away, leader = _away(x, k, followed[k], reference), followed[k]
        gradient[k] += keep * away + comfort * beyond / half
        if leader >= 0:
            gradient[leader] -= FOLLOWING * keep * away
            hessian[leader, leader] += FOLLOWING**2 * keep
            hessian[min(k, leader), max(k, leader)] -= FOLLOWING * keep
        hessian[k, k] += keep + (comfort / half**2 if beyond != 0.0 else 0.0)


@njit(error_model="numpy")
def _newton_step(free, count, damping, gradient, hessian, factor, step):  # type: ignore[no-untyped-def]
    """Solve (H + damping · diag H) p = −g for some coordinates; `step` holds the others' moves."""
    n = gradient.shape[0]
    for r in range(count):
        i = free[r]
        rhs = -gradient[i]
        for j in range(n):
            if step[j] != 0.0:
                rhs -= (hessian[i, j] if j >= i else hessian[j, i]) * step[j]
        factor[r, count] = rhs
        for c in range(r, count):
            factor[r, c] = hessian[i, free[c]]
        factor[r, r] += damping * factor[r, r] + 1e-12
    for r in range(count):
        pivot = math.sqrt(max(factor[r, r], 1e-300))
        for c in range(r, count + 1):
            factor[r, c] /= pivot
        for i in range(r + 1, count):
            share = factor[r, i]
            if share != 0.0:
                for c in range(i, count + 1):
                    factor[i, c] -= share * factor[r, c]
    for r in range(count - 1, -1, -1):
        solved = factor[r, count]
        for c in range(r + 1, count):
            solved -= factor[r, c] * step[free[c]]
        step[free[r]] = solved / factor[r, r]


@njit(error_model="numpy")
def _bounded_step(x, bounds, free, damping, gradient, hessian, factor, step):  # type: ignore[no-untyped-def]
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
    while count > 0:
        for r in range(count):
            step[free[r]] = 0.0
        _newton_step(free, count, damping, gradient, hessian, factor, step)
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
        count = left
    foreseen = 0.0
    for i in range(x.shape[0]):
        if step[i] != 0.0:
            bent = 0.5 * hessian[i, i] * step[i]
            for j in range(i + 1, x.shape[0]):
                bent += hessian[i, j] * step[j]
            foreseen -= 2.0 * step[i] * (gradient[i] + bent)
    return foreseen


@njit(error_model="numpy", inline="always")
def _improve(x, gradient, ints, reals):  # type: ignore[no-untyped-def]
    """Polish x (n,) for the block's number of rounds; return f, with its gradient if that is 0."""
    n = x.shape[0]
    hessian = _part(reals, ints, HESSIAN).reshape((n, n))
    factor = _part(reals, ints, FACTOR).reshape((n, n + 1))
    vectors = _part(reals, ints, VECTORS)[: 4 * n].reshape((4, n))
    row, model, step, trial = vectors[0], vectors[1], vectors[2], vectors[3]
    free = ints[ints[VECTORS] + 4 * n : ints[VECTORS] + 5 * n]
    bounds = _part(reals, ints, BOUNDS).reshape((2, n))
    rounds, tolerance = ints[ints[ROUNDS]], reals[ints[TOLERANCE]]
    damping, growth, foreseen, value = reals[ints[DAMPING]], 2.0, 0.0, np.inf
    for k in range(n):
        trial[k] = x[k]
    while True:
        other, contacts = _value(trial, gradient, rounds == 0, ints, reals)
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
                _model(x, contacts, row, model, hessian, ints, reals)
        else:
            damping *= growth
            growth *= 2.0
        if done or damping > MOST_DAMPING:
            reals[ints[DAMPING]] = damping
            return value
        rounds -= 1
        foreseen = _bounded_step(x, bounds, free, damping, model, hessian, factor, step)
        for k in range(n):
            trial[k] = min(max(x[k] + step[k], bounds[0, k]), bounds[1, k])


@cfunc(
    types.float64(
        types.uint32, types.CPointer(types.float64), types.CPointer(types.float64), types.voidptr
    ),
    cache=True,
    error_model="numpy",
)
def evaluate(count, place, slope, block):  # type: ignore[no-untyped-def]
    """Return f at x (n,) and write its gradient (n,): NLopt's `nlopt_func`.

    The lowest point so far is kept in the block: a method that gives up loses it. Where f is
    undefined a huge value without slope makes a line search step back.

    With rounds in the block x is first polished in place, never to a higher value, by damped
    Gauss-Newton steps inside the bounds (Levenberg 1944, Marquardt 1963; damped as by Nielsen
    1999): every term of f is a square, so that its model needs first derivatives only. A relative
    gain below the block's tolerance ends it, or as many rounds. It is the same entry because
    every entry is a copy of the whole objective, to be compiled once and loaded by every process.
    """
    n = np.int64(count)
    size = carray(block, (1,), np.int64)[0]
    ints, reals = carray(block, (size,), np.int64), carray(block, (size,), np.float64)
    x, gradient = carray(place, (n,)), carray(slope, (n,))
    value = _improve(x, gradient, ints, reals)
    if not math.isfinite(value):
        for k in range(n):
            gradient[k] = 0.0
        return UNDEFINED
    best = _part(reals, ints, BEST)
    if value < best[0]:
        best[0] = value
        for k in range(n):
            best[1 + k] = x[k]
    return value
