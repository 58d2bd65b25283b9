"""Trills of the rules that ship are seen: most finger tips go to and fro by 30 mm or more."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from azee.animation import animate
from azee.compilation import score_of
from azee.lang.program import load
from azee.lang.reflection import MIRROR
from azee.motion.overlay.trill import FADE_S, Oscillation
from azee.motion.tasks.requirement import Requirement
from azee.motion.tasks.timed_task import TimedTask
from azee.score.interval import Interval
from azee.score.score import Key, Score, leaves
from azee_grammar.source import Source
from azee_rig.rig import Rig
from azee_solver.constraint import Trill
from azee_solver.geometry import Bone, Side, Vec

SEEN_M = 0.03
FPS = 120.0
TIPS = tuple(f"{digit}_TIP" for digit in "TIMRL")


def trills(score: Score) -> Iterator[tuple[Trill, float, float]]:
    """Yield each trill, with its start and its end in seconds."""
    for leaf in leaves(score):
        for constraint in leaf.score.constraints if isinstance(leaf.score, Key) else ():
            if isinstance(constraint, Trill):
                yield constraint, float(leaf.interval.start), float(leaf.interval.end)


def test_trills_of_rules_are_seen_at_the_finger_tips(signer: Rig) -> None:
    """The hand stays at its place meanwhile, so that all movement of the tips is the trill's."""
    for name in ("cinéma", "mignon"):
        score = score_of(load(Source(name, f":{name}\n")), None, None)
        made = animate(score, signer, fps=FPS, life=False)
        assert any(trills(score))
        for trill, start_s, end_s in trills(score):
            assert trill.bone.side is Side.STRONG
            a, b = (
                np.searchsorted(made.clip.times, made.lead_s + t)
                for t in (start_s + FADE_S, end_s - FADE_S)
            )
            frames = signer.chain.frames(made.clip.coordinates[a:b])
            ways = []
            for tip in TIPS:
                at = signer.sites[f"{tip}_R"].point(frames)
                ways.append(np.linalg.norm(at[:, None] - at[None], axis=-1).max())
            assert np.median(ways) > SEEN_M, (name, ways)


def angles(trill: Trill, duration_s: int = 1) -> NDArray[np.float64]:
    """Return the angles of a trill of a block, degrees, at a thousand instants a second."""
    whole = Interval(Fraction(0), Fraction(duration_s))
    task = TimedTask(
        Requirement(trill, ("A",), None, whole, whole, 0),
        "arm_R", frozenset(), frozenset(), frozenset(), frozenset(), False,
    )  # fmt: skip
    times = np.arange(0, 1000 * duration_s + 1) / 1000
    return np.degrees(Oscillation(task, np.zeros(1), 1.0).angles(times))


PALM, UP = Bone("palm", Side.STRONG), Vec(0.0, 1.0, 0.0)


@given(st.integers(1, 8), st.integers(0, 60), st.integers(0, 60), st.integers(1, 3))
def test_a_trill_goes_so_often_between_its_two_ends(
    cycles: int, amp: int, back: int, duration_s: int
) -> None:
    trill = Trill(PALM, UP, 5.0, math.radians(amp), math.radians(back), 0.0, cycles * duration_s)
    found = angles(trill, duration_s)
    assert found.max() <= amp + 1e-9
    assert found.min() >= -back - 1e-9
    inner = found[200:-200] - 0.5 * (amp - back)
    if amp + back > 0:
        crossings = int(np.count_nonzero(np.diff(np.sign(inner[np.abs(inner) > 1e-9])) != 0))
        assert abs(crossings - 2 * cycles * (duration_s - 0.4)) <= 1


def test_a_trill_starts_at_its_phase() -> None:
    early, late = (
        angles(replace(Trill(PALM, UP, 2.0, math.radians(20)), phase_rad=phase))
        for phase in (0.0, math.pi / 2)
    )
    np.testing.assert_allclose(late[200:600], early[325:725], atol=1e-9)


def test_two_trills_half_a_cycle_apart_are_opposite() -> None:
    one = Trill(PALM, UP, 3.0, math.radians(20))
    np.testing.assert_allclose(angles(one), -angles(replace(one, phase_rad=math.pi)), atol=1e-9)


@given(st.integers(0, 60), st.integers(0, 60), st.integers(1, 359))
def test_a_mirrored_trill_turns_to_the_other_side(amp: int, back: int, phase_deg: int) -> None:
    trill = Trill(
        PALM, UP, 3.0, math.radians(amp), math.radians(back), math.radians(phase_deg)
    )  # fmt: skip
    other = MIRROR.constraint(trill)
    assert isinstance(other, Trill)
    assert other.bone.side is Side.WEAK
    np.testing.assert_allclose(angles(other), -angles(trill), atol=1e-9)
