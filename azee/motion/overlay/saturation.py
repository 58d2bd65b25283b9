"""What a face can show: weights of face units add up, but lids, lips and jaw stop at their ends.

How far a unit closes an eye or presses the lips is read off the mesh: by how much it narrows the
gap between the edges that meet there, as a share of what closed lids or pressed lips do. A jaw has
no such edges: the share of the displacement that drops it which the unit's own displacement has
along it, on the vertices that move then. Where shares add up to more than the end, all units that
go there are scaled by one factor, so that a blink under a squint closes the lids and does not fold
them through each other.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from azee_rig.rig import Rig

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

LIDS = (("AU43_L", "AU43"), ("AU43_R", "AU43"))
"""Morphs that close an eye, each with another for bodies that lack it."""
PARTING, CLOSING = ("AU25_a", "AU25"), ("AU24", "AU8")
"""Morphs that part the lips and that press them."""
JAW = ("AU27", "AU26")
SMALL_SHARE = 0.3
"""Units that drop the jaw less do not count,"""
SMALL_GAP_SHARE = 0.05
"""and neither do those that close a gap less."""
MOVED_M = 1e-3
"""What a unit moves less than this stays where it is."""
NEAR_M = 6e-3
"""Edges that meet are no farther apart, where they meet."""


def saturated(weights: Array, rig: Rig) -> Array:
    """Return weights of face units (T, U) that lids and jaw can show."""
    out = weights.copy()
    for shares in _shares(rig):
        done = out * shares
        towards, back = np.maximum(done, 0.0).sum(axis=1), np.minimum(done, 0.0).sum(axis=1)
        beyond = towards + back > 1.0
        factor = (1.0 - back[beyond]) / towards[beyond]
        out[beyond] = np.where(done[beyond] > 0.0, out[beyond] * factor[:, None], out[beyond])
    return out


@lru_cache(maxsize=4)
def _shares(rig: Rig) -> tuple[Array, ...]:
    """Return for each end how much of the way there each unit goes at weight 1, (U,)."""
    out = [_lid_shares(rig, names) for names in LIDS]
    out += [_lip_shares(rig), _shares_along(rig, _moved(rig, JAW))]
    return tuple(shares for shares in out if shares is not None)


def _moved(rig: Rig, names: Sequence[str]) -> Array | None:
    """Return how the first morph of some that a body has moves its vertices, (N, 3)."""
    name = next((n for n in names if n in rig.face_morphs), None)
    if name is None:
        return None
    out = np.zeros((len(rig.mesh.vertices), 3))
    for unit, weight in rig.face_morphs[name].items():
        rows, deltas = rig.mesh.unit(unit)
        out[rows] += weight * deltas
    return out


def _lid_shares(rig: Rig, names: Sequence[str]) -> Array | None:
    """Measure between the upper lid, which closes, and what then lies below it."""
    closing = _moved(rig, names)
    if closing is None:
        return None
    down = closing[:, 1]
    raised = np.zeros(len(down))
    for unit in rig.units:
        rows, deltas = rig.mesh.unit(unit)
        raised[rows] = np.maximum(raised[rows], deltas[:, 1])
    lower = np.nonzero((down > 0.1 * down.min()) & (raised > MOVED_M))[0]
    closed = rig.mesh.vertices + closing
    pairs = _nearest(closed, np.nonzero(down < 0.6 * down.min())[0], lower)
    return _gap_shares(rig, pairs, closing) if len(pairs) else _shares_along(rig, closing)


def _lip_shares(rig: Rig) -> Array | None:
    """Measure between what parts upwards and what parts downwards."""
    parting, closing = _moved(rig, PARTING), _moved(rig, CLOSING)
    if parting is None or closing is None:
        return None
    up = parting[:, 1]
    upper, lower = np.nonzero(up > 0.5 * up.max())[0], np.nonzero(up < 0.5 * up.min())[0]
    pairs = _nearest(rig.mesh.vertices, upper, lower)
    return _gap_shares(rig, pairs, closing) if len(pairs) else None


def _nearest(places: Array, first: Indices, second: Indices) -> Indices:
    """Return pairs (P, 2) of each vertex of the first and the nearest of the second near it."""
    if not len(first) or not len(second):
        return np.zeros((0, 2), dtype=np.int64)
    apart = np.linalg.norm(places[first, None] - places[None, second], axis=2)
    nearest = apart.argmin(axis=1)
    near = apart.min(axis=1) < NEAR_M
    return np.column_stack([first[near], second[nearest[near]]])


def _gap_shares(rig: Rig, pairs: Indices, end: Array) -> Array | None:
    """Return by how much each unit narrows the mean height between pairs, as a share of the end."""

    def narrowed(displacement: Array) -> float:
        return float(np.mean(displacement[pairs[:, 1], 1] - displacement[pairs[:, 0], 1]))

    whole = narrowed(end)
    if whole < MOVED_M:
        return None
    shares = np.zeros(len(rig.units))
    for u, unit in enumerate(rig.units):
        displacement = np.zeros_like(end)
        rows, deltas = rig.mesh.unit(unit)
        displacement[rows] = deltas
        shares[u] = narrowed(displacement) / whole
    shares[np.abs(shares) < SMALL_GAP_SHARE] = 0.0
    return shares


def _shares_along(rig: Rig, whole: Array | None) -> Array | None:
    if whole is None:
        return None
    square = float(np.sum(whole**2))
    shares = np.zeros(len(rig.units))
    for u, unit in enumerate(rig.units):
        rows, deltas = rig.mesh.unit(unit)
        shares[u] = float(np.sum(whole[rows] * deltas)) / square if square > 0.0 else 0.0
    shares[np.abs(shares) < SMALL_SHARE] = 0.0
    return shares
