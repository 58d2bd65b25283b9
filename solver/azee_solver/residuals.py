"""Constraints lowered to the kernels' residuals, and read back in metres and radians."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from azee_solver import block
from azee_solver.binding import EYES
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
from azee_solver.geometry import SitePoint
from azee_solver.program import Row
from azee_solver.tape import DegenerateError, Tape
from azee_solver.task import Task
from azee_solver.tolerance import Tolerance

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Residuals:
    """Rows of some tasks on a tape.

    runs: for each task, by index, its first row and one past its last. undefined: tasks whose
    target has no direction; they have no rows.
    """

    rows: tuple[Row, ...]
    runs: Mapping[int, tuple[int, int]]
    undefined: frozenset[int]

    def ratios(
        self, lengths: Sequence[float], tasks: Mapping[int, Task], tolerance: Tolerance
    ) -> Ratios:
        """How far each task is from being met, in tolerances, from how far its rows are."""
        out = {}
        for i, (start, stop) in self.runs.items():
            constraint = tasks[i].constraint
            out[i] = _size(constraint, lengths[start:stop]) / tolerance.of(constraint)
        return out


Ratios = dict[int, float]


EDGE_COST = 2.0
"""What a constraint that is met anywhere within a bound costs at this bound; it costs nothing in
the middle. A palm before the body that should point up within 25° comes to 16° of it, within 40°
to 29°; for another constraint it costs less than a fiftieth of its tolerance."""


def lower(
    tape: Tape,
    tasks: Mapping[int, Task],
    tolerance: Tolerance,
    factors: Mapping[int, float],
    *,
    drawn: bool = True,
    inside: bool = False,
) -> Residuals:
    """Return the rows of tasks, weighted so that a miss by the tolerance costs 1.

    A task that is met within a bound has a dead zone in its own row, and another row, after those
    of all tasks, that draws it to the middle.

    Args: factors: of the tasks' weights, where they are not 1. drawn: whether to draw tasks to the
        middle of their bounds. inside: whether dead zones end a tolerance inside the bounds.
    """
    rows: list[Row] = []
    runs: dict[int, tuple[int, int]] = {}
    undefined = set()
    towards_middle: list[Row] = []
    for i, task in tasks.items():
        start = len(rows)
        weight = factors.get(i, 1.0) / tolerance.of(task.constraint) ** 2
        try:
            rows += _rows(tape, task, weight, tolerance.of(task.constraint) if inside else 0.0)
        except DegenerateError:
            undefined.add(i)
            continue
        runs[i] = (start, len(rows))
        if drawn and (own := rows[start]).slack:
            draw = factors.get(i, 1.0) * EDGE_COST / own.slack**2
            kind = own.kind if own.kind == block.PERPENDICULAR or own.distance_m else block.MEET
            towards_middle.append(replace(own, kind=kind, weight=draw, slack=0.0))
    return Residuals((*rows, *towards_middle), runs, frozenset(undefined))


def _rows(tape: Tape, task: Task, weight: float, inside: float) -> list[Row]:
    constraint = task.constraint
    match constraint:
        case Place(site, point, distance, within_m=within):
            reach = tape.evaluator.scale * distance
            slack = max(tape.evaluator.scale * within - inside, 0.0)
            if isinstance(point, SitePoint):
                aim, reach = tape.site(point.site, reach), 0.0
            else:
                aim = tape.point(point, task.phase)
            kind = block.AT_DISTANCE if reach or slack else block.MEET
            return [Row(kind, tape.site(site), aim, weight, reach, slack)]
        case Orient(axis, bone, relation, vector, bound):
            within = max(bound - inside, 0.0)
            own, aim = tape.axis(bone, axis), tape.unit(tape.vector(vector, task.phase))
            if relation is Relation.ACROSS:
                steep = math.cos(within)
                weight, slack = weight / steep**2, math.sin(within)
                return [Row(block.PERPENDICULAR, own, aim, weight, slack=slack)]
            # At the bound a chord grows by cos(within / 2) of what its angle grows by.
            weight, slack = weight / math.cos(0.5 * within) ** 2, 2.0 * math.sin(0.5 * within)
            kind = block.AT_DISTANCE if within else block.MEET
            return [Row(kind, own, aim, weight, slack=slack)]
        case Look(vector):
            aim = tape.unit(tape.vector(vector, task.phase))
            return [Row(block.MEET, tape.gaze(eye)[1], aim, weight) for eye in EYES]
        case LookAt(point):
            aim = tape.point(point, task.phase)
            rays = [tape.gaze(eye) for eye in EYES]
            return [Row(block.MEET, ray, tape.towards(eye, aim), weight) for eye, ray in rays]
        case Rotate():
            # The three columns' chords are 2 sin(φ / 2) √2 together.
            return [Row(block.MEET, a, b, 0.5 * weight) for a, b in tape.turned_frame(constraint)]
        case Morph() | Trill() | Transpath():
            raise ValueError(f"no residual of a {type(constraint).__name__} is optimised")


def _size(constraint: Constraint, lengths: Sequence[float]) -> float:
    """Metres or radians of a constraint, from the lengths of its rows' gaps."""
    match constraint:
        case Place():
            return lengths[0]
        case Orient(relation=Relation.ACROSS, within_rad=within):
            return math.asin(min(lengths[0] + math.sin(within), 1.0)) - within
        case Orient(within_rad=within) if within:
            chord = lengths[0] + 2.0 * math.sin(0.5 * within)
            return 2 * math.asin(min(chord / 2, 1.0)) - within
        case Orient() | Look() | LookAt():
            chord = max(lengths)
        case Rotate():
            chord = math.sqrt(sum(length * length for length in lengths) / 2)
        case Morph() | Trill() | Transpath():
            raise ValueError(f"a {type(constraint).__name__} has no rows")
    return 2 * math.asin(min(chord / 2, 1.0))
