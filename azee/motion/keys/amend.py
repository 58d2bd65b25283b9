"""Solving an instant on the way: as little as possible moves from where the tracks have it.

What serves the constraints that are missed moves first with the limbs that end in a hand, a finger
or an eye; only if that does not do, head and trunk move with them, which link the others: eyes
keep their aim while a head shakes, and an arm reaches its path from the trunk as it finds it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from azee.motion.keys.residual_monitor import Gauge, Instants
from azee.motion.keys.standing import free_limbs
from azee.motion.tasks.limbs import LINKS, TRUNK, Limbs
from azee.motion.tasks.posture import PostureSolver, Search
from azee.motion.tasks.timed_task import Bound
from azee_solver.constraint import Constraint
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

SETTLED = 0.9
"""Share of the tolerance within which a constraint needs nothing where a key is added."""


@dataclass(frozen=True, slots=True, eq=False)
class Amending:
    """What amends instants of a movement.

    hopeless: constraints that a key posture at a boundary could not meet.
    """

    gauge: Gauge
    limbs: Limbs
    solver: PostureSolver
    hopeless: frozenset[Constraint]

    def solve(
        self,
        one: Instants,
        asking: Sequence[Bound],
        begun: Sequence[Bound],
        tasks: Sequence[Task],
    ) -> SolveReport:
        """Return the posture nearest to where the tracks are at one instant.

        Args: asking: all in force. begun: those of them that must have a key here.
        """
        q = one.q[0]
        report, fixed = None, frozenset[int]()
        missed = frozenset(b for b in asking if self._is_missed(b, one))
        for free in self._widening(asking, missed.union(begun)):
            fixed = self._all_but(free)
            report = self.solver(tasks, start=q, reference=q, search=Search.NEAR, fixed=fixed)
            standing = _standing(asking, missed, free)
            if all(c.met or c.task.rank in standing for c in report.constraints):
                return report
        assert report is not None
        lost = {c.task.constraint for c in report.constraints if not c.met}
        if lost <= self.hopeless:
            return report
        wide = self.solver(tasks, start=q, reference=q, fixed=fixed)
        left, less = (sum(not c.met for c in r.constraints) for r in (report, wide))
        return wide if less < left else report

    def _widening(
        self, asking: Sequence[Bound], pressing: Collection[Bound]
    ) -> Iterator[frozenset[str]]:
        """Yield limbs that may move, ever more of them."""
        new = [b for b in asking if b in pressing]
        kept = [b for b in asking if b not in pressing]
        if not new:
            new, kept = kept, []
        own = {b.limb for b in new}
        before = None
        for links in (LINKS, (TRUNK,), ()):
            free = free_limbs(kept, new, stays=frozenset(links) - own)
            if free != before:
                yield free
            before = free

    def _is_missed(self, bound: Bound, one: Instants) -> bool:
        residual = float(self.gauge.residual(bound, one)[0])
        return not residual <= self.gauge.tolerance(bound) * SETTLED

    def _all_but(self, free: frozenset[str]) -> frozenset[int]:
        members = (self.limbs.members[limb] for limb in self.limbs.names if limb not in free)
        return frozenset(int(v) for indices in members for v in indices)


def _standing(
    asking: Sequence[Bound], missed: Collection[Bound], free: frozenset[str]
) -> frozenset[int]:
    """Ranks of what is right enough and does not move.

    On the way a site may be two millimetres off its path, for which the solver would not stop.
    """
    return frozenset(b.requirement.rank for b in asking if not b.limbs & free and b not in missed)
