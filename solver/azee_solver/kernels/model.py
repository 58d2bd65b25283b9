"""The Gauss-Newton model of an objective: every term is a square."""

from __future__ import annotations

import math

from numba import njit

from azee_rig.pointers import INNER
from azee_solver.block import (
    CODES,
    CONTACTS,
    FOLLOWED,
    FOLLOWING,
    MEET,
    MISS_SHARE,
    NUMBERS,
    OVERLAP_WEIGHT,
    PERPENDICULAR,
    POSTURE,
    ROW_NUMBERS,
    ROWS,
    SHORT,
    SLOPES,
    VALUES,
)
from azee_solver.kernels.objective import beyond_comfort, reference_error
from azee_solver.kernels.residuals import beyond_slack
from azee_solver.kernels.sections import along, matrix, part, stack
from azee_solver.kernels.slopes import differentiate, lever


@njit(**INNER)
def _add_square(row, error, weight, hessian, gradient):
    """Add w e² with slope `row` to the quadratic model; of the matrix only the upper triangle."""
    for i in range(row.shape[0]):
        if row[i] != 0.0:
            c = weight * row[i]
            gradient[i] += c * error
            for j in along(i, row.shape[0]):
                hessian[i, j] += c * row[j]


@njit(**INNER)
def _add_squares(three, errors, weight, hessian, gradient):
    """Do that for three rows at once, (3, n): one loop over columns is quicker than three."""
    for i in range(three.shape[1]):
        a, b, c = weight * three[0, i], weight * three[1, i], weight * three[2, i]
        if a != 0.0 or b != 0.0 or c != 0.0:
            gradient[i] += a * errors[0] + b * errors[1] + c * errors[2]
            for j in along(i, three.shape[1]):
                hessian[i, j] += a * three[0, j] + b * three[1, j] + c * three[2, j]


@njit(**INNER)
def gauss_newton(x, contacts, three, gradient, hessian, ints, reals):
    """Gauss-Newton model of f / 2 about the point that was evaluated last.

    Args: three: (3, n) room to work in.
    """
    n, entries = x.shape[0], (ints[CODES + 1] - ints[CODES]) // 4
    codes = matrix(ints, ints, CODES, entries, 4)
    numbers = matrix(reals, ints, NUMBERS, entries, 5)
    values = matrix(reals, ints, VALUES, entries, 3)
    slopes = stack(reals, ints, SLOPES, entries, 3, n)
    differentiate(codes, numbers, values, slopes, ints, reals)
    row = three[0]
    gradient[:] = 0.0
    hessian[:] = 0.0
    rows, row_numbers = part(ints, ints, ROWS), part(reals, ints, ROW_NUMBERS)
    share = reals[ints[MISS_SHARE]]
    for r in range(rows.shape[0] // 3):
        kind, a, b = rows[3 * r], rows[3 * r + 1], rows[3 * r + 2]
        weight = share * row_numbers[3 * r]
        if kind == MEET:
            for i in range(3):
                for v in range(n):
                    three[i, v] = slopes[a, i, v] - slopes[b, i, v]
            errors = (
                values[a, 0] - values[b, 0],
                values[a, 1] - values[b, 1],
                values[a, 2] - values[b, 2],
            )
            _add_squares(three, errors, weight, hessian, gradient)
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
            error = gap - row_numbers[3 * r + 1]
            if gap > SHORT:
                for i in range(3):
                    part_of_gap = (values[a, i] - values[b, i]) / gap
                    for v in range(n):
                        row[v] += part_of_gap * (slopes[a, i, v] - slopes[b, i, v])
        error = beyond_slack(error, row_numbers[3 * r + 2])
        if error != 0.0:
            _add_square(row, error, weight, hessian, gradient)
    touching = part(reals, ints, CONTACTS)
    overlap_weight = reals[ints[OVERLAP_WEIGHT]]
    for c in range(contacts):
        contact = touching[12 * c : 12 * c + 12]
        row[:] = 0.0
        lever(int(contact[0]), contact[2:5], contact[8:11], -1.0, row, ints, reals)
        lever(int(contact[1]), contact[5:8], contact[8:11], 1.0, row, ints, reals)
        _add_square(row, contact[11], overlap_weight, hessian, gradient)
    posture, followed = part(reals, ints, POSTURE), part(ints, ints, FOLLOWED)
    for k in range(n):
        reference, keep = posture[5 * k], posture[5 * k + 1]
        middle, half, comfort = posture[5 * k + 2], posture[5 * k + 3], posture[5 * k + 4]
        beyond = beyond_comfort((x[k] - middle) / half)
        away, leader = reference_error(x, k, followed[k], reference), followed[k]
        gradient[k] += keep * away + comfort * beyond / half
        if leader >= 0:
            gradient[leader] -= FOLLOWING * keep * away
            hessian[leader, leader] += FOLLOWING**2 * keep
            hessian[min(k, leader), max(k, leader)] -= FOLLOWING * keep
        hessian[k, k] += keep + (comfort / half**2 if beyond != 0.0 else 0.0)
