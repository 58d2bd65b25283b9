"""Cholesky's factor of a symmetric matrix with a band, and what it solves.

Row r of a band holds the entries (r, r), (r, r + 1), … (r, r + w) of the matrix. Zeros inside the
band cost nothing: coordinates that no term couples stay apart by themselves.
"""

from __future__ import annotations

import math

from numba import njit

from azee_rig.pointers import INNER
from azee_solver.kernels.sections import along

LEAST_PIVOT = 1e-300


@njit(**INNER)
def factorise(band):
    """Replace a band (N, w + 1) of A by that of Lᵀ, with A = L Lᵀ (Golub & Van Loan 2013, 4.3)."""
    count, width = band.shape
    for r in range(count):
        row = band[r]
        scale = 1.0 / math.sqrt(max(row[0], LEAST_PIVOT))
        reach = 0
        for d in range(min(width, count - r)):
            row[d] *= scale
            if row[d] != 0.0:
                reach = d
        for d in range(1, reach + 1):
            share = row[d]
            if share != 0.0:
                other = band[r + d]
                for e in along(0, reach + 1 - d):
                    other[e] -= share * row[d + e]


@njit(**INNER)
def solve(band, x):
    """Replace x (N,) by A⁻¹ x, for the band (N, w + 1) of the factor of A."""
    count, width = band.shape
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
