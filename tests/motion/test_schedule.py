"""What a score requires of the body that ships, before anything is solved."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from every_member import CONSTRAINTS, MOVING_POINTS, POINTS, title

from azee.motion.keys.transpath import (
    PathMotion,
    boundaries_on_paths,
    end_times,
    limbs_on_paths,
    path_motions,
    sample_times,
)
from azee.motion.overlay.trill import add_trills, oscillation
from azee.motion.tasks.contradiction import contradict
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.limbs import Limbs, channels_of_constraint
from azee.motion.tasks.schedule import TaskSchedule, bind
from azee.motion.tasks.timed_task import TimedTask
from azee.score.interval import Interval
from azee.score.score import CHANNELS, Block, Group, Hold, Key
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver import kinematics
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Relation,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import (
    Between,
    Bone,
    Dir,
    Moving,
    NamedPoint,
    Point,
    Scale,
    Side,
    SigningSpace,
    Site,
    SitePoint,
    Straight,
    Vec,
    VTranslate,
)

F = Fraction
S, W = Side.STRONG, Side.WEAK
UP, FORWARD = Vec(0, 1, 0), Vec(0, 0, 1)
MIDDLE, RIGHT = NamedPoint(SigningSpace.MSSP), NamedPoint(SigningSpace.RSSP)
TIP = Site("I_TIP", S)
PALM = Bone("palm", S)


FINGERS = ("index", "middle", "ring", "little", "thumb")


@cache
def rig() -> Rig:
    return load_rig()


@cache
def evaluator() -> Evaluator:
    return Evaluator(rig(), Side.RIGHT)


def schedule(*blocks: Block) -> TaskSchedule:
    score = Group(max(b.interval_in_parent.end for b in blocks), blocks=blocks)
    return bind(flatten(score), rig(), evaluator().binding, Limbs.of(rig().coordinates))


def block(name: str, start: str, length: str, *constraints: Constraint) -> Block:
    span = Interval(F(start), F(start) + F(length))
    return Block(name, span, Key(F(length), constraints=constraints))


def one(constraint: Constraint) -> TimedTask:
    return schedule(block("ONE", "0", "1", constraint)).all[0]


def test_every_coordinate_is_of_one_limb() -> None:
    limbs = Limbs.of(rig().coordinates)
    assert limbs.names == (
        "trunk", "head", "eyes", "arm_L", *(f"{f}_L" for f in FINGERS), "arm_R",
        *(f"{f}_R" for f in FINGERS),
    )  # fmt: skip
    assert sum(len(m) for m in limbs.members.values()) == len(rig().coordinates)
    assert limbs.touching([rig().coordinates.index["clav_L.elevation"]]) == {"arm_L"}


def test_a_placement_moves_the_limbs_from_the_trunk_to_its_site() -> None:
    assert one(Place(TIP, MIDDLE)).limbs == {"trunk", "arm_R", "index_R"}
    assert one(Place(TIP, MIDDLE)).read_limbs == frozenset()


def test_what_carries_a_target_is_read() -> None:
    forehead = one(Place(TIP, SitePoint(Site("FH"))))
    assert forehead.limbs == {"arm_R", "index_R"}
    assert forehead.read_limbs == {"head"}


def test_a_gaze_reads_the_trunk_but_does_not_move_it() -> None:
    gaze = one(LookAt(MIDDLE))
    assert gaze.limbs == {"eyes", "head"}
    assert gaze.read_limbs == {"trunk"}


def test_a_point_that_moves_is_dynamic_and_goes_by_minimum_jerk() -> None:
    assert not one(Place(TIP, MIDDLE)).dynamic
    moving = one(Place(TIP, Moving(Straight(), MIDDLE, RIGHT)))
    assert moving.dynamic
    assert [moving.phase(F(n, 2)) for n in range(3)] == [0, 0.5, 1]
    assert moving.ik_task(F(1, 2)).phase == 0.5


@pytest.mark.parametrize("point", [*POINTS, *MOVING_POINTS], ids=title)
def test_every_point_is_known_to_move_or_to_stay(point: Point) -> None:
    frames = rig().chain.frames(rig().coordinates.idle)
    first, later = (evaluator().point(point, frames, phase) for phase in (0.0, 0.5))
    betweens = Between(point, MIDDLE, 0.5), Between(MIDDLE, point, 0.5)
    for wanted in (point, VTranslate(point, UP), *betweens):
        assert one(Place(TIP, wanted)).dynamic == bool(np.any(first != later))


@pytest.mark.parametrize("constraint", CONSTRAINTS, ids=title)
def test_every_constraint_is_a_posture_s_or_a_movement_s(constraint: Constraint) -> None:
    found = schedule(block("ONE", "0", "1", constraint))
    layered = isinstance(constraint, Transpath | Trill | Rotate)
    assert len(found.posture_tasks) == (not layered)
    assert len(found.accents) == isinstance(constraint, Rotate)
    assert len(found.all) == 1
    assert found.all[0].moves


@pytest.mark.parametrize(
    ("constraint", "channels"),
    [
        (Place(TIP, MIDDLE), ("hands", "strong", "right")),
        (Morph("index_bend", S, 1.0), ("hands", "strong", "right")),
        (Orient(BoneAxis.DIR, Bone("clav", W), Relation.ALONG, UP), ("hands", "weak", "left")),
        (Rotate(Bone("head"), UP, 0.1), ("head",)),
        (Look(FORWARD), ("eyes",)),
        (Orient(BoneAxis.DIR, Bone("back_2"), Relation.ALONG, UP), ("trunk",)),
        (Morph("spine_extended", None, 0.3), ("trunk",)),
        (Morph("AU1", None, 1.0), ("face",)),
    ],
)
def test_a_hold_keeps_a_constraint_if_it_names_a_channel_of_it(
    constraint: Constraint, channels: tuple[str, ...]
) -> None:
    assert channels_of_constraint(constraint, evaluator().binding) == {*channels}
    for channel in (*CHANNELS, "nothing"):
        hold = Block("H", Interval(F(1), F(2)), Hold(F(1), block="A", channels=(channel,)))
        held = schedule(block("A", "0", "1", constraint), hold).all[1:]
        assert len(held) == (channel in channels)


def test_a_hold_of_a_hold_keeps_what_both_keep() -> None:
    for outer, kept in (("strong", 1), ("hands", 1), ("weak", 0), ("face", 0)):
        blocks = [
            Block("H", Interval(F(1), F(2)), Hold(F(1), block="A", channels=("hands",))),
            Block("I", Interval(F(2), F(3)), Hold(F(1), block="H", channels=(outer,))),
        ]
        found = schedule(block("A", "0", "1", Place(TIP, MIDDLE)), *blocks).all
        assert sum(task.interval.start == 2 for task in found) == kept


def test_what_names_something_that_the_rig_lacks_is_left_out() -> None:
    lacking = Place(Site("NOWHERE"), MIDDLE)
    assert schedule(block("ONE", "0", "1", lacking)).all == ()
    both = schedule(block("ONE", "0", "1", lacking, Place(TIP, MIDDLE)))
    assert [task.constraint for task in both.all] == [Place(TIP, MIDDLE)]


NRM_UP = Orient(BoneAxis.NRM, PALM, Relation.ALONG, UP)


@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        (Place(TIP, MIDDLE), Place(TIP, RIGHT), True),
        (Place(TIP, MIDDLE), Place(TIP, MIDDLE), False),
        (Place(TIP, MIDDLE), Place(TIP, MIDDLE, distance_m=0.1), True),
        (Place(TIP, Moving(Straight(), RIGHT, MIDDLE)), Place(TIP, MIDDLE), False),
        (Place(TIP, Moving(Straight(), MIDDLE, RIGHT)), Place(TIP, MIDDLE), True),
        (Place(TIP, VTranslate(MIDDLE, Scale(UP, 0.1))), Place(TIP, MIDDLE), True),
        (Place(TIP, VTranslate(MIDDLE, Scale(UP, 0.0))), Place(TIP, MIDDLE), False),
        (Place(TIP, MIDDLE), Place(Site("I_TIP", W), RIGHT), False),
        (Place(TIP, MIDDLE), Place(Site("I_TIP", Side.RIGHT), RIGHT), True),
        (NRM_UP, Orient(BoneAxis.NRM, PALM, Relation.ALONG, FORWARD), True),
        (NRM_UP, Orient(BoneAxis.NRM, PALM, Relation.ALONG, Scale(UP, 2.0)), False),
        (NRM_UP, Orient(BoneAxis.DIR, PALM, Relation.ALONG, FORWARD), False),
        (NRM_UP, Orient(BoneAxis.NRM, PALM, Relation.ACROSS, FORWARD), False),
        (Look(UP), LookAt(MIDDLE), True),
        (Rotate(Bone("head"), UP, 0.1), Rotate(Bone("head"), UP, -0.1), True),
        (Morph("index_bend", S, 1.0), Morph("index_bend", S, 0.2), True),
        (Morph("index_bend", S, 1.0), Morph("middle_bend", S, 0.2), False),
    ],
)
def test_contradictions_are_found_by_comparing_targets(
    first: Constraint, second: Constraint, expected: bool
) -> None:
    both = schedule(block("A", "0", "1", first), block("B", "1", "1", second)).body_tasks
    measure = evaluator()
    frames = kinematics.frames(measure.rig.chain, measure.rig.coordinates.idle)
    assert contradict(both[:1], both[1:], measure, frames) == expected


PATH = Transpath(TIP, Straight())


def path_motion(*blocks: Block) -> PathMotion:
    (found,) = path_motions(schedule(*blocks), Side.RIGHT)
    return found


def test_a_path_leads_from_the_placement_before_to_the_one_after() -> None:
    found = path_motion(
        block("OTHER", "0", "2", Place(Site("I_TIP", W), MIDDLE)),
        block("A", "0", ".5", Place(TIP, MIDDLE)),
        block("P", ".5", "1", PATH),
        block("B", "1.5", ".5", Place(TIP, RIGHT)),
    )
    assert found.before is not None
    assert found.after is not None
    assert [found.before.path, found.after.path] == [("A",), ("B",)]
    assert (found.start, found.end) == (F(1, 2), F(3, 2))
    assert [found.controls(t) for t in (F(1, 2), F(1), F(3, 2))] == [False, True, False]
    assert found.progress(F(1)) == 0.5


def test_a_placement_that_overlaps_a_path_holds_its_site_as_long_as_it_lasts() -> None:
    found = path_motion(
        block("A", "0", ".6", Place(TIP, MIDDLE)),
        block("P", ".5", "1", PATH),
        block("B", "1.4", ".6", Place(TIP, RIGHT)),
    )
    assert (found.start, found.end) == (F("0.6"), F("1.4"))
    assert not found.controls(F("0.55"))


def test_a_site_waits_where_placements_leave_a_gap_to_its_path() -> None:
    found = path_motion(
        block("A", "0", ".5", Place(TIP, MIDDLE)),
        block("P", ".7", ".6", PATH),
        block("B", "1.5", ".5", Place(TIP, RIGHT)),
    )
    assert (found.start, found.end) == (F("0.7"), F("1.3"))
    assert found.between == Interval(F("0.5"), F("1.5"))
    assert found.controls(F("0.7"))
    assert found.progress(F("0.7")) == 0


def test_keyframes_on_a_path_wait_for_its_ends() -> None:
    found = schedule(
        block("A", "0", ".5", Place(TIP, MIDDLE)),
        block("P", ".5", "1", PATH),
        block("LOOK", ".9", ".2", Look(FORWARD)),
        block("NOD", ".7", ".1", Rotate(Bone("head"), UP, 0.1)),
        block("FACE", ".8", ".1", Morph("AU1", None, 1.0)),
        block("B", "1.5", ".5", Place(TIP, RIGHT)),
    )
    known = path_motions(found, Side.RIGHT)
    assert end_times(known) == {F("0.5"), F("1.5")}
    assert boundaries_on_paths(known, found) == {F("0.9"), F("1.1")}


def test_what_follows_a_moving_hand_moves() -> None:
    elbow_on_tip = Place(Site("I_TIP", W), SitePoint(Site("EL", S)))
    found = schedule(
        block("A", "0", ".5", Place(TIP, MIDDLE)),
        block("P", ".5", "1", PATH),
        block("F", "0", "2", elbow_on_tip),
        block("B", "1.5", ".5", Place(TIP, RIGHT)),
    )
    known = path_motions(found, Side.RIGHT)
    followers = [t for t in found.posture_tasks if t.path == ("F",)]
    assert {"arm_R", "arm_L", "index_L"} <= limbs_on_paths(F(1), followers, known)
    assert limbs_on_paths(F(1, 2), followers, known) == frozenset()


def test_paths_are_sampled_by_length_and_by_turns() -> None:
    t = np.linspace(0, 1, 65)[:, None]
    span = Interval(F(2), F(3))
    short = sample_times(np.array([0.1, 0, 0]) * t, span)
    long = sample_times(np.array([0.9, 0, 0]) * t, span)
    small = 0.02 * np.hstack([np.cos(12 * t), np.sin(12 * t), 0 * t])
    assert len(short) < 15 <= len(long) <= 16
    assert len(sample_times(small, span)) > 12
    assert all(2 < time < 3 for time in long)
    assert sample_times(np.full((65, 3), np.nan), span) == []
    assert sample_times(small, Interval(F(1), F(1))) == []


def test_a_trill_swings_from_the_start_of_its_block() -> None:
    trill = Trill(Bone("f_arm", S), Dir(Bone("f_arm", S)), 4.0, 0.1)
    task = schedule(block("T", "1.3", "1", trill)).all[0]
    swing = oscillation(task, rig().coordinates.idle, evaluator())
    quarters = 1.3 + np.arange(2, 15) / 16  # of a second: every quarter of a period of 4 Hz
    wanted = 0.1 * np.array([0, -1, 0, 1] * 4)[: len(quarters)]
    assert swing.angles(quarters) == pytest.approx(wanted, abs=1e-9)
    # The fades of a tenth of a second at both ends: zero outside, half in their middle.
    edge = swing.angles(np.array([1.3, 1.35, 2.25, 2.3]))
    half = 0.05 * math.sin(2 * math.pi * 4.0 * 0.05)
    assert edge == pytest.approx([0.0, half, -half, 0.0], abs=1e-9)


@pytest.mark.parametrize(
    ("room_rad", "short_rad"), [(0.2, 0.0), (0.09, 0.0), (0.06, 0.0), (0.02, 0.03)]
)
def test_a_trill_near_a_limit_keeps_its_size_and_moves_its_middle(
    room_rad: float, short_rad: float
) -> None:
    trill = Trill(Bone("f_arm", S), Dir(Bone("f_arm", S)), 4.0, 0.1)
    task = schedule(block("T", "0", "1", trill)).all[0]
    coordinates = rig().coordinates
    swing = oscillation(task, coordinates.idle, evaluator())
    turned = int(np.abs(swing.direction).argmax())
    q = np.tile(coordinates.idle, (161, 1))
    q[:, turned] = coordinates.upper[turned] - room_rad * abs(swing.direction[turned])
    times = np.arange(161) / 160
    out, short = add_trills(q, times, [swing], coordinates)
    middle = (times > 0.2) & (times < 0.8)
    shown = np.ptp(out[middle, turned]) / abs(swing.direction[turned])
    assert shown == pytest.approx(0.2 - short_rad, abs=1e-3)
    assert short[task.rank] == pytest.approx(short_rad * abs(swing.direction[turned]), abs=1e-3)


def test_a_trill_about_an_axis_of_no_length_turns_nothing() -> None:
    nowhere = one(Trill(Bone("palm", S), Vec(0.0, 0.0, 0.0), 5.0, 0.1))
    swing = oscillation(nowhere, rig().coordinates.idle, evaluator())
    assert swing.turnable == 0.0
    assert not swing.direction.any()


@pytest.mark.parametrize("bone", ["palm", "f_arm", "head"])
def test_a_trill_turns_its_bone_about_its_axis(bone: str) -> None:
    side = None if bone == "head" else S
    of = Bone(bone, side)
    trill = one(Trill(of, Dir(of), 5.0, 0.1))
    q = rig().coordinates.idle
    swing = oscillation(trill, q, evaluator())
    assert swing.turnable > 0.9
    node = evaluator().binding.bone(of).node
    before, after = (rig().chain.frames(p).rotations[node] for p in (q, q + 0.01 * swing.direction))
    turned = after @ before.T
    angle = math.acos((np.trace(turned) - 1) / 2)
    axis = np.array([turned[2, 1], turned[0, 2], turned[1, 0]]) - turned[[1, 2, 0], [2, 0, 1]]
    assert angle == pytest.approx(0.01, rel=1e-3)
    assert axis / np.linalg.norm(axis) @ before[:, 1] > 0.999
