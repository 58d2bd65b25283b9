"""BVH of the rig's own skeleton comes back as it was, whatever program turned and scaled it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from azee.cli.main import run
from azee.clip.bvh import parse_bvh, read_bvh
from azee.clip.clip import Clip
from azee.clip.own_bvh import is_own, own_clip
from azee.clip.recording import Recording
from azee.clips import open_clip
from azee.export.formats.bvh import write_bvh
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from azee_rig.rotation import about_axis, to_matrices

Floats = NDArray[np.float64]

Z_UP = about_axis(0, np.pi / 2)
SKEW = about_axis(1, 0.7) @ about_axis(2, -2.0)


@pytest.fixture(scope="module")
def clip(signer: Rig) -> Clip:
    """Some postures anywhere inside the limits."""
    c = signer.coordinates
    random = np.random.default_rng(8)
    q = c.idle + 0.8 * random.uniform(0, 1, (6, 1)) * (
        random.uniform(c.lower, c.upper, (6, len(c))) - c.idle
    )
    return Clip(np.arange(6) / 25, q, (), np.zeros((6, 0)))


@pytest.fixture(scope="module")
def recording(signer: Rig, clip: Clip, tmp_path_factory: pytest.TempPathFactory) -> Recording:
    path = tmp_path_factory.mktemp("own") / "clip.bvh"
    write_bvh(clip, signer, path)
    return read_bvh(path)


def written_anew(recording: Recording, turn: Floats, scale: float) -> str:
    """BVH of a recording as another program writes it: other axes, unit, order of angles."""
    names, parents = recording.skeleton.names, recording.skeleton.parents
    offsets = scale * recording.skeleton.offsets @ turn.T
    order: list[int] = []

    def numbers(values: Floats) -> str:
        return " ".join(f"{x:.6f}" for x in values)

    def joint(j: int) -> str:
        order.append(j)
        kind, six = (
            ("JOINT", "3") if parents[j] >= 0 else ("ROOT", "6 Xposition Yposition Zposition")
        )
        below = [k for k, p in enumerate(parents) if p == j]
        inside = "".join(map(joint, below)) or "End Site { OFFSET 0 1 0 } "
        return (
            f"{kind} {names[j]} {{ OFFSET {numbers(offsets[j])} "
            f"CHANNELS {six} Xrotation Yrotation Zrotation {inside}}} "
        )

    head = joint(0)
    R = turn @ to_matrices(recording.rotations[:, order]) @ turn.T
    angles = np.degrees(
        np.stack(
            [
                np.arctan2(-R[..., 1, 2], R[..., 2, 2]),
                np.arcsin(np.clip(R[..., 0, 2], -1, 1)),
                np.arctan2(-R[..., 0, 1], R[..., 0, 0]),
            ],
            axis=-1,
        )
    )
    rows = [numbers(np.r_[offsets[0], frame.ravel()]) for frame in angles]
    return "\n".join(
        ["HIERARCHY", head, "MOTION", f"Frames: {len(rows)}", "Frame Time: 0.04", *rows, ""]
    )


@pytest.mark.long
@pytest.mark.parametrize(
    ("turn", "scale"),
    [
        pytest.param(turn, scale, id=f"{name}-{scale}", marks=() if fast else pytest.mark.slow)
        for name, turn in (("as it was", np.eye(3)), ("Z up", Z_UP), ("skew", SKEW))
        for scale in (1.0, 100.0, 3.7)
        for fast in [(name, scale) == ("Z up", 100.0)]
    ],
)
def test_another_axis_up_and_another_unit_are_the_same_coordinates(
    signer: Rig, clip: Clip, recording: Recording, turn: Floats, scale: float, tmp_path: Path
) -> None:
    path = tmp_path / "anew.bvh"
    path.write_text(written_anew(recording, turn, scale), encoding="ascii")
    opened = open_clip(path)
    assert opened.notes == ()
    assert np.degrees(np.abs(opened.clip.coordinates - clip.coordinates).max()) < 0.1
    np.testing.assert_allclose(opened.clip.times, clip.times)


def test_a_mirror_image_and_a_body_that_was_changed_are_not_the_rigs_own(
    signer: Rig, recording: Recording
) -> None:
    assert is_own(recording, signer)
    assert not is_own(parse_bvh(written_anew(recording, np.diag([-1.0, 1, 1]), 1.0)), signer)
    assert not is_own(recording, load_rig("child"))
    text = written_anew(recording, Z_UP, 100.0)
    place = "JOINT finger2_1_L { OFFSET "
    x = text.split(place)[1].split()[0]
    for change_cm, own in ((0.1, True), (0.3, False)):
        moved = text.replace(place + x, f"{place}{float(x) + change_cm:.6f}")
        assert is_own(parse_bvh(moved, "cm"), signer) == own
    with pytest.raises(ValueError, match="one of another skeleton"):
        own_clip(parse_bvh(text.replace("finger2_1_L", "index_L")), signer)


@pytest.mark.long
def test_retargeting_the_bodys_own_skeleton_changes_nothing(
    clip: Clip, recording: Recording, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, out = tmp_path / "own.bvh", tmp_path / "out.npz"
    path.write_text(written_anew(recording, Z_UP, 1.0), encoding="ascii")
    assert run(["retarget", str(path), "-o", str(out)]) == 0
    assert "it is the body's own skeleton: all joints are as they were" in capsys.readouterr().err
    made = open_clip(out).clip.coordinates
    assert np.degrees(np.abs(made - clip.coordinates).max()) < 0.1
