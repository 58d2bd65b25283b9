"""The kinematic chain that inverse kinematics moves: AZee bones coupled to the body's joints.

Every node has a frame whose columns are x, dir and nrm (x = dir × nrm). Its rotation is

    R_node = R_parent · zero_node · Π_d rot(axis_d, scale_d · q[coordinate_d])

over its degrees of freedom in order, and its origin R_parent · offset_node + p_parent. One
coordinate may drive several nodes with a share each, as those of the trunk are spread over the
spine.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from azee_rig.skeleton import frozen

X, DIR, NRM = 0, 1, 2
"""Columns of a node's frame."""


@dataclass(frozen=True, eq=False)
class Frames:
    """World frames of all nodes: positions (…, B, 3) metres, rotations (…, B, 3, 3)."""

    positions: NDArray[np.float64]
    rotations: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Chain:
    """Nodes of the chain, parents before children, as flat arrays that kernels can read.

    names: (B,). parents: (B,), −1 for the root. offsets: (B, 3) in the parent's frame, metres.
    zero: (B, 3, 3) frame in the parent's at q = 0. dof_start: (B + 1,) node b has the degrees of
    freedom dof_start[b] … dof_start[b + 1] − 1. dof_axis: (D,) column 0, 1 or 2. dof_scale: (D,)
    sign and share. dof_coordinate: (D,) index into the coordinates.
    """

    names: tuple[str, ...]
    parents: NDArray[np.int64]
    offsets: NDArray[np.float64]
    zero: NDArray[np.float64]
    dof_start: NDArray[np.int64]
    dof_axis: NDArray[np.int64]
    dof_scale: NDArray[np.float64]
    dof_coordinate: NDArray[np.int64]

    def __post_init__(self) -> None:
        for name in ("parents", "dof_start", "dof_axis", "dof_coordinate"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.int64))
        for name in ("offsets", "zero", "dof_scale"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64))

    def frames(self, q: NDArray[np.float64]) -> Frames:
        """Forward kinematics of one posture or many.

        Args: q: (…, V) coordinates, radians.
        """
        q = np.asarray(q, dtype=np.float64)
        batch, count = q.shape[:-1], len(self.names)
        positions = np.empty((*batch, count, 3))
        rotations = np.empty((*batch, count, 3, 3))
        local = np.broadcast_to(self.zero, (*batch, count, 3, 3)).copy()
        for nodes, turns in self._rounds:
            _turn(
                local,
                nodes,
                self.dof_axis[turns],
                self.dof_scale[turns] * q[..., self.dof_coordinate[turns]],
            )
        for nodes in self._generations:
            parents = self.parents[nodes]
            if parents[0] < 0:
                positions[..., nodes, :] = self.offsets[nodes]
                rotations[..., nodes, :, :] = local[..., nodes, :, :]
                continue
            R = rotations[..., parents, :, :]
            positions[..., nodes, :] = (
                positions[..., parents, :] + (R @ self.offsets[nodes][:, :, None])[..., 0]
            )
            rotations[..., nodes, :, :] = R @ local[..., nodes, :, :]
        return Frames(positions, rotations)

    @cached_property
    def _rounds(self) -> list[tuple[NDArray[np.int64], NDArray[np.int64]]]:
        """Nodes with a first, a second and a third degree of freedom, and these degrees."""
        counts = np.diff(self.dof_start)
        rounds = []
        for k in range(int(counts.max(initial=0))):
            nodes = np.flatnonzero(counts > k)
            rounds.append((nodes, self.dof_start[nodes] + k))
        return rounds

    @cached_property
    def _generations(self) -> list[NDArray[np.int64]]:
        """Nodes by the number of their ancestors: one generation can be computed at once."""
        depth = np.zeros(len(self.parents), dtype=np.int64)
        for node, parent in enumerate(self.parents):
            depth[node] = depth[parent] + 1 if parent >= 0 else 0
        return [np.flatnonzero(depth == d) for d in range(int(depth.max(initial=0)) + 1)]


def _turn(
    R: NDArray[np.float64],
    nodes: NDArray[np.int64],
    axis: NDArray[np.int64],
    angle: NDArray[np.float64],
) -> None:
    """R ← R · rot(axis, angle) for some nodes, in place: only the two other columns change.

    Args: R: (…, B, 3, 3). nodes, axis: (n,). angle: (…, n).
    """
    c, s = np.cos(angle)[..., None], np.sin(angle)[..., None]
    j, k = (axis + 1) % 3, (axis + 2) % 3
    columns = np.swapaxes(R, -1, -2)
    u, w = columns[..., nodes, j, :], columns[..., nodes, k, :]
    columns[..., nodes, j, :] = c * u + s * w
    columns[..., nodes, k, :] = c * w - s * u
