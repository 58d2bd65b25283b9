"""Solving one moment after another: what a solve starts from, and which limbs it keys."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from azee.motion.curves.limb_curves import transition_s
from azee.motion.keys.neutral import CARRIERS, Rest
from azee.motion.keys.standing import solve_beside
from azee.motion.keys.transpath import Travel, passing_limbs
from azee.motion.tasks.keying import Keying, fresh
from azee.motion.tasks.limbs import TRUNK, Limbs
from azee.motion.tasks.posture import KeyPosture, Origin, PostureSolver
from azee.motion.tasks.spans import Spans
from azee.motion.tasks.timed_task import Bound, limbs_asked
from azee_rig.coordinates import Coordinates
from azee_solver.task import Task

Array = NDArray[np.float64]


def tasks_of(
    bounds: Iterable[Bound], time: Fraction, paths: Iterable[Task] = ()
) -> tuple[Task, ...]:
    """Return what requirements ask at an instant, each distinct constraint once.

    A block that holds another repeats its constraints: twice the same morph must not add up.
    """
    asked: dict[tuple[object, float], Task] = {}
    for task in (*(b.task(time) for b in bounds), *paths):
        asked.setdefault((task.constraint, task.phase), task)
    return tuple(asked.values())


@dataclass(slots=True)
class Poser:
    """The state of a body as keyframes are solved in order of time.

    What constraints leave open is drawn to idle, never to the posture before: a trunk that gave
    way a little at each of many keyframes would end at its limits. The search starts from the
    posture before only in limbs that one block goes on constraining, so that no sign inherits an
    odd elbow from the last.

    travels: by when they are. rest: which limbs have gone to rest meanwhile.
    """

    coordinates: Coordinates
    keying: Keying
    solver: PostureSolver
    travels: Spans[Travel]
    rest: Rest
    current: Array = field(init=False)
    last: KeyPosture | None = field(init=False, default=None)
    _let_go: dict[str, Fraction] = field(init=False, default_factory=dict)
    """Since when a trunk, head or eyes that others still constrain are free of what ended."""

    @property
    def limbs(self) -> Limbs:
        """The limbs of the body."""
        return self.keying.limbs

    def __post_init__(self) -> None:
        self.current = np.array(self.coordinates.idle)

    def solve(
        self,
        time: Fraction,
        bounds: Sequence[Bound],
        origin: Origin = Origin.BOUNDARY,
        leaving: Sequence[Bound] = (),
    ) -> KeyPosture:
        """Solve an instant, or take over the last posture where it asks for nothing new.

        Args: leaving: what ends here though its block does not.
        """
        tasks = tasks_of(bounds, time)
        begun = [*fresh(bounds, time), *leaving]
        asked = limbs_asked(bounds)
        passing = passing_limbs(time, bounds, self.travels.at(time))
        last = self.last
        current = self.rest.applied(self.current, last, time)
        relieved = self._relieved(time, bounds)
        if last is not None and not relieved and _nothing_new(tasks, last):
            same = asked | (last.limbs if set(tasks) == set(last.tasks) else frozenset())
            indices = [v for limb in same for v in self.limbs.members[limb]]
            if np.array_equal(current[indices], last.coordinates[indices]):
                left = {d.constraint for d in tasks}
                kept = tuple(c for c in last.report.constraints if c.task.constraint in left)
                still = np.zeros(len(current))
                keyed = self.keying.at_boundary(bounds, begun, still, still)
                keyed |= same & last.limbs - asked
                return KeyPosture(
                    time, current, keyed, passing, tuple(bounds), tasks,
                    replace(last.report, constraints=kept), origin, reused=True,
                )  # fmt: skip
        going_on = self._going_on(time, bounds)
        constrained = frozenset[str]().union(*(b.limbs for b in bounds)) | self._carried(bounds)
        reference = np.where(self._of(constrained), self.coordinates.idle, current)
        start = np.where(self._of(going_on - relieved), current, reference)
        beside = None
        if last is not None and not relieved:
            beside = solve_beside(
                last, bounds, tasks, current, start, reference,
                limbs=self.limbs, solver=self.solver,
            )  # fmt: skip
        if beside is None:
            report = self.solver(tasks, start=start, reference=reference)
        else:
            tasks, report = beside
        keyed = self.keying.at_boundary(
            bounds, begun, report.coordinates - current, report.coordinates - reference
        )
        passing |= self.keying.following(bounds, begun)
        return KeyPosture(
            time, report.coordinates, keyed, passing, tuple(bounds), tasks, report, origin
        )

    def accept(self, posture: KeyPosture) -> KeyPosture:
        """Go on from a posture."""
        relieved = (
            frozenset[str]() if posture.reused else self._relieved(posture.time, posture.bounds)
        )
        let_go = self._let_go_by(posture.bounds)
        self._let_go = {limb: since for limb, since in let_go.items() if limb not in relieved}
        self.current = np.array(posture.coordinates)
        self.rest.note(posture)
        self.last = posture
        return posture

    def _let_go_by(self, bounds: Sequence[Bound]) -> dict[str, Fraction]:
        """Account for the carriers that a block has let go while others go on constraining them."""
        out = dict(self._let_go)
        before = self.last.bounds if self.last is not None else ()
        begun = frozenset[str]().union(*(b.limbs for b in bounds if b not in before))
        constrained = frozenset[str]().union(*(b.limbs for b in bounds))
        staying = {b.constraint for b in bounds}
        for limb in CARRIERS:
            if limb in begun or limb not in constrained:
                out.pop(limb, None)
                continue
            for b in before:
                if limb in b.limbs and b.constraint not in staying:
                    end = b.requirement.interval.end
                    out[limb] = max(end, out.get(limb, end))
        return out

    def _relieved(self, time: Fraction, bounds: Sequence[Bound]) -> frozenset[str]:
        """Carriers that have had the time to come back from what has let them go.

        So a head that a glance has bent comes up again though its chin is still raised.
        """
        idle = self.coordinates.idle
        return frozenset(
            limb
            for limb, since in self._let_go_by(bounds).items()
            for members in (self.limbs.members[limb],)
            if time - since >= transition_s(self.current[members], idle[members])
        )

    def _of(self, limbs: frozenset[str]) -> NDArray[np.bool_]:
        """(V,) which coordinates belong to some limbs."""
        chosen: NDArray[np.bool_] = np.array([n in limbs for n in self.limbs.names])
        return chosen[self.limbs.of_coordinate]

    def _carried(self, bounds: Iterable[Bound]) -> frozenset[str]:
        """Return the trunk, which carries every limb, and the head that is levelled over it."""
        return frozenset((TRUNK, "head")) if any(b.limbs for b in bounds) else frozenset()

    def _going_on(self, time: Fraction, bounds: Iterable[Bound]) -> frozenset[str]:
        """Limbs that one block constrains both at the last posture and now."""
        if self.last is None:
            return frozenset()
        since = self.last.time
        going = (b for b in bounds if b.requirement.interval.start <= since < time)
        return frozenset().union(*(b.limbs for b in going))


def _nothing_new(tasks: Iterable[Task], last: KeyPosture) -> bool:
    """Whether an earlier answer serves: the same tasks, or fewer of which none could do better.

    What was missed then may be met now only if a task that is gone claimed the same limbs.
    """
    before = {(d.constraint, d.phase) for d in last.tasks}
    now = {(d.constraint, d.phase) for d in tasks}
    if not now <= before:
        return False
    left = {constraint for constraint, _ in now}
    missed = {c.task.constraint for c in last.report.constraints if not c.met} & left
    freed = frozenset[str]().union(*(b.limbs for b in last.bounds if b.constraint not in left))
    return not any(freed & (b.limbs | b.read_limbs) for b in last.bounds if b.constraint in missed)
