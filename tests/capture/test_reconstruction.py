"""Whole hands from few markers: how near they are, and what happens to bad markers."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path
from typing import Literal, TypeAlias

import numpy as np
import pytest
from recorded_hand import CHOSEN, away

from azee.capture.hand import TIP_SHARE
from azee.capture.hand_over import hand_clip, hand_over
from azee.capture.markers import Markers, MarkersError
from azee.capture.model import CaptureModel, read_model, write_model
from azee.capture.reconstruction import Reconstruction, reconstruct
from azee.capture.root_frame import into_root
from azee.clip.clip import Clip

JUMP_M, NOISY_JUMP_M = 0.005, 0.008
"""Noise is smoothed less at 20 frames a second than at the 100 of `benchmarks.capture`."""
Fault: TypeAlias = Literal["dropped", "two dropped", "root dropped", "swapped", "noisy"]


def truth_of(markers: Markers, model: CaptureModel) -> np.ndarray:
    return into_root(markers.only(model.names), model.root).positions


def unseen(made: Reconstruction, truth: np.ndarray, model: CaptureModel) -> float:
    """Mean error of markers that are neither chosen nor the root's, metres."""
    hidden = [m for m, name in enumerate(model.names) if name not in model.known]
    return float(np.nanmean(away(made.foretold, truth)[:, hidden]))


@pytest.fixture(scope="module")
def made(held_out: Markers, model: CaptureModel) -> Reconstruction:
    return reconstruct(held_out, model)


@pytest.mark.slow
def test_markers_that_are_not_recorded_are_foretold_within_1_3_mm(
    made: Reconstruction, held_out: Markers, model: CaptureModel
) -> None:
    truth = truth_of(held_out, model)
    assert unseen(made, truth, model) < 0.0013
    still = np.broadcast_to(model.poses.mean(axis=0), truth.shape)
    assert np.nanmean(away(made.foretold, truth)) < 0.15 * np.nanmean(away(still, truth))


@pytest.mark.slow
def test_the_fitted_hand_is_inside_its_limits_and_near_the_markers(
    made: Reconstruction, held_out: Markers, model: CaptureModel
) -> None:
    c = model.rig.coordinates
    assert ((made.postures >= c.lower) & (made.postures <= c.upper)).all()
    truth = truth_of(held_out, model)[:, model.columns(model.digits)]
    assert np.nanmean(away(made.fitted, truth)) < 0.003
    told = made.report()
    assert set(told["markers"]) == set(CHOSEN)
    for marker in told["markers"].values():
        assert 0.0 < marker["mean_off_m"] < 0.003


@pytest.mark.slow
def test_a_nearest_pose_is_worse_than_regression(
    made: Reconstruction, held_out: Markers, model: CaptureModel
) -> None:
    nearest = reconstruct(held_out, model, method="nearest")
    truth = truth_of(held_out, model)
    assert unseen(made, truth, model) < unseen(nearest, truth, model) < 0.006


@pytest.mark.long
def test_last_joints_may_follow_those_before(held_out: Markers, model: CaptureModel) -> None:
    coupled = reconstruct(held_out.frames(slice(0, 40)), model, coupled=True).postures
    last, before = model.hand().followers
    np.testing.assert_allclose(coupled[:, last], TIP_SHARE * coupled[:, before], atol=1e-15)


def spoilt(markers: Markers, how: Fault) -> Markers:
    """A recording with a fault in the middle, a fifth of a second before frame 150."""
    at = np.array(markers.positions)
    a, b = (markers.names.index(name) for name in ("index_tip", "middle_tip"))
    match how:
        case "dropped":
            at[150:160, a] = np.nan
        case "two dropped":
            at[150:160, [a, b]] = np.nan
        case "root dropped":
            at[150:160, markers.names.index("hand_left")] = np.nan
        case "swapped":
            at[150:153, [a, b]] = at[150:153, [b, a]]
        case "noisy":
            at += np.random.default_rng(5).normal(scale=0.001 / np.sqrt(3.0), size=at.shape)
    return replace(markers, positions=at)


SPOILT_M: dict[Fault, float] = {
    "dropped": 0.001, "two dropped": 0.002, "root dropped": 0.003, "swapped": 1e-6, "noisy": 0.0015,
}  # fmt: skip
"""Mean change of all markers in the frames concerned, at most."""


@pytest.mark.slow
@pytest.mark.parametrize("how", SPOILT_M)
def test_bad_markers_change_little_and_make_no_jump(
    how: Fault, made: Reconstruction, held_out: Markers, model: CaptureModel
) -> None:
    found = reconstruct(spoilt(held_out, how), model)
    change = found.foretold - made.foretold
    rows = slice(None) if how == "noisy" else slice(150, 160)
    assert np.linalg.norm(change[rows], axis=-1).mean() < SPOILT_M[how]
    most = NOISY_JUMP_M if how == "noisy" else JUMP_M
    assert np.linalg.norm(np.diff(change, axis=0), axis=-1).max() < most
    fitted = np.diff(found.fitted - made.fitted, axis=0)
    assert np.linalg.norm(fitted, axis=-1).max() < most


@pytest.mark.long
def test_no_marker_at_all_for_a_while_is_no_crash(held_out: Markers, model: CaptureModel) -> None:
    at = np.array(held_out.positions)
    at[100:120] = np.nan
    found = reconstruct(replace(held_out, positions=at), model)
    assert np.isfinite(found.postures).all()
    assert any("not seen whole in 20 frames" in note for note in found.notes)


def test_fewer_markers_than_chosen_are_told(held_out: Markers, model: CaptureModel) -> None:
    names = [name for name in held_out.names if name != "ring_middle"]
    found = reconstruct(held_out.only(names), model)
    assert found.notes == ("without ring_middle, which is not recorded",)
    assert "ring_middle" not in found.known


def test_other_units_hands_and_rates_are_refused(held_out: Markers, model: CaptureModel) -> None:
    tenfold = replace(held_out, positions=10.0 * held_out.positions)
    with pytest.raises(MarkersError, match="times as far apart as the model's") as raised:
        reconstruct(tenfold, model)
    assert "--unit" in str(raised.value.remedy)
    with pytest.raises(MarkersError, match="times as fast as in the recordings") as raised:
        reconstruct(replace(held_out, rate_hz=400.0), model)
    assert "--rate" in str(raised.value.remedy)
    with pytest.raises(MarkersError, match="there is no marker `hand_top`"):
        reconstruct(held_out.only(["index_tip"]), model)
    with pytest.raises(MarkersError, match="none of the markers"):
        reconstruct(held_out.only(["hand_top", "hand_left", "hand_right"]), model)


def test_a_model_is_the_same_bytes_and_reads_back(model: CaptureModel, tmp_path: Path) -> None:
    first, second = io.BytesIO(), io.BytesIO()
    write_model(model, first)
    path = tmp_path / "m.npz"
    path.write_bytes(first.getvalue())
    again = read_model(path)
    write_model(again, second)
    assert first.getvalue() == second.getvalue()
    assert again.provenance["sources"] == model.provenance["sources"]
    path.write_bytes(first.getvalue()[:2000])
    with pytest.raises(MarkersError, match="is no model that azee wrote, or is damaged"):
        read_model(path)
    np.savez(path, markers=np.zeros(3))
    with pytest.raises(MarkersError, match="is no model that azee wrote"):
        read_model(path)


@pytest.mark.slow
def test_a_hand_is_shown_alone_or_over_a_movement(
    made: Reconstruction, model: CaptureModel
) -> None:
    hand, body = model.hand(), model.rig
    alone = hand_clip(made, hand, body)
    np.testing.assert_array_equal(
        alone.coordinates[:, hand.columns], made.postures[:, hand.columns]
    )
    palm = body.chain.frames(alone.coordinates[0]).rotations[hand.palm]
    assert palm[1, 1] > 0.99  # fingers up
    still = np.tile(body.coordinates.idle, (61, 1))
    under = Clip(np.arange(61) / 30.0, still, (), np.zeros((61, 0)))
    over = hand_over(made, hand, body, under, start_s=0.5)
    others = np.setdiff1d(np.arange(len(body.coordinates)), hand.columns)
    np.testing.assert_allclose(over.coordinates[:, others], still[: len(over.times), others])
    np.testing.assert_array_equal(over.coordinates[0], still[0])
    np.testing.assert_allclose(over.coordinates[20, hand.columns], made.postures[10, hand.columns])
    with pytest.raises(MarkersError, match="the movement lasts from 0 s to 2 s"):
        hand_over(made, hand, body, under, start_s=5.0)
