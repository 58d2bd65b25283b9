"""Why a constraint is not met, found by asking smaller questions of the same solver.

Alone, without the body in its way, with everything free that can help: if it misses even so, it is
out of reach, or a coordinate's limit stops it. If only the body stops it, that is the reason; it is
so only where two of its parts touch. Else other constraints do: the first that excludes it as a
pair, or, if none does, those whose removal lets it be met. What alone would miss by a degree and
misses by forty is so because of the others, whatever stops it at that degree. If all could be met
together, the search has left a part of the body still that would have to move.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from azee_solver.body import Body
from azee_solver.body_words import bone_words, capsule_words, limit_words, listed
from azee_solver.constraint import Constraint, Morph, Place
from azee_solver.footprint import Footprint
from azee_solver.geometry import WorldPoint
from azee_solver.group_search import solve_group
from azee_solver.notation import constraint_text, part_text, subject_text
from azee_solver.result import Result
from azee_solver.task import Task

Array = NDArray[np.float64]

MAIN_SHARE = 0.5
"""A cause that accounts for a smaller share of a miss is not the main one."""
AT_LIMIT_RAD = 1e-6
"""A coordinate nearer to its limit than this has run into it."""


class Diagnosis:
    """Reasons for the constraints of one moment, given the posture that was found."""

    def __init__(
        self,
        body: Body,
        tasks: Sequence[Task],
        footprints: Mapping[int, Footprint],
        q: Array,
        moved: frozenset[int],
    ) -> None:
        """Take a posture q (V,), and the coordinates that the search for it has moved."""
        self.moved = moved
        self.tasks, self.footprints, self.q = tasks, footprints, q
        self.body = body
        self._own_misses: dict[int, float] = {}

    @cached_property
    def firm(self) -> Body:
        """The body with all its costs, drawn to the posture that was found."""
        return replace(self.body, reference=self.q)

    @cached_property
    def relaxed(self) -> Body:
        """The body without collision, handshapes and joint-limit cost."""
        return self.body.relaxed(self.q)

    def reason(self, i: int, miss: float, undefined: bool) -> str:
        """Return why task i, which is off by `miss` tolerances, is not met, in one phrase."""
        constraint = self.tasks[i].constraint
        if undefined:
            return "its direction is undefined: a vector in it has no length"
        if isinstance(constraint, Morph):
            return self._morph(i, constraint)
        held = self._free([i], everything=True) & self.firm.options.fixed
        if held and not self._free([i]):
            return "the joints that could meet it are held still"
        alone = self._alone(self.relaxed, [i])
        if not alone.missed():
            return self._others(i, miss, alone)
        if held and not self._alone(self.relaxed, [i], everything=True).missed():
            bones = sorted({self.firm.anatomy.names[v].split(".")[0] for v in held})
            joints = listed([bone_words(bone) for bone in bones])
            return f"needs {joints}, held still"
        own = self._beyond(i, alone)
        if alone.ratios[i] < MAIN_SHARE * miss:
            rivals, _ = self._conflict(i)
            if rivals:
                return f"{rivals}; besides, {own}"
        return own

    def _beyond(self, i: int, alone: Result) -> str:
        """Say what stops a constraint that joints cannot meet: their reach or a limit."""
        constraint = self.tasks[i].constraint
        left = alone.ratios[i] * self.firm.options.tolerance.of(constraint)
        if self._beyond_reach(i) > self.firm.options.tolerance.of(constraint):
            return f"out of reach by {_size(constraint, left)}"
        return self._limits(i, alone) or f"out of reach by {_size(constraint, left)}"

    # One constraint alone ---------------------------------------------------------------------

    def _alone(self, body: Body, indices: Iterable[int], *, everything: bool = False) -> Result:
        chosen = {k: self.tasks[k] for k in indices}
        free = self._free(chosen, everything=everything)
        return solve_group(body, chosen, self.q, free, first=[self.q])

    def _free(self, indices: Iterable[int], *, everything: bool = False) -> frozenset[int]:
        affected = frozenset().union(
            *(self.footprints[k].affected(self.firm.anatomy) for k in indices)
        )
        return affected if everything else affected - self.firm.options.fixed

    def _beyond_reach(self, i: int) -> float:
        """By how much a place is farther than the straightened body from its root can get."""
        constraint = self.tasks[i].constraint
        found = self.footprints[i]
        if not isinstance(constraint, Place) or not found.world or found.target:
            return 0.0
        chain = self.firm.rig.chain
        site = self.firm.evaluator.binding.site(constraint.site)
        frames = self.firm.frames(self.q)
        aim = self.firm.evaluator.target(constraint, frames, self.tasks[i].phase)
        free = self._free([i])
        length = float(sum(map(np.linalg.norm, (site.position, *(s.vector for s in site.shares)))))
        node = site.node
        while True:
            parent = int(chain.parents[node])
            if parent < 0 or not self.firm.anatomy.above(parent) & free:
                break
            length += float(np.linalg.norm(chain.offsets[node]))
            node = parent
        away = float(np.linalg.norm(aim - frames.positions[node]))
        return away - length - self.firm.evaluator.scale * constraint.distance_m

    def _limits(self, i: int, alone: Result) -> str | None:
        """Name the joint at its limit that would meet the constraint with the least beyond it."""
        limits = self.firm.rig.coordinates
        found = []
        for v in sorted(self._free([i])):
            below, above = alone.q[v] - limits.lower[v], limits.upper[v] - alone.q[v]
            past = self._past_limit(i, v, alone) if min(below, above) < AT_LIMIT_RAD else None
            if past is not None:
                found.append((abs(past), limits.names[v], v, past))
        if not found:
            return None
        _, _, v, past = min(found)
        return self._at_limit(v, past)

    def _at_limit(self, v: int, past: float) -> str:
        """Say that a coordinate would have to go beyond a limit: the lower one if negative."""
        limits = self.firm.rig.coordinates
        upper = past > 0
        limit = float(limits.upper[v] if upper else limits.lower[v])
        return limit_words(limits.names[v], limit, upper=upper, more_rad=abs(past))

    def _past_limit(self, i: int, v: int, alone: Result) -> float | None:
        """How far beyond its limit one coordinate would have to go, if that is all it takes.

        It is negative beyond the lower limit.
        """
        limits = self.firm.rig.coordinates
        lower, upper = np.array(limits.lower), np.array(limits.upper)
        lower[v], upper[v] = lower[v] - math.pi, upper[v] + math.pi
        wide = replace(self.relaxed.rig, coordinates=replace(limits, lower=lower, upper=upper))
        body = Body(
            wide, self.relaxed.evaluator, self.q, {}, self.relaxed.options, self.relaxed.constraints
        )
        chosen = {i: self.tasks[i]}
        result = solve_group(
            body, chosen, alone.q, self._free([i]), first=[alone.q], only_first=True
        )
        if result.missed():
            return None
        angle = float(result.q[v])
        return _excess(angle, limits.lower[v], limits.upper[v]) or None

    def _morph(self, i: int, morph: Morph) -> str:
        limits, binding = self.firm.rig.coordinates, self.firm.evaluator.binding
        asked = binding.presets(task.constraint for task in self.tasks)
        for v in binding.preset(morph):
            if v in self.firm.options.fixed:
                return f"{bone_words(limits.names[v].split('.')[0])} is held still"
            past = _excess(asked[v], limits.lower[v], limits.upper[v])
            if abs(past) > self.firm.options.tolerance.angle_rad:
                return self._at_limit(v, past)
        moved = frozenset(binding.preset(morph))
        others = [
            k for k, found in self.footprints.items() if found.affected(self.firm.anatomy) & moved
        ]
        return f"conflicts with {self._names(others)}" if others else "held back by its neighbours"

    # Others -----------------------------------------------------------------------------------

    def _others(self, i: int, miss: float, unhindered: Result) -> str:
        """Find what stops a constraint that joints alone could meet: the body, or others.

        Args: unhindered: a posture that meets it, as if the body were not in its way.
        """
        bodily = replace(self.firm, presets={})
        alone = self._alone(bodily, [i])
        touching = self._touching(alone, unhindered) if alone.missed() else ""
        if touching and alone.ratios[i] >= MAIN_SHARE * miss:
            return f"the body is in the way: {touching}"
        conflict, unhindered = self._conflict(i)
        if conflict:
            return conflict
        if touching:
            return f"the body is in the way: {touching}"
        rivals = self._rivals(i)
        together = self._alone(bodily, [i, *rivals])
        if together.missed() and (touching := self._touching(together, unhindered)):
            return f"the body is in the way of meeting all at once: {touching}"
        held = self._fixed_by(i)
        if held and self._alone(self.firm, [i, *rivals]).missed():
            return f"needs {listed(held)}"
        still = self._still_in(together)
        if still and not together.missed():
            return f"could be met if {listed(still)} moved too"
        return f"the search found no posture that meets it{' and the others' if rivals else ''}"

    def _conflict(self, i: int) -> tuple[str, Result]:
        """Name what excludes a constraint: one other, else those whose removal lets it be met.

        Returns: nothing where nothing does; and the posture with all that may exclude it.
        """
        rivals = self._rivals(i)
        for k in rivals:
            pair = self._alone(self.relaxed, [i, k])
            if self._exclude_each_other(pair):
                return f"conflicts with {self._names([k])}", pair
        everything = [i, *rivals]
        together = self._alone(self.relaxed, everything)
        if not self._exclude_each_other(together):
            return "", together
        guilty = [
            k
            for k in rivals
            if not self._exclude_each_other(
                self._alone(self.relaxed, [j for j in everything if j != k])
            )
        ]
        return f"conflicts with {self._names(guilty or rivals)} together", together

    def _exclude_each_other(self, result: Result) -> bool:
        """Whether constraints that were solved together miss by more than each of them alone."""
        return any(miss > 1.0 + self._own_miss(k) for k, miss in result.ratios.items())

    def _own_miss(self, k: int) -> float:
        """By how many tolerances a constraint misses alone; none if it is met."""
        if k not in self._own_misses:
            alone = self._alone(self.relaxed, [k])
            self._own_misses[k] = alone.ratios.get(k, 0.0) if alone.missed() else 0.0
        return self._own_misses[k]

    def _still_in(self, other: Result) -> list[str]:
        """Return the bones that another posture moves and the search for this one left still."""
        apart = np.abs(other.q - self.q) > self.firm.options.tolerance.angle_rad
        names = self.firm.anatomy.names
        moved = (names[v] for v in np.flatnonzero(apart) if v not in self.moved)
        return [bone_words(bone) for bone in dict.fromkeys(name.split(".")[0] for name in moved)]

    def _rivals(self, i: int) -> list[int]:
        """Other constraints that share coordinates with this one, directly or through others."""
        linked, reach = {i}, self._free([i], everything=True)
        grown = True
        while grown:
            grown = False
            for k in self.footprints:
                if k not in linked and self._free([k], everything=True) & reach:
                    linked.add(k)
                    reach |= self._free([k], everything=True)
                    grown = True
        return sorted(linked - {i}, key=lambda k: self.tasks[k].order)

    def _fixed_by(self, i: int) -> list[str]:
        moved = self._free([i], everything=True)
        out = []
        for task in self.tasks:
            constraint = task.constraint
            if isinstance(constraint, Morph) and self.firm.evaluator.binding.is_skeletal(
                constraint
            ):
                held = moved & frozenset(self.firm.evaluator.binding.preset(constraint))
                if held:
                    out.append(f"joints that `{subject_text(constraint)}` sets")
        return out

    def _touching(self, *results: Result) -> str:
        """Name what overlaps most in the first posture in which anything does, else nothing."""
        for result in results:
            for overlap in self.firm.obstacles.overlaps(result.q)[:1]:
                return f"{capsule_words(overlap.first)} and {capsule_words(overlap.second)}"
        return ""

    def _names(self, indices: Iterable[int]) -> str:
        return listed([_named(self.tasks[k].constraint) for k in indices])


def _named(constraint: Constraint) -> str:
    """Name a constraint as its text does; what has measured points keeps a site on a path."""
    if isinstance(constraint, Place) and isinstance(constraint.point, WorldPoint):
        return f"the path of `{part_text(constraint.site)}`"
    return f"`{constraint_text(constraint)}`"


def _excess(angle: float, lower: float, upper: float) -> float:
    """How far an angle is above its upper limit, or, as a negative angle, below its lower one."""
    return max(angle - upper, 0.0) - max(lower - angle, 0.0)


def _size(constraint: object, amount: float) -> str:
    if isinstance(constraint, Place):
        return f"{1000 * amount:.1f} mm"
    return f"{math.degrees(amount):.1f}°"
