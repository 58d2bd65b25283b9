"""What solving one moment needs of a body: its costs, its obstacles, and frames of postures."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import Frames
from azee_solver import block
from azee_solver.anatomy import Anatomy, Part, anatomy
from azee_solver.broadphase import Collisions
from azee_solver.collisions import Obstacles
from azee_solver.constraint import Constraint
from azee_solver.evaluate import Evaluator
from azee_solver.geometry import Side
from azee_solver.options import SolveOptions
from azee_solver.program import Cost, Program
from azee_solver.residuals import EDGE_COST
from azee_solver.tape import Tape

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]

EYE_STIFFNESS, NECK_STIFFNESS = 0.1, 3.0
"""Of eyes and neck while the eyes are led; the head has 1. They turn first, it last."""
EYE_RANGE_RAD = math.radians(15.0)
"""How far led eyes turn before the head takes the rest."""
EYE_COMFORT = 10.0
"""Joint-limit cost of what they turn beyond that."""
FOLLOWING_STIFFNESS = 4.0
"""Of last finger joints, in following those before them."""


@dataclass(slots=True)
class Body:
    """What solving one moment needs of the rig; counts evaluations."""

    rig: Rig
    evaluator: Evaluator
    reference: Array
    presets: Mapping[int, float]
    options: SolveOptions
    constraints: Sequence[Constraint]
    evaluations: int = 0
    limits: tuple[Array, Array] | None = None
    anatomy: Anatomy = field(init=False)
    obstacles: Obstacles = field(init=False)
    yielding: Mapping[int, float] = field(init=False)
    _weights: dict[bool, tuple[Array, Array, float, Mapping[int, int], Mapping[int, float]]] = (
        field(init=False, default_factory=dict)
    )

    def __post_init__(self) -> None:
        self.anatomy = anatomy(self.rig.chain, self.rig.coordinates)
        self.obstacles = Obstacles(self.evaluator.binding, self.anatomy, self.constraints)
        bounds = self.evaluator.binding.yielding(self.constraints)
        self.yielding = {v: bound for v, bound in bounds.items() if v in self.presets}

    def relaxed(self, reference: Array) -> Body:
        """Return the body without collision, handshapes and joint-limit cost."""
        options = replace(
            self.options,
            posture=1e-3,
            comfort=0.0,
            overlap=0.0,
            overlap_m=math.inf,
        )
        return replace(self, reference=reference, presets={}, options=options, evaluations=0)

    def bounds(self) -> tuple[Array, Array] | None:
        """Return the limits of all coordinates, (V,) each; fingers yield no farther than told.

        None: those of the rig.
        """
        if not self.yielding:
            return self.limits
        coordinates = self.rig.coordinates
        lower, upper = map(np.array, self.limits or (coordinates.lower, coordinates.upper))
        for v, bound in self.yielding.items():
            shape = min(max(self.presets[v], lower[v]), upper[v])
            lower[v], upper[v] = max(lower[v], shape - bound), min(upper[v], shape + bound)
        return lower, upper

    def cost(self, *, gazes: bool) -> Cost:
        """Posture and joint-limit cost: presets hold like constraints, led eyes turn first."""
        if gazes not in self._weights:
            self._weights[gazes] = self._weighed(gazes=gazes)
        reference = np.array(self.reference)
        reference[list(self.presets)] = list(self.presets.values())
        return Cost(reference, *self._weights[gazes])

    def _weighed(
        self, *, gazes: bool
    ) -> tuple[Array, Array, float, Mapping[int, int], Mapping[int, float]]:
        options, anatomy_ = self.options, self.anatomy
        stiffness = np.array(self.rig.coordinates.stiffness)
        comfort = np.full(len(stiffness), options.comfort)
        if gazes:
            for v in anatomy_.of(Part.EYES):
                stiffness[v], comfort[v] = EYE_STIFFNESS, EYE_COMFORT
            for v in anatomy_.of(Part.HEAD):
                if anatomy_.names[v].startswith("neck"):
                    stiffness[v] = NECK_STIFFNESS
        follows = {} if options.posture == 0 or options.inertia else anatomy_.followers
        keep = options.posture * stiffness**2
        keep[list(follows)] *= FOLLOWING_STIFFNESS
        preset = list(self.presets)
        keep[preset], comfort[preset] = options.tolerance.angle_rad**-2, 0.0
        for v, bound in self.yielding.items():
            keep[v] = EDGE_COST / bound**2
        loose = {v: leader for v, leader in follows.items() if v not in self.presets}
        comfort[list(loose)] = 0.0
        half = EYE_RANGE_RAD / block.COMFORTABLE
        ranges = dict.fromkeys(anatomy_.of(Part.EYES), half) if gazes else {}
        return keep, comfort, options.overlap, loose, ranges

    def frames(self, q: Array) -> Frames:
        """Frames of one posture, by the kernels: a hundred times faster than `Chain.frames`."""
        program = _forward(self.rig)
        program(np.ascontiguousarray(q), np.empty(0))
        count = len(self.rig.chain.names)
        return Frames(
            program.section(block.POSITIONS).reshape(count, 3).copy(),
            program.section(block.ROTATIONS).reshape(count, 3, 3).copy(),
        )


@lru_cache(maxsize=4)
def _forward(rig: Rig) -> Program:
    """Return a program that asks for nothing but the frames of all nodes."""
    moving = np.ones(len(rig.chain.names), dtype=np.bool_)
    blank = Frames(np.zeros((len(moving), 3)), np.zeros((len(moving), 3, 3)))
    nothing = np.zeros(len(rig.coordinates))
    return Program(
        rig,
        nothing,
        range(len(nothing)),
        Tape(Evaluator(rig, Side.RIGHT), blank, moving),
        [],
        Collisions.none(),
        Cost(nothing, nothing, nothing, 0.0),
        all_frames=True,
    )
