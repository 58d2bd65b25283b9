"""Which limbs a key posture is a key of: the one thing in which the two modes differ.

In `tracks` a posture keys the limbs of the blocks that begin or end there, and those that had to
move from where the other tracks have them. In `flat` it keys the whole body, as Nunnari, Filhol &
Heloir 2018 have it: every key is a key of every joint.
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
from azee.motion.tasks.timed_task import Bound, limbs_asked

Array = NDArray[np.float64]

Mode = Literal["tracks", "flat"]
MODES: tuple[Mode, ...] = get_args(Mode)

MOVED_RAD = math.radians(1.0)
"""A limb that nothing asked for is keyed if the solver moved it by more than this."""
KEPT_RAD = math.radians(0.01)
"""A limb that a solve leaves as near as this to where its track has it needs no key there."""


@dataclass(frozen=True, slots=True, eq=False)
class Keying:
    """What tells which limbs a solved posture keys."""

    limbs: Limbs
    mode: Mode = "tracks"

    @property
    def flat(self) -> bool:
        """Whether every posture keys the whole body."""
        return self.mode == "flat"

    def at_boundary(
        self, bounds: Iterable[Bound], fresh: Iterable[Bound], changed: Array, levelled: Array
    ) -> frozenset[str]:
        """Return the limbs that a posture keys where blocks begin or end.

        A constraint holds only with what it reads as the solver saw it, so that is keyed too,
        unless a block that merely goes on has it on its own way.

        Args: bounds: all in force. fresh: those that begin or end. changed: (V,) how far the
            posture is from the last one. levelled: (V,) how far the solver moved coordinates
            from where they would be without it (a head over a bent trunk).
        """
        if self.flat:
            return frozenset(self.limbs.names)
        bounds, fresh = [*bounds], [*fresh]
        lasting = [b for b in bounds if b not in fresh]
        own = frozenset[str]().union(*(b.limbs for b in fresh))
        read = frozenset[str]().union(*(b.read_limbs for b in fresh))
        asked = limbs_asked(bounds)
        moved = self.touched(changed, KEPT_RAD) & asked
        unasked = self.touched(levelled, MOVED_RAD) - asked
        return own | (read - limbs_asked(lasting)) | moved | unasked

    def following(self, bounds: Iterable[Bound], fresh: Iterable[Bound]) -> frozenset[str]:
        """Return the limbs that only lasting blocks ask for.

        Where others make them move along they do not stop.
        """
        if self.flat:
            return frozenset()
        fresh = [*fresh]
        return limbs_asked(b for b in bounds if b not in fresh) - limbs_asked(fresh)

    def on_the_way(self, fresh: Iterable[Bound], moved: Array) -> frozenset[str]:
        """Return the limbs that a posture keys inside a movement.

        Args: fresh: what begins or ends there, or is missed. moved: (V,) how
            far from where the tracks have it.
        """
        if self.flat:
            return frozenset(self.limbs.names)
        own = frozenset[str]().union(*(b.limbs for b in fresh))
        return own | self.touched(moved, KEPT_RAD)

    def touched(self, moved: Array, least: float) -> frozenset[str]:
        """Return the limbs that have a coordinate that moved by more than `least`."""
        return self.limbs.touching(int(v) for v in np.flatnonzero(np.abs(moved) > least))


def fresh(bounds: Iterable[Bound], time: Fraction) -> list[Bound]:
    """Return the requirements that begin or end at an instant."""
    spans = ((b, b.requirement.interval) for b in bounds)
    return [b for b, span in spans if time in (span.start, span.end)]
