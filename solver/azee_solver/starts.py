"""Where descents start: the posture at hand, idle, and nine typical ones.

Nine ways to hold an arm (forward, across, up; each with three pronations) cover the signing space
with its solutions. Descents from idle or random starts end inside the trunk more often; starts
from a Halton sequence after them met nothing more in 1,747 problems (ADR 29). Hands that touch
often need their arms held in two unlike ways.
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
STRAIGHT = {
    "forward": {"arm.flexion": 80, "arm.abduction": 0},
    "aside": {"arm.flexion": 0, "arm.abduction": 110},
    "up": {"arm.flexion": 150, "arm.abduction": 40},
    "across": {"arm.flexion": 60, "arm.abduction": -20, "arm.rotation": 40},
    "aslant": {"arm.flexion": 45, "arm.abduction": 60},
    "back": {"arm.flexion": -40, "arm.abduction": 30},
}
"""Nearly straight arms, for what is far away."""
BENT = {"f_arm.flexion": 15}
PRONATIONS = (0, 70, -70)
"""Degrees, as in the table of coordinates."""
UNLIKE = 6
"""By how many of the nine ways the left arm is ahead of the right one where they are unlike."""


def starts(coordinates: Coordinates, free: NDArray[np.int64], at_hand: Array) -> Iterator[Array]:
    """Yield starting points for the free coordinates, (n,) each, best guesses first.

    Args: at_hand: (V,) the posture so far.
    """
    lower, upper = coordinates.lower[free], coordinates.upper[free]
    yield np.clip(at_hand[free], lower, upper)
    yield np.clip(coordinates.idle[free], lower, upper)
    yield from typical(coordinates, free)


def typical(
    coordinates: Coordinates, free: NDArray[np.int64], *, unlike: bool = False
) -> Iterator[Array]:
    """Yield nine ways to hold the arms, (n,) each, all else idle; none where no arm is free.

    Args: unlike: hold the left arm otherwise than the right one; none where not both are free.
    """
    arms = list(_arms(coordinates, free))
    if len({left for _, _, left in arms}) <= unlike:
        return
    postures = tuple(ARM_POSTURES.values())
    for k in range(9):
        x = np.array(coordinates.idle[free])
        for i, name, left in arms:
            n = (k + UNLIKE * (unlike and left)) % 9
            x[i] = np.radians(postures[n % 3].get(name, PRONATIONS[(n + n // 3) % 3]))
        yield np.clip(x, coordinates.lower[free], coordinates.upper[free])


def straight(coordinates: Coordinates, free: NDArray[np.int64]) -> Iterator[Array]:
    """Yield nearly straight arms all around, (n,) each, all else idle; none if none is free."""
    arms = list(_arms(coordinates, free))
    for posture in STRAIGHT.values() if arms else ():
        x = np.array(coordinates.idle[free])
        for i, name, _ in arms:
            x[i] = np.radians((posture | BENT).get(name, 0))
        yield np.clip(x, coordinates.lower[free], coordinates.upper[free])


def _arms(coordinates: Coordinates, free: NDArray[np.int64]) -> Iterator[tuple[int, str, bool]]:
    """Yield places in `free` of what holds an arm, with names and whether it is the left one."""
    for i, v in enumerate(free):
        name = _unsided(coordinates.names[v])
        if name in ARM_POSTURES["forward"] or name == "f_arm.pronation":
            yield i, name, coordinates.names[v].split(".")[0].endswith("_L")


def _unsided(name: str) -> str:
    bone, axis = name.split(".")
    return f"{bone.removesuffix('_L').removesuffix('_R')}.{axis}"
