"""NLopt behind its one function, and where descents start."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from stick_body import stick_body

from azee_solver.nlopt_backend import Compiled, c_interface, minimise
from azee_solver.starts import starts

Array = NDArray[np.float64]
LOWER, UPPER = np.array([-1.0, -1.0]), np.array([1.0, 2.0])


def run(objective: object, start: tuple[float, float] = (0.0, 0.0)) -> tuple[Array, float]:
    found = minimise(
        objective,  # type: ignore[arg-type]
        np.array(start),
        LOWER,
        UPPER,
        max_evaluations=200,
        tolerance=1e-12,
    )
    return found.x, found.value


def bowl(x: Array, gradient: Array, centre: tuple[float, float] = (0.5, 1.0)) -> float:
    away = x - centre
    gradient[:] = 2 * away * (1, 10)
    return float(away @ (away * (1, 10)))


def test_it_finds_a_minimum() -> None:
    x, value = run(bowl)
    np.testing.assert_allclose(x, [0.5, 1.0], atol=1e-6)
    assert value < 1e-10


def test_a_start_outside_is_clipped_and_bounds_hold_to_the_bit() -> None:
    x, _ = run(lambda x, g: bowl(x, g, (7.0, -0.1)), (9.0, -9.0))
    assert x[0] == UPPER[0]
    assert x[1] == pytest.approx(-0.1, abs=1e-6)


def test_nan_is_stepped_back_from() -> None:
    def cliff(x: Array, gradient: Array) -> float:
        value = bowl(x, gradient)
        if x[0] > 0.3:
            gradient[:] = np.nan
            return float("nan")
        return value

    x, value = run(cliff, (-0.9, 0.0))
    assert np.isfinite(value)
    assert x[0] <= 0.3
    assert value < bowl(np.array([-0.9, 0.0]), np.empty(2))


def test_nothing_but_nan_gives_the_start_back() -> None:
    x, _ = run(lambda x, g: float("nan"), (0.25, 0.5))
    np.testing.assert_array_equal(x, [0.25, 0.5])


def test_an_error_in_the_objective_is_not_swallowed() -> None:
    def broken(x: Array, gradient: Array) -> float:
        raise KeyError("mine")

    with pytest.raises(KeyError):
        run(broken)


@pytest.mark.parametrize("last", range(1, 12))
def test_an_interruption_ends_the_descent_whenever_it_comes(last: int) -> None:
    """NLopt is not asked on, which fails in its own way."""
    calls = 0

    def interrupted(x: Array, gradient: Array) -> float:
        nonlocal calls
        calls += 1
        if calls == last:
            raise KeyboardInterrupt
        if calls > last:
            raise RuntimeError("a result with an exception set")
        return bowl(x**3, gradient)

    with pytest.raises(KeyboardInterrupt):
        run(interrupted, (0.9, -0.7))


def compiled() -> Compiled:
    """Code that is never called, laid out for NLopt."""
    return Compiled(0, 0, LOWER, UPPER, np.empty(1 + len(LOWER)))


def test_an_interruption_while_optimisers_are_destroyed_is_not_lost(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Python drops what is raised in a `__del__`; pytest reports it as a warning, an error here."""
    library = c_interface()
    assert library is not None
    destroyed = []
    destroy = library.nlopt_destroy

    def interrupted(optimiser: int) -> None:
        destroyed.append(optimiser)
        destroy(optimiser)
        raise KeyboardInterrupt

    gone = compiled()
    monkeypatch.setattr(library, "nlopt_destroy", interrupted)
    del gone
    with pytest.raises(KeyboardInterrupt):
        compiled()
    assert len(destroyed) == 1


def test_optimisers_of_what_is_gone_are_destroyed_each_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    library = c_interface()
    assert library is not None
    compiled()
    compiled()  # by then those of earlier tests are destroyed
    destroyed: list[int] = []
    monkeypatch.setattr(library, "nlopt_destroy", destroyed.append)
    kept = compiled()
    for _ in range(5):
        compiled()
    assert len(destroyed) == 5
    assert len(set(destroyed)) == 5
    assert not set(destroyed) & set(kept._optimisers.values())


def test_the_best_point_survives_an_objective_that_gets_worse() -> None:
    calls = []

    def lying(x: Array, gradient: Array) -> float:
        calls.append(x.copy())
        gradient[:] = bowl(x, gradient) and 1.0
        return float(len(calls))

    x, value = run(lying, (0.1, 0.2))
    assert value == 1.0
    np.testing.assert_array_equal(x, [0.1, 0.2])


def test_starts_are_inside_the_limits_reproducible_and_all_different() -> None:
    limits = stick_body().coordinates
    free = np.array([v for v, n in enumerate(limits.names) if n.startswith(("arm_R", "f_arm_R"))])
    at_hand = np.full(len(limits), 9.0)
    found = list(starts(limits, free, at_hand))
    assert len(found) == 2 + 9
    for x in found:
        assert np.all(x >= limits.lower[free])
        assert np.all(x <= limits.upper[free])
    assert len({x.tobytes() for x in found}) == len(found)
    again = list(starts(limits, free, at_hand))
    assert [x.tobytes() for x in again] == [x.tobytes() for x in found]
    np.testing.assert_array_equal(found[0], limits.upper[free])


def test_without_an_arm_there_are_no_typical_postures() -> None:
    limits = stick_body().coordinates
    free = np.array([limits.index["head.flexion"]])
    assert len(list(starts(limits, free, np.array(limits.upper)))) == 2
