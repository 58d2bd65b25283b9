"""The value of a problem's objective, and its gradient.

    f(x) = σ Σ_k w_k e_k² + w_o Σ overlap² + Σ_v λ_v (q_v − ref_v)² + Σ_v κ_v beyond_v²

in this order below; the package's docstring names the symbols.
"""

from __future__ import annotations

from numba import njit

from azee_rig.pointers import INNER
from azee_solver.block import (
    ACTIVE,
    AXES,
    CODES,
    COMFORTABLE,
    CONTACTS,
    COUNT,
    DOF_COORDINATE,
    DOF_SCALE,
    DOF_START,
    FOLLOWED,
    FOLLOWING,
    FORCES,
    FREE,
    MISS_SHARE,
    MOMENTS,
    NUMBERS,
    OVERLAP_WEIGHT,
    PARENTS,
    POSITIONS,
    POSTURE,
    PULL_ON_Q,
    PULLS,
    ROTATIONS,
    ROW_NUMBERS,
    ROWS,
    VALUES,
    Q,
)
from azee_solver.kernels.capsules import find_contacts, push_apart
from azee_solver.kernels.chain import forward, joint_gradient
from azee_solver.kernels.residuals import forward_sweep, residual_cost, reverse_sweep
from azee_solver.kernels.sections import matrix, part, stack


@njit(**INNER)
def objective(x, gradient, wanted, ints, reals):
    """Work out f at the free coordinates x (n,), its gradient too if wanted; count contacts."""
    q = part(reals, ints, Q)
    free, active = part(ints, ints, FREE), part(ints, ints, ACTIVE)
    parents = part(ints, ints, PARENTS)
    count, entries = parents.shape[0], (ints[CODES + 1] - ints[CODES]) // 4
    positions = matrix(reals, ints, POSITIONS, count, 3)
    rotations = stack(reals, ints, ROTATIONS, count, 3, 3)
    codes = matrix(ints, ints, CODES, entries, 4)
    numbers = matrix(reals, ints, NUMBERS, entries, 5)
    values = matrix(reals, ints, VALUES, entries, 3)
    pulls = matrix(reals, ints, PULLS, entries, 3)
    ints[ints[COUNT]] += 1

    for k in range(free.shape[0]):
        q[free[k]] = x[k]
    forward(q, ints, reals)
    forward_sweep(codes, numbers, positions, rotations, values)
    pulls[:] = 0.0
    residuals = (ints[ROWS + 1] - ints[ROWS]) // 3
    f = residual_cost(
        matrix(ints, ints, ROWS, residuals, 3),
        matrix(reals, ints, ROW_NUMBERS, residuals, 3),
        reals[ints[MISS_SHARE]],
        values,
        pulls,
    )
    weight = reals[ints[OVERLAP_WEIGHT]]
    contacts, overlaps = find_contacts(ints, reals, positions, rotations)
    f += weight * overlaps

    pull_on_q = part(reals, ints, PULL_ON_Q)
    if wanted:
        forces = matrix(reals, ints, FORCES, count, 3)
        moments = matrix(reals, ints, MOMENTS, count, 3)
        forces[:] = 0.0
        moments[:] = 0.0
        pull_on_q[:] = 0.0
        reverse_sweep(codes, numbers, values, pulls, forces, moments)
        touching = matrix(reals, ints, CONTACTS, contacts, 12)
        push_apart(touching, contacts, weight, forces, moments)
        joint_gradient(
            active,
            parents,
            part(ints, ints, DOF_START),
            part(reals, ints, DOF_SCALE),
            part(ints, ints, DOF_COORDINATE),
            positions,
            matrix(reals, ints, AXES, (ints[AXES + 1] - ints[AXES]) // 3, 3),
            forces,
            moments,
            pull_on_q,
        )

    posture = matrix(reals, ints, POSTURE, free.shape[0], 5)
    followed = part(ints, ints, FOLLOWED)
    for k in range(free.shape[0]):
        reference, keep, middle, half, comfort = posture[k]
        away = reference_error(x, k, followed[k], reference)
        beyond = beyond_comfort((x[k] - middle) / half)
        f += keep * away * away + comfort * beyond * beyond
        if wanted:
            gradient[k] = pull_on_q[free[k]] + 2.0 * keep * away + 2.0 * comfort * beyond / half
    if wanted:
        for k in range(free.shape[0]):
            if followed[k] >= 0:
                away = reference_error(x, k, followed[k], posture[k, 0])
                gradient[followed[k]] -= 2.0 * FOLLOWING * posture[k, 1] * away
    return f, contacts


@njit(**INNER)
def reference_error(x, k, leader, reference):
    """How far a coordinate is from its reference, or from what it follows."""
    return x[k] - (FOLLOWING * x[leader] if leader >= 0 else reference)


@njit(**INNER)
def beyond_comfort(u):
    """How far into the outer part of its range a coordinate is, with its sign."""
    return u - COMFORTABLE if u > COMFORTABLE else min(u + COMFORTABLE, 0.0)
