"""Accents add up along the nesting, and nothing of what they ask for is lost."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.animation import Animation, animate
from azee.motion.overlay.accents import ATTACK_S, DECAY_S, layers
from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.schedule import TaskSchedule, bind
from azee.score.interval import Interval
from azee.score.score import Block, Group, Key, Score
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_solver.constraint import Constraint, LookAt, Rotate
from azee_solver.evaluate import Evaluator, evaluator
from azee_solver.geometry import Bone, FreePoint, Side, Vec

F = Fraction
RAISED = Rotate(Bone("head"), Vec(1, 0, 0), -0.1)
LEFT = Rotate(Bone("head"), Vec(0, 1, 0), 0.2)
RIGHT = Rotate(Bone("head"), Vec(0, 1, 0), -0.2)


@cache
def rig() -> Rig:
    return load_rig()


def of_body() -> Evaluator:
    return evaluator(rig(), Side.RIGHT)


def block(name: str, start: str, end: str, *constraints: Constraint) -> Block:
    span = Interval(F(start), F(end))
    return Block(name, span, Key(span.duration, constraints=constraints))


def sync(*blocks: Block) -> Group:
    return Group(max(b.interval_in_parent.end for b in blocks), blocks=blocks)


def inside(name: str, group: Group) -> Block:
    return Block(name, Interval(F(0), group.duration), group)


def schedule(score: Score) -> TaskSchedule:
    limbs = Limbs.of(rig().coordinates)
    return bind(flatten(score), rig(), of_body().binding, limbs)


def offsets(score: Score, times: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    found = layers(schedule(score).accents, times, of_body()).offsets
    return {name: found[:, i] for i, name in enumerate(rig().coordinates.names)}


def played(score: Score) -> Animation:
    return animate(score, rig(), life=False, fps=50)


TIMES = np.linspace(-1.0, 3.0, 401)


def at(values: NDArray[np.float64], time: float) -> float:
    return float(values[int(np.abs(TIMES - time).argmin())])


def test_an_accent_rises_before_its_block_holds_and_decays_after_it() -> None:
    raised = offsets(sync(block("A", "1", "1.5", RAISED)), TIMES)["head.flexion"]
    held = (TIMES >= 1.0) & (TIMES <= 1.5)
    assert raised[held] == pytest.approx(-0.1, abs=1e-6)
    assert at(raised, 1.0 - ATTACK_S / 2) == pytest.approx(-0.05, abs=8e-3)
    assert at(raised, 1.5 + DECAY_S / 2) == pytest.approx(-0.05, abs=8e-3)
    away = (TIMES < 1.0 - ATTACK_S - 0.01) | (TIMES > 1.5 + DECAY_S + 0.01)
    assert not raised[away].any()


def test_accents_of_nested_groups_add_up() -> None:
    shake = sync(block("L", "0", ".1", LEFT), block("R", ".25", ".35", RIGHT))
    both = offsets(sync(inside("SHAKE", shake), block("CHIN", "0", "1", RAISED)), TIMES)
    alone = offsets(sync(inside("SHAKE", shake)), TIMES)
    assert at(both["head.flexion"], 0.3) == pytest.approx(-0.1, abs=1e-6)
    assert both["head.axial"] == pytest.approx(alone["head.axial"])
    assert at(both["head.axial"], 0.05) == pytest.approx(0.2, abs=1e-6)
    assert at(both["head.axial"], 0.3) == pytest.approx(-0.2, abs=1e-6)


def test_equal_accents_of_two_blocks_at_once_add_up_too() -> None:
    twice = offsets(sync(block("A", "0", "1", RAISED), block("B", "0", "1", RAISED)), TIMES)
    assert at(twice["head.flexion"], 0.5) == pytest.approx(-0.2, abs=1e-6)


def test_far_rotations_of_one_group_come_back_between() -> None:
    apart = offsets(sync(block("A", "0", ".1", LEFT), block("B", "1", "1.1", LEFT)), TIMES)
    assert at(apart["head.axial"], 0.6) == pytest.approx(0.0, abs=1e-9)
    near = offsets(sync(block("A", "0", ".1", LEFT), block("B", ".3", ".4", LEFT)), TIMES)
    assert at(near["head.axial"], 0.2) == pytest.approx(0.2, abs=1e-6)


def test_rotations_that_follow_at_once_leave_time_for_the_step() -> None:
    turned = offsets(sync(block("A", "0", ".2", LEFT), block("B", ".2", ".4", RIGHT)), TIMES)
    speed = np.abs(np.diff(turned["head.axial"])) / 0.01
    assert speed.max() < 1.9 * 0.4 / 0.06


def test_a_trunk_that_carries_the_arms_takes_longer_from_one_rotation_to_the_next() -> None:
    """As in the rule in-context: 3° to the left, .06 s later 2° to the right."""
    left, right = (Rotate(Bone("back_1"), Vec(0, 1, 0), math.radians(a)) for a in (3, -2))
    turned = offsets(sync(block("A", "0", ".11", left), block("B", ".17", ".29", right)), TIMES)
    total = sum(values for name, values in turned.items() if name.endswith(".axial"))
    acceleration = np.abs(np.diff(total, 2)) / 0.01**2
    assert np.ptp(total) == pytest.approx(math.radians(5), rel=0.05)
    assert acceleration.max() < 25.0


def test_a_shake_under_a_gaze_and_a_raised_chin_keeps_its_amplitude() -> None:
    shake = sync(
        block("L1", "0", ".1", LEFT), block("R1", ".25", ".35", RIGHT),
        block("L2", ".5", ".6", LEFT), block("R2", ".75", ".85", RIGHT),
    )  # fmt: skip
    gaze = block("GAZE", "0", "1", LookAt(FreePoint(0.2, 0.2, 1.0)))
    animation = played(sync(inside("SHAKE", shake), block("CHIN", "0", "1", RAISED), gaze))
    axial = rig().coordinates.index["head.axial"]
    times = animation.clip.times - animation.lead_s
    turned = [
        float(animation.clip.coordinates[int(np.abs(times - t).argmin()), axial])
        for t in (0.05, 0.3, 0.55, 0.8)
    ]
    swings = np.diff(turned)
    assert np.all(np.sign(swings) == [-1, 1, -1])
    assert np.abs(swings).min() > 0.8 * 0.4
    assert [c for c in animation.report.constraints if not c.met] == []


def test_what_limits_cut_off_an_accent_is_missed() -> None:
    far = Rotate(Bone("head"), Vec(0, 1, 0), math.radians(80))
    (result,) = played(sync(block("A", "0", "1", far))).report.constraints
    assert not result.met
    limit = rig().coordinates.upper[rig().coordinates.index["head.axial"]]
    assert result.residual == pytest.approx(math.radians(80) - limit, abs=0.02)


def test_flat_has_no_accents() -> None:
    animation = animate(sync(block("A", "0", "1", RAISED)), rig(), mode="flat", life=False)
    assert animation.report.met
    (first, *_) = animation.report.postures
    assert first.timed_tasks
