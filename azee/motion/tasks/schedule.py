"""The schedule of a body: all timed tasks of a score, sorted by what carries them out."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

from azee.motion.tasks.flatten import Timeline
from azee.motion.tasks.interval_index import IntervalIndex
from azee.motion.tasks.limbs import CARRIERS, Limbs, channels_of_constraint, limb_of_constraint
from azee.motion.tasks.recordings import RecordedBlock, recorded_blocks
from azee.motion.tasks.timed_task import TimedTask
from azee_rig.rig import Rig
from azee_solver.anatomy import anatomy
from azee_solver.binding import Binding
from azee_solver.constraint import (
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.footprint import footprint
from azee_solver.geometry import (
    Between,
    Cross,
    Dir,
    FreePoint,
    JointPoint,
    Moving,
    NamedPoint,
    Nrm,
    Opp,
    Out,
    Point,
    Rotated,
    Scale,
    SitePoint,
    Swing,
    Towards,
    Unit,
    VDiff,
    Vec,
    Vector,
    VSum,
    VTranslate,
    Was,
    WorldPoint,
    depends_on,
)


@dataclass(frozen=True, eq=False)
class TaskSchedule:
    """All that a score requires of one body.

    timeline: the flattened score. posture_tasks: what key postures meet. transpaths: paths of
    sites between placements. accents: rotations that add to the posture beneath them. trills,
    facial_morphs: what is laid on the finished movement. recorded: signs that are played.
    """

    timeline: Timeline
    posture_tasks: tuple[TimedTask, ...]
    transpaths: tuple[TimedTask, ...]
    accents: tuple[TimedTask, ...]
    trills: tuple[TimedTask, ...]
    facial_morphs: tuple[TimedTask, ...]
    recorded: tuple[RecordedBlock, ...] = ()

    @cached_property
    def in_force(self) -> IntervalIndex[TimedTask]:
        """The tasks of postures, by when they hold."""
        return IntervalIndex((t.interval, t) for t in self.posture_tasks)

    @cached_property
    def transpaths_in_force(self) -> IntervalIndex[TimedTask]:
        """The transpaths, by when they hold."""
        return IntervalIndex((t.interval, t) for t in self.transpaths)

    @cached_property
    def morphs_of_same_hand(self) -> dict[TimedTask, tuple[TimedTask, ...]]:
        """For every skeletal morph, those of the same hand that overlap it in time, itself too.

        Angles of morphs add up where they move the same coordinates, and the solver adapts a
        thumb to the fingers around it: the target of one depends on the others.
        """
        morphs = [t for t in self.posture_tasks if isinstance(t.constraint, Morph)]
        index = IntervalIndex((t.interval, t) for t in morphs)
        near = ((t, index.overlapping(t.interval)) for t in morphs)
        return {
            t: tuple(o for o in others if o.moves & t.moves or o.limb[-2:] == t.limb[-2:])
            for t, others in near
        }

    @property
    def body_tasks(self) -> tuple[TimedTask, ...]:
        """What moves the skeleton: everything but the face."""
        return (*self.posture_tasks, *self.transpaths, *self.accents, *self.trills)

    @cached_property
    def all(self) -> tuple[TimedTask, ...]:
        """Everything, in the order of the score."""
        return tuple(sorted((*self.body_tasks, *self.facial_morphs), key=lambda t: t.rank))


def bind(
    timeline: Timeline, rig: Rig, binding: Binding, limbs: Limbs, *, layered: bool = True
) -> TaskSchedule:
    """Bind every requirement to a body; of a hold's requirements, keep those in its channels.

    A body does what it can: what names a bone, a site or a morph that it lacks is left out.

    Args: layered: whether rotations of trunk, neck, head and shoulders are accents, which add up.
        Otherwise they are tasks of postures like others.
    """
    kinds: dict[type, list[TimedTask]] = {
        Transpath: [], Rotate: [], Trill: [], Morph: [], object: []
    }  # fmt: skip
    for requirement in timeline.requirements:
        constraint = requirement.constraint
        if not binding.has(constraint):
            continue
        if requirement.held_channels:
            kept = channels_of_constraint(constraint, binding)
            if any(kept.isdisjoint(channels) for channels in requirement.held_channels):
                continue
        on_body = _read(constraint, binding, limbs)
        task = TimedTask(
            requirement, on_body.limb, on_body.moves, on_body.reads, on_body.limbs,
            on_body.read_limbs, on_body.dynamic,
        )  # fmt: skip
        facial = isinstance(constraint, Morph) and not binding.is_skeletal(constraint)
        accent = layered and is_accent(task)
        outside_postures = isinstance(constraint, Transpath | Trill) or facial or accent
        kinds[type(constraint) if outside_postures else object].append(task)
    named = (*kinds[object], *kinds[Transpath], *kinds[Trill])
    return TaskSchedule(
        timeline,
        posture_tasks=tuple(kinds[object]),
        transpaths=tuple(kinds[Transpath]),
        accents=tuple(kinds[Rotate]),
        trills=tuple(kinds[Trill]),
        facial_morphs=tuple(kinds[Morph]),
        recorded=recorded_blocks(timeline.recordings, named, rig, limbs, binding.dominant),
    )


def is_accent(task: TimedTask) -> bool:
    """Whether a task turns trunk, neck, head or a shoulder by an angle of its own.

    A rotation whose axis is read off the body (a site, another bone) is none.
    """
    constraint = task.constraint
    if not isinstance(constraint, Rotate) or depends_on(constraint.axis):
        return False
    return task.limb in CARRIERS or constraint.bone.name == "clav"


@dataclass(frozen=True, slots=True)
class _Reading:
    """What a constraint reads and moves on a body: the fields of `TimedTask` of these names."""

    limb: str
    moves: frozenset[int]
    reads: frozenset[int]
    limbs: frozenset[str]
    read_limbs: frozenset[str]
    dynamic: bool


@lru_cache(maxsize=4096)
def _read(constraint: Constraint, binding: Binding, limbs: Limbs) -> _Reading:
    """Return what a constraint reads and moves; it comes again in every round and text."""
    limb = limb_of_constraint(constraint, binding)
    body = anatomy(binding.rig.chain, binding.rig.coordinates)
    moves, affected = frozenset[int](), frozenset[int]()
    if not isinstance(constraint, Morph):
        reading = footprint(_posture_equivalent(constraint), binding)
        moves, affected = reading.movers(body), reading.affected(body)
        if limb in _HEAD_AND_EYES:
            moves &= frozenset(v for n in _HEAD_AND_EYES for v in limbs.members.get(n, ()))
    elif binding.is_skeletal(constraint):
        moves = affected = frozenset(binding.preset(constraint))
    reads = affected - moves
    match constraint:
        case Place(point=point) | LookAt(point=point):
            dynamic = has_moving(point)
        case Orient(vector=vector) | Look(vector=vector):
            dynamic = has_swing(vector)
        case Morph() | Trill() | Rotate() | Transpath():
            dynamic = False
    return _Reading(limb, moves, reads, limbs.touching(moves), limbs.touching(reads), dynamic)


_HEAD_AND_EYES = ("head", "eyes")
"""Limbs whose tasks never move the trunk, only read it: a gaze does not keep a body bent."""


def _posture_equivalent(constraint: Constraint) -> Constraint:
    """Return a constraint on one posture that depends on the same parts of the body."""
    match constraint:
        case Transpath(site=site, path=path):
            return Place(site, Moving(path, WorldPoint(0, 0, 0), WorldPoint(0, 0, 0)))
        case Trill(bone=bone, axis=axis):
            return Rotate(bone, axis, 0.0)
        case Place() | Orient() | Look() | LookAt() | Rotate() | Morph():
            return constraint


def has_moving(point: Point) -> bool:
    """Whether a point moves on a path of its own."""
    match point:
        case Moving():
            return True
        case VTranslate(inner, vector):
            return has_moving(inner) or has_swing(vector)
        case Between(start=start, end=end):
            return has_moving(start) or has_moving(end)
        case FreePoint() | NamedPoint() | SitePoint() | JointPoint() | WorldPoint() | Was():
            return False


def has_swing(vector: Vector) -> bool:
    """Whether a direction swings while its block lasts."""
    match vector:
        case Swing():
            return True
        case Opp(inner) | Unit(inner) | Scale(inner):
            return has_swing(inner)
        case VSum(inners):
            return any(map(has_swing, inners))
        case VDiff(a, b) | Cross(a, b) | Rotated(a, b):
            return has_swing(a) or has_swing(b)
        case Towards(start, end):
            return has_moving(start) or has_moving(end)
        case Vec() | Out() | Dir() | Nrm():
            return False
