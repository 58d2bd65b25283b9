"""Comfort is a price: what the last millimetres and degrees may cost the rest of the body.

The exact answer of a group may lean the trunk by 27° for the last six millimetres. Where it leans
by more than 5°, or drives a coordinate of trunk, head or arms to its limit, `eased` solves the same
group again inside narrower limits, and takes the first answer that costs no constraint more than
the tolerance of Nunnari, Filhol and Heloir 2018 (1 cm, 5°):

1. the trunk within 5° of neutral, all else short of its limits; where that parts what touches, once
   more with as much overlap as the exact answer may have;
2. the same, and orientations are given up: one alone does not lean the trunk;
3. the trunk leans as little as will do, all else short of its limits, if that spares 5°;
4. the trunk as it is, all else short of its limits, and what touches goes on touching.

Where the exact answer does not lean the trunk, only 4 is tried. A task that the exact answer misses
may be missed by that tolerance more, and by as much as the exact answer lies in the body.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from azee_solver.anatomy import Part
from azee_solver.body import Body
from azee_solver.constraint import Constraint, Orient, Place
from azee_solver.footprint import part_constrained
from azee_solver.geometry import Between, Bone, Point, SitePoint
from azee_solver.group_search import solve_group
from azee_solver.groups import Group
from azee_solver.moment import Moment
from azee_solver.outcome import Price
from azee_solver.priorities import GIVEN_UP_PULL
from azee_solver.result import Result, excess
from azee_solver.tolerance import PAPER

Array = NDArray[np.float64]
Limits = tuple[Array, Array]

STILL_RAD = math.radians(5.0)
"""How far the trunk may turn without a price."""
NEAR_LIMIT_RAD = math.radians(1.0)
"""A coordinate nearer to its limit than this is at it."""
MARGIN_RAD = math.radians(1.5)
"""How far short of their limits coordinates stay where that will do."""
MOST_GIVEN_UP_RAD = math.radians(30.0)
"""An orientation farther off would be another one: rather than that, the trunk leans. But for a
bone that cannot be turned as is asked anyway, the trunk does not lean."""
HALVINGS = 4
"""Of the range between a trunk that is still and the exact answer's: the lean is the least to
within a sixteenth."""
STIFF_OVERLAP = 16.0
"""Factor of the overlap's weight: a constraint is eased before a hand presses into the body."""

_STILL_EACH_RAD = 0.98 * STILL_RAD / (2.0 * math.sqrt(3.0))
"""Of each of the six coordinates of two joints: together these turn the trunk by at most 5°."""

_ROUNDING = 1e-9


def eased(
    moment: Moment, group: Group, q: Array, unsettled: frozenset[int], exact: Result
) -> Result:
    """Return the most comfortable result of a group in which each constraint is met or eased.

    Args: q: (V,) the posture so far. unsettled: see `solve_group`. exact: the group's result
        without regard to comfort, which is returned where nothing better is found.
    """
    if not exact.ratios:
        return exact
    search = _ComfortSearch(moment, group, q, unsettled, exact)
    return search.result()


class _ComfortSearch:
    """Attempts on one group: narrower limits, and what may be given up."""

    def __init__(
        self, moment: Moment, group: Group, q: Array, unsettled: frozenset[int], exact: Result
    ) -> None:
        self.moment, self.q, self.unsettled, self.exact = moment, q, unsettled, exact
        self.tasks = moment.tasks_of(group)
        self.free = group.free - self._shaped()
        anatomy, coordinates = moment.body.anatomy, moment.body.rig.coordinates
        self.bodily = sorted(anatomy.of(Part.TRUNK, Part.HEAD, Part.ARM) & self.free)
        self.trunk = [] if self._trunk_is_asked() else sorted(anatomy.of(Part.TRUNK) & self.free)
        self.idle: Array = coordinates.idle
        self.limits: Limits = coordinates.lower, coordinates.upper
        self.price = self._price(exact.q)

    @cached_property
    def body(self) -> Body:
        """The body of the attempts; its limits are those of the last one."""
        return self._body(STIFF_OVERLAP)

    @cached_property
    def touching_body(self) -> Body:
        """The same, but overlap is no dearer than in the exact answer, which touches."""
        return self._body(1.0)

    def _body(self, overlap: float) -> Body:
        """Return a body whose overlap costs so many times as much."""
        options = self.moment.options
        stiff = replace(
            options,
            far=False,
            overlap=overlap * options.overlap,
            patience=max(options.patience, 1),
        )
        return replace(self.moment.body, options=stiff, evaluations=0)

    def _trunk_is_asked(self) -> bool:
        """Whether the text itself turns the trunk: then its lean has no price."""
        binding = self.moment.body.evaluator.binding
        tasks = self.tasks.values()
        return any(part_constrained(t.constraint, binding) is Part.TRUNK for t in tasks)

    def _shaped(self) -> frozenset[int]:
        """Coordinates of handshapes that the exact answer keeps: comfort is not theirs to give."""
        tolerance, presets = self.moment.options.tolerance.angle_rad, self.moment.body.presets
        return frozenset(v for v, a in presets.items() if abs(self.exact.q[v] - a) <= tolerance)

    def result(self) -> Result:
        """Return what `eased` returns."""
        if not self.price:
            return self.exact
        found, hard = None, frozenset[int]()
        if self.price.trunk_rad > STILL_RAD:
            found, hard = self._with_trunk()
        if found is None or self._lean(found.q) > max(STILL_RAD, self.price.trunk_rad - STILL_RAD):
            other, more = self._attempt()
            if other is None and any(_touches(self.tasks[i].constraint) for i in more):
                other, more = self._attempt(touch=True)
            found, hard = other or found, hard | more
        self.moment.body.evaluations += self.body.evaluations + self.touching_body.evaluations
        if found is None:
            return replace(self.exact, strain=self.price, strained_for=hard)
        strain = self._price(found.q)
        return replace(
            found,
            eased=dict.fromkeys(found.missed() - self.exact.missed(), self.price),
            strain=strain,
            strained_for=hard if strain else frozenset(),
        )

    def _with_trunk(self) -> tuple[Result | None, frozenset[int]]:
        """Try the answers 1 to 3 above.

        Returns: also the tasks that are not even eased while the trunk is still.
        """
        found, hard = self._attempt(0.0)
        if found is not None:
            if self._has_let_go(found):
                other, _ = self._attempt(0.0, touch=True)
                found = other or found
            return found, hard
        orientations = frozenset(
            i for i, t in self.tasks.items() if isinstance(t.constraint, Orient)
        )
        if orientations:
            found, _ = self._attempt(0.0, orientations)
            if found is not None:
                return found, hard
        least, most = 0.0, 1.0
        for _ in range(HALVINGS):
            middle = 0.5 * (least + most)
            other, _ = self._attempt(middle)
            if other is None:
                least = middle
            else:
                most, found = middle, other
        return found, hard

    def _attempt(
        self, lean: float = 1.0, given_up: frozenset[int] = frozenset(), *, touch: bool = False
    ) -> tuple[Result | None, frozenset[int]]:
        """Solve the group inside limits; none if that costs too much. Also the tasks that it costs.

        Args: lean: see `_inside`. given_up: tasks that may be missed. touch: what touches in the
            exact answer goes on touching, with as much overlap as may be, not as little as can be.
        """
        exact, options = self.exact, self.moment.options
        factors = {i: GIVEN_UP_PULL / exact.ratios[i] for i in exact.missed() - exact.undefined}
        factors |= {i: GIVEN_UP_PULL / self._slack(i) for i in given_up}
        body = self.touching_body if touch else self.body
        body.limits = self._inside(lean)
        found = solve_group(
            body,
            self.tasks,
            self.q,
            self.free,
            unsettled=self.unsettled,
            factors=factors,
            first=[self.moment.start, exact.q],
            only_first=not options.far,
            further=False,
        )
        allowed_m = max(exact.overlap_m, options.overlap_m) + options.tolerance.length_m
        touch = touch or lean == 1.0
        costs = frozenset(
            i for i in found.ratios if not found.ratios[i] <= self._allowed(i, given_up, touch)
        )
        return None if costs or found.overlap_m > allowed_m else found, costs

    def _allowed(self, i: int, given_up: frozenset[int], touch: bool) -> float:
        """How far off a task may be, in tolerances."""
        exact, constraint = self.exact.ratios[i], self.tasks[i].constraint
        if i in given_up:
            if self._bone(i) in map(self._bone, self.exact.missed()):
                return math.inf
            return MOST_GIVEN_UP_RAD / self.moment.options.tolerance.of(constraint)
        if not exact <= 1.0:
            return exact + excess(self.exact, self.moment.options) + self._slack(i)
        return 1.0 if touch and _touches(constraint) else self._slack(i)

    def _has_let_go(self, found: Result) -> bool:
        """Whether something no longer touches that does in the exact answer."""
        return any(
            _touches(task.constraint) and self.exact.ratios[i] <= 1.0 < found.ratios[i]
            for i, task in self.tasks.items()
        )

    def _bone(self, i: int) -> Bone | None:
        """Return the bone that an orientation is of."""
        constraint = self.tasks[i].constraint
        return constraint.bone if isinstance(constraint, Orient) else None

    def _slack(self, i: int) -> float:
        """Tolerance of the source paper, in ours."""
        constraint = self.tasks[i].constraint
        return PAPER.of(constraint) / self.moment.options.tolerance.of(constraint)

    def _inside(self, lean: float = 1.0) -> Limits:
        """Limits of the body, short of what joints can do.

        Args: lean: how much of the exact answer's lean the trunk may have beyond 5°, from 0 to 1.
        """
        lower, upper = (np.array(limit) for limit in self.limits)
        lower[self.bodily] += MARGIN_RAD
        upper[self.bodily] -= MARGIN_RAD
        if lean < 1.0 and self.trunk:
            low, high = self._free_lean()
            there = self.exact.q[self.trunk]
            low += lean * np.minimum(there - low, 0.0)
            high += lean * np.maximum(there - high, 0.0)
            lower[self.trunk] = np.maximum(lower[self.trunk], low)
            upper[self.trunk] = np.minimum(upper[self.trunk], high)
        return lower, upper

    def _free_lean(self) -> tuple[Array, Array]:
        """Return between which limits the trunk leans for free: to the reference, or by 5°."""
        idle, there = (p[self.trunk] for p in (self.idle, self.moment.reference))
        return np.minimum(idle - _STILL_EACH_RAD, there), np.maximum(idle + _STILL_EACH_RAD, there)

    def _price(self, q: Array) -> Price:
        """Return what a posture costs."""
        names, (lower, upper) = self.moment.body.rig.coordinates.names, self.limits
        stops = np.minimum(q - lower, upper - q)[self.bodily] < NEAR_LIMIT_RAD
        stopped = tuple(names[v] for v, s in zip(self.bodily, stops.tolist(), strict=True) if s)
        lean = self._lean(q)
        return Price(lean if lean > STILL_RAD else 0.0, stopped)

    def _lean(self, q: Array) -> float:
        """Angle of the upper trunk from neutral, radians; 0 where it leans for free."""
        if not self.trunk:
            return 0.0
        low, high = self._free_lean()
        there = q[self.trunk]
        if np.all(there >= low - _ROUNDING) and np.all(there <= high + _ROUNDING):
            return 0.0
        body = self.moment.body
        node = int(np.flatnonzero(body.anatomy.owns[:, self.trunk].any(axis=1))[-1])
        a, b = (body.frames(p).rotations[node] for p in (q, self.idle))
        return 2.0 * math.asin(min(float(np.linalg.norm(a - b)) / math.sqrt(8.0), 1.0))


def _touches(constraint: Constraint) -> bool:
    """Whether a site of the body is placed on another, or between two."""
    return (
        isinstance(constraint, Place)
        and (isinstance(constraint.point, SitePoint) or _is_on_skin(constraint.point))
        and not constraint.distance_m
    )


def _is_on_skin(point: Point) -> bool:
    return isinstance(point, Between) and point.on_skin
