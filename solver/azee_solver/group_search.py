"""Solving one group of problems: descents from several starts until one meets everything.

`solve_group` minimises, over the coordinates that the group may move and inside their limits,

    f(q) = Σ w r² + w_o Σ overlap² + Σ λ (q − q₀)² + Σ κ beyond²

(docs/solver.md names the terms). f has many local minima, so there are descents from many starts:

1. minimise from each start in turn until one end meets everything or no more is gained (`search`);
2. if only the body is in the way, minimise around it and through it (`around_the_body`);
3. from the best end minimise until nothing is gained (`finished`);
4. if a place is far out of reach, try nearly straight arms as well (`nearest`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from azee_solver import block
from azee_solver.anatomy import Part
from azee_solver.body import Body
from azee_solver.broadphase import Collisions
from azee_solver.collisions import MARGIN_M, depths
from azee_solver.constraint import Look, LookAt, Place
from azee_solver.descent import (
    refined,
    scaled_weights,
    soft_descent,
    stiff_descent,
    without_margin,
)
from azee_solver.footprint import part_constrained
from azee_solver.program import Program, Row
from azee_solver.residuals import Residuals, lower
from azee_solver.result import Result, excess, is_repeat, merit
from azee_solver.starts import starts, straight, typical
from azee_solver.tape import Tape
from azee_solver.task import Task

Array = NDArray[np.float64]

LEVEL_RAD = math.radians(2.0)
"""How far a head that nothing turns may tilt with the trunk before it costs as much as a miss."""
ROLL_RAD = math.radians(2.0)
"""The same for its roll while the eyes are led."""

BLOCKED_WEIGHT = 2
"""A descent that ends in the body counts as so many more that gain nothing, where a wider problem
can move the body out of the way."""
REPEAT_WEIGHT = 4
"""A descent that ends where the best one did counts as so many that gain nothing: the more descents
end there, the less likely is it that there is anything better."""
DEEP = 2.0
"""Overlaps up to so many times what is tolerated are better than a miss, deeper ones are not."""
STIFF_OVERLAP = 4.0
"""Factor of the overlap's weight in `finished`, where steps are exact. Before,
the weight is smaller, so that descents find ways past the body."""
NEAR_MISS, NEAR_MISS_POSTURE, NEAR_MISS_OVERLAP = 5.0, 0.01, 0.3
"""Misses below so many tolerances are tried again with posture cost and overlap scaled down."""
PROBES = 3
"""If none of so many descents through the body meets all, the body is not what is in the way."""
RETURNING_OVERLAP = 0.1
"""Factor of the overlap's weight with which the body comes back after a descent through it."""


def solve_group(
    body: Body,
    tasks: Mapping[int, Task],
    q: Array,
    free: frozenset[int],
    *,
    unsettled: frozenset[int] = frozenset(),
    factors: Mapping[int, float] | None = None,
    first: Sequence[Array] = (),
    only_first: bool = False,
    further: bool = True,
    finish: bool = True,
) -> Result:
    """Return the best posture found for some tasks when some coordinates may move.

    Args: tasks: by their index. q: (V,) the posture so far. free: coordinates that may move.
        unsettled: coordinates that later groups will move; what only they carry is no obstacle
        yet. factors: of the weights of tasks that are given up. first: postures (V,) to start
        from before the others. only_first: start from no others. further: go on while the body is
        in the way; else leave that to a wider problem. finish: get as near as can be to what is
        missed; else leave that to the next try.
    """
    search = GroupSearch(body, tasks, q, free, unsettled=unsettled, factors=factors)
    if not search.residuals.rows:
        return Result(q, {}, 0.0, 0.0, search.residuals.undefined)
    coordinates, indices = body.rig.coordinates, search.program.free
    known = starts(coordinates, indices, q)
    best = search.search(chain((p[indices] for p in first), () if only_first else known), further)
    if further and not only_first and body.options.far:
        best = search.around_the_body(best, typical(coordinates, indices, unlike=True))
    if finish or not best.unmet():
        best = search.finished(best)
    if finish and body.options.far:
        best = search.nearest(best, straight(coordinates, indices))
    body.evaluations += search.program.evaluations
    return best


class GroupSearch:
    """The objective of a group laid out for the kernels, and descents on it."""

    def __init__(
        self,
        body: Body,
        tasks: Mapping[int, Task],
        q: Array,
        free: frozenset[int],
        *,
        unsettled: frozenset[int] = frozenset(),
        factors: Mapping[int, float] | None = None,
    ) -> None:
        """Lay the objective out; see `solve_group` for the arguments."""
        self.body, self.tasks, self.q = body, tasks, q
        self.given_up = frozenset(factors or {})
        options = body.options
        frames = body.frames(q)
        tape = Tape(body.evaluator, frames, body.anatomy.moved_by(free))
        # A trunk leans for what is outside a bound, never for its middle.
        drawn = not free & body.anatomy.of(Part.TRUNK)
        self.residuals: Residuals = lower(
            tape, tasks, options.tolerance, factors or {}, drawn=drawn
        )
        rows = [*self.residuals.rows, *self._level_head(tape, free)]
        self.collisions = (
            body.obstacles.for_problem(free, unsettled - free)
            if options.overlap
            else Collisions.none()
        )
        gazes = any(isinstance(task.constraint, Look | LookAt) for task in tasks.values())
        cost = body.cost(gazes=gazes)
        self.program = Program(
            body.rig, q, sorted(free), tape, rows, self.collisions, cost, limits=body.bounds()
        )

    def search(self, candidates: Iterable[Array], further: bool) -> Result:
        """Return the best end of descents: the first that meets all, or when no more is gained.

        Args: candidates: starts (n,). further: see `solve_group`.
        """
        options = self.body.options
        best: Result | None = None
        stalled, repeats, repeated = 0, 0, False
        tried: set[bytes] = set()
        for start in candidates:
            if start.tobytes() in tried:
                continue
            tried.add(start.tobytes())
            result = self._near_miss_refined((self.stiff if repeated else self.soft)(start))
            found = merit(result, options)
            if not found[0] and not excess(result, options):
                best = result
                break
            repeated = best is not None and is_repeat(found, merit(best, options))
            repeats += repeated
            if best is None or found[0] < merit(best, options)[0]:
                stalled, repeats = 0, 0
            else:
                stalled += REPEAT_WEIGHT if repeated else 1
                stalled += BLOCKED_WEIGHT if excess(result, options) and not further else 0
            if best is None or found < merit(best, options):
                best = result
            if stalled >= options.patience or ((repeated or further) and self.suffices(best)):
                break
        assert best is not None
        return replace(best, repeats=repeats)

    def around_the_body(self, best: Result, candidates: Iterable[Array]) -> Result:
        """Return what descents around and through the body find, where it is in the way.

        From every start (n,) twice: with the body, and after a descent without it, after which it
        comes back in two steps and pushes the posture out of itself (ADR 25). Of 1,747 drawn
        problems this meets four more.
        """
        options = self.body.options
        if not options.overlap or self.suffices(best):
            return best
        starts = list(candidates)
        if not self._body_is_in_the_way([best.q[self.program.free], *starts[: PROBES - 1]]):
            return best
        for start in starts:
            if self.suffices(best):
                break
            for x in (start, self._out_of_the_body(start)):
                result = self._near_miss_refined(self.stiff(x))
                best = min(best, result, key=lambda r: merit(r, options))
        return best

    def suffices(self, result: Result) -> bool:
        """Whether nothing is unmet and nothing overlaps but the margin around the body.

        The margin is a wish: reports leave it out (ADR 27).
        """
        tolerated_m = self.body.options.overlap_m
        if result.unmet() or result.overlap_m > tolerated_m + MARGIN_M:
            return False
        return result.overlap_m <= tolerated_m or bool(
            depths(self.body.rig, self.collisions, result.q).max(initial=0.0) <= tolerated_m
        )

    def finished(self, result: Result) -> Result:
        """Minimise from a result until nothing is gained; near targets end in near postures so.

        Where a task is missed, Gauss-Newton steps are short: there NLopt goes on first.
        """
        options, program = self.body.options, self.program
        tolerance, unmet = options.finish_tolerance, result.unmet()
        x = result.q[program.free]
        if unmet:
            x = program.lbfgs(x, max_evaluations=options.max_evaluations, tolerance=tolerance)
        with scaled_weights(program, overlap=STIFF_OVERLAP):
            rounds = options.finish_work // max(len(x), 1)
            x = program.gauss_newton(x, rounds=rounds, tolerance=tolerance, keep_damping=not unmet)
        finished = self.measured(x)
        if not finished.unmet() and excess(finished, options) <= excess(result, options):
            return finished
        return min(finished, result, key=lambda r: merit(r, options))

    def nearest(self, best: Result, candidates: Iterable[Array]) -> Result:
        """Look for another posture that comes nearer to a place that is far out of reach.

        What is best early in a descent is not what is best at its end, so each goes on to there
        (ADR 25: worst distance behind the best of any method 9.7 → 0.3 mm).

        Args: candidates: starts (n,).
        """
        places = [i for i in best.unmet() if isinstance(self.tasks[i].constraint, Place)]
        if not any(best.ratios[i] > NEAR_MISS for i in places):
            return best
        others = [self.finished(self.soft(start)) for start in candidates]
        return min([best, *others], key=lambda r: merit(r, self.body.options))

    # Single descents --------------------------------------------------------------------------

    def soft(self, start: Array) -> Result:
        """Return where a soft descent from a start (n,) ends."""
        return self.measured(soft_descent(self.program, start, self.body.options))

    def stiff(self, start: Array) -> Result:
        """Return where a stiff descent from a start (n,) ends, on its side of the body."""
        return self.measured(stiff_descent(self.program, start, self.body.options))

    def _body_is_in_the_way(self, starts: Iterable[Array]) -> bool:
        """Whether a descent without the body from one of some starts (n,) meets everything.

        If not, the body is not to blame: targets out of reach are not searched for around it.
        """
        return any(not self.measured(self._through_the_body(x)).unmet() for x in starts)

    def _through_the_body(self, start: Array) -> Array:
        """Return where a descent without collision ends, (n,)."""
        with scaled_weights(self.program, overlap=0.0):
            return stiff_descent(self.program, start, self.body.options)

    def _out_of_the_body(self, start: Array) -> Array:
        """Return where the body, at part of its weight, pushes a descent through it, (n,)."""
        through = self._through_the_body(start)
        with scaled_weights(self.program, overlap=RETURNING_OVERLAP):
            return stiff_descent(self.program, through, self.body.options)

    def _near_miss_refined(self, result: Result) -> Result:
        """Minimise once more with little posture cost, if a small miss may come from that.

        If the body is in the way too, minimise without the margin around it, which is a wish.
        """
        if not 1.0 < result.worst() < NEAR_MISS:
            return result
        x, options = result.q[self.program.free], self.body.options
        posture = self._posture_factors(NEAR_MISS_POSTURE)
        with scaled_weights(self.program, posture=posture, overlap=NEAR_MISS_OVERLAP):
            closer = self.measured(refined(self.program, x, options))
        if closer.overlap_m <= max(result.overlap_m, DEEP * options.overlap_m):
            result = min(result, closer, key=lambda r: merit(r, options))
        if not result.unmet() or not excess(result, options):
            return result
        with without_margin(self.program), scaled_weights(self.program, posture=posture):
            x = refined(self.program, result.q[self.program.free], options)
        return min(result, self.measured(x), key=lambda r: merit(r, options))

    def _posture_factors(self, factor: float) -> Array:
        """Factors of posture and joint-limit cost per free coordinate; handshapes keep theirs."""
        return np.array([1.0 if v in self.body.presets else factor for v in self.program.free])

    def measured(self, x: Array) -> Result:
        """Return what the free coordinates x (n,) are worth."""
        self.program(x, np.empty(0))
        ratios = self.residuals.ratios(
            self.program.lengths(), self.tasks, self.body.options.tolerance
        )
        q = self.q.copy()
        q[self.program.free] = x
        return Result(
            q,
            ratios,
            sum(r * r for i, r in ratios.items() if i not in self.given_up),
            float(self.program.section(block.DEEPEST)[0]),
            self.residuals.undefined,
            self.given_up,
        )

    def _level_head(self, tape: Tape, free: frozenset[int]) -> list[Row]:
        """Rows that keep the head as it was while the trunk moves under it, and never roll it.

        A gaze turns and pitches the head; by Donders' law it does not roll: the line through the
        ears stays level.
        """
        anatomy_, rig = self.body.anatomy, self.body.rig
        gaze = any(isinstance(task.constraint, Look | LookAt) for task in self.tasks.values())
        if not free & anatomy_.of(Part.HEAD) or not (gaze or free & anatomy_.of(Part.TRUNK)):
            return []
        binding = self.body.evaluator.binding
        if Part.HEAD in {part_constrained(t.constraint, binding) for t in self.tasks.values()}:
            return []
        node = rig.bones["head"].node
        axes = [tape.node_vector(node, np.eye(3)[k]) for k in range(3)]
        if gaze:
            up = tape.constant(np.array([0.0, 1.0, 0.0]))
            return [Row(block.PERPENDICULAR, axes[0], up, ROLL_RAD**-2)]
        level = self.body.frames(self.body.reference).rotations[node]
        weight = 0.5 * LEVEL_RAD**-2
        return [
            Row(block.MEET, axis, tape.constant(level[:, k]), weight) for k, axis in enumerate(axes)
        ]
