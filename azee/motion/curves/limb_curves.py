"""Curves of joint coordinates through key postures, limb by limb.

Curves run on coordinates, never on quaternions: every convex blend of two postures stays inside
the limits and on the joints' own manifold. Between two key postures a limb moves by minimum jerk.
Where keys lie on a movement (samples of a path, keys added to hold a constraint) it passes through
them without stopping, by the curve of least jerk through all of them (see `least_jerk`): the whole
is C² and at rest at both ends. What such a curve overshoots is clamped to the limits.

A limb that nothing needs for a while goes on to where it is next needed, or to rest and back.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.minimum_jerk import through

Array = NDArray[np.float64]

GO_ON_S = 0.6
"""A limb that is needed again within this time goes on without rest."""

SHORTEST_S, LONGEST_S = 0.15, 0.5
"""Lengths of movements from and to rest."""

LONG_WAY_RAD = math.radians(80.0)
"""Largest change of a coordinate in a movement that takes the longest time."""


def transition_s(a: Array, b: Array) -> float:
    """Length of the movement between a posture and rest, by the coordinate that turns most."""
    way = float(np.max(np.abs(a - b), initial=0.0)) / LONG_WAY_RAD
    return SHORTEST_S + (LONGEST_S - SHORTEST_S) * min(1.0, way)


UNHURRIED_RAD_S2 = math.radians(2000.0)
"""Largest acceleration of a limb that has time."""
UNHURRIED_RAD_S3 = math.radians(30_000.0)
"""Largest jerk of such a limb."""
PEAK, PEAK_JERK = 10.0 / math.sqrt(3.0), 60.0
"""Largest acceleration and jerk of a movement of minimum jerk, over a way and a time of one."""
MOST_UNHURRIED_S = 0.7


def unhurried_s(a: Array, b: Array) -> float:
    """Length of the movement between a posture and rest with no haste in any coordinate."""
    way = float(np.max(np.abs(a - b), initial=0.0))
    calm = math.sqrt(PEAK * way / UNHURRIED_RAD_S2)
    smooth = math.cbrt(PEAK_JERK * way / UNHURRIED_RAD_S3)
    return float(np.clip(max(calm, smooth), SHORTEST_S, MOST_UNHURRIED_S))


@dataclass(frozen=True, slots=True, eq=False)
class LimbKey:
    """A limb's posture at a time.

    time_s: on the score's time line. values: the limb's coordinates, radians. passing: on the way,
    without stopping. held: something needs the limb from here until its next key. rest_s: length of
    the way from or to rest.
    """

    time_s: float
    values: Array
    passing: bool = False
    held: bool = False
    rest_s: float | None = None

    def way_s(self, rest: Array) -> float:
        """Length of the way from or to rest."""
        return transition_s(self.values, rest) if self.rest_s is None else self.rest_s


@dataclass(frozen=True, eq=False)
class LimbTrack:
    """All keys of one limb, rests included, in order of time; at rest before and after."""

    keys: tuple[LimbKey, ...]
    rest: Array

    @property
    def start_s(self) -> float:
        """When it leaves its rest for the first time; 0 if it never does."""
        return self.keys[0].time_s if self.keys else 0.0

    @property
    def end_s(self) -> float:
        """When it has come back to rest for good; 0 if it never left."""
        return self.keys[-1].time_s if self.keys else 0.0

    def sample(self, times_s: Array) -> Array:
        """Return the limb's coordinates at increasing times, (T, n); limits are the caller's."""
        out = np.broadcast_to(self.rest, (len(times_s), len(self.rest))).copy()
        if not len(times_s):
            return out
        first, last = float(times_s[0]), float(times_s[-1])
        for run in self.runs[bisect_left(self._ends, first) :]:
            if run[0].time_s > last:
                break
            _run(run, times_s, out)
        return out

    @cached_property
    def runs(self) -> tuple[tuple[LimbKey, ...], ...]:
        """The keys from each stop to the next, both included."""
        stops = [i for i, key in enumerate(self.keys) if not key.passing]
        return tuple(self.keys[a : b + 1] for a, b in pairwise(stops))

    @cached_property
    def _ends(self) -> list[float]:
        return [run[-1].time_s for run in self.runs]


def track(keys: Sequence[LimbKey], rest: Array) -> LimbTrack:
    """Complete a limb's keys with the way from rest, the way back, and rests between."""
    if not keys:
        return LimbTrack((), rest)
    first, last = keys[0], keys[-1]
    whole = [LimbKey(first.time_s - first.way_s(rest), rest)]
    for key, following in pairwise(keys):
        whole.append(key)
        gap = following.time_s - key.time_s
        back, forth = key.way_s(rest), following.way_s(rest)
        if not key.held and gap > GO_ON_S and gap >= back + forth:
            whole.append(LimbKey(key.time_s + back, rest))
            whole.append(LimbKey(following.time_s - forth, rest))
    whole.append(last)
    whole.append(LimbKey(last.time_s + last.way_s(rest), rest))
    return LimbTrack(tuple(_stopping_before_rests(whole)), rest)


def _stopping_before_rests(keys: list[LimbKey]) -> list[LimbKey]:
    """Let movements end at a key beside the first or last rest."""
    out = []
    for i, key in enumerate(keys):
        alone = i in (0, 1, len(keys) - 2, len(keys) - 1)
        out.append(replace(key, passing=key.passing and not alone))
    return out


def _run(keys: Sequence[LimbKey], times_s: Array, out: Array) -> None:
    """Fill in the frames from one stop to the next."""
    start, end = keys[0].time_s, keys[-1].time_s
    first = int(np.searchsorted(times_s, start, side="left"))
    last = int(np.searchsorted(times_s, end, side="right"))
    if first == last:
        return
    inside = slice(first, last)
    if end <= start:
        out[inside] = keys[-1].values
        return
    values = np.stack([key.values for key in keys])
    if np.all(values == values[0]):
        out[inside] = values[0]
        return
    knots = np.array([key.time_s for key in keys])
    out[inside] = through(knots, values, times_s[inside])
