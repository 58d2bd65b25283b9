"""Postures that follow what is dragged, one after the other, as fast as a screen shows them.

Each is solved from the one before and drawn to it thirty times more than to the reference, which is
where compiling would draw the body: the neutral posture. So a posture changes little from frame to
frame and ends where the text will have it. Whatever is in force stays in force beside what is
dragged; what is dragged goes first. The trunk stays where it is, unless it is what is dragged:
people do not lean for what their arms can reach, and compiling would not lean either.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.timed_task import TimedTask, ik_tasks_at
from azee.posing.handle import Handle, MorphHandle, SiteHandle, Target, constraint_of
from azee.posing.instant import Instant
from azee.posing.replaced import is_replaced
from azee.posing.sites import SiteMap
from azee_rig.rig import Rig
from azee_solver import kinematics
from azee_solver.anatomy import Anatomy, Part, anatomy
from azee_solver.collisions import Overlap
from azee_solver.constraint import Constraint, Morph
from azee_solver.footprint import footprint
from azee_solver.geometry import Site
from azee_solver.options import SolveOptions
from azee_solver.solve import solve
from azee_solver.solve_report import SolveReport
from azee_solver.task import Task

Array = NDArray[np.float64]

INERTIA = 30.0
"""As for the paths of `benchmarks.continuity` (ADR 26)."""
TOUCH_M = 0.02
"""A point so near to a site of the skin may be touched there."""
FIRST = Fraction(-1)
"""When what is dragged starts, for the order of constraints: before all others."""


@dataclass(frozen=True, slots=True, eq=False)
class Dragged:
    """A posture in which handles are where they were dragged to, as far as the body allows.

    q: (V,) radians. residuals: of each handle, metres or radians; 0 for weights. overlaps: of parts
    of the body that the drag moves, beyond what is tolerated. reasons: why a handle misses its target, where asked
    for. solve_s: processor time that it took.
    """

    q: Array
    residuals: Mapping[Handle, float]
    overlaps: tuple[Overlap, ...]
    reasons: Mapping[Handle, str]
    solve_s: float


class DragSolver:
    """Solves the postures of one drag after the other, at one instant of a score."""

    def __init__(self, instant: Instant) -> None:
        self.instant = instant
        self._rig: Rig = instant.evaluator.rig
        self.anatomy: Anatomy = anatomy(self._rig.chain, self._rig.coordinates)
        self._linked: dict[frozenset[Handle], tuple[frozenset[int], tuple[TimedTask, ...]]] = {}
        self._sites: dict[frozenset[Handle], SiteMap] = {}

    def solve(
        self, goals: Mapping[Handle, Target], start: Array, *, explain: bool = False
    ) -> Dragged:
        """Return the posture for all goals, found from a posture (V,).

        Args: goals: where each handle should be. explain: find out why handles miss; takes longer.
        """
        instant = self.instant
        began = time.thread_time()
        free, linked = self.linked(frozenset(goals))
        asked = {handle: self._constraint(handle, target) for handle, target in goals.items()}
        skeletal = {h: c for h, c in asked.items() if not self._is_facial(c)}
        tasks = [
            *(Task(c, ("drag",), FIRST, rank) for rank, c in enumerate(skeletal.values())),
            *ik_tasks_at(linked, instant.time),
        ]
        report = solve(
            self._rig,
            tasks,
            dominant=instant.evaluator.binding.dominant,
            start=start,
            reference=self._reference(free),
            options=SolveOptions(
                far=False,
                patience=0,
                explain=explain,
                inertia=INERTIA,
                fixed=frozenset(range(len(start))) - free,
            ),
        )
        spent_s = time.thread_time() - began
        return self._dragged(skeletal, asked, report, free, spent_s)

    def linked(self, handles: frozenset[Handle]) -> tuple[frozenset[int], tuple[TimedTask, ...]]:
        """Return the coordinates that drags of handles may move, and the tasks that go along.

        A task goes along if it moves the same coordinates or its target depends on them, and then
        what it moves may move too. Tasks that a handle replaces do not.
        """
        if handles not in self._linked:
            self._linked[handles] = self._links(handles)
        return self._linked[handles]

    def _links(self, handles: frozenset[Handle]) -> tuple[frozenset[int], tuple[TimedTask, ...]]:
        free = frozenset().union(*map(self._own, handles))
        trunk = self.anatomy.of(Part.TRUNK) - free
        binding = self.instant.evaluator.binding
        left = [
            task
            for task in self.instant.tasks
            if not any(is_replaced(task.constraint, handle, binding) for handle in handles)
        ]
        linked: list[TimedTask] = []
        while found := [task for task in left if (task.moves | task.reads) & free]:
            linked += found
            left = [task for task in left if task not in found]
            free = free.union(*(task.moves - trunk for task in found))
        linked.sort(key=lambda task: task.rank)
        return free, tuple(linked)

    def _own(self, handle: Handle) -> frozenset[int]:
        """Coordinates of the limbs that a handle is on, without the trunk that carries them."""
        example = constraint_of(
            handle, (1.0,) if isinstance(handle, MorphHandle) else (0.0, 0.0, 1.0)
        )
        if self._is_facial(example):
            return frozenset()
        binding = self.instant.evaluator.binding
        if isinstance(example, Morph):
            return frozenset(binding.preset(example))
        movers = footprint(example, binding).movers(self.anatomy)
        carried = movers - self.anatomy.of(Part.TRUNK)
        return carried or movers

    def _constraint(self, handle: Handle, target: Target) -> Constraint:
        touching = ()
        if isinstance(handle, SiteHandle):
            touching = self.touched(handle, target)
        return constraint_of(handle, target, touching)

    def touched(self, handle: SiteHandle, target: Target) -> tuple[Site, ...]:
        """Return the site of another part of the body that a point is at, if there is one."""
        near = self.sites(frozenset({handle})).near(np.array(target), TOUCH_M)
        return tuple(found.site for found in near[:1])

    def sites(self, handles: frozenset[Handle]) -> SiteMap:
        """Return the sites that stay where they are when handles are dragged."""
        if handles not in self._sites:
            frames = kinematics.frames(self._rig.chain, self.instant.q)
            free, _ = self.linked(handles)
            self._sites[handles] = SiteMap(self.instant.evaluator, frames, free)
        return self._sites[handles]

    def _reference(self, free: frozenset[int]) -> Array:
        reference = np.array(self.instant.q)
        members = sorted(free)
        reference[members] = self._rig.coordinates.idle[members]
        return reference

    def _is_facial(self, constraint: Constraint) -> bool:
        binding = self.instant.evaluator.binding
        return isinstance(constraint, Morph) and not binding.is_skeletal(constraint)

    def _dragged(
        self,
        skeletal: Mapping[Handle, Constraint],
        asked: Mapping[Handle, Constraint],
        report: SolveReport,
        free: frozenset[int],
        spent_s: float,
    ) -> Dragged:
        residuals = dict.fromkeys(asked, 0.0)
        reasons = {}
        for handle, constraint in skeletal.items():
            found = next(c for c in report.constraints if c.task.constraint is constraint)
            residuals[handle] = 0.0 if isinstance(constraint, Morph) else found.residual
            if found.reason:
                reasons[handle] = found.reason
        moved = self.anatomy.moved_by(free)
        names, nodes = self._rig.capsules.names, self._rig.capsules.node
        moving = {name for name, node in zip(names, nodes, strict=True) if moved[node]}
        overlaps = tuple(o for o in report.penetration if {o.first, o.second} & moving)
        return Dragged(report.coordinates, residuals, overlaps, reasons, spent_s)
