"""Forward kinematics of the body's joints, and linear blend skinning (Gürel 2010, §4.2.2)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from azee_rig.machine_code import Kernel
from azee_rig.mesh import BodyMesh
from azee_rig.rotation import to_matrices
from azee_rig.skeleton import Pose, Skeleton

Floats = NDArray[np.float64]

_BLENDED = Kernel("azee_rig.skin_kernel", "blended", "azee_rig.pointers")


def joint_frames(skeleton: Skeleton, pose: Pose) -> tuple[Floats, Floats]:
    """World positions (…, J, 3) and rotations (…, J, 3, 3) of the joints of one posture or many."""
    local = to_matrices(pose.rotations)
    world = np.empty_like(local)
    positions = np.empty(local.shape[:-1])
    for j, p in enumerate(skeleton.parents):
        if p < 0:
            world[..., j, :, :] = local[..., j, :, :]
            positions[..., j, :] = skeleton.offsets[j] + pose.root_translation
        else:
            parent = world[..., p, :, :]
            world[..., j, :, :] = parent @ local[..., j, :, :]
            positions[..., j, :] = positions[..., p, :] + parent @ skeleton.offsets[j]
    return positions, world


def skin(
    mesh: BodyMesh, skeleton: Skeleton, pose: Pose, unit_weights: Floats | None = None
) -> Floats:
    """Return vertices (N, 3) of a posture: shapes, then v' = Σ_j w_j (R_j (v − p̄_j) + p_j).

    p̄_j is joint j's place in the rest pose, where every joint's axes are the world's.

    Args: unit_weights: (U,) weights of the face units, in the mesh's order.
    """
    positions, rotations = joint_frames(skeleton, pose)
    shaped = mesh.vertices if unit_weights is None else mesh.shaped(unit_weights)
    skins = blended(shaped, mesh.joints, mesh.weights, skeleton, positions[None], rotations[None])
    return np.asarray(skins[0])


def blended(
    vertices: Floats,
    joints: NDArray[np.int64],
    weights: Floats,
    skeleton: Skeleton,
    positions: Floats,
    rotations: Floats,
) -> Floats:
    """Return vertices in T postures, (T, N, 3).

    Args: vertices: (N, 3) in the rest pose. joints, weights: (N, K). positions: (T, J, 3).
        rotations: (T, J, 3, 3), of the joints in the world.
    """
    shift = positions - (rotations @ skeleton.rest_positions[:, :, None])[..., 0]
    transforms = np.concatenate([rotations, shift[..., None]], axis=-1)
    count, influences = joints.shape
    out = np.empty((len(transforms), count, 3))
    for of_posture, skin_of_posture in zip(transforms, out, strict=True):
        _BLENDED(
            count, influences, len(of_posture), vertices, joints, weights,
            of_posture, skin_of_posture,
        )  # fmt: skip
    return out
