"""three-vrm plays our movements on our avatars and on one that is not ours, and sees the same."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from foreign_avatar import write_foreign_avatar
from moving import moving
from numpy.typing import NDArray
from programs import Node

from azee.cli.main import run
from azee.clip.clip import Clip
from azee.clips import save_clip
from azee.export.formats.smplx import HUMAN, JOINTS, write_smplx
from azee.export.formats.vrm.avatar import NoAvatarError, write_vrm
from azee.export.formats.vrm.humanoid import HUMAN_BONES, t_pose
from azee.export.formats.vrm.turns import human_motion
from azee.export.formats.vrm.vrma import write_vrma
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_rig.rotation import to_matrices

Floats = NDArray[np.float64]

WITHIN_M = 0.002
PARENTS = (
    -1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 15, 15, 15,
    20, 25, 26, 20, 28, 29, 20, 31, 32, 20, 34, 35, 20, 37, 38,
    21, 40, 41, 21, 43, 44, 21, 46, 47, 21, 49, 50, 21, 52, 53,
)  # fmt: skip
"""The tree of SMPL-X' joints, as its authors publish it."""


def _played(node: Node, avatar: Path, clip: Clip, rig: Rig, folder: Path) -> list[dict[str, Any]]:
    write_vrma(clip, rig, folder / "moving.vrma")
    times = ",".join(str(t - clip.times[0]) for t in clip.times[::4])
    said: dict[str, Any] = json.loads(node("vrm.mjs", avatar, folder / "moving.vrma", times))
    return list(said["frames"])


def _worst(frames: list[dict[str, Any]], clip: Clip, rig: Rig) -> float:
    at = rig.chain.frames(clip.coordinates[::4]).positions
    off = [
        np.linalg.norm(np.array(frame["bones"][name]) - at[n, rig.bones[bone.azee].origin_node])
        for n, frame in enumerate(frames)
        for name, bone in HUMAN_BONES.items()
        if bone.azee is not None
    ]
    return float(max(off))


@pytest.mark.parametrize("name", ["signer", "game"])
def test_our_avatar_moves_as_our_body(name: str, node: Node, tmp_path: Path) -> None:
    rig = load_rig(name)
    clip = moving(rig)
    write_vrm(rig, tmp_path / "body.vrm")
    frames = _played(node, tmp_path / "body.vrm", clip, rig, tmp_path)
    assert _worst(frames, clip, rig) < WITHIN_M
    for unit, weight in zip(clip.units, clip.unit_weights[-1], strict=True):
        assert frames[-1]["morphs"][unit] == pytest.approx(weight, abs=1e-4), unit
    eyes = clip.coordinates[-1, [rig.coordinates.index[f"eye_{s}.yaw"] for s in "LR"]]
    assert abs(frames[-1]["gaze"][0]) == pytest.approx(abs(np.degrees(eyes.mean())), abs=0.6)
    for file in ("body.vrm", "moving.vrma"):
        issues = json.loads(node("validate.mjs", tmp_path / file))["issues"]
        assert not any(issues[kind] for kind in ("numErrors", "numWarnings", "numHints"))


def test_an_avatar_that_is_not_ours_moves_as_our_body(
    node: Node, signer: Rig, tmp_path: Path
) -> None:
    clip = moving(signer)
    offsets = human_motion(clip, signer).offsets
    parents = {name: bone.parent for name, bone in HUMAN_BONES.items()}
    places: dict[str, Floats] = {}
    for name, parent in parents.items():
        places[name] = offsets[name] + (places[parent] if parent else 0.0)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        places[f"{side}Eye"] = places["head"] + (0.03 * sign, 0.05, 0.08)
        parents[f"{side}Eye"] = "head"
    avatar = write_foreign_avatar(places, parents, tmp_path / "foreign.vrm")
    frames = _played(node, avatar, clip, signer, tmp_path)
    assert _worst(frames, clip, signer) < WITHIN_M
    weights = dict(zip(clip.units, clip.unit_weights[-1], strict=True))
    shown = frames[-1]["expressions"]
    assert shown["aa"] == pytest.approx(weights["jawOpen"], abs=1e-4)
    assert shown["browInnerUp"] == pytest.approx(weights["browInnerUp"], abs=1e-4)


def test_arms_of_the_t_pose_are_straight_and_palms_down(signer: Rig) -> None:
    frames = t_pose(signer)
    for side, sign in (("L", 1.0), ("R", -1.0)):
        for bone in ("arm", "f_arm", "palm", "index_{}_2", "little_{}_3"):
            name = bone.format(side) if "{" in bone else f"{bone}_{side}"
            assert frames[signer.bones[name].node][:, 1] == pytest.approx([sign, 0.0, 0.0])
        assert frames[signer.bones[f"palm_{side}"].node][:, 2] == pytest.approx([0.0, -1.0, 0.0])
    assert np.linalg.det(frames) == pytest.approx(np.ones(len(frames)))


def test_only_bodies_that_ship_become_avatars(
    signer: Rig, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from dataclasses import replace

    with pytest.raises(NoAvatarError, match="does not ship"):
        write_vrm(replace(signer, folder=tmp_path), tmp_path / "x.vrm")
    assert run(["export", "avatar", "--rig", "child", "-o", str(tmp_path / "child.vrm")]) == 0
    assert run(["export", "avatar", "--rig", "nobody", "-o", str(tmp_path / "y.vrm")]) == 2
    assert "there is no rig `nobody`" in capsys.readouterr().err


def test_parameters_of_smplx_bring_joints_where_they_are(signer: Rig, tmp_path: Path) -> None:
    """Forward kinematics on the published tree, with the lengths of our body."""
    clip = moving(signer)
    save_clip(clip, signer, tmp_path / "clip.npz")
    out = tmp_path / "smplx.npz"
    assert run(["export", "smplx", str(tmp_path / "clip.npz"), "-o", str(out), "--quiet"]) == 0
    write_smplx(clip, signer, tmp_path / "again.npz")
    assert (tmp_path / "again.npz").read_bytes() == out.read_bytes()
    with np.load(out) as packed:
        poses = packed["poses"].reshape(len(clip.times), 55, 3)
        assert str(packed["surface_model_type"]) == "smplx"
        parts = ("root_orient", "pose_body", "pose_jaw", "pose_eye", "pose_hand")
        assert np.array_equal(np.hstack([packed[p] for p in parts]), packed["poses"])
    offsets = human_motion(clip, signer).offsets
    at = signer.chain.frames(clip.coordinates).positions
    assert len(PARENTS) == len(JOINTS) == 55
    world: list[Floats] = []
    place: list[Floats] = []
    for n, joint in enumerate(JOINTS):
        R = _turns(poses[:, n])
        bone = HUMAN.get(joint)
        if n == 0:
            world.append(R)
            place.append(np.tile(offsets["hips"], (len(R), 1)))
            continue
        above = PARENTS[n]
        offset = offsets[bone] if bone else np.zeros(3)
        place.append(place[above] + world[above] @ offset)
        world.append(world[above] @ R)
        if bone and (azee := HUMAN_BONES[bone].azee):
            off = np.linalg.norm(place[n] - at[:, signer.bones[azee].origin_node], axis=1)
            assert off.max() < WITHIN_M, joint


def _turns(vectors: Floats) -> Floats:
    """Rotation matrices of axis times angle."""
    angle = np.linalg.norm(vectors, axis=-1, keepdims=True)
    axis = vectors / np.maximum(angle, 1e-12)
    return to_matrices(np.concatenate([np.cos(angle / 2), axis * np.sin(angle / 2)], axis=-1))
