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
def _pivot(row, stop):
    """Scale a row by the root of its first number; return how far it reaches."""
    scale = 1.0 / math.sqrt(max(row[0], LEAST_PIVOT))
    reach = 0
    for d in range(stop):
        row[d] *= scale
        if row[d] != 0.0:
            reach = d
    return reach


@njit(**INNER)
def factorise(band):
    """Replace a band (N, w + 1) of A by that of Lᵀ, with A = L Lᵀ (Golub & Van Loan 2013, 4.3).

    Two rows at a time: one loop over columns is quicker than two.
    """
    count, width = band.shape
    for r in range(0, count, 2):
        one = band[r]
        reach = _pivot(one, min(width, count - r))
        if r + 1 == count:
            break
        two = band[r + 1]
        share = one[1]
        if share != 0.0:
            for e in along(0, reach):
                two[e] -= share * one[e + 1]
        after = _pivot(two, min(width, count - r - 1))
        for d in range(2, max(reach, after + 1) + 1):
            p = one[d] if d <= reach else 0.0
            q = two[d - 1] if d - 1 <= after else 0.0
            other = band[r + d]
            if p != 0.0 and q != 0.0:
                both = min(reach - d, after - d + 1) + 1
                for e in along(0, both):
                    other[e] -= p * one[d + e] + q * two[d - 1 + e]
                for e in along(both, reach - d + 1):
                    other[e] -= p * one[d + e]
                for e in along(both, after - d + 2):
                    other[e] -= q * two[d - 1 + e]
            elif p != 0.0:
                for e in along(0, reach - d + 1):
                    other[e] -= p * one[d + e]
            elif q != 0.0:
                for e in along(0, after - d + 2):
                    other[e] -= q * two[d - 1 + e]


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
