"""Web clips keep what a page needs, within what nobody sees."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from small_rig import SMALL, tumbling

from azee.clip.clip import Clip, Label
from azee.export.formats.glb import write_body
from azee.export.formats.web_clip import web_clip, write_web_clip
from azee_rig.rig import Rig
from azee_rig.skeleton import Pose


@dataclass(frozen=True)
class Read:
    """A web clip as a page reads it, from docs/studio-protocol.md alone."""

    header: dict[str, Any]
    times: NDArray[Any]
    roots: NDArray[Any]
    rotations: dict[str, NDArray[Any]]
    weights: dict[str, NDArray[Any]]


def read(data: bytes) -> Read:
    assert data[:4] == b"AZWC"
    (length,) = struct.unpack_from("<I", data, 4)
    assert length % 4 == 0
    header = json.loads(data[8 : 8 + length])
    frames, joints, units = header["frames"], header["joints"], header["units"]
    at = 8 + length

    def take(kind: str, *shape: int) -> NDArray[Any]:
        nonlocal at
        taken = np.frombuffer(data, kind, int(np.prod(shape)), at).reshape(shape)
        at += taken.nbytes
        return taken

    times, roots = take("<f4", frames), take("<f4", frames, 3)
    rotations = take("<i2", len(joints), frames, 4) / 32767
    weights = take("<i2", len(units), frames) / 16384
    assert at == len(data)
    return Read(
        header,
        times,
        roots,
        dict(zip(joints, rotations, strict=True)),
        dict(zip(units, weights, strict=True)),
    )


def posed(found: Read, names: tuple[str, ...], offset: NDArray[np.float64]) -> Pose:
    frames = found.header["frames"]
    turns = np.tile([0.0, 0.0, 0.0, 1.0], (frames, len(names), 1))
    for joint, name in enumerate(names):
        turns[:, joint] = found.header["still"].get(name, turns[:, joint])
        turns[:, joint] = found.rotations.get(name, turns[:, joint])
    turns /= np.linalg.norm(turns, axis=-1, keepdims=True)
    return Pose(found.roots - offset, np.roll(turns, 1, axis=-1))


def wave(rig: Rig, frames: int = 20) -> Clip:
    """All joints go from one limit to the other and back."""
    times = np.arange(frames) / 30 + 1
    swing = (1 - np.cos(2 * np.pi * np.arange(frames) / frames)) / 2
    lower, upper = rig.coordinates.lower, rig.coordinates.upper
    q = lower + swing[:, None] * (upper - lower)
    weights = np.outer(swing, [1.0, -0.5])
    units = tuple(rig.units)[:2]
    return Clip(times, q, units, weights, (Label(("a",), 1.1, 1.2), Label(("a", "b"), 1.1, 1.15)))


def test_joints_are_where_the_clip_has_them_within_half_a_millimetre(signer: Rig) -> None:
    clip = wave(signer)
    found = read(web_clip(clip, signer))
    skeleton = signer.skeleton
    shown = signer.joint_positions(posed(found, skeleton.names, skeleton.offsets[0]))
    exact = signer.joint_positions(signer.pose(clip.coordinates))
    assert len(found.rotations) > 50
    assert np.abs(shown - exact).max() < 0.5e-3


def test_times_weights_and_labels_start_with_the_first_frame(signer: Rig) -> None:
    clip = wave(signer)
    found = read(web_clip(clip, signer, {"number": 7}))
    np.testing.assert_allclose(found.times, clip.times - 1, atol=1e-6)
    for column, unit in enumerate(clip.units):
        np.testing.assert_allclose(found.weights[unit], clip.unit_weights[:, column], atol=4e-5)
    assert [label["text"] for label in found.header["labels"]] == ["a", "b"]
    assert found.header["labels"][1]["path"] == ["a", "b"]
    assert found.header["labels"][1]["start_s"] == 0.1
    assert found.header["extras"] == {"number": 7}


def test_what_is_turned_and_never_moves_takes_no_room_a_frame() -> None:
    clip = tumbling()
    still = Clip(
        clip.times, np.tile(clip.coordinates[3], (len(clip.times), 1)), clip.units,
        clip.unit_weights,
    )  # fmt: skip
    found = read(web_clip(still, SMALL))
    assert found.rotations == {}
    assert found.header["still"]
    skeleton = SMALL.skeleton
    shown = SMALL.joint_positions(posed(found, skeleton.names, skeleton.offsets[0]))
    exact = SMALL.joint_positions(SMALL.pose(still.coordinates))
    np.testing.assert_allclose(shown, exact, atol=1e-5)


def test_the_file_has_the_same_bytes(tmp_path: Path) -> None:
    write_web_clip(tumbling(), SMALL, tmp_path / "a.azwc")
    assert (tmp_path / "a.azwc").read_bytes() == web_clip(tumbling(), SMALL)


def test_a_body_alone_has_the_skeleton_and_the_mesh_and_no_animation(tmp_path: Path) -> None:
    write_body(SMALL, tmp_path / "body.glb")
    data = (tmp_path / "body.glb").read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    gltf = json.loads(data[20 : 20 + length])
    assert "animations" not in gltf
    assert {n["name"] for n in gltf["nodes"]} >= set(SMALL.skeleton.names)
