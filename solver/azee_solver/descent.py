"""One descent on a problem's objective: from afar by NLopt, to the bottom by Gauss-Newton steps.

The postures that nearly meet everything are a valley, and the one most at ease lies on its floor.
At its full price a miss makes the valley so narrow that every step along it is short. So misses
and overlaps cost but a hundredth at first, as if tolerances were ten times as wide: there few
evaluations lead to the right part of the floor, and from there few steps to its bottom. Of the
postures found so more are the best that are known than of those found at the full price at once.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray

from azee_solver import kernels
from azee_solver.options import SolveOptions
from azee_solver.program import Program

Array = NDArray[np.float64]

SOFT = 0.01
"""Part of their price that misses and overlaps cost at first."""


def descended(program: Program, start: Array, options: SolveOptions) -> Array:
    """Return where a descent from a start ends, (n,), inside the bounds."""
    with weighing(program, misses=SOFT, overlap=SOFT):
        x = program.descend(
            start,
            max_evaluations=options.approach_evaluations,
            tolerance=options.descent_tolerance,
        )
        x = program.polish(x, rounds=options.polish_rounds, tolerance=options.descent_tolerance)
    return refined(program, x, options)


def pressed(program: Program, start: Array, options: SolveOptions) -> Array:
    """Return where a descent at the full price ends, (n,): it stays on its side of the body."""
    x = program.descend(
        start, max_evaluations=options.max_evaluations, tolerance=options.descent_tolerance
    )
    return refined(program, x, options)


def refined(program: Program, x: Array, options: SolveOptions) -> Array:
    """Return where Gauss-Newton steps lead from a point that is near already, (n,)."""
    return program.polish(x, rounds=options.polish_rounds, tolerance=options.polish_tolerance)


@contextmanager
def weighing(
    program: Program,
    *,
    misses: float | Array = 1.0,
    ease: float | Array = 1.0,
    overlap: float = 1.0,
) -> Iterator[None]:
    """Let misses, posture with comfort, and overlap cost parts of what they do.

    Args: misses: of all, or per row. ease: of all, or per free coordinate.
    """
    sections = (kernels.ROW_NUMBERS, kernels.POSTURE, kernels.OVERLAP_WEIGHT)
    rows, posture, resistance = (program.section(section) for section in sections)
    kept = rows.copy(), posture.copy(), resistance.copy()
    rows[::2] *= misses
    resistance *= overlap
    if np.any(ease != 1.0):
        posture[1::5] *= ease
        posture[4::5] *= ease
    try:
        yield
    finally:
        rows[:], posture[:], resistance[:] = kept
