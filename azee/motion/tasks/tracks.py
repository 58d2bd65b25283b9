"""Which block keys which coordinates, and when: what a picture of a movement draws."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from azee.motion.tasks.keying import Keying
from azee.motion.tasks.limbs import LINKS
from azee.motion.tasks.posture import KeyPosture
from azee.motion.tasks.timed_task import Bound, BoundScore
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
    score: BoundScore, postures: Sequence[KeyPosture], keying: Keying, coordinates: Coordinates
) -> tuple[Track, ...]:
    """Return what every block keys, in the order of the score; in flat mode, one for the whole.

    Blocks that need the same hand or arm both have its track. Trunk and head, which link the
    others, are only the track of their owner: whoever speaks of them, else of the blocks that need
    them the one that began first. Faces have no coordinates and no track; trills have one without
    keys.
    """
    if keying.flat:
        keys = tuple(sorted({float(p.time) for p in postures}))
        return (Track((), tuple(coordinates.names), keys, 0.0, float(score.timeline.duration)),)
    keyed: dict[Bound, dict[str, list[float]]] = {b: {} for b in score.moving}
    for posture in postures:
        for limb in posture.limbs:
            users = [b for b in posture.bounds if limb in b.limbs]
            for b in _owners(limb, users):
                keyed[b].setdefault(limb, []).append(float(posture.time))
    found: dict[tuple[str, ...], list[Bound]] = {}
    for bound in sorted(keyed, key=lambda b: b.requirement.rank):
        found.setdefault(bound.requirement.path, []).append(bound)
    out = []
    for path, bounds in found.items():
        moved: set[int] = set()
        times: set[float] = set()
        for b in bounds:
            limbs = keyed[b]
            own = {b.limb} if isinstance(b.constraint, Trill) else limbs.keys()
            moved |= {
                v for limb in own for v in keying.limbs.members[limb].tolist() if v in b.moves
            }
            times.update(t for keys in limbs.values() for t in keys)
        first = min(b.requirement.interval.start for b in bounds)
        last = max(b.requirement.interval.end for b in bounds)
        names = tuple(coordinates.names[v] for v in sorted(moved))
        if names:
            out.append(Track(path, names, tuple(sorted(times)), float(first), float(last)))
    return tuple(out)


def _owners(limb: str, users: Sequence[Bound]) -> Sequence[Bound]:
    """Return whose track a limb's key is."""
    speaking = [b for b in users if b.limb == limb]
    if limb not in LINKS or speaking:
        return speaking if limb in LINKS else users
    order = sorted(users, key=lambda b: (b.requirement.interval.start, b.requirement.rank))
    return order[:1]
