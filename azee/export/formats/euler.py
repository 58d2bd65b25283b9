"""Euler angles for BVH: exact at gimbal lock, and no jumps from one frame to the next."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

LOCKED = 1e-9
"""Below this half-angle length z and y turn about the same axis, to the accuracy of a double."""


@dataclass(frozen=True, eq=False)
class EulerZXY:
    """Rotations R = Rz(z) · Rx(x) · Ry(y), the order of the channels in our BVH files.

    angles: (T, …, 3) radians, in the order z, x, y; frames along the first axis.
    """

    angles: NDArray[np.float64]

    @classmethod
    def from_quaternions(
        cls, rotations: NDArray[np.float64], after: NDArray[np.float64] | None = None
    ) -> EulerZXY:
        """Take angles from unit quaternions wxyz, (T, …, 4).

        Args: after: angles (…, 3) of the frame before the first, if there is one.

        Multiplying the three half-angle quaternions out gives, with s = (z + y)/2,
        d = (z − y)/2 and h = x/2,

            w + x = (cos h + sin h) cos s        z + y = (cos h + sin h) sin s
            w − x = (cos h − sin h) cos d        z − y = (cos h − sin h) sin d

        So s, d and h come from one arctangent each, without the cancellation of an arcsine near
        ±90° (after Bernardes & Viollet 2022, for this order of axes). At x = +90° d is
        undetermined, at −90° s: it keeps its value of the frame before.

        Two triples and their full turns give the same rotation. Each frame takes the one nearest to
        the frame before.
        """
        w, x, y, z = np.moveaxis(np.asarray(rotations, dtype=np.float64), -1, 0)
        plus, minus = np.hypot(z + y, w + x), np.hypot(z - y, w - x)
        s, d = np.arctan2(z + y, w + x), np.arctan2(z - y, w - x)
        pitch = 2 * np.arctan2(plus, minus) - np.pi / 2
        angles = np.empty((*w.shape, 3))
        previous = np.zeros((*w.shape[1:], 3)) if after is None else after
        for t in range(len(w)):
            s_t = np.where(plus[t] < LOCKED, (previous[..., 0] + previous[..., 2]) / 2, s[t])
            d_t = np.where(minus[t] < LOCKED, (previous[..., 0] - previous[..., 2]) / 2, d[t])
            angles[t] = _nearest(np.stack([s_t + d_t, pitch[t], s_t - d_t], axis=-1), previous)
            previous = angles[t]
        return cls(angles)

    def quaternions(self) -> NDArray[np.float64]:
        """Return the rotations as unit quaternions wxyz, (T, …, 4)."""
        half = self.angles / 2
        (cz, cx, cy), (sz, sx, sy) = (
            np.moveaxis(np.cos(half), -1, 0),
            np.moveaxis(np.sin(half), -1, 0),
        )
        return np.stack(
            [
                cz * cx * cy - sz * sx * sy,
                cz * sx * cy - sz * cx * sy,
                cz * cx * sy + sz * sx * cy,
                sz * cx * cy + cz * sx * sy,
            ],
            axis=-1,
        )


def _nearest(angles: NDArray[np.float64], to: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the equivalent triples (…, 3) that are nearest to `to`."""
    other = angles * (1, -1, 1) + np.pi
    turn = 2 * np.pi
    angles, other = (a + turn * np.round((to - a) / turn) for a in (angles, other))
    closer = np.abs(other - to).sum(axis=-1) < np.abs(angles - to).sum(axis=-1) - LOCKED
    return np.where(closer[..., None], other, angles)
