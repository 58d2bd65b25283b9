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
    assert all(p.pair[0].endswith("_R") and p.on == "skin" for p in found)
    assert max(p.depth_m for p in found) > 0.005


def part_of_the_way(share: float) -> Floats:
    return np.asarray(FREE + share * (IN_CHEST - FREE))


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
        assert one.on == "skin"
        assert not one.intended
    assert first.as_json()["depth_m"] == first.depth_m


def test_hands_held_away_enter_nothing() -> None:
    assert search([FREE, BESIDE, FREE], FREE_S) == ()


def test_a_finger_in_a_finger_is_told_on_capsules() -> None:
    rows = [BESIDE, BESIDE, CROSSED, CROSSED, BESIDE]
    found = search(rows, [0.5 + 0.1 * n for n in range(5)])
    by_pair = {p.pair: p for p in found}
    assert {"index_R_2", "middle_R_2"} <= {name for pair in by_pair for name in pair}
    middle = by_pair["index_R_2", "middle_R_2"]
    assert middle.depth_m == max(p.depth_m for p in found)
    assert 0.015 < middle.depth_m < 0.022  # of two fingers about 18 mm thick, one in the other
    for one in found:
        assert (one.start_s, one.end_s) == pytest.approx((0.7, 0.8))
        assert one.time_s == one.start_s
        assert one.on == "capsules"
        assert not one.intended
        assert all(name.startswith(("index_R", "middle_R")) for name in one.pair)


def test_what_the_score_asks_to_touch_is_intended_while_it_asks() -> None:
    touch = Place(Site("I_TIP", S), SitePoint(Site("M_TIP", S)))
    pair = ("index_R_3", "middle_R_3")
    when = {
        time_s: next(p for p in search([CROSSED], [time_s], touch) if p.pair == pair)
        for time_s in (0.5, 1.4, 1.6)
    }
    assert {time_s: p.intended for time_s, p in when.items()} == {0.5: True, 1.4: True, 1.6: False}
    assert not next(p for p in search([CROSSED], [0.5]) if p.pair == pair).intended


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
