"""three.js plays our animations on the very files that bodies were taken from."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from body_families import make_body
from glb_file import GlbFile
from joint_names import FAMILIES
from programs import Node

from azee.cli.main import run
from azee.clip.clip import Clip
from azee.clips import save_clip
from azee_rig.load import load_rig
from azee_rig.rig import Rig

WITHIN_M = 0.002
FRAMES = 5
LEFT_OUT = str.maketrans("", "", "[].:/")
"""Characters that three.js leaves out of names."""
UNITS = {"jawOpen": "jawOpen", "Brow": "browInnerUp"}


def _hung(file: GlbFile) -> None:
    """Hang the skeleton on a node that turns and scales it and takes it elsewhere."""
    half = 0.5**0.5
    scene = file.document["scenes"][0]["nodes"]
    root = next(n for n in scene if "skin" not in file.nodes[n])
    above = {"name": "above", "children": [root], "scale": [100.0] * 3}
    file.nodes.append(above | {"rotation": [half, 0, 0, half], "translation": [30.0, 5.0, -7.0]})
    scene[scene.index(root)] = len(file.nodes) - 1


def _moving(rig: Rig) -> Clip:
    c = rig.coordinates
    goal = c.idle + 0.4 * (np.random.default_rng(4).uniform(c.lower, c.upper) - c.idle)
    share = np.linspace(0.0, 1.0, FRAMES)[:, None]
    units = tuple(u for u in UNITS if u in rig.units)
    weights = share * np.full(len(units), 0.6)
    return Clip(np.arange(FRAMES) / 25.0, c.idle + share * (goal - c.idle), units, weights)


@pytest.mark.slow
@pytest.mark.parametrize("hung", [False, True], ids=["upright", "hung"])
def test_three_js_plays_it_on_the_original(
    hung: bool, node: Node, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = make_body(FAMILIES["mixamo"]).file(units=UNITS)
    if hung:
        _hung(file)
    original = file.write(tmp_path / "original.glb")
    folder = tmp_path / "body"
    assert run(["rig", "import", str(original), "-o", str(folder), "--quiet"]) == 0
    rig = load_rig(folder)
    clip = _moving(rig)
    save_clip(clip, rig, tmp_path / "clip.npz")
    out = tmp_path / "animation.glb"
    command = ["export", "animation", str(tmp_path / "clip.npz"), "--rig", str(folder)]
    assert run([*command, "--onto", str(original), "-o", str(out), "--quiet"]) == 0
    issues = json.loads(node("validate.mjs", out))["issues"]
    assert issues["numErrors"] == 0
    times = ",".join(str(t) for t in clip.times)
    said = json.loads(node("own_joints.mjs", original, out, times))
    assert [c for c in said["complaints"] if "No target" in c] == []
    at = rig.joint_positions(rig.pose(clip.coordinates))
    called = {name.translate(LEFT_OUT): name for name in rig.skeleton.names}
    names = [n for n in called if n in said["frames"][0]["nodes"]]
    assert len(names) > 40
    rows = [rig.skeleton.names.index(called[n]) for n in names]
    found = np.array([[frame["nodes"][n] for n in names] for frame in said["frames"]])
    # The file's space is another: what a similarity does not explain is off.
    flat, goal = found.reshape(-1, 3), at[:, rows].reshape(-1, 3)
    centred, wanted = flat - flat.mean(axis=0), goal - goal.mean(axis=0)
    u, s, vt = np.linalg.svd(wanted.T @ centred)
    assert np.linalg.det(u @ vt) > 0.0
    scale = s.sum() / (centred**2).sum()
    off = np.linalg.norm(scale * centred @ (u @ vt).T - wanted, axis=1)
    assert off.max() < WITHIN_M
    assert scale == pytest.approx(0.01 if hung else 1.0, rel=0.2)
    for unit, weight in zip(clip.units, clip.unit_weights[-1], strict=True):
        assert said["frames"][-1]["morphs"][unit] == pytest.approx(weight, abs=1e-5)
    other = make_body(FAMILIES["vroid"]).file().write(tmp_path / "other.glb")
    assert run([*command, "--onto", str(other), "-o", str(out)]) == 1
    assert "was not taken from it" in capsys.readouterr().err
