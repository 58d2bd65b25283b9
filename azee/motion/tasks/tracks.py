"""Tracks: which block keys which coordinates, and when. Pictures of a movement draw them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from azee.motion.tasks.key_posture import KeyPosture
from azee.motion.tasks.key_selection import KeySelection
from azee.motion.tasks.limbs import CARRIERS
from azee.motion.tasks.recordings import RecordedBlock
from azee.motion.tasks.schedule import TaskSchedule
from azee.motion.tasks.timed_task import TimedTask
from azee_rig.coordinates import Coordinates
from azee_solver.constraint import Trill


@dataclass(frozen=True, slots=True)
class Track:
    """Coordinates that one block keys, on the score's time line.

    path: names of the blocks that lead to it, outermost first; empty for the whole score.
    coordinates: their names, in the rig's order. keys_s: times of their keys, increasing.
    start_s, end_s: when the block holds them.
    """

    path: tuple[str, ...]
    coordinates: tuple[str, ...]
    keys_s: tuple[float, ...]
    start_s: float
    end_s: float


def tracks(
    schedule: TaskSchedule,
    postures: Sequence[KeyPosture],
    selection: KeySelection,
    coordinates: Coordinates,
) -> tuple[Track, ...]:
    """Return what every block keys, in the order of the score; in flat mode, one for the whole.

    Blocks that move the same hand or arm both have it in their track. Trunk and head, which carry
    others, are in the track of one block only: the one that names them, else the first to begin of
    those that move them. Accents have keys where they begin and end. Faces have no coordinates and
    no track; trills have one without keys. Recordings have keys where their bodies
    begin and end.
    """
    if selection.flat:
        keys = tuple(sorted({float(p.time) for p in postures}))
        return (Track((), tuple(coordinates.names), keys, 0.0, float(schedule.timeline.duration)),)
    key_times: dict[TimedTask, dict[str, list[float]]] = {t: {} for t in schedule.body_tasks}
    for posture in postures:
        for limb in posture.limbs:
            movers = [t for t in posture.timed_tasks if limb in t.limbs]
            for task in _owners(limb, movers):
                key_times[task].setdefault(limb, []).append(float(posture.time))
    for task in schedule.accents:
        ends = dict.fromkeys((float(task.interval.start), float(task.interval.end)))
        key_times[task][task.limb] = [*ends]
    blocks: dict[tuple[str, ...], list[TimedTask]] = {}
    for task in sorted(key_times, key=lambda t: t.rank):
        blocks.setdefault(task.path, []).append(task)
    out = []
    for path, tasks in blocks.items():
        moved: set[int] = set()
        times: set[float] = set()
        for task in tasks:
            limbs = key_times[task]
            own = {task.limb} if isinstance(task.constraint, Trill) else limbs.keys()
            moved |= {
                v for limb in own for v in selection.limbs.members[limb].tolist() if v in task.moves
            }
            times.update(t for keys in limbs.values() for t in keys)
        first = min(t.interval.start for t in tasks)
        last = max(t.interval.end for t in tasks)
        names = tuple(coordinates.names[v] for v in sorted(moved))
        if names:
            out.append(Track(path, names, tuple(sorted(times)), float(first), float(last)))
    return (*out, *(_recorded(block) for block in schedule.recorded if block.limbs))


def _recorded(block: RecordedBlock) -> Track:
    """Return what a recording moves, from the start of its attack to the end of its decay."""
    names = tuple(block.coordinates.names[v] for v in block.members.tolist())
    first, last = float(block.interval.start), float(block.interval.end)
    return Track(block.path, names, (block.start_s, block.end_s), first, last)


def _owners(limb: str, movers: Sequence[TimedTask]) -> Sequence[TimedTask]:
    """Return the tasks that have a key of a limb in their track."""
    if limb not in CARRIERS:
        return movers
    naming = [t for t in movers if t.limb == limb]
    return naming or sorted(movers, key=lambda t: (t.interval.start, t.rank))[:1]
