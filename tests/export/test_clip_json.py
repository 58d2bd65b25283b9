"""Clip JSON keeps to the schema in docs/formats.md, and its numbers are those of the clip."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from formats import schema
from numpy.typing import NDArray
from small_rig import SMALL, SmallRig, tumbling

from azee.export.formats.clip_json import write_json
from azee_rig.skeleton import Pose


@pytest.fixture
def document(tmp_path: Path) -> dict[str, Any]:
    write_json(tumbling(), SMALL, tmp_path / "clip.json")
    read: dict[str, Any] = json.loads((tmp_path / "clip.json").read_text(encoding="utf-8"))
    return read


def test_it_keeps_to_the_documented_schema(document: dict[str, Any]) -> None:
    jsonschema.validate(document, schema("clip"))


def test_every_field_is_documented(document: dict[str, Any]) -> None:
    assert document.keys() == schema("clip")["properties"].keys()


def test_a_reader_gets_rotations_that_give_the_positions(document: dict[str, Any]) -> None:
    """Forward kinematics from the file alone, as a program that knows nothing of azee does it."""
    offsets = np.array(document["skeleton"]["offsets"])
    rotations = np.array(document["rotations"])
    positions = np.array(document["positions"])
    assert len(document["root_positions"]) == len(positions) > 1
    assert len(document["skeleton"]["parents"]) == positions.shape[1] > 1
    for frame, root in enumerate(document["root_positions"]):
        world: list[tuple[Any, Any]] = []
        for joint, parent in enumerate(document["skeleton"]["parents"]):
            turn = _matrix(rotations[frame, joint])
            if parent < 0:
                world.append((np.array(root), turn))
            else:
                place, frame_of_parent = world[parent]
                world.append((place + frame_of_parent @ offsets[joint], frame_of_parent @ turn))
            assert np.abs(world[joint][0] - positions[frame, joint]).max() < 1e-5


def _matrix(xyzw: Any) -> Any:
    x, y, z, w = xyzw
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def test_weights_labels_and_times_are_the_clips(document: dict[str, Any]) -> None:
    clip = tumbling()
    np.testing.assert_allclose(document["times"], clip.times, atol=1e-6)
    np.testing.assert_allclose(document["morphs"]["weights"], clip.unit_weights, atol=1e-6)
    assert document["morphs"]["names"] == ["blink", "smile"]
    inner = {"text": "Y & <Z>", "path": ["not-but", "Y & <Z>"], "start_s": 0.4, "end_s": 0.76}
    assert document["labels"][2] == inner


def test_the_same_clip_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a.json", "b.json"):
        write_json(tumbling(), SMALL, tmp_path / name)
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()


def test_numbers_that_are_none_are_never_written(tmp_path: Path) -> None:
    class Lost(SmallRig):
        def joint_positions(self, pose: Pose) -> NDArray[np.float64]:
            return np.full_like(super().joint_positions(pose), np.nan)

    with pytest.raises(ValueError, match="JSON"):
        write_json(tumbling(), Lost(), tmp_path / "lost.json")
    assert list(tmp_path.iterdir()) == []
