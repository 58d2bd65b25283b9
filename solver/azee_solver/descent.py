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

from azee_solver import block
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
    misses: float = 1.0,
    overlap: float = 1.0,
    each: Array | None = None,
    ease: Array | None = None,
) -> Iterator[None]:
    """Let misses and overlaps cost parts of what they do.

    Args: each: parts for single rows, (R,). ease: parts that posture and comfort cost, per free
        coordinate, (n,).
    """
    share, resistance, rows, posture = (
        program.section(section)
        for section in (
            block.MISS_SHARE,
            block.OVERLAP_WEIGHT,
            block.ROW_NUMBERS,
            block.POSTURE,
        )
    )
    changed = [share, resistance]
    changed += [] if each is None else [rows]
    changed += [] if ease is None else [posture]
    kept = [section.copy() for section in changed]
    share *= misses
    resistance *= overlap
    if each is not None:
        rows[::2] *= each
    if ease is not None:
        posture[1::5] *= ease
        posture[4::5] *= ease
    try:
        yield
    finally:
        for section, values in zip(changed, kept, strict=True):
            section[:] = values
