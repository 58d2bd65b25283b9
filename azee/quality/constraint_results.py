"""What became of every constraint of a score, measured over its whole block."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from azee.motion.keys.plan import Plan
from azee.motion.keys.residual_monitor import TOLERANCE, MovementSamples
from azee.motion.tasks.schedule import TaskSchedule
from azee.motion.tasks.timed_task import TimedTask
from azee_solver.constraint import Morph, Rotate, Trill
from azee_solver.cycles import cycles
from azee_solver.notation import operator_text, subject_text, target_text
from azee_solver.outcome import Outcome, Price
from azee_solver.tolerance import PAPER

if TYPE_CHECKING:
    from azee_solver.solve_report import ConstraintReport

_ROUNDING = 1.0 + 1e-6
"""A residual counts as met up to the tolerance times this."""
FACE_TOLERANCE_M = TOLERANCE["m"]
MOST_WEIGHT = 1.0
"""Of a facial morph: beyond it the skin would tear."""


@dataclass(frozen=True, slots=True)
class ConstraintResult:
    """One constraint of one block, measured over the whole block.

    residual: the largest at any frame or key inside the block, metres or radians; none where the
    geometry it names is degenerate. reason: why it is missed, else none. price: what meeting it
    would have cost, where comfort kept it from that. Times are the score's.
    """

    path: tuple[str, ...]
    rule: str | None
    kind: str
    subject: str
    target: str
    start_s: float
    end_s: float
    residual: float | None
    unit: str
    tolerance: float
    met: bool
    reason: str | None
    price: Price | None = None

    @property
    def missed(self) -> bool:
        """Whether it is neither met nor eased."""
        return self.outcome is Outcome.MISSED

    @property
    def outcome(self) -> Outcome:
        """What became of it."""
        if self.met:
            return Outcome.MET
        return Outcome.MISSED if self.reason is not None else Outcome.EASED

    @property
    def text(self) -> str:
        """The constraint in AZee's notation."""
        return f"{self.subject} {self.target}"

    def as_json(self) -> dict[str, object]:
        """Return it as the report's JSON has it."""
        return {
            "path": [*self.path],
            "rule": self.rule,
            "kind": self.kind,
            "subject": self.subject,
            "target": self.target,
            "start_s": self.start_s,
            "end_s": self.end_s,
            "residual": self.residual,
            "unit": self.unit,
            "tolerance": self.tolerance,
            "met": self.met,
            "outcome": self.outcome.value,
            "reason": self.reason,
            "price": self.price.as_json() if self.price else None,
        }


def constraint_results(
    schedule: TaskSchedule,
    plan: Plan,
    samples: MovementSamples,
    shortfalls: Mapping[int, float],
    fps: float,
) -> tuple[ConstraintResult, ...]:
    """Measure every task at the clip's frames inside its block.

    Trills are left out of the postures that are measured: they swing about what others fix.

    Args: samples: the frames inside the score. shortfalls: angles by which accents and trills fall
        short, by rank. fps: of the clip.
    """
    measured = {t.rank for t in plan.monitor.measured_tasks}
    out = []
    for task in schedule.all:
        if task.rank in measured:
            out.append(_measured(task, plan, samples, fps))
        elif isinstance(task.constraint, Trill):
            out.append(_trill(task, task.constraint, shortfalls.get(task.rank, 0.0), fps))
        elif isinstance(task.constraint, Rotate):
            out.append(_accent(task, shortfalls.get(task.rank, 0.0)))
        else:
            out.append(_face(task))
    return tuple(out)


def _measured(
    task: TimedTask, plan: Plan, samples: MovementSamples, fps: float
) -> ConstraintResult:
    monitor = plan.monitor
    rows = monitor.rows_inside(task, samples.seconds)
    values = monitor.residual(task, samples.only(rows))
    residual = float(np.max(values, initial=0.0))
    unit, tolerance = monitor.unit(task), monitor.tolerance(task)
    reason = price = None
    if not residual <= tolerance * _ROUNDING:
        price = _price(task, plan)
        if price is None or not residual <= PAPER.of(task.constraint) * _ROUNDING:
            reason = _reason(task, plan, residual)
    return _result(task, residual, unit, tolerance, _unseen(task, fps) or reason, price)


def _unseen(task: TimedTask, fps: float) -> str | None:
    """Return what frames cannot show of a path: between two of them nobody knows where it was.

    A frame rate shows frequencies below half of it (Nyquist 1928, Shannon 1949).
    """
    lasts_s = float(task.requirement.motion.duration)
    most = max(cycles(task.constraint), default=0.0)
    if lasts_s <= 0.0 or most / lasts_s <= fps / 2:
        return None
    return f"no {fps:g} frames a second can show {most / lasts_s:g} turns a second"


def _answers(task: TimedTask, plan: Plan) -> Iterator[ConstraintReport]:
    """Yield the solver's answers for a task that it has not met at keys."""
    for posture in plan.postures:
        if task in posture.timed_tasks:
            for answer in posture.report.constraints:
                if not answer.met and answer.task.rank == task.rank:
                    yield answer


def _price(task: TimedTask, plan: Plan) -> Price | None:
    """Return what meeting a task would have cost where it costs most, if comfort eased it."""
    prices = (answer.price for answer in _answers(task, plan))
    return max(filter(None, prices), default=None)


def _reason(task: TimedTask, plan: Plan, residual: float) -> str:
    """Why a task is unmet: its early end, else the solver's worst answer at a key."""
    early = plan.monitor.early_ends.get(task.rank)
    if early is not None:
        return (
            f"ends early, at {float(early.time):.3f} s: {'/'.join(early.successor)} "
            "starts at the instant this ends and needs another posture"
        )
    missed = [answer for answer in _answers(task, plan) if answer.missed]
    if missed:
        return str(max(missed, key=lambda answer: answer.residual).reason)
    if not math.isfinite(residual):
        return "the geometry it names is degenerate"
    if any(_answers(task, plan)):
        return "eased at the keys but farther off at a frame between them"
    return "met at the keys but not at every frame between them"


def _trill(task: TimedTask, trill: Trill, shortfall: float, fps: float) -> ConstraintResult:
    """Judge a trill by how far its joints can go, and by whether frames can show it.

    A frame rate shows frequencies below half of it (Nyquist 1928, Shannon 1949).
    """
    tolerance = TOLERANCE["rad"]
    hz = trill.hz(float(task.interval.duration))
    if hz > fps / 2:
        shown = f"no {fps:g} frames a second can show {hz:g} oscillations"
        return _result(task, trill.amplitude_rad, "rad", tolerance, shown)
    reason = None if shortfall <= tolerance else "the limits of its joints are in the way"
    return _result(task, shortfall, "rad", tolerance, reason)


def _accent(task: TimedTask, shortfall: float) -> ConstraintResult:
    """Judge an accent by how far the bone is from the sum of all that turns it."""
    tolerance = TOLERANCE["rad"]
    reason = None if shortfall <= tolerance else "limits or other constraints leave it no room"
    return _result(task, shortfall, "rad", tolerance, reason)


def _face(task: TimedTask) -> ConstraintResult:
    """Judge a facial morph: the face shows every weight from −1 to 1 exactly, and no other."""
    weight = task.constraint.weight if isinstance(task.constraint, Morph) else 0.0
    if abs(weight) > MOST_WEIGHT:
        reason = f"no face goes so far: weights are from −{MOST_WEIGHT:g} to {MOST_WEIGHT:g}"
        return _result(task, math.inf, "m", FACE_TOLERANCE_M, reason)
    return _result(task, 0.0, "m", FACE_TOLERANCE_M, None)


def _result(
    task: TimedTask,
    residual: float,
    unit: str,
    tolerance: float,
    reason: str | None,
    price: Price | None = None,
) -> ConstraintResult:
    return ConstraintResult(
        path=task.path,
        rule=task.requirement.rule,
        kind=operator_text(task.constraint),
        subject=subject_text(task.constraint),
        target=target_text(task.constraint),
        start_s=float(task.interval.start),
        end_s=float(task.interval.end),
        residual=residual if math.isfinite(residual) else None,
        unit=unit,
        tolerance=tolerance,
        met=residual <= tolerance * _ROUNDING and reason is None,
        reason=reason,
        price=price,
    )
