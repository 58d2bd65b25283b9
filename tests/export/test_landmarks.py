"""Landmarks are where joints and skin are, and pose-format takes them for a tracker's."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from moving import FPS, FRAMES, moving
from pose_format import Pose
from pose_format.utils.generic import (
    detect_known_pose_format,
    normalize_hands_3d,
    pose_normalization_info,
    reduce_holistic,
)

from azee.cli.main import run
from azee.clips import save_clip
from azee.export.landmarks.face import face_marks
from azee.export.landmarks.files import LANDMARK_WRITERS
from azee.export.landmarks.layout import BODY, COMPONENTS, COUNT, HAND
from azee.export.landmarks.view import Landmarks, View, landmarks
from azee.export.pictures.camera import projected
from azee.export.pictures.camerawork import cameras
from azee.formats import CLIP_WRITERS, LANDMARK_SUFFIXES
from azee_rig.load import load_rig
from azee_rig.rig import Rig

UPPER_LIP, LOWER_LIP, NOSE, CHIN = 13, 14, 1, 152
EYES = {"left": (386, 374), "right": (159, 145)}
"""Upper and lower lid of each eye."""


@pytest.fixture(scope="module")
def seen(signer: Rig) -> Landmarks:
    return landmarks(moving(signer), signer, View(fps=FPS))


@pytest.fixture(scope="module")
def file(seen: Landmarks, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("pose") / "moving.pose"
    LANDMARK_WRITERS[".pose"](seen, path)
    return path


def test_pose_format_reads_it_as_holistic_and_normalises_it(file: Path, seen: Landmarks) -> None:
    read = Pose.read(file.read_bytes())
    assert detect_known_pose_format(read) == "holistic"
    assert read.body.fps == FPS
    assert read.body.data.shape == (FRAMES, 1, COUNT, 3)
    assert np.array_equal(read.body.data.data[:, 0], seen.values.astype(np.float32))
    assert np.array_equal(read.body.confidence[:, 0], seen.confidence.astype(np.float32))
    read.normalize(pose_normalization_info(read.header))
    width = (
        read.body.data[:, 0, BODY.index("LEFT_SHOULDER")]
        - (read.body.data[:, 0, BODY.index("RIGHT_SHOULDER")])
    )
    assert np.linalg.norm(width, axis=1).mean() == pytest.approx(1.0, abs=1e-4)
    normalize_hands_3d(read)
    assert reduce_holistic(Pose.read(file.read_bytes())).body.data.shape[2] < COUNT


def test_hands_and_shoulders_are_pixels_of_the_joints(signer: Rig, seen: Landmarks) -> None:
    clip = moving(signer)
    at = signer.chain.frames(clip.coordinates)
    eye = cameras(clip, signer, "front", 1.0)[-1]
    for name, bone, component, names in (
        ("RIGHT_SHOULDER", "arm_R", "POSE_LANDMARKS", BODY),
        ("WRIST", "palm_R", "RIGHT_HAND_LANDMARKS", HAND),
        ("INDEX_FINGER_PIP", "index_L_2", "LEFT_HAND_LANDMARKS", HAND),
    ):
        place = at.positions[-1, [signer.bones[bone].origin_node]]
        pixel = projected(place, eye, 720, 720)[0][0, :2]
        values, confidence = seen.component(component)
        assert values[-1, names.index(name), :2] == pytest.approx(pixel, abs=0.01)
        assert confidence[-1, names.index(name)] == 1.0


def test_world_points_are_metres_from_the_hips_before_the_camera(signer: Rig) -> None:
    clip = moving(signer)
    at = signer.chain.frames(clip.coordinates[-1])
    wrists = [signer.bones[f"palm_{s}"].origin_node for s in "LR"]
    apart = at.positions[wrists[0]] - at.positions[wrists[1]]
    front, _ = landmarks(clip, signer, View(fps=FPS)).component("POSE_WORLD_LANDMARKS")
    side, _ = landmarks(clip, signer, View("side", fps=FPS)).component("POSE_WORLD_LANDMARKS")
    for world in (front, side):
        hips = world[-1, [BODY.index("LEFT_HIP"), BODY.index("RIGHT_HIP")]].mean(axis=0)
        assert hips == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
        found = world[-1, BODY.index("LEFT_WRIST")] - world[-1, BODY.index("RIGHT_WRIST")]
        assert np.linalg.norm(found) == pytest.approx(np.linalg.norm(apart), abs=1e-6)
    assert front[-1, BODY.index("NOSE"), 1] < -0.4  # y is down
    assert front[-1, BODY.index("LEFT_HIP"), 0] > 0.05 > front[-1, BODY.index("RIGHT_HIP"), 0]
    assert front[-1, BODY.index("NOSE"), 2] < side[-1, BODY.index("NOSE"), 2]


@pytest.mark.parametrize("name", ["signer", "child", "heavy", "game"])
def test_landmarks_of_the_face_are_on_the_skin_of_every_body(name: str) -> None:
    rig = load_rig(name)
    marks = face_marks(rig)
    assert marks.weights.sum(axis=1) == pytest.approx(np.ones(468))
    places = np.einsum("lk,lkc->lc", marks.weights, rig.mesh.vertices[marks.vertices])
    assert places[NOSE, 2] == pytest.approx(places[:, 2].max(), abs=0.002)
    assert places[CHIN, 1] == pytest.approx(places[:, 1].min(), abs=0.004)
    for upper, lower in (*EYES.values(), (UPPER_LIP, LOWER_LIP)):
        assert places[upper, 1] > places[lower, 1] - 1e-4
    assert places[EYES["left"][0], 0] > 0.02 > -0.02 > places[EYES["right"][0], 0]


def test_landmarks_follow_the_face(signer: Rig) -> None:
    clip = moving(signer)
    closed = replace(clip, units=(), unit_weights=np.zeros((FRAMES, 0)))
    gaps = []
    for shown in (closed, clip):
        values, _ = landmarks(shown, signer, View("face", fps=FPS)).component("FACE_LANDMARKS")
        gaps.append(np.linalg.norm(values[-1, UPPER_LIP] - values[-1, LOWER_LIP]))
    assert gaps[1] > gaps[0] + 20.0


def test_a_face_that_looks_away_and_a_hand_outside_are_not_found(signer: Rig) -> None:
    clip = moving(signer)
    _, behind = landmarks(clip, signer, View("back", fps=FPS)).component("FACE_LANDMARKS")
    assert not behind.any()
    near = landmarks(clip, signer, View("face", fps=FPS))
    values, confidence = near.component("LEFT_HAND_LANDMARKS")
    assert not confidence[0].any()
    assert not values[0].any()
    assert near.component("FACE_LANDMARKS")[1].all()


def test_tables_hold_the_same_numbers(seen: Landmarks, tmp_path: Path) -> None:
    for suffix in LANDMARK_SUFFIXES:
        LANDMARK_WRITERS[suffix](seen, tmp_path / f"marks{suffix}")
    with np.load(tmp_path / "marks.npz") as packed:
        found = np.concatenate([packed[c.name] for c in COMPONENTS], axis=1)
        assert packed["fps"] == FPS
        assert tuple(packed["POSE_LANDMARKS_names"]) == BODY
    assert np.array_equal(found[..., :3], seen.values.astype(np.float32))
    with (tmp_path / "marks.csv").open(encoding="utf-8", newline="") as table:
        rows = [*csv.DictReader(table)]
    numbers = [[np.float32(row[key]) for key in ("x", "y", "z", "confidence")] for row in rows]
    assert np.array_equal(np.array(numbers).reshape(found.shape), found)
    assert rows[COUNT]["time_s"] == "0.040000"


def test_noise_and_losses_are_as_large_as_asked_and_repeatable(signer: Rig) -> None:
    clip = moving(signer)
    exact = landmarks(clip, signer, View(fps=200.0))
    spoilt, again = (
        landmarks(clip, signer, View(fps=200.0, noise_px=2.0, dropout=0.2, seed=5)) for _ in "ab"
    )
    assert np.array_equal(spoilt.values, again.values)
    off = (spoilt.values - exact.values)[spoilt.confidence > 0.0][:, :2]
    body = (spoilt.values - exact.values)[:, : len(BODY), :2]
    assert body.std() == pytest.approx(2.0, rel=0.1)
    assert np.abs(off).max() < 15.0
    lost = 1.0 - spoilt.component("RIGHT_HAND_LANDMARKS")[1].mean()
    assert lost == pytest.approx(0.2, abs=0.1)


def test_the_command_writes_what_the_writers_do(
    signer: Rig, tmp_path: Path, file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    save_clip(moving(signer), signer, tmp_path / "clip.npz")
    out = tmp_path / "out.pose"
    assert run(["export", "landmarks", str(tmp_path / "clip.npz"), "-o", str(out)]) == 0
    assert out.read_bytes() == file.read_bytes()
    CLIP_WRITERS[".pose"](moving(signer), signer, tmp_path / "again.pose")
    assert (tmp_path / "again.pose").read_bytes() == file.read_bytes()
    capsys.readouterr()
    bad = ["export", "landmarks", str(tmp_path / "none.npz"), "-o", str(out)]
    assert run(bad) == 1
    assert "there is no file" in capsys.readouterr().err


@pytest.mark.parametrize(
    "wrong",
    [{"shot": "above"}, {"size": (1, 1)}, {"fps": 0.0}, {"noise_px": -1.0}, {"dropout": 2.0},
     {"seed": -1}],
)  # fmt: skip
def test_a_view_that_is_none_is_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ValueError):  # noqa: PT011 - each has its own words
        View(**wrong)  # type: ignore[arg-type]
