"""Which task is given up where tasks exclude each other, and what a search takes for infeasible."""

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
from azee_solver.body import Body
from azee_solver.constraint import Constraint, Orient, Place
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Bone, Opp, Side, Site, WorldPoint
from azee_solver.group_search import GroupSearch
from azee_solver.options import SolveOptions
from azee_solver.priorities import GIVEN_UP_PULL, give_up_later_tasks, take_back
from azee_solver.result import Result, is_repeat
from azee_solver.solve import solve
from azee_solver.solve_report import SolveReport

Q = np.zeros(1)


class Rivals:
    """Tasks of which some exclude each other: both of a pair miss until one is given up."""

    def __init__(self, *pairs: tuple[int, int], count: int = 4) -> None:
        self.pairs, self.count = pairs, count
        self.asked: list[frozenset[int]] = []

    def __call__(self, factors: Mapping[int, float], begin: NDArray[np.float64]) -> Result:
        self.asked.append(frozenset(factors))
        missed = {i for pair in self.pairs if not set(pair) & factors.keys() for i in pair}
        ratios = {i: 8.0 if i in missed | factors.keys() else 0.0 for i in range(self.count)}
        cost = sum(r * r for i, r in ratios.items() if i not in factors)
        return Result(Q, ratios, cost, 0.0, frozenset(), frozenset(factors))


def order(i: int) -> tuple[Fraction, int, int]:
    return Fraction(0), 0, i


def given_up(rivals: Rivals, given: Mapping[int, float] | None = None) -> dict[int, float]:
    factors, result = give_up_later_tasks(rivals(given or {}, Q), given or {}, rivals, order)
    assert not result.unmet()
    return factors


def test_the_later_of_two_is_given_up() -> None:
    assert given_up(Rivals((1, 2))) == {2: GIVEN_UP_PULL / 8.0}


def test_of_two_pairs_one_each_is_given_up() -> None:
    assert set(given_up(Rivals((0, 1), (2, 3)))) == {1, 3}


def test_what_need_not_be_given_up_after_all_is_taken_back() -> None:
    """3 goes first, for it is the last that is unmet; once 2 has gone it may return."""
    rivals = Rivals((1, 2), (2, 3))
    assert set(given_up(rivals)) == {2}
    assert frozenset({3}) in rivals.asked


def test_what_was_given_up_before_stays_and_is_not_asked_again() -> None:
    rivals = Rivals((0, 1), (2, 3))
    factors = given_up(rivals, {3: 0.5})
    assert factors == {3: 0.5, 1: GIVEN_UP_PULL / 8.0}
    assert all(3 in asked for asked in rivals.asked)


def test_one_that_misses_alone_keeps_its_weight() -> None:
    lonely = Result(Q, {0: 8.0, 1: 0.0}, 64.0, 0.0, frozenset())

    def never(factors: Mapping[int, float], begin: NDArray[np.float64]) -> Result:
        raise AssertionError

    factors, result = give_up_later_tasks(lonely, {}, never, order)
    assert factors == {}
    assert result is lonely


BEFORE = np.full(1, 7.0)


class Pull:
    """A task that misses by less the more its weight, until another misses or the body is hit.

    From anywhere but BEFORE it is found on its other side, where it misses by much.
    """

    def __init__(self, *, bound: float, deep: float) -> None:
        self.bound, self.deep = bound, deep

    def __call__(self, factors: Mapping[int, float], begin: NDArray[np.float64]) -> Result:
        factor = factors[1]
        other = 0.5 if factor <= self.bound else 2.0
        overlap_m = 0.001 if factor <= self.deep else 0.005
        missed = 2.0 / factor if begin is BEFORE else 300.0
        ratios = {0: other, 1: missed, 2: 9.0}
        return Result(Q, ratios, other**2, overlap_m, frozenset(), frozenset(factors))


@pytest.mark.parametrize(("bound", "deep"), [(0.4, 1.0), (1.0, 0.4)])
def test_a_task_is_given_up_no_further_than_the_others_need(bound: float, deep: float) -> None:
    again, given = Pull(bound=bound, deep=deep), {2: 0.01}
    little = again({1: 0.01, **given}, Q)
    factors, result = take_back(little, {1: 0.01, **given}, given, again, BEFORE, deepest_m=0.003)
    assert 0.25 < factors[1] <= 0.4
    assert result.ratios[1] == 2.0 / factors[1]
    assert not result.unmet()
    assert result.overlap_m < 0.003
    assert factors[2] == given[2]


def test_nothing_is_taken_back_where_giving_up_did_not_help() -> None:
    missed = Result(Q, {0: 2.0, 1: 8.0}, 4.0, 0.0, frozenset(), frozenset({1}))

    def never(factors: Mapping[int, float], begin: NDArray[np.float64]) -> Result:
        raise AssertionError

    assert take_back(missed, {1: 0.1}, {}, never, Q, deepest_m=0.003) == ({1: 0.1}, missed)


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
    assert is_repeat(one, best) is same


# On the signer -----------------------------------------------------------------------------------


def run(rig: Rig, *constraints: Constraint) -> SolveReport:
    idle = rig.coordinates.idle
    asked = tasks(*constraints)
    return solve(rig, asked, dominant=Side.RIGHT, start=idle, reference=idle)


def test_an_infeasible_thumb_does_not_prolong_the_search_for_all_else(signer: Rig) -> None:
    """The relaxed problem misses it too; a search that does not know takes five times as long."""
    report = run(signer, *(d.constraint for d in tree(thumb=True)))
    assert [c.kind for c in report.constraints if not c.met] == ["orient 'nrm !thumb(s, 2)"]
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
    assert report.constraints[1].reason == "conflicts with `orient 'nrm !palm(s) 'along ^up`"


def test_an_arm_that_waits_for_the_trunk_is_not_searched_for_alone(signer: Rig) -> None:
    """Alone against a trunk that another arm has bent it takes a hundred evaluations too many."""
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
def test_what_overlaps_only_by_a_margin_suffices(
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
    search = GroupSearch(body, dict(enumerate(tasks(place))), idle, arm)
    tolerated_m, seen = options.overlap_m, set()
    for angle in np.radians(np.linspace(*degrees, 200)):
        q = idle.copy()
        q[[names.index(name) for name in turned]] = angle
        found = search.measured(q[search.program.free])
        assert not search.suffices(found)  # the hand is not where it should be
        met = replace(found, ratios={0: 0.5})
        deepest = max((o.depth_m for o in body.obstacles.overlaps(q)), default=0.0)
        assert search.suffices(met) == (deepest <= tolerated_m)
        seen.add((found.overlap_m > tolerated_m, deepest > tolerated_m))
    assert seen == ends
