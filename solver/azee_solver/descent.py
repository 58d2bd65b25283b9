"""One descent on a problem's objective: NLopt from afar, Gauss-Newton steps to the bottom.

The postures that nearly meet all constraints form a narrow valley of the objective, and the one of
least posture cost lies on its floor. At the full weights every step along the valley is short. So
a soft descent is a continuation in two stages: misses and overlaps first have a five-hundredth of
their weights, where few evaluations lead to the right part of the floor, then all of it (ADR 27:
17 to 26 evaluations instead of 36 to 65, and 94 to 100 % of the ends are the best known instead of
57 to 75 %).
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

SOFT = 0.002
"""Part of their weights that misses and overlaps have in the first stage."""


def soft_descent(program: Program, start: Array, options: SolveOptions) -> Array:
    """Return where a descent in two stages ends, (n,), inside the bounds."""
    with scaled_weights(program, misses=SOFT, overlap=SOFT):
        x = program.lbfgs(
            start,
            max_evaluations=options.approach_evaluations,
            tolerance=options.descent_tolerance,
        )
        x = program.gauss_newton(
            x, rounds=options.gauss_newton_rounds, tolerance=options.descent_tolerance
        )
    return refined(program, x, options)


def stiff_descent(program: Program, start: Array, options: SolveOptions) -> Array:
    """Return where a descent at the full weights ends, (n,): it stays on its side of the body."""
    x = program.lbfgs(
        start, max_evaluations=options.max_evaluations, tolerance=options.descent_tolerance
    )
    return refined(program, x, options)


def refined(program: Program, x: Array, options: SolveOptions) -> Array:
    """Return where Gauss-Newton steps lead from a point that is near already, (n,)."""
    return program.gauss_newton(
        x, rounds=options.gauss_newton_rounds, tolerance=options.gauss_newton_tolerance
    )


@contextmanager
def without_margin(program: Program) -> Iterator[None]:
    """Leave out the margin around trunk and head for as long as a `with` lasts."""
    reach = program.section(block.PAIR_REACH)
    wished = reach.copy()
    reach -= program.layout.margin
    try:
        yield
    finally:
        reach[:] = wished


class scaled_weights:  # noqa: N801 - used as a statement
    """Scale weights of the objective for as long as a `with` lasts.

    Args: misses, overlap: factors of all residuals and of overlap. posture: factors of posture and
        joint-limit cost per free coordinate, (n,).
    """

    def __init__(
        self,
        program: Program,
        *,
        misses: float = 1.0,
        overlap: float = 1.0,
        posture: Array | None = None,
    ) -> None:
        self._program, self._factors = program, (misses, overlap)
        self._posture = posture
        self._kept: list[tuple[Array, Array | float]] = []

    def __enter__(self) -> None:
        program = self._program
        for weight, factor in zip(program.weights, self._factors, strict=True):
            self._kept.append((weight, float(weight[0])))
            weight[0] *= factor
        if self._posture is not None:
            posture = self._keep(program.section(block.POSTURE))  # of 5: 1 keep, 4 comfort
            posture[1::5] *= self._posture
            posture[4::5] *= self._posture

    def _keep(self, section: Array) -> Array:
        self._kept.append((section, section.copy()))
        return section

    def __exit__(self, *failure: object) -> None:
        for section, values in self._kept:
            section[:] = values
