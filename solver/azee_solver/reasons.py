"""Why a constraint is not met, found by asking smaller questions of the same solver.

Alone, without the body in its way, with everything free that can help: if it misses even so, it is
out of reach, or a coordinate's limit stops it. If only the body stops it, that is the reason. Else
other constraints do: the first that excludes it as a pair, or, if none does, those whose removal
lets it be met.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from azee_solver.body import Body
from azee_solver.constraint import Morph, Place
from azee_solver.footprint import Footprint
from azee_solver.group_search import solve_group
from azee_solver.notation import constraint_text, subject_text
from azee_solver.result import Result
from azee_solver.task import Task

Array = NDArray[np.float64]

AT_LIMIT_RAD = 1e-6
"""A coordinate nearer to its limit than this has run into it."""


class Diagnosis:
    """Reasons for the constraints of one moment, given the posture that was found.

    spent_s: how long they have taken to find so far.
    """

    def __init__(
        self,
        body: Body,
        tasks: Sequence[Task],
        footprints: Mapping[int, Footprint],
        q: Array,
    ) -> None:
        self.tasks, self.footprints, self.q = tasks, footprints, q
        self.body = body
        self.spent_s = 0.0

    @cached_property
    def firm(self) -> Body:
        """The body with all its costs, drawn to the posture that was found."""
        return replace(self.body, reference=self.q)

    @cached_property
    def relaxed(self) -> Body:
        """The body without collision, handshapes and joint-limit cost."""
        return self.body.relaxed(self.q)

    def reason(self, i: int, undefined: bool) -> str:
        """Return why task i is not met, in one phrase."""
        began = time.perf_counter()
        found = self._reason(i, undefined)
        self.spent_s += time.perf_counter() - began
        return found

    def _reason(self, i: int, undefined: bool) -> str:
        constraint = self.tasks[i].constraint
        if undefined:
            return "its direction is undefined: a vector in it has no length"
        if isinstance(constraint, Morph):
            return self._morph(i, constraint)
        held = self._free([i], everything=True) & self.firm.options.fixed
        if held and not self._free([i]):
            return "the coordinates that could meet it are held fixed"
        alone = self._alone(self.relaxed, [i])
        if not alone.missed():
            return self._others(i)
        if held and not self._alone(self.relaxed, [i], everything=True).missed():
            bones = sorted({self.firm.anatomy.names[v].split(".")[0] for v in held})
            return f"needs {_sentence(bones)}, held fixed"
        left = alone.ratios[i] * self.firm.options.tolerance.of(constraint)
        if self._beyond_reach(i) > self.firm.options.tolerance.of(constraint):
            return f"out of reach by {_size(constraint, left)}"
        stopped = self._limits(i, alone)
        if stopped:
            return f"limit of {_sentence(stopped)}"
        return f"out of reach by {_size(constraint, left)}"

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

    def _limits(self, i: int, alone: Result) -> list[str]:
        """Coordinates at their limits that would let the constraint be met if they went further."""
        limits = self.firm.rig.coordinates
        stopped = [
            v
            for v in sorted(self._free([i]))
            if min(alone.q[v] - limits.lower[v], limits.upper[v] - alone.q[v]) < AT_LIMIT_RAD
        ]
        found = []
        for v in stopped:
            past = self._past_limit(i, v, alone)
            if past is not None:
                found.append((abs(past), limits.names[v]))
        return [f"{name} by {math.degrees(past):.1f}°" for past, name in sorted(found)[:1]]

    def _past_limit(self, i: int, v: int, alone: Result) -> float | None:
        """How far beyond its limit one coordinate would have to go, if that is all it takes."""
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
        return max(limits.lower[v] - angle, angle - limits.upper[v], 0.0) or None

    def _morph(self, i: int, morph: Morph) -> str:
        limits, binding = self.firm.rig.coordinates, self.firm.evaluator.binding
        asked = binding.presets(task.constraint for task in self.tasks)
        for v in binding.preset(morph):
            if v in self.firm.options.fixed:
                return f"{limits.names[v]} is held fixed"
            past = max(limits.lower[v] - asked[v], asked[v] - limits.upper[v])
            if past > self.firm.options.tolerance.angle_rad:
                return f"limit of {limits.names[v]} by {math.degrees(past):.1f}°"
        moved = frozenset(binding.preset(morph))
        others = [
            k for k, found in self.footprints.items() if found.affected(self.firm.anatomy) & moved
        ]
        return f"conflicts with {self._names(others)}" if others else "held back by its neighbours"

    # Others -----------------------------------------------------------------------------------

    def _others(self, i: int) -> str:
        alone = self._alone(replace(self.firm, presets={}), [i])
        if alone.missed():
            return f"the body is in the way: {self._touching(alone)}"
        rivals = self._rivals(i)
        for k in rivals:
            if self._alone(self.relaxed, [i, k]).missed():
                return f"conflicts with {self._names([k])}"
        everything = [i, *rivals]
        if self._alone(self.relaxed, everything).missed():
            guilty = [
                k
                for k in rivals
                if not self._alone(self.relaxed, [j for j in everything if j != k]).missed()
            ]
            return f"conflicts with {self._names(guilty or rivals)} together"
        held = self._fixed_by(i)
        if held:
            return f"needs {_sentence(held)}"
        return "the body is in the way of meeting all at once"

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
                    out.append(f"coordinates that `{subject_text(constraint)}` fixes")
        return out

    def _touching(self, result: Result) -> str:
        overlaps = self.firm.obstacles.overlaps(result.q)
        if not overlaps:
            return "touching"
        return f"{overlaps[0].first} against {overlaps[0].second}"

    def _names(self, indices: Iterable[int]) -> str:
        return _sentence([f"`{constraint_text(self.tasks[k].constraint)}`" for k in indices])


def _sentence(parts: Sequence[str]) -> str:
    """Join parts as `a`, `a and b`, `a, b and c`."""
    if len(parts) < 2:
        return "".join(parts)
    return f"{', '.join(parts[:-1])} and {parts[-1]}"


def _size(constraint: object, amount: float) -> str:
    if isinstance(constraint, Place):
        return f"{1000 * amount:.1f} mm"
    return f"{math.degrees(amount):.1f}°"
