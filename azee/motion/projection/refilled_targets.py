"""Targets that differ from frame to frame: moving points, and sites on their paths."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.motion.keys.transpath import AnchoredPath
from azee_rig.chain import Frames
from azee_solver import kinematics
from azee_solver.evaluate import Evaluator
from azee_solver.trajectory import Refills

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class OnPath:
    """A site on a path: which entry its target is, and how far it is in which frames, (R,)."""

    path: AnchoredPath
    entry: int
    frames: NDArray[np.int64]
    progress: Array


@dataclass(frozen=True, slots=True, eq=False)
class Numbers:
    """Entries (m,) and numbers (m, 5) of a frame, the same for all postures."""

    frame: int
    entries: NDArray[np.int64]
    numbers: Array


Moving: TypeAlias = OnPath | Numbers


@dataclass(frozen=True, slots=True, eq=False)
class RefilledTargets:
    """Fills in the targets that move.

    numbers: by frame. paths: sites on paths, whose frames lie between `spans`, (P, 2), both ends
    included.
    """

    evaluator: Evaluator
    numbers: Mapping[int, Sequence[Numbers]]
    paths: Sequence[OnPath]
    spans: NDArray[np.int64]

    @staticmethod
    def of(evaluator: Evaluator, moving: Iterable[Moving]) -> RefilledTargets:
        """Sort what moves by its frames."""
        numbers: dict[int, list[Numbers]] = {}
        paths = []
        for each in moving:
            if isinstance(each, Numbers):
                numbers.setdefault(each.frame, []).append(each)
            else:
                paths.append(each)
        spans = np.array([(p.frames[0], p.frames[-1]) for p in paths], dtype=np.int64)
        return RefilledTargets(evaluator, numbers, paths, spans.reshape(-1, 2))

    def __call__(self, frames: range, q: Array) -> Refills:
        """Return the refills of some frames, in which the body has the postures q (T, V)."""
        found: list[list[tuple[int, Array]]] = [
            [
                pair
                for n in self.numbers.get(t, ())
                for pair in zip(n.entries, n.numbers, strict=True)
            ]
            for t in frames
        ]
        near = (self.spans[:, 0] < frames.stop) & (frames.start <= self.spans[:, 1])
        body: Frames | None = None
        for k in np.flatnonzero(near).tolist():
            path = self.paths[k]
            inside = (frames.start <= path.frames) & (path.frames < frames.stop)
            here = path.frames[inside] - frames.start
            if not len(here):
                continue
            body = body or kinematics.frames(self.evaluator.rig.chain, q)
            then = Frames(body.positions[here], body.rotations[here])
            numbers = np.zeros((len(here), 5))
            numbers[:, :3] = path.path.targets_at(path.progress[inside], then, self.evaluator)
            for row, target in zip(here.tolist(), numbers, strict=True):
                found[row].append((path.entry, target))
        counts = np.array([len(f) for f in found], dtype=np.int64)
        places = np.zeros((len(found), max(1, int(counts.max(initial=0)))), dtype=np.int64)
        filled = np.zeros((*places.shape, 5))
        for row, entries_of_row in enumerate(found):
            for j, (entry, target) in enumerate(entries_of_row):
                places[row, j], filled[row, j] = entry, target
        return Refills(counts, places, filled)
