"""Times as performed: ways of arms get the time that they need, and the rest of a score moves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from numpy.typing import NDArray

import azee
from azee.animation import Animation, animate
from azee.clip.spline import minimum_jerk
from azee.motion.curves.limb_curves import ONSET_SPREAD_S
from azee.motion.tasks.key_posture import Search
from azee.motion.tasks.limbs import Limbs
from azee.motion.timing.accents import is_accent
from azee.motion.timing.pace import PEAK_ACCELERATION, PEAK_SPEED, Pace
from azee.motion.timing.remembering import RememberingSolver
from azee.motion.timing.ways import Ways
from azee.quality import signing_dynamics as recordings
from azee.quality.outcome import longer
from azee.score.interval import Interval
from azee.score.score import Block, Group, Hold, Key, Score, leaves
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    Morph,
    Orient,
    Place,
    Relation,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Bone, Circle, Moving, Side, Site, Straight, Vec, WorldPoint
from azee_solver.solve_report import ConstraintReport, SolveReport
from azee_solver.task import Task

Array = NDArray[np.float64]
F = Fraction
S = Side.STRONG
PALM = Site("PA", S)
UP, DOWN = Vec(0, 1, 0), Vec(0, -1, 0)
LEFT, RIGHT = Place(PALM, WorldPoint(0.1, 1.2, 0.3)), Place(PALM, WorldPoint(-0.4, 1.2, 0.3))
NEAR = Place(PALM, WorldPoint(-0.35, 1.2, 0.3))


@cache
def rig() -> Rig:
    return load_rig()


SCALE = Ways(evaluator(rig(), Side.RIGHT), Limbs.of(rig().coordinates).members, Pace()).scale


def test_a_body_of_another_size_takes_the_time_of_the_signer() -> None:
    child = load_rig("child")
    measure = Ways(evaluator(child, Side.RIGHT), Limbs.of(child.coordinates).members, Pace())
    assert measure.scale > 1.1 * SCALE
    arms = [child.bones[f"arm_{s}"].origin_node for s in "LR"]
    left, right = child.chain.frames(child.coordinates.idle).positions[arms]
    assert measure.scale * np.linalg.norm(left - right) == pytest.approx(recordings.SHOULDERS_M)


def block(name: str, start: str, length: str, *constraints: Constraint) -> Block:
    interval = Interval(F(start), F(start) + F(length))
    return Block(name, interval, Key(F(length), constraints=constraints))


def inside(name: str, start: str, score: Score) -> Block:
    return Block(name, Interval(F(start), F(start) + score.duration), score)


def sync(*blocks: Block) -> Group:
    return Group(max(b.interval_in_parent.end for b in blocks), blocks=blocks)


def turned(degrees: float) -> Rotate:
    return Rotate(Bone("head"), UP, math.radians(degrees))


SHAKE = sync(block("A", "0", ".05", turned(-10)), block("B", ".13", ".05", turned(10)))
FAR = sync(block("A", "0", ".4", LEFT), block("B", ".6", ".4", RIGHT))
"""Half a metre in .2 s."""


@cache
def played(score: Score, timing: str | None = None, tempo: float = 1.0) -> Animation:
    return animate(score, rig(), fps=100, life=False, timing=timing, tempo=tempo)  # type: ignore[arg-type]


def times(score: Score) -> dict[str, tuple[float, float]]:
    return {
        "/".join(x.path): (float(x.interval.start), float(x.interval.end)) for x in leaves(score)
    }


def largest(animation: Animation, bone: str = "palm_R") -> tuple[float, float]:
    """Largest speed and acceleration of a wrist between the ends of the score."""
    at = animation.clip.times - animation.lead_s
    rows = (at >= 0) & (at <= float(animation.score.duration))
    q = animation.clip.coordinates[rows]
    wrist = rig().chain.frames(q).positions[:, rig().bones[bone].origin_node]
    return tuple(  # type: ignore[return-value]
        float(np.linalg.norm(np.diff(wrist, n, axis=0), axis=1).max() * 100**n) for n in (1, 2)
    )


def test_the_peaks_of_minimum_jerk_are_those_of_its_curve() -> None:
    at = np.linspace(0.0, 1.0, 10_001)
    speed = np.gradient(minimum_jerk(at), at)
    assert speed.max() == pytest.approx(PEAK_SPEED, rel=1e-6)
    assert np.gradient(speed, at).max() == pytest.approx(PEAK_ACCELERATION, rel=1e-3)


@pytest.mark.parametrize(
    ("way_m", "turn_deg", "least_s"),
    [
        (0.5, 0, 1.875 * 0.5 / 1.9),
        (0.05, 0, math.sqrt(5.7735 * 0.05 / 34.0)),
        (0.05, 90, 1.875 * 90 / 570),
        (0.0, 0, 0.0),
    ],
)
def test_the_least_time_is_that_of_the_tightest_limit(
    way_m: float, turn_deg: float, least_s: float
) -> None:
    assert Pace().least_s(way_m, math.radians(turn_deg)) == pytest.approx(least_s, rel=1e-4)


def test_a_pace_has_limits_above_zero() -> None:
    with pytest.raises(ValueError, match="above zero"):
        Pace(wrist_m_s=0.0)


def test_at_the_time_needed_the_wrist_is_as_fast_as_the_pace_allows() -> None:
    limbs = Limbs.of(rig().coordinates)
    before = np.array(rig().coordinates.idle)
    after = before.copy()
    after[rig().coordinates.index["arm_R.flexion"]] += 0.9
    ways = Ways(evaluator(rig(), Side.RIGHT), limbs.members, Pace(joint_rad_s=100.0))
    needed_s = ways.needed_s(before, after, frozenset(("arm_R",)))
    at = np.linspace(0.0, 1.0, 2001)
    q = before + (after - before) * np.asarray(minimum_jerk(at))[:, None]
    wrist = rig().chain.frames(q).positions[:, rig().bones["palm_R"].origin_node]
    together_s = needed_s - ONSET_SPREAD_S
    speed = np.linalg.norm(np.diff(wrist, axis=0), axis=1).max() * 2000 / together_s
    assert ways.scale * speed == pytest.approx(1.9, rel=0.01)
    assert ways.needed_s(before, after, frozenset(("arm_L",))) == 0.0
    assert ways.needed_s(before, after, frozenset(("head",))) == 0.0


def test_a_way_too_short_for_its_length_gets_what_it_needs() -> None:
    animation = played(FAR)
    (stretch,) = animation.report.stretched
    assert (stretch.way.source, stretch.way.target, stretch.way.side) == (("A",), ("B",), "R")
    assert stretch.score_s == F("1/5")
    assert 0.4 < stretch.way.way_m < 0.6
    assert stretch.performed_s >= stretch.way.needed_s / F("1.02")
    assert stretch.performed_s <= F("1.1") * stretch.way.needed_s
    extra_s = float(stretch.performed_s - stretch.score_s)
    assert animation.report.extra_s == pytest.approx(extra_s)
    found = times(animation.score)
    assert found["A"] == (0.0, 0.4)
    assert found["B"] == pytest.approx((0.6 + extra_s, 1.0 + extra_s))
    speed, acceleration = largest(animation)
    assert speed < 2.1
    assert acceleration < 42
    assert largest(played(FAR, "exact"))[0] > 4


def test_a_way_with_time_enough_stays_as_it_is() -> None:
    score = sync(block("A", "0", ".4", RIGHT), block("B", ".6", ".4", NEAR))
    animation = played(score)
    assert animation.score == score
    assert animation.report.stretched == ()
    assert longer(animation.report) == []
    exact = played(score, "exact")
    np.testing.assert_array_equal(animation.clip.coordinates, exact.clip.coordinates)


def test_exact_timing_keeps_the_times_of_the_text() -> None:
    exact = played(FAR, "exact")
    assert exact.score is FAR
    assert exact.report.timing == "exact"
    assert exact.report.stretched == ()
    starts = {c.path: c.start_s for c in exact.report.constraints}
    assert starts == {("A",): 0.0, ("B",): 0.6}


def test_flat_mode_is_exact_unless_asked_otherwise() -> None:
    assert animate(FAR, rig(), fps=10, mode="flat").score == FAR
    performed = animate(FAR, rig(), fps=10, mode="flat", timing="performed")
    assert performed.score.duration > FAR.duration


def test_a_block_that_must_end_early_gives_time_but_keeps_its_core() -> None:
    score = sync(block("A", "0", ".8", LEFT), block("B", ".8", ".4", RIGHT))
    animation = played(score)
    assert animation.score == score
    (early,) = (b for b in animation.report.blocks if b["path"] == ["A"])
    assert 0.15 <= float(str(early["held_until_s"])) < 0.4
    assert largest(animation)[0] < 2.1
    tight = sync(block("A", "0", ".3", LEFT), block("B", ".3", ".4", RIGHT))
    (early,) = (b for b in played(tight).report.blocks if b["path"] == ["A"])
    assert float(str(early["held_until_s"])) >= 0.15
    assert played(tight).score.duration > tight.duration


def test_where_half_a_block_was_its_core_another_round_gives_the_rest() -> None:
    score = sync(block("A", "0", ".2", LEFT), block("B", ".2", ".4", RIGHT))
    animation = played(score)
    assert largest(animation)[0] < 2.2
    (stretch,) = animation.report.stretched
    assert stretch.performed_s >= stretch.way.needed_s
    assert float(stretch.performed_s - stretch.score_s) == pytest.approx(animation.report.extra_s)


def test_a_short_way_gets_time_to_gather_speed() -> None:
    score = sync(block("A", "0", ".3", RIGHT), block("B", ".35", ".3", NEAR))
    (stretch,) = played(score).report.stretched
    by_speed_s = 1.875 * SCALE * stretch.way.way_m / 1.9
    assert float(stretch.way.needed_s) > 1.3 * by_speed_s
    assert largest(played(score))[1] < 44
    assert largest(played(score, "exact"))[1] > 80


def test_a_hand_that_is_held_over_a_swaying_trunk_needs_no_time() -> None:
    def sway(n: int) -> Block:
        lean = Rotate(Bone("back_1"), UP, math.radians(15 * (-1) ** n))
        return block(str(n), f"{n * 0.08:.2f}", ".03", lean)

    held = block("P", "0", "2", Place(PALM, WorldPoint(-0.2, 1.2, 0.35)))
    accent = sync(*(sway(n) for n in range(4)))
    animation = played(sync(held, inside("SWAY", "1", accent)))
    assert isinstance(animation.score, Group)
    assert animation.score.block("SWAY").score == accent
    assert animation.report.stretched == ()


def test_a_palm_that_turns_in_its_place_gets_time_too() -> None:
    def palm(towards: Vec) -> Orient:
        return Orient(BoneAxis.NRM, Bone("palm", S), Relation.ALONG, towards)

    score = sync(
        block("P", "0", "1", Place(PALM, WorldPoint(-0.2, 1.25, 0.3))),
        block("A", "0", ".4", palm(DOWN)),
        block("B", ".45", ".55", palm(UP)),
    )
    (stretch,) = played(score).report.stretched
    assert (stretch.way.source[-1], stretch.way.target[-1]) == ("A", "B")
    assert stretch.way.turn_rad > 1.0
    assert stretch.performed_s > F("1/4")


def test_a_path_inside_a_sign_gets_time_too() -> None:
    score = sync(
        block("A", "0", ".3", LEFT),
        block("WAY", ".3", ".2", Transpath(PALM, Straight())),
        block("B", ".5", ".3", RIGHT),
    )
    start, end = times(played(score).score)["WAY"]
    assert end - start == pytest.approx(1.875 * SCALE * 0.5 / 1.9, rel=0.01)


def test_a_moving_target_gets_time_too() -> None:
    here = WorldPoint(-0.2, 1.2, 0.3)
    circle = Place(PALM, Moving(Circle(Vec(0, 0, 1), 0.08, 1.0), here, here))
    animation = played(
        sync(block("A", "0", ".3", Place(PALM, here)), block("B", ".3", ".2", circle))
    )
    (stretch,) = animation.report.stretched
    assert stretch.way.target == ("B",)
    assert stretch.way.way_m == pytest.approx(2 * math.pi * 0.08, rel=0.01)
    least_s = 1.875 * SCALE * stretch.way.way_m / 1.9
    assert float(stretch.performed_s) == pytest.approx(least_s, abs=0.01)


def test_fixed_parts_keep_their_length() -> None:
    fixed = Group(FAR.duration, blocks=FAR.blocks, fixed=True)
    score = sync(inside("F", "0", fixed), block("C", "1.2", ".4", LEFT))
    animation = played(score)
    assert isinstance(animation.score, Group)
    assert animation.score.block("F").score == fixed
    assert {(s.way.source, s.way.target) for s in animation.report.stretched} == {
        (("F", "B"), ("C",))
    }


def test_a_head_shake_keeps_its_clock_and_its_start() -> None:
    score = sync(*FAR.blocks, inside("SHAKE", ".5", SHAKE))
    animation = played(score)
    assert isinstance(animation.score, Group)
    assert animation.score.duration > score.duration
    shaken = animation.score.block("SHAKE")
    assert shaken.score == SHAKE
    assert shaken.interval_in_parent.start > F(".5")


def test_a_nod_that_ends_a_group_ends_it_when_it_is_done() -> None:
    nod = sync(block("A", "0", ".1", turned(5)), block("B", ".4", ".7", turned(-5)))
    inner = sync(*FAR.blocks[:1], inside("NOD", ".3", nod))
    score = sync(inside("IN", "0", inner), *FAR.blocks[1:])
    performed = played(score).score
    for leaf in leaves(performed):
        for group in leaf.parents:
            assert group.duration == max(b.interval_in_parent.end for b in group.blocks)
            for b in group.blocks:
                assert b.interval_in_parent.duration == b.score.duration


@pytest.mark.parametrize(
    ("score", "expected"),
    [
        (SHAKE, True),
        (sync(inside("1", "0", SHAKE), block("2", ".5", ".1", Morph("AU1", None, 0.5))), True),
        (sync(block("A", "0", "1", Trill(Bone("head"), UP, 0.1, 3.0))), True),
        (sync(block("A", "0", "1", Rotate(Bone("back_1"), UP, 0.1))), True),
        (sync(block("A", "0", "1")), False),
        (block("A", "0", "1", turned(5)).score, False),
        (sync(block("A", "0", "1", turned(5), LEFT)), False),
        (sync(block("A", "0", "1", Rotate(Bone("palm", S), UP, 0.1))), False),
        (
            sync(
                block("A", "0", "1", turned(5)),
                Block("H", Interval(F(1), F(2)), Hold(F(1), block="A", channels=("head",))),
            ),
            False,
        ),
    ],
)  # fmt: skip
def test_accents_are_groups_of_turns_of_head_and_trunk_and_of_the_face(
    score: Score, *, expected: bool
) -> None:
    assert is_accent(score, evaluator(rig(), Side.RIGHT).binding) is expected


def test_tempo_scales_all_but_what_is_fixed() -> None:
    score = sync(block("A", "0", ".4", RIGHT), block("B", ".6", ".4", NEAR))
    assert played(score, "exact", 2.0).score.duration == F("1/2")
    fixed = Group(F(1), blocks=score.blocks, fixed=True)
    mixed = sync(inside("F", "0", fixed), block("C", "1.5", ".5", RIGHT))
    assert times(played(mixed, "exact", 0.5).score) == {
        "F/A": (0.0, 0.4), "F/B": (0.6, 1.0), "C": (2.0, 3.0),
    }  # fmt: skip
    assert played(score, "exact", 2.0).report.tempo == 2.0


def test_at_a_fast_tempo_ways_still_get_their_time() -> None:
    assert largest(played(FAR, None, 3.0))[0] < 2.1


@pytest.mark.parametrize("tempo", [0.0, -1.0, math.inf, math.nan])
def test_a_tempo_is_a_factor(tempo: float) -> None:
    with pytest.raises(ValueError, match="times as fast"):
        animate(FAR, rig(), tempo=tempo)


def test_an_unknown_timing_is_told() -> None:
    with pytest.raises(ValueError, match="there is no timing 'loose'; the timings are: performed"):
        animate(FAR, rig(), timing="loose")  # type: ignore[arg-type]


TEXT = (
    "sync\n    'A (key .4 (place @PA(s) point(.1, -.1, .28)))\n"
    "    'B (key .4 (place @PA(s) point(-.4, -.1, .28)))\n    'start 'A:end:.2\n"
)


def test_labels_report_and_elan_have_the_times_as_performed(tmp_path: Path) -> None:
    made = azee.compile(TEXT, life=False)
    (stretch,) = made.report.stretched
    start_s, lead_s = float(stretch.end_s), made.report.lead_s
    assert start_s > 0.8
    labels = {label.text: label.start_s - lead_s for label in made.clip.labels}
    assert labels["B"] == pytest.approx(start_s)
    assert {c.start_s for c in made.report.constraints} == {0.0, start_s}
    assert made.report.score_s == pytest.approx(start_s + 0.4)
    assert made.report_json()["stretched"] == [stretch.as_json()]
    made.save(tmp_path / "made.eaf")
    slots = {
        int(slot.attrib["TIME_VALUE"])
        for slot in ElementTree.parse(tmp_path / "made.eaf").iter("TIME_SLOT")
    }
    assert round((start_s + lead_s) * 1000) in slots


class Counting:
    """A solver that answers with the reference, and counts."""

    def __init__(self) -> None:
        self.asked = 0

    def __call__(
        self,
        ik_tasks: Sequence[Task],
        *,
        start: Array,
        reference: Array,
        search: Search = Search.GLOBAL,
        fixed: frozenset[int] = frozenset(),
    ) -> SolveReport:
        self.asked += 1
        answers = (ConstraintReport(t, 0.0, "m", 1.0, True, None) for t in ik_tasks)
        return SolveReport(
            np.array(reference), (), tuple(answers), (), self.asked, 0.0, frozenset()
        )


def test_postures_that_differ_only_in_where_they_stand_are_solved_once() -> None:
    counting, here, there = Counting(), np.zeros(3), np.ones(3)
    solver = RememberingSolver(counting)
    early = (Task(LEFT, ("A",), F(0), 0), Task(NEAR, ("B",), F(1), 1))
    late = (Task(LEFT, ("C",), F(2), 4), Task(NEAR, ("C", "D"), F(5), 7))
    first = solver(early, start=here, reference=here)
    again = solver(late, start=here, reference=here)
    assert counting.asked == 1
    assert again.evaluations == first.evaluations
    assert [c.task for c in again.constraints] == [*late]

    def asked_for(
        tasks: Sequence[Task],
        *,
        start: Array = here,
        reference: Array = here,
        search: Search = Search.GLOBAL,
        fixed: frozenset[int] = frozenset(),
    ) -> int:
        solver(tasks, start=start, reference=reference, search=search, fixed=fixed)
        return counting.asked

    assert asked_for((late[1], late[0])) == 2
    assert asked_for((late[0], replace(late[1], start_s=F(1)))) == 3
    assert asked_for((late[0], replace(late[1], rank=2))) == 4
    assert asked_for((late[0], replace(late[1], phase=0.5))) == 5
    assert asked_for(late, start=there) == 6
    assert asked_for(late, reference=there) == 7
    assert asked_for(late, fixed=frozenset((1,))) == 8
    assert asked_for(late, search=Search.LOCAL) == 9
    assert asked_for(late, search=Search.LOCAL) == 10
    assert asked_for(late) == 10
