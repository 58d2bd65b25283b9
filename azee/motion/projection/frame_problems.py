"""The problems of a movement's frames: frames in which the same is in force share one program.

A program is laid out once for a set of tasks and paths. What differs from frame to frame in it, the
target of a site on a path or behind a moving point, is filled in for each frame.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from azee.motion.keys.residual_monitor import ResidualMonitor
from azee.motion.keys.transpath import AnchoredPath
from azee.motion.projection.refilled_targets import Moving, Numbers, OnPath, RefilledTargets
from azee.motion.tasks.key_posture import KeyPosture
from azee.motion.tasks.limbs import CARRIERS, TRUNK, is_finger, limb_of_coordinate
from azee.motion.tasks.timed_task import TimedTask
from azee_rig.chain import Frames
from azee_rig.rig import Rig
from azee_solver import kinematics
from azee_solver.anatomy import anatomy
from azee_solver.body import Body
from azee_solver.broadphase import Collisions
from azee_solver.constraint import Constraint, Morph, Place
from azee_solver.geometry import SitePoint
from azee_solver.options import SolveOptions
from azee_solver.program import Cost, Program, used_entries
from azee_solver.residuals import lower
from azee_solver.tape import Tape
from azee_solver.task import Task
from azee_solver.trajectory import ORDER, SMOOTH_S, Trajectory

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

TOUCH_S = 0.15
"""Bodies may be as near as a touch brings them this long before and after it."""
CARRIER_SHARE = 50.0
"""How many times more trunk and head cost than in a posture: keys have chosen where they are, and
a chin does not come to meet a finger."""
SWAY_M = 0.0015
"""Added to the margin that arms and hands keep from the trunk."""
ACCENT_SHARE = 0.6
"""Of its tolerance that an accent may be off at the cost of 1."""
COMFORT = 0.1
"""Share of the joint-limit cost: it leads steps along limits instead of against them."""
PRESET_PLAY_RAD = math.radians(0.4)
"""How far fingers may be from the angles of their handshape, inside the tolerance."""
YIELD_SHARE = 0.1
"""Fingers that yield keep so near to what key postures decided, as a share of their bounds."""
_SOMEWHERE = np.array([0.123456, 1.0, 0.5])
"""Stands for the target of a path until it is filled in; metres."""


NEAR_LIMIT_RAD = math.radians(1.1)
"""How far inside their limits joints stay, as people rarely hold one at its stop."""


@dataclass(frozen=True, slots=True, eq=False)
class FrameProblems:
    """Makes the trajectory problem of a movement.

    factors: of the weights of tasks, by rank, where not 1. postures: all key postures.
    """

    monitor: ResidualMonitor
    factors: Mapping[int, float]
    postures: Sequence[KeyPosture]
    options: SolveOptions

    def trajectory(
        self,
        times: Sequence[Fraction],
        reference: Array,
        accented: Mask,
        played: Mask,
        fps: float,
    ) -> Trajectory:
        """Return the problem of the frames at exact times, near a movement.

        Args: reference: (T, V). accented: (T, V), where accents ask for what the reference has.
            played: (T, V), where the reference is kept.
        """
        coordinates = self.monitor.evaluator.rig.coordinates
        free_keep = self.options.posture * np.array(coordinates.stiffness) ** 2
        carriers = [limb_of_coordinate(name) in CARRIERS for name in coordinates.names]
        free_keep[carriers] *= CARRIER_SHARE
        keep = np.tile(free_keep, (len(times), 1))
        keep[accented] = (ACCENT_SHARE * self.options.tolerance.angle_rad) ** -2
        fixed = played.copy()
        target = np.clip(reference, coordinates.lower, coordinates.upper)
        of_frame = np.empty(len(times), dtype=np.int64)
        programs: list[Program] = []
        moving: list[Moving] = []
        for now, rows in self._in_force(times):
            problem = self._lay_out(now, times[rows[0]])
            of_frame[rows] = len(programs)
            programs.append(problem.program)
            if problem.presets:
                members, angles = [*problem.presets], np.array([*problem.presets.values()])
                of_shape = np.ix_(rows, members)
                fixed[of_shape] = True
                near = np.clip(target[of_shape], angles - PRESET_PLAY_RAD, angles + PRESET_PLAY_RAD)
                target[of_shape] = np.clip(
                    near, coordinates.lower[members], coordinates.upper[members]
                )
            for v, bound in problem.yielding.items():
                keep[rows, v] = np.maximum(keep[rows, v], (YIELD_SHARE * bound) ** -2)
            moving += self._paths(problem, rows, times)
            moving += self._moving_targets(problem, rows, times, reference)
        seconds = np.array([float(time) for time in times])
        smooth = free_keep * (SMOOTH_S * fps) ** (2 * ORDER)
        refilling = RefilledTargets.of(self.monitor.evaluator, moving)
        return Trajectory(
            programs, of_frame, target, keep, fixed, smooth, coordinates.lower, coordinates.upper,
            self.options.overlap, refilling, self._near_limits(seconds, fixed),
        )  # fmt: skip

    def _near_limits(self, seconds: Array, fixed: Mask) -> Array:
        """Return how far inside the limits coordinates stay, (T, V) radians.

        That is nothing where a key posture is nearer, where coordinates are fixed, and while a
        constraint is in force that a key posture misses or eases.
        """
        limits = self.monitor.evaluator.rig.coordinates
        names = [limb_of_coordinate(name) for name in limits.names]
        bodily = np.array([not is_finger(limb) and limb != "eyes" for limb in names])
        q = np.stack([limits.idle, *(posture.coordinates for posture in self.postures)])
        inside = np.minimum(q - limits.lower, limits.upper - q).min(axis=0) > NEAR_LIMIT_RAD
        out = np.where(bodily & inside & ~fixed, NEAR_LIMIT_RAD, 0.0)
        answers = (c for posture in self.postures for c in posture.report.constraints)
        unmet = {answer.task.constraint for answer in answers if not answer.met}
        for task in self.monitor.schedule.posture_tasks if unmet else ():
            if task.constraint in unmet:
                rows = self.monitor.rows_inside(task, seconds)
                out[rows.start : rows.stop] = 0.0
        return out

    def _in_force(self, times: Sequence[Fraction]) -> list[tuple[_InForce, list[int]]]:
        """Return what holds together in frames, and in which."""
        seconds = np.array([float(time) for time in times])
        tasks = self.monitor.schedule.posture_tasks
        first_of: dict[object, int] = {}
        same = [first_of.setdefault(t if t.dynamic else t.constraint, i)
                for i, t in enumerate(tasks)]  # fmt: skip
        holding = [self.monitor.rows_inside(t, seconds, enforced=True) for t in tasks]
        paths = [*self.monitor.paths.values()]
        controlled = [[t for t in range(*self._rows(p, seconds)) if p.motion.controls(times[t])]
                      for p in paths]  # fmt: skip
        touches = {i for i in first_of.values() if _is_touch(tasks[i].constraint)}
        near = [
            (i, np.searchsorted(seconds, (float(t.interval.start) - TOUCH_S,
                                          float(t.interval.end) + TOUCH_S), side="right"))
            for i, t in zip(same, tasks, strict=True)
            if i in touches
        ]  # fmt: skip
        held: list[set[int]] = [set() for _ in times]
        on: list[list[int]] = [[] for _ in times]
        touching: list[set[int]] = [set() for _ in times]
        for i, rows in zip(same, holding, strict=True):
            for t in range(rows.start, rows.stop):
                held[t].add(i)
        for p, instants in enumerate(controlled):
            for t in instants:
                on[t].append(p)
        for i, (start, stop) in near:
            for t in range(int(start), int(stop)):
                touching[t].add(i)
        groups: dict[tuple[frozenset[int], tuple[int, ...], frozenset[int]], list[int]] = {}
        for t in range(len(times)):
            key = frozenset(held[t]), tuple(on[t]), frozenset(touching[t])
            groups.setdefault(key, []).append(t)
        return [
            (
                _InForce(
                    tuple(tasks[i] for i in sorted(some)),
                    tuple(paths[p] for p in along),
                    tuple(tasks[i].constraint for i in sorted(close)),
                ),
                rows,
            )
            for (some, along, close), rows in groups.items()
        ]  # fmt: skip

    def _rows(self, path: AnchoredPath, seconds: Array) -> tuple[int, int]:
        rows = self.monitor.rows_inside(path.motion.task, seconds)
        return rows.start, rows.stop

    def _lay_out(self, now: _InForce, time: Fraction) -> _Problem:
        evaluator = self.monitor.evaluator
        rig = evaluator.rig
        idle = rig.coordinates.idle
        asked = [t.constraint for t in now.tasks]
        presets = evaluator.binding.presets(asked)
        yielding = evaluator.binding.yielding(asked)
        for v in yielding:
            del presets[v]  # key postures have decided how far it yields
        on_paths = [path.ik_task(_SOMEWHERE).constraint for path in now.paths]
        touches = (*now.touches, *on_paths)
        body = Body(rig, evaluator, idle, presets, self.options, touches)
        count = len(now.tasks)
        tasks = {i: t.ik_task(time) for i, t in enumerate(now.tasks) if _has_rows(t)}
        tasks |= {count + i: path.ik_task(_SOMEWHERE) for i, path in enumerate(now.paths)}
        ranked = (*now.tasks, *(path.motion.task for path in now.paths))
        factors = {i: self.factors.get(task.rank, 1.0) for i, task in enumerate(ranked)}
        tape = self._tape(body.frames(idle))
        residuals = lower(tape, tasks, self.options.tolerance, factors, drawn=False, inside=True)
        free = self._free(now, presets)
        nothing, comfort = np.zeros(len(idle)), np.full(len(idle), COMFORT * self.options.comfort)
        program = Program(
            rig,
            idle,
            sorted(free),
            tape,
            residuals.rows,
            _farther(rig, body.obstacles.for_problem(free, frozenset())),
            Cost(np.array(idle), nothing, comfort, self.options.overlap),
        )
        return _Problem(now, tasks, residuals.runs, presets, yielding, program)

    def _free(self, now: _InForce, presets: Mapping[int, float]) -> frozenset[int]:
        """Return the coordinates that terms of a frame hang on.

        Fingers are left out unless something but a handshape moves them: they follow the reference.
        """
        names = self.monitor.evaluator.rig.coordinates.names
        bodily = {v for v, n in enumerate(names) if not is_finger(limb_of_coordinate(n))}
        tasks = (*now.tasks, *(path.motion.task for path in now.paths))
        moved = {v for t in tasks if _has_rows(t) for v in (*t.moves, *t.reads)}
        return frozenset(bodily | (moved - presets.keys()))

    def _tape(self, frames: Frames) -> Tape:
        rig = self.monitor.evaluator.rig
        everything = frozenset(range(len(rig.coordinates)))
        moving = anatomy(rig.chain, rig.coordinates).moved_by(everything)
        return Tape(self.monitor.evaluator, frames, moving)

    def _paths(
        self, problem: _Problem, rows: Sequence[int], times: Sequence[Fraction]
    ) -> Iterable[OnPath]:
        """Yield the sites on paths in frames that share a program."""
        for i, path in enumerate(problem.now.paths):
            row = problem.program.rows[problem.runs[len(problem.now.tasks) + i][0]]
            progress = np.array([path.motion.progress(times[t]) for t in rows])
            yield OnPath(path, row.b, np.array(rows), progress)

    def _moving_targets(
        self, problem: _Problem, rows: Sequence[int], times: Sequence[Fraction], q: Array
    ) -> Iterable[Numbers]:
        """Yield what differs in the tapes of frames with moving targets."""
        moving = [i for i, task in enumerate(problem.now.tasks) if task.dynamic]
        if not moving:
            return
        on_paths = [p.entry for p in self._paths(problem, rows, times)]
        frames = kinematics.frames(self.monitor.evaluator.rig.chain, q[rows])
        numbers = []
        for k, t in enumerate(rows):
            tape = self._tape(Frames(frames.positions[k], frames.rotations[k]))
            now = {i: problem.now.tasks[i].ik_task(times[t]) for i in moving}
            tasks = {**problem.tasks, **now}
            asked = lower(tape, tasks, self.options.tolerance, {}, drawn=False, inside=True).rows
            numbers.append(used_entries(tape, asked))
        # What differs in one frame is filled in for all of them: they share one tape.
        differs = np.any(np.stack(numbers) != problem.program.tape_numbers, axis=(0, 2))
        differs[on_paths] = False
        for t, of_frame in zip(rows, numbers, strict=True):
            yield Numbers(t, np.flatnonzero(differs), of_frame[differs])


@dataclass(frozen=True, slots=True, eq=False)
class _InForce:
    """What holds in a frame: distinct tasks, paths in control, touches that are near in time."""

    tasks: tuple[TimedTask, ...]
    paths: tuple[AnchoredPath, ...]
    touches: tuple[Constraint, ...]


@dataclass(frozen=True, slots=True, eq=False)
class _Problem:
    """A program with what it was made for.

    tasks: what it asks, by index. runs: rows of each. presets: angles of handshapes, by coordinate.
    yielding: by how far other coordinates of handshapes may yield, radians.
    """

    now: _InForce
    tasks: Mapping[int, Task]
    runs: Mapping[int, tuple[int, int]]
    presets: Mapping[int, float]
    yielding: Mapping[int, float]
    program: Program


@lru_cache(maxsize=256)
def _farther(rig: Rig, collisions: Collisions) -> Collisions:
    """Keep what is kept away from the trunk a little farther away: bodies sway."""
    of_trunk = np.array([name.startswith(TRUNK) for name in rig.capsules.names])
    trunk = of_trunk[collisions.pairs].any(axis=1)
    farther = np.where(trunk & (np.asarray(collisions.margin) > 0.0), SWAY_M, 0.0)
    return Collisions(collisions.pairs, collisions.reach + farther, collisions.margin)


def _has_rows(task: TimedTask) -> bool:
    return not isinstance(task.constraint, Morph)


def _is_touch(constraint: Constraint) -> bool:
    return isinstance(constraint, Place) and isinstance(constraint.point, SitePoint)
