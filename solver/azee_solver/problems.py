"""From constraints to ordered inverse-kinematics problems (Nunnari, Filhol and Heloir 2018, §4.2).

A problem has a chain of bones, at most one placement of a site on its last bone, and orientations
of bones on the chain. Each placement makes one. An orientation joins the first placement whose
chain holds its bone; the others form problems together as far as their bones lie on one chain,
except that one whose target reads a bone which another of them moves stands alone and later: its
target is a look-up once that bone is where it belongs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from fractions import Fraction
from functools import cached_property

from azee_solver import describe
from azee_solver.anatomy import Anatomy, Part, part_of
from azee_solver.binding import Binding
from azee_solver.constraint import Look, LookAt, Orient, Place, Rotate
from azee_solver.demand import Demand
from azee_solver.footprint import Footprint, footprint
from azee_solver.ordering import ordered


class Reach(IntEnum):
    """How much of the body a problem may move; each includes those before it."""

    OWN = 0
    """What it speaks of: an arm for a hand's placement, a finger for a finger's direction."""
    FINGERS = 1
    """Also the fingers that carry its site, and the head that carries an eye."""
    TRUNK = 2
    """Also the trunk; problems that it depends on are solved together with it."""
    ALL = 3
    """Everything that changes its residuals, on the target's side too, and an idle arm that would
    be in the way of a leaning trunk."""


@dataclass(frozen=True, slots=True)
class Problem:
    """One of the ordered problems of a keyframe.

    demands: indices of its demands, by their order. chain: AZee bones, from the root. steps:
    coordinates that it may move, per `Reach`. reads: coordinates that change its residuals.
    """

    name: str
    demands: tuple[int, ...]
    chain: tuple[str, ...]
    steps: tuple[frozenset[int], ...]
    reads: frozenset[int]
    order: tuple[Fraction, int, int]

    def needs(self, other: Problem, mine: Reach = Reach.OWN, its: Reach = Reach.OWN) -> bool:
        """Whether the other moves something that this one only reads."""
        return bool(other.steps[its] & (self.reads - self.steps[mine]))


@dataclass(slots=True)
class _Draft:
    """A problem being gathered: its demands, and the node at the end of its chain."""

    demands: list[int]
    end: int
    kind: type


_ROLES = {Place: Place, Orient: Orient | Rotate, Look: Look | LookAt}


class ProblemBuilder:
    """Builds the problems of one set of demands."""

    def __init__(self, demands: Sequence[Demand], binding: Binding, anatomy: Anatomy) -> None:
        self.demands, self.binding, self.anatomy = demands, binding, anatomy
        self.footprints: dict[int, Footprint] = {}
        self._movers: dict[int, frozenset[int]] = {}
        self._affected: dict[int, frozenset[int]] = {}
        for i, demand in enumerate(demands):
            if isinstance(demand.constraint, Place | Orient | Look | LookAt | Rotate):
                self.footprints[i] = found = footprint(demand.constraint, binding)
                self._movers[i] = found.movers(anatomy)
                self._affected[i] = found.affected(anatomy)

    @cached_property
    def _claimed(self) -> frozenset[int]:
        """Finger coordinates that orientations and morphs speak of, and what follows those."""
        return self._asked | self._followers(self._asked)

    @cached_property
    def _asked(self) -> frozenset[int]:
        """Finger coordinates that orientations and morphs speak of."""
        constraints = [demand.constraint for demand in self.demands]
        presets = frozenset(self.binding.presets(constraints))
        turned = [i for i in self.footprints if self._role(i) is Orient]
        return presets.union(*(self._movers[i] for i in turned))

    @cached_property
    def _idle_arms(self) -> frozenset[int]:
        """Arm coordinates that no constraint can use: they yield when the trunk leans."""
        used = frozenset().union(*self._affected.values())
        presets = self.binding.presets(demand.constraint for demand in self.demands)
        return self.anatomy.of(Part.ARM) - used - frozenset(presets)

    def build(self) -> tuple[Problem, ...]:
        """Return the problems in the order in which they would be solved one by one."""
        drafts: list[_Draft] = []
        for i in sorted(self.footprints, key=lambda i: (self._kind(i), self.demands[i].order)):
            self._gather(i, drafts)
        problems = [self._finish(draft) for draft in drafts]
        needs = [
            {j for j, other in enumerate(problems) if j != i and problem.needs(other)}
            for i, problem in enumerate(problems)
        ]
        keys = [problem.order for problem in problems]
        entries = ordered(len(problems), lambda i: needs[i], keys)
        return tuple(problems[i] for entry in entries for i in entry)

    def _kind(self, i: int) -> int:
        return 0 if isinstance(self.demands[i].constraint, Place) else 1

    def _gather(self, i: int, drafts: list[_Draft]) -> None:
        kind = self._role(i)
        node = max(self.footprints[i].own)
        for draft in drafts:
            if kind is not Place and self._fits(i, kind, node, draft):
                draft.demands.append(i)
                draft.end = max(node, draft.end)
                return
        drafts.append(_Draft([i], node, kind))

    def _role(self, i: int) -> type:
        constraint = self.demands[i].constraint
        return next(k for k in (Place, Orient, Look) if isinstance(constraint, _ROLES[k]))

    def _fits(self, i: int, kind: type, node: int, draft: _Draft) -> bool:
        if kind is Look or draft.kind is Look:
            return kind is draft.kind
        if draft.kind is Place:
            return self.anatomy.is_above(node, draft.end)
        above, below = sorted((node, draft.end))
        return self.anatomy.is_above(above, below) and not any(
            self._reads(i, j) or self._reads(j, i) for j in draft.demands
        )

    def _reads(self, i: int, j: int) -> bool:
        """Whether the target of demand i hangs on a bone that demand j moves."""
        moved = self._own(j)
        return any(self.anatomy.above(node) & moved for node in self.footprints[i].target)

    # What may move ----------------------------------------------------------------------------

    def _part(self, i: int) -> Part:
        constraint = self.demands[i].constraint
        if isinstance(constraint, Place):
            return part_of(self.binding.site(constraint.site).bone)
        assert isinstance(constraint, Orient | Rotate)
        return part_of(constraint.bone.name)

    def _own(self, i: int) -> frozenset[int]:
        return self._step(i, Reach.OWN)

    def _step(self, i: int, reach: Reach) -> frozenset[int]:
        constraint = self.demands[i].constraint
        movers, affected = self._movers[i], self._affected[i]
        if isinstance(constraint, Look | LookAt):
            return movers & self.anatomy.of(Part.EYES, Part.HEAD)
        if reach is Reach.ALL:
            step = affected | self._step(i, Reach.TRUNK)
            step |= self._followers(step)
            return step | self._idle_arms if step & self.anatomy.of(Part.TRUNK) else step
        part = self._part(i)
        parts = {part}
        if part is Part.HAND:
            parts.add(Part.ARM)
            if isinstance(constraint, Place) and reach < Reach.FINGERS:
                parts.remove(Part.HAND)
        if part is Part.EYES and reach >= Reach.FINGERS:
            parts.add(Part.HEAD)
        if reach >= Reach.TRUNK:
            parts.add(Part.TRUNK)
        free = movers & self.anatomy.of(*parts) or affected
        free |= self._followers(free)
        if reach >= Reach.FINGERS and isinstance(constraint, Place):
            free |= self._idle_fingers(i)
        return free

    def _followers(self, free: frozenset[int]) -> frozenset[int]:
        """Last finger joints that follow one that moves, where nothing else fixes them."""
        led = {v for v, leader in self.anatomy.followers.items() if leader in free}
        return frozenset(led) - self._asked

    def _idle_fingers(self, i: int) -> frozenset[int]:
        """Fingers that nothing asks anything of, on hands that a placement brings near things.

        They do not change its residual, but they can get out of the way.
        """
        found = self.footprints[i]
        fingers = self.anatomy.of(Part.HAND) - self._claimed
        near = frozenset(v for node in found.own | found.target for v in self.anatomy.carried(node))
        return fingers & near

    def _finish(self, draft: _Draft) -> Problem:
        indices = sorted(draft.demands, key=lambda i: (self._kind(i), self.demands[i].order))
        constraints = [self.demands[i].constraint for i in indices]
        bones = [
            (nodes.node, name)
            for name, nodes in self.binding.rig.bones.items()
            if self.anatomy.is_above(nodes.node, draft.end)
        ]
        return Problem(
            describe.problem(constraints, self.binding.dominant),
            tuple(indices),
            tuple(name for _, name in sorted(bones)),
            tuple(frozenset().union(*(self._step(i, reach) for i in indices)) for reach in Reach),
            frozenset().union(*(self._affected[i] for i in indices)),
            min(self.demands[i].order for i in indices),
        )
