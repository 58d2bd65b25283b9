"""How deep capsules of the body overlap along a movement: what clearing the way works on.

Capsules hold the skin and can be asked for thousands of postures a second; the skin itself is the
judge in the report.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from azee_solver.anatomy import Part, anatomy
from azee_solver.collisions import Obstacles
from azee_solver.constraint import Constraint, Place
from azee_solver.evaluate import Evaluator
from azee_solver.kinematics import Parting

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

CLEAR_M, FINGERS_CLEAR_M = 0.01, 0.0005
"""Fingers of one hand lie side by side; everything else keeps a little away."""


class Overlaps:
    """Overlaps of the pairs of capsules of one body that must stay apart.

    pairs: (P, 2). nodes: (P, 2) the nodes that carry them. clear_m: (P,) how far apart a way that
    is free to choose keeps them: capsules do not hold all of the skin. same_hand: (P,) which are
    fingers of one hand.
    """

    def __init__(self, evaluator: Evaluator) -> None:
        self._evaluator, self._rig = evaluator, evaluator.rig
        self._anatomy = anatomy(self._rig.chain, self._rig.coordinates)
        capsules = self._rig.capsules
        self.pairs: Ints = Obstacles(evaluator.binding, self._anatomy, ()).pairs
        self.nodes = capsules.node[self.pairs]
        hands = [*self._anatomy.of(Part.HAND)]
        others = np.ones(len(self._rig.coordinates), dtype=np.bool_)
        others[hands] = False
        arms = (self._anatomy.relative(*self.nodes.T) & others).any(axis=1)
        self.same_hand: NDArray[np.bool_] = np.logical_not(arms)
        self.clear_m: Array = np.where(arms, CLEAR_M, FINGERS_CLEAR_M)
        self._reach = lru_cache(maxsize=64)(self._reach_of)

    def moved_by(self, pair: int) -> list[int]:
        """Coordinates that change the distance of a pair."""
        relative = self._anatomy.relative(*self.nodes[[pair]].T)[0]
        return [int(v) for v in np.flatnonzero(relative)]

    def names(self, pair: int) -> tuple[str, str]:
        """Names of a pair's capsules."""
        i, j = self.pairs[pair]
        return self._rig.capsules.names[i], self._rig.capsules.names[j]

    def regions(self, pair: int) -> tuple[str, str]:
        """Parts of the body that a pair belongs to: trunk, head, arm_L, arm_R."""
        first, second = (self._region(int(node)) for node in self.nodes[pair])
        return first, second

    def _region(self, node: int) -> str:
        for side in "LR":
            if self._anatomy.is_above(self._rig.bones[f"arm_{side}"].node, node):
                return f"arm_{side}"
        head = self._anatomy.is_above(self._rig.bones["neck"].origin_node, node)
        return "head" if head else "trunk"

    def reach(self, constraints: Iterable[Constraint]) -> Array:
        """How near the axes of pairs may come, (P,), where constraints mean some to touch."""
        return self._reach(tuple(dict.fromkeys(c for c in constraints if isinstance(c, Place))))

    def _reach_of(self, places: tuple[Constraint, ...]) -> Array:
        return Obstacles(self._evaluator.binding, self._anatomy, places).reach

    def depth(self, q: Array, reach: Array, pairs: Ints | None = None) -> Array:
        """Return how deep pairs overlap in postures, (T, P) metres; negative if they are apart.

        Args: q: (T, V). reach: all pairs', as `reach` gives it. pairs: indices of those to look
            at, all by default.
        """
        return self.slopes(q, reach, pairs, np.empty(0, dtype=np.int64))[0]

    def slopes(
        self,
        q: Array,
        reach: Array,
        pairs: Ints | None,
        coordinates: Ints,
        deeper_m: float = -math.inf,
    ) -> tuple[Array, Array]:
        """Return depths, and how they change with some coordinates, (T, P, n) metres a radian.

        Args: deeper_m: of pairs that overlap no deeper slopes are left at zero.
        """
        chosen = np.arange(len(self.pairs)) if pairs is None else pairs
        parting = Parting(self._rig, self.pairs[chosen])
        return parting.depths(q, reach[chosen], coordinates, deeper_m)
