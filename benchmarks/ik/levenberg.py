"""A hand-written Levenberg–Marquardt kernel: the practical limit of speed for such problems.

The kernel minimises residuals within the limits and, on request, the posture cost, that is, the
distance from idle. It has no collisions, no order of problems and no reasons. It shares no code
with the solver that it is compared with, not even forward kinematics. A step over the coordinates
that are not held at a limit is cut off at the limits (Levenberg 1944, Marquardt 1963). The step is
−Jᵀ (J Jᵀ + λ 1)⁻¹ r, whose matrix is small where constraints are few (Nakamura and Hanafusa 1986).
With the posture cost it is −(Jᵀ J + λ 1)⁻¹ Jᵀ r, which is the same.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numba import njit
from numpy.typing import NDArray

from azee_rig.rig import Rig
from azee_solver.constraint import BoneAxis, Constraint, Orient, Place, Relation
from azee_solver.geometry import Bone, Dir, Nrm, Opp, Side, SitePoint, Vec, Vector, WorldPoint

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

POINT, ALONG, ACROSS = range(3)
MAX_STEPS = 100
GAIN = 1e-6
"""The share of the cost that a step must save for the next step to be made."""
NOTHING: Array = np.empty(0)
CLOSE = 0.25
"""The share of the squared tolerance at which the kernel stops."""


class Flat:
    """Constraints of one problem on a chain, as arrays.

    kinds: (C,). nodes: (C, 2) the placed or turned node and the node that it is compared with; −1
        is the world. locals_: (C, 2, 3) point or direction in the frames of these nodes. weights:
        (C,).
    """

    def __init__(
        self,
        rig: Rig,
        constraints: Sequence[Constraint],
        free: Sequence[int],
        tolerance: tuple[float, float],
        dominant: Side = Side.RIGHT,
    ) -> None:
        self.rig = rig
        self.free: Ints = np.array(sorted(free), dtype=np.int64)
        rows = [flat_row(rig, constraint, dominant) for constraint in constraints]
        self.kinds: Ints = np.array([row[0] for row in rows], dtype=np.int64)
        self.nodes: Ints = np.array([(row[1], row[3]) for row in rows], dtype=np.int64)
        self.locals_: Array = np.array([(row[2], row[4]) for row in rows])
        self.weights: Array = np.array([1 / tolerance[int(k != POINT)] for k in self.kinds])
        self.lower: Array = rig.coordinates.lower[self.free]
        self.upper: Array = rig.coordinates.upper[self.free]
        column = np.full(len(rig.coordinates), -1, dtype=np.int64)
        column[self.free] = np.arange(len(self.free))
        needed = np.zeros(len(rig.chain.names), dtype=np.bool_)
        for node in self.nodes.ravel().tolist():
            while node >= 0:
                needed[node] = True
                node = int(rig.chain.parents[node])
        self.column = column
        self.active: Ints = np.flatnonzero(needed)
        count = len(rig.chain.names)
        self.positions, self.rotations = np.zeros((count, 3)), np.zeros((count, 3, 3))
        self.axes = np.zeros((len(rig.chain.dof_axis), 3))
        self.rows = int(sum(1 if k == ACROSS else 3 for k in self.kinds))
        chain = rig.chain
        self._chain = (
            chain.parents,
            chain.offsets,
            chain.zero,
            chain.dof_start,
            chain.dof_axis,
            chain.dof_scale,
            chain.dof_coordinate,
            self.active,
            self.column,
            self.kinds,
            self.nodes,
            self.locals_,
            self.weights,
            self.positions,
            self.rotations,
            self.axes,
        )

    def residuals(self, q: Array) -> tuple[Array, Array]:
        """Weighted residuals (R,) at a posture (V,), and their Jacobian (R, n)."""
        r, J = np.empty(self.rows), np.zeros((self.rows, len(self.free)))
        _residuals(q, *self._chain, r, J)
        return r, J

    def worst(self, q: Array) -> float:
        """Return the greatest residual at a posture, in tolerances; for directions, the chord."""
        r, _ = self.residuals(q)
        return float(_worst(r, self.kinds))

    def descend(self, q: Array, keep: Array = NOTHING) -> tuple[Array, int]:
        """Return the end of a descent from a posture (V,), and its number of evaluations.

        Args: keep: (n,) square root of the cost of a squared radian away from idle. With it, the
            descent ends when a step gains no more; without it, as soon as all residuals are met.
        """
        q = q.copy()
        q[self.free] = np.clip(q[self.free], self.lower, self.upper)
        idle = self.rig.coordinates.idle[self.free]
        limits = (self.free, self.lower, self.upper, idle, keep)
        return q, int(_descend(q, *limits, *self._chain, self.rows))


def flat_row(
    rig: Rig, constraint: Constraint, dominant: Side
) -> tuple[int, int, Array, int, Array]:
    """Return kind, node, point or direction in it, and the same of its counterpart."""
    if isinstance(constraint, Place) and rig.sites[constraint.site.key(dominant)].shares:
        raise ValueError(f"{constraint.site.name} rides on several nodes: pin the body's sites")
    match constraint:
        case Place(site, WorldPoint(x, y, z)):
            own = rig.sites[site.key(dominant)]
            return POINT, own.node, own.position, -1, np.array([x, y, z])
        case Place(site, SitePoint(other)):
            own, its = rig.sites[site.key(dominant)], rig.sites[other.key(dominant)]
            return POINT, own.node, own.position, its.node, its.position
        case Orient(axis, bone, relation, vector):
            node, local = _axis(rig, bone, axis, dominant)
            other_node, other_local = _direction(rig, vector, dominant)
            kind = ALONG if relation is Relation.ALONG else ACROSS
            return kind, node, local, other_node, other_local
        case _:
            raise ValueError(f"not a constraint of the benchmark: {constraint}")


def _axis(rig: Rig, bone: Bone, axis: BoneAxis, dominant: Side) -> tuple[int, Array]:
    return rig.bones[bone.key(dominant)].node, np.eye(3)[1 if axis is BoneAxis.DIR else 2]


def _direction(rig: Rig, vector: Vector, dominant: Side) -> tuple[int, Array]:
    match vector:
        case Vec(x, y, z):
            return -1, np.array([x, y, z]) / math.sqrt(x * x + y * y + z * z)
        case Dir(bone):
            return _axis(rig, bone, BoneAxis.DIR, dominant)
        case Nrm(bone):
            return _axis(rig, bone, BoneAxis.NRM, dominant)
        case Opp(inner):
            node, local = _direction(rig, inner, dominant)
            return node, -local
        case _:
            raise ValueError(f"not a direction of the benchmark: {vector}")


def as_json(flat: Flat) -> list[Mapping[str, object]]:
    """Constraints for another process."""
    return [
        {
            "kind": ("point", "along", "across")[kind],
            "node": int(a),
            "local": own.tolist(),
            "other": int(b),
            "other_local": its.tolist(),
        }
        for kind, (a, b), (own, its) in zip(flat.kinds, flat.nodes, flat.locals_, strict=True)
    ]


@njit(cache=True)
def _frames(  # type: ignore[no-untyped-def]
    q, parents, offsets, zero, start, axis, scale, coordinate, active, positions, rotations, axes
):
    for b in active:
        p = parents[b]
        if p < 0:
            positions[b] = offsets[b]
            rotations[b] = zero[b]
        else:
            for i in range(3):
                positions[b, i] = positions[p, i]
                for k in range(3):
                    positions[b, i] += rotations[p, i, k] * offsets[b, k]
                for j in range(3):
                    total = 0.0
                    for k in range(3):
                        total += rotations[p, i, k] * zero[b, k, j]
                    rotations[b, i, j] = total
        for d in range(start[b], start[b + 1]):
            angle = scale[d] * q[coordinate[d]]
            c, s = math.cos(angle), math.sin(angle)
            j, k = (axis[d] + 1) % 3, (axis[d] + 2) % 3
            for i in range(3):
                axes[d, i] = rotations[b, i, axis[d]]
                u, w = rotations[b, i, j], rotations[b, i, k]
                rotations[b, i, j] = c * u + s * w
                rotations[b, i, k] = c * w - s * u


@njit(cache=True)
def _residuals(  # type: ignore[no-untyped-def]
    q, parents, offsets, zero, start, axis, scale, coordinate, active, column, kinds, nodes,
    locals_, weights, positions, rotations, axes, r, J,
):  # fmt: skip
    _frames(
        q, parents, offsets, zero, start, axis, scale, coordinate, active, positions, rotations,
        axes,
    )  # fmt: skip
    J[:] = 0.0
    value = np.zeros((2, 3))
    row = 0
    for c in range(kinds.shape[0]):
        kind, w = kinds[c], weights[c]
        for side in range(2):
            node = nodes[c, side]
            for i in range(3):
                if node < 0:
                    value[side, i] = locals_[c, side, i]
                    continue
                value[side, i] = positions[node, i] if kind == POINT else 0.0
                for k in range(3):
                    value[side, i] += rotations[node, i, k] * locals_[c, side, k]
        if kind == ACROSS:
            r[row] = 0.0
            for i in range(3):
                r[row] += w * value[0, i] * value[1, i]
        else:
            for i in range(3):
                r[row + i] = w * (value[0, i] - value[1, i])
        for side in range(2):
            node = nodes[c, side]
            sign = w if side == 0 else -w
            while node >= 0:
                for d in range(start[node], start[node + 1]):
                    col = column[coordinate[d]]
                    if col < 0:
                        continue
                    ux, uy, uz = axes[d, 0], axes[d, 1], axes[d, 2]
                    x, y, z = value[side, 0], value[side, 1], value[side, 2]
                    if kind == POINT:
                        x -= positions[node, 0]
                        y -= positions[node, 1]
                        z -= positions[node, 2]
                    gx, gy, gz = uy * z - uz * y, uz * x - ux * z, ux * y - uy * x
                    if kind == ACROSS:
                        o = 1 - side
                        J[row, col] += (
                            w * scale[d] * (gx * value[o, 0] + gy * value[o, 1] + gz * value[o, 2])
                        )
                    else:
                        J[row, col] += sign * scale[d] * gx
                        J[row + 1, col] += sign * scale[d] * gy
                        J[row + 2, col] += sign * scale[d] * gz
                node = parents[node]
        row += 1 if kind == ACROSS else 3


@njit(cache=True)
def _worst(r, kinds):  # type: ignore[no-untyped-def]
    worst, row = 0.0, 0
    for kind in kinds:
        size = 1 if kind == ACROSS else 3
        square = 0.0
        for i in range(size):
            square += r[row + i] ** 2
        worst = max(worst, math.sqrt(square))
        row += size
    return worst


@njit(cache=True)
def _descend(  # type: ignore[no-untyped-def]
    q, free, lower, upper, idle, keep, parents, offsets, zero, start, axis, scale, coordinate,
    active, column, kinds, nodes, locals_, weights, positions, rotations, axes, rows,
):  # fmt: skip
    n = free.shape[0]
    asked = rows
    rows += keep.shape[0]
    r, tried = np.empty(rows), np.empty(rows)
    J, other = np.empty((rows, n)), np.empty((rows, n))
    primal = keep.shape[0] > 0
    size = n if primal else rows
    A, y, b = np.empty((size, size)), np.empty(size), np.empty(size)
    held = np.zeros(n, dtype=np.bool_)
    step, kept = np.empty(n), np.empty(n)
    _residuals(
        q, parents, offsets, zero, start, axis, scale, coordinate, active, column, kinds, nodes,
        locals_, weights, positions, rotations, axes, r, J,
    )  # fmt: skip
    _posture_cost(q, free, idle, keep, asked, r, J)
    evaluations = 1
    f = 0.0
    for i in range(rows):
        f += r[i] * r[i]
    damping = 1e-3
    for _ in range(MAX_STEPS):
        if keep.shape[0] == 0 and _worst(r, kinds) ** 2 <= CLOSE:
            break
        slope = 0.0
        for v in range(n):
            g = 0.0
            for i in range(rows):
                g += J[i, v] * r[i]
            x = q[free[v]]
            held[v] = (x <= lower[v] and g > 0.0) or (x >= upper[v] and g < 0.0)
            if not held[v]:
                slope += g * g
        if slope < 1e-16:
            break
        trace = 0.0
        for i in range(size):
            b[i] = 0.0 if primal else r[i]
            for j in range(i + 1):
                total = 0.0
                if primal:
                    if not (held[i] or held[j]):
                        for k in range(asked):
                            total += J[k, i] * J[k, j]
                else:
                    for v in range(n):
                        if not held[v]:
                            total += J[i, v] * J[j, v]
                A[i, j] = total
            if primal and not held[i]:
                A[i, i] += keep[i] * keep[i]
                for k in range(rows):
                    b[i] += J[k, i] * r[k]
            trace += A[i, i]
        better = False
        for _again in range(12):
            _solve(A, damping * trace / size + 1e-12, b, y)
            for v in range(n):
                step[v] = 0.0
                if primal:
                    step[v] = -y[v]
                elif not held[v]:
                    for i in range(rows):
                        step[v] -= J[i, v] * y[i]
                kept[v] = q[free[v]]
                q[free[v]] = min(max(kept[v] + step[v], lower[v]), upper[v])
            _residuals(
                q, parents, offsets, zero, start, axis, scale, coordinate, active, column, kinds,
                nodes, locals_, weights, positions, rotations, axes, tried, other,
            )  # fmt: skip
            _posture_cost(q, free, idle, keep, asked, tried, other)
            evaluations += 1
            g = 0.0
            for i in range(rows):
                g += tried[i] * tried[i]
            if g < f:
                gain = f - g
                f = g
                r[:] = tried
                J[:] = other
                damping = max(damping * 0.2, 1e-9)
                better = gain > GAIN * f
                break
            for v in range(n):
                q[free[v]] = kept[v]
            damping *= 5.0
        if not better:
            break
    return evaluations


@njit(cache=True)
def _posture_cost(q, free, idle, keep, at, r, J):  # type: ignore[no-untyped-def]
    """Add the residuals of the distance from idle, below those of the constraints."""
    for k in range(keep.shape[0]):
        r[at + k] = keep[k] * (q[free[k]] - idle[k])
        J[at + k, k] = keep[k]


@njit(cache=True)
def _solve(A, shift, b, x):  # type: ignore[no-untyped-def]
    """Solve (A + shift 1) x = b by Cholesky; the lower triangle of A is given and kept."""
    n = b.shape[0]
    L = np.empty((n, n))
    for i in range(n):
        for j in range(i + 1):
            total = A[i, j] + (shift if i == j else 0.0)
            for k in range(j):
                total -= L[i, k] * L[j, k]
            L[i, j] = math.sqrt(max(total, 1e-300)) if i == j else total / L[j, j]
    for i in range(n):
        total = b[i]
        for k in range(i):
            total -= L[i, k] * x[k]
        x[i] = total / L[i, i]
    for i in range(n - 1, -1, -1):
        total = x[i]
        for k in range(i + 1, n):
            total -= L[k, i] * x[k]
        x[i] = total / L[i, i]
