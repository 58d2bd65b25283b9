"""Capsules that overlap, and how they push each other apart."""

from __future__ import annotations

import math

from numba import njit

from azee_rig.pointers import INNER
from azee_solver.block import (
    BALL_NODE,
    BALLS,
    CAPSULE_ENDS,
    CAPSULE_NODE,
    CENTRES,
    CONTACTS,
    DEEPEST,
    ENDS,
    PAIR_REACH,
    PAIRS,
    RUN_REACH,
    RUNS,
    SHORT,
)
from azee_solver.kernels.sections import matrix, part


@njit(**INNER)
def nearest(ends, i, j):
    """Parameters of the nearest points of two capsules' axes (Ericson 2005, §5.1.9)."""
    a, b, c, d, e = 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        u = ends[i, 3 + k] - ends[i, k]
        v = ends[j, 3 + k] - ends[j, k]
        w = ends[i, k] - ends[j, k]
        a += u * u
        b += u * v
        c += v * v
        d += u * w
        e += v * w
    s = 0.0
    if a * c - b * b > SHORT:
        s = min(max((b * e - c * d) / (a * c - b * b), 0.0), 1.0)
    t = (b * s + e) / c if c > SHORT else 0.0
    if t < 0.0:
        t = 0.0
        s = min(max(-d / a, 0.0), 1.0) if a > SHORT else 0.0
    elif t > 1.0:
        t = 1.0
        s = min(max((b - d) / a, 0.0), 1.0) if a > SHORT else 0.0
    return s, t


@njit(**INNER)
def _spread(balls, nodes, positions, rotations, centres):
    """Where points of nodes' frames lie, some reals per row, of which the first three are one."""
    for c in range(nodes.shape[0]):
        node = nodes[c]
        for i in range(3):
            centres[c, i] = (
                positions[node, i]
                + rotations[node, i, 0] * balls[c, 0]
                + rotations[node, i, 1] * balls[c, 1]
                + rotations[node, i, 2] * balls[c, 2]
            )


@njit(**INNER)
def find_contacts(ints, reals, positions, rotations):
    """Find the pairs of capsules that overlap; return how many, and the sum of overlap².

    Contacts are rows of: one capsule's node, the nearest point of its axis, the other's, the
    unit vector from the second to the first, and the overlap.
    """
    if ints[PAIRS] == ints[PAIRS + 1]:
        reals[ints[DEEPEST]] = 0.0
        return 0, 0.0
    nodes = part(ints, ints, CAPSULE_NODE)
    local = matrix(reals, ints, CAPSULE_ENDS, nodes.shape[0], 6)
    ends = matrix(reals, ints, ENDS, nodes.shape[0], 6)
    _spread(local, nodes, positions, rotations, ends)
    _spread(local[:, 3:], nodes, positions, rotations, ends[:, 3:])
    ball_nodes = part(ints, ints, BALL_NODE)
    centres = matrix(reals, ints, CENTRES, ball_nodes.shape[0], 3)
    _spread(
        matrix(reals, ints, BALLS, ball_nodes.shape[0], 3),
        ball_nodes,
        positions,
        rotations,
        centres,
    )
    runs = matrix(ints, ints, RUNS, (ints[RUNS + 1] - ints[RUNS]) // 4, 4)
    pairs = matrix(ints, ints, PAIRS, (ints[PAIRS + 1] - ints[PAIRS]) // 2, 2)
    run_reach, reach = part(reals, ints, RUN_REACH), part(reals, ints, PAIR_REACH)
    contacts = matrix(reals, ints, CONTACTS, pairs.shape[0], 12)
    deepest, total, found = 0.0, 0.0, 0
    for run in range(runs.shape[0]):
        one, other = runs[run, 0], runs[run, 1]
        if one != other:
            away = 0.0
            for k in range(3):
                away += (centres[one, k] - centres[other, k]) ** 2
            if away > run_reach[run] * run_reach[run]:
                continue
        for n in range(runs[run, 2], runs[run, 3]):
            i, j = pairs[n, 0], pairs[n, 1]
            # A box around both axes that is wide enough to miss nothing.
            apart = False
            for k in range(3):
                low_i, high_i = min(ends[i, k], ends[i, 3 + k]), max(ends[i, k], ends[i, 3 + k])
                low_j, high_j = min(ends[j, k], ends[j, 3 + k]), max(ends[j, k], ends[j, 3 + k])
                if low_i - high_j > reach[n] or low_j - high_i > reach[n]:
                    apart = True
            if apart:
                continue
            s, t = nearest(ends, i, j)
            contact = contacts[found]
            square = 0.0
            for k in range(3):
                contact[2 + k] = ends[i, k] + s * (ends[i, 3 + k] - ends[i, k])
                contact[5 + k] = ends[j, k] + t * (ends[j, 3 + k] - ends[j, k])
                square += (contact[2 + k] - contact[5 + k]) ** 2
            distance = math.sqrt(square)
            overlap = reach[n] - distance
            if overlap <= 0.0:
                continue
            total += overlap * overlap
            deepest = max(deepest, overlap)
            if distance <= SHORT:
                continue
            contact[0], contact[1], contact[11] = nodes[i], nodes[j], overlap
            for k in range(3):
                contact[8 + k] = (contact[2 + k] - contact[5 + k]) / distance
            found += 1
    reals[ints[DEEPEST]] = deepest
    return found, total


@njit(**INNER)
def push_apart(contacts, count, weight, forces, moments):
    """Push nodes of capsules that overlap apart, with forces and moments."""
    for n in range(count):
        contact = contacts[n]
        for side in range(2):
            factor = -2.0 * weight * contact[11] if side == 0 else 2.0 * weight * contact[11]
            node = int(contact[side])
            px, py, pz = contact[2 + 3 * side], contact[3 + 3 * side], contact[4 + 3 * side]
            fx, fy, fz = factor * contact[8], factor * contact[9], factor * contact[10]
            forces[node, 0] += fx
            forces[node, 1] += fy
            forces[node, 2] += fz
            moments[node, 0] += py * fz - pz * fy
            moments[node, 1] += pz * fx - px * fz
            moments[node, 2] += px * fy - py * fx
