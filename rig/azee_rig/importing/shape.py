"""Reads a skeleton by its shape, if names give no information: symmetry, hands, a head.

The middle plane is the one in which most joints have a mirror image. Hands are the pair of mirrored
joints from which most chains of fingers start, or else the ends of the pair of chains that extend
furthest to the sides above the legs. The head is the highest middle joint that carries skin.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from azee_rig.importing.bone_map import DIGITS, LEGS
from azee_rig.importing.names import Reading
from azee_rig.importing.skeleton_tree import Tree, nearest_of

Floats = NDArray[np.float64]

NEAR = 0.02
"""How far mirror images may be off, as a share of the figure's size."""
FINGER, LONGEST = 2, 5
"""A finger is a chain of at least, and of at most, so many joints."""


@dataclass(frozen=True, eq=False)
class Shape:
    """The parts that the shape of a skeleton shows: head, hands, fingers of each hand, legs."""

    head: int
    hands: dict[str, int]
    fingers: dict[str, dict[str, list[int]]]
    legs: tuple[list[int], ...]

    def landmarks(self) -> dict[str, int]:
        """Return head and hands in the form that names would give."""
        return {"head": self.head} | {f"palm_{s}": hand for s, hand in self.hands.items()}

    def readings(self, names: Sequence[Reading]) -> list[Reading]:
        """Return what is found, in the form that names would give; eyes may have names."""
        seen = [r if r.kind == "eye" else replace(Reading(), end=r.end) for r in names]
        for leg in self.legs:
            for joint, kind in zip(leg, LEGS, strict=False):
                seen[joint] = Reading(kind)
        for side, fingers in self.fingers.items():
            for digit, chain in fingers.items():
                for joint in chain:
                    seen[joint] = Reading("digit", side, digit, names[joint].end)
        return seen


def read_shape(tree: Tree, carried: Floats | None) -> Shape | None:
    """Find a figure with a head and two hands in a skeleton; None if there is none.

    Args: carried: skin on each joint, (J,), if there is any.
    """
    if len(tree.names) < 6:
        return None
    size = float(np.ptp(tree.places, axis=0).max())
    if size <= 0.0:
        return None
    side, mirror = _middle_plane(tree, NEAR * size)
    if side is None:
        return None
    rest = [axis for axis in range(3) if axis != side]
    up = max(rest, key=lambda axis: float(np.ptp(tree.places[:, axis])))
    forward = next(axis for axis in rest if axis != up)
    middle = np.median([tree.places[j, side] for j, m in enumerate(mirror) if m == j] or [0.0])
    away = tree.places[:, side] - middle
    hands = _hands(tree, mirror, away, up)
    if hands is None:
        return None
    chest = tree.common(*hands)
    upright = _upright(tree, hands, chest, up)
    height = upright * tree.places[:, up]
    head = _head(tree, chest, mirror, height, carried)
    if head is None:
        return None
    fingers = [_fingers(tree, hand) for hand in hands]
    ahead = _ahead(tree, fingers, height, forward)
    # Left is up × forward.
    axes = np.zeros((2, 3))
    axes[0, up], axes[1, forward] = upright, ahead
    left = np.cross(axes[0], axes[1])[side] * away[hands[0]] > 0
    order = "LR" if left else "RL"
    sided = dict(zip(order, hands, strict=True))
    return Shape(head, sided, dict(zip(order, fingers, strict=True)), _legs(tree, mirror, height))


def _middle_plane(tree: Tree, near: float) -> tuple[int | None, list[int]]:
    """Return the axis across the figure, and each joint's mirror image, −1 for none."""
    best: tuple[int, int | None, list[int]] = (0, None, [])
    places = tree.places
    for axis in range(3):
        flipped = places.copy()
        flipped[:, axis] = 2.0 * np.median(places[:, axis]) - flipped[:, axis]
        found, gap = nearest_of(places, flipped)
        mirror = np.where(gap < near, found, -1).tolist()
        pairs = sum(m not in (-1, j) for j, m in enumerate(mirror))
        if pairs > best[0]:
            best = pairs, axis, mirror
    return best[1], best[2]


def _hands(tree: Tree, mirror: Sequence[int], away: Floats, up: int) -> tuple[int, int] | None:
    pairs = [(j, m) for j, m in enumerate(mirror) if m > j]
    many = [
        (min(len(_chains(tree, a)), len(_chains(tree, b))), abs(float(away[a])), a, b)
        for a, b in pairs
    ]
    handed = [row for row in many if row[0] >= 3]
    if handed:
        return max(handed)[2:]
    ends = [
        (a, b)
        for a, b in pairs
        if not tree.children[a] and not tree.children[b] and tree.depth[a] >= 3
    ]
    if not ends:
        return None
    # Arms branch from the chain to the head, legs from the root, higher up in the tree.
    return max(ends, key=lambda p: (int(tree.depth[tree.common(*p)]), abs(float(away[p[0]]))))


def _chains(tree: Tree, joint: int) -> list[list[int]]:
    """Chains that go out from a joint like fingers: unbranched, two to five joints long."""
    runs = [tree.run(child, LONGEST + 1) for child in tree.children[joint]]
    return [
        run
        for run in runs
        if FINGER <= len(run) <= LONGEST and all(len(tree.children[j]) <= 1 for j in run)
    ]


def _upright(tree: Tree, hands: tuple[int, int], chest: int, up: int) -> float:
    """Return 1 if the up axis points up, else −1: arms leave the trunk above its root."""
    above = tree.places[chest, up] - tree.places[tree.path(chest)[0], up]
    return -1.0 if above < 0.0 else 1.0


def _head(
    tree: Tree, chest: int, mirror: Sequence[int], height: Floats, carried: Floats | None
) -> int | None:
    """Return the middle joint above the arms with the most skin, or else the highest."""
    measure = height if carried is None else carried
    inside = [j for j in tree.below(chest) if j != chest and mirror[j] == j]
    return max(inside, key=lambda j: float(measure[j]), default=None)


def _legs(tree: Tree, mirror: Sequence[int], height: Floats) -> tuple[list[int], ...]:
    """Return the chains to the lowest pair of mirrored ends, from where they separate."""
    ends = [(j, m) for j, m in enumerate(mirror) if m > j and not tree.children[j]]
    if not ends:
        return ()
    left, right = min(ends, key=lambda p: float(height[p[0]]))
    pelvis = tree.common(left, right)
    chains = tuple(tree.path(end)[int(tree.depth[pelvis]) + 1 :] for end in (left, right))
    return chains if pelvis >= 0 and all(len(chain) > 1 for chain in chains) else ()


def _ahead(
    tree: Tree, hands: Sequence[dict[str, list[int]]], height: Floats, forward: int
) -> float:
    """Return 1 if the forward axis points ahead, else −1.

    Thumbs are in front of little fingers in all postures in which bodies are modelled. Without
    fingers, toes decide, and without toes glTF's own convention.
    """
    at = tree.places[:, forward]
    pairs = [(f["thumb"][0], list(f.values())[-1][0]) for f in hands if f]
    if not pairs:
        low = np.argsort(height)[: max(2, len(height) // 20)]
        pairs = [(int(j), int(tree.parents[j])) for j in low if tree.parents[j] >= 0]
    way = sum(float(at[a] - at[b]) for a, b in pairs)
    return -1.0 if way < 0.0 else 1.0


def _fingers(tree: Tree, hand: int) -> dict[str, list[int]]:
    """Name the fingers of a hand: the thumb starts nearest to the wrist; others are in a row."""
    chains = _chains(tree, hand)
    if not 3 <= len(chains) <= 5:
        return {}
    wrist = tree.places[hand]
    thumb = min(chains, key=lambda c: _out(tree, wrist, c))
    others = [c for c in chains if c is not thumb]
    first, last = max(
        ((a, b) for a in others for b in others), key=lambda p: tree.apart(p[0][0], p[1][0])
    )
    if tree.apart(thumb[0], first[0]) > tree.apart(thumb[0], last[0]):
        first, last = last, first
    others.sort(key=lambda c: tree.apart(first[0], c[0]))
    return {"thumb": thumb} | dict(zip(DIGITS[1:], others, strict=False))


def _out(tree: Tree, wrist: Floats, chain: Sequence[int]) -> float:
    """Return how far a finger extends from the wrist."""
    return float(np.linalg.norm(tree.places[chain[-1]] - wrist))
