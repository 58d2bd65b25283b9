"""From constraints to ordered inverse-kinematics problems (Nunnari, Filhol and Heloir 2018, §4.2).

A problem has a chain of bones, at most one placement of a site on its last bone, and orientations
of bones on the chain. Each placement makes one. An orientation joins the first placement whose
chain holds its bone; the others form problems together as far as their bones lie on one chain,
except that one whose target depends on a bone that another of them moves is a problem of its own,
and a later one: its target is known once that bone has been placed.

None of that depends on where targets are, only on the bones that they depend on. So it is worked
out once for all moments that ask the same of the same bones, as those of a movement do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

from azee_solver.anatomy import Anatomy, Part
from azee_solver.binding import Binding
from azee_solver.constraint import Constraint, Look, LookAt, Orient, Place, Rotate
from azee_solver.footprint import Footprint, footprint, part_constrained
from azee_solver.ordering import ordered
from azee_solver.task import Task

if TYPE_CHECKING:
    from azee_rig.rig import Rig


class Reach(IntEnum):
    """How much of the body a problem may move; each includes those before it."""

    OWN = 0
    """The part that its constraints name: an arm for a hand's placement, a finger for a finger's
    direction."""
    FINGERS = 1
    """Also the fingers that carry its site, and the head that carries an eye."""
    TRUNK = 2
    """Also the trunk; problems that it depends on are solved together with it."""
    ALL = 3
    """Everything that changes its residuals, on the target's side too, and an idle arm that would
    be in the way of a leaning trunk."""


@dataclass(frozen=True, slots=True, eq=False)
class Problem:
    """One of the ordered problems of a keyframe.

    tasks: indices of its tasks, by their order. chain: AZee bones, from the root. steps:
    coordinates that it may move, per `Reach`. reads: coordinates that change its residuals.
    order: place of the first of its tasks among all.
    """

    tasks: tuple[int, ...]
    chain: tuple[str, ...]
    steps: tuple[frozenset[int], ...]
    reads: frozenset[int]
    order: int

    def needs(self, other: Problem, mine: Reach = Reach.OWN, its: Reach = Reach.OWN) -> bool:
        """Whether the other moves something that this one only reads."""
        return bool(other.steps[its] & (self.reads - self.steps[mine]))


@dataclass(frozen=True, slots=True)
class _Asked:
    """What a task asks of a body, wherever its target is.

    role: Place, Orient or Look. part: to which the bone or site that it moves belongs; none for
    a gaze. order: its place among all tasks, by their order.
    """

    index: int
    role: type
    part: Part | None
    footprint: Footprint
    order: int

    @property
    def rank(self) -> tuple[bool, int]:
        """Sorting key: placements first."""
        return self.role is not Place, self.order


class ProblemBuilder:
    """Builds the problems of one set of tasks.

    footprints: by the index of each task that a posture can meet, but morphs.
    """

    def __init__(self, tasks: Sequence[Task], binding: Binding, anatomy: Anatomy) -> None:
        self.binding, self.anatomy = binding, anatomy
        asked = [task.constraint for task in tasks]
        self._presets = frozenset(binding.presets(asked)) - frozenset(binding.yielding(asked))
        self._asked = tuple(
            _Asked(i, *_asks(task.constraint, binding), order)
            for i, (task, order) in enumerate(zip(tasks, _places(tasks), strict=True))
            if isinstance(task.constraint, Place | Orient | Look | LookAt | Rotate)
        )
        self.footprints: dict[int, Footprint] = {a.index: a.footprint for a in self._asked}

    def build(self) -> tuple[Problem, ...]:
        """Return the problems in the order in which they would be solved one by one."""
        return _built(self.binding.rig, self.anatomy, self._asked, self._presets)


def _places(tasks: Sequence[Task]) -> list[int]:
    """Place of each task among all by their order; the same where nothing tells them apart."""
    orders = [task.order for task in tasks]
    keys: list[tuple[Any, ...]] = list(orders)
    if all(start == orders[0][0] for start, _, _ in orders):
        keys = [order[1:] for order in orders]  # exact fractions are slow to sort
    place = {key: n for n, key in enumerate(sorted(set(keys)))}
    return [place[key] for key in keys]


@lru_cache(maxsize=4096)
def _asks(constraint: Constraint, binding: Binding) -> tuple[type, Part | None, Footprint]:
    """Find what a constraint asks of a body; the same ones come again from key to key."""
    part = part_constrained(constraint, binding)
    return _role(constraint), part, footprint(constraint, binding)


def _role(constraint: Constraint) -> type:
    roles = {Rotate: Orient, LookAt: Look}
    return roles.get(type(constraint), type(constraint))


@lru_cache(maxsize=256)
def _built(
    rig: Rig, anatomy: Anatomy, asked: tuple[_Asked, ...], presets: frozenset[int]
) -> tuple[Problem, ...]:
    return _Builder(rig, anatomy, asked, presets).build()


@dataclass(slots=True)
class _Draft:
    """A problem being gathered: its tasks, and the node at the end of its chain."""

    tasks: list[int]
    end: int
    role: type


class _Builder:
    def __init__(
        self, rig: Rig, anatomy: Anatomy, asked: Sequence[_Asked], presets: frozenset[int]
    ) -> None:
        self.rig, self.anatomy, self.presets = rig, anatomy, presets
        self.asked = {a.index: a for a in asked}
        self._movers = {a.index: a.footprint.movers(anatomy) for a in asked}
        self._affected = {a.index: a.footprint.affected(anatomy) for a in asked}

    @cached_property
    def _claimed(self) -> frozenset[int]:
        """Finger coordinates that orientations and morphs turn, and what follows those."""
        return self._turned | self._followers(self._turned)

    @cached_property
    def _turned(self) -> frozenset[int]:
        """Finger coordinates that orientations and morphs turn."""
        turned = [i for i, a in self.asked.items() if a.role is Orient]
        return self.presets.union(*(self._movers[i] for i in turned))

    @cached_property
    def _idle_arms(self) -> frozenset[int]:
        """Arm coordinates that no constraint can use: they yield when the trunk leans."""
        used = frozenset().union(*self._affected.values())
        return self.anatomy.of(Part.ARM) - used - self.presets

    def build(self) -> tuple[Problem, ...]:
        drafts: list[_Draft] = []
        for asked in sorted(self.asked.values(), key=lambda a: a.rank):
            self._gather(asked, drafts)
        problems = [self._finish(draft) for draft in drafts]
        needs = [
            {j for j, other in enumerate(problems) if j != i and problem.needs(other)}
            for i, problem in enumerate(problems)
        ]
        keys = [problem.order for problem in problems]
        entries = ordered(len(problems), lambda i: needs[i], keys)
        return tuple(problems[i] for entry in entries for i in entry)

    def _gather(self, asked: _Asked, drafts: list[_Draft]) -> None:
        node = max(asked.footprint.own)
        for draft in drafts:
            if asked.role is not Place and self._fits(asked, node, draft):
                draft.tasks.append(asked.index)
                draft.end = max(node, draft.end)
                return
        drafts.append(_Draft([asked.index], node, asked.role))

    def _fits(self, asked: _Asked, node: int, draft: _Draft) -> bool:
        if asked.role is Look or draft.role is Look:
            return asked.role is draft.role
        if draft.role is Place:
            return self.anatomy.is_above(node, draft.end)
        above, below = sorted((node, draft.end))
        i = asked.index
        return self.anatomy.is_above(above, below) and not any(
            self._reads(i, j) or self._reads(j, i) for j in draft.tasks
        )

    def _reads(self, i: int, j: int) -> bool:
        """Whether the target of task i depends on a bone that task j moves."""
        moved = self._step(j, Reach.OWN)
        return any(self.anatomy.above(node) & moved for node in self.asked[i].footprint.target)

    # What may move ----------------------------------------------------------------------------

    def _step(self, i: int, reach: Reach) -> frozenset[int]:
        asked, movers, affected = self.asked[i], self._movers[i], self._affected[i]
        if asked.part is None:
            return movers & self.anatomy.of(Part.EYES, Part.HEAD)
        if reach is Reach.ALL:
            step = affected | self._step(i, Reach.TRUNK)
            step |= self._followers(step)
            return step | self._idle_arms if step & self.anatomy.of(Part.TRUNK) else step
        parts = {asked.part}
        if asked.part is Part.HAND:
            parts.add(Part.ARM)
            if asked.role is Place and reach < Reach.FINGERS:
                parts.remove(Part.HAND)
        if asked.part is Part.EYES and reach >= Reach.FINGERS:
            parts.add(Part.HEAD)
        if reach >= Reach.TRUNK:
            parts.add(Part.TRUNK)
        free = movers & self.anatomy.of(*parts) or affected
        free |= self._followers(free)
        if reach >= Reach.FINGERS and asked.role is Place:
            free |= self._idle_fingers(i)
        return free

    def _followers(self, free: frozenset[int]) -> frozenset[int]:
        """Last finger joints that follow one that moves, where nothing else fixes them."""
        led = {v for v, leader in self.anatomy.followers.items() if leader in free}
        return frozenset(led) - self._turned

    def _idle_fingers(self, i: int) -> frozenset[int]:
        """Fingers that nothing asks anything of, on hands that a placement brings near things.

        They do not change its residual, but they can get out of the way.
        """
        found = self.asked[i].footprint
        fingers = self.anatomy.of(Part.HAND) - self._claimed
        near = frozenset(v for node in found.own | found.target for v in self.anatomy.carried(node))
        return fingers & near

    def _finish(self, draft: _Draft) -> Problem:
        asked = sorted((self.asked[i] for i in draft.tasks), key=lambda a: a.rank)
        indices = tuple(a.index for a in asked)
        bones = [
            (nodes.node, name)
            for name, nodes in self.rig.bones.items()
            if self.anatomy.is_above(nodes.node, draft.end)
        ]
        return Problem(
            indices,
            tuple(name for _, name in sorted(bones)),
            tuple(frozenset().union(*(self._step(i, reach) for i in indices)) for reach in Reach),
            frozenset().union(*(self._affected[i] for i in indices)),
            min(a.order for a in asked),
        )
