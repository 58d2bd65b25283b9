"""Cholesky's factor of a symmetric matrix with a band, and what it solves.

Row r of a band holds the entries (r, r), (r, r + 1), … (r, r + w) of the matrix, and then
`BAND_PAD` zeros.
"""

from __future__ import annotations

import math

from numba import njit

from azee_rig.pointers import INNER
from azee_solver.block import BAND_PAD as PAD
from azee_solver.kernels.sections import along

LEAST_PIVOT = 1e-300


@njit(**INNER)
def factorise(band, width):
    """Replace a band (N, w + 1 + PAD) of A by that of Lᵀ; A = L Lᵀ (Golub & Van Loan 2013, 4.3).

    Args: width: w + 1.
    """
    count, first = band.shape[0], 0
    while first + PAD <= count:
        for k in range(PAD):
            _scale(band[first + k], width)
            for d in range(1, min(PAD - k, width)):
                _subtract(band[first + k], d, band[first + k + d], width)
        for d in range(PAD, min(width + PAD - 1, count - first)):
            _subtract_rows(band[first : first + PAD], d, band[first + d], width)
        first += PAD
    for r in range(first, count):
        _scale(band[r], width)
        for d in range(1, min(width, count - r)):
            _subtract(band[r], d, band[r + d], width)


@njit(**INNER)
def _scale(row, width):
    """Divide a row by the root of its first number."""
    scale = 1.0 / math.sqrt(max(row[0], LEAST_PIVOT))
    for d in along(0, width):
        row[d] *= scale


@njit(**INNER)
def _subtract(row, d, other, width):
    """Subtract what a finished row leaves on the one that is d below it."""
    p = row[d]
    if p != 0.0:
        for e in along(0, width - d):
            other[e] -= p * row[d + e]


@njit(**INNER)
def _subtract_rows(rows, d, other, width):
    """Subtract what `PAD` finished rows leave on the one that is d below the first of them.

    Their zeros at the end let one loop serve them all.
    """
    p0, p1, p2, p3 = rows[0, d], rows[1, d - 1], rows[2, d - 2], rows[3, d - 3]
    p4, p5, p6, p7 = rows[4, d - 4], rows[5, d - 5], rows[6, d - 6], rows[7, d - 7]
    if p0 == p1 == p2 == p3 == p4 == p5 == p6 == p7 == 0.0:
        return
    a0, a1, a2, a3 = rows[0, d:], rows[1, d - 1 :], rows[2, d - 2 :], rows[3, d - 3 :]
    a4, a5, a6, a7 = rows[4, d - 4 :], rows[5, d - 5 :], rows[6, d - 6 :], rows[7, d - 7 :]
    for e in along(0, width + PAD - 1 - d):
        other[e] -= (
            p0 * a0[e] + p1 * a1[e] + p2 * a2[e] + p3 * a3[e]
            + p4 * a4[e] + p5 * a5[e] + p6 * a6[e] + p7 * a7[e]
        )  # fmt: skip


@njit(**INNER)
def solve(band, width, x):
    """Replace x (N,) by A⁻¹ x, for the band (N, w + 1 + PAD) of the factor of A."""
    count = band.shape[0]
    for r in range(count):
        row = band[r]
        x[r] /= row[0]
        value = x[r]
        if value != 0.0:
            for d in along(1, min(width, count - r)):
                x[r + d] -= row[d] * value
    for r in range(count - 1, -1, -1):
        row = band[r]
        total = x[r]
        for d in along(1, min(width, count - r)):
            total -= row[d] * x[r + d]
        x[r] = total / row[0]
