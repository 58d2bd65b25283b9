"""The nodes of a glTF file: a forest with a transform each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee_rig.importing.container import GltfFile, label
from azee_rig.importing.fault import unreadable
from azee_rig.rotation import to_matrices

Floats = NDArray[np.float64]
FARTHEST = 1e15
"""No number of a transform is larger."""


@dataclass(frozen=True, eq=False)
class Nodes:
    """Nodes as the file has them, by their numbers.

    names: "" where a node has none. parents: −1 for roots. order: parents before children.
    local, world: (n, 4, 4) transforms, to the parent and to the scene.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    order: tuple[int, ...]
    local: Floats
    world: Floats

    @cached_property
    def depth(self) -> tuple[int, ...]:
        """Number of ancestors of each node."""
        depth = [0] * len(self.parents)
        for node in self.order:
            if self.parents[node] >= 0:
                depth[node] = depth[self.parents[node]] + 1
        return tuple(depth)

    def above(self, node: int) -> list[int]:
        """Return the ancestors of a node, nearest first."""
        found = []
        while (node := self.parents[node]) >= 0:
            found.append(node)
        return found


def read_nodes(file: GltfFile) -> Nodes:
    """Read all nodes.

    Raises: BodyError: a node is its own ancestor, has two parents, or no sound transform.
    """
    rows = file.all("nodes")
    parents = [-1] * len(rows)
    for number, row in enumerate(rows):
        children = row.get("children", [])
        for child in children if isinstance(children, list) else []:
            file.one("nodes", child)
            if parents[child] >= 0:
                raise unreadable(f"node {child} has two parents, {parents[child]} and {number}")
            parents[child] = number
    order = _parents_first(parents)
    local = np.array([_local(row, i) for i, row in enumerate(rows)]).reshape(-1, 4, 4)
    world = np.array(local)
    for node in order:
        if parents[node] >= 0:
            with np.errstate(over="ignore", invalid="ignore"):
                world[node] = world[parents[node]] @ local[node]
    if not np.isfinite(world).all() or np.abs(world).max(initial=0.0) > FARTHEST:
        raise unreadable("its nodes stand farther away than numbers reach")
    names = tuple(label(row.get("name")) for row in rows)
    return Nodes(names, tuple(parents), order, local, world)


def _parents_first(parents: list[int]) -> tuple[int, ...]:
    below: list[list[int]] = [[] for _ in parents]
    for node, parent in enumerate(parents):
        if parent >= 0:
            below[parent].append(node)
    order: list[int] = []
    waiting = [node for node, parent in enumerate(parents) if parent < 0][::-1]
    while waiting:
        node = waiting.pop()
        order.append(node)
        waiting.extend(reversed(below[node]))
    if len(order) < len(parents):
        lost = next(node for node in range(len(parents)) if node not in set(order))
        raise unreadable(f"node {lost} is its own ancestor")
    return tuple(order)


def _local(row: Mapping[str, Any], number: int) -> Floats:
    if "matrix" in row:
        return _numbers(row["matrix"], 16, number).reshape(4, 4).T
    transform = np.eye(4)
    x, y, z, w = _numbers(row.get("rotation", (0, 0, 0, 1)), 4, number)
    length = np.sqrt(x * x + y * y + z * z + w * w)
    if not 1e-6 < length < FARTHEST:
        raise unreadable(f"node {number} has a rotation that is none")
    transform[:3, :3] = to_matrices(np.array([w, x, y, z]) / length)
    transform[:3, :3] *= _numbers(row.get("scale", (1, 1, 1)), 3, number)
    transform[:3, 3] = _numbers(row.get("translation", (0, 0, 0)), 3, number)
    return transform


def _numbers(values: object, count: int, number: int) -> Floats:
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        array = np.empty(0)
    if array.shape != (count,) or not (np.abs(array) < FARTHEST).all():
        raise unreadable(f"node {number} has a transform that is none")
    return array
