"""A skeleton as a tree, with queries."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


AT_ONCE = 2**20
"""Distances that are worked out at a time."""


def nearest_of(points: Floats, places: Floats) -> tuple[Ints, Floats]:
    """Return which of some places (m, 3) is nearest to each point (n, 3), and how far: (n,), (n,).

    No more than a few megabytes are used, however many there are.
    """
    found, away = np.zeros(len(points), np.int64), np.zeros(len(points))
    step = max(1, AT_ONCE // max(1, len(places)))
    for start in range(0, len(points), step):
        some = slice(start, start + step)
        squares = sum((points[some, None, k] - places[None, :, k]) ** 2 for k in range(3))
        gaps = np.asarray(squares)
        found[some] = gaps.argmin(axis=1)
        away[some] = np.sqrt(gaps[np.arange(len(gaps)), found[some]])
    return found, away


@dataclass(frozen=True, eq=False)
class Tree:
    """Joints of a body. names (J,), parents before children; parents (J,); places (J, 3)."""

    names: tuple[str, ...]
    parents: Ints
    places: Floats

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """Children of each joint."""
        below: list[list[int]] = [[] for _ in self.names]
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                below[parent].append(joint)
        return tuple(map(tuple, below))

    @cached_property
    def depth(self) -> Ints:
        """Number of ancestors of each joint, (J,)."""
        depth = np.zeros(len(self.names), np.int64)
        for joint, parent in enumerate(self.parents):
            depth[joint] = 0 if parent < 0 else depth[parent] + 1
        return depth

    def path(self, joint: int) -> list[int]:
        """Return a joint and its ancestors, the root first."""
        found = [joint]
        while self.parents[found[-1]] >= 0:
            found.append(int(self.parents[found[-1]]))
        return found[::-1]

    def common(self, first: int, second: int) -> int:
        """Return the deepest joint above, or the same as, both; −1 if they share none."""
        shared = [a for a, b in zip(self.path(first), self.path(second), strict=False) if a == b]
        return shared[-1] if shared else -1

    def below(self, joint: int) -> list[int]:
        """Return a joint and all below it."""
        found = {joint}
        for j, parent in enumerate(self.parents):
            if int(parent) in found:
                found.add(j)
        return sorted(found)

    def run(self, joint: int, most: int) -> list[int]:
        """Return the longest chain down from a joint, itself first, cut off after `most`."""
        chain = [joint]
        while len(chain) < most and self.children[chain[-1]]:
            chain.append(max(self.children[chain[-1]], key=lambda c: self.height[c]))
        return chain

    @cached_property
    def height(self) -> Ints:
        """Length of the longest chain below each joint, (J,)."""
        height = np.zeros(len(self.names), np.int64)
        for joint in range(len(self.names) - 1, -1, -1):
            parent = self.parents[joint]
            if parent >= 0:
                height[parent] = max(height[parent], height[joint] + 1)
        return height

    def named(self, joints: Sequence[int]) -> tuple[str, ...]:
        """Names of some joints."""
        return tuple(self.names[j] for j in joints)

    def apart(self, first: int, second: int) -> float:
        """Distance of two joints."""
        return float(np.linalg.norm(self.places[first] - self.places[second]))
