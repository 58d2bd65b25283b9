"""Handshapes that fit the hand: straight digits are not stretched, and thumbs lie on fingers.

Nobody holds a straight finger at zero. The angles of skeletal morphs are counted from `STRAIGHT`.

Presets say where digits go, by angles that know nothing of flesh: the angles of a straight thumb
put it into the palm, those of a fist through the index. Here thumbs move aside, each in its own
joints and as little as will do, before anything else is solved; the angles that come of it are
what the presets then ask for. The rest of the body has no part in this, so that a handshape is
the same wherever the hand is.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_solver.anatomy import Part, anatomy
from azee_solver.binding import Binding
from azee_solver.broadphase import Collisions
from azee_solver.collisions import Obstacles
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side
from azee_solver.program import Cost, Program
from azee_solver.tape import Tape

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]

STRAIGHT: Mapping[str, float] = {
    digit + joint: math.radians(angle)
    for digit, angles in {
        "index": (3.0, 6.0, 4.0),
        "middle": (3.0, 5.0, 4.0),
        "ring": (3.0, 6.0, 4.0),
        "little": (5.0, 8.0, 5.0),
    }.items()
    for joint, angle in zip(("_1.flexion", "_2.flexion", "_3.flexion"), angles, strict=True)
} | dict.fromkeys(("thumb_2.flexion", "thumb_3.flexion"), math.radians(6.0))
"""Flexion of digits that people hold straight, radians, by digit and joint.

In recordings of the ASL alphabet, seen by MediaPipe Holistic, the medians at PIP and DIP are 8 and
5 degrees in stretched index fingers, 4 and 5 in middle, 10 and 6 in ring and 15 and 8 in little
fingers (3 to 13 letters each); ours are a little straighter where bent neighbours bend these. MCP
and thumb are ours: the tracker has no metacarpal to measure them against.
"""

KEEP = 4.0
"""Cost of a squared radian away from a preset, beside which an overlap of 1 mm costs 1."""
OVERLAP = 1e6
ROUNDS, TOLERANCE = 80, 1e-9
MOVED_RAD = 1e-4
"""A thumb that moves by less has nothing in its way."""
MARGIN_M, PALM_MARGIN_M = 0.003, 0.006
"""Capsules hold most of the skin, not all: so far a thumb stays away from fingers and palm."""


FINGERS = ("index", "middle", "ring", "little")
WIDTH: Mapping[int, float] = {2: 0.82, 3: 1.08}
"""Half the width of a finger's phalanges over the radii of their capsules, which hold depth and
joints too: 0.75 to 0.86 and 1.05 to 1.2 on the four bodies that ship."""


def straight(coordinate: str) -> float:
    """Return the angle of a coordinate such as `index_R_1.flexion` in a straight digit, radians."""
    return STRAIGHT.get(coordinate.replace("_L_", "_").replace("_R_", "_"), 0.0)


def fitted(
    rig: Rig, presets: Mapping[int, float], touching: frozenset[int] = frozenset()
) -> dict[int, float]:
    """Return the angles of presets, by coordinate, with thumbs beside or on what they would enter.

    Args: presets: angles that morphs ask for, radians, by coordinate. touching: coordinates of
        fingers that these angles press into each other, and that give way until they touch.
    """
    out = dict(presets)
    hands = anatomy(rig.chain, rig.coordinates).of(Part.HAND)
    for side in ("L", "R"):
        own = {v for v in presets if v in hands and f"_{side}_" in rig.coordinates.names[v]}
        if pressed := tuple(sorted(own & touching)):
            out |= _side_by_side(rig, side, tuple((v, out[v]) for v in sorted(own)), pressed)
        out |= _fitted(rig, side, tuple((v, out[v]) for v in sorted(own)))
    return out


@lru_cache(maxsize=512)
def _fitted(rig: Rig, side: str, presets: tuple[tuple[int, float], ...]) -> Mapping[int, float]:
    """Angles of the thumb's presets on one hand that keep it out of the hand."""
    free = [v for v, _ in presets if rig.coordinates.names[v].startswith(f"thumb_{side}_")]
    if not free:
        return {}
    structure = anatomy(rig.chain, rig.coordinates)
    found = Obstacles(Binding(rig, Side.RIGHT), structure, []).for_problem(free, ())
    return _pushed_apart(rig, presets, free, _within(rig, side, found))


@lru_cache(maxsize=128)
def _side_by_side(
    rig: Rig, side: str, presets: tuple[tuple[int, float], ...], free: tuple[int, ...]
) -> Mapping[int, float]:
    """Angles at which fingers of one hand that presets press together touch.

    At their roots neighbours share flesh, so first phalanges do not count. Fingers that bend for it
    cross: they lie on each other, by their depth, and give way by bending. The others give way to
    the side, and the less the more they are bent: there a deviation would only roll them.
    """
    names, radius = rig.capsules.names, rig.capsules.radius
    angles, coordinates = dict(presets), rig.coordinates
    bends = tuple(v for v in free if coordinates.names[v].endswith("flexion"))
    crossing = bool(bends)
    for v in () if crossing else free:
        knuckle = coordinates.index[coordinates.names[v].replace("deviation", "flexion")]
        angles[v] *= max(0.0, math.cos(angles.get(knuckle, 0.0)))
    ends = [(f"{finger}_{side}_", j) for finger in FINGERS for j in WIDTH]
    half = {
        names.index(f"{finger}{j}"): radius[names.index(f"{finger}{j}")]
        * (1.0 if crossing else WIDTH[j])
        for finger, j in ends
    }
    pairs = [(i, k) for i, k in combinations(half, 2) if names[i][:-1] != names[k][:-1]]
    reach = np.array([half[i] + half[k] for i, k in pairs])
    pushed = _pushed_apart(rig, angles.items(), bends or free, Collisions(np.array(pairs), reach))
    return {v: angles[v] for v in free} | dict(pushed)


def _pushed_apart(
    rig: Rig,
    presets: Iterable[tuple[int, float]],
    free: Sequence[int],
    collisions: Collisions,
) -> Mapping[int, float]:
    """Return the angles nearest to presets at which capsules do not overlap, if they do."""
    limits = rig.coordinates
    q = np.array(limits.idle)
    for v, angle in presets:
        q[v] = angle
    np.clip(q, limits.lower, limits.upper, out=q)
    moving = anatomy(rig.chain, limits).moved_by(free)
    program = Program(
        rig,
        q,
        free,
        Tape(Evaluator(rig, Side.RIGHT), rig.chain.frames(q), moving),
        [],
        collisions,
        Cost(q, np.full(len(q), KEEP), np.zeros(len(q)), OVERLAP),
    )
    x = program.gauss_newton(q[program.free], rounds=ROUNDS, tolerance=TOLERANCE)
    if np.abs(x - q[program.free]).max() < MOVED_RAD:
        return {}
    return {int(v): float(angle) for v, angle in zip(program.free, x, strict=True)}


def _within(rig: Rig, side: str, collisions: Collisions) -> Collisions:
    """Pairs of capsules that both belong to one hand."""
    structure = anatomy(rig.chain, rig.coordinates)
    hand = structure.paths[:, rig.bones[f"palm_{side}"].node]
    chosen = hand[rig.capsules.node[collisions.pairs]].all(axis=1)
    pairs = collisions.pairs[chosen]
    palm = (rig.capsules.node[pairs] == rig.bones[f"palm_{side}"].node).any(axis=1)
    margin = np.where(palm, PALM_MARGIN_M, MARGIN_M)
    return Collisions(pairs, collisions.reach[chosen] + margin)
