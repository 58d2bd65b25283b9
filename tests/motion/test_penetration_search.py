"""What a report says of postures that certainly penetrate: a hand in the chest, crossed fingers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.schedule import bind
from azee.quality.measures import Penetration, PenetrationSearch
from azee.score.score import Key
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.constraint import Constraint, Place
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Side, Site, SitePoint

Floats = NDArray[np.float64]
S = Side.STRONG
FREE_S = (0.0, 0.1, 0.2)


@cache
def rig() -> Rig:
    return load_rig()


def posture(**degrees: float) -> Floats:
    """A posture with both arms held away from the body, and some coordinates besides."""
    q, index = rig().coordinates.idle.copy(), rig().coordinates.index
    away = {"arm_L__abduction": 50.0, "arm_R__abduction": 50.0}
    for name, angle in (away | degrees).items():
        q[index[name.replace("__", ".")]] = math.radians(angle)
    return np.clip(q, rig().coordinates.lower, rig().coordinates.upper)


FREE = posture()
IN_CHEST = posture(
    arm_R__rotation=80, arm_R__flexion=0, f_arm_R__flexion=110, arm_R__abduction=0
)  # fmt: skip
STRAIGHT = {f"{f}_R_{k}__flexion": 0.0 for f in ("index", "middle") for k in (1, 2)}
CROSSED = posture(**STRAIGHT, index_R_1__deviation=-10, middle_R_1__deviation=15)
BESIDE = posture(**STRAIGHT, index_R_1__deviation=25, middle_R_1__deviation=-20)


def search(
    rows: Sequence[Floats], times_s: Sequence[float], *asked: Constraint
) -> tuple[Penetration, ...]:
    """Find what penetrates; what is asked is asked of the score's first second."""
    score = flatten(Key(Fraction(1), constraints=asked))
    binding = evaluator(rig(), Side.RIGHT).binding
    schedule = bind(score, rig(), binding, Limbs.of(rig().coordinates))
    return PenetrationSearch(rig(), Side.RIGHT, schedule, np.array(rows), np.array(times_s))()


def test_fingers_in_the_head_belong_to_their_arm() -> None:
    """The skin is told by its digit, the capsules by their arm."""
    in_head = posture(
        arm_R__rotation=20, arm_R__flexion=50, f_arm_R__flexion=140, arm_R__abduction=10
    )
    found = search([FREE, in_head, FREE], FREE_S)
    assert found
    assert {p.pair[1] for p in found} == {"head"}
    assert all(p.pair[0].endswith("_R") for p in found)
    assert max(p.depth_m for p in found) > 0.005


def part_of_the_way(share: float) -> Floats:
    return np.asarray(FREE + share * (IN_CHEST - FREE))


@pytest.mark.long
def test_a_hand_in_the_chest_is_told_with_its_depth_time_and_parts() -> None:
    shares = (0.0, 0.0, 0.95, 1.0, 0.95, 0.0, 0.0, 0.95, 0.0)
    times = [2.0 + 0.1 * n for n in range(len(shares))]
    found = search([part_of_the_way(s) for s in shares], times)
    first, second = (p for p in found if p.pair == ("arm_R", "trunk"))
    assert len(found) == 2
    assert first.start_s == pytest.approx(2.2)
    assert first.end_s == pytest.approx(2.4)
    assert first.time_s == pytest.approx(2.3)
    assert second.start_s == second.end_s == second.time_s == pytest.approx(2.7)
    assert 0.08 < second.depth_m < first.depth_m < 0.13
    for one in found:
        assert not one.intended
    assert first.as_json()["depth_m"] == first.depth_m


def test_hands_held_away_enter_nothing() -> None:
    assert search([FREE, BESIDE, FREE], FREE_S) == ()


def test_a_finger_in_a_finger_is_told_by_its_skin() -> None:
    rows = [BESIDE, BESIDE, CROSSED, CROSSED, BESIDE]
    (one,) = search(rows, [0.5 + 0.1 * n for n in range(5)])
    assert one.pair == ("index_R", "middle_R")
    assert 0.006 < one.depth_m < 0.010  # of two fingers about 18 mm thick, one in the other
    assert (one.start_s, one.end_s) == pytest.approx((0.7, 0.8))
    assert one.time_s == one.start_s
    assert not one.intended


def test_what_the_score_asks_to_touch_is_intended_while_it_asks() -> None:
    pressed = posture(**STRAIGHT, index_R_1__deviation=-10, middle_R_1__deviation=2)
    touch = Place(Site("I_PAD", S), SitePoint(Site("M_TIP", S)))
    when = {time_s: search([pressed], [time_s], touch)[0] for time_s in (0.5, 1.1, 1.4)}
    assert {time_s: p.intended for time_s, p in when.items()} == {0.5: True, 1.1: True, 1.4: False}
    assert all(p.depth_m > 0.004 for p in when.values())
    assert not search([pressed], [0.5])[0].intended


def test_fingers_that_cross_elsewhere_than_at_the_touch_are_not_intended() -> None:
    touch = Place(Site("I_TIP", S), SitePoint(Site("M_TIP", S)))
    assert [p.intended for p in search([CROSSED], [0.5], touch)] == [False]


@pytest.mark.long
def test_a_thumb_in_the_chest_is_intended_where_the_score_asks_for_that_touch() -> None:
    """The deepest of all pairs of the two parts tells, here the thumb's tip in the chest."""
    thumb_in = posture(
        arm_R__rotation=80, arm_R__flexion=50, f_arm_R__flexion=135, arm_R__abduction=30
    )
    for site, intended in ((Site("T_TIP", S), True), (Site("T_TIP", Side.WEAK), False)):
        asked = Place(site, SitePoint(Site("ST")), contact=True)
        found = [p for p in search([thumb_in], [0.5], asked) if p.pair[1] == "trunk"]
        assert [p.intended for p in found] == [intended]
        assert found[0].depth_m > 0.05
