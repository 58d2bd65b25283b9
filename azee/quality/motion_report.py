"""The report of a movement: every constraint over its whole block, limits, and the solving."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee.motion.keys.plan import Plan
from azee.motion.keys.residual_monitor import TOLERANCE, MovementSamples
from azee.motion.tasks.schedule import TaskSchedule
from azee.motion.tasks.timed_task import TimedTask
from azee.motion.timing.performed import Stretch
from azee.quality.likeness import Likeness
from azee.quality.measures import CoordinatePeaks, Penetration
from azee.quality.recordings import PlayedRecording
from azee_rig.coordinates import Coordinates
from azee_solver.constraint import Morph, Rotate, Trill
from azee_solver.cycles import cycles
from azee_solver.notation import operator_text, subject_text, target_text
from azee_solver.outcome import Outcome, Price, Strain
from azee_solver.tolerance import PAPER

if TYPE_CHECKING:
    from azee.motion.tasks.key_posture import KeyPosture
    from azee_solver.solve_report import ConstraintReport

Array = NDArray[np.float64]

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


@dataclass(frozen=True, eq=False)
class MotionReport:
    """The report of one animation.

    blocks: their times, and until when their constraints hold. peaks: largest speed, acceleration
    and jerk of the coordinates that move. measure_penetration: measures it in every frame.
    measure_likeness: takes the figures of likeness. stretched: what takes longer than the score
    says. extra_s: by how much all does. recordings: signs that are played. measure_fingers:
    measures the fingers of each hand in every frame. Other times are those of the score as
    performed.
    """

    rig: str
    fps: float
    mode: str
    duration_s: float
    lead_s: float
    score_s: float
    measure_constraints: Callable[[], tuple[ConstraintResult, ...]]
    max_excess_rad: float
    excess_joint: str | None
    postures: tuple[KeyPosture, ...]
    blocks: tuple[Mapping[str, object], ...]
    measure_peaks: Callable[[], tuple[CoordinatePeaks, ...]]
    measure_penetration: Callable[[], tuple[Penetration, ...]]
    measure_likeness: Callable[[], Likeness]
    timing: str = "exact"
    tempo: float = 1.0
    stretched: tuple[Stretch, ...] = ()
    extra_s: float = 0.0
    recordings: tuple[PlayedRecording, ...] = ()
    measure_fingers: Callable[[], tuple[Penetration, ...]] = tuple

    @cached_property
    def constraints(self) -> tuple[ConstraintResult, ...]:
        """Every constraint of the score with its residual; measured when first asked for."""
        return self.measure_constraints()

    @cached_property
    def peaks(self) -> tuple[CoordinatePeaks, ...]:
        """Largest speed, acceleration and jerk of the coordinates that move."""
        return self.measure_peaks()

    @cached_property
    def clip_penetration(self) -> tuple[Penetration, ...]:
        """What penetrates what in any frame; measured when first asked for, as it takes long."""
        return self.measure_penetration()

    @cached_property
    def self_contact(self) -> tuple[Penetration, ...]:
        """Fingers of one hand that are inside each other though the score asks for no touch."""
        return tuple(p for p in self.measure_fingers() if not p.intended)

    @cached_property
    def likeness(self) -> Likeness:
        """How like a person's the movement is; measured when first asked for."""
        return self.measure_likeness()

    @property
    def met(self) -> bool:
        """Whether every constraint is within its tolerance, and no finger inside another."""
        return all(c.met for c in self.constraints) and not self.self_contact

    @property
    def missed(self) -> bool:
        """Whether a constraint is neither met nor eased, or a finger is inside another."""
        return any(c.missed for c in self.constraints) or bool(self.self_contact)

    @property
    def strains(self) -> tuple[tuple[float, Strain], ...]:
        """Where key postures are beyond the comfortable: times of the score, and what they pay."""
        return tuple(
            (float(p.time), strain)
            for p in self.postures
            if not p.reused
            for strain in p.report.strains
        )

    @property
    def evaluations(self) -> int:
        """Evaluations of the solver's objectives, all solves together."""
        return sum(p.report.evaluations for p in self.postures if not p.reused)

    @property
    def solve_s(self) -> float:
        """Time spent solving."""
        return float(sum(p.report.solve_s for p in self.postures if not p.reused))

    @property
    def explain_s(self) -> float:
        """Time spent finding the reasons of unmet constraints."""
        return float(sum(p.report.explain_s for p in self.postures if not p.reused))

    def as_json(self) -> dict[str, object]:
        """Return the report as plain data."""
        return {
            "rig": self.rig,
            "fps": self.fps,
            "mode": self.mode,
            "timing": self.timing,
            "tempo": self.tempo,
            "duration_s": self.duration_s,
            "lead_s": self.lead_s,
            "score_s": self.score_s,
            "stretched": [s.as_json() for s in self.stretched],
            "recordings": [played.as_json() for played in self.recordings],
            "keyframes": [_keyframe(p) for p in self.postures],
            "problems": [row for p in self.postures if not p.reused for row in _problems(p)],
            "evaluations": self.evaluations,
            "solve_s": self.solve_s,
            "explain_s": self.explain_s,
            "constraints": [c.as_json() for c in self.constraints],
            "strains": [{"time_s": time, **strain.as_json()} for time, strain in self.strains],
            "limits": {"max_excess_rad": self.max_excess_rad, "joint": self.excess_joint},
            "penetration": [row for p in self.postures for row in _penetration(p)],
            "clip_penetration": [p.as_json() for p in self.clip_penetration],
            "self_contact": [p.as_json() for p in self.self_contact],
            "blocks": [{**row} for row in self.blocks],
            "coordinates": [p.as_json() for p in self.peaks],
            "likeness": self.likeness.as_json(),
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
    missed = [answer for answer in _answers(task, plan) if answer.reason is not None]
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


def limit_excess(q: Array, coordinates: Coordinates) -> tuple[float, str | None]:
    """Return by how much the worst coordinate of a clip leaves its limits, and which it is."""
    excess = np.max(np.maximum(coordinates.lower - q, q - coordinates.upper), axis=0, initial=0.0)
    worst = int(np.argmax(excess))
    return float(excess[worst]), coordinates.names[worst] if excess[worst] > 0 else None


def _keyframe(posture: KeyPosture) -> dict[str, object]:
    return {
        "time_s": float(posture.time),
        "origin": posture.origin.value,
        "constraints": len(posture.ik_tasks),
        "unmet": posture.unmet_count,
        "limbs": sorted(posture.limbs),
        "reused": posture.reused,
    }


def _problems(posture: KeyPosture) -> Sequence[dict[str, object]]:
    return [
        {
            "time_s": float(posture.time),
            "name": p.name,
            "constraints": [
                {
                    "path": [*posture.ik_tasks[i].path],
                    "kind": operator_text(posture.ik_tasks[i].constraint),
                }
                for i in p.constraints
            ],
            "chain": [*p.chain],
            "merged_into": p.merged_into,
            "moved": [*p.moved],
            **({} if p.iterations is None else {"iterations": p.iterations}),
        }
        for p in posture.report.problems
    ]


def _penetration(posture: KeyPosture) -> Sequence[dict[str, object]]:
    return [
        {
            "time_s": float(posture.time),
            "pair": [p.first, p.second],
            "depth_m": p.depth_m,
            "intended": False,
        }
        for p in posture.report.penetration
    ]
