"""Which pairs of capsules are worth looking at: bundles of them lie in balls that are far apart.

A hand with its fingers stays inside a ball about its palm, whatever they do; every other bone's
capsules are as rigid as the bone. Pairs are sorted by the two balls they belong to, and a whole
run of them is passed over while its balls are apart: nothing that overlaps is ever missed.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Collisions:
    """Capsules that must stay apart.

    pairs: (P, 2) capsules of the rig. reach: (P,) how near their axes may come, metres. margin:
    (P,) how much of that is a wish: so much nearer they touch.
    """

    pairs: Ints
    reach: Array
    margin: Array | float = 0.0

    @staticmethod
    def none() -> Collisions:
        """No collisions."""
        return _NONE


_NONE = Collisions(np.empty((0, 2), dtype=np.int64), np.empty(0))


@dataclass(frozen=True, slots=True, eq=False)
class BroadPhase:
    """Pairs of capsules in runs.

    capsules: (K,) of the rig, those that are used. pairs: (P, 2) indices into them. reach: (P,)
    how near their axes may come, metres. margin: (P,) the part of that which is a wish.
    ball_node: (B,) the node that carries a ball. ball_centre: (B, 3) in its frame. runs: (R, 4) two
    balls, the first pair and one past the last; twice the same ball where both capsules lie in it.
    run_reach: (R,) balls whose centres are farther apart than this hold no pair that overlaps.
    """

    capsules: Ints
    pairs: Ints
    reach: Array
    margin: Array
    ball_node: Ints
    ball_centre: Array
    runs: Ints
    run_reach: Array


@dataclass(frozen=True, slots=True, eq=False)
class _Balls:
    """All balls of a rig.

    of: (K,) the ball of each capsule. node: (B,). centre: (B, 3) in its frame. radius: (B,).
    """

    of: Ints
    node: Ints
    centre: Array
    radius: Array


@lru_cache(maxsize=256)
def broad_phase(rig: Rig, collisions: Collisions) -> BroadPhase:
    """Sort pairs of capsules into runs, once for every problem that comes again."""
    pairs, reach = collisions.pairs, collisions.reach
    balls = _balls(rig)
    count = len(balls.node)
    one, other = np.sort(balls.of[pairs], axis=1).T
    key = one * count + other
    order = np.argsort(key, kind="stable")
    pairs, reach, key = pairs[order], reach[order], key[order]
    first = np.flatnonzero(np.diff(key, prepend=-1))
    last = np.append(first, len(key))[1:]
    one, other = np.divmod(key[first], count)
    radii = rig.capsules.radius[pairs].sum(axis=1)
    slack = np.maximum.reduceat(reach - radii, first) if len(key) else np.empty(0)
    run_reach = np.maximum(balls.radius[one] + balls.radius[other] + slack, 0.0)
    capsules, used = np.unique(pairs), np.unique((one, other))
    return BroadPhase(
        capsules,
        np.searchsorted(capsules, pairs),
        reach,
        np.broadcast_to(collisions.margin, reach.shape)[order],
        balls.node[used],
        balls.centre[used],
        np.stack([*np.searchsorted(used, (one, other)), first, last], axis=1),
        run_reach,
    )


@lru_cache(maxsize=4)
def _balls(rig: Rig) -> _Balls:
    """Work out the balls of a rig: one per hand, one per other node that carries capsules."""
    chain, capsules = rig.chain, rig.capsules
    palms = [rig.bones[f"palm_{side}"].node for side in "LR"]
    carrier = np.arange(len(chain.names))
    for node, parent in enumerate(chain.parents):
        if parent >= 0 and carrier[parent] in palms:
            carrier[node] = carrier[parent]
    nodes, of = np.unique(carrier[capsules.node], return_inverse=True)
    straight = rig.chain.frames(np.zeros(len(rig.coordinates)))
    centres, radii = np.empty((len(nodes), 3)), np.empty(len(nodes))
    for ball, node in enumerate(nodes):
        members = np.flatnonzero(of == ball)
        R, o = straight.rotations[node], straight.positions[node]
        ends = [
            (straight.positions[m] + straight.rotations[m] @ end - o) @ R
            for c in members
            for m, end in (
                (capsules.node[c], capsules.a[c]),
                (capsules.node[c], capsules.b[c]),
            )
        ]
        centres[ball] = np.mean(ends, axis=0)
        radii[ball] = max(
            max(_farthest(rig, int(node), int(capsules.node[c]), centres[ball], end)
                for end in (capsules.a[c], capsules.b[c]))
            + capsules.radius[c]
            for c in members
        )  # fmt: skip
    return _Balls(of.astype(np.int64), nodes.astype(np.int64), centres, radii)


def _farthest(rig: Rig, ball: int, node: int, centre: Array, end: Array) -> float:
    """How far a point of a node can get from a centre that an ancestor carries, metres."""
    chain = rig.chain
    if node == ball:
        return float(np.linalg.norm(end - centre))
    length = float(np.linalg.norm(end))
    while chain.parents[node] != ball:
        length += float(np.linalg.norm(chain.offsets[node]))
        node = int(chain.parents[node])
    return length + float(np.linalg.norm(chain.offsets[node] - centre))
