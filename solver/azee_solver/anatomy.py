"""Which coordinates move which bones, and which part of the body each belongs to."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import Enum
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import Chain
from azee_rig.coordinates import Coordinates

Flags = NDArray[np.bool_]


class Part(Enum):
    """Parts of the body that problems may move one after the other."""

    TRUNK = "trunk"
    HEAD = "head"
    EYES = "eyes"
    ARM = "arm"
    HAND = "hand"

    __hash__ = object.__hash__


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

    followers: last joints of fingers, and the joint before, which they follow: one tendon bends
    both.
    paths: (B, B), whether the second node is the first or above it. owns: (B, V), whether a
    coordinate turns a node against its parent. moves: (B, V), whether it changes its frame.
    """

    def __init__(self, chain: Chain, coordinates: Coordinates) -> None:
        self.names = coordinates.names
        count = len(chain.names)
        self.paths: Flags = np.eye(count, dtype=np.bool_)
        self.owns: Flags = np.zeros((count, len(coordinates)), dtype=np.bool_)
        for b, parent in enumerate(chain.parents):
            self.owns[b, chain.dof_coordinate[chain.dof_start[b] : chain.dof_start[b + 1]]] = True
            if parent >= 0:
                self.paths[b] |= self.paths[parent]
        self.moves: Flags = self.paths @ self.owns
        self.parts = tuple(part_of(name) for name in self.names)
        self.followers = _followers(self.names)
        self._of = {p: frozenset(v for v, q in enumerate(self.parts) if q is p) for p in Part}

    def of(self, *parts: Part) -> frozenset[int]:
        """Coordinates of parts of the body."""
        return frozenset().union(*(self._of[part] for part in parts))

    def moved_by(self, coordinates: Iterable[int]) -> Flags:
        """Tell for each node whether any of some coordinates moves it, (B,)."""
        return np.asarray(self.moves[:, sorted(coordinates)].any(axis=1), dtype=np.bool_)

    def above(self, node: int) -> frozenset[int]:
        """Coordinates that move a node."""
        return _set(self.moves[node])

    def below(self, ancestor: int, node: int) -> frozenset[int]:
        """Coordinates that move a node relative to one of its ancestors, or to −1, the world."""
        between = self.paths[node] & ~self.paths[ancestor] if ancestor >= 0 else self.paths[node]
        return _set(between @ self.owns)

    def relative(self, first: NDArray[np.int64], second: NDArray[np.int64]) -> Flags:
        """Tell for pairs of nodes (P,) which coordinates move them against each other, (P, V)."""
        return np.asarray((self.paths[first] ^ self.paths[second]) @ self.owns)

    def carried(self, node: int) -> frozenset[int]:
        """Coordinates of the joints beyond a node: they turn what it carries, not the node."""
        beyond = self.paths[:, node].copy()
        beyond[node] = False
        return _set(beyond @ self.owns)

    def outwards(self, coordinates: frozenset[int]) -> int:
        """Rank parts of the body for solving: trunk, head and eyes, then limbs from their tips."""
        if not coordinates & self.of(Part.ARM, Part.HAND):
            return -len(self.paths)
        turned = self.owns[:, sorted(coordinates)].any(axis=1)
        return -int(self.paths[turned].sum(axis=1).min())

    def is_above(self, ancestor: int, node: int) -> bool:
        """Whether a node is an ancestor of another, or the same."""
        return bool(self.paths[node, ancestor])

    def common(self, nodes: Iterable[int]) -> int:
        """Deepest node above all the given ones, or −1."""
        shared = np.flatnonzero(np.logical_and.reduce([self.paths[n] for n in nodes]))
        return int(shared[-1]) if len(shared) else -1


def _followers(names: Sequence[str]) -> dict[int, int]:
    index = {name: v for v, name in enumerate(names)}
    pairs = {
        f"{finger}_{side}_3.flexion": f"{finger}_{side}_2.flexion"
        for finger in ("index", "middle", "ring", "little")
        for side in "LR"
    }
    return {
        index[last]: index[before]
        for last, before in pairs.items()
        if last in index and before in index
    }


def _set(flags: Flags) -> frozenset[int]:
    return frozenset(np.flatnonzero(flags).tolist())


@lru_cache(maxsize=16)
def anatomy(chain: Chain, coordinates: Coordinates) -> Anatomy:
    """Return the anatomy of a body, worked out once."""
    return Anatomy(chain, coordinates)
