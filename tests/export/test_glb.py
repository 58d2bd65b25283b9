"""GLB files are sound glTF, and three.js sees the body that we computed."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from programs import Node
from small_rig import SMALL, tumbling

from azee.clip.clip import Clip, Label
from azee.export.formats.glb import write_glb
from azee.export.formats.moving_body import MovingBody
from azee_rig.mesh import BodyMesh
from azee_rig.rig import Rig
from azee_rig.skin import skin

MILLIMETRE = 1e-3


def _signing(rig: Rig) -> Clip:
    """A second of the whole body on its way between postures inside its limits, face included."""
    c = rig.coordinates
    random = np.random.default_rng(11)
    keys = [c.idle + 0.6 * (random.uniform(c.lower, c.upper) - c.idle) for _ in range(3)]
    keys = [c.idle, *keys, c.idle]
    share = np.linspace(0, 1, 8)[:, None]
    rows = [a + share * (b - a) for a, b in pairwise(keys)]
    frames = len(keys) * 8 - 8
    units = (rig.units[0], rig.units[-1])
    weights = np.stack([np.linspace(0, 1, frames), np.linspace(1, -0.4, frames)], axis=1)
    label = Label(("signing",), 0.0, frames / 30)
    return Clip(np.arange(frames) / 30, np.vstack(rows), units, weights, (label,))


@pytest.fixture
def small_file(tmp_path: Path) -> Path:
    write_glb(tumbling(), SMALL, tmp_path / "small.glb")
    return tmp_path / "small.glb"


@pytest.fixture(scope="session")
def signing(signer: Rig) -> Clip:
    return _signing(signer)


@pytest.fixture(scope="session")
def signer_file(signer: Rig, signing: Clip, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("glb") / "signer.glb"
    write_glb(signing, signer, path)
    return path


def _json(path: Path) -> dict[str, Any]:
    data = path.read_bytes()
    magic, version, length, size, kind = struct.unpack_from("<4sIII4s", data)
    assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON")
    document: dict[str, Any] = json.loads(data[20 : 20 + size])
    return document


@pytest.mark.parametrize("file", ["small_file", "signer_file"])
def test_the_khronos_validator_has_nothing_to_say(
    node: Node, file: str, request: pytest.FixtureRequest
) -> None:
    report = json.loads(node("validate.mjs", request.getfixturevalue(file)))
    assert report["issues"]["messages"] == []
    assert not report["issues"]["truncated"]


def test_nodes_and_targets_keep_the_rigs_names(signer_file: Path, signer: Rig) -> None:
    document = _json(signer_file)
    names = [node["name"] for node in document["nodes"]]
    assert names[: len(signer.skeleton.names)] == list(signer.skeleton.names)
    (mesh,) = document["meshes"]
    assert tuple(mesh["extras"]["targetNames"]) == signer.units
    assert len(document["skins"]) == len(document["animations"]) == 1


def test_only_what_moves_has_keys(small_file: Path) -> None:
    document = _json(small_file)
    (animation,) = document["animations"]
    counts = {}
    for channel in animation["channels"]:
        node = document["nodes"][channel["target"]["node"]]["name"]
        sampler = animation["samplers"][channel["sampler"]]
        key = node, channel["target"]["path"]
        counts[key] = document["accessors"][sampler["input"]]["count"]
    assert counts == {
        ("root", "translation"): 20,
        ("root", "rotation"): 20,
        ("spine.01", "rotation"): 1,
        ("arm.L", "rotation"): 20,
        ("hand-1.L", "rotation"): 1,
        ("head", "rotation"): 20,
        ("small_mesh", "weights"): 20,
    }


def test_labels_stand_in_the_extras_with_their_paths(small_file: Path) -> None:
    (animation,) = _json(small_file)["animations"]
    assert animation["name"] == "not-but"
    first = {"text": "X", "path": ["not-but", "X"], "start_s": 0.0, "end_s": 0.4}
    assert animation["extras"]["labels"][1] == first
    assert animation["extras"]["labels"][2]["path"] == ["not-but", "Y & <Z>"]


def test_more_than_four_influences_make_a_second_set_and_few_do_not(small_file: Path) -> None:
    sleeve, skin = _json(small_file)["meshes"][0]["primitives"]
    assert "JOINTS_1" in sleeve["attributes"]
    assert "JOINTS_1" not in skin["attributes"]


def test_a_clip_at_rest_is_a_file_too(node: Node, tmp_path: Path) -> None:
    still = np.tile([0.0, 0, 0, *[1.0, 0, 0, 0] * 6], (2, 1))
    clip = Clip(np.array([0.0, 1.0]), still, (), np.zeros((2, 0)))
    write_glb(clip, SMALL, tmp_path / "rest.glb")
    assert json.loads(node("validate.mjs", tmp_path / "rest.glb"))["issues"]["messages"] == []


def test_the_same_clip_gives_the_same_bytes(small_file: Path, tmp_path: Path) -> None:
    write_glb(tumbling(), SMALL, tmp_path / "again.glb")
    assert small_file.read_bytes() == (tmp_path / "again.glb").read_bytes()


def _seen(browser: Node, path: Path, times: NDArray[np.float64], step: int) -> dict[str, Any]:
    picture = path.with_suffix(".png")
    seconds = ",".join(f"{t:.9f}" for t in times)
    seen: dict[str, Any] = json.loads(
        browser("gltf_browser.mjs", path, seconds, str(step), picture)
    )
    assert "error" not in seen, seen["error"]
    assert seen["complaints"] == []
    return seen


@pytest.mark.parametrize("body", ["small", "signer"])
def test_three_js_in_a_browser_sees_our_body(
    browser: Node, body: str, request: pytest.FixtureRequest
) -> None:
    path: Path = request.getfixturevalue(f"{body}_file")
    rig: MovingBody = SMALL if body == "small" else request.getfixturevalue("signer")
    clip: Clip = tumbling() if body == "small" else request.getfixturevalue("signing")
    step = 1 if body == "small" else 5
    frames = [0, len(clip.times) // 3, len(clip.times) // 2, len(clip.times) - 1]
    seen = _seen(browser, path, clip.times[frames], step)
    assert seen["triangles"] == len(rig.mesh.triangles)
    assert [part.name for part in rig.mesh.parts] == seen["materials"]
    assert all(tuple(names) == rig.mesh.units for names in seen["morphs"])
    (animation,) = seen["animations"]
    assert abs(animation["duration"] - clip.times[-1]) < 1e-5
    assert [row["path"] for row in animation["extras"]["labels"]] == [
        list(label.path) for label in clip.labels
    ]

    for at, frame in zip(seen["at"], frames, strict=True):
        pose = rig.pose(clip.coordinates[frame])
        ours = dict(zip(rig.skeleton.names, rig.joint_positions(pose), strict=True))
        assert at["joints"].keys() == ours.keys()
        for name, position in at["joints"].items():
            assert np.abs(position - ours[name]).max() < MILLIMETRE, name
        if body == "small":
            continue
        units = np.zeros(len(rig.mesh.units))
        units[[rig.mesh.units.index(unit) for unit in clip.units]] = clip.unit_weights[frame]
        skinned = skin(_with_four_influences(rig.mesh), rig.skeleton, pose, units)
        for part, vertices in zip(rig.mesh.parts, at["vertices"], strict=True):
            used = np.unique(rig.mesh.triangles[part.start : part.stop])[::step]
            error = np.linalg.norm(np.array(vertices) - skinned[used], axis=1)
            assert error.max() < 2 * MILLIMETRE, part.name


def _with_four_influences(mesh: BodyMesh) -> BodyMesh:
    """Reduce influences as three.js does, which reads JOINTS_0 alone and rescales its weights."""
    weights = np.array(mesh.weights)
    weights[:, 4:] = 0
    return replace(mesh, weights=weights / weights.sum(axis=1, keepdims=True))


def test_the_browser_draws_the_body(browser: Node, signer_file: Path, signing: Clip) -> None:
    _seen(browser, signer_file, signing.times[:1], 1000)
    picture = np.asarray(Image.open(signer_file.with_suffix(".png")).convert("RGB")).astype(int)
    green = (np.abs(picture - (0, 255, 0)) < 8).all(axis=2)
    assert 0.03 < 1 - green.mean() < 0.6
    assert len(np.unique(picture[~green], axis=0)) > 100
