"""A clip from a recording of the rig's own skeleton, exact except for the rounding of files.

The rig's BVH files say every joint's rotation to a millionth of a degree. The coordinates behind
them are those of which these are the rotations (`azee_rig.recover`). The root's place and turn are
dropped, as §3.2.3 of Gürel 2010 wants: the signer stands where the rig stands. Face units have no
place in BVH; eyes and jaw that are joints have.
"""

from __future__ import annotations

import re

import numpy as np

from azee.clip.clip import Clip
from azee.clip.recording import Recording
from azee_rig.recover import recover
from azee_rig.rig import Rig

SAME_M = 2e-3
"""Up to which difference of offsets a skeleton is the rig's own."""
LOST_RAD = np.radians(0.1)
"""A posture that is farther from the recorded one is not what was recorded."""


def is_own(recording: Recording, rig: Rig) -> bool:
    """Whether a recording moves the rig's own skeleton: the same joints in the same places."""
    theirs, ours = recording.skeleton, rig.skeleton
    order = _order(recording, rig)
    if order is None:
        return False
    offsets = theirs.offsets[order[1:]]
    return bool(np.abs(offsets - ours.offsets[1:]).max() < SAME_M)


def own_clip(recording: Recording, rig: Rig) -> tuple[Clip, float]:
    """Return a recording of the rig's own skeleton as a clip, and the largest error, radians.

    If the file was edited elsewhere, it may have postures that the body cannot take. The clip comes
    as near as the limits allow; the error is the worst turn of any joint in any frame.

    Raises: ValueError: it is a recording of another skeleton.
    """
    order = _order(recording, rig)
    if order is None:
        raise ValueError("the recording is one of another skeleton")
    found = recover(rig, recording.rotations[:, order])
    clip = Clip(recording.times, found.coordinates, (), np.zeros((len(recording.times), 0)))
    return clip, float(found.error_rad.max())


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
