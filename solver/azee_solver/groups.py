"""Problems that must be solved together, and the order of the groups.

If two problems move the same coordinate, solving one after the other spoils the first: a forearm's
direction, solved after its elbow's place, missed by up to 13°.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

from azee_solver.anatomy import Anatomy, Part
from azee_solver.ordering import ordered
from azee_solver.problems import Problem, Reach


@dataclass(frozen=True, slots=True)
class Group:
    """Problems that are solved together.

    problems: indices. reach: of each. free: coordinates that move. reads: coordinates that change
    its residuals.
    """

    problems: tuple[int, ...]
    reach: tuple[Reach, ...]
    free: frozenset[int]
    reads: frozenset[int]


def grouped(
    problems: Sequence[Problem],
    reach: Sequence[Reach],
    anatomy: Anatomy,
    fixed: frozenset[int] = frozenset(),
) -> list[Group]:
    """Return the groups in the order in which they are to be solved.

    Where dependencies leave a choice, trunk and head come first, then hands before arms, so that
    the arms keep the hands, as they will be, out of the body. Where the trunk moves, a head that
    no constraint turns is free too, so that it can stay level. Problems that read and move nothing
    but digits are one group: each is small, and laying out a problem takes longer than solving it.
    If a problem may move the trunk, an arm whose target depends on what it moves is solved with it:
    the trunk must suit both.

    Args: fixed: coordinates that nothing may move.
    """
    return list(_grouped(tuple(problems), tuple(reach), anatomy, fixed))


@lru_cache(maxsize=512)
def _grouped(
    problems: tuple[Problem, ...],
    reach: tuple[Reach, ...],
    anatomy: Anatomy,
    fixed: frozenset[int],
) -> tuple[Group, ...]:
    free = [problem.steps[r] - fixed for problem, r in zip(problems, reach, strict=True)]
    trunk, head, arms = (anatomy.of(part) for part in (Part.TRUNK, Part.HEAD, Part.ARM))
    own = frozenset().union(*(problem.steps[Reach.OWN] for problem in problems))
    if not own & head or all(_is_gaze(p, anatomy) for p in problems if p.steps[0] & head):
        free = [f | (head - fixed) if f & trunk else f for f in free]

    digits = anatomy.of(Part.HAND)
    only_digits = [
        problem.reads <= digits and f <= digits for problem, f in zip(problems, free, strict=True)
    ]
    together = _Partition(len(problems))
    for i in range(len(problems)):
        if only_digits[i]:
            together.join(only_digits.index(True), i)
        for j in range(i):
            if free[i] & free[j]:
                together.join(i, j)
        if reach[i] >= Reach.TRUNK:
            for j, other in enumerate(problems):
                depends = bool(free[j] & arms) and other.needs(problems[i])
                if (free[j] & (problems[i].reads - free[i]) and other.steps[0] - fixed) or depends:
                    together.join(i, j)
    sets = together.sets()
    moved = [frozenset().union(*(free[i] for i in s)) for s in sets]
    read = [frozenset().union(*(problems[i].reads for i in s)) for s in sets]
    keys = [
        (anatomy.outwards(m), min(problems[i].order for i in members))
        for members, m in zip(sets, moved, strict=True)
    ]
    entries = ordered(
        len(sets),
        lambda g: {h for h in range(len(sets)) if moved[h] & (read[g] - moved[g])},
        keys,
    )
    out = []
    for entry in entries:
        members = sorted((i for g in entry for i in sets[g]), key=lambda i: problems[i].order)
        out.append(
            Group(
                tuple(members),
                tuple(reach[i] for i in members),
                frozenset().union(*(moved[g] for g in entry)),
                frozenset().union(*(read[g] for g in entry)),
            )
        )
    return tuple(out)


def _is_gaze(problem: Problem, anatomy: Anatomy) -> bool:
    return bool(problem.steps[Reach.OWN] & anatomy.of(Part.EYES))


class _Partition:
    """Disjoint sets of 0 … count − 1."""

    def __init__(self, count: int) -> None:
        self._root = list(range(count))

    def _find(self, i: int) -> int:
        while self._root[i] != i:
            i = self._root[i]
        return i

    def join(self, i: int, j: int) -> None:
        """Put two in one set."""
        a, b = sorted((self._find(i), self._find(j)))
        self._root[b] = a

    def sets(self) -> list[list[int]]:
        """Return the sets, each sorted, in order of their least member."""
        out: dict[int, list[int]] = {}
        for i in range(len(self._root)):
            out.setdefault(self._find(i), []).append(i)
        return list(out.values())
