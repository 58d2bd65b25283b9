"""Which limbs have come to rest by an instant."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.limb_curves import GO_ON_S, transition_s
from azee.motion.tasks.limbs import TRUNK, Limbs
from azee.motion.tasks.posture import KeyPosture
from azee.motion.tasks.timed_task import Bound, limbs_asked

Array = NDArray[np.float64]

CARRIERS = frozenset((TRUNK, "head", "eyes"))
"""Limbs that come back though others read them: a hand at the forehead follows the head."""


@dataclass(slots=True)
class Rest:
    """Remembers when limbs were needed, as keyframes are solved in order of time.

    bounds: all that a score requires of postures. idle: (V,) the resting posture.
    """

    bounds: Iterable[Bound]
    limbs: Limbs
    idle: Array
    _starts: dict[str, list[Fraction]] = field(init=False)
    _needed: dict[str, Fraction] = field(init=False, default_factory=dict)
    _claimed: dict[str, Fraction] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self._starts = {name: [] for name in self.limbs.names}
        for b in self.bounds:
            for limb in b.limbs:
                self._starts[limb].append(b.requirement.interval.start)
        for starts in self._starts.values():
            starts.sort()

    def note(self, posture: KeyPosture) -> None:
        """Remember what a posture needs."""
        for limb in posture.limbs | limbs_asked(posture.bounds):
            self._needed[limb] = posture.time
        for b in posture.bounds:
            for limb in b.limbs:
                self._claimed[limb] = posture.time

    def since(self, limb: str, time: Fraction) -> float:
        """How long ago a limb was claimed last; without end if it never was."""
        claimed = self._claimed.get(limb)
        return math.inf if claimed is None else float(time - claimed)

    def applied(self, current: Array, last: KeyPosture | None, time: Fraction) -> Array:
        """Return a posture with the limbs at idle that have come to rest by an instant, (V,).

        Args: current: (V,) the posture before. last: the key posture it is of.
        """
        out = current.copy()
        going_on: list[Bound] = []
        if last is not None:
            going_on = [b for b in last.bounds if b.requirement.interval.end >= time]
        for limb, members in self.limbs.members.items():
            way = transition_s(current[members], self.idle[members])
            if self._rests(limb, time, last, going_on, way):
                out[members] = self.idle[members]
        return out

    def _rests(
        self,
        limb: str,
        time: Fraction,
        last: KeyPosture | None,
        going_on: Iterable[Bound],
        way_s: float,
    ) -> bool:
        needed = self._needed.get(limb)
        if needed is None or last is None:
            return True
        if any(limb in b.limbs for b in going_on):
            return False
        levelled = limb in last.limbs and limb not in self._claimed
        if limb in CARRIERS and not levelled:
            since = self._claimed.get(limb, needed)
            starts = self._starts[limb]
            i = bisect_right(starts, since)
            soon = i < len(starts) and starts[i] - since <= GO_ON_S
            return not soon and time - since >= way_s
        held = any(last.holds(limb, b.limbs | b.read_limbs) for b in going_on)
        return time - needed > GO_ON_S and not held
