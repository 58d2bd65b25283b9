"""Which limbs have returned to rest by an instant."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.limb_curves import DIRECT_WITHIN_S, transition_s
from azee.motion.tasks.key_posture import KeyPosture
from azee.motion.tasks.limbs import TRUNK, Limbs
from azee.motion.tasks.timed_task import TimedTask, limbs_used

Array = NDArray[np.float64]

SELF_RETURNING = frozenset((TRUNK, "head", "eyes"))
"""Limbs that return as soon as no task moves them, though tasks read them: a hand on the forehead
follows the head back."""

_DIRECT_WITHIN_S = Fraction(DIRECT_WITHIN_S)


@dataclass(slots=True)
class ReturnToNeutral:
    """Records when limbs were needed, as key postures are solved in order of time.

    tasks: all tasks of postures of a score. posture: (V,) the rest to return to.
    """

    tasks: Iterable[TimedTask]
    limbs: Limbs
    posture: Array
    _starts: dict[str, list[Fraction]] = field(init=False)
    """When tasks that move a limb begin, increasing."""
    _needed: dict[str, Fraction] = field(init=False, default_factory=dict)
    """When a limb was last keyed, moved or read."""
    _moved: dict[str, Fraction] = field(init=False, default_factory=dict)
    """When a task last moved a limb."""

    def __post_init__(self) -> None:
        self._starts = {name: [] for name in self.limbs.names}
        for task in self.tasks:
            for limb in task.limbs:
                self._starts[limb].append(task.interval.start)
        for starts in self._starts.values():
            starts.sort()

    def record(self, posture: KeyPosture) -> None:
        """Record what a posture needs."""
        for limb in posture.limbs | limbs_used(posture.timed_tasks):
            self._needed[limb] = posture.time
        for task in posture.timed_tasks:
            for limb in task.limbs:
                self._moved[limb] = posture.time

    def since_moved(self, limb: str, time: Fraction) -> float:
        """How long ago a task last moved a limb; infinite if none did."""
        moved = self._moved.get(limb)
        return math.inf if moved is None else float(time - moved)

    def posture_at(self, current: Array, last: KeyPosture | None, time: Fraction) -> Array:
        """Return a posture with those limbs at rest that have returned by an instant, (V,).

        Args: current: (V,) the posture before. last: the key posture it belongs to.
        """
        out = current.copy()
        going_on: list[TimedTask] = []
        if last is not None:
            going_on = [t for t in last.timed_tasks if t.interval.end >= time]
        for limb, members in self.limbs.members.items():
            if self._has_returned(limb, time, current, last, going_on):
                out[members] = self.posture[members]
        return out

    def _has_returned(
        self,
        limb: str,
        time: Fraction,
        current: Array,
        last: KeyPosture | None,
        going_on: Iterable[TimedTask],
    ) -> bool:
        """Whether a limb has returned by an instant.

        Args: going_on: tasks of the last posture that last until now.
        """
        needed = self._needed.get(limb)
        if needed is None or last is None:
            return True
        if any(limb in t.limbs for t in going_on):
            return False
        moved_by_solver = limb in last.limbs and limb not in self._moved
        if limb in SELF_RETURNING and not moved_by_solver:
            since = self._moved.get(limb, needed)
            starts = self._starts[limb]
            i = bisect_right(starts, since)
            needed_soon = i < len(starts) and starts[i] - since <= _DIRECT_WITHIN_S
            members = self.limbs.members[limb]
            needs_s = transition_s(current[members], self.posture[members])
            return not needed_soon and time - since >= needs_s
        if time - needed <= _DIRECT_WITHIN_S:
            return False
        return not any(last.holds(limb, t.used_limbs) for t in going_on)
