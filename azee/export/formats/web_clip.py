"""A clip for pages that have its body already: rotations as 16-bit integers, and face weights.

docs/studio-protocol.md describes the bytes. A page loads the body once (`write_body`) and gets
only this for every movement: a tenth of a GLB of the same clip.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.export.files import replace_file
from azee.export.formats.moving_body import MovingBody, postures

MAGIC = b"AZWC"
VERSION = 1
ROTATION_STEPS = 32767
"""Steps from 0 to 1 of a component of a quaternion; an angle is off by 1e-4 rad at most."""
WEIGHT_STEPS = 16384
"""Steps from 0 to 1 of a weight, which may lie between −2 and 2."""
STILL = 1e-6
"""Change of a component of a quaternion that is not visible."""

Floats = NDArray[np.float64]


def web_clip(clip: Clip, rig: MovingBody, extras: Mapping[str, object] | None = None) -> bytes:
    """Return a clip as docs/studio-protocol.md describes it.

    Time 0 is the first frame. Joints that stay in the bind pose are left out, as in a GLB; those
    that are turned and never move are in the header.

    Args: extras: more for the page that gets it, as JSON allows; part of the header.
    """
    frames, joints = len(clip.times), len(rig.skeleton.names)
    rotations, roots = np.empty((frames, joints, 4)), np.empty((frames, 3))
    for chunk, pose in postures(clip, rig):
        rotations[chunk] = _in_one_half(pose.rotations)
        roots[chunk] = rig.skeleton.offsets[0] + pose.root_translation
    away = np.abs(rotations - (0.0, 0.0, 0.0, 1.0)).max(axis=(0, 2), initial=0.0) >= STILL
    moves = np.abs(rotations - rotations[:1]).max(axis=(0, 2), initial=0.0) >= STILL
    header: dict[str, Any] = {
        "format": "azee-web-clip",
        "version": VERSION,
        "rig": rig.name,
        "frames": frames,
        "duration_s": round(clip.duration_s, 6),
        "joints": [rig.skeleton.names[j] for j in np.flatnonzero(moves)],
        "still": {
            rig.skeleton.names[j]: np.round(rotations[0, j], 6).tolist()
            for j in np.flatnonzero(away & ~moves)
        },
        "units": list(clip.units),
        "labels": [
            {
                "text": label.text,
                "path": list(label.path),
                "start_s": round(label.start_s - float(clip.times[0]), 6),
                "end_s": round(label.end_s - float(clip.times[0]), 6),
            }
            for label in clip.labels
        ],
        "extras": dict(extras or {}),
    }
    sections = (
        (clip.times - clip.times[0]).astype("<f4"),
        roots.astype("<f4"),
        _steps(rotations[:, moves].transpose(1, 0, 2), ROTATION_STEPS),
        _steps(clip.unit_weights.T, WEIGHT_STEPS),
    )
    head = json.dumps(header, separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode()
    head += b" " * (-len(head) % 4)
    data = b"".join(section.tobytes() for section in sections)
    return MAGIC + struct.pack("<I", len(head)) + head + data


def write_web_clip(clip: Clip, rig: MovingBody, path: str | Path) -> None:
    """Write a clip for web pages. Raises: OSError: the file cannot be written."""
    with replace_file(path) as file:
        file.write(web_clip(clip, rig))


def _in_one_half(rotations: Floats) -> Floats:
    """Return quaternions (…, wxyz) as xyzw, of q and −q the one with w ≥ 0."""
    signs = np.where(rotations[..., :1] < 0.0, -1.0, 1.0)
    return np.roll(rotations * signs, -1, axis=-1)


def _steps(values: Floats, steps: int) -> NDArray[np.int16]:
    """Round to whole steps, row after row."""
    whole = np.round(np.ascontiguousarray(values) * steps)
    return np.clip(whole, -32768, 32767).astype("<i2")
