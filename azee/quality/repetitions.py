"""How much a way differs from the same way gone before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.quality.kinematics import CHEST, SIDES, Kinematics
from azee.quality.task_spans import TaskSpan
from azee_solver.constraint import Constraint, Place, Transpath

Array = NDArray[np.float64]

CARRIERS = (CHEST, "head")
"""Bones that carry what a way may be on."""
PHASES = 65
"""Instants at which two performances of a way are compared."""
LEAST_WAY_M = 0.02
"""Shorter ways are not compared: what a way differs by is a share of its length."""
ADJACENT_S = 0.05
"""A place of the score that ends this long before a way, or begins after it, is an end of it."""
SAME_WAY = 0.25
"""Ways on equal paths that differ by more of their length are two ways, not one repeated."""


@dataclass(frozen=True, slots=True)
class Repetition:
    """A way that an arm goes twice: when either begins, and how much they differ.

    difference_percent: the largest distance between the two at the same share of their time, both
    starting from one point, of the length of the way.
    """

    side: str
    first_s: float
    second_s: float
    difference_percent: float


def repetitions(k: Kinematics, spans: Sequence[TaskSpan]) -> tuple[Repetition, ...]:
    """Compare each way of a wrist on a path with the next one that is the same, on either side.

    The same: on an equal path from equal places to equal places, and no farther from it than
    `SAME_WAY` of its length. A straight path there and one back are equal paths and two ways; so
    are a movement and a smaller one, where a score damps what it repeats.
    """
    out = []
    for side in SIDES:
        ways = [
            s for s in spans if isinstance(s.constraint, Transpath) and s.concerns(f"arm_{side}")
        ]
        ways.sort(key=lambda s: s.start_s)
        for n, one in enumerate(ways):
            for two in ways[n + 1 :]:
                if one.constraint == two.constraint and _ends(one, spans) == _ends(two, spans):
                    apart = _difference(k, side, one, two)
                    if apart is not None and apart <= SAME_WAY:
                        out.append(Repetition(side, one.start_s, two.start_s, 100.0 * apart))
                        break
    return tuple(sorted(out, key=lambda r: (r.first_s, r.side)))


def _ends(way: TaskSpan, spans: Sequence[TaskSpan]) -> tuple[Constraint | None, Constraint | None]:
    """Return where the score has the site of a way before and after it, if it says so."""
    assert isinstance(way.constraint, Transpath)
    site = way.constraint.site
    places = [s for s in spans if isinstance(s.constraint, Place) and s.constraint.site == site]
    before = [s for s in places if s.start_s <= way.start_s <= s.end_s + ADJACENT_S]
    after = [s for s in places if s.start_s - ADJACENT_S <= way.end_s <= s.end_s]
    first = max(before, key=lambda s: s.start_s, default=None)
    last = min(after, key=lambda s: s.end_s, default=None)
    return first.constraint if first else None, last.constraint if last else None


def _difference(k: Kinematics, side: str, one: TaskSpan, two: TaskSpan) -> float | None:
    """How far two ways are apart, of their length, against the part of the body they are on.

    A trunk that sways takes arms and their targets along, a head that turns what is at the face: a
    way is no other for that. The part is the one against which the two differ less.
    """
    each = (_apart(_way(k, side, one, bone), _way(k, side, two, bone)) for bone in CARRIERS)
    return min((apart for apart in each if apart is not None), default=None)


def _way(k: Kinematics, side: str, span: TaskSpan, bone: str) -> Array:
    """Wrist against a bone at evenly spaced times of a span, (PHASES, 3)."""
    times = np.linspace(span.start_s, span.end_s, PHASES)
    turn = k.rotation(bone)
    wrist = np.einsum("tji,tj->ti", turn, k.wrist(side) - k.scale * k.joint(bone))
    return np.stack([np.interp(times, k.times_s, wrist[:, i]) for i in range(3)], axis=1)


def _apart(a: Array, b: Array) -> float | None:
    """Largest distance of two ways from one start, of their mean length; none of short ones."""
    length = (_length(a) + _length(b)) / 2.0
    if length < LEAST_WAY_M:
        return None
    return float(np.linalg.norm(a - a[0] - (b - b[0]), axis=1).max()) / length


def _length(way: Array) -> float:
    return float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())
