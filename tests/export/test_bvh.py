"""BVH files follow the published conventions, and readers that are not ours get our joints."""

from __future__ import annotations

import json
import re
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from plain_bvh import PlainBvh
from programs import Node
from small_rig import SMALL, tumbling

from azee.clip.clip import Clip
from azee.export.formats import moving_body
from azee.export.formats.bvh import write_bvh
from azee.export.formats.moving_body import MovingBody

MILLIMETRE = 1e-3
CENTIMETRE = 1e-2


@pytest.fixture
def clip() -> Clip:
    return tumbling()


@pytest.fixture
def file(clip: Clip, tmp_path: Path) -> Path:
    path = tmp_path / "clip.bvh"
    write_bvh(clip, SMALL, path)
    return path


def _ours(clip: Clip, rig: MovingBody = SMALL) -> NDArray[np.float64]:
    return rig.joint_positions(rig.pose(clip.coordinates))


def test_the_file_reads_as_the_conventions_want(file: Path) -> None:
    text = file.read_text(encoding="ascii")
    lines = text.splitlines()
    assert lines[:5] == [
        "HIERARCHY",
        "ROOT root",
        "{",
        "\tOFFSET 0.000000 0.000000 0.000000",
        "\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation",
    ]
    joints = [line for line in lines if line.lstrip().startswith("CHANNELS")][1:]
    assert {line.strip() for line in joints} == {"CHANNELS 3 Zrotation Xrotation Yrotation"}
    assert lines[lines.index("MOTION") + 1 :][:2] == ["Frames: 20", "Frame Time: 0.04"]
    depth = 0
    for line in lines[: lines.index("MOTION")]:
        depth -= line.strip() == "}"
        assert re.fullmatch(r"\t*", line[: len(line) - len(line.lstrip())])
        assert len(line) - len(line.lstrip()) == depth
        depth += line.strip() == "{"
    assert "-0.000000" not in text


def test_every_last_joint_has_an_end_site_of_some_length(file: Path) -> None:
    sites = PlainBvh(file.read_text()).end_sites
    assert len(sites) == 3
    assert all(np.linalg.norm(site) > 1 for site in sites)


def test_names_are_plain_and_told_apart(file: Path) -> None:
    names = PlainBvh(file.read_text()).names
    assert names == ["root", "spine_01", "arm_L", "hand_1_L", "hand_1_L_2", "head"]


def test_a_plain_reader_gets_our_joints(file: Path, clip: Clip) -> None:
    read = PlainBvh(file.read_text())
    error = np.abs(read.positions() * CENTIMETRE - _ours(clip)).max()
    assert error < 1e-6


@pytest.mark.filterwarnings("ignore:Importing PyGLM:PendingDeprecationWarning")
def test_bvhio_gets_our_joints(file: Path, clip: Clip) -> None:
    error = np.abs(_read_with_bvhio(file) - _ours(clip)).max()
    assert error < MILLIMETRE / 10


def test_three_js_gets_our_joints(node: Node, file: Path, clip: Clip) -> None:
    read = json.loads(node("bvh.mjs", file))
    assert read["names"] == PlainBvh(file.read_text()).names
    np.testing.assert_allclose(read["times"], clip.times, atol=1e-6)
    error = np.abs(np.array(read["frames"]) * CENTIMETRE - _ours(clip)).max()
    assert error < MILLIMETRE / 10


def _read_with_bvhio(path: Path) -> NDArray[np.float64]:
    """World positions (frames, joints, 3) in metres, in the order of the file."""
    import bvhio

    root = bvhio.readAsHierarchy(str(path))
    count = len(PlainBvh(path.read_text()).rows)
    frames = []
    for frame in range(count):
        root.loadPose(frame)
        frames.append([list(joint.PositionWorld) for joint, _, _ in root.layout()])
    return np.array(frames) * CENTIMETRE


def test_angles_do_not_jump_between_frames(file: Path, clip: Clip) -> None:
    rows = PlainBvh(file.read_text()).rows
    q = SMALL.pose(clip.coordinates).rotations
    turned = 2 * np.degrees(np.arccos(np.clip(np.abs((q[1:] * q[:-1]).sum(-1)), 0, 1)))
    assert turned.max() < 40
    assert np.abs(np.diff(rows[:, 3:], axis=0)).max() < 180


def test_a_still_has_one_frame(clip: Clip, tmp_path: Path) -> None:
    still = Clip(clip.times[:1], clip.coordinates[:1], clip.units, clip.unit_weights[:1])
    write_bvh(still, SMALL, tmp_path / "still.bvh")
    read = PlainBvh((tmp_path / "still.bvh").read_text())
    assert len(read.rows) == 1
    assert read.frame_time > 0
    assert np.abs(read.positions() * CENTIMETRE - _ours(still)).max() < 1e-6


def test_uneven_times_are_refused_and_leave_no_file(clip: Clip, tmp_path: Path) -> None:
    times = np.array(clip.times)
    times[-1] += 0.01
    uneven = Clip(times, clip.coordinates, clip.units, clip.unit_weights)
    with pytest.raises(ValueError, match="frame time"):
        write_bvh(uneven, SMALL, tmp_path / "uneven.bvh")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.long
def test_a_long_clip_needs_no_more_room_to_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(moving_body, "CHUNK", 100)
    peaks = []
    for frames in (200, 1600):
        q = np.resize(tumbling().coordinates, (frames, tumbling().coordinates.shape[1]))
        long = Clip(np.arange(frames) / 30, q, (), np.zeros((frames, 0)))
        tracemalloc.start()
        write_bvh(long, SMALL, tmp_path / "long.bvh")
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[1] < 1.2 * peaks[0]
