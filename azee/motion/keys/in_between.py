"""In-between postures: keys inside a movement, as near as possible to where the movement is.

What serves the unmet tasks moves first with limbs that end in a hand, a finger or an eye. Only if
that is not enough do head and trunk move too, which carry the others: so eyes keep their aim while
a head shakes, and an arm reaches its path from the trunk as it finds it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from azee.motion.curves.movement import Movement
from azee.motion.keys.incremental import free_limbs
from azee.motion.keys.residual_monitor import MovementSamples, ResidualMonitor, sample_movement
from azee.motion.tasks.key_posture import KeyPosture, Origin, PostureSolver, Search
from azee.motion.tasks.key_selection import KeySelection, beginning_or_ending
from azee.motion.tasks.limbs import CARRIERS, TRUNK
from azee.motion.tasks.timed_task import TimedTask, ik_tasks_at
from azee_solver.constraint import Constraint
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

MET_SHARE = 0.9
"""A task whose residual is below this share of its tolerance needs no correction."""

ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class InBetweenSolver:
    """Solves key postures at instants of a movement.

    infeasible: constraints that a key posture at a boundary could not meet. eased: those that one
    has eased for comfort, and by how much: no more is asked of them between the boundaries.
    """

    monitor: ResidualMonitor
    selection: KeySelection
    solver: PostureSolver
    infeasible: frozenset[Constraint] = frozenset()
    eased: Mapping[Constraint, float] = field(default_factory=dict)

    def solve_at(
        self,
        times: Sequence[Fraction],
        movement: Movement,
        origin: Origin,
        passing: Sequence[frozenset[str]] | None = None,
    ) -> list[KeyPosture]:
        """Solve increasing instants, each from where a movement has the body then.

        Args: passing: limbs that pass through each key without stopping; by default all.
        """
        if not times:
            return []
        samples = sample_movement(movement, times, self.monitor.evaluator)
        every_limb = frozenset(self.selection.limbs.names)
        played = self.monitor.schedule.recorded
        out = []
        for i, (time, q) in enumerate(zip(times, samples.q, strict=True)):
            now = samples.only(slice(i, i + 1))
            posture_tasks = self.monitor.in_force(time)
            paths = self.monitor.paths_in_control(time)
            points = (p.targets([time], now.frames, self.monitor.evaluator)[0] for p in paths)
            on_paths = [path.ik_task(point) for path, point in zip(paths, points, strict=True)]
            tasks = [*posture_tasks, *(p.motion.task for p in paths)]
            ik_tasks = ik_tasks_at(posture_tasks, time, on_paths)
            changing = beginning_or_ending(posture_tasks, time) if origin is Origin.BOUNDARY else []
            owned = frozenset(n for b in played for n in b.limbs if b.plays(time))
            report = self._nearest(now, tasks, changing, ik_tasks, owned)
            unmet = {c.task.constraint for c in report.constraints if not c.met}
            urgent = [*changing, *(t for t in tasks if t.constraint in unmet)]
            keyed = self.selection.between_boundaries(urgent, report.coordinates - q) - owned
            out.append(
                KeyPosture(
                    time, report.coordinates, keyed,
                    every_limb if passing is None else passing[i], tuple(tasks),
                    tuple(c.task for c in report.constraints), report, origin,
                )
            )  # fmt: skip
        return out

    def _nearest(
        self,
        now: MovementSamples,
        tasks: Sequence[TimedTask],
        changing: Sequence[TimedTask],
        ik_tasks: Sequence[Task],
        owned: frozenset[str],
    ) -> SolveReport:
        """Return the answer nearest to where a movement is at one instant.

        Tries ever more limbs until all is met but what was unmet before and did not move. At
        worst searches globally with all of them, unless nothing is unmet but what is infeasible.

        Args: now: the movement then. tasks: all in force. changing: those that must have a key.
            owned: limbs of recordings, which stay.
        """
        q = now.q[0]
        report, fixed = None, frozenset[int]()
        off = frozenset(t for t in tasks if self._is_off(t, now))
        for free in self._widening(tasks, off.union(changing)):
            fixed = self._all_but(free - owned)
            report = self.solver(ik_tasks, start=q, reference=q, search=Search.LOCAL, fixed=fixed)
            undisturbed = _undisturbed(tasks, off, free)
            if all(not c.missed or c.task.rank in undisturbed for c in report.constraints):
                return report
        assert report is not None
        unmet = {c.task.constraint for c in report.constraints if not c.met}
        if unmet <= self.infeasible:
            return report
        searched = self.solver(ik_tasks, start=q, reference=q, fixed=fixed)
        left, fewer = (sum(c.missed for c in r.constraints) for r in (report, searched))
        return searched if fewer < left else report

    def _widening(
        self, tasks: Sequence[TimedTask], urgent: Collection[TimedTask]
    ) -> Iterator[frozenset[str]]:
        """Yield the limbs that may move: without head and trunk, without the trunk, all.

        Limbs that an urgent task names may always move.
        """
        new = [t for t in tasks if t in urgent]
        lasting = [t for t in tasks if t not in urgent]
        if not new:
            new, lasting = lasting, []
        named = {t.limb for t in new}
        before = None
        for stays in (CARRIERS, (TRUNK,), ()):
            free = free_limbs(lasting, new, stays=frozenset(stays) - named)
            if free != before:
                yield free
            before = free

    def _is_off(self, task: TimedTask, now: MovementSamples) -> bool:
        residual = float(self.monitor.residual(task, now)[0])
        tolerance = self.monitor.tolerance(task) * MET_SHARE
        return not residual <= max(tolerance, self.eased.get(task.constraint, 0.0) + ROUNDING)

    def _all_but(self, free: frozenset[str]) -> frozenset[int]:
        """Return the coordinates of all other limbs."""
        limbs = self.selection.limbs
        members = (limbs.members[limb] for limb in limbs.names if limb not in free)
        return frozenset(int(v) for indices in members for v in indices)


def _undisturbed(
    tasks: Sequence[TimedTask], off: Collection[TimedTask], free: frozenset[str]
) -> frozenset[int]:
    """Return ranks of tasks that the movement meets and whose limbs do not move.

    The movement may have a site two millimetres off its path, which the solver calls unmet.
    """
    return frozenset(t.rank for t in tasks if not t.limbs & free and t not in off)
