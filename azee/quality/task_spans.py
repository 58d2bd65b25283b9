"""What a score asks of which part of the body, and when: what measures of likeness compare with.

A task *asks for movement* if its site travels on a path, its target moves or its bone trills; also
if its target lies on a part of the body of which such a task speaks, as a hand does that is to
touch a hand on its way. Movement that a task asks for is *lexical*; all other movement of an arm,
from sign to sign and from posture to posture of a sign, is *transitional*, and AZee leaves it to
whoever performs the score.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from azee.motion.tasks.limbs import CARRIERS
from azee.motion.tasks.recordings import RecordedBlock
from azee.motion.tasks.timed_task import EarlyEnd, TimedTask
from azee_solver.constraint import Constraint, Transpath, Trill

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class TaskSpan:
    """One constraint of one block while it is held, on the score's time line.

    Or what a recording has a limb do: that has no constraint, and asks for movement.

    limb: the one that the constraint names. limbs: all that can move what it names. reads: those
    that its target lies on. moves: whether the task itself asks for movement.
    """

    path: tuple[str, ...]
    constraint: Constraint | None
    limb: str
    limbs: frozenset[str]
    reads: frozenset[str]
    moves: bool
    start_s: float
    end_s: float

    def concerns(self, limb: str) -> bool:
        """Whether it asks something of a limb; of trunk and head only if it names them."""
        return limb == self.limb or (limb in self.limbs and limb not in CARRIERS)

    def during(self, times_s: Array) -> Mask:
        """Return at which times it is held, both ends included."""
        return np.asarray((self.start_s <= times_s) & (times_s <= self.end_s))


def task_spans(
    tasks: Iterable[TimedTask],
    early_ends: Mapping[int, EarlyEnd],
    recorded: Iterable[RecordedBlock] = (),
) -> tuple[TaskSpan, ...]:
    """Return what a score asks of one body, in the order of the score, then what is played.

    Args: early_ends: by the rank of tasks that stop to hold before their blocks end.
    """
    out = []
    for task in tasks:
        early = early_ends.get(task.rank)
        out.append(
            TaskSpan(
                path=task.path,
                constraint=task.constraint,
                limb=task.limb,
                limbs=task.limbs | {task.limb},
                reads=task.read_limbs,
                moves=task.dynamic or isinstance(task.constraint, Transpath | Trill),
                start_s=float(task.interval.start),
                end_s=float(task.interval.end if early is None else early.time),
            )
        )
    for block in recorded:
        for limb in sorted(block.limbs):
            own = frozenset((limb,))
            out.append(
                TaskSpan(block.path, None, limb, own, frozenset(), True, block.start_s, block.end_s)
            )
    return tuple(out)


def asked(spans: Iterable[TaskSpan], limb: str, times_s: Array) -> Mask:
    """Return at which times something is asked of a limb, (T,)."""
    return _any((s.during(times_s) for s in spans if s.concerns(limb)), times_s)


def asked_to_move(spans: Sequence[TaskSpan], limb: str, times_s: Array) -> Mask:
    """Return at which times movement is asked of a limb, itself or by what its tasks aim at."""
    movers = [s for s in spans if s.moves]
    found = [s.during(times_s) for s in movers if s.concerns(limb)]
    for span in spans:
        if not span.moves and span.concerns(limb):
            aimed_at = [m for m in movers if any(m.concerns(read) for read in span.reads)]
            found += [span.during(times_s) & m.during(times_s) for m in aimed_at]
    return _any(found, times_s)


def _any(masks: Iterable[Mask], times_s: Array) -> Mask:
    out = np.zeros(len(times_s), dtype=bool)
    for mask in masks:
        out |= mask
    return out
