"""One descent on a problem's objective: from afar by NLopt, to the bottom by Gauss-Newton steps.

The postures that nearly meet everything are a valley, and the one most at ease lies on its floor.
At its full price a miss makes the valley so narrow that every step along it is short. So misses
and overlaps cost but a hundredth at first, as if tolerances were ten times as wide: there few
evaluations lead to the right part of the floor, and from there few steps to its bottom. Of the
postures found so more are the best that are known than of those found at the full price at once.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee_solver import block
from azee_solver.options import SolveOptions
from azee_solver.program import Program

Array = NDArray[np.float64]

SOFT = 0.002
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


class weighing:  # noqa: N801 - used as a statement
    """Let misses and overlaps cost parts of what they do, as long as a `with` lasts.

    Args: each: parts for single rows, (R,). ease: parts that posture and comfort cost, per free
        coordinate, (n,).
    """

    def __init__(
        self,
        program: Program,
        *,
        misses: float = 1.0,
        overlap: float = 1.0,
        each: Array | None = None,
        ease: Array | None = None,
    ) -> None:
        self._program, self._shares = program, (misses, overlap)
        self._each, self._ease = each, ease
        self._kept: list[tuple[Array, Array | float]] = []

    def __enter__(self) -> None:
        program = self._program
        for price, share in zip(program.prices, self._shares, strict=True):
            self._kept.append((price, float(price[0])))
            price[0] *= share
        if self._each is not None:
            self._keep(program.section(block.ROW_NUMBERS))[::2] *= self._each
        if self._ease is not None:
            posture = self._keep(program.section(block.POSTURE))
            posture[1::5] *= self._ease
            posture[4::5] *= self._ease

    def _keep(self, section: Array) -> Array:
        self._kept.append((section, section.copy()))
        return section

    def __exit__(self, *failure: object) -> None:
        for section, values in self._kept:
            section[:] = values
