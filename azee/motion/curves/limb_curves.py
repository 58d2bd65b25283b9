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
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.clip.quintic import State, quintic
from azee.clip.spline import minimum_jerk
from azee.motion.curves.manner import share_of_way
from azee.motion.curves.minimum_jerk import MinimumJerkCurve
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

    def within(self, turns: Array, spans_s: Array) -> tuple[Array, Array]:
        """Return when coordinates set out and arrive in movements, (m, n) seconds each.

        Args: turns: (m, n) how far each coordinate turns, radians. spans_s: (m,) the whole times.
        """
        spans = spans_s[:, None]
        if self.fingers:
            turn = np.max(np.abs(turns), axis=1, initial=0.0, keepdims=True)
            needed = PEAK_SPEED * turn / FINGERS_RAD_S
            done = np.minimum(spans, np.maximum(FINGERS_DONE * spans, needed))
            return np.zeros_like(turns), np.broadcast_to(done, turns.shape)
        spread = np.minimum(ONSET_SPREAD_S, SPREAD_SHARE * spans)
        return spread * self.places, spans - spread * (1.0 - self.places)


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
        if len(self.keys) > 1:
            self._runs.sample(times_s, out)
        return out

    @cached_property
    def _runs(self) -> _Runs:
        return _Runs(self.keys, self.onsets)


class _Runs:
    """The movements of a limb from each stop to the next, end to end, as arrays of m rows.

    Nearly all are of minimum jerk between two keys, and are sampled together. Those along a path,
    of a manner of its own and from or into a recording are sampled one by one.
    """

    def __init__(self, keys: Sequence[LimbKey], onsets: Onsets | None) -> None:
        stops = [i for i, key in enumerate(keys) if not key.passing]
        times_s = np.array([keys[i].time_s for i in stops])
        values = np.stack([keys[i].values for i in stops])
        self._starts_s, self._ends_s = times_s[:-1], times_s[1:]
        self._values = values[:-1]
        self._ways: Array = np.diff(values, axis=0)
        spans_s = self._ends_s - self._starts_s
        if onsets is None:
            whole = np.broadcast_to(spans_s[:, None], self._ways.shape)
            self._set_out, self._lasting = np.zeros_like(whole), whole
        else:
            self._set_out, arrived = onsets.within(self._ways, spans_s)
            self._lasting = arrived - self._set_out
        self._lasting = np.where(self._lasting > 0.0, self._lasting, 1.0)
        self._own = {
            run: own
            for run, (a, b) in enumerate(pairwise(stops))
            if (own := self._own_curve(run, keys[a : b + 1])) is not None
        }

    def _own_curve(self, run: int, keys: Sequence[LimbKey]) -> Callable[[Array], Array] | None:
        """Return the curve of a run that is not of minimum jerk between two keys."""
        first, last = keys[0], keys[-1]
        if first.plays is not None:
            return first.plays
        if last.time_s <= first.time_s:
            return lambda times_s: np.broadcast_to(last.values, (len(times_s), len(last.values)))
        if any(key.state for key in keys):
            return partial(_between_states, first, last)
        if len(keys) == 2:
            return None if last.manner is None else partial(self._of_manner, run, last.manner)
        values = np.stack([key.values for key in keys])
        if np.all(values == values[0]):
            return None
        return MinimumJerkCurve(np.array([key.time_s for key in keys]), values)

    def sample(self, times_s: Array, out: Array) -> None:
        """Fill in the rows of the times inside, the first and the last included."""
        first = int(np.searchsorted(times_s, self._starts_s[0], side="left"))
        last = int(np.searchsorted(times_s, self._ends_s[-1], side="right"))
        if first == last:
            return
        times_s = times_s[first:last]
        runs = np.searchsorted(self._starts_s, times_s, side="right") - 1
        out[first:last] = self._along(runs, minimum_jerk(self._shares(runs, times_s)))
        for run in range(runs[0], runs[-1] + 1) if self._own else ():
            if run in self._own:
                a, b = np.searchsorted(runs, (run, run + 1))
                if a < b:
                    out[first + a : first + b] = self._own[run](times_s[a:b])

    def _of_manner(self, run: int, manner: Manner, times_s: Array) -> Array:
        runs = np.full(len(times_s), run)
        return self._along(runs, share_of_way(self._shares(runs, times_s), manner))

    def _shares(self, runs: NDArray[np.int64], times_s: Array) -> Array:
        """Return which share of its time each coordinate has had, (T, n)."""
        since_s = (times_s - self._starts_s[runs])[:, None]
        shares: Array = (since_s - self._set_out[runs]) / self._lasting[runs]
        return shares

    def _along(self, runs: NDArray[np.int64], share: Array) -> Array:
        values: Array = self._values[runs] + self._ways[runs] * share
        return values


def _between_states(first: LimbKey, last: LimbKey, times_s: Array) -> Array:
    start, end = (key.state or State.at_rest(key.values) for key in (first, last))
    return quintic(start, end, last.time_s - first.time_s, times_s - first.time_s)


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
        if key.passing and (
            outermost or any(other.state is not None for other in keys[i - 1 : i + 2])
        ):
            key = replace(key, passing=False)
        out.append(key)
    return out
