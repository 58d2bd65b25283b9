"""How deep the thumb is in the fingers of its hand, on the skin, in many postures at once.

Capsules do not hold all of the skin: a thumb whose capsule just touches that of a finger may be
5 mm inside it. `mesh_penetration` is exact; this is quick. A vertex is inside a digit if it is
behind the nearest vertex of the digit's surface, along this one's normal; that distance is its
depth. Between vertices, which lie 3 mm apart, a surface of 8 mm radius bends by 0.1 mm.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_rig.machine_code import Kernel
from azee_rig.mesh import vertex_normals
from azee_rig.skin_part import SkinPart
from azee_solver import kinematics
from azee_solver.penetration import DIGITS, skin_regions

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

DEEPEST_M = 0.01
"""Nothing is deeper inside a finger: what is farther from its surface is beside it."""
_DEEPEST = np.array([DEEPEST_M])
_BEHIND = Kernel("azee_solver.surfaces", "behind", "azee_rig.pointers")


@dataclass(frozen=True, slots=True, eq=False)
class _Digit:
    """Vertices of a digit's surface, (n,), and those of them that lie beyond the web, (m,)."""

    rows: Ints
    beyond_web: Ints


class DigitSkin:
    """The skin of the digits of one hand.

    fingers: those that there are beside the thumb, such as `index_R`.
    """

    def __init__(self, rig: Rig, side: str) -> None:
        regions = skin_regions(rig)
        names = [name for digit in DIGITS if (name := f"{digit}_{side}") in regions.limbs]
        surfaces = {name: regions.surfaces[name] for name in names if name in regions.surfaces}
        self._thumb_name = f"thumb_{side}"
        self.fingers = tuple(n for n in surfaces if n != self._thumb_name)
        if self._thumb_name not in surfaces or not self.fingers:
            self.fingers = ()
            return
        vertices = np.unique(np.concatenate([t.ravel() for t in surfaces.values()]))
        triangles = np.concatenate([*surfaces.values()])
        self._chain, self._part = rig.chain, SkinPart(rig, vertices)
        self._triangles: Ints = np.searchsorted(vertices, triangles)
        self._digits = {
            name: _Digit(
                np.searchsorted(vertices, regions.corners[name]),
                np.searchsorted(
                    vertices,
                    np.intersect1d(regions.corners[name], regions.limbs[name].beyond_web),
                ),
            )
            for name in surfaces
        }

    def depths(self, q: Array, near: Flags | None = None) -> Array:
        """Return how deep the thumb and each finger are in each other, (T, F) metres, 0 if apart.

        Against its own hand only skin beyond the web counts, as in `mesh_penetration`.

        Args: q: (T, V). near: (T, F), where to look; everywhere by default.
        """
        out = np.zeros((len(q), len(self.fingers)))
        look = np.ones(out.shape, dtype=np.bool_) if near is None else near
        rows = np.flatnonzero(look.any(axis=1))
        if not len(rows):
            return out
        thumb = self._digits[self._thumb_name]
        nodes = kinematics.frames(self._chain, q[rows]).rotations
        for t, skin in zip(rows.tolist(), self._part.skin(q[rows], nodes), strict=True):
            normals = vertex_normals(skin, self._triangles)
            for k in np.flatnonzero(look[t]).tolist():
                out[t, k] = _depth(skin, normals, thumb, self._digits[self.fingers[k]])
        return out


@lru_cache(maxsize=8)
def digit_skin(rig: Rig, side: str) -> DigitSkin:
    """Return the skin of the digits of one hand of a body."""
    return DigitSkin(rig, side)


def _depth(skin: Array, normals: Array, first: _Digit, second: _Digit) -> float:
    """Return how deep two digits are in each other, metres."""
    return max(_inside(skin, normals, *pair) for pair in ((first, second), (second, first)))


def _inside(skin: Array, normals: Array, digit: _Digit, other: _Digit) -> float:
    """Return how deep skin of a digit is in another one, metres."""
    out = np.zeros(1)
    points, surface = digit.beyond_web, other.rows
    _BEHIND(
        *(len(skin), len(points), len(surface)),
        *(skin, normals, points, surface, _DEEPEST, out),
    )
    return float(out[0])
