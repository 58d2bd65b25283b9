"""Manners are laws of time: where a movement is fastest, and where it is when."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from azee.animation import animate
from azee.clip.spline import minimum_jerk
from azee.lang.program import evaluate_expression
from azee.motion.curves.manner import LAWS, share_of_way
from azee_rig.rig import Rig
from azee_solver.constraint import Manner

TAU = np.linspace(0.0, 1.0, 1001)
MANNERS = [None, *Manner]
FASTEST = {None: 0.5, Manner.TENSE: 0.5, Manner.SLOW_START: 2 / 3, Manner.SHARP_STOP: 0.8,
           Manner.SOFT: 0.5}  # fmt: skip


@pytest.mark.parametrize("manner", MANNERS)
def test_a_law_leads_from_start_to_end_without_turning_back(manner: Manner | None) -> None:
    share = share_of_way(TAU, manner)
    assert (share[0], share[-1]) == (0.0, pytest.approx(1.0))
    assert np.all(np.diff(share) >= 0.0)
    speed = np.gradient(share, TAU)
    assert TAU[speed.argmax()] == pytest.approx(FASTEST[manner], abs=0.01)


def test_every_manner_has_a_law_and_minimum_jerk_is_one_of_them() -> None:
    assert LAWS.keys() == {*Manner}
    found = share_of_way(TAU, None)
    np.testing.assert_allclose(found, minimum_jerk(TAU))


@given(st.floats(0.01, 0.99), st.sampled_from([*Manner]))
def test_the_speed_is_that_of_the_formula(tau: float, manner: Manner) -> None:
    a, b = LAWS[manner]
    h = 1e-5
    slope = (share_of_way(tau + h, manner) - share_of_way(tau - h, manner)) / (2 * h)
    middle = (share_of_way(0.5 + h, manner) - share_of_way(0.5 - h, manner)) / (2 * h)
    expected = tau ** (a - 1) * (1 - tau) ** (b - 1) / 0.5 ** (a + b - 2)
    assert slope / middle == pytest.approx(expected, rel=1e-4, abs=1e-6)


def fastest(rig: Rig, text: str, first: str, last: str) -> float:
    """Return at which share of the time between two blocks the palm is fastest."""
    made = animate(evaluate_expression(text).score, rig, fps=120.0, life=False, timing="exact")
    spans = {c.path[0]: (c.start_s, c.end_s) for c in made.report.constraints}
    start, end = (made.lead_s + t for t in (spans[first][1], spans[last][0]))
    times = made.clip.times
    rows = (times >= start) & (times <= end)
    palm = rig.sites["PA_R"].point(rig.chain.frames(made.clip.coordinates[rows]))
    speed = np.linalg.norm(np.diff(palm, axis=0), axis=1)
    return float(speed.argmax() / len(speed))


KEYS = """\
sync
    'A
    key .2 (place @PA(s) (point -.25 -.2 .35))
    'B
    key .2 (place @PA(s) (point 0 -.2 .35)){}
    'start 'A:end:.8
"""
PATH = """\
sync
    'A
    key .2 (place @PA(s) (point -.25 -.2 .35))
    'P
    key .8 (transpath @PA(s) straight{})
    'start 'A:end
    'B
    key .2 (place @PA(s) (point 0 -.2 .35))
    'start 'P:end
"""


@pytest.mark.parametrize("text", [KEYS, PATH], ids=["key", "path"])
def test_a_hand_is_fastest_when_its_manner_says(signer: Rig, text: str) -> None:
    usual, sharp, slow = (
        fastest(signer, text.format(option), "A", "B")
        for option in ("", " 'manner 'sharp-stop", " 'manner 'slow-start")
    )
    assert usual == pytest.approx(0.5, abs=0.1)
    assert sharp == pytest.approx(0.8, abs=0.08)
    assert usual + 0.08 < slow < sharp
