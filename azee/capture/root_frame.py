"""Markers in the frame of the root: a few markers that do not move against each other.

They are glued on the forearm or on the back of the hand. The frame of an instant is the rotation
and shift that bring the shape of these markers onto where they are, in the least squares (Kabsch
1976). Where fewer than three are seen, the other markers help: against the root they move little
while the hand goes through the room. Where fewer than three of all are seen it is interpolated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from azee.capture.markers import Flags, Floats, Markers, MarkersError
from azee_rig.skeleton import frozen

LEAST = 3
ROUNDS = 5
"""Of averaging the shape: its frame and its mean change each other hardly at all."""
LEAST_SPREAD_M = 0.004
"""How far from one line the markers of a root must lie."""
OFF = 3.0
"""Markers that fit the shape worse than usual by this factor may be swapped."""
HELP = 1e-3
"""Weight of the other markers beside the root's: they are off by millimetres."""
USUAL_M = 0.002
"""How well the markers of a root fit their shape; skin moves."""


@dataclass(frozen=True, eq=False)
class RootShape:
    """Markers of the root and where they are in its frame, (R, 3) metres, mean at the origin."""

    names: tuple[str, ...]
    points: Floats

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", frozen(self.points, np.float64))

    @property
    def widths_m(self) -> Floats:
        """Distances of all pairs, (R (R − 1) / 2,) metres."""
        i, j = np.triu_indices(len(self.points), 1)
        return np.asarray(np.linalg.norm(self.points[i] - self.points[j], axis=-1))


@dataclass(frozen=True, eq=False)
class InRoot:
    """Markers in the root's frame.

    positions: (T, M, 3) metres, NaN where one is not seen. rotations (T, 3, 3) and origins (T, 3):
    the frame in the room. measured: (T,), whether the root was seen whole. off_m: (T,)
    root mean square of what the root's markers are off their shape.
    """

    names: tuple[str, ...]
    positions: Floats
    rotations: Floats
    origins: Floats
    measured: Flags
    off_m: Floats


def root_shape(markers: Markers, names: Sequence[str]) -> RootShape:
    """Return the mean shape of some markers.

    Raises: MarkersError: there are fewer than three, they lie on a line, or are never seen at once.
    """
    if len(names) < LEAST:
        raise MarkersError(f"the root needs {LEAST} markers, not {len(names)}")
    at = markers.only(names).positions
    at = at[~np.isnan(at).any(axis=(1, 2))]
    if not len(at):
        raise MarkersError(f"the markers of the root are never seen at once: {', '.join(names)}")
    first = at[len(at) // 2]
    x, across = first[1] - first[0], first[2] - first[0]
    z = np.cross(x, across)
    if np.linalg.norm(z) < LEAST_SPREAD_M * np.linalg.norm(x):
        raise MarkersError(f"the markers of the root lie on one line: {', '.join(names)}")
    axes = np.stack([x, np.cross(z, x), z], axis=1)
    axes /= np.linalg.norm(axes, axis=0)
    shape = (first - first.mean(axis=0)) @ axes
    for _ in range(ROUNDS):
        R, origin = rigid(shape, at)
        shape = ((at - origin[:, None]) @ R).mean(axis=0)
        shape -= shape.mean(axis=0)
    return RootShape(tuple(names), shape)


def rigid(shape: Floats, points: Floats, weights: Floats | None = None) -> tuple[Floats, Floats]:
    """Rotations (T, 3, 3) and shifts (T, 3) that bring a shape (R, 3) nearest to points (T, R, 3).

    Kabsch 1976: with H = Σ w (p − p̄)(s − s̄)ᵀ = U S Vᵀ, R = U diag(1, 1, det U det V) Vᵀ.

    Args: weights: w, (R,); by default all alike.
    """
    w = np.full(len(shape), 1.0) if weights is None else weights
    w = w / w.sum()
    middle, centre = w @ shape, w @ points
    H = np.swapaxes((points - centre[:, None]) * w[:, None], 1, 2) @ (shape - middle)
    U, _, V = np.linalg.svd(H)
    sign = np.linalg.det(U) * np.linalg.det(V)
    U[:, :, 2] *= sign[:, None]
    R = U @ V
    return R, centre - R @ middle


def into_root(markers: Markers, shape: RootShape) -> InRoot:
    """Return markers in the root's frame; swapped markers of the root are put right.

    Raises: MarkersError: a marker of the root is not there, or they are never seen at once.
    """
    at = markers.only(shape.names).positions
    columns = [markers.names.index(name) for name in shape.names]
    seen = ~np.isnan(at[:, :, 0])
    measured = seen.sum(axis=1) >= LEAST
    if not measured.any():
        raise MarkersError(
            f"fewer than {LEAST} markers of the root are ever seen at once: "
            f"{', '.join(shape.names)}"
        )
    R, origin = np.tile(np.eye(3), (len(at), 1, 1)), np.zeros((len(at), 3))
    off = np.zeros(len(at))
    positions = np.array(markers.positions)
    for pattern in np.unique(seen[measured], axis=0):
        rows = np.flatnonzero(measured & (seen == pattern).all(axis=1))
        points, part = at[np.ix_(rows, np.flatnonzero(pattern))], shape.points[pattern]
        R[rows], origin[rows], off[rows] = _fitted(part, points)
        limit = max(USUAL_M, OFF * float(np.median(off[rows])))
        for row in rows[off[rows] > limit]:
            order = _order(part, at[row, pattern])
            swapped = at[row, pattern][list(order)]
            R[row], origin[row], off[row] = (x[0] for x in _fitted(part, swapped[None]))
            positions[row, np.array(columns)[pattern]] = swapped
    _interpolate(R, origin, measured)
    if not measured.all():
        _help(R, origin, measured, positions, shape, columns)
    local = (positions - origin[:, None]) @ R
    return InRoot(markers.names, local, R, origin, measured, off)


def _fitted(shape: Floats, points: Floats) -> tuple[Floats, Floats, Floats]:
    R, origin = rigid(shape, points)
    off = points - (np.swapaxes(R @ shape.T, 1, 2) + origin[:, None])
    return R, origin, np.sqrt((off**2).sum(axis=2).mean(axis=1))


def _order(shape: Floats, points: Floats) -> tuple[int, ...]:
    """Return the order of points (R, 3) in which they fit a shape best."""
    orders = (
        list(permutations(range(len(points)))) if len(points) <= 5 else [(*range(len(points)),)]
    )
    tried = np.stack([points[list(order)] for order in orders])
    return orders[int(_fitted(shape, tried)[2].argmin())]


def _help(
    R: Floats, origin: Floats, measured: Flags, positions: Floats, shape: RootShape,
    columns: Sequence[int],
) -> None:  # fmt: skip
    """Find the frames in which the root is not seen whole by all markers that are seen.

    The others are taken to be where they are in the root before and after, and evenly on the way.
    """
    known, gaps = np.flatnonzero(measured), np.flatnonzero(~measured)
    local = (positions[known] - origin[known, None]) @ R[known]
    expected = np.full((len(gaps), *positions.shape[1:]), np.nan)
    for m in range(positions.shape[1]):
        seen = ~np.isnan(local[:, m, 0])
        for axis in range(3) if seen.any() else ():
            expected[:, m, axis] = np.interp(gaps, known[seen], local[seen, m, axis])
    expected[:, columns] = shape.points
    weights = np.full(positions.shape[1], HELP)
    weights[columns] = 1.0
    for row, guess in zip(gaps, expected, strict=True):
        use = ~np.isnan(positions[row, :, 0]) & ~np.isnan(guess[:, 0])
        if use.sum() >= LEAST:
            turned, shift = rigid(guess[use], positions[row, use][None], weights[use])
            R[row], origin[row] = turned[0], shift[0]


def _interpolate(R: Floats, origin: Floats, measured: Flags) -> None:
    """Fill in frames that were not measured from their neighbours; at the ends they stay."""
    known, gaps = np.flatnonzero(measured), np.flatnonzero(~measured)
    if not len(gaps):
        return
    at = np.clip(gaps, known[0], known[-1])
    for k in range(3):
        origin[gaps, k] = np.interp(at, known, origin[known, k])
    if len(known) > 1:
        R[gaps] = Slerp(known, Rotation.from_matrix(R[known]))(at).as_matrix()
    else:
        R[gaps] = R[known[0]]
