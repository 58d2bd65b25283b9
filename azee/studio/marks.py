"""Where constraints are on the body: what a page draws for site and target, axis and direction."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from azee.clip.clip import Clip
from azee.score.score import Key, Score, leaves
from azee_rig.chain import Frames
from azee_rig.rig import Rig
from azee_solver import kinematics
from azee_solver.binding import EYES, BindingError
from azee_solver.constraint import (
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Relation,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.evaluate import Evaluator, evaluator
from azee_solver.geometry import Side
from azee_solver.notation import constraint_text

Floats = NDArray[np.float64]

SHARES = (0.05, 0.5, 0.95)
"""Of a block's time, when its constraints are drawn."""
ARROW_M = 0.14
MOST_MARKED = 2_000
"""Constraints of one movement."""


def marks(
    score: Score, clip: Clip, rig: Rig, dominant: Side, lead_s: float
) -> list[dict[str, Any]]:
    """Return the marks of a movement, a row per constraint that has a place on the body.

    A row has the `path` of its block, the constraint's `text`, and `marks` at some times of the
    clip: `time_s`; `at`, where a site or the tip of an axis is; `goal`, where it should be; `base`,
    the foot of both for an axis. World, metres.

    Args: score: as performed. lead_s: when it starts in the clip.
    """
    body = evaluator(rig, dominant)
    rows: list[dict[str, Any]] = []
    for leaf in leaves(score):
        if not isinstance(leaf.score, Key):
            continue
        start, duration = float(leaf.interval.start) + lead_s, float(leaf.score.duration)
        times = [start + share * duration for share in SHARES]
        chosen = [int(np.abs(clip.times - time).argmin()) for time in times]
        frames = kinematics.frames(rig.chain, clip.coordinates[chosen])
        for constraint in leaf.score.constraints:
            found = [
                {"time_s": round(float(clip.times[chosen[i]]), 4), **mark}
                for i, share in enumerate(SHARES)
                for mark in _of(constraint, body, _only(frames, i), share)
            ]
            if found:
                text = constraint_text(constraint)
                rows.append({"path": leaf.path, "text": text, "marks": found})
        if len(rows) >= MOST_MARKED:
            break
    return rows


def _only(frames: Frames, i: int) -> Frames:
    return Frames(frames.positions[i], frames.rotations[i])


def _of(
    constraint: Constraint, body: Evaluator, frames: Frames, phase: float
) -> Iterator[dict[str, Any]]:
    """Yield the marks of a constraint in one posture; none where nothing can be drawn."""
    try:
        match constraint:
            case Place():
                at, goal = (
                    body.site(constraint.site, frames),
                    body.target(constraint, frames, phase),
                )
                yield from _mark(None, at, goal)
            case Orient(axis, bone, relation, vector):
                base = frames.positions[body.binding.bone(bone).origin_node]
                now, wanted = body.axis(bone, axis, frames), body.vector(vector, frames, phase)
                wanted = _unit(wanted)
                if relation is Relation.ACROSS:  # the nearest direction that is perpendicular
                    wanted = _unit(now - (now @ wanted) * wanted)
                yield from _mark(base, base + ARROW_M * now, base + ARROW_M * wanted)
            case Look(vector):
                for eye in EYES:
                    base, now = body.gaze(eye, frames)
                    wanted = _unit(body.vector(vector, frames, phase))
                    yield from _mark(base, base + ARROW_M * now, base + ARROW_M * wanted)
            case LookAt(point):
                for eye in EYES:
                    base, now = body.gaze(eye, frames)
                    goal = body.point(point, frames, phase)
                    reach = np.linalg.norm(goal - base)
                    yield from _mark(base, base + reach * now, goal)
            case Morph() | Rotate() | Transpath() | Trill():
                return
    except BindingError:
        return


def _unit(vector: Floats) -> Floats:
    return vector / max(float(np.linalg.norm(vector)), 1e-12)


def _mark(base: Floats | None, at: Floats, goal: Floats) -> Iterator[dict[str, Any]]:
    ends = [at, goal] if base is None else [at, goal, base]
    if np.isfinite(ends).all():
        names = ("at", "goal", "base")
        yield {n: np.round(e, 4).tolist() for n, e in zip(names, ends, strict=False)}
