"""The report of a movement: every constraint over its whole block, limits, and the solving."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee.motion.timing.performed import Stretch
from azee.quality.constraint_results import ConstraintResult
from azee.quality.likeness import Likeness
from azee.quality.measures import CoordinatePeaks, Penetration
from azee.quality.recordings import PlayedRecording
from azee_rig.coordinates import Coordinates
from azee_solver.notation import operator_text
from azee_solver.outcome import Strain

if TYPE_CHECKING:
    from azee.motion.tasks.key_posture import KeyPosture

Array = NDArray[np.float64]


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
        """Time spent so far finding the reasons of missed constraints."""
        return float(sum(p.report.explain_s for p in self.postures if not p.reused))

    def as_json(self) -> dict[str, object]:
        """Return the report as plain data."""
        constraints = [c.as_json() for c in self.constraints]  # asks for reasons, which takes time
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
            "constraints": constraints,
            "strains": [{"time_s": time, **strain.as_json()} for time, strain in self.strains],
            "limits": {"max_excess_rad": self.max_excess_rad, "joint": self.excess_joint},
            "penetration": [row for p in self.postures for row in _penetration(p)],
            "clip_penetration": [p.as_json() for p in self.clip_penetration],
            "self_contact": [p.as_json() for p in self.self_contact],
            "blocks": [{**row} for row in self.blocks],
            "coordinates": [p.as_json() for p in self.peaks],
            "likeness": self.likeness.as_json(),
        }


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
