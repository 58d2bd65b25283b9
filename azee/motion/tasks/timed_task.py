"""A time line bound to a rig: which part of the body every requirement speaks of and reads."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from azee.clip.spline import minimum_jerk
from azee.motion.tasks.flatten import Timeline
from azee.motion.tasks.limbs import Limbs, channel_of_constraint, limb_of_constraint
from azee.motion.tasks.requirement import Requirement
from azee.motion.tasks.spans import Spans
from azee_rig.rig import Rig
from azee_solver.anatomy import anatomy
from azee_solver.binding import Binding
from azee_solver.constraint import Constraint, LookAt, Morph, Place, Rotate, Transpath, Trill
from azee_solver.footprint import footprint
from azee_solver.geometry import Between, Moving, Point, VTranslate, WorldPoint
from azee_solver.task import Task


@dataclass(frozen=True, slots=True, eq=False)
class Bound:
    """A requirement on one rig.

    limb: the one that it speaks of. moves: coordinates with which the bone or site that it speaks
    of is moved. reads: the others that its residual depends on. limbs, read_limbs: the limbs of
    either. dynamic: its target moves while it lasts.
    """

    requirement: Requirement
    limb: str
    moves: frozenset[int]
    reads: frozenset[int]
    limbs: frozenset[str]
    read_limbs: frozenset[str]
    dynamic: bool

    @property
    def constraint(self) -> Constraint:
        """What is required."""
        return self.requirement.constraint

    def task(self, time: Fraction) -> Task:
        """Return what it asks of a posture at an instant."""
        r = self.requirement
        phase = self.phase(time) if self.dynamic else 0.0
        return Task(r.constraint, r.path, r.interval.start, r.rank, phase)

    def phase(self, time: Fraction) -> float:
        """How far a dynamic point has got, 0 to 1: minimum jerk over its own block."""
        motion = self.requirement.motion
        if motion.duration == 0:
            return 1.0
        return float(minimum_jerk(float((time - motion.start) / motion.duration)))


def limbs_asked(bounds: Iterable[Bound]) -> frozenset[str]:
    """Limbs that requirements constrain or read."""
    return frozenset().union(*(b.limbs | b.read_limbs for b in bounds))


@dataclass(frozen=True, eq=False)
class BoundScore:
    """All that a score requires of one body, by who serves it.

    postures: what the solver meets. paths: transpaths. trills, faces: laid on the curves.
    """

    timeline: Timeline
    postures: tuple[Bound, ...]
    paths: tuple[Bound, ...]
    trills: tuple[Bound, ...]
    faces: tuple[Bound, ...]

    @cached_property
    def in_force(self) -> Spans[Bound]:
        """The requirements that the solver meets, by when they hold."""
        return Spans((b.requirement.interval, b) for b in self.postures)

    @cached_property
    def sharing(self) -> dict[Bound, tuple[Bound, ...]]:
        """For every skeletal morph, those of the same hand meanwhile, itself too.

        They add up where they move the same coordinates, and thumbs give way to fingers.
        """
        morphs = [b for b in self.postures if isinstance(b.constraint, Morph)]
        spans = Spans((b.requirement.interval, b) for b in morphs)
        near = ((b, spans.meeting(b.requirement.interval)) for b in morphs)
        return {
            b: tuple(o for o in others if o.moves & b.moves or o.limb[-2:] == b.limb[-2:])
            for b, others in near
        }

    @cached_property
    def paths_at(self) -> Spans[Bound]:
        """The transpaths, by when they hold."""
        return Spans((b.requirement.interval, b) for b in self.paths)

    @property
    def moving(self) -> tuple[Bound, ...]:
        """What asks something of the body, the face left out."""
        return (*self.postures, *self.paths, *self.trills)

    @cached_property
    def all(self) -> tuple[Bound, ...]:
        """Everything, in the order of the score."""
        return tuple(sorted((*self.moving, *self.faces), key=lambda b: b.requirement.rank))


def bind(timeline: Timeline, rig: Rig, binding: Binding, limbs: Limbs) -> BoundScore:
    """Bind every requirement; of a hold's, keep those in its channels.

    Raises: BindingError: the rig lacks a bone, a site or a morph.
    """
    kinds: dict[type, list[Bound]] = {Transpath: [], Trill: [], Morph: [], object: []}
    for requirement in timeline.requirements:
        constraint = requirement.constraint
        binding.check(constraint)
        channels = requirement.held_channels
        if channels is not None and channel_of_constraint(constraint, binding) not in channels:
            continue
        bound = _bind(requirement, rig, binding, limbs)
        facial = isinstance(constraint, Morph) and not binding.is_skeletal(constraint)
        served = isinstance(constraint, Transpath | Trill) or facial
        kinds[type(constraint) if served else object].append(bound)
    return BoundScore(
        timeline,
        postures=tuple(kinds[object]),
        paths=tuple(kinds[Transpath]),
        trills=tuple(kinds[Trill]),
        faces=tuple(kinds[Morph]),
    )


def _bind(requirement: Requirement, rig: Rig, binding: Binding, limbs: Limbs) -> Bound:
    constraint = requirement.constraint
    limb = limb_of_constraint(constraint, binding)
    body = anatomy(rig.chain, rig.coordinates)
    moves, affected = frozenset[int](), frozenset[int]()
    if not isinstance(constraint, Morph):
        print_ = footprint(_alike(constraint), binding)
        moves, affected = print_.movers(body), print_.affected(body)
        if limb in _HEAD:
            moves &= frozenset(v for n in _HEAD for v in limbs.members.get(n, ()))
    elif binding.is_skeletal(constraint):
        moves = affected = frozenset(binding.preset(constraint))
    reads = affected - moves
    dynamic = isinstance(constraint, Place | LookAt) and has_moving(constraint.point)
    return Bound(
        requirement,
        limb,
        moves,
        reads,
        limbs.touching(moves),
        limbs.touching(reads),
        dynamic,
    )


_HEAD = ("head", "eyes")
"""Limbs that turn on the trunk without laying claim to it: a gaze does not keep a body bent."""


def _alike(constraint: Constraint) -> Constraint:
    """Return a constraint that a posture can meet and that reads the same of the body."""
    match constraint:
        case Transpath(site=site, path=path):
            return Place(site, Moving(path, WorldPoint(0, 0, 0), WorldPoint(0, 0, 0)))
        case Trill(bone=bone, axis=axis):
            return Rotate(bone, axis, 0.0)
        case _:
            return constraint


def has_moving(point: Point) -> bool:
    """Whether a point moves on a path of its own."""
    match point:
        case Moving():
            return True
        case VTranslate(point=inner):
            return has_moving(inner)
        case Between(start=start, end=end):
            return has_moving(start) or has_moving(end)
        case _:
            return False


@dataclass(frozen=True, slots=True, eq=False)
class GivingWay:
    """A block whose constraints stop holding before its end, because another starts there."""

    start: Fraction
    to: tuple[str, ...]
