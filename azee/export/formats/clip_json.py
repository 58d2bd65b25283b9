"""A clip as JSON: skeleton, frames, morph weights and labels; docs/formats.md has the schema."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.export.files import replace_file
from azee.export.formats.moving_body import MovingBody

METRES = 6
QUATERNION = 8
"""Number of decimals that are written."""


def write_json(clip: Clip, rig: MovingBody, path: str | Path) -> None:
    """Write a clip as JSON, a line a property.

    Raises: OSError: the file cannot be written.
    """
    lines = (
        f"{json.dumps(name)}: "
        + json.dumps(value, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
        for name, value in clip_document(clip, rig).items()
    )
    with replace_file(path) as file:
        file.write(("{\n" + ",\n".join(lines) + "\n}\n").encode())


def clip_document(clip: Clip, rig: MovingBody) -> dict[str, Any]:
    """Return what `write_json` writes, as plain dictionaries and lists.

    Quaternions are xyzw here, as in glTF, and the document says so.
    """
    pose = rig.pose(clip.coordinates)
    positions = rig.joint_positions(pose)
    return {
        "format": "azee-clip",
        "version": 1,
        "rig": rig.name,
        "conventions": {
            "length": "m",
            "time": "s",
            "rotation": "quaternion xyzw, relative to the parent",
            "axes": {"up": "+Y", "forward": "+Z", "left": "+X"},
        },
        "labels": [
            {
                "text": label.text,
                "path": list(label.path),
                "start_s": label.start_s,
                "end_s": label.end_s,
            }
            for label in clip.labels
        ],
        "skeleton": {
            "names": list(rig.skeleton.names),
            "parents": rig.skeleton.parents.tolist(),
            "offsets": _rounded(rig.skeleton.offsets, METRES),
        },
        "times": _rounded(clip.times, METRES),
        "root_positions": _rounded(positions[:, 0], METRES),
        "rotations": _rounded(np.roll(pose.rotations, -1, axis=-1), QUATERNION),
        "morphs": {"names": list(clip.units), "weights": _rounded(clip.unit_weights, METRES)},
        "positions": _rounded(positions, METRES),
    }


def _rounded(array: NDArray[np.float64], decimals: int) -> list[Any]:
    """Return nested lists, without minus zeros."""
    rounded: list[Any] = (np.round(array, decimals) + 0.0).tolist()
    return rounded
