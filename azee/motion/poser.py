"""Solving one moment after another: what a solve starts from, and which limbs it keys."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.bound import Bound, limbs_asked
from azee.motion.curves import GO_ON_S
from azee.motion.limbs import TRUNK, Limbs
from azee.motion.posture import KeyPosture, Origin, PostureSolver
from azee.motion.spans import Spans
from azee.motion.transpath import Travel, passing_limbs
from azee_rig.coordinates import Coordinates
from azee_solver.demand import Demand
from azee_solver.report import SolveReport

Array = NDArray[np.float64]

MOVED_RAD = math.radians(1.0)
"""A limb that nothing asked for is keyed if the solver moved it by more than this."""


def demands_of(
    bounds: Iterable[Bound], time: Fraction, paths: Iterable[Demand] = ()
) -> tuple[Demand, ...]:
    """Return what requirements ask at an instant, each distinct constraint once.

    A block that holds another repeats its constraints: twice the same morph must not add up.
    """
    asked: dict[tuple[object, float], Demand] = {}
    for demand in (*(b.demand(time) for b in bounds), *paths):
        asked.setdefault((demand.constraint, demand.phase), demand)
    return tuple(asked.values())


@dataclass(slots=True)
class Poser:
    """The state of a body as keyframes are solved in order of time.

    What constraints leave open is drawn to idle, never to the posture before: a trunk that gave
    way a little at each of many keyframes would end at its limits. The search starts from the
    posture before only in limbs that one block goes on constraining, so that no sign inherits an
    odd elbow from the last. A limb that nothing has needed for longer than `GO_ON_S` is taken to
    have gone to rest.
    """

    coordinates: Coordinates
    limbs: Limbs
    solver: PostureSolver
    travels: Spans[Travel] = field(default_factory=lambda: Spans(()))
    current: Array = field(init=False)
    last: KeyPosture | None = field(init=False, default=None)
    _needed: dict[str, Fraction] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self.current = np.array(self.coordinates.idle)

    def solve(
        self, time: Fraction, bounds: Sequence[Bound], origin: Origin = Origin.BOUNDARY
    ) -> KeyPosture:
        """Solve an instant, or take over the last posture where it asks for nothing new."""
        demands = demands_of(bounds, time)
        asked = limbs_asked(bounds)
        passing = passing_limbs(time, bounds, self.travels.at(time))
        current = self._rested(time)
        last = self.last
        if last is not None and _nothing_new(demands, last):
            keyed = asked | (last.limbs if set(demands) == set(last.demands) else frozenset())
            indices = [v for limb in keyed for v in self.limbs.members[limb]]
            if np.array_equal(current[indices], last.coordinates[indices]):
                return KeyPosture(
                    time, current, keyed, passing, tuple(bounds), demands, last.report,
                    origin, reused=True,
                )  # fmt: skip
        going_on = self._going_on(time, bounds)
        constrained = frozenset[str]().union(*(b.limbs for b in bounds)) | self._carried(bounds)
        reference = np.where(self._of(constrained), self.coordinates.idle, current)
        start = np.where(self._of(going_on), current, reference)
        report = self._beside_what_stands(bounds, demands, current, start, reference)
        if report is None:
            report = self.solver(demands, start=start, reference=reference)
        keyed = keyed_limbs(bounds, report.coordinates - reference, self.limbs)
        return KeyPosture(
            time, report.coordinates, keyed, passing, tuple(bounds), demands, report, origin
        )

    def _beside_what_stands(
        self,
        bounds: Sequence[Bound],
        demands: Sequence[Demand],
        current: Array,
        start: Array,
        reference: Array,
    ) -> SolveReport | None:
        """Solve what is new and leave limbs that blocks go on holding; none if that does not do.

        A head shake then moves the head alone, and what holds on holds still.
        """
        last = self.last
        if last is None or not last.met:
            return None
        changed = self.limbs.touching(np.flatnonzero(current != last.coordinates).tolist())
        before = {*last.bounds}
        kept = [
            b
            for b in bounds
            if b in before and not b.dynamic and not (b.limbs | b.read_limbs) & changed
        ]
        new = [b for b in bounds if b not in kept]
        free = _free_limbs(kept, new)
        fixed = frozenset(np.flatnonzero(~self._of(free)).tolist())
        if not kept or not new or not fixed:
            return None
        begin = np.where(self._of(free), start, current)
        report = self.solver(demands, start=begin, reference=reference, fixed=fixed)
        return report if report.met else None

    def accept(self, posture: KeyPosture) -> KeyPosture:
        """Go on from a posture."""
        self.current = np.array(posture.coordinates)
        for limb in posture.limbs:
            self._needed[limb] = posture.time
        self.last = posture
        return posture

    def _rested(self, time: Fraction) -> Array:
        """Return the last posture, with limbs that nothing has needed lately at rest."""
        out = self.current.copy()
        for limb, members in self.limbs.members.items():
            needed = self._needed.get(limb)
            busy = self.last is not None and any(
                self.last.holds(limb, b.limbs | b.read_limbs)
                for b in self.last.bounds
                if b.requirement.interval.end >= time
            )
            if needed is None or (time - needed > GO_ON_S and not busy):
                out[members] = self.coordinates.idle[members]
        return out

    def _of(self, limbs: frozenset[str]) -> NDArray[np.bool_]:
        """(V,) which coordinates belong to some limbs."""
        chosen: NDArray[np.bool_] = np.array([n in limbs for n in self.limbs.names])
        return chosen[self.limbs.of_coordinate]

    def _carried(self, bounds: Iterable[Bound]) -> frozenset[str]:
        """Return the trunk, which carries every limb, and the head that is levelled over it."""
        return frozenset((TRUNK, "head")) if any(b.limbs for b in bounds) else frozenset()

    def _going_on(self, time: Fraction, bounds: Iterable[Bound]) -> frozenset[str]:
        """Limbs that one block constrains both at the last posture and now."""
        if self.last is None:
            return frozenset()
        since = self.last.time
        going = (b for b in bounds if b.requirement.interval.start <= since < time)
        return frozenset().union(*(b.limbs for b in going))


def _free_limbs(kept: Iterable[Bound], new: Iterable[Bound]) -> frozenset[str]:
    """Return the limbs that must move for new requirements while others are kept.

    Those that the new ones speak of, and those of kept ones that share them or follow them. The
    trunk carries both arms: it stays with the block that had it first.
    """
    kept = [*kept]
    stays = frozenset((TRUNK,)) if any(TRUNK in b.limbs for b in kept) else frozenset()
    free = frozenset[str]().union(*(b.limbs for b in new)) - stays
    while True:
        drawn = [b.limbs for b in kept if free & (b.limbs | b.read_limbs)]
        wider = free.union(*drawn) - stays
        if wider == free:
            return free
        free = wider


def keyed_limbs(bounds: Iterable[Bound], moved: Array, limbs: Limbs) -> frozenset[str]:
    """Return the limbs that a solved posture is a key of.

    These are the limbs that the demands move or read, for a constraint holds only with them as
    the solver saw them, and any other that it moved (the head, levelled over a bent trunk).

    Args: moved: (V,) how far the solver moved coordinates from where they would be without it.
    """
    far = np.flatnonzero(np.abs(moved) > MOVED_RAD)
    return limbs_asked(bounds) | limbs.touching(int(v) for v in far)


def _nothing_new(demands: Iterable[Demand], last: KeyPosture) -> bool:
    """Whether an earlier answer serves: the same demands, or fewer and all were met."""
    before = {(d.constraint, d.phase) for d in last.demands}
    now = {(d.constraint, d.phase) for d in demands}
    return now == before or (last.met and now < before)
