"""Curves of a limb's joint coordinates through its keys.

Curves run on coordinates, not on quaternions: every convex combination of two postures is inside
the limits. Between two keys a limb moves by minimum jerk and stops at both. Keys inside a movement
(samples of a path) are passed without stopping, by the curve of
minimum jerk through all of them (see `minimum_jerk`): the whole has a continuous acceleration and
is still at both ends. Where such a curve overshoots the limits, it is clamped.

A limb that nothing needs for a while returns to the neutral posture. If it is needed again soon,
it goes there directly.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.clip.quintic import State, quintic
from azee.motion.curves.manner import share_of_way
from azee.motion.curves.minimum_jerk import curve_through
from azee_solver.constraint import Manner

Array = NDArray[np.float64]

DIRECT_WITHIN_S = 0.6
"""A limb that is needed again within this time does not return to neutral meanwhile."""

SHORTEST_S, LONGEST_S = 0.15, 0.5
LONGEST_TURN_RAD = math.radians(80.0)
"""Turn of a coordinate from which on a transition takes the longest time."""


def transition_s(a: Array, b: Array) -> float:
    """Time of a quick transition between two postures of a limb, by the farthest coordinate.

    SHORTEST_S + (LONGEST_S − SHORTEST_S) · min(1, max|a − b| / LONGEST_TURN_RAD)
    """
    share = float(np.max(np.abs(a - b), initial=0.0)) / LONGEST_TURN_RAD
    return SHORTEST_S + (LONGEST_S - SHORTEST_S) * min(1.0, share)


ONSET_SPREAD_S = 0.06
"""Between the onsets of the first and the last joint of an arm: people have 20 to 80 ms."""

CALM_RAD_S2 = math.radians(2000.0)
"""Largest acceleration of a limb that has time."""
CALM_RAD_S3 = math.radians(30_000.0)
"""Largest jerk of such a limb."""
PEAK_SPEED, PEAK_ACCELERATION, PEAK_JERK = 1.875, 10.0 / math.sqrt(3.0), 60.0
"""Largest |s′|, |s″| and |s‴| of minimum jerk, s(τ) = 10τ³ − 15τ⁴ + 6τ⁵ over 0 ≤ τ ≤ 1."""
LONGEST_CALM_S = 0.7


CALM_M_S = 1.5
"""Largest speed of a wrist that has time: people who sign rarely exceed it (docs/likeness.md)."""
PEAK_SPEED = 1.875
"""Largest s′."""


def calm_transition_s(a: Array, b: Array, way_m: float = 0.0) -> float:
    """Time in which a limb moves calmly from one posture to another by minimum jerk.

    With d = max|a − b|, no coordinate exceeds the acceleration A or the jerk J of a limb that has
    time if T ≥ √(PEAK_ACCELERATION · d / A) and T ≥ ∛(PEAK_JERK · d / J); T is kept between
    `SHORTEST_S` and `LONGEST_CALM_S`. A wrist that goes L = way_m does not exceed its speed v if
    T ≥ PEAK_SPEED · L / v, however long that is. Before, transitions of half a second at most
    turned forearms by 120° in that time (ADR 30).
    """
    turn = float(np.max(np.abs(a - b), initial=0.0))
    by_acceleration = math.sqrt(PEAK_ACCELERATION * turn / CALM_RAD_S2)
    by_jerk = math.cbrt(PEAK_JERK * turn / CALM_RAD_S3)
    by_turn = min(max(by_acceleration, by_jerk, SHORTEST_S), LONGEST_CALM_S)
    by_way = PEAK_SPEED * way_m / CALM_M_S
    return max(by_turn, by_way + ONSET_SPREAD_S if way_m else 0.0)


@dataclass(frozen=True, slots=True, eq=False)
class LimbKey:
    """A limb's posture at a time.

    time_s: on the score's time line. values: the limb's coordinates, radians. passing: the limb
    moves through it without stopping. held: something needs the limb from here until its next key.
    neutral_s: time of the transition from or to neutral; by default that of `transition_s`.
    manner: how the limb arrives, if it has stopped before. state: how it moves there, where a
    recording starts or ends. plays: the recording until the next key: coordinates at times.
    way_s: how long the recording gives the limb to come to the key, or to go from it.
    """

    time_s: float
    values: Array
    passing: bool = False
    held: bool = False
    neutral_s: float | None = None
    manner: Manner | None = None
    state: State | None = None
    plays: Callable[[Array], Array] | None = None
    way_s: float = 0.0

    def transition_s(self, neutral: Array) -> float:
        """Time of the transition from or to neutral."""
        return transition_s(self.values, neutral) if self.neutral_s is None else self.neutral_s


SPREAD_SHARE = 0.2
"""The spread is at most this share of a movement's time."""
FINGERS_DONE = 0.65
"""Share of the time of a movement of the hand in which its shape is formed."""
FINGERS_RAD_S = math.radians(600.0)
"""Fingers take longer rather than be faster."""


@dataclass(frozen=True, slots=True, eq=False)
class Onsets:
    """When the coordinates of a limb set out in a movement, and when they arrive.

    places: (n,) 0 for what sets out first, 1 for what arrives last. fingers: whether it is a
    finger, which arrives early.
    """

    places: Array
    fingers: bool

    def within(self, before: Array, after: Array, span_s: float) -> tuple[Array, Array]:
        """Return when coordinates set out and arrive, (n,) each, in a movement of `span_s`."""
        if self.fingers:
            turn = float(np.max(np.abs(after - before), initial=0.0))
            needed = PEAK_SPEED * turn / FINGERS_RAD_S
            done = min(span_s, max(FINGERS_DONE * span_s, needed))
            return np.zeros_like(before), np.full_like(before, done)
        spread = min(ONSET_SPREAD_S, SPREAD_SHARE * span_s)
        return spread * self.places, span_s - spread * (1.0 - self.places)


@dataclass(frozen=True, eq=False)
class LimbCurve:
    """All keys of one limb, neutral ones included, in order of time; neutral before and after.

    onsets: when each coordinate sets out.
    """

    keys: tuple[LimbKey, ...]
    neutral: Array
    onsets: Onsets | None = None

    @property
    def start_s(self) -> float:
        """When it leaves neutral for the first time; 0 if it never does."""
        return self.keys[0].time_s if self.keys else 0.0

    @property
    def end_s(self) -> float:
        """When it is back at neutral for good; 0 if it never left."""
        return self.keys[-1].time_s if self.keys else 0.0

    def sample(self, times_s: Array) -> Array:
        """Return the limb's coordinates at increasing times, (T, n); limits are the caller's."""
        out = np.broadcast_to(self.neutral, (len(times_s), len(self.neutral))).copy()
        if not len(times_s):
            return out
        first, last = float(times_s[0]), float(times_s[-1])
        for run in self.runs[bisect_left(self._run_ends, first) :]:
            if run.start_s > last:
                break
            run.sample(times_s, out)
        return out

    @cached_property
    def runs(self) -> tuple[_Run, ...]:
        """The movements from each stop to the next."""
        stops = [i for i, key in enumerate(self.keys) if not key.passing]
        return tuple(_Run(self.keys[a : b + 1], self.onsets) for a, b in pairwise(stops))

    @cached_property
    def _run_ends(self) -> list[float]:
        return [run.end_s for run in self.runs]


class _Run:
    """A movement of a limb through its keys, from one stop to the next."""

    def __init__(self, keys: Sequence[LimbKey], onsets: Onsets | None) -> None:
        self.start_s, self.end_s = keys[0].time_s, keys[-1].time_s
        self._knots = np.array([key.time_s for key in keys])
        self._values = np.stack([key.values for key in keys])
        self._still = bool(np.all(self._values == self._values[0]))
        self._onsets, self._manner = onsets, keys[-1].manner
        self._plays, self._moving = keys[0].plays, any(key.state for key in keys)
        first, last = (key.state or State.at_rest(key.values) for key in (keys[0], keys[-1]))
        self._ends = first, last

    def sample(self, times_s: Array, out: Array) -> None:
        """Fill in the rows of the times inside, both ends included."""
        first = int(np.searchsorted(times_s, self.start_s, side="left"))
        last = int(np.searchsorted(times_s, self.end_s, side="right"))
        if first == last:
            return
        rows, values = slice(first, last), self._values
        if self._plays is not None:
            out[rows] = self._plays(times_s[rows])
        elif self._moving and self.end_s > self.start_s:
            start, end = self._ends
            since_s, span_s = times_s[rows] - self.start_s, self.end_s - self.start_s
            out[rows] = quintic(start, end, span_s, since_s)
        elif self._still or self.end_s <= self.start_s:
            out[rows] = values[-1]
        elif len(values) == 2 and self._onsets is not None:
            a, b = self._onsets.within(values[0], values[1], self.end_s - self.start_s)
            share = share_of_way((times_s[rows, None] - self.start_s - a) / (b - a), self._manner)
            out[rows] = values[0] + (values[1] - values[0]) * share
        elif len(values) == 2 and self._manner is not None:
            lasts_s = self.end_s - self.start_s
            share = share_of_way((times_s[rows, None] - self.start_s) / lasts_s, self._manner)
            out[rows] = values[0] + (values[1] - values[0]) * share
        else:
            out[rows] = curve_through(self._knots, values, times_s[rows])


def limb_curve(keys: Sequence[LimbKey], neutral: Array, onsets: Onsets | None = None) -> LimbCurve:
    """Return the curve through a limb's keys, with the returns to neutral for which there is time.

    It comes from neutral before the first key and returns after the last. Between two keys it
    returns if nothing holds the limb, the gap is longer than `DIRECT_WITHIN_S` and both
    transitions fit into it.
    """
    if not keys:
        return LimbCurve((), neutral, onsets)
    first, last = keys[0], keys[-1]
    out = [LimbKey(first.time_s - first.transition_s(neutral), neutral)]
    for key, following in pairwise(keys):
        out.append(key)
        if key.plays is not None:
            continue
        gap = following.time_s - key.time_s
        back, forth = key.transition_s(neutral), following.transition_s(neutral)
        idle = gap - key.way_s - following.way_s
        if not key.held and idle > DIRECT_WITHIN_S and gap >= back + forth:
            out.append(LimbKey(key.time_s + back, neutral))
            out.append(LimbKey(following.time_s - forth, neutral))
    out.append(last)
    out.append(LimbKey(last.time_s + last.transition_s(neutral), neutral))
    return LimbCurve(tuple(_stopping_at_first_and_last(out)), neutral, onsets)


def _stopping_at_first_and_last(keys: list[LimbKey]) -> list[LimbKey]:
    """Let the limb stop at its first and last key, next to the outermost neutral ones.

    A recording starts where it stops, or takes over from one movement between two keys.
    """
    out = []
    for i, key in enumerate(keys):
        outermost = i in (0, 1, len(keys) - 2, len(keys) - 1)
        beside = any(other.state is not None for other in keys[max(0, i - 1) : i + 2])
        out.append(replace(key, passing=key.passing and not (outermost or beside)))
    return out
