"""A part of a body's skin, such as the digits of a hand, posed without the rest of the body.

Only the joints that carry the part are posed, from the one that they all hang on. Where that is in
the world is left out: the part is where it would be if this joint were at its rest position. So
only distances inside the part have a meaning.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_rig.drive import Drive
from azee_rig.skeleton import Skeleton
from azee_rig.skin import blended, joint_frames

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class SkinPart:
    """Some vertices of a body's mesh, (n,) indices in increasing order."""

    def __init__(self, rig: Rig, vertices: Ints) -> None:
        self._rig = rig
        joints = _carriers(rig, vertices)
        new = np.full(len(rig.skeleton.names), -1, dtype=np.int64)
        new[joints] = np.arange(len(joints))
        parents = rig.skeleton.parents[joints]
        offsets = np.array(rig.skeleton.offsets[joints])
        offsets[0] = rig.skeleton.rest_positions[joints[0]]
        self._skeleton = Skeleton(
            tuple(rig.skeleton.names[j] for j in joints),
            np.where(parents < 0, -1, new[parents]),
            offsets,
        )
        drive = rig.drive
        helped = drive.helper_of[joints]
        self._drive = Drive(
            drive.node[joints],
            drive.twist_coordinate[joints],
            drive.twist_left_out[joints],
            np.where(helped < 0, -1, new[helped]),
            drive.helper_share[joints],
            drive.bind,
        )
        self._vertices: Floats = rig.mesh.vertices[vertices]
        self._weights: Floats = rig.mesh.weights[vertices]
        carried = self._weights > 0.0
        self._joints: Ints = np.where(carried, new[rig.mesh.joints[vertices]], 0)

    def skin(self, q: Floats, nodes: Floats) -> Floats:
        """Return the vertices in postures, (T, n, 3) metres, in the axes of the world.

        Args: q: (T, V). nodes: (T, B, 3, 3) rotations of the chain's nodes in them.
        """
        pose = self._drive.posed(nodes, q, self._rig.coordinates.bind, self._skeleton)
        positions, rotations = joint_frames(self._skeleton, pose)
        return blended(
            self._vertices, self._joints, self._weights, self._skeleton, positions, rotations
        )


def _carriers(rig: Rig, vertices: Ints) -> Ints:
    """Return the joints that carry vertices, with those between them and the one they hang on."""
    parents, helper_of = rig.skeleton.parents, rig.drive.helper_of
    carriers = {*np.unique(rig.mesh.joints[vertices][rig.mesh.weights[vertices] > 0.0]).tolist()}
    carriers |= {int(helper_of[j]) for j in carriers if helper_of[j] >= 0}
    above = {j: _path(parents, j) for j in carriers}
    common = set.intersection(*map(set, above.values()))
    top = max(common)
    return np.array(sorted({a for path in above.values() for a in path if a >= top}))


def _path(parents: Ints, joint: int) -> list[int]:
    """Return a joint and those that it hangs on."""
    path = [joint]
    while (above := int(parents[path[-1]])) >= 0:
        path.append(above)
    return path
