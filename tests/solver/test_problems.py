"""Constraints to ordered problems to groups (Nunnari et al. 2018, §4.2 and figure 5)."""

from __future__ import annotations

from fractions import Fraction

import pytest
from stick_body import stick_body
from tree_sign import DIR, FINGERS, NRM, UP, S, W, along, tasks, tree

from azee_solver.anatomy import anatomy
from azee_solver.binding import Binding
from azee_solver.constraint import (
    Constraint,
    Look,
    LookAt,
    Morph,
    Place,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.geometry import (
    Bone,
    Dir,
    NamedPoint,
    Nrm,
    Side,
    SigningSpace,
    Site,
    SitePoint,
    Straight,
)
from azee_solver.groups import grouped
from azee_solver.notation import problem_text
from azee_solver.ordering import ordered
from azee_solver.problems import Problem, ProblemBuilder, Reach
from azee_solver.task import PRECEDENCE, Task

RIG = stick_body()
BODY = anatomy(RIG.chain, RIG.coordinates)
MSSP = NamedPoint(SigningSpace.MSSP)


DIGITS_R = {f"{f}_R_{k}" for f in ("thumb", *FINGERS) for k in (1, 2, 3)}


def build(asked: list[Task]) -> tuple[Problem, ...]:
    return ProblemBuilder(asked, Binding(RIG, Side.RIGHT), BODY).build()


def names(coordinates: frozenset[int]) -> set[str]:
    return {RIG.coordinates.names[v] for v in coordinates}


def named(problem: Problem, asked: list[Task]) -> str:
    return problem_text(asked[i].constraint for i in problem.tasks)


def test_tree_is_the_paper_s_eleven_problems() -> None:
    asked = tree(thumb=True)
    problems = build(asked)
    assert len(problems) == 11
    assert [p.tasks for p in problems[:3]] == [(0, 1, 2), (3,), (4, 5, 6, 7)]
    assert [p.tasks for p in problems[3:]] == [(i,) for i in range(8, 16)]
    called = [named(problem, asked) for problem in problems]
    axes = "dir !f_arm(s)", "dir !palm(s)", "dir !thumb(s, 3)", "nrm !thumb(s, 2)"
    assert called[0].startswith("place @H_BACK(w) ")
    assert called[1] == "place @EL(s) @PA(w) 'contact"
    assert called[2] == ", ".join(f"orient '{axis}" for axis in axes)
    assert called[3] == "orient 'dir !index(s, 1)"
    assert problems[2].chain[-1] == "thumb_R_3"
    assert problems[1].chain == ("back_1", "back_2", "clav_R", "arm_R")


def test_the_weak_hand_comes_first_however_it_is_written() -> None:
    asked = list(reversed(tree()))
    first = [named(p, asked) for p in build(asked)]
    weak = next(i for i, name in enumerate(first) if "@H_BACK(w)" in name)
    assert weak < first.index("place @EL(s) @PA(w) 'contact")


def test_an_orientation_joins_the_placement_whose_chain_holds_its_bone() -> None:
    place = Place(Site("I_TIP", S), MSSP)
    problems = build(tasks(along(NRM, Bone("palm", S), UP), place))
    assert [p.tasks for p in problems] == [(1, 0)]
    thumb = build(tasks(place, along(DIR, Bone("thumb", S, 3), UP)))
    assert [p.tasks for p in thumb] == [(0,), (1,)]


def test_one_that_reads_what_another_moves_stands_alone_and_later() -> None:
    forearm, palm = Bone("f_arm", S), Bone("palm", S)
    together = build(tasks(along(DIR, palm, UP), along(DIR, forearm, UP)))
    assert [p.tasks for p in together] == [(0, 1)]
    apart = build(tasks(along(DIR, palm, Dir(forearm)), along(DIR, forearm, UP)))
    assert sorted(p.tasks for p in apart) == [(0,), (1,)]
    same_target = build(
        tasks(
            along(DIR, Bone("index", S, 1), Dir(palm)), along(NRM, Bone("index", S, 2), Nrm(palm))
        )
    )
    assert [p.tasks for p in same_target] == [(0, 1)]


def test_ties_go_by_start_then_kind_then_writing() -> None:
    late = Task(Place(Site("PA", S), MSSP), (), Fraction(1), 0)
    orient = Task(along(DIR, Bone("palm", W), UP), (), Fraction(0), 2)
    look = Task(Look(UP), (), Fraction(0), 1)
    assert [p.tasks for p in build([late, orient, look])] == [(2,), (1,), (0,)]


def test_precedence_names_every_kind_once() -> None:
    kinds = [kind for group in PRECEDENCE for kind in group]
    assert len(kinds) == len(set(kinds)) == 8
    trill = Task(Trill(Bone("palm", S), UP, 4.0, 0.1))
    path = Task(Transpath(Site("PA", S), Straight()))
    assert path.order < trill.order < Task(Morph("smile", None, 1.0)).order


def test_all_gazes_are_one_problem_of_eyes_and_head() -> None:
    (problem,) = build(tasks(Look(UP), LookAt(MSSP)))
    assert {name.split(".")[0] for name in names(problem.steps[Reach.ALL])} == {
        "neck",
        "head",
        "eye_L",
        "eye_R",
    }


@pytest.mark.parametrize(
    ("constraint", "reach", "bones"),
    [
        (Place(Site("PA", S), MSSP), Reach.OWN, {"clav_R", "arm_R", "f_arm_R", "palm_R"}),
        (Place(Site("EL", S), MSSP), Reach.OWN, {"clav_R", "arm_R"}),
        (Place(Site("EL", S), MSSP), Reach.TRUNK,
         {"clav_R", "arm_R", "back_1", "back_2", *DIGITS_R}),
        (Place(Site("CH"), MSSP), Reach.OWN, {"neck", "head"}),
        (Place(Site("ST"), MSSP), Reach.OWN, {"back_1", "back_2"}),
        (along(DIR, Bone("neck"), UP), Reach.OWN, {"neck"}),
        (along(DIR, Bone("index", S, 2), UP), Reach.OWN,
         {"clav_R", "arm_R", "f_arm_R", "palm_R", "index_R_1", "index_R_2", "index_R_3"}),
        (along(DIR, Bone("index", S, 2), Dir(Bone("palm", S))), Reach.ALL,
         {"index_R_1", "index_R_2", "index_R_3"}),
        (along(DIR, Bone("palm", S), Dir(Bone("palm", W))), Reach.OWN,
         {"clav_R", "arm_R", "f_arm_R", "palm_R"}),
        (along(DIR, Bone("palm", S), Dir(Bone("palm", W))), Reach.ALL,
         {f"{b}_{s}" for b in ("clav", "arm", "f_arm", "palm") for s in "LR"}),
        (Rotate(Bone("head"), UP, 0.1), Reach.ALL, {"head"}),
    ],
)  # fmt: skip
def test_what_a_problem_may_move(constraint: Constraint, reach: Reach, bones: set[str]) -> None:
    (problem,) = build(tasks(constraint))
    assert {name.split(".")[0] for name in names(problem.steps[reach])} == bones


def test_a_fingertip_s_placement_bends_the_finger_only_where_it_must() -> None:
    (problem,) = build(tasks(Place(Site("I_TIP", S), MSSP)))
    own, fingers = (names(problem.steps[r]) for r in (Reach.OWN, Reach.FINGERS))
    assert not any(name.startswith("index") for name in own)
    assert "index_R_1.flexion" in fingers - own


def test_problems_that_share_coordinates_are_grouped() -> None:
    problems = build(tree(thumb=True))
    groups = grouped(problems, [Reach.OWN] * 11, BODY)
    assert {g.problems for g in groups} == {(0,), (1, 2), tuple(range(3, 11))}
    assert [g.problems for g in groups].index((0,)) < [g.problems for g in groups].index((1, 2))
    # Fingers before the arm that carries them, so that it can keep them out of the body.
    assert [g.problems for g in groups][-2:] == [(0,), (1, 2)]


def test_digits_that_wait_for_an_arm_are_no_group_with_those_that_go_before_it() -> None:
    fixed = frozenset(
        v
        for v, name in enumerate(RIG.coordinates.names)
        if name.startswith(("back", "clav_R", "arm_R", "f_arm_R", "palm_R"))
    )
    asked = tasks(
        along(DIR, Bone("little", W, 1), Dir(Bone("palm", W))),
        Place(Site("I_TIP", W), MSSP),
        along(DIR, Bone("index", S, 1), Dir(Bone("palm", W))),
    )
    problems = build(asked)
    groups = grouped(problems, [Reach.OWN] * 3, BODY, fixed)
    assert [[named(problems[p], asked) for p in group.problems] for group in groups] == [
        ["orient 'dir !little(w, 1)"],
        ["place @I_TIP(w) ^Mssp"],
        ["orient 'dir !index(s, 1)"],
    ]


def test_with_the_trunk_free_what_depends_on_each_other_is_solved_together() -> None:
    problems = build(tree())
    groups = grouped(problems, [Reach.TRUNK] * len(problems), BODY)
    assert (0, 1, 2) in {g.problems for g in groups}
    whole = next(g for g in groups if g.problems == (0, 1, 2))
    # The head is free too, so that it can be levelled.
    assert "head.flexion" in names(whole.free)


def test_an_arm_that_hangs_on_one_with_the_trunk_is_solved_with_it() -> None:
    problems = build(tree())
    trunk_for_the_weak_hand = [Reach.TRUNK, *[Reach.OWN] * (len(problems) - 1)]
    assert problems[1].needs(problems[0])
    assert not problems[0].needs(problems[1])
    groups = grouped(problems, trunk_for_the_weak_hand, BODY)
    arm = next(g for g in groups if 0 in g.problems)
    assert 1 in arm.problems
    # Digits that are bent against their own hand are not drawn in.
    assert not set(range(3, len(problems))) & set(arm.problems)


def test_a_head_that_a_constraint_turns_is_not_levelled() -> None:
    trunk_alone, with_head = (
        grouped(problems, [Reach.OWN] * len(problems), BODY)
        for problems in (
            build(tasks(along(DIR, Bone("back_2"), UP))),
            build(tasks(along(DIR, Bone("back_2"), UP), Rotate(Bone("head"), UP, 0.1))),
        )
    )
    assert "head.flexion" in names(trunk_alone[0].free)
    assert "head.flexion" not in names(with_head[0].free)
    assert [len(g.problems) for g in with_head] == [1, 1]


def test_fixed_coordinates_are_never_free() -> None:
    fixed = frozenset({RIG.coordinates.index["arm_R.flexion"]})
    problems = build(tree())
    assert not any(
        fixed & g.free for g in grouped(problems, [Reach.ALL] * len(problems), BODY, fixed)
    )


def test_a_ring_of_dependencies_is_one_group() -> None:
    problems = build(
        tasks(
            Place(Site("I_TIP", S), SitePoint(Site("I_TIP", W))),
            Place(Site("M_TIP", W), SitePoint(Site("PA", S))),
        )
    )
    groups = grouped(problems, [Reach.OWN] * 2, BODY)
    assert [g.problems for g in groups] == [(0, 1)]


def test_ordering_is_topological_with_ties_by_key_and_rings_together() -> None:
    needs = {0: {3}, 1: set(), 2: {4}, 3: set(), 4: {2}}
    order = ordered(5, lambda i: set(needs[i]), [0, 4, 3, 2, 1])
    assert order == [[4, 2], [3], [0], [1]]
