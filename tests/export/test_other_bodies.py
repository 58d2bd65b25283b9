"""The bodies beside the signer are sound glTF, and three.js sees them as we do."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from programs import Node

from azee.clip.clip import Clip
from azee.export.formats.glb import write_glb
from azee_rig.load import load_rig, shipped_rigs

POSTURES = 10
JOINT_M, VERTEX_M = 0.001, 0.002
STEP = 7
OTHERS = tuple(name for name in shipped_rigs() if name != "signer")


def test_there_are_other_bodies() -> None:
    assert set(OTHERS) >= {"child", "heavy", "game"}


@pytest.mark.slow
@pytest.mark.parametrize("name", OTHERS)
def test_three_js_agrees_at_ten_random_postures(
    node: Node, browser: Node, name: str, tmp_path: Path
) -> None:
    rig = load_rig(name)
    c = rig.coordinates
    anywhere = np.random.default_rng(7).uniform(c.lower, c.upper, (POSTURES, len(c)))
    q = c.idle + 0.6 * (anywhere - c.idle)
    times = np.arange(POSTURES) / 10
    path = tmp_path / f"{name}.glb"
    write_glb(Clip(times, q, (), np.zeros((POSTURES, 0))), rig, path)
    assert json.loads(node("validate.mjs", path))["issues"]["messages"] == []
    seconds = ",".join(f"{t:.9f}" for t in times)
    seen = json.loads(
        browser("gltf_browser.mjs", path, seconds, str(STEP), path.with_suffix(".png"))
    )
    assert seen["complaints"] == []
    for at, posture in zip(seen["at"], q, strict=True):
        pose = rig.pose(posture)
        ours = dict(zip(rig.skeleton.names, rig.joint_positions(pose), strict=True))
        assert at["joints"].keys() == ours.keys()
        for joint, place in at["joints"].items():
            assert np.linalg.norm(place - ours[joint]) < JOINT_M, joint
        skin = rig.skin(pose)
        for part, vertices in zip(rig.mesh.parts, at["vertices"], strict=True):
            used = np.unique(rig.mesh.triangles[part.start : part.stop])[::STEP]
            gap = np.linalg.norm(np.array(vertices) - skin[used], axis=1)
            assert gap.max() < VERTEX_M, part.name
