"""Clearing the way: where a movement would lead through the body, it swerves round it.

Between keys a limb moves straight in joint space, which may lead a hand through the chest or a
thumb through a finger. Where capsules overlap on the way, the limbs that carry them, and that
nothing needs just then, make the smallest detour on which they do not: a change of their
coordinates that rises and falls smoothly between the two keys (see `swerve`), found by damped
least squares on all depths along the way at once. Keys and times stay as they are.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.curves.capsule_overlap import Overlaps
from azee.motion.curves.movement import Movement
from azee.motion.curves.via_points import Swerve
from azee.motion.tasks.limbs import LINKS
from azee.motion.tasks.spans import Spans
from azee.motion.tasks.timed_task import BoundScore
from azee.score.interval import Interval
from azee_solver.constraint import Constraint
from azee_solver.evaluate import Evaluator

Array = NDArray[np.float64]

LEFT = 0.25
"""Share of the wanted distance that may be missing in the end."""
SEEN = 0.3
"""Pairs are in the way when nearer than this share of the distance that ways keep."""
LEAST_M = 0.002
"""What comes nearer by no more than this than it is at an end of the way is let be."""
NEAR_M = 0.025
"""Pairs farther apart than this at the start of a detour do not bear on it."""
ABOUT_S = Fraction(1, 2)
"""A touch that is meant so near in time is meant on the way to it and from it."""
STEP_S = 1 / 50
CHUNK = 240
MOST_SAMPLES = 20
STEPS, STRIDE_RAD = 40, 0.15
DAMPING = 0.03
PASSES = 4
HASTY_S, UNHURRIED_S, LEAST_ROOM = 0.15, 0.45, 0.1
"""A wide berth in a short time is a jerk: ways that long and shorter are only just clear."""
TAPER = 0.35
"""Share of the way from an end in which what is near there comes apart."""
BETTER = 0.7
"""A detour is made if it leaves at most this share of the deepest overlap."""
WEIGHT_M = 0.015
"""A detour of one radian weighs as much as this overlap in one posture."""


_Gaps: TypeAlias = tuple[tuple[str, float, float], ...]
"""Limbs that nothing needs, each from when to when."""


@dataclass(frozen=True, slots=True, eq=False)
class Clearing:
    """What clears the ways of one movement.

    holders: limbs that something needs, by when.
    """

    evaluator: Evaluator
    score: BoundScore
    holders: Spans[frozenset[str]]
    overlaps: Overlaps

    @property
    def _seen(self) -> Array:
        """Depth from which on pairs are in the way, (P,) metres."""
        clear = self.overlaps.clear_m
        return np.where(clear > LEAST_M, -SEEN * clear, LEAST_M / 2)

    def cleared(self, movement: Movement) -> Movement:
        """Return a movement with detours where there is something in its way."""
        given_up: set[_Gaps] = set()
        for _ in range(PASSES):
            ways = _joined(self._obstructed(movement))
            added = []
            for gaps, (first, last) in ways.items():
                if gaps in given_up:
                    continue
                found = self._detour(movement, gaps, (first + last) / 2)
                if not found:
                    given_up.add(gaps)
                added += found
            if not added:
                break
            movement = replace(movement, swerves=(*movement.swerves, *added))
        return movement

    def meant(self, first_s: float, last_s: float) -> list[Constraint]:
        """Constraints in force about some time: touches that they mean are no obstacles."""
        span = Interval(
            Fraction(first_s).limit_denominator(10**6) - ABOUT_S,
            Fraction(last_s).limit_denominator(10**6) + ABOUT_S,
        )
        return [b.constraint for b in self.score.in_force.meeting(span)]

    def _obstructed(self, movement: Movement) -> dict[_Gaps, tuple[float, float]]:
        """Return who could swerve for what is in the way, and from when to when it is."""
        times = np.arange(movement.start_s - STEP_S, movement.end_s + STEP_S, STEP_S)
        out: dict[_Gaps, tuple[float, float]] = {}
        for start in range(0, len(times), CHUNK):
            part = times[start : start + CHUNK]
            for pair, rows in self._touching(movement.sample(part), part).items():
                for run in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1):
                    first, last = float(part[run[0]]), float(part[run[-1]])
                    gaps = self._gaps(movement, (first + last) / 2, pair)
                    if gaps:
                        before = out.get(gaps, (first, last))
                        out[gaps] = (min(first, before[0]), max(last, before[1]))
        return out

    def _touching(self, q: Array, times: Array) -> dict[int, NDArray[np.int64]]:
        """Return pairs that overlap in postures though they may not, and the rows where they do."""
        found: dict[int, list[int]] = {}
        moving = np.flatnonzero(np.any(np.diff(q, axis=0, prepend=q[:1]) != 0.0, axis=1))
        for rows in np.array_split(moving, max(1, len(moving) // 15)):
            if not len(rows):
                continue
            reach = self.overlaps.reach(self.meant(times[rows[0]], times[rows[-1]]))
            depth = self.overlaps.depth(q[rows], reach)
            for t, p in zip(*np.nonzero(depth > self._seen), strict=True):
                found.setdefault(int(p), []).append(int(rows[t]))
        return {pair: np.array(rows, dtype=np.int64) for pair, rows in found.items()}

    def _detour(self, movement: Movement, gaps: _Gaps, peak: float) -> list[Swerve]:
        """Return the smallest detour of free limbs that parts what overlaps; none if none."""
        base = [
            Swerve(
                movement.limbs.members[limb],
                np.zeros(len(movement.limbs.members[limb])),
                a, b, float(np.clip((peak - a) / (b - a), 0.0, 1.0)),
            )
            for limb, a, b in gaps
        ]  # fmt: skip
        start, end = min(s.start_s for s in base), max(s.end_s for s in base)
        count = int(np.clip((end - start) / STEP_S, 8, MOST_SAMPLES))
        times = np.linspace(start, end, count + 2)
        search = _Search(
            movement.sample(times),
            np.concatenate([swerve.members for swerve in base]),
            np.hstack([np.outer(s.share(times), np.ones(len(s.members))) for s in base]),
            self.overlaps,
            self.overlaps.reach(self.meant(start, end)),
            float(np.clip((end - start - HASTY_S) / (UNHURRIED_S - HASTY_S), LEAST_ROOM, 1.0)),
            movement.coordinates.lower,
            movement.coordinates.upper,
        )
        change = search.least()
        if change is None:
            return []
        ends = np.cumsum([len(swerve.members) for swerve in base])[:-1]
        parts = np.split(change, ends)
        return [replace(s, change=part) for s, part in zip(base, parts, strict=True)]

    def _gaps(self, movement: Movement, time: float, pair: int) -> _Gaps:
        """Return limbs that may swerve to part a pair, each with its free time about an instant."""
        names = movement.limbs.touching(self.overlaps.moved_by(pair)) - {*LINKS, "eyes"}
        arms = {n for n in names if n.startswith("arm_")}
        found = ((limb, self._free(movement, limb, time)) for limb in sorted(arms or names))
        return tuple((limb, *gap) for limb, gap in found if gap is not None)

    def _free(self, movement: Movement, limb: str, time: float) -> tuple[float, float] | None:
        """Return the time about an instant between two keys in which nothing needs a limb."""
        keys = [k.time_s for k in movement.tracks[limb].keys]
        after = int(np.searchsorted(keys, time))
        if after in (0, len(keys)):
            return None
        start, end = keys[after - 1], keys[after]
        span = Interval(
            Fraction(start).limit_denominator(10**6), Fraction(end).limit_denominator(10**6)
        )
        for interval, needed in self.holders.entries_meeting(span):
            if limb in needed:
                a, b = float(interval.start), float(interval.end)
                if a < time < b:
                    return None
                start = max(start, b) if b <= time else start
                end = min(end, a) if a >= time else end
        return (start, end) if start < time < end else None


def _joined(ways: Mapping[_Gaps, tuple[float, float]]) -> dict[_Gaps, tuple[float, float]]:
    """Join what the same limbs would have to swerve for at the same time."""
    out: dict[_Gaps, tuple[float, float]] = {}
    for gaps, (first, last) in ways.items():
        for other in [o for o in out if {*o} & {*gaps}]:
            before = out.pop(other)
            first, last = min(first, before[0]), max(last, before[1])
            gaps = tuple(sorted({*gaps, *other}))
        out[gaps] = first, last
    return out


@dataclass(frozen=True, slots=True, eq=False)
class _Search:
    """Damped least squares for the smallest change that parts all pairs along a way.

    q: (T, V) the way as it is. members: (n,) coordinates that change. shares: (T, n) how much of
    its change each has made. room: share of the wanted distance that there is the time for. What
    is near at an end of the way may be so near beside it.
    """

    q: Array
    members: NDArray[np.int64]
    shares: Array
    overlaps: Overlaps
    reach: Array
    room: float
    lower: Array
    upper: Array

    def least(self) -> Array | None:
        """Return the change, (n,) radians; none if it would hardly lessen the overlaps."""
        depth = self.overlaps.depth(self.q, self.reach)
        nearer = depth.max(axis=0) - np.maximum(depth[0], depth[-1])
        clear = self.overlaps.clear_m * self.room
        if not np.any((depth.max(axis=0) > -SEEN * clear) & (nearer > LEAST_M)):
            return None
        pairs = np.flatnonzero(np.any(depth > -NEAR_M, axis=0))
        wanted = self._wanted(depth[:, pairs], clear[pairs])
        enough = LEFT * float(np.min(clear[pairs]))
        c, damping = np.zeros(len(self.members)), DAMPING
        error, J = self._errors(c, pairs, wanted)
        began = float(np.max(error))
        for _ in range(STEPS):
            if np.max(error) <= enough:
                break
            lhs = J.T @ J + (WEIGHT_M**2 + damping) * np.eye(len(c))
            step = -np.linalg.solve(lhs, J.T @ error + WEIGHT_M**2 * c)
            step *= min(1.0, STRIDE_RAD / max(1e-9, float(np.max(np.abs(step)))))
            new, slope = self._errors(c + step, pairs, wanted)
            if np.sum(new**2) < np.sum(error**2):
                c, error, J, damping = c + step, new, slope, damping / 3
            else:
                damping *= 8
        return c if float(np.max(error)) < BETTER * began else None

    def _wanted(self, depth: Array, clear: Array) -> Array:
        """Depths that pairs may have along the way, (T, P) metres."""
        ends = np.maximum(depth[[0, -1]], -clear)
        along = np.linspace(0.0, 1.0, len(self.q))[:, None]
        leaving = 1.0 - minimum_jerk(along / TAPER)
        coming = 1.0 - minimum_jerk((1.0 - along) / TAPER)
        near = np.maximum((ends[0] + clear) * leaving, (ends[1] + clear) * coming)
        return np.asarray(near - clear)

    def _errors(
        self, change: Array, pairs: NDArray[np.int64], wanted: Array
    ) -> tuple[Array, Array]:
        """Depths beyond what is wanted after a change, (T · P,) metres, and slopes, (T · P, n)."""
        asked = self.q.copy()
        asked[:, self.members] += self.shares * change
        q = np.clip(asked, self.lower, self.upper)
        least = float(wanted.min(initial=math.inf))
        depth, slope = self.overlaps.slopes(q, self.reach, pairs, self.members, least)
        beyond = depth - wanted
        # A coordinate at its limit does not move, what is far enough does not count.
        moving = (asked == q)[:, None, self.members] & (beyond > 0.0)[..., None]
        J = slope * self.shares[:, None, :] * moving
        return np.maximum(beyond, 0.0).ravel(), J.reshape(beyond.size, -1)
