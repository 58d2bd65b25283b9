"""Helper joints that share a bend, so that skin keeps its volume at large bends.

Each helper lies beside the joint that bends and takes a share of its turn. Skin that both sides of
the bend pull at lies between the two helpers whose turns are nearest to its own. With four steps
instead of one, skin on the outside of a bend of 145° keeps 95 % of its distance from the axis, not
30 %.

Flesh that a crease displaces has to move elsewhere. Joints here only rotate, since every format can
play rotations. But a helper that rotates about a point beside the axis moves its skin outward.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.build.chain_builder import BuiltChain
from azee_rig.chain import NRM
from azee_rig.coordinates import Coordinates
from azee_rig.rotation import part_turn, to_matrices, to_quaternions

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Bend:
    """Helpers that share the bend of a joint evenly.

    joint: the one that bends. near: joints that carry the skin before the bend.
    helpers: names, and how far each moves its skin outward at the largest bend of the joint,
        metres; the k-th of n takes k / (n + 1) of the bend.
    bone: the AZee bone that the joint belongs to.
    """

    joint: str
    bone: str
    near: tuple[str, ...]
    helpers: Mapping[str, float]

    @property
    def shares(self) -> dict[str, float]:
        """Shares of the bend per helper."""
        return {h: k / (len(self.helpers) + 1) for k, h in enumerate(self.helpers, start=1)}

    def pivots(self, built: BuiltChain, coordinates: Coordinates) -> dict[str, Floats]:
        """Return the pivots of the helpers, metres from the joint, in the mesh's posture.

        At the largest flexion, a helper has turned by S from the mesh's posture. To have moved its
        skin by d then, it turns about the place p that solves (1 − S) p = d. d points away from the
        crease; the bend rotates its direction by the helper's share.
        """
        if not any(self.helpers.values()):
            return {helper: np.zeros(3) for helper in self.helpers}
        chain, node = built.chain, built.bones[self.bone].node
        flexion = coordinates.index[f"{self.bone}.flexion"]

        def turned(angle: float) -> Floats:
            q = np.array(coordinates.bind)
            q[flexion] = angle
            return np.asarray(chain.frames(q).rotations[node])

        utmost = float(coordinates.upper[flexion])
        crease = chain.frames(coordinates.bind).rotations[chain.parents[node], :, NRM]
        bend = to_quaternions(turned(utmost) @ turned(0.0).T)
        bent = to_quaternions(turned(utmost) @ turned(float(coordinates.bind[flexion])).T)
        out = {}
        for helper, share in self.shares.items():
            outward = -to_matrices(part_turn(bend, share)) @ crease
            moved = np.eye(3) - to_matrices(part_turn(bent, share))
            out[helper] = self.helpers[helper] * np.linalg.pinv(moved, rcond=1e-6) @ outward
        return out


def share_bend(weights: Floats, near: Sequence[int], steps: Sequence[int]) -> None:
    """Assign skin that both sides of a bend pull at to the two helpers with the nearest turns.

    Skin keeps the share of the bend that it had.

    Args: weights: (N, J), changed. near: columns of the joints before the bend, whose remaining
        weights keep their proportions. steps: columns of the helpers, then of the joint that bends.
    """
    before = weights[:, near].sum(axis=1)
    both = before + weights[:, steps[-1]]
    share = weights[:, steps[-1]] / np.where(both > 0.0, both, 1.0)
    hats = both[:, None] * between(share, np.linspace(0.0, 1.0, len(steps) + 1))
    weights[:, near] *= (hats[:, 0] / np.where(before > 0.0, before, 1.0))[:, None]
    weights[:, steps] = hats[:, 1:]


def between(x: Floats, knots: Floats) -> Floats:
    """Return weights (n, k) of linear interpolation at x (n,) between k knots, constant beyond."""
    return np.stack([np.interp(x, knots, row) for row in np.eye(len(knots))], axis=1)
