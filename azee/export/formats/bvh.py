"""A clip as BVH, after the format's description and conventions in Gürel 2010, appendix B.

One skeleton; tabs; the root has six channels, every other joint three, rotations in the order Z, X,
Y; angles in degrees, lengths in centimetres, as motion-capture tools expect. The root's OFFSET is
zero and its position channels are absolute. Some programs add the offset to the channels and some
replace it; with zero, all give the same result.

Names have only the letters, digits and underscores of the appendix' grammar. The format has no
morph weights.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.export.files import replace_file
from azee.export.formats.euler import EulerZXY
from azee.export.formats.moving_body import MovingBody, postures
from azee_rig.skeleton import Skeleton

CENTIMETRES = 100.0
POSITIONS = "Xposition Yposition Zposition"
ROTATIONS = "Zrotation Xrotation Yrotation"
TIP = 0.75
"""Length of a last bone as a share of the bone before, since joints do not give its length.

About the ratio of distal to middle phalanges.
"""
ONE_FRAME_S = 1 / 30
"""Frame time of a still."""


def write_bvh(clip: Clip, rig: MovingBody, path: str | Path) -> None:
    """Write a clip's skeleton and joint rotations, one line a frame.

    Raises: OSError: the file cannot be written. ValueError: the clip's frames are not evenly
        spaced, or the skeleton has more than one root.
    """
    skeleton = rig.skeleton
    below = _children(skeleton)
    names = _names(skeleton)
    order = list(_depth_first(0, below))
    if len(order) != len(skeleton.names):
        raise ValueError("a BVH file holds one skeleton, with one root")
    lines = [
        "HIERARCHY",
        *_joint(skeleton, 0, names, below, 0),
        "MOTION",
        f"Frames: {len(clip.times)}",
        f"Frame Time: {_frame_time(clip.times):.9g}",
    ]
    with replace_file(path) as file:
        for line in chain(lines, _rows(clip, rig, order)):
            file.write(f"{line}\n".encode("ascii"))


def _rows(clip: Clip, rig: MovingBody, order: Sequence[int]) -> Iterator[str]:
    """Yield a line for each frame, a chunk of frames at a time."""
    before: NDArray[np.float64] | None = None
    for _, pose in postures(clip, rig):
        euler = EulerZXY.from_quaternions(pose.rotations[:, order], before).angles
        before = euler[-1]
        root = rig.skeleton.offsets[0] + np.broadcast_to(pose.root_translation, (len(euler), 3))
        rows = np.hstack([root * CENTIMETRES, np.degrees(euler).reshape(len(euler), -1)])
        yield from map(_numbers, rows)


def _children(skeleton: Skeleton) -> list[list[int]]:
    below: list[list[int]] = [[] for _ in skeleton.names]
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            below[parent].append(joint)
    return below


def _depth_first(joint: int, below: Sequence[Sequence[int]]) -> Iterator[int]:
    """Yield joints in the order in which the hierarchy, and so each frame, lists them."""
    yield joint
    for child in below[joint]:
        yield from _depth_first(child, below)


def _names(skeleton: Skeleton) -> list[str]:
    """Return joint names of letters, digits and underscores; equal ones get different endings."""
    names: list[str] = []
    for name in skeleton.names:
        plain = re.sub(r"[^A-Za-z0-9_]", "_", name)
        names.append(plain if plain not in names else f"{plain}_{names.count(plain) + 1}")
    return names


def _joint(
    skeleton: Skeleton, joint: int, names: list[str], below: list[list[int]], level: int
) -> Iterator[str]:
    tabs = "\t" * level
    offset = skeleton.offsets[joint] if level else np.zeros(3)
    yield f"{tabs}{'JOINT' if level else 'ROOT'} {names[joint]}"
    yield f"{tabs}{{"
    yield f"{tabs}\tOFFSET {_numbers(offset * CENTIMETRES)}"
    yield f"{tabs}\tCHANNELS " + (f"3 {ROTATIONS}" if level else f"6 {POSITIONS} {ROTATIONS}")
    for child in below[joint]:
        yield from _joint(skeleton, child, names, below, level + 1)
    if not below[joint]:
        yield f"{tabs}\tEnd Site"
        yield f"{tabs}\t{{"
        yield f"{tabs}\t\tOFFSET {_numbers(skeleton.offsets[joint] * (TIP * CENTIMETRES))}"
        yield f"{tabs}\t}}"
    yield f"{tabs}}}"


def _frame_time(times: NDArray[np.float64]) -> float:
    if len(times) < 2:
        return ONE_FRAME_S
    step = float(times[-1] - times[0]) / (len(times) - 1)
    if np.abs(np.diff(times) - step).max() > 1e-6:
        raise ValueError("a BVH file has one frame time for all frames")
    return step


def _numbers(values: NDArray[np.float64]) -> str:
    """Six decimals: a millionth of a degree, ten nanometres. Never a minus zero.

    Raises: ValueError: one is infinite or not a number.
    """
    if not np.isfinite(values).all():
        raise ValueError("BVH holds no infinite numbers and none that are not numbers")
    return " ".join(f"{value:.6f}" for value in np.round(values, 6) + 0.0)
