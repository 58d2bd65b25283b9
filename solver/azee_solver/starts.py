"""Where descents start: the posture at hand, the resting one, nine typical ones, then a sequence.

Nine ways to hold an arm (forward, across, up; each with three pronations) cover the signing space
with its solutions: where resting and random starts stuck inside the trunk, most of them did not.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from azee_rig.coordinates import Coordinates

Array = NDArray[np.float64]

ARM_POSTURES = {
    "forward": {"arm.flexion": 45, "arm.abduction": 10, "arm.rotation": 20, "f_arm.flexion": 80},
    "across": {"arm.flexion": 50, "arm.abduction": 0, "arm.rotation": 60, "f_arm.flexion": 100},
    "up": {"arm.flexion": 75, "arm.abduction": 25, "arm.rotation": 10, "f_arm.flexion": 125},
}
PRONATIONS = (0, 70, -70)
"""Degrees, as in the table of coordinates."""

_PRIMES = [n for n in range(2, 400) if all(n % d for d in range(2, n))]
"""Bases of the sequence, one per coordinate."""


def starts(
    coordinates: Coordinates, free: NDArray[np.int64], at_hand: Array, further: int
) -> Iterator[Array]:
    """Yield starting points for the free coordinates, (n,) each, best guesses first.

    Args: at_hand: (V,) the posture so far. further: how many of the sequence to add at the end.
    """
    lower, upper = coordinates.lower[free], coordinates.upper[free]
    yield np.clip(at_hand[free], lower, upper)
    yield np.clip(coordinates.idle[free], lower, upper)
    arms = [
        (i, name)
        for i, name in enumerate(_unsided(coordinates.names[v]) for v in free)
        if name in ARM_POSTURES["forward"] or name == "f_arm.pronation"
    ]
    if arms:
        postures = tuple(ARM_POSTURES.values())
        for k in range(9):
            posture, pronation = postures[k % 3], PRONATIONS[(k + k // 3) % 3]
            x = np.array(coordinates.idle[free])
            for i, name in arms:
                x[i] = np.radians(posture.get(name, pronation))
            yield np.clip(x, lower, upper)
    for k in range(1, further + 1):
        part = np.array([_halton(k, base) for base in _PRIMES[: len(free)]])
        # The middle of the range: the ends are seldom where a body is at ease.
        yield lower + (0.15 + 0.7 * part) * (upper - lower)


def _unsided(name: str) -> str:
    bone, axis = name.split(".")
    return f"{bone.removesuffix('_L').removesuffix('_R')}.{axis}"


def _halton(index: int, base: int) -> float:
    """Radical inverse of an index (Halton 1960)."""
    value, weight = 0.0, 1.0
    while index:
        weight /= base
        index, digit = divmod(index, base)
        value += weight * digit
    return value
