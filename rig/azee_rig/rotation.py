"""Rotations as matrices and as unit quaternions wxyz, for arrays of any leading shape."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def about_axis(axis: int, angle: Floats | float) -> Floats:
    """Matrices of a turn by `angle` radians (…) about coordinate axis 0, 1 or 2: (…, 3, 3)."""
    angle = np.asarray(angle, dtype=np.float64)
    R = np.zeros((*angle.shape, 3, 3))
    j, k = (axis + 1) % 3, (axis + 2) % 3
    R[..., axis, axis] = 1.0
    R[..., j, j] = R[..., k, k] = np.cos(angle)
    R[..., k, j] = np.sin(angle)
    R[..., j, k] = -R[..., k, j]
    return R


def to_quaternions(R: Floats) -> Floats:
    """Return unit quaternions wxyz with w ≥ 0 of rotation matrices (…, 3, 3).

    Of the four equivalent forms the one with the largest divisor is taken (Shepperd 1978), so
    that no angle loses precision.
    """
    d = np.diagonal(R, axis1=-2, axis2=-1)
    trace = d.sum(axis=-1, keepdims=True)
    squares = np.concatenate([1.0 + trace, 1.0 + 2.0 * d - trace], axis=-1)
    best = squares.argmax(axis=-1)
    x = R[..., 2, 1] - R[..., 1, 2]
    y = R[..., 0, 2] - R[..., 2, 0]
    z = R[..., 1, 0] - R[..., 0, 1]
    xy = R[..., 0, 1] + R[..., 1, 0]
    yz = R[..., 1, 2] + R[..., 2, 1]
    zx = R[..., 2, 0] + R[..., 0, 2]
    forms = np.stack(
        [
            np.stack([squares[..., 0], x, y, z], axis=-1),
            np.stack([x, squares[..., 1], xy, zx], axis=-1),
            np.stack([y, xy, squares[..., 2], yz], axis=-1),
            np.stack([z, zx, yz, squares[..., 3]], axis=-1),
        ],
        axis=-2,
    )
    q = np.take_along_axis(forms, best[..., None, None], axis=-2)[..., 0, :]
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    return np.asarray(np.where(q[..., :1] < 0.0, -q, q))


def to_matrices(q: Floats) -> Floats:
    """Rotation matrices (…, 3, 3) of unit quaternions wxyz (…, 4)."""
    w, x, y, z = np.moveaxis(np.asarray(q, dtype=np.float64), -1, 0)
    R = np.empty((*w.shape, 3, 3))
    R[..., 0, 0] = 1.0 - 2.0 * (y * y + z * z)
    R[..., 1, 1] = 1.0 - 2.0 * (z * z + x * x)
    R[..., 2, 2] = 1.0 - 2.0 * (x * x + y * y)
    R[..., 0, 1] = 2.0 * (x * y - w * z)
    R[..., 1, 0] = 2.0 * (x * y + w * z)
    R[..., 1, 2] = 2.0 * (y * z - w * x)
    R[..., 2, 1] = 2.0 * (y * z + w * x)
    R[..., 2, 0] = 2.0 * (z * x - w * y)
    R[..., 0, 2] = 2.0 * (z * x + w * y)
    return R


def part_turn(q: Floats, share: float, *, longer: bool = False) -> Floats:
    """Return rotations by a share, 0 … 1, of the angle about the same axes: quaternions, (…, 4).

    The shorter way is taken, for which q with w < 0 counts as −q, or the longer one.
    """
    q = np.where((q[..., :1] < 0.0) != longer, -q, q)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = share * np.arctan2(sine, q[..., :1])
    along = np.where(sine > 1e-12, np.sin(angle) / np.where(sine > 1e-12, sine, 1.0), share)
    return np.concatenate([np.cos(angle), along * q[..., 1:]], axis=-1)


def rotation_vectors(R: Floats) -> Floats:
    """Axis times angle of rotations (…, 3, 3), (…, 3); exact near 0, either sign at π."""
    v = np.stack(
        [R[..., 2, 1] - R[..., 1, 2], R[..., 0, 2] - R[..., 2, 0], R[..., 1, 0] - R[..., 0, 1]],
        axis=-1,
    )
    sine = np.linalg.norm(v, axis=-1, keepdims=True) / 2.0
    cosine = (np.trace(R, axis1=-2, axis2=-1)[..., None] - 1.0) / 2.0
    angle = np.arctan2(sine, cosine)
    return np.asarray(v / 2.0 * np.where(sine > 1e-9, angle / np.maximum(sine, 1e-9), 1.0))
