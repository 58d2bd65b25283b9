"""The least time that a way takes, by how fast arms are."""

from __future__ import annotations

import math

import numpy as np
import pytest
from timed_scores import SCALE, rig

from azee.clip.spline import minimum_jerk
from azee.motion.curves.limb_curves import ONSET_SPREAD_S
from azee.motion.tasks.limbs import Limbs
from azee.motion.timing.pace import PEAK_ACCELERATION, PEAK_SPEED, Pace
from azee.motion.timing.ways import Ways
from azee.quality import signing_dynamics as recordings
from azee_rig.load import load_rig
from azee_solver.evaluate import evaluator
from azee_solver.geometry import Side


def test_a_body_of_another_size_takes_the_time_of_the_signer() -> None:
    child = load_rig("child")
    measure = Ways(evaluator(child, Side.RIGHT), Limbs.of(child.coordinates).members, Pace())
    assert measure.scale > 1.1 * SCALE
    arms = [child.bones[f"arm_{s}"].origin_node for s in "LR"]
    left, right = child.chain.frames(child.coordinates.idle).positions[arms]
    assert measure.scale * np.linalg.norm(left - right) == pytest.approx(recordings.SHOULDERS_M)


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
