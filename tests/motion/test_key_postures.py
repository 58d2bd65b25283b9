"""What the solver is asked for, told by a solver that only writes it down."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.animation import Animation, animate
from azee.motion.keys.rest import DEFAULT, rest_posture
from azee.motion.keys.transpath import boundaries_on_paths, path_motions
from azee.motion.tasks.key_posture import Origin, Search
from azee.motion.tasks.key_selection import Mode
from azee.score.interval import Interval
from azee.score.score import Block, Group, Hold, Key, Score
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    LookAt,
    Morph,
    Orient,
    Place,
    Relation,
    Transpath,
)
from azee_solver.geometry import (
    Bone,
    FreePoint,
    Moving,
    NamedPoint,
    Side,
    SigningSpace,
    Site,
    SitePoint,
    Straight,
    Vec,
    WorldPoint,
)
from azee_solver.solve_report import ConstraintReport, SolveReport
from azee_solver.task import Task

F = Fraction
S = Side.STRONG
MIDDLE, RIGHT = NamedPoint(SigningSpace.MSSP), NamedPoint(SigningSpace.RSSP)
TIP, WEAK_TIP = Site("I_TIP", S), Site("I_TIP", Side.WEAK)
HERE, THERE = Place(TIP, MIDDLE), Place(TIP, RIGHT)
NOD = Orient(BoneAxis.DIR, Bone("head"), Relation.ALONG, Vec(0, 1, 0.1))


@cache
def rig() -> Rig:
    return load_rig()


@dataclass
class Asked:
    constraints: tuple[Constraint, ...]
    start: NDArray[np.float64]
    reference: NDArray[np.float64]
    search: Search
    fixed: frozenset[int]


@dataclass
class Recorder:
    """Says that it meets what `can` says but what is in `never`, and moves shoulder and trunk.

    It never moves what is fixed.
    """

    can: Callable[[Sequence[Constraint]], bool] = lambda _: True
    never: frozenset[Constraint] = frozenset()
    asked: list[Asked] = field(default_factory=list)

    def __call__(
        self,
        ik_tasks: Sequence[Task],
        *,
        start: NDArray[np.float64],
        reference: NDArray[np.float64],
        search: Search = Search.GLOBAL,
        fixed: frozenset[int] = frozenset(),
    ) -> SolveReport:
        constraints = tuple(d.constraint for d in ik_tasks)
        self.asked.append(Asked(constraints, start, reference, search, fixed))
        q = np.array(reference)
        q[rig().coordinates.index["arm_R.flexion"]] += 0.2
        q[rig().coordinates.index["back_2.flexion"]] += 0.1
        q = np.clip(q, rig().coordinates.lower, rig().coordinates.upper)
        q[[*fixed]] = start[[*fixed]]
        reports = []
        for d in ik_tasks:
            met = self.can(constraints) and d.constraint not in self.never
            why, residual = (None, 0.0) if met else ("no", 1.0)
            reports.append(ConstraintReport(d, residual, "m", 1e-3, met, why))
        return SolveReport(q, (), tuple(reports), (), 1, 0.0, frozenset())

    def placed(self) -> list[list[object]]:
        """The points where the strong index tip was asked to be, per solve."""
        return [
            [c.point for c in a.constraints if isinstance(c, Place) and c.site == TIP]
            for a in self.asked
        ]


def block(name: str, start: str, length: str, *constraints: Constraint) -> Block:
    span = Interval(F(start), F(start) + F(length))
    return Block(name, span, Key(F(length), constraints=constraints))


def sync(*blocks: Block) -> Group:
    return Group(max(b.interval_in_parent.end for b in blocks), blocks=blocks)


def play(score: Score, solver: Recorder, mode: Mode = "tracks") -> Animation:
    return animate(score, rig(), solver=solver, fps=10, life=False, mode=mode)


def boundaries(solver: Recorder) -> list[Asked]:
    return [a for a in solver.asked if a.search is Search.GLOBAL]


def test_what_contradicts_is_never_asked_of_one_posture() -> None:
    solver = Recorder()
    animation = play(sync(block("A", "0", "1", HERE), block("B", "1", "1", THERE)), solver)
    assert [MIDDLE, RIGHT] not in solver.placed()
    assert [p.origin for p in animation.report.postures][:3] == [
        Origin.BOUNDARY, Origin.EARLY_END, Origin.BOUNDARY,
    ]  # fmt: skip


def test_what_no_posture_can_join_parts_and_the_later_block_has_the_instant() -> None:
    def can(constraints: Sequence[Constraint]) -> bool:
        return not (HERE in constraints and Place(Site("T_TIP", S), RIGHT) in constraints)

    solver = Recorder(can)
    later = Place(Site("T_TIP", S), RIGHT)
    animation = play(sync(block("A", "0", "1", HERE), block("B", "1", "1", later)), solver)
    at_one = [p for p in animation.report.postures if p.time == 1]
    assert [[d.constraint for d in p.ik_tasks] for p in at_one] == [[later]]
    early = [p for p in animation.report.postures if p.origin is Origin.EARLY_END]
    assert [[d.constraint for d in p.ik_tasks] for p in early] == [[HERE]]
    assert F(1, 2) <= early[0].time < 1


def test_what_one_posture_can_join_is_asked_of_one() -> None:
    solver = Recorder()
    later = Place(Site("T_TIP", S), RIGHT)
    animation = play(sync(block("A", "0", "1", HERE), block("B", "1", "1", later)), solver)
    (at_one,) = [p for p in animation.report.postures if p.time == 1]
    assert {d.constraint for d in at_one.ik_tasks} == {HERE, later}


def test_a_block_of_no_length_cannot_end_early() -> None:
    solver = Recorder()
    play(sync(block("A", "0", "0", HERE), block("B", "0", "1", THERE)), solver)
    assert solver.placed()[0] == [MIDDLE, RIGHT]


def test_a_constraint_that_two_blocks_repeat_is_asked_once() -> None:
    solver = Recorder()
    fist = Morph("index_bend", S, 1.0)
    hold = Block("H", Interval(F(1), F(2)), Hold(F(1), block="A"))
    play(sync(block("A", "0", "1", fist), hold, block("B", "0", "2", fist)), solver)
    assert all(a.constraints == (fist,) for a in solver.asked)


def test_fewer_of_the_same_tasks_need_no_solve() -> None:
    solver = Recorder()
    animation = play(sync(block("A", "0", "2", HERE), block("B", "0", "1", NOD)), solver)
    assert len(boundaries(solver)) == 1
    assert [p.reused for p in animation.report.postures if p.origin is Origin.BOUNDARY] == [
        False, True, True,
    ]  # fmt: skip


def test_what_is_open_is_drawn_to_idle_and_a_block_that_lasts_is_where_the_search_starts() -> None:
    solver = Recorder()
    idle = rig().coordinates.idle
    flexion = rig().coordinates.index["arm_R.flexion"]
    play(
        sync(block("A", "0", ".5", HERE), block("B", ".7", "1", THERE), block("C", "1", ".3", NOD)),
        solver,
    )
    a, b, c = boundaries(solver)[:3]
    arm = [v for v, name in enumerate(rig().coordinates.names) if name.startswith("arm_R")]
    assert all(asked.reference[arm] == pytest.approx(idle[arm]) for asked in (a, b, c))
    weak = [v for v, name in enumerate(rig().coordinates.names) if name.startswith("arm_L")]
    standing = rest_posture(rig(), DEFAULT, Side.RIGHT)
    assert a.reference[weak] == pytest.approx(standing[weak]), "where nothing is asked it rests"
    assert [asked.start[flexion] - idle[flexion] for asked in (a, b, c)] == pytest.approx(
        [0.0, 0.0, 0.2]
    )


def test_a_gaze_that_lasts_does_not_keep_the_trunk_bent() -> None:
    solver = Recorder()
    bend = rig().coordinates.index["back_2.flexion"]
    gaze = LookAt(FreePoint(0, 0, 2))
    play(
        sync(block("A", "0", ".5", HERE), block("B", ".7", "1", THERE), block("G", "0", "2", gaze)),
        solver,
    )
    second = next(a for a in boundaries(solver) if THERE in a.constraints)
    assert second.reference[bend] == pytest.approx(rig().coordinates.idle[bend])


def _free(asked: Asked) -> set[str]:
    names = rig().coordinates.names
    return {names[v].partition(".")[0] for v in set(range(len(names))) - asked.fixed}


def test_what_is_new_is_solved_while_what_lasts_stays_still() -> None:
    solver = Recorder()
    animation = play(sync(block("A", "0", "2", HERE), block("N", "1", ".5", NOD)), solver)
    first, second = boundaries(solver)
    assert first.fixed == frozenset()
    assert second.constraints == (HERE, NOD)
    assert _free(second) == {"head", "neck"}
    at_one = next(p for p in animation.report.postures if p.time == 1)
    flexion = rig().coordinates.index["arm_R.flexion"]
    assert at_one.coordinates[flexion] == animation.report.postures[0].coordinates[flexion]


def test_what_follows_a_new_posture_is_solved_with_it_and_the_trunk_stays() -> None:
    solver = Recorder()
    weak = Place(WEAK_TIP, MIDDLE)
    follower = Place(TIP, SitePoint(Site("PA", Side.WEAK)))
    palm = Orient(BoneAxis.DIR, Bone("back_2"), Relation.ALONG, Vec(0, 1, 0))
    play(sync(block("A", "0", "2", follower, palm), block("N", "1", ".5", weak)), solver)
    free = _free(boundaries(solver)[1])
    assert {"arm_L", "arm_R", "index_L_1", "index_R_1"} <= free
    assert not {"back_1", "back_2", "head"} & free


def test_a_head_that_the_solver_levelled_stays_level_while_the_trunk_is_needed() -> None:
    class Leveller(Recorder):
        def __call__(self, ik_tasks: Sequence[Task], **how: object) -> SolveReport:
            report = super().__call__(ik_tasks, **how)  # type: ignore[arg-type]
            q = np.array(report.coordinates)
            q[rig().coordinates.index["head.flexion"]] = -0.2
            return replace(report, coordinates=q)

    animation = play(sync(block("A", "0", "3", HERE)), Leveller())
    head = rig().coordinates.index["head.flexion"]
    inside = animation.clip.times - animation.lead_s
    during = animation.clip.coordinates[(inside >= 0) & (inside <= 3), head]
    assert during == pytest.approx(-0.2)
    assert [p.reused for p in animation.report.postures] == [False, True]


def test_an_unmet_task_keeps_its_answer_while_a_new_one_is_solved() -> None:
    solver = Recorder(never=frozenset((HERE,)))
    animation = play(sync(block("A", "0", "2", HERE), block("N", "1", ".5", NOD)), solver)
    assert [a.constraints for a in boundaries(solver)] == [(HERE,), (NOD,)]
    at_one = next(p for p in animation.report.postures if p.time == 1)
    assert [(c.task.constraint, c.met) for c in at_one.report.constraints] == [
        (NOD, True), (HERE, False),
    ]  # fmt: skip
    assert [d.constraint for d in at_one.ik_tasks] == [NOD, HERE]


def test_a_head_comes_back_though_a_hand_goes_by_it() -> None:
    forehead = Place(TIP, SitePoint(Site("FH")))
    blocks = (
        block("A", "0", "2", forehead),
        block("N", "0", ".3", NOD),
        block("E", "1", ".2", LookAt(MIDDLE)),
    )
    idle = rig().coordinates.idle
    head = rig().coordinates.index["head.flexion"]

    class Nodder(Recorder):
        def __call__(self, ik_tasks: Sequence[Task], **how: object) -> SolveReport:
            report = super().__call__(ik_tasks, **how)  # type: ignore[arg-type]
            q = np.array(report.coordinates)
            if any(d.constraint == NOD for d in ik_tasks):
                q[head] = 0.1
            return replace(report, coordinates=q)

    animation = play(sync(*blocks), Nodder())
    at = {float(p.time): p.coordinates[head] for p in animation.report.postures}
    assert at[0.0] == at[0.3] == pytest.approx(0.1)
    assert at[1.0] == pytest.approx(idle[head])
    shaken = play(sync(*blocks, block("M", ".6", ".1", NOD)), Nodder())
    at = {float(p.time): p.coordinates[head] for p in shaken.report.postures}
    assert at[0.3] == at[0.6] == at[0.7] == pytest.approx(0.1)


def test_where_what_lasts_is_in_the_way_all_is_solved_anew() -> None:
    solver = Recorder(lambda constraints: NOD not in constraints)
    play(sync(block("A", "0", "2", HERE), block("N", "1", ".5", NOD)), solver)
    assert [bool(a.fixed) for a in boundaries(solver)[1:3]] == [True, False]


def test_a_limb_long_unused_is_at_rest_again() -> None:
    solver = Recorder()
    weak = Place(WEAK_TIP, MIDDLE)
    play(sync(block("A", "0", ".5", HERE), block("B", "3", "1", weak)), solver)
    second = boundaries(solver)[1]
    assert second.constraints == (weak,)
    strong = [v for v, name in enumerate(rig().coordinates.names) if name.startswith("arm_R")]
    standing = rest_posture(rig(), DEFAULT, Side.RIGHT)
    assert second.start[strong] == pytest.approx(standing[strong])


def test_on_a_path_the_trunk_keeps_its_curve_and_the_search_is_local() -> None:
    solver = Recorder()
    path = Transpath(TIP, Straight())
    animation = play(
        sync(block("A", "0", ".5", HERE), block("P", ".5", "1", path),
             block("B", "1.5", ".5", THERE)),
        solver,
        "flat",
    )  # fmt: skip
    on_path = [a for a in solver.asked if a.search is Search.LOCAL]
    trunk = {i for i, n in enumerate(rig().coordinates.names) if n.startswith("back_")}
    assert on_path
    assert all(a.fixed >= trunk for a in on_path)
    assert all(isinstance(p, WorldPoint) for points in solver.placed()[2:] for p in points)
    assert Origin.PATH in [p.origin for p in animation.report.postures]


def test_what_no_boundary_could_meet_is_not_searched_for_on_a_path() -> None:
    blocks = (
        block("A", "0", ".5", HERE, NOD),
        block("P", ".5", "1", Transpath(TIP, Straight()), NOD),
        block("B", "1.5", ".5", THERE, NOD),
    )
    infeasible = Recorder(never=frozenset((NOD,)))
    play(sync(*blocks), infeasible, "flat")
    assert len(boundaries(infeasible)) == 2
    unlucky = Recorder(lambda constraints: HERE in constraints or THERE in constraints)
    play(sync(*blocks), unlucky, "flat")
    assert len(boundaries(unlucky)) > 2


def test_a_moving_point_is_sampled_on_its_way() -> None:
    solver = Recorder()
    moving = Place(TIP, Moving(Straight(), MIDDLE, RIGHT))
    animation = play(sync(block("A", "0", "1", moving)), solver, "flat")
    samples = [p for p in animation.report.postures if p.origin is Origin.PATH]
    assert len(samples) > 1
    assert all(0 < d.phase < 1 for p in samples for d in p.ik_tasks)


def test_a_key_that_ends_one_path_is_solved_first_though_it_lies_on_another() -> None:
    from azee.motion.tasks.flatten import flatten
    from azee.motion.tasks.limbs import Limbs
    from azee.motion.tasks.schedule import bind
    from azee_solver.binding import Binding

    score = sync(
        block("A", "0", ".2", HERE),
        block("P", ".2", ".6", Transpath(TIP, Straight())),
        block("B", ".8", ".2", THERE),
        block("WA", "0", ".4", Place(WEAK_TIP, MIDDLE)),
        block("WP", ".4", ".5", Transpath(WEAK_TIP, Straight())),
        block("WB", ".9", ".1", Place(WEAK_TIP, RIGHT)),
    )
    schedule = bind(flatten(score), rig(), Binding(rig(), Side.RIGHT), Limbs.of(rig().coordinates))
    known = path_motions(schedule, Side.RIGHT)
    assert boundaries_on_paths(known, schedule) == frozenset()
    assert {F("0.4"), F("0.8")} <= {p.time for p in play(score, Recorder()).report.postures}
