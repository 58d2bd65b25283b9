"""Postures that follow what is dragged, one after the other, as fast as a screen shows them.

Each is solved from the one before and drawn to it eight times more than to the reference, which is
where compiling would draw the body: the neutral posture. So a posture changes little from frame to
frame and ends where the text will have it. Whatever is in force stays in force beside what is
dragged; what is dragged goes first. The trunk stays where it is, unless it is what is dragged:
people do not lean for what their arms can reach, and compiling would not lean either.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

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
from azee_solver.binding import Binding
from azee_solver.collisions import Obstacles, Overlap
from azee_solver.comfort import MARGIN_RAD
from azee_solver.constraint import Constraint, Morph, Place
from azee_solver.footprint import footprint
from azee_solver.geometry import Site
from azee_solver.moment import Moment
from azee_solver.options import SolveOptions
from azee_solver.relaxed import RelaxedProblem
from azee_solver.sequence import GroupSequence
from azee_solver.solve import solve
from azee_solver.task import Task
from azee_solver.tolerance import PAPER
from azee_solver.widening import least_reach

Array = NDArray[np.float64]

OPTIONS = SolveOptions(far=False, patience=0, inertia=8.0)
"""From where the body is, without a search. With inertia 8 a posture is near the one that compiling
finds after half a second; with 30 as along a path (ADR 26) elbows lag behind by seconds."""
YIELDING = 0.001
"""Factor of the weight of what a drag cannot be met with."""
FIRM = 20.0
"""Factor of the cost of overlap where a body that is drawn to be still leans into itself."""
WAY = (1.0, 0.25, 0.5, 0.75)
"""Shares of a step at which nothing may overlap: a hand does not jump to the back of the body."""
DEEPER_M = 5e-4
"""An overlap that is deeper by less than it was at the instant is the same."""
TOUCH_M = 0.02
"""A point so near to a site of the skin may be touched there."""
AHEAD = (0.0, 0.0, 1.0)
"""A point or direction that stands for any."""
FIRST = Fraction(-1)
"""When what is dragged starts, for the order of constraints: before all others."""


@dataclass(frozen=True, slots=True, eq=False)
class Dragged:
    """A posture in which handles are where they were dragged to, as far as the body allows.

    q: (V,) radians. residuals: of each handle, metres or radians; 0 for weights. overlaps: of parts
    of the body that the drag moves, beyond what is tolerated. reasons: why a handle misses its
    target, where that was asked for. solve_s: processor time that it took.
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

    def solve(self, goals: Mapping[Handle, Target], start: Array) -> Dragged:
        """Return the posture for all goals, found from a posture (V,).

        Args: goals: where each handle should be.
        """
        began = time.thread_time()
        free, linked = self.linked(frozenset(goals))
        asked = {handle: self._constraint(handle, target) for handle, target in goals.items()}
        skeletal = {h: c for h, c in asked.items() if not self._is_facial(c)}
        beside = ik_tasks_at(linked, self.instant.time)
        wanted = list(skeletal.values())
        q, overlaps = self._followed(wanted, beside, start, free)
        if overlaps:
            q, overlaps = self._followed(wanted, beside, start, free, firm=FIRM)
        if overlaps:
            kept = [self._kept(c, start) for c in skeletal.values()]
            q, overlaps = self._followed(kept, beside, start, free)
            if overlaps:
                q, overlaps = np.array(start), []
        spent_s = time.thread_time() - began
        return Dragged(q, self._residuals(asked, q), tuple(overlaps), {}, spent_s)

    def agreed(self, goals: Mapping[Handle, Target], start: Array) -> Dragged:
        """Return the posture that compiling would find for goals and all that is in force.

        It is up to 1 cm and 5° farther from what was dragged than `start`, a posture (V,): where
        the rest of the text leaves no comfortable posture, compiling eases constraints (ADR 43). If
        it would be farther, the posture stays, and the reasons say what is in the way.
        """
        began = time.thread_time()
        binding = self.instant.evaluator.binding
        tasks = [t for t in self.instant.tasks if not _any_replaces(goals, t, binding)]
        asked = {handle: self._constraint(handle, target) for handle, target in goals.items()}
        skeletal = {h: c for h, c in asked.items() if not self._is_facial(c)}
        if not skeletal:
            return Dragged(start, dict.fromkeys(goals, 0.0), (), {}, time.thread_time() - began)
        moved = frozenset().union(*map(self._own, goals), *(t.moves for t in tasks))
        report = solve(
            self._rig,
            [*_tasks(skeletal.values()), *ik_tasks_at(tasks, self.instant.time)],
            dominant=binding.dominant,
            start=start,
            reference=self._reference(moved),
            options=replace(OPTIONS, inertia=0.0, precise=False),
        )
        q = np.array(report.coordinates)
        said = {id(c.task.constraint): c.reason for c in report.constraints if c.reason}
        reasons = {h: said[id(c)] for h, c in asked.items() if id(c) in said}
        overlaps = self._too_deep(self._moving(report.penetration, moved))
        before, after = self._residuals(asked, start), self._residuals(asked, q)
        if any(after[h] > before[h] + PAPER.of(c) for h, c in skeletal.items()):
            q, after, overlaps = start, before, []
        return Dragged(q, after, tuple(overlaps), reasons, time.thread_time() - began)

    def _followed(
        self,
        asked: Sequence[Constraint],
        beside: Sequence[Task],
        start: Array,
        free: frozenset[int],
        *,
        firm: float = 1.0,
    ) -> tuple[Array, list[Overlap]]:
        """Return the posture that does what is asked, and what overlaps there or on the way to it.

        These are steps 1 to 5 of the solver. Where what is in force keeps a handle from its target,
        it gets little weight, and the steps are made once more.
        """
        tasks = [*_tasks(asked), *beside]
        moment = self._moment(tasks, start, free, firm)
        relaxed, reach = RelaxedProblem(moment), least_reach(moment)
        sequence = GroupSequence(moment, relaxed)
        solution = sequence.solve(reach)
        if beside and any(i < len(asked) for i in solution.missed()):
            relaxed.given_up |= dict.fromkeys(range(len(asked), len(tasks)), YIELDING)
            solution = sequence.solve(reach, solution)
        q = np.clip(solution.q, self._rig.coordinates.lower, self._rig.coordinates.upper)
        obstacles = moment.body.obstacles
        for share in WAY:
            found = self._moving(obstacles.overlaps(start + share * (q - start)), free)
            if deep := self._too_deep(found):
                break
        return q, deep

    def _moment(
        self, tasks: Sequence[Task], start: Array, free: frozenset[int], firm: float
    ) -> Moment:
        fixed = frozenset(range(len(start))) - free
        dominant = self.instant.evaluator.binding.dominant
        options = replace(OPTIONS, fixed=fixed, overlap=firm * OPTIONS.overlap)
        moment = Moment(self._rig, tasks, dominant, start, self._reference(free), options)
        moment.body.limits = self._comfortable(moment.start)
        return moment

    def _comfortable(self, start: Array) -> tuple[Array, Array]:
        """Return limits of the coordinates, (V,) each, a little short of the body's.

        Compiling would go as far for comfort's sake, and not to the limits themselves. Where the
        body is farther already, it need not come back.
        """
        coordinates = self._rig.coordinates
        narrow = coordinates.upper - coordinates.lower < 2.0 * MARGIN_RAD
        short = np.where(narrow, 0.0, MARGIN_RAD)
        short[sorted(self.anatomy.of(Part.HAND, Part.EYES))] = 0.0
        lower = np.minimum(coordinates.lower + short, start)
        return lower, np.maximum(coordinates.upper - short, start)

    def _too_deep(self, overlaps: Iterable[Overlap]) -> list[Overlap]:
        """Return the overlaps that are deeper than is tolerated, and than at the instant itself."""
        was = self._depths
        tolerated = OPTIONS.overlap_m
        return [
            o
            for o in overlaps
            if o.depth_m > max(tolerated, was.get((o.first, o.second), 0.0) + DEEPER_M)
        ]

    @cached_property
    def _depths(self) -> dict[tuple[str, str], float]:
        """How deep parts lie in each other at the instant itself."""
        constraints = [task.constraint for task in self.instant.tasks]
        obstacles = Obstacles(self.instant.evaluator.binding, self.anatomy, constraints)
        found = obstacles.overlaps(self.instant.q)
        return {(o.first, o.second): o.depth_m for o in found}

    def _kept(self, constraint: Constraint, start: Array) -> Constraint:
        """Return what is asked of a posture that may stay where it is.

        A site may be as far from its target as it is, and is drawn there as far as nothing is in
        the way: so a hand slides along the body.
        """
        if not isinstance(constraint, Place):
            return constraint
        evaluator = self.instant.evaluator
        frames = kinematics.frames(self._rig.chain, start)
        residual, _ = evaluator.residual(constraint, frames, start)
        return replace(constraint, within_m=float(residual) / evaluator.scale + DEEPER_M)

    def _moving(self, overlaps: Iterable[Overlap], free: frozenset[int]) -> list[Overlap]:
        """Return those overlaps in which a part is that coordinates move."""
        moved = self.anatomy.moved_by(free)
        names, nodes = self._rig.capsules.names, self._rig.capsules.node
        moving = {name for name, node in zip(names, nodes, strict=True) if moved[node]}
        return [o for o in overlaps if {o.first, o.second} & moving]

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
        left = [t for t in self.instant.tasks if not _any_replaces(handles, t, binding)]
        linked: list[TimedTask] = []
        while found := [task for task in left if (task.moves | task.reads) & free]:
            linked += found
            left = [task for task in left if task not in found]
            free = free.union(*(task.moves - trunk for task in found))
        linked.sort(key=lambda task: task.rank)
        return free, tuple(linked)

    def _own(self, handle: Handle) -> frozenset[int]:
        """Coordinates of the limbs that a handle is on, without the trunk that carries them."""
        example = constraint_of(handle, (1.0,) if isinstance(handle, MorphHandle) else AHEAD)
        if self._is_facial(example):
            return frozenset()
        binding = self.instant.evaluator.binding
        if isinstance(example, Morph):
            return frozenset(binding.preset(example))
        movers = footprint(example, binding).movers(self.anatomy)
        carried = movers - self.anatomy.of(Part.TRUNK)
        return carried or movers

    def _constraint(self, handle: Handle, target: Target) -> Constraint:
        touching = self.touched(handle, target) if isinstance(handle, SiteHandle) else ()
        return constraint_of(handle, target, touching)

    def touched(self, handle: SiteHandle, target: Target) -> tuple[Site, ...]:
        """Return the site of another part of the body that a point is at, if there is one."""
        near = self.sites(frozenset({handle})).near(np.array(target), TOUCH_M)
        return tuple(found.site for found in near[:1])

    def sites(self, handles: frozenset[Handle]) -> SiteMap:
        """Return the sites that stay where they are when handles are dragged.

        Those of an arm on its way are none: where it is then hangs on everything about it.
        """
        if handles not in self._sites:
            frames = kinematics.frames(self._rig.chain, self.instant.q)
            free, _ = self.linked(handles)
            passing = self.instant.on_the_way
            self._sites[handles] = SiteMap(self.instant.evaluator, frames, free | passing)
        return self._sites[handles]

    def _reference(self, free: frozenset[int]) -> Array:
        reference = np.array(self.instant.q)
        members = sorted(free)
        reference[members] = self._rig.coordinates.idle[members]
        return reference

    def _is_facial(self, constraint: Constraint) -> bool:
        binding = self.instant.evaluator.binding
        return isinstance(constraint, Morph) and not binding.is_skeletal(constraint)

    def _residuals(self, asked: Mapping[Handle, Constraint], q: Array) -> dict[Handle, float]:
        evaluator = self.instant.evaluator
        frames = kinematics.frames(self._rig.chain, q)
        return {
            handle: 0.0
            if isinstance(constraint, Morph)
            else float(evaluator.residual(constraint, frames, q)[0])
            for handle, constraint in asked.items()
        }


def _any_replaces(handles: Iterable[Handle], task: TimedTask, binding: Binding) -> bool:
    return any(is_replaced(task.constraint, handle, binding) for handle in handles)


def _tasks(asked: Iterable[Constraint]) -> list[Task]:
    """Return what is dragged as tasks, before all others."""
    return [Task(constraint, ("drag",), FIRST, rank) for rank, constraint in enumerate(asked)]
