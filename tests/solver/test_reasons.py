"""The reason that is told is the true cause: what accounts for most of the miss."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from stick_body import stick_body

from azee_rig.rig import Rig
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    Look,
    Morph,
    Orient,
    Place,
    Relation,
    Rotate,
)
from azee_solver.geometry import (
    Bone,
    Dir,
    FreePoint,
    Nrm,
    Side,
    Site,
    SitePoint,
    Vec,
    Vector,
    WorldPoint,
)
from azee_solver.moment import Moment
from azee_solver.options import SolveOptions
from azee_solver.reasons import Diagnosis
from azee_solver.solve import solve
from azee_solver.task import Task

HEAD, NECK = Bone("head"), Bone("neck")
LEFT, UP, FORWARD = Vec(1.0, 0.0, 0.0), Vec(0.0, 1.0, 0.0), Vec(0.0, 0.0, 1.0)
FAR_LEFT, RIGHT_FORWARD = Vec(1.0, 0.0, 0.2), Vec(-1.0, 0.0, 1.0)


def along(axis: BoneAxis, bone: Bone, vector: Vector) -> Orient:
    return Orient(axis, bone, Relation.ALONG, vector)


def turn(bone: Bone, axis: Vec, degrees: float) -> Rotate:
    return Rotate(bone, axis, math.radians(degrees))


def reasons(rig: Rig, *constraints: Constraint) -> dict[int, str]:
    """Why constraints are not met, by their number."""
    tasks = [Task(c, ("A",), Fraction(0), i) for i, c in enumerate(constraints)]
    idle = rig.coordinates.idle
    report = solve(rig, tasks, dominant=Side.RIGHT, start=idle, reference=idle)
    return {i: c.reason for i, c in enumerate(report.constraints) if c.reason is not None}


@pytest.mark.parametrize(
    "constraints",
    [
        (Look(FAR_LEFT), along(BoneAxis.NRM, HEAD, RIGHT_FORWARD)),
        (Look(FAR_LEFT), turn(HEAD, LEFT, -20), along(BoneAxis.NRM, HEAD, RIGHT_FORWARD)),
        # Alone, the body would stop the neck from the last degree of forty-five:
        (turn(HEAD, UP, 35), along(BoneAxis.NRM, HEAD, Vec(0.0, -1.0, 1.0)),
         along(BoneAxis.DIR, NECK, FORWARD)),
        (along(BoneAxis.NRM, HEAD, UP), along(BoneAxis.DIR, NECK, FORWARD),
         Look(Vec(-1.0, 1.0, 1.0))),
    ],
)  # fmt: skip
def test_head_constraints_that_exclude_each_other_are_a_conflict(
    signer: Rig, constraints: tuple[Constraint, ...]
) -> None:
    found = reasons(signer, *constraints)
    assert found
    assert not [reason for reason in found.values() if "body" in reason]
    assert all(reason.startswith("conflicts with `") for reason in found.values())


def test_a_limit_that_stops_a_constraint_less_than_another_is_told_after_it(signer: Rig) -> None:
    alone = reasons(signer, turn(NECK, FORWARD, -35))
    limit = "the neck cannot bend further: it is at 25° to the left and needs 10.0° more"
    assert alone == {0: limit}
    found = reasons(signer, turn(NECK, UP, 20), turn(NECK, FORWARD, -35))
    assert found == {1: f"conflicts with `rotate !neck ^up 20`; besides, {limit}"}


@pytest.mark.parametrize(("degrees", "first"), [(-51.0, "conflicts"), (-56.0, "the neck cannot")])
def test_what_stops_the_larger_half_is_told_first(signer: Rig, degrees: float, first: str) -> None:
    """Of a turn of 51° the limit stops 26°, and the other constraint a little more."""
    found = reasons(signer, turn(NECK, UP, 20), turn(NECK, FORWARD, degrees))
    assert found[1].startswith(first)


def test_a_constraint_that_nothing_meets_does_not_exclude_others(signer: Rig) -> None:
    """The head cannot turn so far, whatever the hand, which is too far away, does."""
    found = reasons(
        signer, turn(HEAD, UP, 50), Place(Site("I_TIP", Side.RIGHT), FreePoint(-0.3, 0.1, 3.0))
    )
    assert found[0] == "the head cannot turn further: it is at 40° to the left and needs 10.0° more"
    assert found[1].startswith("out of reach by ")


def test_a_part_that_was_left_still_is_named(signer: Rig) -> None:
    """Looking up takes the head back; leaning back, the signer could turn it besides."""
    found = reasons(signer, Look(UP), turn(HEAD, UP, 20))
    assert found == {1: "could be met if the lower back and the upper back moved too"}


def test_joints_that_nothing_but_another_constraint_sets_are_not_named_for_a_third(
    signer: Rig,
) -> None:
    """The morph sets joints of the back, which the turn of the head could do without."""
    spine = Morph("spine_extended", None, 0.1)
    found = reasons(signer, Look(UP), turn(HEAD, UP, 20), spine)
    assert found[0] == "needs joints that `morph 'spine_extended` sets"
    assert found[1] == "could be met if the lower back and the upper back moved too"


def test_the_body_is_named_where_it_stops_a_constraint(signer: Rig) -> None:
    fixed = (along(BoneAxis.DIR, Bone("back_2"), UP), along(BoneAxis.NRM, Bone("back_2"), FORWARD))
    inside = Place(Site("PA", Side.RIGHT), FreePoint(0.0, -0.15, 0.0))
    found = reasons(signer, inside, *fixed)
    assert found[0].startswith("the body is in the way")
    assert "the trunk" in found[0]


@pytest.mark.parametrize(
    ("lower_deg", "told"),
    [
        (10.0, "turn less: it is at 10° to the left and needs 5.0° less"),
        (-10.0, "turn further: it is at 10° to the right and needs 5.0° more"),
    ],
)
def test_a_joint_at_its_lower_limit_is_told_on_whichever_side_that_is(
    signer: Rig, lower_deg: float, told: str
) -> None:
    """The head of this body turns from 10° to the left, or to the right, and no farther back."""
    c = signer.coordinates
    axial = c.index["head.axial"]
    lower, idle = np.array(c.lower), np.array(c.idle)
    lower[axial], idle[axial] = math.radians(lower_deg), math.radians(lower_deg + 10.0)
    body = replace(signer, coordinates=replace(c, lower=lower, idle=idle))
    assert reasons(body, turn(HEAD, UP, lower_deg - 5.0))[0] == f"the head cannot {told}"


def test_a_morph_that_is_missed_conflicts_only_with_what_moves_the_same_joints() -> None:
    index, palm = Bone("index", Side.STRONG, 1), Bone("palm", Side.STRONG)
    forward = Orient(BoneAxis.DIR, index, Relation.ALONG, Nrm(palm))
    found = reasons(stick_body(), Morph("index_bend", Side.STRONG, 0.0), forward, Look(LEFT))
    assert found[0] == "conflicts with `orient 'dir !index(s, 1) 'along nrm(!palm(s))`"


INDEX, THUMB, PALM = (
    Bone("index", Side.STRONG, 2), Bone("thumb", Side.STRONG, 2), Bone("palm", Side.STRONG)
)  # fmt: skip
STRAIGHT_THUMB = along(BoneAxis.DIR, THUMB, Dir(PALM))
BENT_INDEX = along(BoneAxis.DIR, INDEX, Nrm(PALM))
TIPS_TOUCH = Place(Site("I_TIP", Side.STRONG), SitePoint(Site("T_TIP", Side.STRONG)))
ALL_THREE_EXCLUDE_EACH_OTHER = (
    "conflicts with `place @I_TIP(s) @T_TIP(s)` and "
    "`orient 'dir !index(s, 2) 'along nrm(!palm(s))` together"
)


def test_a_rival_that_is_linked_through_another_constraint_is_named(signer: Rig) -> None:
    """Thumb and index finger share no joint; that their tips touch makes them rivals."""
    for two in (
        (STRAIGHT_THUMB, TIPS_TOUCH), (STRAIGHT_THUMB, BENT_INDEX), (TIPS_TOUCH, BENT_INDEX)
    ):  # fmt: skip
        assert reasons(signer, *two) == {}
    for three in (
        (STRAIGHT_THUMB, TIPS_TOUCH, BENT_INDEX), (STRAIGHT_THUMB, BENT_INDEX, TIPS_TOUCH)
    ):  # fmt: skip
        assert reasons(signer, *three) == {0: ALL_THREE_EXCLUDE_EACH_OTHER}


def test_a_rival_without_which_nothing_could_be_met_either_is_not_named(signer: Rig) -> None:
    """The middle finger follows the index finger wherever that is."""
    follows = along(BoneAxis.DIR, Bone("middle", Side.STRONG, 1), Dir(replace(INDEX, phalanx=1)))
    (told,) = reasons(signer, STRAIGHT_THUMB, TIPS_TOUCH, BENT_INDEX, follows).values()
    assert told == ALL_THREE_EXCLUDE_EACH_OTHER


@pytest.mark.parametrize(("apart", "conflict"), [(1.9, False), (2.1, True), (2.4, True)])
def test_two_that_each_miss_by_more_than_the_tolerance_are_a_conflict(
    apart: float, conflict: bool
) -> None:
    """They are met half way between, and the tolerance is half a degree."""
    found = reasons(stick_body(), turn(HEAD, UP, 10.0), turn(HEAD, UP, 10.0 + 0.5 * apart))
    assert found == ({1: "conflicts with `rotate !head ^up 10`"} if conflict else {})


def reason_of_first(
    *constraints: Constraint, moved: bool = True, held: tuple[str, ...] = (), miss: float = 40.0
) -> str:
    """Why the first constraint is missed by so many tolerances in the idle posture.

    Args: moved: whether the search has moved every coordinate, or none. held: beginnings of
        the names of coordinates that must not move.
    """
    rig = stick_body()
    tasks = [Task(c, ("A",), Fraction(0), i) for i, c in enumerate(constraints)]
    idle, names = rig.coordinates.idle, rig.coordinates.names
    fixed = frozenset(v for v, name in enumerate(names) if name.startswith(held))
    moment = Moment(rig, tasks, Side.RIGHT, idle, idle, SolveOptions(fixed=fixed))
    free = frozenset(range(len(names))) if moved else frozenset[int]()
    return Diagnosis(moment.body, tasks, moment.footprints, idle, free).reason(0, miss, False)


def test_what_could_be_met_is_told_by_what_the_search_left_still() -> None:
    head = turn(HEAD, UP, 20)
    assert reason_of_first(head, moved=False) == "could be met if the head moved too"
    assert reason_of_first(head, moved=True) == "the search found no posture that meets it"


@pytest.mark.parametrize(
    ("other", "held", "shared"),
    [
        (turn(HEAD, UP, 0.0), (), True),
        (turn(HEAD, UP, 0.0), ("head",), True),
        (BENT_INDEX, (), False),
    ],
)
def test_others_are_told_of_if_they_share_joints_held_or_not(
    other: Constraint, held: tuple[str, ...], shared: bool
) -> None:
    told = reason_of_first(Look(Vec(0.1, 0.0, 1.0)), other, held=held)
    others = " and the others" if shared else ""
    assert told == f"the search found no posture that meets it{others}"


def test_a_rival_that_is_out_of_reach_by_itself_does_not_exclude_what_is_in_reach() -> None:
    """The head turns by 30° of 50°, and the eyes back by as much."""
    assert "conflicts" not in reason_of_first(Look(FORWARD), turn(HEAD, UP, 50))


def test_the_body_is_named_also_for_a_small_part_of_a_miss_if_nothing_else_is_known() -> None:
    inside, held = Place(Site("PA", Side.RIGHT), WorldPoint(0.0, 1.2, 0.0)), ("back", "clav")
    told = reason_of_first(inside, held=held, miss=1e4)
    assert told.startswith("the body is in the way: ")
    assert told == reason_of_first(inside, held=held, miss=1.0)
