"""Peaks of joints and times of blocks, on made-up movements."""

from __future__ import annotations

import math
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from azee.motion.tasks.flatten import flatten
from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.schedule import bind
from azee.motion.tasks.timed_task import EarlyEnd
from azee.quality.constraint_results import constraint_results
from azee.quality.measures import block_times, peaks
from azee.score.interval import Interval
from azee.score.score import Block, Group, Key
from azee_rig.load import load_rig
from azee_solver.constraint import Rotate
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Bone, Side, Vec

F, S = Fraction, Side.STRONG


def test_peaks_of_a_swing_are_those_of_its_derivatives() -> None:
    fps, omega = 500.0, 2.0 * math.pi
    times = np.arange(int(2 * fps)) / fps
    still = np.zeros_like(times)
    found = peaks(np.stack([still, np.sin(omega * times)], axis=1), fps, ("a", "b"), lead_s=0.5)
    (peak,) = found
    assert peak.coordinate == "b"
    assert peak.speed == pytest.approx(omega, rel=1e-3)
    assert peak.acceleration == pytest.approx(omega**2, rel=1e-3)
    assert peak.jerk == pytest.approx(omega**3, rel=1e-3)
    assert (peak.fastest_s + 0.5) % 0.5 == pytest.approx(0.0, abs=0.01) or (
        peak.fastest_s + 0.5
    ) % 0.5 == pytest.approx(0.5, abs=0.01)


def test_a_clip_of_one_frame_has_no_peaks() -> None:
    assert peaks(np.zeros((1, 2)), 30.0, ("a", "b"), lead_s=0.0) == ()


@pytest.mark.parametrize("lead", [0.0, 0.37, 1.1])
def test_the_fastest_moment_counts_from_the_start_of_the_score(lead: float) -> None:
    """Between frames 12 and 13 of 25 a second is the only step."""
    q = np.where(np.arange(40) > 12, 1.0, 0.0)[:, None]
    (peak,) = peaks(q, 25.0, ("a",), lead_s=lead)
    assert peak.fastest_s == pytest.approx(0.5 - lead)
    assert peak.speed == pytest.approx(25.0)


def test_a_block_is_held_until_the_first_of_its_constraints_ends() -> None:
    nod, turn = Rotate(Bone("head"), Vec(0, 1, 0), 0.1), Rotate(Bone("palm", S), Vec(0, 1, 0), 0.1)
    both = Block("A", Interval(F(1), F(3)), Key(F(2), constraints=(nod, turn)))
    alone = Block("B", Interval(F(2), F(4)), Key(F(2), constraints=(nod,)))
    rig, score = load_rig(), flatten(Group(F(4), blocks=(both, alone)))
    binding = evaluator(rig, Side.RIGHT).binding
    tasks = bind(score, rig, binding, Limbs.of(rig.coordinates)).all
    a = [task for task in tasks if task.path == ("A",)]
    early = {a[0].rank: EarlyEnd(F(5, 2), ("B",))}
    rows = {"A": (1.0, 3.0, 2.5), "B": (2.0, 4.0, 4.0)}
    for order in (tasks, tasks[::-1]):
        found = block_times(order, early)
        assert len(found) == len(rows)
        for row in found:
            times = row["start_s"], row["end_s"], row["held_until_s"]
            assert row["path"] in (["A"], ["B"])
            assert times == rows["A" if row["path"] == ["A"] else "B"]


@pytest.mark.parametrize(
    ("residual", "reason"),
    [
        (0.0, None),
        (0.5, "met at the keys but not at every frame between them"),
        (math.inf, "the geometry it names is degenerate"),
    ],
)
def test_what_is_missed_between_keys_has_a_reason(residual: float, reason: str | None) -> None:
    """A plan whose keys all meet the task, and frames where it is off by so much."""
    nod = Rotate(Bone("head"), Vec(0, 1, 0), 0.1)
    rig, score = load_rig(), flatten(Key(F(2), constraints=(nod,)))
    binding = evaluator(rig, Side.RIGHT).binding
    schedule = bind(score, rig, binding, Limbs.of(rig.coordinates))
    monitor = SimpleNamespace(
        early_ends={},
        measured_tasks=schedule.all,
        rows_inside=lambda task, seconds: np.arange(len(seconds)),
        residual=lambda task, samples: np.array([0.0, residual, 0.0]),
        unit=lambda task: "rad",
        tolerance=lambda task: 0.01,
    )
    samples: Any = SimpleNamespace(seconds=np.arange(3.0), only=lambda rows: rows)
    plan: Any = SimpleNamespace(monitor=monitor, postures=())
    (found,) = constraint_results(schedule, plan, samples, {}, 30.0)
    assert found.met == (reason is None)
    assert found.reason == reason
