"""Key selection: which limbs a key posture is a key of.

In `tracks` a posture keys the limbs of the blocks that begin or end there, and the limbs that had
to move from where the movement has them. In `flat` it keys the whole body, as in Nunnari, Filhol &
Heloir 2018: every key is a key of every joint. A flat movement gets no keys beside boundaries and
samples of paths, and no via points.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.limbs import Limbs
from azee.motion.tasks.timed_task import TimedTask, limbs_moved, limbs_used

Array = NDArray[np.float64]

Mode = Literal["tracks", "flat"]
MODES: tuple[Mode, ...] = get_args(Mode)

SOLVER_MOVED_RAD = math.radians(1.0)
"""A limb that no task uses is keyed if the solver moved a coordinate of it by more than this."""
UNCHANGED_RAD = math.radians(0.01)
"""A limb that a solve leaves this near to where the movement has it gets no key."""


@dataclass(frozen=True, slots=True, eq=False)
class KeySelection:
    """Selects the limbs that a solved posture keys."""

    limbs: Limbs
    mode: Mode = "tracks"

    @property
    def flat(self) -> bool:
        """Whether every posture keys the whole body."""
        return self.mode == "flat"

    def at_boundary(
        self,
        tasks: Iterable[TimedTask],
        changing: Iterable[TimedTask],
        from_last: Array,
        from_reference: Array,
    ) -> frozenset[str]:
        """Return the limbs that a posture keys where blocks begin or end.

        These are
        - the limbs that the tasks which begin or end move;
        - the limbs that these tasks read, unless a lasting task uses them: a constraint holds only
          while what it reads is as the solver saw it;
        - any other limb in use that the solve has moved;
        - limbs that no task uses and that the solver moved by itself (a head levelled over a bent
          trunk).

        Args: tasks: all in force. changing: those that begin or end. from_last: (V,) how far the
            posture is from the last one. from_reference: (V,) how far it is from its reference.
        """
        if self.flat:
            return frozenset(self.limbs.names)
        tasks, changing = [*tasks], [*changing]
        lasting = [t for t in tasks if t not in changing]
        read = frozenset[str]().union(*(t.read_limbs for t in changing))
        used = limbs_used(tasks)
        moved = self._limbs_beyond(from_last, UNCHANGED_RAD) & used
        moved_by_solver = self._limbs_beyond(from_reference, SOLVER_MOVED_RAD) - used
        return limbs_moved(changing) | (read - limbs_used(lasting)) | moved | moved_by_solver

    def passing_at_boundary(
        self, tasks: Iterable[TimedTask], changing: Iterable[TimedTask]
    ) -> frozenset[str]:
        """Return the limbs that only lasting tasks use: where they are keyed, they do not stop."""
        if self.flat:
            return frozenset()
        changing = [*changing]
        return limbs_used(t for t in tasks if t not in changing) - limbs_used(changing)

    def between_boundaries(self, urgent: Iterable[TimedTask], moved: Array) -> frozenset[str]:
        """Return the limbs that a posture keys inside a movement.

        Args: urgent: tasks that begin or end there, or are unmet. moved: (V,) how far the
            posture is from where the movement has it.
        """
        if self.flat:
            return frozenset(self.limbs.names)
        return limbs_moved(urgent) | self._limbs_beyond(moved, UNCHANGED_RAD)

    def _limbs_beyond(self, moved: Array, least: float) -> frozenset[str]:
        """Return the limbs with a coordinate that moved by more than `least`."""
        return self.limbs.touching(int(v) for v in np.flatnonzero(np.abs(moved) > least))


def beginning_or_ending(tasks: Iterable[TimedTask], time: Fraction) -> list[TimedTask]:
    """Return the tasks that begin or end at an instant."""
    return [t for t in tasks if time in (t.interval.start, t.interval.end)]
