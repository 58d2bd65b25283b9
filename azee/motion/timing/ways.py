"""Finds the ways of arms in a score, and measures how long they need."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from azee.clip.spline import minimum_jerk
from azee.motion.curves.limb_curves import ONSET_SPREAD_S
from azee.motion.curves.movement import Movement
from azee.motion.keys.transpath import AnchoredPath, PathMotion
from azee.motion.tasks.key_posture import KeyPosture
from azee.motion.tasks.schedule import TaskSchedule
from azee.motion.tasks.timed_task import TimedTask
from azee.motion.timing.pace import SHOULDERS_M, Pace
from azee.motion.timing.way import Way
from azee.score.interval import Interval
from azee_rig.chain import Frames
from azee_solver import kinematics
from azee_solver.constraint import Place
from azee_solver.evaluate import Evaluator

Array = NDArray[np.float64]

SIDES = ("L", "R")
SAME_RAD = 1e-3
"""An arm whose coordinates differ by no more has no way to go."""
SAMPLES = 25
"""Instants at which a way between keys is measured: the peak of its speed is found to .2 %."""
PATH_POINTS = 65
UNEVEN_TURN = 1.2
"""How much faster than by minimum jerk a forearm or wrist turns at most, while its hand is led on a
path: measured on 150 signs of the lexicon `ngt`, where most exceed it by .05 to .2."""
_AT_ONCE = 64
"""Ways that are measured at once: memory stays bounded in long texts."""


@dataclass(frozen=True, eq=False)
class Ways:
    """Measures ways on one body, at one pace.

    members: the coordinates of every limb. One text takes about the same time on bodies of any
    size: lengths count as if the shoulders were `SHOULDERS_M` apart.
    """

    evaluator: Evaluator
    members: Mapping[str, NDArray[np.int64]]
    pace: Pace

    @cached_property
    def scale(self) -> float:
        """How many times larger a body is whose shoulders are `SHOULDERS_M` apart."""
        rig = self.evaluator.rig
        joints = [rig.bones[f"arm_{s}"].origin_node for s in SIDES]
        left, right = kinematics.frames(rig.chain, rig.coordinates.idle).positions[joints]
        return SHOULDERS_M / float(np.linalg.norm(left - right))

    def needed_s(self, before: Array, after: Array, limbs: frozenset[str]) -> float:
        """Return how long those of some limbs that are arms need between two postures, (V,).

        Their joints do not set out together: each has so much less time than the whole.
        """
        q = _between(before, after)
        sides = [s for s in SIDES if f"arm_{s}" in limbs]
        if not sides:
            return 0.0
        frames = kinematics.frames(self.evaluator.rig.chain, q)
        needed = max(self._measured(s, frames, q, 1.0)[0] for s in sides)
        return needed + ONSET_SPREAD_S if needed > 0.0 else 0.0

    def between_keys(
        self,
        postures: Sequence[KeyPosture],
        movement: Movement,
        motions: Iterable[PathMotion],
    ) -> Iterator[Way]:
        """Yield the ways between successive keys in which an arm differs.

        A hand that turns while its place is held has a way, too. There is none where the arm is on
        a path or rests in between.
        """
        on_paths = [*motions]
        for side in SIDES:
            limb = f"arm_{side}"
            if limb not in self.members:
                continue
            arm = self.members[limb]
            own = [p for p in postures if limb in p.limbs]
            keyed = {float(p.time) for p in own}
            paths = [m.between for m in on_paths if limb in m.task.limbs]
            rests = [k.time_s for k in movement.curves[limb].keys if k.time_s not in keyed]
            pairs = [
                (a, b)
                for a, b in pairwise(own)
                if a.time < b.time
                and np.abs(a.coordinates[arm] - b.coordinates[arm]).max() > SAME_RAD
                and not any(p.start < b.time and a.time < p.end for p in paths)
                and not any(float(a.time) < t < float(b.time) for t in rests)
            ]
            for first in range(0, len(pairs), _AT_ONCE):
                yield from self._between(pairs[first : first + _AT_ONCE], movement, side)

    def _between(
        self, pairs: Sequence[tuple[KeyPosture, KeyPosture]], movement: Movement, side: str
    ) -> Iterator[Way]:
        """Measure the ways between pairs of keys.

        The arm moves as its curve does, and all else by minimum jerk from one posture to the other:
        where trunk or head go to and fro in between, more time for the arm is no remedy.
        """
        limb = f"arm_{side}"
        q = np.concatenate([_between(a.coordinates, b.coordinates) for a, b in pairs])
        times = np.concatenate(
            [np.linspace(float(a.time), float(b.time), SAMPLES) for a, b in pairs]
        )
        q[:, self.members[limb]] = movement.curves[limb].sample(times)
        frames = kinematics.frames(self.evaluator.rig.chain, q)
        for n, (a, b) in enumerate(pairs):
            rows = slice(n * SAMPLES, (n + 1) * SAMPLES)
            part = Frames(frames.positions[rows], frames.rotations[rows])
            lasts_s = float(b.time - a.time)
            needed_s, way_m, turn_rad = self._measured(side, part, q[rows], lasts_s)
            source, target = _named(limb, a, b)
            yield Way(
                side, Interval(a.time, b.time), _milliseconds(needed_s), way_m, turn_rad,
                source, target,
            )  # fmt: skip

    def _measured(
        self, side: str, frames: Frames, q: Array, lasts_s: float
    ) -> tuple[float, float, float]:
        """Return the time needed for a movement of an arm, its way and its turn.

        Args: frames, q: at `SAMPLES` even steps of the time that it lasts.
        """
        wrist = frames.positions[:, self.evaluator.rig.bones[f"palm_{side}"].origin_node]
        arm = q[:, self.members[f"arm_{side}"]]
        steps = np.linalg.norm(np.diff(wrist, axis=0), axis=1)
        step_s = lasts_s / (len(q) - 1)
        bends = np.linalg.norm(np.diff(wrist, 2, axis=0), axis=1)
        stretch = self.pace.stretch(
            self.scale * float(steps.max()) / step_s,
            self.scale * float(bends.max()) / step_s**2,
            float(np.abs(np.diff(arm, axis=0)).max()) / step_s,
        )
        return stretch * lasts_s, float(steps.sum()), float(np.abs(arm[-1] - arm[0]).max())

    def along_paths(self, paths: Iterable[AnchoredPath], movement: Movement) -> Iterator[Way]:
        """Yield the ways of arms along the paths of sites."""
        moved = [
            (path, sides)
            for path in paths
            if (sides := self._sides(path.motion.task)) and path.motion.start < path.motion.end
        ]
        times = [(float(p.motion.start), float(p.motion.end)) for p, _ in moved]
        instants, at = np.unique(np.array(times).reshape(-1, 2), return_inverse=True)
        postures = movement.sample(instants)[at.reshape(-1, 2)]
        for (path, sides), ends in zip(moved, postures, strict=True):
            motion = path.motion
            points = self.evaluator.path(
                motion.constraint.path,
                path.start.world,
                path.end.world,
                np.linspace(0.0, 1.0, PATH_POINTS),
                kinematics.frames(self.evaluator.rig.chain, ends[0]),
            )
            source = motion.task.path if motion.before is None else motion.before.path
            target = motion.task.path if motion.after is None else motion.after.path
            interval = Interval(motion.start, motion.end)
            yield from self._along(points, ends, interval, sides, source, target)

    def behind_targets(self, schedule: TaskSchedule, movement: Movement) -> Iterator[Way]:
        """Yield the ways of arms whose sites follow moving points."""
        for task in schedule.posture_tasks:
            sides = self._sides(task)
            span = task.requirement.motion
            if not (task.dynamic and isinstance(task.constraint, Place) and sides):
                continue
            if span != task.interval or not span.duration:
                continue
            ends = movement.sample(np.array([float(span.start), float(span.end)]))
            frames = kinematics.frames(self.evaluator.rig.chain, ends[0])
            points = np.stack(
                [
                    self.evaluator.point(task.constraint.point, frames, float(s))
                    for s in np.linspace(0.0, 1.0, PATH_POINTS)
                ]
            )
            yield from self._along(points, ends, span, sides, task.path, task.path)

    def _along(
        self,
        points: Array,
        ends: Array,
        interval: Interval,
        sides: Sequence[str],
        source: tuple[str, ...],
        target: tuple[str, ...],
    ) -> Iterator[Way]:
        way_m = float(np.linalg.norm(np.diff(points.reshape(-1, 3), axis=0), axis=1).sum())
        for side in sides:
            arm = self.members[f"arm_{side}"]
            turn_rad = float(np.abs(ends[1, arm] - ends[0, arm]).max())
            needed_s = self.pace.least_s(self.scale * way_m, UNEVEN_TURN * turn_rad)
            if math.isfinite(needed_s):
                yield Way(side, interval, _milliseconds(needed_s), way_m, turn_rad, source, target)

    def _sides(self, task: TimedTask) -> list[str]:
        """Return whose arm a task moves, if the bone or site that it names is of one."""
        own = [s for s in SIDES if task.limb.endswith(f"_{s}") and f"arm_{s}" in task.limbs]
        return [s for s in own if f"arm_{s}" in self.members]


def _between(before: Array, after: Array) -> Array:
    """Return `SAMPLES` postures from one to another by minimum jerk, (SAMPLES, V)."""
    progress = np.asarray(minimum_jerk(np.linspace(0.0, 1.0, SAMPLES)))[:, None]
    return np.asarray(before + (after - before) * progress)


def _named(limb: str, before: KeyPosture, after: KeyPosture) -> tuple[tuple[str, ...], ...]:
    """Return the paths of the blocks that a way of a limb leads from and to.

    From what ends last before the way, to what begins last, of the blocks that move the limb.
    """
    leaving = [t for t in before.timed_tasks if limb in t.limbs] or [*before.timed_tasks]
    arriving = [t for t in after.timed_tasks if limb in t.limbs] or [*after.timed_tasks]
    source = min(leaving, key=lambda t: (t.interval.end, t.rank))
    target = min(arriving, key=lambda t: (-t.interval.start, t.rank))
    return source.path, target.path


def _milliseconds(seconds: float) -> Fraction:
    """Round up, so that sums of many times stay short fractions."""
    return Fraction(math.ceil(seconds * 1000), 1000)
