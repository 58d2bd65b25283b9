"""Which coordinates move which bones, and which part of the body each belongs to."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import Chain
from azee_rig.coordinates import Coordinates


class Part(Enum):
    """Parts of the body that problems may move one after the other."""

    TRUNK = "trunk"
    HEAD = "head"
    EYES = "eyes"
    ARM = "arm"
    HAND = "hand"


_PARTS = {
    "back": Part.TRUNK,
    "neck": Part.HEAD,
    "head": Part.HEAD,
    "eye": Part.EYES,
    "clav": Part.ARM,
    "arm": Part.ARM,
    "f": Part.ARM,
    "palm": Part.ARM,
    "thumb": Part.HAND,
    "index": Part.HAND,
    "middle": Part.HAND,
    "ring": Part.HAND,
    "little": Part.HAND,
}
"""By the first word of AZee's bone names."""


def part_of(bone: str) -> Part:
    """Part of the body that a bone or a coordinate belongs to, by its name."""
    return _PARTS[bone.split(".")[0].split("_")[0]]


class Anatomy:
    """Structure of a chain, for asking what a constraint can depend on.

    moves: (B, V), whether a coordinate changes the frame of a node.
    """

    def __init__(self, chain: Chain, coordinates: Coordinates) -> None:
        self.names = coordinates.names
        count = len(chain.names)
        self.moves: NDArray[np.bool_] = np.zeros((count, len(coordinates)), dtype=np.bool_)
        self._own: list[frozenset[int]] = []
        self._parents = chain.parents
        for b, parent in enumerate(chain.parents):
            own = chain.dof_coordinate[chain.dof_start[b] : chain.dof_start[b + 1]]
            self._own.append(frozenset(int(v) for v in own))
            if parent >= 0:
                self.moves[b] = self.moves[parent]
            self.moves[b, own] = True
        self.parts = tuple(part_of(name) for name in self.names)
        self._of = {p: frozenset(v for v, q in enumerate(self.parts) if q is p) for p in Part}

    def of(self, *parts: Part) -> frozenset[int]:
        """Coordinates of parts of the body."""
        return frozenset().union(*(self._of[part] for part in parts))

    def moved_by(self, coordinates: Iterable[int]) -> NDArray[np.bool_]:
        """Tell for each node whether any of some coordinates moves it, (B,)."""
        return np.asarray(self.moves[:, sorted(coordinates)].any(axis=1), dtype=np.bool_)

    def above(self, node: int) -> frozenset[int]:
        """Coordinates that move a node."""
        return frozenset(np.flatnonzero(self.moves[node]).tolist())

    def below(self, ancestor: int, node: int) -> frozenset[int]:
        """Coordinates that move a node relative to one of its ancestors (or to itself: none)."""
        found: set[int] = set()
        while node != ancestor:
            found |= self._own[node]
            node = int(self._parents[node])
        return frozenset(found)

    def carried(self, node: int) -> frozenset[int]:
        """Coordinates of the joints beyond a node: they turn what it carries, not the node."""
        return frozenset(
            v
            for n in range(node + 1, len(self._own))
            if self.is_above(node, n)
            for v in self._own[n]
        )

    def is_above(self, ancestor: int, node: int) -> bool:
        """Whether a node is an ancestor of another, or the same."""
        while node > ancestor:
            node = int(self._parents[node])
        return node == ancestor

    def common(self, nodes: Iterable[int]) -> int:
        """Deepest node above all the given ones, or −1."""
        common: int | None = None
        for node in nodes:
            if common is None:
                common = node
            while common >= 0 and not self.is_above(common, node):
                common = int(self._parents[common])
        return -1 if common is None else common


@lru_cache(maxsize=16)
def anatomy(chain: Chain, coordinates: Coordinates) -> Anatomy:
    """Return the anatomy of a body, worked out once."""
    return Anatomy(chain, coordinates)
