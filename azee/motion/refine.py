"""Holding constraints between keys: add key postures on the way, until every frame is right.

Between two keys that meet a constraint the interpolated posture may not. There a key is added
at the worst frame, solved from the posture that the curve has there and drawn to it, and the limbs
pass through it without stopping. Repeated, this halves the stretches that are too long.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.gauge import Gauge, Instants, instants
from azee.motion.keyframes import active
from azee.motion.limbs import Limbs
from azee.motion.movement import Movement, movement
from azee.motion.poser import demands_of, solved
from azee.motion.posture import KeyPosture, Origin, PostureSolver
from azee.motion.spans import Spans
from azee.motion.transpath import Course

Array = NDArray[np.float64]

ROUNDS = 8
MARGIN = 0.9
"""Share of the tolerance that an interpolated posture may use up before a key is added."""
NO_WORSE = 1.1
"""Between keys that miss a constraint, it may be missed by this much more."""
CLOSEST_S = 0.012
"""Keys nearer than this to another would only shake."""


@dataclass(frozen=True, slots=True, eq=False)
class Refinement:
    """What solves moments on the way, once boundaries and courses are known."""

    gauge: Gauge
    limbs: Limbs
    solver: PostureSolver
    holders: Spans[frozenset[str]]
    """Limbs that something needs, by when."""

    def join(self, postures: Iterable[KeyPosture]) -> Movement:
        """Return the movement through key postures."""
        ordered = sorted(postures, key=lambda p: p.time)
        coordinates = self.gauge.evaluator.rig.coordinates
        return movement(ordered, self.holders, coordinates, self.limbs)

    def solve(
        self,
        time: Fraction,
        movement: Movement,
        origin: Origin,
        passing: frozenset[str] | None = None,
    ) -> KeyPosture:
        """Solve an instant from where a movement has the body. By default every limb passes."""
        bounds = active(self.gauge.score, time, self.gauge.giving_way)
        steering = self.gauge.steering(time)
        q = movement.sample(np.array([float(time)]))
        demands = demands_of(
            bounds, time, [c.demand(t) for c, t in self._targets(steering, time, q)]
        )
        asking = (*bounds, *(c.travel.bound for c in steering))
        return solved(
            time, asking, demands, q[0], q[0], origin,
            frozenset(self.limbs.names) if passing is None else passing,
            limbs=self.limbs, solver=self.solver,
        )  # fmt: skip

    def _targets(
        self, steering: Iterable[Course], time: Fraction, q: Array
    ) -> Iterable[tuple[Course, Array]]:
        evaluator = self.gauge.evaluator
        frames = evaluator.rig.chain.frames(q)
        for course in steering:
            yield course, course.target([time], frames, evaluator)[0]

    def added(
        self, postures: Sequence[KeyPosture], frame_times: Sequence[Fraction]
    ) -> list[KeyPosture]:
        """Return key postures with those added that every frame needs."""
        out = sorted(postures, key=lambda p: p.time)
        for _ in range(ROUNDS):
            current = self.join(out)
            keys = sorted({p.time for p in out})
            worst = self._worst(current, keys, frame_times)
            if not worst:
                break
            out += [self.solve(t, current, Origin.ADDED) for t in worst]
            out.sort(key=lambda p: p.time)
        return out

    def _worst(
        self, current: Movement, keys: Sequence[Fraction], frame_times: Sequence[Fraction]
    ) -> list[Fraction]:
        """Return the worst frame of every stretch between keys that has one out of tolerance."""
        if len(keys) < 2:
            return []
        at_keys = instants(current, keys, self.gauge.evaluator)
        inside = [t for t in frame_times if keys[0] < t < keys[-1]]
        if not inside:
            return []
        at = instants(current, inside, self.gauge.evaluator)
        stretch = np.searchsorted(at_keys.seconds, at.seconds, side="right") - 1
        ratio = self._ratios(at, at_keys, stretch)
        near = np.minimum(
            at.seconds - at_keys.seconds[stretch], at_keys.seconds[stretch + 1] - at.seconds
        )
        ratio[near < CLOSEST_S] = 0.0
        out = []
        for s in np.unique(stretch):
            members = np.flatnonzero(stretch == s)
            best = members[int(np.argmax(ratio[members]))]
            if ratio[best] > 1.0:
                out.append(at.times[int(best)])
        return out

    def _ratios(self, at: Instants, at_keys: Instants, stretch: NDArray[np.int64]) -> Array:
        """Largest residual at every frame over what is allowed there, (T,)."""
        ratio = np.zeros(len(at.times))
        for bound in self.gauge.measurable:
            rows = self.gauge.inside(bound, at.seconds, enforced=True)
            if rows.start == rows.stop:
                continue
            first, last = int(stretch[rows.start]), int(stretch[rows.stop - 1]) + 2
            allowed = np.full(last - first, self.gauge.tolerance(bound) * MARGIN)
            keys = self.gauge.inside(bound, at_keys.seconds, enforced=True)
            keys = slice(max(keys.start, first), min(keys.stop, last))
            if keys.start < keys.stop:
                missed = self.gauge.residual(bound, at_keys.only(keys))
                met = slice(keys.start - first, keys.stop - first)
                allowed[met] = np.fmax(allowed[met], NO_WORSE * missed)
            own = stretch[rows] - first
            limit = np.maximum(allowed[own], allowed[own + 1])
            residual = self.gauge.residual(bound, at.only(rows))
            ratio[rows] = np.fmax(ratio[rows], residual / limit)
        return ratio
