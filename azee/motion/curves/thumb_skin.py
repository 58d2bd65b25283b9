"""What the skin says of a way that capsules call free: how deep a thumb is in fingers on it.

Capsules do not hold all of the skin. Where a thumb touches a finger in a handshape, its capsule is
up to 10 mm inside that of the finger while the skins only touch, and a frame later the capsules are
as deep and the skins 5 mm. So a search on capsules alone leads thumbs through the skin of fingers.
The skin of its answer is measured; where it is too deep, the capsules there must be farther apart
than they are by as much, and the search goes on.

Fingers lie side by side, and no way led them into each other: only thumbs are looked at.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.curves.capsule_overlap import CapsuleOverlaps
from azee.motion.curves.offset_search import TAPER
from azee_rig.rig import Rig
from azee_solver.digit_skin import DigitSkin, digit_skin

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

NEAR_M = -0.001
"""The skin is measured where the capsules of a thumb and a finger are no farther apart."""
SHALLOW_M = 0.001
"""Skins may be so deep in each other on the way, and as deep as in the handshapes beside these."""
ALIKE_M = 0.003
"""Of the capsules of a thumb and a finger, those that are less deep than the deepest by no more
than this may be what the skin is in."""
BESIDE = (0.5, 1.0, 0.5)
"""How far capsules are parted in the sample before, in the one of the skin, and in the next."""
FARTHER = 1.2
"""Times what the skin is too deep by."""


@dataclass(frozen=True, slots=True, eq=False)
class ThumbSkin:
    """The thumb of one hand, and its fingers.

    finger: (P,) the finger that each pair of capsules parts from the thumb, −1 for other pairs.
    """

    skin: DigitSkin
    finger: Ints

    @staticmethod
    def of(rig: Rig, overlaps: CapsuleOverlaps, pairs: Ints, side: str) -> ThumbSkin:
        """Return that of one hand, whose pairs of capsules are those of the indices `pairs`."""
        skin = digit_skin(rig, side)
        order = {finger: k for k, finger in enumerate(skin.fingers)}
        finger = []
        for pair in pairs.tolist():
            digits = [name.rpartition("_")[0] for name in overlaps.names(pair)]
            parted = [order[d] for d in digits if d in order]
            finger.append(parted[0] if f"thumb_{side}" in digits and parted else -1)
        return ThumbSkin(skin, np.array(finger, dtype=np.int64))

    def near(self, depths: Array) -> NDArray[np.bool_]:
        """Return where skins could touch, (T, F), as capsules are so deep, (T, P)."""
        out = np.zeros((len(depths), len(self.skin.fingers)), dtype=np.bool_)
        for k in range(out.shape[1]):
            of_finger = depths[:, self.finger == k]
            out[:, k] = (of_finger > NEAR_M).any(axis=1)
        return out

    def depths(self, q: Array, capsules: Array) -> Array:
        """Return how deep skins are in each other, (T, F) metres.

        Args: q: (T, V). capsules: (T, P) how deep these are.
        """
        return self.skin.depths(q, self.near(capsules))

    def allowed(self, ends: Array, samples: int) -> Array:
        """Return how deep skins may be on a way, (T, F) metres.

        Beside the ends as deep as there, (2, F), and less by minimum jerk within the share `TAPER`.
        """
        along = np.linspace(0.0, 1.0, samples)[:, None]
        leaving = ends[0] * (1.0 - minimum_jerk(along / TAPER))
        arriving = ends[1] * (1.0 - minimum_jerk((1.0 - along) / TAPER))
        return np.asarray(np.maximum(SHALLOW_M, np.maximum(leaving, arriving)))

    def parted(self, allowed: Array, capsules: Array, excess: Array) -> Array:
        """Return how deep capsules may be where skins are too deep, (T, P) metres.

        Args: allowed: (T, P) as it was. capsules: (T, P) how deep these are. excess: (T, F) by how
            much skins are too deep.
        """
        out, inner = allowed.copy(), range(1, len(allowed) - 1)
        for t, k in np.argwhere(excess > 0.0).tolist():
            pairs = np.flatnonzero(self.finger == k)
            pairs = pairs[capsules[t, pairs] > capsules[t, pairs].max() - ALIKE_M]
            for beside, share in zip((t - 1, t, t + 1), BESIDE, strict=True):
                if beside in inner:
                    apart = capsules[beside, pairs] - share * FARTHER * excess[t, k]
                    out[beside, pairs] = np.minimum(out[beside, pairs], apart)
        return out
