"""Residuals: the tape run both ways, and the sum of squares that it gives."""

from __future__ import annotations

import math

from numba import njit

from azee_rig.pointers import INNER
from azee_solver.block import (
    COMBINE,
    CONSTANT,
    CROSS,
    MEET,
    PERPENDICULAR,
    POINT,
    SHORT,
    TURN,
    UNIT,
    VECTOR,
)


@njit(**INNER)
def forward_sweep(codes, numbers, positions, rotations, values):
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


@njit(**INNER)
def reverse_sweep(codes, numbers, values, pulls, forces, moments):
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


@njit(**INNER)
def beyond_slack(e, slack):
    """Return how far a residual is beyond the dead zone of ± slack."""
    if e > slack:
        return e - slack
    return e + slack if e < -slack else 0.0


@njit(**INNER)
def residual_cost(rows, row_numbers, share, values, pulls):
    """Sum of σ w e² over the residuals, and its pulls on the entries they compare."""
    f = 0.0
    for k in range(rows.shape[0]):
        kind, a, b = rows[k, 0], rows[k, 1], rows[k, 2]
        weight = share * row_numbers[k, 0]
        if kind == PERPENDICULAR:
            e = 0.0
            for i in range(3):
                e += values[a, i] * values[b, i]
            e = beyond_slack(e, row_numbers[k, 2])
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
            e = beyond_slack(gap - row_numbers[k, 1], row_numbers[k, 2])
            f += weight * e * e
            factor = 2.0 * weight * e / gap if gap > SHORT else 0.0
        for i in range(3):
            pull = factor * (values[a, i] - values[b, i])
            pulls[a, i] += pull
            pulls[b, i] -= pull
    return f
