"""Solving one group of problems: descents from several starts until one meets everything."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from azee_solver import block
from azee_solver.anatomy import Part, part_of
from azee_solver.binding import Binding
from azee_solver.body import Body
from azee_solver.broadphase import Collisions
from azee_solver.collisions import MARGIN_M, depths
from azee_solver.constraint import Constraint, Look, LookAt, Orient, Place, Rotate
from azee_solver.descent import descended, pressed, refined, weighing
from azee_solver.program import Program, Row
from azee_solver.residuals import Residuals, lower
from azee_solver.result import Result, excess, gains, is_again, merit
from azee_solver.starts import starts, straight, typical
from azee_solver.tape import Tape
from azee_solver.task import Task

Array = NDArray[np.float64]

LEVEL_RAD = math.radians(2.0)
"""How far a head that nothing turns may tilt with the trunk before it costs as much as a miss."""
GAZING_LEVEL_RAD = math.radians(5.0)
"""The same for its tilt while the eyes are led."""

BLOCKED = 2
"""A descent that ends in the body counts so many times more against looking on, where a wider
problem can move the body out of the way."""
AGAIN = 4
"""So many times counts a descent that ends where the best one did, unless that is a near miss: the
more descents end there, the less likely is it that there is anything better."""
RETURNS, CLEAR_RETURNS = 9, 3
"""So many descents that come back to the same end, with the body and through it, end the search;
so many where nothing is missed and only overlap is left."""
DEEP = 2.0
"""Overlaps up to so many times what is tolerated are better than a miss, deeper ones are not."""
FIRM = 4.0
"""By what bodies push harder at the end, where steps are exact: soft ones are found around."""
FAR = 30.0
"""Beyond so many tolerances a miss pulls no harder, once it is known that it must miss."""
FAR_EASE = 0.3
"""Part of posture's and comfort's price where a miss is too great to come from them."""
POLISH, POLISH_EASE, POLISH_OVERLAP = 5.0, 0.01, 0.3
"""Misses below so many tolerances are tried again with posture, comfort and overlap at a part."""
FAINT = 0.1
"""Part of its weight with which the body comes back where descents have passed through it."""
UNHINDERED = 3
"""So many descents through the body, none of which meets all: then it is not in the way."""
ROUGH = 1e-6
"""Relative gain that ends descents whose ends are only compared."""
NEARER = 0.1
"""By so many tolerances another posture must be nearer to what is out of reach to be preferred."""


def solve_group(
    body: Body,
    tasks: Mapping[int, Task],
    q: Array,
    free: frozenset[int],
    *,
    unsettled: frozenset[int] = frozenset(),
    ease: Mapping[int, float] | None = None,
    first: Sequence[Array] = (),
    only_first: bool = False,
    thorough: bool = True,
    to_the_end: bool = True,
) -> Result:
    """Return the best posture found for some tasks when some coordinates may move.

    Args: q: (V,) the posture so far. unsettled: coordinates that other problems will still move.
        ease: factors of the tasks' weights. first: postures (V,) to start from before the
        others, or instead of them. thorough: look on while the body is in the way; else leave
        that to a wider problem. to_the_end: get as near as can be to what is missed; else leave
        that to the next try.
    """
    attempt = _Attempt(body, tasks, q, free, unsettled, ease or {})
    if not attempt.residuals.rows:
        return Result(q, {}, 0.0, 0.0, attempt.residuals.undefined)
    indices = attempt.program.free
    known = starts(body.rig.coordinates, indices, q, body.options.further_starts)
    best = attempt.search(chain((p[indices] for p in first), () if only_first else known), thorough)
    if thorough and not only_first and body.options.further_starts:
        best = attempt.around(best, typical(body.rig.coordinates, indices, unlike=True))
    if to_the_end or not best.lost():
        best = attempt.finished(best)
    if to_the_end and body.options.further_starts:
        best = attempt.nearest(best, straight(body.rig.coordinates, indices))
    body.evaluations += attempt.program.evaluations
    return best


def _turns_head(constraint: Constraint, binding: Binding) -> bool:
    match constraint:
        case Place(site):
            return part_of(binding.site(site).bone) is Part.HEAD
        case Orient(_, bone) | Rotate(bone):
            return part_of(bone.name) is Part.HEAD
        case _:
            return False


class _Attempt:
    """The objective of a group, and descents on it."""

    def __init__(
        self,
        body: Body,
        tasks: Mapping[int, Task],
        q: Array,
        free: frozenset[int],
        unsettled: frozenset[int],
        ease: Mapping[int, float],
    ) -> None:
        self.body, self.tasks, self.q = body, tasks, q
        self.ease = frozenset(ease)
        options = body.options
        moving = body.anatomy.moved_by(free)
        frames = body.frames(q)
        tape = Tape(body.evaluator, frames, moving)
        self.residuals: Residuals = lower(tape, tasks, options.tolerance, ease)
        rows = [*self.residuals.rows, *self._level(tape, free)]
        self.collisions = (
            body.obstacles.for_problem(free, unsettled - free)
            if options.overlap
            else Collisions.none()
        )
        gazes = any(isinstance(d.constraint, Look | LookAt) for d in tasks.values())
        self.cost = body.cost(gazes=gazes)
        self.program = Program(body.rig, q, sorted(free), tape, rows, self.collisions, self.cost)

    def search(self, at_hand: Iterable[Array], thorough: bool) -> Result:
        """Return the best end of descents: the first that meets all, or when no more is gained.

        One that meets all but for the margin around bodies ends the search once another ended
        there too, or at once where no wider problem could get it clear.
        After a descent that ended where the best one did the next one goes another way about it.
        """
        options = self.body.options
        patience = options.patience * (2 if thorough else 1)
        best: Result | None = None
        in_vain, returns, again = 0, 0, False
        tried: set[bytes] = set()
        for start in at_hand:
            if start.tobytes() in tried:
                continue
            tried.add(start.tobytes())
            result = self._polished(self.press(start) if again else self.descend(start))
            found = merit(result, options)
            if not found[0] and not excess(result, options):
                best = result
                break
            again = best is not None and is_again(found, merit(best, options))
            returns += again
            if best is None or gains(found, merit(best, options)):
                in_vain, returns = 0, 0
            else:
                near = 1.0 < result.worst() < POLISH and (thorough or self.ease)
                in_vain += AGAIN if again and not near else 1
                in_vain += BLOCKED if excess(result, options) and not thorough else 0
            if best is None or found < merit(best, options):
                best = result
            if in_vain >= patience or ((again or thorough) and self._will_do(best)):
                break
        assert best is not None
        return replace(best, again=returns)

    def around(self, best: Result, at_hand: Iterable[Array]) -> Result:
        """Look on where the body is in the way of what could be met, or return the best there is.

        From every start twice: with the body, and through it, where it comes back little by
        little and pushes the posture out of itself.
        """
        options = self.body.options
        if not options.overlap or self._will_do(best):
            return best
        starts = list(at_hand)
        probes = [best.q[self.program.free], *starts[: UNHINDERED - 1]]
        if not starts or all(self._through(x).lost() for x in probes):
            return best
        returned = 0
        for start in starts:
            through = self._through(start).q[self.program.free]
            with weighing(self.program, overlap=FAINT):
                out = self.press(through).q[self.program.free]
            for x in (start, out):
                result = self._polished(self.press(x))
                returned += is_again(merit(result, options), merit(best, options))
                best = min(best, result, key=lambda r: merit(r, options))
                if returned >= (RETURNS if best.lost() else CLEAR_RETURNS) or self._will_do(best):
                    return best
        return best

    def _will_do(self, result: Result) -> bool:
        """Whether nothing is missed and nothing overlaps, but for the margin around bodies."""
        tolerated_m = self.body.options.overlap_m
        if result.lost() or result.overlap_m > tolerated_m + MARGIN_M:
            return False
        return result.overlap_m <= tolerated_m or bool(
            depths(self.body.rig, self.collisions, result.q).max() <= tolerated_m
        )

    def _through(self, start: Array) -> Result:
        """Return where a descent ends to which the body gives way."""
        with weighing(self.program, overlap=0.0):
            return self.press(start)

    def nearest(self, best: Result, at_hand: Iterable[Array]) -> Result:
        """Look for another posture that comes nearer to what is far out of reach.

        What is best early in a descent is not what is best at its end, so each goes on to there.
        """
        places = [i for i in best.lost() if isinstance(self.tasks[i].constraint, Place)]
        if not any(best.ratios[i] > POLISH for i in places):
            return best
        for start in at_hand:
            other = self.finished(self.descend(start), ROUGH)
            (misses, cost), (fewest, least) = (
                merit(result, self.body.options) for result in (other, best)
            )
            if misses <= fewest and math.sqrt(cost) < math.sqrt(least) - NEARER:
                best = other
        return self.finished(best)

    def finished(self, result: Result, tolerance: float | None = None) -> Result:
        """Go on to the very bottom, so that near targets end in near postures.

        Far from what they want, Gauss-Newton steps are short: there NLopt goes on first. What is
        far away pulls less then, so that it does not press the body into itself.
        """
        options, program = self.body.options, self.program
        tolerance = tolerance or options.finish_tolerance
        lost = result.lost()
        each = np.ones(len(program.rows))
        for i in lost:
            each[slice(*self.residuals.runs[i])] = min(1.0, FAR / result.ratios[i])
        far = any(result.ratios[i] > POLISH for i in lost)
        x = result.q[program.free]
        with weighing(program, each=each, ease=self._ease(FAR_EASE) if far else None):
            if lost:
                x = program.descend(x, max_evaluations=options.max_evaluations, tolerance=tolerance)
            with weighing(program, overlap=FIRM):
                rounds = options.finish_work // max(len(x), 1)
                x = program.polish(x, rounds=rounds, tolerance=tolerance, going_on=not lost)
        finished = self._measure(x)
        if not finished.lost() and excess(finished, options) <= excess(result, options):
            return finished
        return min(finished, result, key=lambda r: merit(r, options))

    def _polished(self, result: Result) -> Result:
        """Descend once more without the price of ease and distance, if a small miss may be that."""
        if not 1.0 < result.worst() < POLISH:
            return result
        x, options = result.q[self.program.free], self.body.options
        with weighing(self.program, ease=self._ease(POLISH_EASE), overlap=POLISH_OVERLAP):
            closer = self._measure(refined(self.program, x, options))
        if closer.overlap_m > max(result.overlap_m, DEEP * self.body.options.overlap_m):
            return result
        return min(result, closer, key=lambda r: merit(r, self.body.options))

    def descend(self, start: Array) -> Result:
        """Return where a descent from a start ends."""
        return self._measure(descended(self.program, start, self.body.options))

    def press(self, start: Array) -> Result:
        """Return where a descent at the full price ends, on its side of the body."""
        return self._measure(pressed(self.program, start, self.body.options))

    def _ease(self, share: float) -> Array:
        """Parts of their price that posture and comfort cost, per free coordinate; presets hold."""
        return np.array([1.0 if v in self.body.presets else share for v in self.program.free])

    def _measure(self, x: Array) -> Result:
        self.program(x, np.empty(0))
        ratios = self.residuals.ratios(
            self.program.lengths(), self.tasks, self.body.options.tolerance
        )
        q = self.q.copy()
        q[self.program.free] = x
        return Result(
            q,
            ratios,
            sum(r * r for i, r in ratios.items() if i not in self.ease),
            float(self.program.section(block.DEEPEST)[0]),
            self.residuals.undefined,
            self.ease,
        )

    def _level(self, tape: Tape, free: frozenset[int]) -> list[Row]:
        """Rows that keep the head as it was while the trunk moves under it."""
        anatomy_, rig = self.body.anatomy, self.body.rig
        if not free & anatomy_.of(Part.TRUNK) or not free & anatomy_.of(Part.HEAD):
            return []
        if any(_turns_head(d.constraint, self.body.evaluator.binding) for d in self.tasks.values()):
            return []
        node = rig.bones["head"].node
        level = self.body.frames(self.body.reference).rotations[node]
        gaze = any(isinstance(d.constraint, Look | LookAt) for d in self.tasks.values())
        columns = (1,) if gaze else (0, 1, 2)
        weight = GAZING_LEVEL_RAD**-2 if gaze else 0.5 * LEVEL_RAD**-2
        return [
            Row(
                block.MEET,
                tape.node_vector(node, np.eye(3)[k]),
                tape.constant(level[:, k]),
                weight,
            )
            for k in columns
        ]
