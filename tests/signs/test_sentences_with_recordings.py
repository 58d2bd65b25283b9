"""Sentences of AZee and recordings: no fall to idle, exact contacts, the recording as it was."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from any_recordings import AnyRecordings, RaisedArm
from numpy.typing import NDArray

import azee
from azee.compilation import Compilation
from azee.quality.constraint_results import ConstraintResult
from azee.score.score import Group
from azee_rig.rig import Rig
from azee_solver import kinematics

Floats = NDArray[np.float64]

BETWEEN = "seq(list(:bien, recorded 'BONJOUR, :bien))"
TOUCHED = (
    "sync 'SIG (recorded 'BONJOUR) "
    "'TIP (key 1 (place @I_TIP(w) @F_ARM(s))) 'start/end 'SIG:start:+1.2 'SIG:end:-.7"
)
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def between(signer: Rig) -> Compilation:
    return azee.compile(expression=BETWEEN, rig=signer, recordings=AnyRecordings())


@pytest.fixture(scope="module")
def touched(signer: Rig) -> Compilation:
    return azee.compile(expression=TOUCHED, rig=signer, recordings=AnyRecordings())


def palm_heights(made: Compilation, side: str) -> Floats:
    frames = kinematics.frames(made.rig.chain, made.clip.coordinates)
    heights: Floats = frames.positions[:, made.rig.bones[f"palm_{side}"].node, 1]
    return heights


def rows(made: Compilation, start_s: float, end_s: float) -> NDArray[np.bool_]:
    times = made.clip.times - made.report.lead_s
    return np.asarray((times >= start_s - 1e-9) & (times <= end_s + 1e-9))


def off_the_recording_rad(made: Compilation) -> float:
    """Largest difference of what the recording moves from the recording, while it plays."""
    played = made.report.recordings[0]
    inside = rows(made, *played.body_s)
    source = RaisedArm("BONJOUR").clip(made.rig)
    since = made.clip.times[inside] - made.report.lead_s - played.body_s[0]
    own = [v for v, name in enumerate(made.rig.coordinates.names) if name.startswith("arm_R")]
    first = 1.0 + since * played.speed
    wanted = np.stack([np.interp(first, source.times, source.coordinates[:, v]) for v in own])
    return float(np.abs(made.clip.coordinates[inside][:, own] - wanted.T).max())


def test_the_recording_is_played_as_it_was(between: Compilation, touched: Compilation) -> None:
    assert np.degrees(off_the_recording_rad(between)) < 0.1
    assert np.degrees(off_the_recording_rad(touched)) < 0.1
    assert "arm_R" in between.report.recordings[0].limbs
    assert between.report_json()["recordings"][0]["name"] == "BONJOUR"  # type: ignore[index]


def test_hands_do_not_fall_to_idle_between(between: Compilation) -> None:
    """The palm is never lower than the lowest of its two neighbours, but for 5 cm."""
    height = palm_heights(between, "R")
    assert isinstance(between.score, Group)
    first, _, last = (block.interval_in_parent for block in between.score.blocks)
    spans = [
        (float(first.start), float(first.end)),
        between.report.recordings[0].body_s,
        (float(last.start), float(last.end)),
    ]
    for one, other in pairwise(spans):
        lowest = min(height[rows(between, *span)].min() for span in (one, other))
        way = height[rows(between, one[1], other[0])]
        assert way.min() > lowest - 0.05


def test_speeds_do_not_jump_where_a_recording_begins_and_ends(between: Compilation) -> None:
    """The change of velocity from frame to frame is no larger there than elsewhere in the clip."""
    q = between.clip.coordinates
    own = [v for v, name in enumerate(between.rig.coordinates.names) if "arm_R" in name]
    change = np.abs(np.diff(q[:, own], 2, axis=0)).max(axis=1) * between.report.fps**2
    times = between.clip.times[1:-1] - between.report.lead_s
    for at in between.report.recordings[0].body_s:
        assert change[np.abs(times - at) < 0.05].max() < 0.7 * change.max()


def test_a_contact_of_azee_is_exact_while_a_recording_plays(touched: Compilation) -> None:
    found: ConstraintResult = next(c for c in touched.report.constraints if c.kind == "place")
    assert found.met
    assert found.residual is not None
    assert found.residual <= found.tolerance
    assert {"arm_R"} <= {*touched.report.recordings[0].limbs}


def test_the_figures_of_likeness_are_those_of_people(between: Compilation) -> None:
    """docs/likeness.md: wrists on their way, arms, signs a second."""
    found = between.report.likeness
    assert found.transitional_wrist_speed_m_s is not None
    assert found.transitional_wrist_speed_m_s.value < 2.0
    assert found.arm_speed_deg_s is not None
    assert found.arm_speed_deg_s.value < 600.0
    assert [s.rule for s in found.signs] == ["bien", "BONJOUR", "bien"]


def test_a_recording_is_played_in_flat_mode_too(signer: Rig) -> None:
    made = azee.compile(
        expression=BETWEEN, rig=signer, recordings=AnyRecordings(), mode="flat", life=False
    )
    assert np.degrees(off_the_recording_rad(made)) < 0.1
