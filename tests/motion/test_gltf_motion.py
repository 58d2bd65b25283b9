"""Motion in glTF files, ours and others', is read and carried over."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import pytest

from azee.cli.main import run
from azee.clip.clip import Clip
from azee.clip.gltf_motion import GltfMotionError, read_gltf_motion
from azee.clips import carry_over, save_clip
from azee_rig.rig import Rig

FRAMES = 12


def _clip(rig: Rig) -> Clip:
    c = rig.coordinates
    goal = np.array(c.idle)
    for name, angle in (("arm_R.flexion", 0.9), ("f_arm_R.flexion", 1.2), ("palm_R.flexion", 0.3),
                        ("index_R_1.flexion", 0.8), ("head.flexion", 0.2)):  # fmt: skip
        i = c.index[name]
        goal[i] = np.clip(angle, c.lower[i], c.upper[i])
    share = np.linspace(0.0, 1.0, FRAMES)[:, None]
    q = c.idle + share * (goal - c.idle)
    return Clip(np.arange(FRAMES) / 30.0, q, (), np.zeros((FRAMES, 0)))


@pytest.mark.slow
@pytest.mark.parametrize(("suffix", "within_m"), [(".glb", 1e-5), (".vrma", 0.01)])
def test_our_files_come_back(suffix: str, within_m: float, signer: Rig, tmp_path: Path) -> None:
    """A GLB has the body's own skeleton; VRMA has one of its own, with fewer joints."""
    clip = _clip(signer)
    path = tmp_path / f"clip{suffix}"
    save_clip(clip, signer, path)
    made, _ = carry_over(path, signer)
    was, now = (signer.chain.frames(c.coordinates).positions for c in (clip, made.clip))
    nodes = [signer.bones[b].origin_node for b in ("palm_R", "index_R_3", "palm_L", "head")]
    assert np.linalg.norm(was[:, nodes] - now[:, nodes], axis=2).max() < within_m
    assert np.abs(made.clip.times - clip.times).max() < 1e-6


@pytest.mark.slow
def test_retarget_takes_them(
    signer: Rig, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    save_clip(_clip(signer), signer, tmp_path / "clip.vrma")
    out = tmp_path / "child.npz"
    assert run(["retarget", str(tmp_path / "clip.vrma"), "--rig", "child", "-o", str(out)]) == 0
    assert "hands are where they were in all 12 frames" in capsys.readouterr().err
    assert out.exists()


def _file(path: Path, how: str, values: list[list[float]], times: list[float]) -> Path:
    """Write a node that turns, and one below it at rest turned the other way."""
    half = 0.5**0.5
    turned = [0.0, 0.0, half, half]
    data = np.array(times, np.float32).tobytes() + np.array(values, np.float32).tobytes()
    document = {
        "asset": {"version": "2.0"},
        "nodes": [
            {"name": "a", "children": [1], "translation": [0, 1, 0], "rotation": turned},
            {"name": "b", "translation": [1, 0, 0], "rotation": [0, 0, -half, half]},
        ],
        "scenes": [{"nodes": [0]}],
        "buffers": [{"byteLength": len(data)}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 4 * len(times)},
            {"buffer": 0, "byteOffset": 4 * len(times), "byteLength": 16 * len(values)},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(times), "type": "SCALAR"},
            {"bufferView": 1, "componentType": 5126, "count": len(values), "type": "VEC4"},
        ],
        "animations": [
            {
                "samplers": [{"input": 0, "output": 1, "interpolation": how}],
                "channels": [{"sampler": 0, "target": {"node": n, "path": "rotation"}}
                             for n in (0, 1)],
            }
        ],
    }  # fmt: skip
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
    return path


@pytest.mark.parametrize(
    ("how", "middle_deg"), [("LINEAR", 45.0), ("STEP", 0.0), ("CUBICSPLINE", 45.0)]
)
def test_keys_are_interpolated_as_gltf_says(how: str, middle_deg: float, tmp_path: Path) -> None:
    none, turned = [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.5**0.5, 0.5**0.5]
    keys = [none, turned]
    if how == "CUBICSPLINE":
        keys = [[0.0] * 4, none, [0.0] * 4, [0.0] * 4, turned, [0.0] * 4]
    recording = read_gltf_motion(_file(tmp_path / "x.glb", how, keys, [0.0, 1.0]))
    assert len(recording.times) == 31
    places, turns = recording.frames()
    # At rest `a` is turned by 90°, so that `b` stands above it; rest has the world's axes.
    assert recording.skeleton.rest_positions[1] == pytest.approx([0.0, 2.0, 0.0], abs=1e-6)
    angle = np.radians(middle_deg)
    assert places[15, 1] == pytest.approx([np.cos(angle), 1.0 + np.sin(angle), 0.0], abs=2e-3)
    assert places[-1, 1] == pytest.approx([0.0, 2.0, 0.0], abs=1e-6)
    assert np.linalg.det(turns) == pytest.approx(np.ones(turns.shape[:2]))


def test_files_without_motion_are_told(
    signer: Rig, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from azee.export.formats.glb import write_body

    write_body(signer, tmp_path / "still.glb")
    (tmp_path / "cut.vrma").write_bytes(b"glTF\x02\x00\x00\x00")
    for name, words in (("still.glb", "it has no animation"), ("cut.vrma", "cut.vrma")):
        out = tmp_path / "x.npz"
        assert run(["retarget", str(tmp_path / name), "-o", str(out)]) == 1
        said = capsys.readouterr().err
        assert "error[not-a-clip]" in said
        assert words in said
    bad = _file(tmp_path / "bad.glb", "LINEAR", [[0.0, 0.0, 0.0, 1.0]], [0.0, 1.0])
    with pytest.raises(GltfMotionError, match="do not fit"):
        read_gltf_motion(bad)
