"""How near parts of the body may come to each other in the frames of a movement.

Key postures decide what overlaps: a hand whose place lies in a fold of the body, or that the margin
around the trunk would push off it. Frames that press such parts apart would miss, between keys,
what the keys meet.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from azee.motion.keys.residual_monitor import SAME_S
from azee.motion.tasks.limbs import TRUNK
from azee_rig.rig import Rig
from azee_solver.broadphase import Collisions
from azee_solver.kinematics import Parting

Array = NDArray[np.float64]

SWAY_M = 0.0015
"""Added to the margin that arms and hands keep from the trunk."""
MOST_OVERLAP_M = 0.002
"""So deep at most may overlap what overlaps in a key posture beside a frame. Without a bound, a
third more signs of a lexicon had frames with more than 3 mm."""

_NO_COORDINATES = np.empty(0, dtype=np.int64)


def keys_beside(keys_s: Array, times_s: Array) -> list[tuple[int, ...]]:
    """Return which keys are the last before instants (T,) and the first after them, or at them."""
    before = np.searchsorted(keys_s, times_s + SAME_S, side="right") - 1
    after = np.searchsorted(keys_s, times_s - SAME_S)
    pairs = zip(before.tolist(), after.tolist(), strict=True)
    return [tuple(sorted({k for k in pair if 0 <= k < len(keys_s)})) for pair in pairs]


def in_frames(rig: Rig, collisions: Collisions, keys: Sequence[Array]) -> Collisions:
    """Return what frames keep apart between key postures (V,).

    What is kept away from the trunk is kept a little farther away, for bodies sway; what is nearer
    in a key posture may be as near, but overlaps no deeper than `MOST_OVERLAP_M`.
    """
    farther = _farther(rig, collisions)
    if not keys:
        return farther
    depths, _ = Parting(rig, farther.pairs).depths(np.stack(keys), farther.reach, _NO_COORDINATES)
    wish = farther.reach - collisions.reach + collisions.margin
    nearer = np.clip(depths.max(axis=0), 0.0, wish + MOST_OVERLAP_M)
    if not nearer.any():
        return farther
    return Collisions(farther.pairs, farther.reach - nearer, farther.margin)


@lru_cache(maxsize=256)
def _farther(rig: Rig, collisions: Collisions) -> Collisions:
    of_trunk = np.array([name.startswith(TRUNK) for name in rig.capsules.names])
    trunk = of_trunk[collisions.pairs].any(axis=1)
    farther = np.where(trunk & (np.asarray(collisions.margin) > 0.0), SWAY_M, 0.0)
    return Collisions(collisions.pairs, collisions.reach + farther, collisions.margin)
