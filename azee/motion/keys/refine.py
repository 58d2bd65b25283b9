"""Holding constraints between keys: add key postures on the way, until every frame is right.

Between two keys that meet a constraint the interpolated posture may not. There a key is added
at the worst frame, solved from the posture that the curve has there and drawn to it, and the limbs
pass through it without stopping. Repeated, this halves the stretches that are too long.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.movement import Movement, movement
from azee.motion.keys.amend import Amending
from azee.motion.keys.boundaries import active
from azee.motion.keys.posture_solver import tasks_of
from azee.motion.keys.residual_monitor import Gauge, Instants, instants
from azee.motion.tasks.keying import Keying, fresh
from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.posture import KeyPosture, Origin, PostureSolver
from azee.motion.tasks.spans import Spans
from azee_solver.constraint import Constraint

Array = NDArray[np.float64]

ROUNDS = 12
MARGIN = 0.9
"""Share of the tolerance that an interpolated posture may use up before a key is added."""
NO_WORSE = 1.1
"""Between keys that miss a constraint, it may be missed by this much more."""
TRIALS = 4
"""So often an instant is solved anew because other tracks have changed since."""
CLOSEST_S = 0.003
"""Keys nearer than this to another would only shake."""
NEIGHBOURS = 3
"""A key that is added bends the curve about as many keys away; those stretches are checked."""


@dataclass(frozen=True, slots=True, eq=False)
class Refined:
    """Key postures in order of time, the movement through them, measured at frames and keys."""

    postures: tuple[KeyPosture, ...]
    movement: Movement
    instants: Instants


@dataclass(frozen=True, slots=True, eq=False)
class Refinement:
    """What solves moments on the way, once boundaries and courses are known."""

    gauge: Gauge
    keying: Keying
    solver: PostureSolver
    holders: Spans[frozenset[str]]
    """Limbs that something needs, by when."""
    hopeless: frozenset[Constraint] = frozenset()
    """Constraints that a key posture at a boundary could not meet."""

    @property
    def limbs(self) -> Limbs:
        """The limbs of the body."""
        return self.keying.limbs

    def join(self, postures: Iterable[KeyPosture]) -> Movement:
        """Return the movement through key postures."""
        ordered = sorted(postures, key=lambda p: p.time)
        coordinates = self.gauge.evaluator.rig.coordinates
        return movement(
            ordered, self.holders, coordinates, self.limbs, together=not self.keying.flat
        )

    def solve(
        self,
        times: Sequence[Fraction],
        movement: Movement,
        origin: Origin,
        passing: Sequence[frozenset[str]] | None = None,
    ) -> list[KeyPosture]:
        """Solve increasing instants, each from where a movement has the body then.

        Args: passing: limbs that pass through each key; by default all do.
        """
        if not times:
            return []
        at = instants(movement, times, self.gauge.evaluator)
        every = frozenset(self.limbs.names)
        amending = Amending(self.gauge, self.limbs, self.solver, self.hopeless)
        out = []
        for i, (time, q) in enumerate(zip(times, at.q, strict=True)):
            one = at.only(slice(i, i + 1))
            bounds = active(self.gauge.score, time, self.gauge.giving_way)
            steering = self.gauge.steering(time)
            targets = (c.target([time], one.frames, self.gauge.evaluator)[0] for c in steering)
            paths = [c.task(t) for c, t in zip(steering, targets, strict=True)]
            asking = [*bounds, *(c.travel.bound for c in steering)]
            tasks = tasks_of(bounds, time, paths)
            begun = fresh(bounds, time) if origin is Origin.BOUNDARY else []
            report = amending.solve(one, asking, begun, tasks)
            lost = {c.task.constraint for c in report.constraints if not c.met}
            missed = [b for b in asking if b.constraint in lost]
            keyed = self.keying.on_the_way([*begun, *missed], report.coordinates - q)
            through = every if passing is None else passing[i]
            out.append(
                KeyPosture(
                    time, report.coordinates, keyed, through, tuple(asking),
                    tuple(c.task for c in report.constraints), report, origin,
                )
            )  # fmt: skip
        return out

    def refined(self, postures: Iterable[KeyPosture], frame_times: Sequence[Fraction]) -> Refined:
        """Return key postures with those added that the frames need.

        A flattened score has no others than its boundaries and the samples of its paths.
        """
        out = sorted(postures, key=lambda p: p.time)
        if self.keying.flat:
            current, at = self._measured(out, frame_times)
            return Refined(tuple(out), current, at)
        near: Sequence[Fraction] | None = None  # frames to look at; none for all
        tried: Counter[Fraction] = Counter()
        for _ in range(ROUNDS):
            current, at = self._measured(out, frame_times if near is None else near)
            worst = [t for t in self._worst(at, out) if tried[t] < TRIALS]
            if worst:
                tried.update(worst)
                near = _near(worst, sorted({p.time for p in out}), frame_times)
                out = merged(out, self.solve(worst, current, Origin.ADDED))
            elif near is None:
                return Refined(tuple(out), current, at)
            else:
                near = None
        current, at = self._measured(out, frame_times)
        return Refined(tuple(out), current, at)

    def _measured(
        self, postures: Iterable[KeyPosture], frame_times: Iterable[Fraction]
    ) -> tuple[Movement, Instants]:
        """Return the movement through postures, and it at frames and keys."""
        current = self.join(postures)
        keys = {p.time for p in postures}
        return current, instants(current, sorted({*frame_times, *keys}), self.gauge.evaluator)

    def _worst(self, at: Instants, postures: Sequence[KeyPosture]) -> list[Fraction]:
        """Return the worst instant of every stretch between keys that has one out of tolerance."""
        keys = sorted({p.time for p in postures})
        if len(keys) < 2:
            return []
        key_s = np.array([float(t) for t in keys])
        stretch = np.clip(np.searchsorted(key_s, at.seconds, side="right") - 1, 0, len(keys) - 2)
        ratio = self._ratios(at, self._key_rows(at, postures), self._missed_rows(at, postures))
        out = []
        for s in np.unique(stretch[ratio > 1.0]):
            members = np.flatnonzero(stretch == s)
            out.append(at.times[int(members[int(np.argmax(ratio[members]))])])
        return out

    def _key_rows(
        self, at: Instants, postures: Sequence[KeyPosture]
    ) -> dict[str, NDArray[np.int64]]:
        """Rows of every limb's keys among the instants, increasing."""
        found: dict[str, list[int]] = {name: [] for name in self.limbs.names}
        rows = np.searchsorted(at.seconds, [float(p.time) for p in postures])
        for posture, row in zip(postures, rows.tolist(), strict=True):
            for limb in posture.limbs:
                found[limb].append(row)
        return {limb: np.array(rows, dtype=np.int64) for limb, rows in found.items()}

    def _missed_rows(
        self, at: Instants, postures: Sequence[KeyPosture]
    ) -> dict[Constraint, set[int]]:
        """Rows of the keys at which the solver could not meet a constraint."""
        found: dict[Constraint, set[int]] = {}
        rows = np.searchsorted(at.seconds, [float(p.time) for p in postures])
        for posture, row in zip(postures, rows.tolist(), strict=True):
            for answer in posture.report.constraints:
                if not answer.met:
                    found.setdefault(answer.task.constraint, set()).add(row)
        return found

    def _ratios(
        self,
        at: Instants,
        key_rows: Mapping[str, NDArray[np.int64]],
        missed_rows: Mapping[Constraint, set[int]],
    ) -> Array:
        """Largest residual at every instant over what is allowed there, (T,).

        Between two keys that miss a constraint though they key all that it depends on, it may be
        missed a little more.
        """
        ratio = np.zeros(len(at.times))
        for bound in self.gauge.measurable:
            rows = self.gauge.inside(bound, at.seconds, enforced=True)
            if rows.start == rows.stop:
                continue
            residual = self.gauge.residual(bound, at.only(rows))
            asked = (bound.limbs | bound.read_limbs) or self.limbs.names
            keys = [_around(key_rows[limb], rows) for limb in asked]
            own = np.unique(np.concatenate(keys))
            settled = np.isin(own, [*missed_rows.get(bound.constraint, ())])
            settled |= np.all([np.isin(own, k) for k in keys], axis=0)
            full = own[settled]
            allowed = np.full(len(full) + 1, self.gauge.tolerance(bound) * MARGIN)
            inside = np.flatnonzero((full >= rows.start) & (full < rows.stop))
            allowed[inside] = np.fmax(
                allowed[inside], NO_WORSE * residual[full[inside] - rows.start]
            )
            after = np.searchsorted(full, np.arange(rows.start, rows.stop))
            excess = residual / np.maximum(allowed[after - 1], allowed[after])
            here = own[(own >= rows.start) & (own < rows.stop)] - rows.start
            excess[here] *= MARGIN
            excess[_near_keys(at.seconds, own, rows)] = 0.0
            ratio[rows] = np.fmax(ratio[rows], excess)
        return ratio


def _around(keys: NDArray[np.int64], rows: slice) -> NDArray[np.int64]:
    """Rows of a limb's keys inside some rows, and of the ones before and after them."""
    first, last = np.searchsorted(keys, (rows.start, rows.stop))
    return keys[max(0, int(first) - 1) : int(last) + 1]


def _near_keys(seconds: Array, own: NDArray[np.int64], rows: slice) -> NDArray[np.bool_]:
    """Which instants of some rows are beside a key, but too near for another one, (R,)."""
    if not len(own):
        return np.zeros(rows.stop - rows.start, dtype=np.bool_)
    at, keys = seconds[rows], seconds[own]
    after = np.searchsorted(keys, at)
    away = np.minimum(
        np.abs(at - keys[np.maximum(after - 1, 0)]),
        np.abs(keys[np.minimum(after, len(keys) - 1)] - at),
    )
    return np.asarray((away > 0.0) & (away < CLOSEST_S))


def merged(postures: Iterable[KeyPosture], added: Iterable[KeyPosture]) -> list[KeyPosture]:
    """Return key postures in order of time; what is added to an instant completes its key."""
    by_time = {p.time: p for p in postures}
    for new in added:
        old = by_time.get(new.time)
        if old is not None:
            through = old.passing | (new.limbs - old.limbs)
            new = replace(new, limbs=old.limbs | new.limbs, passing=through, origin=old.origin)
        by_time[new.time] = new
    return sorted(by_time.values(), key=lambda p: p.time)


def _near(
    added: Sequence[Fraction], keys: Sequence[Fraction], frame_times: Sequence[Fraction]
) -> list[Fraction]:
    """Return the frames in the stretches that added keys change."""
    rows: set[int] = set()
    for time in added:
        k = bisect_left(keys, time)
        first = keys[max(0, k - 1 - NEIGHBOURS)]
        last = keys[min(len(keys) - 1, k + NEIGHBOURS)]
        rows.update(range(bisect_left(frame_times, first), bisect_right(frame_times, last)))
    return [frame_times[i] for i in sorted(rows)]
