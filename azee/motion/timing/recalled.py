"""Points as they were: the postures in which blocks end, measured before the score is performed.

`was` names the end of another block. That block is solved first, without what waits for it; the
point is then a place in the world, which nothing moves any more.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, is_dataclass, replace
from fractions import Fraction
from functools import lru_cache, partial
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.key_posture import KeyPosture, PostureSolver
from azee.motion.tasks.key_selection import KeySelection
from azee.motion.timing.first_postures import first_postures
from azee.score.rebuilt import rebuilt
from azee.score.score import Group, Key, Score
from azee_solver.binding import BindingError
from azee_solver.constraint import Constraint
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Was

Array = NDArray[np.float64]
Path: TypeAlias = tuple[str, ...]
_Places: TypeAlias = "dict[tuple[Path, Was], tuple[float, float, float]]"


def recalled(
    score: Score, evaluator: Evaluator, selection: KeySelection, solver: PostureSolver, rest: Array
) -> Score:
    """Return a score in which every `was` has its place in the world.

    In each round the blocks are measured in which nothing waits any more. What the body lacks, or
    what waits for itself, stays without a place.

    Args: rest: (V,) the posture of a body that nothing has moved yet.
    """
    while waiting := [*_waiting(score)]:
        pending = {w.path for w in waiting}
        ready = [w for w in waiting if not any(p[: len(w.block)] == w.block for p in pending)]
        measured: _Places = {}
        if ready:
            without = rebuilt(score, _without_waiting)
            postures = first_postures(without, evaluator, selection, solver, rest)
            for one in ready:
                place = _measured(one, postures, evaluator, rest)
                if place is not None:
                    measured[one.path, one.was] = place
        if not measured:
            break
        score = rebuilt(score, partial(_with_places, measured))
    return score


@dataclass(frozen=True, slots=True)
class _Waiting:
    """A point as it was, the leaf it stands in, the block that it names and when that ends."""

    path: Path
    was: Was
    block: Path
    end: Fraction


def _waiting(
    score: Score,
    path: Path = (),
    start: Fraction = Fraction(0),
    around: tuple[tuple[Path, Group, Fraction], ...] = (),
) -> Iterator[_Waiting]:
    """Yield all points as they were without a place, whose block is found."""
    if isinstance(score, Group):
        for block in score.blocks:
            begins = start + block.interval_in_parent.start
            inner = (*around, (path, score, start))
            yield from _waiting(block.score, (*path, block.name), begins, inner)
    elif isinstance(score, Key):
        for was in (w for c in score.constraints for w in _points_as_they_were(c) if w.at is None):
            for depth, (outer, group, begins) in reversed([*enumerate(around)]):
                names = {block.name for block in group.blocks}
                if was.block in names and path[depth] != was.block:
                    end = begins + group.block(was.block).interval_in_parent.end
                    yield _Waiting(path, was, (*outer, was.block), end)
                    break


@lru_cache(maxsize=4096)
def _points_as_they_were(constraint: Constraint) -> tuple[Was, ...]:
    return tuple(_wases(constraint))


def _wases(node: object) -> Iterator[Was]:
    if isinstance(node, Was):
        yield node
    elif isinstance(node, tuple):
        for item in node:
            yield from _wases(item)
    elif is_dataclass(node):
        for part in fields(node):
            yield from _wases(getattr(node, part.name))


def _without_waiting(path: Path, found: tuple[Constraint, ...]) -> tuple[Constraint, ...]:
    return tuple(c for c in found if all(w.at is not None for w in _points_as_they_were(c)))


def _with_places(
    measured: _Places, path: Path, found: tuple[Constraint, ...]
) -> tuple[Constraint, ...]:
    def placed(node: Any) -> Any:
        if isinstance(node, Was):
            return replace(node, at=measured.get((path, node), node.at))
        if isinstance(node, tuple):
            return tuple(map(placed, node))
        if is_dataclass(node) and any(True for _ in _wases(node)):
            changed = {f.name: placed(getattr(node, f.name)) for f in fields(node)}
            return replace(node, **changed)  # type: ignore[type-var]
        return node

    return tuple(map(placed, found))


def _measured(
    waiting: _Waiting, postures: tuple[KeyPosture, ...], evaluator: Evaluator, rest: Array
) -> tuple[float, float, float] | None:
    """Return where a point is at the end of its block: in the last key posture of the block."""
    before = [p for p in postures if p.time <= waiting.end]
    own = [
        p
        for p in before
        if any(t.path[: len(waiting.block)] == waiting.block for t in p.timed_tasks)
    ]
    found = (own or before)[-1:]
    q = found[0].coordinates if found else rest
    try:
        place = evaluator.point(waiting.was.point, evaluator.rig.chain.frames(q), 1.0)
    except BindingError:
        return None
    if not np.all(np.isfinite(place)):
        return None
    x, y, z = place.tolist()
    return x, y, z
