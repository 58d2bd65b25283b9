"""A recording as the vector of parameters of Gürel 2010, section 3.2.1.

A sign is P = S(t). With J joints P has 3 + 3J parameters: the place of the root, p₁ to p₃, and for
each joint i from 1 on, in degrees, θz = p₃ᵢ₊₁, θx = p₃ᵢ₊₂ and θy = p₃ᵢ₊₃. The signer of the thesis
has 40 joints and 123 parameters. The rotation of a joint in its parent's frame is L = Lz Lx Ly, and
in the world G = G(parent) L; the thesis prints this product transposed.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee.clip.recording import Recording
from azee_rig.rotation import to_matrices

Array = NDArray[np.float64]


def parameters(recording: Recording) -> Array:
    """Return P of all frames, (T, 3 + 3J): metres, then degrees."""
    R = to_matrices(recording.rotations)
    z = np.arctan2(-R[..., 0, 1], R[..., 1, 1])
    x = np.arcsin(np.clip(R[..., 2, 1], -1.0, 1.0))
    y = np.arctan2(-R[..., 2, 0], R[..., 2, 2])
    angles = np.degrees(np.stack([z, x, y], axis=-1)).reshape(len(R), -1)
    root = int(np.flatnonzero(recording.skeleton.parents < 0)[0])
    return np.hstack([recording.translations[:, root], angles])
