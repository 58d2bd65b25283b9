"""What a body could do that nothing is in the way of: a ghost, at ease in any posture.

Before wider or longer searches it is asked what of the constraints that are missed can be met at
all. What even a ghost misses gives way at once; where it meets everything is a good place to start.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from azee_solver.attempt import AGAIN, POLISH, solve_group
from azee_solver.body import Body
from azee_solver.footprint import Footprint
from azee_solver.result import Result
from azee_solver.settling import giving_way
from azee_solver.task import Task

Array = NDArray[np.float64]

AGREED = 3
"""So many other descents must end where the best one does to tell that nothing meets all."""


class Ghost:
    """What is known of what cannot be met.

    given_up: tasks that gave way to others even there, and factors of their weights. hopeless:
    those that were missed even there. postures: (V,) in which it met all that it was asked for.
    """

    def __init__(
        self, body: Body, tasks: Sequence[Task], footprints: Mapping[int, Footprint]
    ) -> None:
        self._body, self._tasks, self._footprints = body, tasks, footprints
        self._asked: frozenset[int] = frozenset()
        self.given_up: dict[int, float] = {}
        self.hopeless: frozenset[int] = frozenset()
        self.postures: list[Array] = []

    def ask(self, lost: frozenset[int], among: Mapping[int, Task], q: Array) -> None:
        """Find out whether tasks that are lost can be met together with others.

        Looking on for the sake of what cannot would be in vain. A near miss is no proof, nor are
        ends that differ from start to start.

        Args: q: (V,) the posture so far.
        """
        if lost <= self._asked:
            return
        self._asked |= lost
        anatomy = self._body.anatomy
        free = frozenset().union(*(self._footprints[i].affected(anatomy) for i in among))
        free -= self._body.options.fixed
        if not free:
            return
        body = self._body.ghost(q)
        # It looks on for as long as so many ends alike take to count.
        body.options = replace(body.options, finish_work=0, patience=AGREED * AGAIN)

        def again(ease: Mapping[int, float], begin: Array) -> Result:
            return solve_group(
                body, among, q, free, ease=ease, first=[begin], thorough=False, to_the_end=False
            )

        result = again({}, q)
        if result.worst() > POLISH and result.again >= AGREED:
            ease, result = giving_way(result, {}, again, lambda i: self._tasks[i].order)
            self.given_up |= ease
            self.hopeless |= result.lost()
        elif not result.lost():
            self.postures.append(result.q)
        self._body.evaluations += body.evaluations
