"""A clip from a recording of the rig's own skeleton, exact except for the rounding of files.

The rig's BVH files say every joint's rotation to a millionth of a degree. The coordinates behind
them are those of which these are the rotations (`azee_rig.recover`). Other programs write them
anew with another axis up and in other units: the skeleton is the rig's own up to a turn and a scale
of the whole. The root's place and turn are
dropped, as §3.2.3 of Gürel 2010 wants: the signer stands where the rig stands. Face units have no
place in BVH; eyes and jaw that are joints have.
"""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.clip.recording import Recording
from azee_rig.recover import recover
from azee_rig.rig import Rig

Floats = NDArray[np.float64]

SAME_M = 2e-3
"""Up to which difference of offsets, turned and scaled to the rig's, a skeleton is its own."""
LOST_RAD = np.radians(0.1)
"""A posture that is farther from the recorded one is not what was recorded."""


def is_own(recording: Recording, rig: Rig) -> bool:
    """Whether a recording moves the rig's own skeleton, turned and scaled as a whole or not."""
    return _aligned(recording, rig) is not None


def own_clip(recording: Recording, rig: Rig) -> tuple[Clip, float]:
    """Return a recording of the rig's own skeleton as a clip, and the largest error, radians.

    If the file was edited elsewhere, it may have postures that the body cannot take. The clip comes
    as near as the limits allow; the error is the worst turn of any joint in any frame.

    Raises: ValueError: it is a recording of another skeleton.
    """
    aligned = _aligned(recording, rig)
    if aligned is None:
        raise ValueError("the recording is one of another skeleton")
    order, turn = aligned
    rotations = recording.rotations[:, order]
    # Joints have the file's axes at rest: turns are the same about turned axes.
    rotations = np.concatenate([rotations[..., :1], rotations[..., 1:] @ turn.T], axis=-1)
    found = recover(rig, rotations)
    clip = Clip(recording.times, found.coordinates, (), np.zeros((len(recording.times), 0)))
    return clip, float(found.error_rad.max())


def _aligned(recording: Recording, rig: Rig) -> tuple[list[int], Floats] | None:
    """Index of each of the rig's joints in the recording, and the turn (3, 3) to the rig's axes.

    The turn R and the scale s are those that bring all offsets a of the recording nearest to the
    rig's own, b: min Σ |s R a − b|² (Umeyama 1991, eqs. 40 to 42). The root's place counts
    for nothing. None: joints are missing, or an offset is not the rig's own.
    """
    order = _order(recording, rig)
    if order is None:
        return None
    a, b = recording.skeleton.offsets[order[1:]], rig.skeleton.offsets[1:]
    square = float((a**2).sum())
    if square == 0.0:
        return None
    U, D, Vt = np.linalg.svd(b.T @ a)
    signs = np.array([1.0, 1.0, np.sign(np.linalg.det(U @ Vt))])
    R = (U * signs) @ Vt
    scale = float((D * signs).sum()) / square
    if np.abs(scale * a @ R.T - b).max() >= SAME_M:
        return None
    return order, np.asarray(R)


def _order(recording: Recording, rig: Rig) -> list[int] | None:
    """Return the index of each of the rig's joints in the recording, or None if one is missing."""
    there = {_plain(name): i for i, name in enumerate(recording.skeleton.names)}
    names = [_plain(name) for name in rig.skeleton.names]
    if len(there) != len(recording.skeleton.names) or len(set(names)) != len(names):
        return None
    return [there[name] for name in names] if all(name in there for name in names) else None


def _plain(name: str) -> str:
    """Return a name in the form that BVH allows: letters, digits and underscores."""
    return re.sub(r"[^A-Za-z0-9_]", "_", name)
