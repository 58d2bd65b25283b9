"""How the joints of a body follow the chain: whole nodes, shared twist, shared bends.

A joint takes the rotation of one node, counted from the posture in which the mesh was modelled, so
that the mesh is unchanged in this posture. Two refinements keep skin from collapsing; BVH and glTF
can play both:

- twist: a joint of a limb leaves out a part of the turn about the limb's axis, so that pronation is
  spread along the forearm instead of twisting one joint;
- helpers: a helper joint turns by a share of its neighbour's bend, and carries the skin in between.

The chain gives the places of joints: twisted joints lie on their limb's axis, helpers at their
neighbour's origin.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import DIR, Chain
from azee_rig.rotation import about_axis, part_turn, to_quaternions
from azee_rig.skeleton import Pose, Skeleton, frozen

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Drive:
    """What drives each of the J joints.

    node: (J,) node whose rotation the joint takes; −1 for a joint that stays in the rest pose.
    twist_coordinate: (J,) coordinate of the turn that is partly left out; −1 for none.
    twist_left_out: (J,) signed share of it that is left out.
    helper_of: (J,) joint whose bend a helper shares, both with the same parent; −1 for others.
    helper_share: (J,) share of that bend, 0 … 1.
    bind: (B, 3, 3) frames of the nodes in the mesh's own posture.
    """

    node: NDArray[np.int64]
    twist_coordinate: NDArray[np.int64]
    twist_left_out: Floats
    helper_of: NDArray[np.int64]
    helper_share: Floats
    bind: Floats

    def __post_init__(self) -> None:
        for name in ("node", "twist_coordinate", "helper_of"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.int64))
        for name in ("twist_left_out", "helper_share", "bind"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64))

    def pose(self, q: Floats, bind_q: Floats, chain: Chain, skeleton: Skeleton) -> Pose:
        """Local rotations of the body's joints for coordinates q (…, V), radians."""
        q = np.asarray(q, dtype=np.float64)
        return self.posed(chain.frames(q).rotations, q, bind_q, skeleton)

    def posed(self, nodes: Floats, q: Floats, bind_q: Floats, skeleton: Skeleton) -> Pose:
        """Local rotations of the joints for rotations of the nodes (…, B, 3, 3) in q (…, V)."""
        batch = q.shape[:-1]
        world = np.empty((*batch, len(self.node), 3, 3))
        local = np.empty_like(world)
        for j, n in enumerate(self.node):
            p = skeleton.parents[j]
            if self.helper_of[j] >= 0:
                continue
            if n < 0:
                world[..., j, :, :] = np.eye(3) if p < 0 else world[..., p, :, :]
            else:
                R = nodes[..., n, :, :]
                c = self.twist_coordinate[j]
                if c >= 0:
                    R = R @ about_axis(DIR, -self.twist_left_out[j] * (q[..., c] - bind_q[c]))
                world[..., j, :, :] = R @ self.bind[n].T
            local[..., j, :, :] = (
                world[..., j, :, :]
                if p < 0
                else np.swapaxes(world[..., p, :, :], -1, -2) @ world[..., j, :, :]
            )
        rotations = to_quaternions(local[..., self.helper_of < 0, :, :])
        out = np.empty((*batch, len(self.node), 4))
        out[..., self.helper_of < 0, :] = rotations
        for helper in np.flatnonzero(self.helper_of >= 0):
            bend = out[..., self.helper_of[helper], :]
            out[..., helper, :] = part_turn(bend, self.helper_share[helper])
        return Pose(np.zeros((*batch, 3)), out)
