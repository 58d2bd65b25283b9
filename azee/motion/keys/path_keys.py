"""Keys on paths: what is solved once the ends of paths and moving targets are known."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np

from azee.motion.curves.movement import Interpolation, Movement
from azee.motion.keys.in_between import InBetweenSolver
from azee.motion.keys.transpath import (
    PathMotion,
    anchor,
    end_times,
    index_by_time,
    limbs_on_paths,
    path_sample_times,
    target_sample_times,
)
from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.key_posture import KeyPosture, Origin
from azee_solver import kinematics

CLOSEST_S = 0.003
"""Keys nearer to another than this would only make the movement shake."""


@dataclass(slots=True, eq=False)
class PathKeys:
    """Adds the keys on paths to those of the boundaries, step by step.

    motions: all path motions. postures: the keys so far, in order of time. frame_times: increasing.
    """

    motions: tuple[PathMotion, ...]
    postures: list[KeyPosture]
    in_between: InBetweenSolver
    interpolation: Interpolation
    frame_times: Sequence[Fraction]
    _by_time: IntervalIndex[PathMotion] = field(init=False)
    _joined: list[KeyPosture] = field(init=False, default_factory=list)

    def __post_init__(self) -> None:
        self._by_time = index_by_time(self.motions)

    def join_boundaries(self) -> Movement:
        """Join the keys, without what they say of limbs that should be on a path then."""
        out: list[KeyPosture] = []
        for posture in self.postures:
            on_paths = (m.task.limbs for m in self._in_control(posture.time))
            free = posture.limbs.difference(*on_paths)
            out.append(posture if free == posture.limbs else replace(posture, limbs=free))
        self._joined = out
        return self.interpolation.through(out)

    def movement(self, joined: Movement) -> Movement:
        """Return the movement through all keys; the joined one where no key has been added."""
        if self.postures == self._joined:
            return joined
        return self.interpolation.through(self.postures)

    def anchor_paths(self, joined: Movement) -> None:
        """Measure where paths start and end.

        A boundary at which one path ends may lie on another. It was solved without that other
        path, whose ends were not known yet, and is solved once more before the paths are measured
        for good.
        """
        self._measure_ends(joined)
        on_another = {t for t in end_times(self.motions) if self._in_control(t)}
        if on_another:
            self.postures = [p for p in self.postures if p.time not in on_another]
            self._solve(on_another, joined, Origin.BOUNDARY)
            self._measure_ends(joined)

    def solve_deferred(self, deferred: Iterable[Fraction], joined: Movement) -> None:
        """Solve the boundaries that lie on paths, with the sites on their paths."""
        self._solve(deferred, joined, Origin.BOUNDARY)

    def sample_paths(self, joined: Movement) -> None:
        """Add keys at even steps along every path."""
        evaluator = self.in_between.monitor.evaluator
        samples: set[Fraction] = set()
        for path in self.in_between.monitor.paths.values():
            q = joined.sample(np.array([float(path.motion.start)]))[0]
            samples.update(
                path_sample_times(path, kinematics.frames(evaluator.rig.chain, q), evaluator)
            )
        self._solve(self._on_frames(samples), joined, Origin.PATH)

    def sample_moving_targets(self) -> None:
        """Add keys at even steps of the way that every moving target takes."""
        tasks = [t for t in self.in_between.monitor.schedule.posture_tasks if t.dynamic]
        if not tasks:
            return
        joined = self.interpolation.through(self.postures)
        evaluator = self.in_between.monitor.evaluator
        samples: set[Fraction] = set()
        for task in tasks:
            q = joined.sample(np.array([float(task.requirement.motion.start)]))[0]
            samples.update(
                target_sample_times(task, kinematics.frames(evaluator.rig.chain, q), evaluator)
            )
        self._solve(self._on_frames(samples), joined, Origin.PATH)

    def _in_control(self, time: Fraction) -> list[PathMotion]:
        return [m for m in self._by_time.at(time) if m.controls(time)]

    def _measure_ends(self, joined: Movement) -> None:
        monitor = self.in_between.monitor
        paths = anchor(self.motions, self.postures, joined, monitor.evaluator)
        self.in_between = replace(self.in_between, monitor=replace(monitor, paths=paths))

    def _solve(self, times: Iterable[Fraction], movement: Movement, origin: Origin) -> None:
        """Add keys at some instants. At a boundary only limbs on a path pass without stopping."""
        ordered = sorted(times)
        if not ordered:
            return
        passing = None
        if origin is Origin.BOUNDARY:
            monitor = self.in_between.monitor
            passing = [limbs_on_paths(t, monitor.in_force(t), self._by_time.at(t)) for t in ordered]
        added = self.in_between.solve_at(ordered, movement, origin, passing)
        self.postures = merge_keys(self.postures, added)

    def _on_frames(self, samples: Iterable[Fraction]) -> list[Fraction]:
        """Return the frames nearest to samples, but for those too close to a key.

        A key just beside a frame would leave this frame too close to it for a key of its own.
        """
        taken = [p.time for p in self.postures]
        nearest = {nearest_in(self.frame_times, time) for time in samples}
        return [t for t in sorted(nearest) if abs(t - nearest_in(taken, t)) >= CLOSEST_S]


def nearest_in(ordered: Sequence[Fraction], time: Fraction) -> Fraction:
    """Return the instant of an increasing sequence, not empty, that is nearest to another."""
    i = bisect_left(ordered, time)
    return min(ordered[max(0, i - 1) : i + 1], key=lambda t: abs(t - time))


def merge_keys(postures: Iterable[KeyPosture], added: Iterable[KeyPosture]) -> list[KeyPosture]:
    """Return key postures in order of time; one added at the instant of a key keys more limbs."""
    by_time = {p.time: p for p in postures}
    for new in added:
        old = by_time.get(new.time)
        if old is not None:
            passing = old.passing | (new.limbs - old.limbs)
            new = replace(new, limbs=old.limbs | new.limbs, passing=passing, origin=old.origin)
        by_time[new.time] = new
    return sorted(by_time.values(), key=lambda p: p.time)
