"""The joints of a body that its rig keeps, with their skin; all others are merged upwards."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee_rig.importing.bone_map import BoneMap
from azee_rig.importing.skeleton_tree import Tree

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Reduced:
    """Kept joints, parents first: names, parents (K,), places (K, 3); weights (N, K) on them."""

    names: tuple[str, ...]
    parents: Ints
    places: Floats
    weights: Floats

    def place(self, joint: str) -> Floats:
        """Return the place of a joint, (3,)."""
        return np.asarray(self.places[self.names.index(joint)])

    def held(self, joints: Sequence[str], at_least: float = 0.5) -> NDArray[np.bool_]:
        """Return which vertices some joints together carry by at least a share, (N,)."""
        columns = [self.names.index(j) for j in joints]
        return np.asarray(self.weights[:, columns].sum(axis=1) >= at_least)

    def with_joint(
        self, name: str, parent: str, place: Floats, taken: NDArray[np.bool_]
    ) -> Reduced:
        """Return it with one more joint, which alone carries some vertices (N,)."""
        weights = np.pad(self.weights, ((0, 0), (0, 1)))
        weights[taken] = 0.0
        weights[taken, -1] = 1.0
        parents = np.append(self.parents, self.names.index(parent))
        return Reduced((*self.names, name), parents, np.vstack([self.places, place]), weights)


def reduce_joints(
    tree: Tree, bones: BoneMap, places: Floats, influences: Ints, weights: Floats
) -> Reduced:
    """Keep the joints of the bones-map and of the legs; their skin includes that of all others.

    Args: places: (J, 3). influences, weights: (N, k) of the vertices.
    """
    index = {name: j for j, name in enumerate(tree.names)}
    root = index[bones.root]
    wanted = {root, *(index[j] for j in _all(bones))}
    above_root = set(tree.path(root)[:-1]) - wanted
    kept = [j for j in range(len(tree.names)) if j in wanted]
    kept.sort(key=lambda j: (j != root, int(tree.depth[j])))
    column = {j: k for k, j in enumerate(kept)}
    of = np.zeros(len(tree.names), np.int64)
    for j in range(len(tree.names)):
        up = int(tree.parents[j])
        of[j] = column[j] if j in column else (of[up] if up >= 0 and j not in above_root else 0)
    parents = [-1 if j == root else int(of[int(tree.parents[j])]) for j in kept]
    dense = np.zeros((len(weights), len(kept)))
    rows = np.arange(len(weights))
    for k in range(weights.shape[1]):
        np.add.at(dense, (rows, of[influences[:, k]]), weights[:, k])
    return Reduced(tree.named(kept), np.array(parents), places[kept], dense)


def _all(bones: BoneMap) -> list[str]:
    groups: list[Mapping[str, Sequence[str]]] = [bones.bones, bones.twists]
    return [j for group in groups for chain in group.values() for j in chain] + list(bones.kept)
