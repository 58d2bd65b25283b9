"""The whole of motion on the body that ships, with scores built by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from played_scores import (
    PATH,
    SHAKE,
    TIP,
    TWO_KEYS,
    S,
    at,
    block,
    frame_at,
    played,
    results,
    rig,
    sync,
    tip_track,
)

from azee.animation import animate
from azee.score.score import Score
from azee_solver.constraint import (
    BoneAxis,
    Morph,
    Orient,
    Relation,
)
from azee_solver.geometry import (
    Bone,
    Side,
    Vec,
)


@pytest.mark.parametrize("score", [TWO_KEYS, PATH, SHAKE])
@pytest.mark.parametrize("fps", [30.0, 60.0])
def test_every_constraint_holds_in_every_frame_of_its_block(score: Score, fps: float) -> None:
    animation = played(score, fps=fps)
    assert [(c.path, c.reason) for c in animation.report.constraints if not c.met] == []
    assert animation.report.max_excess_rad == 0
    assert animation.report.met


def test_the_score_keeps_its_times() -> None:
    animation = played(TWO_KEYS)
    in_score = [round(t - animation.lead_s, 9) for t in animation.key_times]
    assert {0.0, 0.2, 0.6, 0.8} <= set(in_score)
    assert animation.lead_s * 30 == pytest.approx(round(animation.lead_s * 30))
    assert {(c.start_s, c.end_s) for c in animation.report.constraints} == {
        (0.0, 0.2),
        (0.6, 0.8),
        (0.0, 0.8),
    }
    assert [(label.text, round(label.start_s - animation.lead_s, 9), label.depth)
            for label in animation.clip.labels] == [
        ("START", 0.0, 0), ("PALM", 0.0, 0), ("END", 0.6, 0),
    ]  # fmt: skip


def test_nothing_jumps() -> None:
    clip = played(PATH, fps=60.0).clip
    step = np.abs(np.diff(clip.coordinates, axis=0)) * 60.0
    assert 2.5 < step.max() < 6.5
    jump = np.abs(np.diff(clip.coordinates, n=2, axis=0)) * 60.0**2
    assert 15.0 < jump.max() < 40.0


def test_a_static_block_is_solved_once() -> None:
    animation = played(sync(block("ONLY", "0", "2", at(TIP, 0, 0, 0))))
    assert [p.reused for p in animation.report.postures] == [False, True]
    first, second = (p.coordinates for p in animation.report.postures)
    assert np.array_equal(first, second)


def test_two_postures_that_share_an_instant_are_told_apart() -> None:
    score = sync(
        block("A", "0", ".6", at(TIP, 0, 0.1, 0)),
        block("B", ".6", ".6", at(TIP, -0.1, -0.05, 0)),
    )
    animation = played(score)
    found = results(animation)
    assert found["B place"].met
    assert not found["A place"].met
    assert str(found["A place"].reason).startswith("ends early, at 0.")
    assert ": B starts" in str(found["A place"].reason)
    step = np.abs(np.diff(animation.clip.coordinates, axis=0)).max() * 30
    assert step < math.radians(900)


def test_two_blocks_that_one_posture_serves_share_the_instant() -> None:
    palm = Orient(BoneAxis.NRM, Bone("palm", S), Relation.ALONG, Vec(0, -1, 0))
    animation = played(sync(block("A", "0", ".6", palm), block("B", ".6", ".6", at(TIP, 0, 0, 0))))
    assert animation.report.met, animation.report.constraints


def test_left_handers_sign_with_the_left() -> None:
    left = played(TWO_KEYS, dominant=Side.LEFT, precise=True)
    assert left.report.met
    assert np.ptp(tip_track(left, "I_TIP_L"), axis=0).max() > 0.1
    other = [i for i, n in enumerate(rig().coordinates.names) if n.startswith(("arm_R", "index_R"))]
    assert np.ptp(left.clip.coordinates[:, other], axis=0).max() < math.radians(5)


def test_the_same_score_gives_the_same_bytes() -> None:
    again = animate(PATH, rig(), life=False).clip
    assert again.coordinates.tobytes() == played(PATH).clip.coordinates.tobytes()


def test_life_is_seeded_never_still_and_keeps_what_the_score_asks() -> None:
    face = block("FACE", "0", "3", Morph("AU5", None, 0.7))
    score = sync(block("SIGN", "0", "3", at(TIP, 0, 0, 0)), face)
    lively = animate(score, rig(), seed=5)
    assert np.array_equal(lively.clip.coordinates, animate(score, rig(), seed=5).clip.coordinates)
    assert not np.array_equal(
        lively.clip.coordinates, animate(score, rig(), seed=6).clip.coordinates
    )
    assert lively.report.met
    still = played(score)
    apart = np.abs(lively.clip.coordinates - still.clip.coordinates)
    assert math.radians(0.5) < apart.max() < math.radians(8)
    moving = np.abs(np.diff(lively.clip.coordinates, axis=0)) * 30.0 > math.radians(0.2)
    names = rig().coordinates.names
    for limb in ("back", "head", "neck"):
        columns = [i for i, name in enumerate(names) if name.startswith(limb)]
        assert moving[:, columns].any(axis=1).all()
    inside = slice(frame_at(lively, 0.0), frame_at(lively, 3.0) + 1)
    shown = dict(zip(lively.clip.units, lively.clip.unit_weights[inside].T, strict=True))
    assert not any(np.any(shown.get(unit, 0.0)) for unit in rig().face_morphs["AU43"])
    stare = animate(sync(block("FACE", "0", "30", Morph("AU5", None, 0.7))), rig(), seed=5)
    during = stare.clip.unit_weights[frame_at(stare, 0.0) : frame_at(stare, 30.0) + 1]
    shown = dict(zip(stare.clip.units, during.T, strict=True))
    assert not any(np.any(shown.get(unit, 0.0)) for unit in rig().face_morphs["AU43"])
    quiet = animate(sync(block("PAUSE", "0", "20")), rig(), seed=5)
    assert quiet.clip.unit_weights.max() > 0.9


def test_an_empty_score_is_a_signer_at_rest() -> None:
    animation = played(sync(block("NOTHING", "0", "1")))
    assert animation.report.constraints == ()
    assert animation.key_times == ()
    assert animation.clip.times[-1] >= 1


def test_a_mode_that_is_none_is_an_error() -> None:
    with pytest.raises(ValueError, match="no mode"):
        animate(TWO_KEYS, rig(), mode="wild")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="frames per second"):
        animate(TWO_KEYS, rig(), fps=0)


def test_flat_has_one_track_with_all_keys() -> None:
    animation = animate(TWO_KEYS, rig(), mode="flat")
    (track,) = animation.tracks
    assert track.path == ()
    assert track.coordinates == tuple(rig().coordinates.names)
    assert track.keys_s == tuple(sorted({float(p.time) for p in animation.report.postures}))
    assert (track.start_s, track.end_s) == (0.0, 0.8)


def test_tracks_give_each_block_what_it_needs() -> None:
    tracks = {"/".join(t.path): t for t in played(SHAKE).tracks}
    assert {c.partition(".")[0] for c in tracks["R"].coordinates} <= {"neck", "head"}
    assert tracks["R"].keys_s == pytest.approx((0.3, 0.4))
    assert tracks["SIGN"].keys_s == pytest.approx((0.0, 1.2))
    assert {"arm_R.flexion", "f_arm_R.flexion"} <= set(tracks["SIGN"].coordinates)
