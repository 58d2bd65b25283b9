"""A clip as JSON: skeleton, frames, morph weights and labels; docs/formats.md has the schema."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.export.files import replace_file
from azee.export.formats.moving_body import MovingBody, postures

METRES = 6
QUATERNION = 8
"""Number of decimals that are written."""
ROWS = 64
"""Rows of an array that are made text together."""


def write_json(clip: Clip, rig: MovingBody, path: str | Path) -> None:
    """Write a clip as JSON, a line a property.

    Quaternions are xyzw here, as in glTF, and the document says so.

    Raises: OSError: the file cannot be written.
    """
    separator = "{\n"
    with replace_file(path) as file:
        for name, value in _properties(clip, rig):
            file.write(f"{separator}{json.dumps(name)}: ".encode())
            file.writelines(part.encode() for part in _text(value))
            separator = ",\n"
        file.write(b"\n}\n")


@dataclass(frozen=True, slots=True)
class _Numbers:
    """An array that is written as nested lists, some rows at a time.

    Nested lists of floats take ten times the room of their array.
    """

    array: NDArray[np.float64]
    decimals: int

    def text(self) -> Iterator[str]:
        """Yield the rows, without minus zeros."""
        for start in range(0, len(self.array), ROWS):
            rounded = np.round(self.array[start : start + ROWS], self.decimals) + 0.0
            yield ("," if start else "") + _dumped(rounded.tolist())[1:-1]


def _text(value: object) -> Iterator[str]:
    """Yield a value as JSON: what holds arrays in parts, all else at once."""
    if isinstance(value, _Numbers):
        yield "["
        yield from value.text()
        yield "]"
    elif isinstance(value, dict):
        for n, (name, inner) in enumerate(value.items()):
            yield f"{',' if n else '{'}{json.dumps(name)}:"
            yield from _text(inner)
        yield "}"
    else:
        yield _dumped(value)


def _dumped(value: object) -> str:
    return json.dumps(value, separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def _properties(clip: Clip, rig: MovingBody) -> Iterator[tuple[str, object]]:
    """Yield what a document has, in order."""
    yield "format", "azee-clip"
    yield "version", 1
    yield "rig", rig.name
    yield (
        "conventions",
        {
            "length": "m",
            "time": "s",
            "rotation": "quaternion xyzw, relative to the parent",
            "axes": {"up": "+Y", "forward": "+Z", "left": "+X"},
        },
    )
    yield (
        "labels",
        [
            {
                "text": label.text,
                "path": list(label.path),
                "start_s": label.start_s,
                "end_s": label.end_s,
            }
            for label in clip.labels
        ],
    )
    skeleton = rig.skeleton
    yield (
        "skeleton",
        {
            "names": list(skeleton.names),
            "parents": skeleton.parents.tolist(),
            "offsets": _Numbers(skeleton.offsets, METRES),
        },
    )
    yield "times", _Numbers(clip.times, METRES)
    shape = (len(clip.times), len(skeleton.names))
    rotations, positions = np.empty((*shape, 4)), np.empty((*shape, 3))
    for frames, pose in postures(clip, rig):
        rotations[frames] = np.roll(pose.rotations, -1, axis=-1)
        positions[frames] = rig.joint_positions(pose)
    yield "root_positions", _Numbers(positions[:, 0], METRES)
    yield "rotations", _Numbers(rotations, QUATERNION)
    weights = _Numbers(clip.unit_weights, METRES)
    yield "morphs", {"names": list(clip.units), "weights": weights}
    yield "positions", _Numbers(positions, METRES)
