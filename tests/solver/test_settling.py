"""Who gives way where constraints exclude each other, and what a search takes for hopeless."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from numpy.typing import NDArray
from tree_sign import NRM, UP, S, W, along, tasks, tree

from azee_rig.rig import Rig
from azee_solver.anatomy import Part
from azee_solver.attempt import _Attempt
from azee_solver.body import Body
from azee_solver.constraint import Constraint, Orient, Place
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Bone, Opp, Side, Site, WorldPoint
from azee_solver.options import SolveOptions
from azee_solver.report import SolveReport
from azee_solver.result import Result, is_again
from azee_solver.settling import PULL, giving_way
from azee_solver.solve import solve

Q = np.zeros(1)


class Rivals:
    """Constraints of which some exclude each other: both of a pair miss until one has given way."""

    def __init__(self, *pairs: tuple[int, int], count: int = 4) -> None:
        self.pairs, self.count = pairs, count
        self.asked: list[frozenset[int]] = []

    def __call__(self, ease: Mapping[int, float], begin: NDArray[np.float64]) -> Result:
        self.asked.append(frozenset(ease))
        missed = {i for pair in self.pairs if not set(pair) & ease.keys() for i in pair}
        ratios = {i: 8.0 if i in missed | ease.keys() else 0.0 for i in range(self.count)}
        cost = sum(r * r for i, r in ratios.items() if i not in ease)
        return Result(Q, ratios, cost, 0.0, frozenset(), frozenset(ease))


def order(i: int) -> tuple[Fraction, int, int]:
    return Fraction(0), 0, i


def settled(rivals: Rivals, given: Mapping[int, float] | None = None) -> dict[int, float]:
    ease, result = giving_way(rivals(given or {}, Q), given or {}, rivals, order)
    assert not result.lost()
    return ease


def test_the_later_of_two_gives_way() -> None:
    assert settled(Rivals((1, 2))) == {2: PULL / 8.0}


def test_of_two_pairs_one_each_gives_way() -> None:
    assert set(settled(Rivals((0, 1), (2, 3)))) == {1, 3}


def test_whoever_need_not_give_way_after_all_is_taken_back() -> None:
    """3 goes first, for it is the last that is lost; once 2 has gone it may return."""
    rivals = Rivals((1, 2), (2, 3))
    assert set(settled(rivals)) == {2}
    assert frozenset({3}) in rivals.asked


def test_what_has_given_way_before_stays_and_is_not_asked_again() -> None:
    rivals = Rivals((0, 1), (2, 3))
    ease = settled(rivals, {3: 0.5})
    assert ease == {3: 0.5, 1: PULL / 8.0}
    assert all(3 in asked for asked in rivals.asked)


def test_one_that_misses_alone_keeps_its_weight() -> None:
    lonely = Result(Q, {0: 8.0, 1: 0.0}, 64.0, 0.0, frozenset())

    def never(ease: Mapping[int, float], begin: NDArray[np.float64]) -> Result:
        raise AssertionError

    ease, result = giving_way(lonely, {}, never, order)
    assert ease == {}
    assert result is lonely


@pytest.mark.parametrize(
    ("one", "best", "same"),
    [
        ((1, 100.0), (1, 100.5), True),
        ((1, 100.0), (1, 103.0), False),
        ((2, 100.0), (1, 100.0), False),
        ((0, 0.0), (0, 0.0), True),
    ],
)
def test_ends_of_equal_cost_are_one_end(
    one: tuple[int, float], best: tuple[int, float], same: bool
) -> None:
    assert is_again(one, best) is same


# On the signer -----------------------------------------------------------------------------------


def run(rig: Rig, *constraints: Constraint) -> SolveReport:
    idle = rig.coordinates.idle
    asked = tasks(*constraints)
    return solve(rig, asked, dominant=Side.RIGHT, start=idle, reference=idle)


def test_an_impossible_thumb_does_not_make_everything_else_be_searched_for(signer: Rig) -> None:
    """Once a ghost has missed it too; a search that does not know takes five times as long."""
    report = run(signer, *(d.constraint for d in tree(thumb=True)))
    assert [c.kind for c in report.constraints if not c.met] == ["nrm of thumb_R_2"]
    assert report.evaluations < 600


def test_the_other_hand_is_met_although_one_is_out_of_reach(signer: Rig) -> None:
    far = Place(Site("I_TIP", W), WorldPoint(0.6, 1.3, 1.5))
    near = Place(Site("PA", S), WorldPoint(-0.15, 1.1, 0.35))
    report = run(signer, far, near, along(NRM, Bone("palm", S), UP))
    assert [c.met for c in report.constraints] == [False, True, True]


def test_what_excludes_itself_in_one_hand_does_not_disturb_the_other(signer: Rig) -> None:
    palm = Bone("palm", S)
    clash: list[Orient] = [along(NRM, palm, UP), along(NRM, palm, Opp(UP))]
    report = run(signer, *clash, along(NRM, Bone("palm", W), UP))
    assert [c.met for c in report.constraints] == [True, False, True]
    assert report.constraints[1].reason == "conflicts with `nrm of palm_R along up`"


def test_an_arm_that_waits_for_the_trunk_is_not_searched_for_alone(signer: Rig) -> None:
    """Alone against a trunk that another arm has bent it takes a hundred evaluations, in vain."""
    report = run(signer, *(d.constraint for d in tree()))
    assert all(c.met for c in report.constraints)
    assert report.evaluations < 170


@pytest.mark.parametrize(
    ("bent", "turned", "degrees", "ends"),
    [
        # The arm into the trunk, from which it keeps a margin.
        ({}, ("arm_R.abduction",), (12.0, -16.0), {(False, False), (True, False), (True, True)}),
        # Hand into hand, which keep none.
        (
            {"f_arm_L.flexion": 90.0, "f_arm_R.flexion": 90.0},
            ("arm_L.rotation", "arm_R.rotation"),
            (20.0, 80.0),
            {(False, False), (True, True)},
        ),
    ],
)
def test_what_overlaps_only_by_a_margin_will_do(
    signer: Rig,
    bent: dict[str, float],
    turned: tuple[str, ...],
    degrees: tuple[float, float],
    ends: set[tuple[bool, bool]],
) -> None:
    """Reports leave margins out, and a search for what nobody asks for may take long."""
    names, idle = signer.coordinates.names, np.array(signer.coordinates.idle)
    idle[[names.index(name) for name in bent]] = np.radians(list(bent.values()))
    evaluator, options = Evaluator(signer, Side.RIGHT), SolveOptions()
    place = Place(Site("H_BACK", Side.STRONG), WorldPoint(0.0, 1.0, 0.3))
    body = Body(signer, evaluator, idle, {}, options, [place])
    arm = body.anatomy.of(Part.ARM)
    attempt = _Attempt(body, dict(enumerate(tasks(place))), idle, arm, frozenset(), {})
    tolerated_m, seen = options.overlap_m, set()
    for angle in np.radians(np.linspace(*degrees, 200)):
        q = idle.copy()
        q[[names.index(name) for name in turned]] = angle
        found = attempt._measure(q[attempt.program.free])
        assert not attempt._will_do(found)  # the hand is not where it should be
        met = replace(found, ratios={0: 0.5})
        deepest = max((o.depth_m for o in body.obstacles.overlaps(q)), default=0.0)
        assert attempt._will_do(met) == (deepest <= tolerated_m)
        seen.add((found.overlap_m > tolerated_m, deepest > tolerated_m))
    assert seen == ends
