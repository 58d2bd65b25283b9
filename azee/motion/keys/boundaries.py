"""Key postures at the boundaries of blocks, solved in order of time.

Where a block ends at the instant another begins, one posture may serve both, and then it does.
Two different postures cannot share an instant: a block holds on [start, end), so the instant is
the opening block's, exactly on its time, and the closing block gives way before its end, for as
long as the movement between the two needs but never for more than half its own length. The report
tells of it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

from azee.motion.curves.limb_curves import transition_s
from azee.motion.keys.posture_solver import Poser, tasks_of
from azee.motion.tasks.conflict import contradict
from azee.motion.tasks.limbs import LINKS
from azee.motion.tasks.posture import KeyPosture, Origin
from azee.motion.tasks.timed_task import Bound, BoundScore, GivingWay, limbs_asked
from azee.score.interval import Interval
from azee_solver.binding import Binding

PREPARE_S = Fraction(3, 20)
"""Head and trunk get ready for what begins within this time."""
SHORTEST_GIVING_WAY = Fraction(1, 12)


@dataclass(frozen=True, slots=True, eq=False)
class Boundaries:
    """Solved key postures in order of time, and who gave way, by rank of the requirement."""

    postures: tuple[KeyPosture, ...]
    giving_way: dict[int, GivingWay] = field(default_factory=dict)


def active(score: BoundScore, time: Fraction, giving: Mapping[int, GivingWay]) -> list[Bound]:
    """Return requirements in force at an instant, both ends included; what gave way is not."""
    given = ((b, giving.get(b.requirement.rank)) for b in score.in_force.at(time))
    return [b for b, to in given if to is None or time <= to.start]


def solve_boundaries(
    score: BoundScore, poser: Poser, binding: Binding, deferred: frozenset[Fraction]
) -> Boundaries:
    """Solve the keyframes of a time line, but for `deferred` ones, which lie inside movements."""
    postures: list[KeyPosture] = []
    giving: dict[int, GivingWay] = {}
    for keyframe in score.timeline.keyframes:
        time = keyframe.time
        bounds = active(score, time, giving)
        if not bounds or time in deferred:
            continue
        opening = [b for b in bounds if b.requirement.starts_or_runs(time)]
        closing = [b for b in bounds if not b.requirement.starts_or_runs(time)]
        posture = _prepared(time, opening, closing, score, poser)
        if posture is None:
            posture = _shared(time, opening, closing, poser, binding)
        if posture is None:
            postures += _apart(time, opening, closing, poser, giving)
        else:
            postures.append(poser.accept(posture))
    return Boundaries(tuple(postures), giving)


def _prepared(
    time: Fraction,
    opening: Sequence[Bound],
    closing: Sequence[Bound],
    score: BoundScore,
    poser: Poser,
) -> KeyPosture | None:
    """Return a posture in which head and trunk are already as blocks want them that begin soon.

    A gaze that bends the head for a tenth of a second, until a raised chin asks for the opposite,
    is met as well by eyes and neck. None if nothing begins soon on a head or trunk that is asked
    for now, if that has only just been elsewhere, or if not all can be met together.
    """
    if poser.keying.flat or closing:
        return None
    soon = score.in_force.meeting(Interval(time, time + PREPARE_S))
    asked = frozenset[str]().union(*(b.limbs for b in opening)) & {*LINKS}
    ahead = [
        b
        for b in soon
        if (start := b.requirement.interval.start) > time
        and b.limb in LINKS
        and b.limbs & asked
        and poser.rest.since(b.limb, time) >= start - time
    ]
    if not ahead:
        return None
    posture = poser.solve(time, [*opening, *ahead])
    return replace(posture, bounds=tuple(opening)) if posture.met else None


def _shared(
    time: Fraction,
    opening: Sequence[Bound],
    closing: Sequence[Bound],
    poser: Poser,
    binding: Binding,
) -> KeyPosture | None:
    """Return one posture for both sides of an instant; none if they must part."""
    starting = [b for b in opening if b.requirement.interval.start == time]
    if not closing or not starting:
        return poser.solve(time, [*opening, *closing])
    if not any(limbs_asked([a]) & limbs_asked([b]) for a in closing for b in starting):
        return poser.solve(time, [*opening, *closing])
    if contradict(closing, starting, binding):
        return None
    joint = poser.solve(time, [*opening, *closing])
    if joint.met or joint.reused or len(tasks_of(opening, time)) == len(joint.tasks):
        return joint
    return joint if poser.solve(time, opening).misses() >= joint.misses() else None


def _apart(
    time: Fraction,
    opening: Sequence[Bound],
    closing: Sequence[Bound],
    poser: Poser,
    giving: dict[int, GivingWay],
) -> list[KeyPosture]:
    """Solve the opening side on time and give the closing side an earlier end key."""
    starting = [b for b in opening if b.requirement.interval.start == time]
    contested = limbs_asked(starting)
    yielding = {b.requirement.path for b in closing if limbs_asked([b]) & contested}
    leaving = [b for b in closing if b.requirement.path in yielding]
    staying = [b for b in closing if b.requirement.path not in yielding]
    after = poser.solve(time, [*opening, *staying])
    going_on = [b for b in [*opening, *staying] if b.requirement.interval.start < time]
    before = poser.solve(time, [*leaving, *going_on], Origin.EARLY_END, leaving)
    end = time - _way(before, after, leaving, poser)
    since = poser.last.time if poser.last is not None else None
    out: list[KeyPosture] = []
    if since is None or end > since:
        out.append(poser.accept(poser.solve(end, [*leaving, *going_on], Origin.EARLY_END, leaving)))
    else:
        end = since
    to = starting[0].requirement.path
    giving.update({b.requirement.rank: GivingWay(end, to) for b in leaving})
    out.append(poser.accept(after))
    return out


def _way(before: KeyPosture, after: KeyPosture, leaving: Sequence[Bound], poser: Poser) -> Fraction:
    """How long before its end a block gives way."""
    longest = max(
        transition_s(before.coordinates[members], after.coordinates[members])
        for members in (poser.limbs.members[limb] for limb in limbs_asked(leaving))
    )
    wanted = max(SHORTEST_GIVING_WAY, Fraction(round(longest * 1000), 1000))
    return min(wanted, min(b.requirement.interval.duration for b in leaving) / 2)
