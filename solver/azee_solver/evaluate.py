"""Symbolic geometry and constraints as numbers on given frames of a body, one posture or many.

This is the measure: it shares nothing with the kernels that optimise, so that a report made with
it checks them. Lengths that a text gives are metres of a reference signer and grow with the arms
of the body that plays. A direction that its operands do not define is NaN, never an exception.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from azee_rig.chain import DIR, NRM, Chain, Frames
from azee_solver import path as paths
from azee_solver.binding import EYES, Binding, BindingError
from azee_solver.constraint import (
    BoneAxis,
    Constraint,
    Look,
    LookAt,
    Morph,
    Orient,
    Place,
    Relation,
    Rotate,
    Transpath,
    Trill,
)
from azee_solver.geometry import (
    Arc,
    Around,
    Between,
    Bone,
    Circle,
    Cross,
    Dir,
    FreePoint,
    JointPoint,
    Moving,
    NamedPoint,
    Nrm,
    Opp,
    Out,
    Path,
    Point,
    Rotated,
    Scale,
    Side,
    SigningSpace,
    Site,
    SitePoint,
    Slide,
    Straight,
    Swing,
    Through,
    Towards,
    Unit,
    VDiff,
    Vec,
    Vector,
    VSum,
    VTranslate,
    Was,
    Wave,
    WorldPoint,
    Zigzag,
    depends_on,
)
from azee_solver.sliding import skin_of

if TYPE_CHECKING:
    from azee_rig.rig import BoneNodes, Rig

Array = NDArray[np.float64]
LengthOrAngle: TypeAlias = Literal["m", "rad"]

GAZE = DIR
"""Column of an eye's frame that looks."""


@lru_cache(maxsize=8)
def evaluator(rig: Rig, dominant: Side) -> Evaluator:
    """Return the one evaluator of a rig and a dominant hand."""
    return Evaluator(rig, dominant)


class Evaluator:
    """What symbolic geometry means on one rig, for one dominant hand."""

    def __init__(self, rig: Rig, dominant: Side) -> None:
        self.rig = rig
        self.binding = Binding(rig, dominant)
        marks = rig.landmarks
        self.scale = marks.arm_m / marks.reference_arm_m
        """Metres of this body for one metre of the reference signer."""
        self._middle = np.asarray(marks.shoulder_middle, dtype=np.float64)

    # Geometry ---------------------------------------------------------------------------------

    def vector(self, expr: Vector, frames: Frames, phase: float = 0.0) -> Array:
        """Return a vector of the signer's frame, (…, 3), not made to length one.

        A dynamic one as it is at `phase`.

        Raises: BindingError: the rig lacks a bone or site.
        """
        match expr:
            case Vec(x, y, z):
                return np.array([x, y, z], dtype=np.float64)
            case Out(side):
                left = side.bound(self.binding.dominant) is Side.LEFT
                return np.array([1.0 if left else -1.0, 0.0, 0.0])
            case Dir(bone):
                return self.axis(bone, BoneAxis.DIR, frames)
            case Nrm(bone):
                return self.axis(bone, BoneAxis.NRM, frames)
            case Opp(inner):
                return -self.vector(inner, frames, phase)
            case Unit(inner):
                return paths.unit(self.vector(inner, frames, phase))
            case Scale(inner, factor):
                return factor * self.vector(inner, frames, phase)
            case VSum(inners):
                total = np.zeros(3)
                for inner in inners:
                    total = total + self.vector(inner, frames, phase)
                return total
            case VDiff(left_, right_):
                return self.vector(left_, frames, phase) - self.vector(right_, frames, phase)
            case Cross(left_, right_):
                return np.cross(
                    self.vector(left_, frames, phase), self.vector(right_, frames, phase)
                )
            case Towards(start, end):
                a, b = (self.point(p, frames, phase) for p in (start, end))
                return paths.unit(b - a)
            case Rotated(inner, axis, angle):
                spin = paths.unit(self.vector(axis, frames, phase))
                return paths.turned(self.vector(inner, frames, phase), spin, angle)
            case Swing(from_, to, beside, longer):
                if from_ is None or to is None:
                    return np.full(3, np.nan)
                first, last = self.vector(from_, frames, phase), self.vector(to, frames, phase)
                if beside is None or beside.start is None or beside.end is None:
                    return paths.swung(first, last, phase)
                one = self.vector(beside.start, frames, phase)
                other = self.vector(beside.end, frames, phase)
                return paths.turned_together(first, last, one, other, phase, longer=longer)

    def point(self, expr: Point, frames: Frames, phase: float = 0.0) -> Array:
        """Return a point in the world, (…, 3) metres; a dynamic one where it is at `phase`.

        Raises: BindingError: the rig lacks a bone or site.
        """
        match expr:
            case FreePoint(x, y, z):
                return self._middle + self.scale * np.array([x, y, z])
            case NamedPoint(place):
                return np.array(self.rig.signing_space[self.named(place)], dtype=np.float64)
            case SitePoint(site):
                return self.site(site, frames)
            case JointPoint(bone):
                node = self.binding.bone(bone).origin_node
                return np.asarray(frames.positions[..., node, :])
            case VTranslate(point, vector):
                moved = self.scale * self.vector(vector, frames, phase)
                return self.point(point, frames, phase) + moved
            case Between(start, end, fraction):
                if (found := self.binding.skin_between(expr)) is not None:
                    node, local = found
                    turned = frames.rotations[..., node, :, :] @ local
                    return np.asarray(frames.positions[..., node, :] + turned)
                return paths.straight(
                    self.point(start, frames, phase), self.point(end, frames, phase), fraction
                )
            case Moving(path, start, end):
                a, b = self.point(start, frames, phase), self.point(end, frames, phase)
                return self.path(path, a, b, phase, frames)
            case WorldPoint(x, y, z):
                return np.array([x, y, z], dtype=np.float64)
            case Was(at=place):
                return np.full(3, np.nan) if place is None else np.array(place)

    def named(self, place: SigningSpace) -> str:
        """Name in the rig's signing space; strong and weak bound to their sides."""
        right = self.binding.dominant is Side.RIGHT
        if place is SigningSpace.SSSP:
            place = SigningSpace.RSSP if right else SigningSpace.LSSP
        elif place is SigningSpace.WSSP:
            place = SigningSpace.LSSP if right else SigningSpace.RSSP
        return place.value

    def site(self, site: Site, frames: Frames) -> Array:
        """World position of a site, (…, 3). Raises BindingError."""
        return self.binding.site(site).point(frames)

    def normal(self, site: Site, frames: Frames) -> Array:
        """Outward normal of the skin at a site, (…, 3). Raises BindingError."""
        return self.binding.site(site).outward(frames)

    def axis(self, bone: Bone, axis: BoneAxis, frames: Frames) -> Array:
        """Return a bone's dir or nrm, (…, 3). Raises BindingError."""
        column = DIR if axis is BoneAxis.DIR else NRM
        return np.asarray(frames.rotations[..., self.binding.bone(bone).node, :, column])

    def path(
        self,
        path: Path,
        start: Array,
        end: Array,
        t: ArrayLike,
        frames: Frames | None = None,
    ) -> Array:
        """Return points of a path from start to end.

        Args: start, end: (…, 3), a posture each. t: a number, giving (…, 3), or (T,), giving
            (…, T, 3). frames: postures that the path reads, needed if it names bones or sites.
        """
        if frames is None:
            if depends_on(path):
                raise ValueError("this path reads the posture: give the frames")
            frames = Frames(np.empty((0, 3)), np.empty((0, 3, 3)))
        times = np.asarray(t, dtype=np.float64)
        many = times.ndim == 1
        a, b = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)

        def spread(v: Array) -> Array:
            return v[..., None, :] if many and v.ndim > 1 else v

        a, b = (a[..., None, :], b[..., None, :]) if many else (a, b)
        match path:
            case Straight():
                return paths.straight(a, b, times)
            case Arc(bulge):
                return paths.arc(a, b, self._aside(bulge, frames, spread), times)
            case Circle(axis, radius, turns, phase, ratio, last):
                spin = spread(self.vector(axis, frames))
                return paths.circle(
                    a, b, spin, self.scale * radius, turns, times, phase=phase, ratio=ratio,
                    end_radius=None if last is None else self.scale * last,
                )  # fmt: skip
            case Around(centre, axis, turns):
                middle, spin = (
                    spread(v) for v in (self.point(centre, frames), self.vector(axis, frames))
                )
                return paths.around(a, b, middle, spin, turns, times)
            case Wave(side, waves):
                return paths.wave(a, b, self._aside(side, frames, spread), waves, times)
            case Zigzag(side, corners):
                return paths.zigzag(a, b, self._aside(side, frames, spread), corners, times)
            case Slide(bone, course):
                skin = skin_of(self.rig, self.binding.bone(bone))
                free = self.path(course, start, end, t, frames)
                return skin.laid_on(free, a, b, times, frames)
            case Through(points):
                inner = [spread(self.point(p, frames)) for p in points]
                return paths.through(np.stack(np.broadcast_arrays(a, *inner, b), axis=-2), times)

    def _aside(self, vector: Vector, frames: Frames, spread: Callable[[Array], Array]) -> Array:
        """Return a vector of a path in metres of this body."""
        return spread(self.scale * self.vector(vector, frames))

    # Constraints ------------------------------------------------------------------------------

    def target(self, place: Place, frames: Frames, phase: float = 0.0) -> Array:
        """Where a placement wants its site, (…, 3); a free point's distance is not in it."""
        point = self.point(place.point, frames, phase)
        if isinstance(place.point, SitePoint) and place.distance_m:
            distance = self.scale * place.distance_m
            point = point + distance * self.normal(place.point.site, frames)
        return point

    def gaze(self, eye: Bone, frames: Frames) -> tuple[Array, Array]:
        """Centre of an eye and the direction it looks in, (…, 3) each."""
        nodes = self.binding.bone(eye)
        return (
            np.asarray(frames.positions[..., nodes.origin_node, :]),
            np.asarray(frames.rotations[..., nodes.node, :, GAZE]),
        )

    def residual(
        self,
        constraint: Constraint,
        frames: Frames,
        q: Array,
        phase: float = 0.0,
        among: Iterable[Constraint] = (),
    ) -> tuple[Array, LengthOrAngle]:
        """How far postures are from meeting a constraint: (…,) metres or radians.

        Args: q: (…, V) coordinates of the same postures. phase: see `Task`. among: all
            constraints in force at that moment, for morphs that share coordinates: they add.
        Raises: BindingError. ValueError: `constraint` is none that a posture meets: a facial
            morph, a trill or a transpath.
        """
        try:
            return self._residual(constraint, frames, q, phase, among)
        except BindingError as error:
            raise error.at(constraint.origin) from None

    def _residual(
        self,
        constraint: Constraint,
        frames: Frames,
        q: Array,
        phase: float,
        among: Iterable[Constraint],
    ) -> tuple[Array, LengthOrAngle]:
        match constraint:
            case Place(site, point, distance, within_m=within):
                gap = paths.length(self.site(site, frames) - self.target(constraint, frames, phase))
                if not isinstance(point, SitePoint):
                    gap = np.abs(gap - self.scale * distance)
                return beyond(gap, self.scale * within), "m"
            case Orient(axis, bone, relation, vector, within):
                between = angle(self.axis(bone, axis, frames), self.vector(vector, frames, phase))
                if relation is Relation.ACROSS:
                    between = np.abs(between - np.pi / 2)
                return beyond(between, within), "rad"
            case Look(vector):
                wanted = self.vector(vector, frames, phase)
                off = [angle(self.gaze(eye, frames)[1], wanted) for eye in EYES]
                return np.maximum(*off), "rad"
            case LookAt(point):
                aim = self.point(point, frames, phase)
                off = []
                for eye in EYES:
                    centre, gaze = self.gaze(eye, frames)
                    off.append(angle(gaze, aim - centre))
                return np.maximum(*off), "rad"
            case Rotate(bone):
                nodes = self.binding.bone(bone)
                wanted = self.rotation(constraint, frames)
                turn = np.swapaxes(frames.rotations[..., nodes.node, :, :], -1, -2) @ wanted
                return _turn_angle(turn), "rad"
            case Morph() if self.binding.is_skeletal(constraint):
                whole = self.binding.presets([*among] or [constraint])
                own = self.binding.preset(constraint)
                off = [np.abs(q[..., v] - whole[v]) for v in own]
                return beyond(np.max(np.stack(off), axis=0), constraint.within_rad), "rad"
            case Morph() | Trill() | Transpath():
                raise ValueError(f"no posture meets a {type(constraint).__name__}")

    def rotation(self, rotate: Rotate, frames: Frames) -> Array:
        """World rotation that a bone should have, (…, 3, 3).

        The angle is counted from the zero pose. A constant axis has the components x, dir and nrm
        of the parent bone's frame, which for trunk and head are left, up and forward; an axis
        that reads the posture is a direction of the signer's frame.
        """
        nodes = self.binding.bone(rotate.bone)
        chain = self.rig.chain
        rest = zero_rotation(chain, nodes)
        parent = int(chain.parents[nodes.origin_node])
        base = frames.rotations[..., parent, :, :] if parent >= 0 else np.eye(3)
        axis = self.vector(rotate.axis, frames)
        if not depends_on(rotate.axis):
            return np.asarray(base @ _rotation(paths.unit(axis), rotate.angle_rad) @ rest)
        return np.asarray(_rotation(paths.unit(axis), rotate.angle_rad) @ base @ rest)


def zero_rotation(chain: Chain, nodes: BoneNodes) -> Array:
    """Frame of a bone at the zero pose, in the frame of its parent bone, (3, 3)."""
    rotation = np.eye(3)
    node = nodes.node
    while True:
        rotation = chain.zero[node] @ rotation
        if node == nodes.origin_node:
            return np.asarray(rotation)
        node = int(chain.parents[node])


def beyond(miss: Array, within: float) -> Array:
    """By how much misses are greater than what a constraint allows, (…,); NaN stays."""
    return np.asarray(np.maximum(miss - within, 0.0) if within else miss)


def angle(a: Array, b: Array) -> Array:
    """Angle between vectors of any length, (…,) radians; exact near 0 and π; NaN for zero."""
    if a.ndim == b.ndim == 1:
        return np.asarray(_angle_of_two(a.tolist(), b.tolist()))
    u, v = paths.unit(a), paths.unit(b)
    return np.asarray(2 * np.arctan2(paths.length(u - v), paths.length(u + v)))


def _angle_of_two(a: Sequence[float], b: Sequence[float]) -> float:
    """Do the same for a single pair: numpy takes ten times as long over three numbers."""
    m, n = math.hypot(*a), math.hypot(*b)
    if not (m > paths.TINY and n > paths.TINY):
        return math.nan
    apart = math.hypot(*(x / m - y / n for x, y in zip(a, b, strict=True)))
    along = math.hypot(*(x / m + y / n for x, y in zip(a, b, strict=True)))
    return 2 * math.atan2(apart, along)


def _rotation(axis: Array, angle_rad: float) -> Array:
    """Matrix of a turn about a unit axis, (…, 3, 3)."""
    columns = [paths.turned(np.eye(3)[k], axis, angle_rad) for k in range(3)]
    return np.stack(np.broadcast_arrays(*columns), axis=-1)


def _turn_angle(rotation: Array) -> Array:
    """Angle of rotations, (…,), exact near 0: chordal distance is 2√2 sin(φ / 2)."""
    chord = np.linalg.norm(rotation - np.eye(3), axis=(-2, -1))
    return np.asarray(2 * np.arcsin(np.clip(chord / np.sqrt(8.0), 0.0, 1.0)))
