"""What NLopt and Gauss-Newton steps do with a laid-out problem."""

from __future__ import annotations

import numpy as np
import pytest
from kernel_case import Case, everything
from numpy.typing import NDArray
from stick_body import stick_body

from azee_solver import nlopt_backend
from azee_solver.layout import Layout


@pytest.mark.parametrize("seed", range(3))
def test_nlopt_gives_the_same_bytes_through_c_and_through_python(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    case, program = everything(seed)
    x = case.q[program.free]
    assert nlopt_backend.c_interface() is not None
    compiled = program.lbfgs(x, max_evaluations=150, tolerance=1e-6)
    monkeypatch.setattr(nlopt_backend, "c_interface", lambda: None)
    called = program.lbfgs(x, max_evaluations=150, tolerance=1e-6)
    assert compiled.tobytes() == called.tobytes()
    assert program(compiled, np.empty(0)) < 0.5 * program(x, np.empty(0))


@pytest.mark.parametrize("seed", range(4))
def test_gauss_newton_ends_where_nothing_pulls_but_into_a_limit(seed: int) -> None:
    case, program = everything(seed)
    start = program.lbfgs(case.q[program.free], max_evaluations=100, tolerance=1e-2)
    before = program(start, np.empty(0))
    x = program.gauss_newton(start, rounds=300, tolerance=1e-14)
    gradient = np.empty(len(x))
    assert program(x, gradient) <= before
    assert np.all(x >= program.lower)
    assert np.all(x <= program.upper)
    at_limit = ((x == program.lower) & (gradient > 0)) | ((x == program.upper) & (gradient < 0))
    first = np.empty(len(x))
    program(start, first)
    assert np.abs(gradient[~at_limit]).max() < 1e-3 * np.abs(first).max()


def test_gauss_newton_on_a_single_coordinate_is_newton_s_method() -> None:
    """One parabola: a step or two reach its bottom to the last digits."""
    case = Case(3, [stick_body().coordinates.index["head.axial"]])
    program = case.program([], keep=2.0)
    x = program.gauss_newton(np.array([0.4]), rounds=10, tolerance=0.0)
    assert x[0] == pytest.approx(case.rig.coordinates.idle[program.free[0]], abs=1e-9)


@pytest.mark.parametrize("free", [[], [3], None], ids=["nothing", "one", "everything"])
def test_kernels_write_nowhere_but_into_their_block(
    free: list[int] | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With nothing to move, matrices have no first row: a loop over it would end in the heap."""
    untouched, blocks = 4242, []
    lay_out = Layout.block

    def padded(layout: Layout) -> NDArray[np.int64]:
        whole = np.full(layout.size + 64, untouched)
        whole[: layout.size] = lay_out(layout)
        blocks.append(whole)
        return whole[: layout.size]

    monkeypatch.setattr(Layout, "block", padded)
    case, program = everything(5, free)
    x = case.q[program.free]
    program(x, np.empty(len(x)))
    x = program.lbfgs(x, max_evaluations=10, tolerance=1e-6)
    program.gauss_newton(x, rounds=10, tolerance=0.0)
    (block,) = blocks
    assert np.all(block[-64:] == untouched)
