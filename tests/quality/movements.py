"""Movements whose figures are known in closed form: drawn coordinates, and wrists on given ways."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.quality.kinematics import FPS, Kinematics
from azee.quality.task_spans import TaskSpan
from azee_rig.rig import Rig
from azee_solver.constraint import Constraint, Place
from azee_solver.geometry import Side, Site, WorldPoint

Array = NDArray[np.float64]
Course = Callable[[Array], Array]
"""A number for every time."""

SOMEWHERE = Place(Site("PA", Side.RIGHT), WorldPoint(0.0, 1.0, 0.3))
ARM_R, ARM_L = frozenset({"arm_R", "trunk"}), frozenset({"arm_L", "trunk"})


@dataclass(frozen=True, eq=False)
class Drawn(Kinematics):
    """A body whose wrists go where they are told; its joints do what its coordinates say."""

    ways: Mapping[str, Array] = field(default_factory=dict)

    def wrist(self, side: str) -> Array:
        if side in self.ways:
            return self.ways[side]
        return super().wrist(side)


def drawn(
    rig: Rig,
    seconds: float,
    coordinates: Mapping[str, Course] | None = None,
    wrists: Mapping[str, Course] | None = None,
    fps: float = FPS,
) -> Drawn:
    """A movement from rest: coordinates in degrees, and wrists by metres to the left."""
    times = np.arange(round(seconds * fps) + 1) / fps
    q = np.tile(rig.coordinates.idle, (len(times), 1))
    for name, course in (coordinates or {}).items():
        q[:, rig.coordinates.index[name]] = np.radians(course(times))
    ways = {
        side: np.stack([course(times), np.ones(len(times)), np.zeros(len(times))], axis=1)
        for side, course in (wrists or {}).items()
    }
    nothing = np.zeros((len(times), 0))
    return Drawn(rig, fps, times, q, (), nothing, ways)


def moves(size: float, start_s: float, duration_s: float, origin: float = 0.0) -> Course:
    """From one value to another by minimum jerk; still before and after."""
    return lambda t: origin + size * minimum_jerk((t - start_s) / duration_s)


def then(*courses: Course) -> Course:
    """One after the other: their sum."""
    return lambda t: np.asarray(sum(course(t) for course in courses))


def still(value: float = 0.0) -> Course:
    return lambda t: np.full(len(t), value)


def span(
    start_s: float,
    end_s: float,
    *,
    limb: str = "arm_R",
    limbs: frozenset[str] | None = None,
    reads: frozenset[str] = frozenset(),
    moving: bool = False,
    constraint: Constraint = SOMEWHERE,
    path: tuple[str, ...] = ("A",),
) -> TaskSpan:
    return TaskSpan(
        path, constraint, limb, (limbs or frozenset()) | {limb}, reads, moving, start_s, end_s
    )
