"""Joint angles of a hand from 21 landmarks in MediaPipe's order, as decomposition needs them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

FINGERS = ("index", "middle", "ring", "little")
JOINTS = (
    *(f"{finger}_{joint}" for finger in FINGERS for joint in ("mcp", "pip", "dip")),
    "thumb_mcp",
    "thumb_ip",
    "thumb_cmc",
    "index_middle_spread",
    "palm_tilt",
    "palm_turn",
)
"""Eighteen angles, as many as the joints of Wheatland's hand.

`palm_tilt` is how the hand leans in the picture, `palm_turn` where its palm looks: without them
H and U, G and Q, K and P, I and J are the same.
"""
LANDMARKS = 21
_WRIST, _THUMB = 0, (1, 2, 3, 4)
_CHAINS = ((5, 6, 7, 8), (9, 10, 11, 12), (13, 14, 15, 16), (17, 18, 19, 20))


def joint_angles(landmarks: ArrayLike) -> Array:
    """Return the angles of a hand in `JOINTS`' order.

    Args: landmarks: (..., 21, 3), x to the right, y down, z away from the camera, in one unit.
    Returns: (..., 18) radians. Flexions are 0 where a finger is straight; all lie in -π…π.
    """
    at = np.asarray(landmarks, dtype=np.float64)

    def way(a: int, b: int) -> Array:
        return np.asarray(at[..., b, :] - at[..., a, :])

    angles = []
    for chain in _CHAINS:
        links = [
            way(_WRIST, chain[0]),
            *(way(a, b) for a, b in pairwise(chain)),
        ]
        angles += [_between(u, v) for u, v in pairwise(links)]
    thumb = [way(_WRIST, _THUMB[0])]
    thumb += [way(a, b) for a, b in pairwise(_THUMB)]
    cmc, mcp, ip = (_between(u, v) for u, v in pairwise(thumb))
    up = way(_WRIST, _CHAINS[1][0])
    normal = np.cross(way(_WRIST, _CHAINS[0][0]), way(_WRIST, _CHAINS[3][0]))
    spread = _signed(way(*_CHAINS[0][:2]), way(*_CHAINS[1][:2]), normal)
    tilt = np.arctan2(up[..., 0], -up[..., 1])
    turn = np.arctan2(normal[..., 0], normal[..., 2])
    return np.stack([*angles, mcp, ip, cmc, spread, tilt, turn], axis=-1)


def _between(u: Array, v: Array) -> Array:
    crossed = np.linalg.norm(np.cross(u, v), axis=-1)
    return np.asarray(np.arctan2(crossed, (u * v).sum(axis=-1)))


def _signed(u: Array, v: Array, normal: Array) -> Array:
    """Angle from u to v about a normal, (...); seen along it."""
    n = normal / np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-12)
    return np.asarray(np.arctan2((np.cross(u, v) * n).sum(axis=-1), (u * v).sum(axis=-1)))
