"""How deep capsules of the body overlap in the postures of a movement.

Collision avoidance works on capsules, which enclose nearly all of the skin: their overlaps are
computed for thousands of postures a second. The report measures on the skin itself.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from azee_rig.rig import Rig
from azee_solver.anatomy import Part, anatomy
from azee_solver.collisions import Obstacles
from azee_solver.constraint import Constraint, Place
from azee_solver.evaluate import Evaluator
from azee_solver.kinematics import Parting

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

CLEARANCE_M, FINGER_CLEARANCE_M = 0.01, 0.0005
"""Distance that avoidance keeps: fingers of one hand may lie side by side, other parts not."""


class CapsuleOverlaps:
    """The pairs of capsules of one body that must stay apart, and how deep they overlap.

    pairs: (P, 2). nodes: (P, 2) the nodes that carry them. clearance_m: (P,) distance that
    avoidance keeps between them, since capsules do not enclose all of the skin. same_hand: (P,)
    which are fingers of one hand.
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
        self.clearance_m: Array = np.where(arms, CLEARANCE_M, FINGER_CLEARANCE_M)
        self._axis_distances = lru_cache(maxsize=64)(self._axis_distances_with)

    @property
    def rig(self) -> Rig:
        """The body."""
        return self._rig

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

    def axis_distances(self, constraints: Iterable[Constraint]) -> Array:
        """Return how near the axes of pairs may come, (P,) metres.

        That is the sum of their radii and a margin; less where a placement wants a touch, by as
        much as the capsules stand out beyond the skin there.

        Args: constraints: those in force; only placements matter.
        """
        places = dict.fromkeys(c for c in constraints if isinstance(c, Place))
        return self._axis_distances(tuple(places))

    def _axis_distances_with(self, places: tuple[Constraint, ...]) -> Array:
        return Obstacles(self._evaluator.binding, self._anatomy, places).reach

    def depths(self, q: Array, axis_distances: Array, pairs: Ints | None = None) -> Array:
        """Return how deep pairs overlap in postures, (T, P) metres; negative if they are apart.

        Args: q: (T, V). axis_distances: (P,) of all pairs. pairs: indices of some, all by default.
        """
        nothing = np.empty(0, dtype=np.int64)
        return self.depths_and_gradients(q, axis_distances, pairs, nothing)[0]

    def depths_and_gradients(
        self,
        q: Array,
        axis_distances: Array,
        pairs: Ints | None,
        coordinates: Ints,
        deeper_m: float = -math.inf,
    ) -> tuple[Array, Array]:
        """Return depths, and their derivatives by some coordinates, (T, P, n) metres a radian.

        Args: deeper_m: derivatives are left at zero where a pair overlaps no deeper than this.
        """
        chosen = np.arange(len(self.pairs)) if pairs is None else pairs
        parting = Parting(self._rig, self.pairs[chosen])
        return parting.depths(q, axis_distances[chosen], coordinates, deeper_m)
