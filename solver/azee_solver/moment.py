"""One moment to be solved: its tasks bound to a body, and the problems that they make."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from azee_solver.body import Body
from azee_solver.constraint import Constraint, Orient
from azee_solver.evaluate import evaluator
from azee_solver.footprint import Footprint
from azee_solver.geometry import Side
from azee_solver.groups import Group
from azee_solver.options import SolveOptions
from azee_solver.problems import Problem, ProblemBuilder, Reach
from azee_solver.task import Task

if TYPE_CHECKING:
    from azee_rig.rig import Rig

Array = NDArray[np.float64]


class Moment:
    """What solving one moment starts from.

    constraints: of the tasks. start: (V,) where to start looking. reference: (V,) the posture to
    stay near, with the handshapes in it. body: the rig with costs and obstacles. problems: in the
    order of `ProblemBuilder`. footprints: by task, what its residual depends on.

    Inertia m draws the posture to the start as well: (q − reference)² + m (q − start)² is, but for
    a constant, (1 + m) (q − (reference + m start) / (1 + m))². So it changes weight and reference.
    """

    def __init__(
        self,
        rig: Rig,
        tasks: Sequence[Task],
        dominant: Side,
        start: Array,
        reference: Array,
        options: SolveOptions,
    ) -> None:
        """Bind tasks to a rig; see `solve` for the arguments.

        Raises: BindingError: the rig lacks a bone, site or morph.
        """
        self.tasks = tasks
        self.options = replace(options, posture=(1.0 + options.inertia) * options.posture)
        self.constraints: list[Constraint] = [task.constraint for task in tasks]
        measure, limits = evaluator(rig, dominant), rig.coordinates
        for constraint in self.constraints:
            measure.binding.check(constraint)
        self.start = np.clip(start, limits.lower, limits.upper)
        self.reference = np.clip(reference, limits.lower, limits.upper)
        self.reference += options.inertia / (1.0 + options.inertia) * (self.start - self.reference)
        for v in options.fixed:
            self.reference[v] = self.start[v]
        presets = measure.binding.presets(self.constraints)
        self.body = Body(
            rig, measure, self.reference.copy(), presets, self.options, self.constraints
        )
        for v, angle in presets.items():
            if v not in options.fixed:
                self.reference[v] = np.clip(angle, limits.lower[v], limits.upper[v])
        builder = ProblemBuilder(tasks, measure.binding, self.body.anatomy)
        self.problems: tuple[Problem, ...] = builder.build()
        self.footprints: Mapping[int, Footprint] = builder.footprints

    def tasks_of(self, group: Group) -> dict[int, Task]:
        """Return the tasks of a group by their index."""
        indices = sorted(i for p in group.problems for i in self.problems[p].tasks)
        return {i: self.tasks[i] for i in indices}

    def precedence(self, i: int) -> tuple[bool, Fraction, int, int]:
        """Order of tasks from the one that is kept longest: orientations after all others."""
        return isinstance(self.constraints[i], Orient), *self.tasks[i].order

    def is_widest(self, group: Group) -> bool:
        """Whether nothing more can be given to a group to move."""
        return all(
            self.problems[p].steps[Reach.ALL] <= group.free | self.options.fixed
            for p in group.problems
        )

    def jump(self, q: Array) -> float:
        """How far a posture is from the start, in the coordinate that is farthest, radians."""
        return float(np.abs(q - self.start).max())
