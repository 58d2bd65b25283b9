"""Holding constraints between keys: add key postures on the way, until every frame is right.

Between two keys that meet a constraint the interpolated posture may not. There a key is added
at the worst frame, solved from the posture that the curve has there and drawn to it, and the limbs
pass through it without stopping. Repeated, this halves the stretches that are too long.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.bound import Bound
from azee.motion.gauge import Gauge, Instants, instants
from azee.motion.keyframes import active
from azee.motion.limbs import TRUNK, Limbs
from azee.motion.movement import Movement, movement
from azee.motion.poser import demands_of, keyed_limbs
from azee.motion.posture import KeyPosture, Origin, PostureSolver, Search
from azee.motion.spans import Spans
from azee_solver.constraint import Constraint
from azee_solver.demand import Demand
from azee_solver.report import SolveReport

Array = NDArray[np.float64]

ROUNDS = 12
MARGIN = 0.9
"""Share of the tolerance that an interpolated posture may use up before a key is added."""
NO_WORSE = 1.1
"""Between keys that miss a constraint, it may be missed by this much more."""
CLOSEST_S = 0.005
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
    limbs: Limbs
    solver: PostureSolver
    holders: Spans[frozenset[str]]
    """Limbs that something needs, by when."""
    hopeless: frozenset[Constraint] = frozenset()
    """Constraints that a key posture at a boundary could not meet."""

    def join(self, postures: Iterable[KeyPosture]) -> Movement:
        """Return the movement through key postures."""
        ordered = sorted(postures, key=lambda p: p.time)
        coordinates = self.gauge.evaluator.rig.coordinates
        return movement(ordered, self.holders, coordinates, self.limbs)

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
        out = []
        for i, (time, q) in enumerate(zip(times, at.q, strict=True)):
            one = at.only(slice(i, i + 1))
            bounds = active(self.gauge.score, time, self.gauge.giving_way)
            steering = self.gauge.steering(time)
            targets = (c.target([time], one.frames, self.gauge.evaluator)[0] for c in steering)
            paths = [c.demand(t) for c, t in zip(steering, targets, strict=True)]
            asking = [*bounds, *(c.travel.bound for c in steering)]
            demands = demands_of(bounds, time, paths)
            report = self._beside_the_trunk(one, bounds, demands) or self._whole(demands, q)
            keyed = keyed_limbs(asking, report.coordinates - q, self.limbs)
            through = every if passing is None else passing[i]
            out.append(
                KeyPosture(
                    time, report.coordinates, keyed, through, tuple(asking),
                    tuple(c.demand for c in report.constraints), report, origin,
                )
            )  # fmt: skip
        return out

    def _beside_the_trunk(
        self, one: Instants, bounds: Sequence[Bound], demands: Sequence[Demand]
    ) -> SolveReport | None:
        """Leave the trunk to its own curve and solve the rest; none if that does not do.

        The trunk links both arms: moved for one it would disturb the other's way.
        """
        own = frozenset(self.limbs.members.get(TRUNK, np.empty(0, dtype=np.int64)).tolist())
        aside = [b for b in bounds if b.moves and b.moves <= own]
        for b in aside:
            if not float(self.gauge.residual(b, one)[0]) <= self.gauge.tolerance(b):
                return None
        left = {b.constraint for b in aside}
        asked = [d for d in demands if d.constraint not in left]
        report = self.solver(
            asked, start=one.q[0], reference=one.q[0], search=Search.NEAR, fixed=own
        )
        return report if report.met else None

    def _whole(self, demands: Sequence[Demand], q: Array) -> SolveReport:
        """Solve with all of the body, near if that will do, else looking farther."""
        near = self.solver(demands, start=q, reference=q, search=Search.NEAR)
        lost = {c.demand.constraint for c in near.constraints if not c.met}
        if lost <= self.hopeless:
            return near
        wide = self.solver(demands, start=q, reference=q)
        missed = [sum(not c.met for c in r.constraints) for r in (near, wide)]
        return wide if missed[1] < missed[0] else near

    def refined(self, postures: Iterable[KeyPosture], frame_times: Sequence[Fraction]) -> Refined:
        """Return key postures with those added that the frames need."""
        out = sorted(postures, key=lambda p: p.time)
        near: Sequence[Fraction] | None = None  # frames to look at; none for all
        for _ in range(ROUNDS):
            current, keys, at = self._measured(out, frame_times if near is None else near)
            worst = self._worst(at, keys)
            if worst:
                out += self.solve(worst, current, Origin.ADDED)
                out.sort(key=lambda p: p.time)
                near = _near(worst, keys, frame_times)
            elif near is None:
                return Refined(tuple(out), current, at)
            else:
                near = None
        current, _, at = self._measured(out, frame_times)
        return Refined(tuple(out), current, at)

    def _measured(
        self, postures: Iterable[KeyPosture], frame_times: Iterable[Fraction]
    ) -> tuple[Movement, list[Fraction], Instants]:
        """Return the movement through postures, their times, and it at frames and keys."""
        current = self.join(postures)
        keys = sorted({p.time for p in postures})
        at = instants(current, sorted({*frame_times, *keys}), self.gauge.evaluator)
        return current, keys, at

    def _worst(self, at: Instants, keys: Sequence[Fraction]) -> list[Fraction]:
        """Return the worst instant of every stretch between keys that has one out of tolerance."""
        if len(keys) < 2:
            return []
        key_s = np.array([float(t) for t in keys])
        stretch = np.clip(np.searchsorted(key_s, at.seconds, side="right") - 1, 0, len(keys) - 2)
        ratio = self._ratios(at, stretch, np.searchsorted(at.seconds, key_s))
        near = np.minimum(
            np.abs(at.seconds - key_s[stretch]), np.abs(key_s[stretch + 1] - at.seconds)
        )
        ratio[near < CLOSEST_S] = 0.0
        out = []
        for s in np.unique(stretch[ratio > 1.0]):
            members = np.flatnonzero(stretch == s)
            out.append(at.times[int(members[int(np.argmax(ratio[members]))])])
        return out

    def _ratios(
        self, at: Instants, stretch: NDArray[np.int64], key_rows: NDArray[np.int64]
    ) -> Array:
        """Largest residual at every instant over what is allowed there, (T,).

        Args: stretch: (T,) which two keys an instant is between. key_rows: (K,) the keys' own rows.
        """
        ratio = np.zeros(len(at.times))
        for bound in self.gauge.measurable:
            rows = self.gauge.inside(bound, at.seconds, enforced=True)
            if rows.start == rows.stop:
                continue
            residual = self.gauge.residual(bound, at.only(rows))
            first, last = int(stretch[rows.start]), int(stretch[rows.stop - 1]) + 2
            allowed = np.full(last - first, self.gauge.tolerance(bound) * MARGIN)
            own = key_rows[first:last] - rows.start
            inside = np.flatnonzero((own >= 0) & (own < len(residual)))
            allowed[inside] = np.fmax(allowed[inside], NO_WORSE * residual[own[inside]])
            between = stretch[rows] - first
            limit = np.maximum(allowed[between], allowed[between + 1])
            ratio[rows] = np.fmax(ratio[rows], residual / limit)
        return ratio


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
