"""Symbolic geometry lowered to a short list of operations that a kernel can run both ways.

Every entry gives one three-vector. Run forwards the tape gives the points and directions that
residuals compare; run backwards it turns the residuals' pulls on those into forces and moments on
nodes. What nothing free can move is folded into constants, so most targets are one entry.

| operation | value |
|---|---|
| CONSTANT | c |
| POINT | origin of node + its rotation · c |
| VECTOR | rotation of node · c |
| COMBINE | c + α · a + β · b |
| UNIT | a / |a| |
| CROSS | a × b |
| TURN | a turned about the unit vector b by an angle with cosine α and sine β |
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from azee_rig.chain import DIR, NRM, Frames
from azee_solver import path as paths
from azee_solver.block import COMBINE, CONSTANT, CROSS, POINT, TURN, UNIT, VECTOR
from azee_solver.constraint import BoneAxis, Rotate
from azee_solver.evaluate import GAZE, Evaluator, zero_rotation
from azee_solver.geometry import (
    Between,
    Bone,
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
    Site,
    SitePoint,
    Straight,
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

Array = NDArray[np.float64]


AXES = np.eye(3)
AXES.setflags(write=False)


class DegenerateError(Exception):
    """A direction that nothing free can change has no length."""


class Tape:
    """A tape under construction for one posture, of which some nodes will move.

    frames: the posture that gives the constants, one. moving: (B,), whether a node will move.
    """

    def __init__(self, evaluator: Evaluator, frames: Frames, moving: NDArray[np.bool_]) -> None:
        self.evaluator, self.frames, self.moving = evaluator, frames, moving
        self.binding, self.chain = evaluator.binding, evaluator.rig.chain
        self.codes: list[tuple[int, int, int, int]] = []
        """Operation, operands a and b (indices of earlier entries) and node; −1 for none."""
        self.numbers: list[tuple[float, float, float, float, float]] = []
        """c, α and β."""
        self._folded: list[Array | None] = []

    # Entries ----------------------------------------------------------------------------------

    def constant(self, value: Array) -> int:
        """Entry of a value that does not move."""
        x, y, z = value.tolist()
        return self._add(CONSTANT, numbers=(x, y, z, 0.0, 0.0), folded=value)

    def node_point(self, node: int, local: Array) -> int:
        """Entry of a point fixed in a node's frame; in the world's for −1."""
        if node >= 0 and self.moving[node]:
            return self._leaf(POINT, node, local)
        if node < 0:
            return self.constant(local)
        return self.constant(self.frames.positions[node] + self.frames.rotations[node] @ local)

    def node_vector(self, node: int, local: Array) -> int:
        """Entry of a direction fixed in a node's frame; in the world's for −1."""
        if node >= 0 and self.moving[node]:
            return self._leaf(VECTOR, node, local)
        return self.constant(local if node < 0 else self.frames.rotations[node] @ local)

    def combine(
        self, a: int, alpha: float, b: int = -1, beta: float = 0.0, c: Array | None = None
    ) -> int:
        """Entry for c + α · a + β · b."""
        fixed = np.zeros(3) if c is None else np.array(c, dtype=np.float64)
        terms = []
        for index, factor in ((a, alpha), (b, beta)):
            value = self._folded[index] if index >= 0 else None
            if value is not None:
                fixed = fixed + factor * value
            elif index >= 0:
                terms.append((index, factor))
        if not terms:
            return self.constant(fixed)
        (i, f), (j, g) = terms[0], terms[1] if len(terms) > 1 else (-1, 0.0)
        x, y, z = fixed.tolist()
        return self._add(COMBINE, i, j, numbers=(x, y, z, f, g))

    def unit(self, a: int) -> int:
        """Entry for a / |a|. Raises DegenerateError."""
        value = self._folded[a]
        if value is None:
            return self._add(UNIT, a)
        length = float(np.linalg.norm(value))
        if not length > paths.TINY:
            raise DegenerateError
        return self.constant(value / length)

    def cross(self, a: int, b: int) -> int:
        """Entry for a × b."""
        left, right = self._folded[a], self._folded[b]
        if left is not None and right is not None:
            return self.constant(np.cross(left, right))
        return self._add(CROSS, a, b)

    def turn(self, a: int, axis: int, angle: float) -> int:
        """Entry for a turned about a unit vector."""
        vector, spin = self._folded[a], self._folded[axis]
        if vector is not None and spin is not None:
            return self.constant(paths.turned(vector, spin, angle))
        return self._add(TURN, a, axis, numbers=(0.0, 0.0, 0.0, math.cos(angle), math.sin(angle)))

    def _leaf(self, code: int, node: int, local: Array) -> int:
        x, y, z = local.tolist()
        return self._add(code, node=node, numbers=(x, y, z, 0.0, 0.0))

    def _add(
        self,
        code: int,
        a: int = -1,
        b: int = -1,
        node: int = -1,
        numbers: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0),
        folded: Array | None = None,
    ) -> int:
        self.codes.append((code, a, b, node))
        self.numbers.append(numbers)
        self._folded.append(folded)
        return len(self.codes) - 1

    # Geometry ---------------------------------------------------------------------------------

    def vector(self, expr: Vector, phase: float = 0.0) -> int:
        """Entry of a vector expression. Raises DegenerateError, BindingError.

        A dynamic one keeps the shares of its ends that it has in the posture at hand.
        """
        match expr:
            case Vec() | Out():
                return self.constant(self.evaluator.vector(expr, self.frames))
            case Dir(bone):
                return self.axis(bone, BoneAxis.DIR)
            case Nrm(bone):
                return self.axis(bone, BoneAxis.NRM)
            case Opp(inner):
                return self.combine(self.vector(inner, phase), -1.0)
            case Unit(inner):
                return self.unit(self.vector(inner, phase))
            case Scale(inner, factor):
                return self.combine(self.vector(inner, phase), factor)
            case VSum(inners):
                total = self.constant(np.zeros(3))
                for inner in inners:
                    total = self.combine(total, 1.0, self.vector(inner, phase), 1.0)
                return total
            case VDiff(left, right):
                return self.combine(self.vector(left, phase), 1.0, self.vector(right, phase), -1.0)
            case Cross(left, right):
                return self.cross(self.vector(left, phase), self.vector(right, phase))
            case Towards(start, end):
                return self.towards(self.point(start, phase), self.point(end, phase))
            case Rotated(inner, axis, angle):
                return self.turn(
                    self.vector(inner, phase), self.unit(self.vector(axis, phase)), angle
                )
            case Swing(from_, to, beside):
                if from_ is None or to is None:
                    raise DegenerateError
                if beside is None:
                    return self._swung(from_, to, phase)
                return self._beside_straight(expr, from_, to, phase)

    def _swung(self, start: Vector, end: Vector, phase: float) -> int:
        a, b = (self.unit(self.vector(v, phase)) for v in (start, end))
        u, v = (
            paths.unit(self.evaluator.vector(side, self.frames, phase)) for side in (start, end)
        )
        angle = 2.0 * math.atan2(float(np.linalg.norm(u - v)), float(np.linalg.norm(u + v)))
        if not 0.0 < phase < 1.0 or angle < paths.TINY:
            return b if phase >= 1.0 else a
        if not math.pi - angle > 1e-6:
            raise DegenerateError
        shares = (math.sin(part * angle) / math.sin(angle) for part in (1.0 - phase, phase))
        first, second = shares
        return self.unit(self.combine(a, first, b, second))

    def _beside_straight(self, expr: Vector, start: Vector, end: Vector, phase: float) -> int:
        """Entry of a direction that stays as far from the straight line as it is now."""
        value = self.evaluator.vector(expr, self.frames, phase)
        if not np.all(np.isfinite(value)):
            raise DegenerateError
        first, last = (self.evaluator.vector(v, self.frames, phase) for v in (start, end))
        aside = value - (1.0 - phase) * paths.unit(first) - phase * paths.unit(last)
        a, b = (self.unit(self.vector(v, phase)) for v in (start, end))
        return self.unit(self.combine(a, 1.0 - phase, b, phase, aside))

    def towards(self, start: int, end: int) -> int:
        """Entry of the unit vector between two points. Raises DegenerateError."""
        return self.unit(self.combine(end, 1.0, start, -1.0))

    def axis(self, bone: Bone, axis: BoneAxis) -> int:
        """Entry of a bone's dir or nrm. Raises BindingError."""
        column = DIR if axis is BoneAxis.DIR else NRM
        return self.node_vector(self.binding.bone(bone).node, AXES[column])

    def point(self, expr: Point, phase: float = 0.0) -> int:
        """Entry of a point expression. Raises DegenerateError, BindingError.

        A dynamic point on a curved path goes with the straight one between the ends, from which it
        is as far as in the posture at hand.
        """
        scale = self.evaluator.scale
        match expr:
            case Was(at=None):
                raise DegenerateError
            case FreePoint() | NamedPoint() | WorldPoint() | Was():
                return self.constant(self.evaluator.point(expr, self.frames))
            case SitePoint(site):
                return self.site(site)
            case JointPoint(bone):
                return self.joint(bone)
            case VTranslate(point, vector):
                moved = self.vector(vector, phase)
                return self.combine(self.point(point, phase), 1.0, moved, scale)
            case Between(start, end, fraction):
                if (found := self.binding.skin_between(expr)) is not None:
                    return self.node_point(*found)
                return self.combine(
                    self.point(start, phase), 1.0 - fraction, self.point(end, phase), fraction
                )
            case Moving(Straight(), start, end):
                return self.combine(
                    self.point(start, phase), 1.0 - phase, self.point(end, phase), phase
                )
            case Moving(_, start, end):
                value = self.evaluator.point(expr, self.frames, phase)
                if not np.all(np.isfinite(value)):
                    raise DegenerateError
                straight = Moving(Straight(), start, end)
                aside = value - self.evaluator.point(straight, self.frames, phase)
                return self.combine(
                    self.point(start, phase), 1.0 - phase, self.point(end, phase), phase, aside
                )

    def site(self, site: Site, distance: float = 0.0) -> int:
        """Entry of a site, or of the point so many metres outwards of it. Raises BindingError."""
        bound = self.binding.site(site)
        if not bound.shares:
            return self.node_point(bound.node, bound.position + distance * bound.normal)
        point = self.node_point(bound.node, bound.position)
        for share in bound.shares:
            point = self.combine(point, 1.0, self.node_vector(share.node, share.vector), 1.0)
        if distance:
            normal = self.node_vector(bound.node, bound.normal)
            for share in bound.shares:
                normal = self.combine(normal, 1.0, self.node_vector(share.node, share.normal), 1.0)
            point = self.combine(point, 1.0, self.unit(normal), distance)
        return point

    def joint(self, bone: Bone) -> int:
        """Entry of a bone's proximal end. Raises BindingError."""
        node = self.binding.bone(bone).origin_node
        return self.node_point(int(self.chain.parents[node]), self.chain.offsets[node])

    def gaze(self, eye: Bone) -> tuple[int, int]:
        """Entries of an eye's centre and of the direction it looks in. Raises BindingError."""
        node = self.binding.bone(eye).node
        return self.joint(eye), self.node_vector(node, AXES[GAZE])

    def turned_frame(self, rotate: Rotate) -> Sequence[tuple[int, int]]:
        """Pairs of entries, a column of a bone's frame and what it should be; see `rotation`."""
        nodes = self.binding.bone(rotate.bone)
        rest = zero_rotation(self.chain, nodes)
        parent = int(self.chain.parents[nodes.origin_node])
        pairs = []
        if depends_on(rotate.axis):
            spin = self.unit(self.vector(rotate.axis))
            wanted = [
                self.turn(self.node_vector(parent, rest[:, k]), spin, rotate.angle_rad)
                for k in range(3)
            ]
        else:
            axis = self.evaluator.vector(rotate.axis, self.frames)
            if not np.linalg.norm(axis) > paths.TINY:
                raise DegenerateError
            turned = paths.turned(rest.T, paths.unit(axis), rotate.angle_rad).T
            wanted = [self.node_vector(parent, turned[:, k]) for k in range(3)]
        for k in range(3):
            pairs.append((self.node_vector(nodes.node, AXES[k]), wanted[k]))
        return pairs
