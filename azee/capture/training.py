"""Training: from recordings with all markers to a model that needs a few."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from azee.capture.calibration import calibrate
from azee.capture.choosing import by_clusters, by_components, by_regression
from azee.capture.hand import Hand
from azee.capture.hand_fit import HandFit
from azee.capture.markers import Floats, Markers, MarkersError, named_like
from azee.capture.model import CaptureModel
from azee.capture.places import digit_markers
from azee.capture.poses import SEED, representatives
from azee.capture.regression import LocalRegression
from azee.capture.root_frame import RootShape, into_root, root_shape
from azee.capture.tracking import roughness_of, speed_of, tracked

Algorithm: TypeAlias = Literal["regression", "clusters", "clusters-printed", "components"]
ALGORITHMS: tuple[Algorithm, ...] = ("regression", "clusters", "clusters-printed", "components")
Told = Callable[[int, int], None]
"""Is told of parts of the work that are done, and all."""

LEAST_FRAMES = 100
"""Of a training: fewer do not tell a hand."""
SELECTION_SHARE = 0.25
"""Of the training, at its end, on which choices are scored and errors are measured."""
SHAPE_POSES = 150
"""Poses that a hand's shape is fitted to."""
CHOICE_POSES = 1000
"""p of algorithm 1."""
REGRESSION_POSES, REGRESSION_FRAMES = 500, 200
"""Samples and frames on which a choice is scored by regression."""
WIDTH_M = (0.05, 0.4)
"""How wide a hand with its markers is."""


@dataclass(frozen=True, eq=False)
class Poses:
    """All markers of one hand in the root's frame, complete frames only.

    names: of the M markers. positions: (N, M, 3) metres. runs: first frames of stretches without a
    gap, and N. root. rate_hz. sources: files. speed_m_s: see `speed_of`.
    """

    names: tuple[str, ...]
    positions: Floats
    runs: tuple[int, ...]
    root: RootShape
    rate_hz: float
    sources: tuple[str, ...]
    speed_m_s: float

    def columns(self, names: Sequence[str]) -> list[int]:
        """Columns of some markers."""
        return [self.names.index(name) for name in names]

    @property
    def candidates(self) -> list[int]:
        """Columns of markers that can be chosen: all but the root's."""
        return [m for m, name in enumerate(self.names) if name not in self.root.names]

    def part(self, rows: NDArray[np.int64]) -> Poses:
        """Return some of the frames, increasing rows."""
        apart = np.flatnonzero(np.diff(rows) > 1) + 1
        starts = {0, *apart.tolist(), *np.searchsorted(rows, self.runs[1:-1]).tolist()}
        runs = (*tuple(sorted(starts - {len(rows)})), len(rows))
        return replace(self, positions=self.positions[rows], runs=runs)


def poses_of(
    recordings: Sequence[Markers], root: Sequence[str], names: Sequence[str] | None = None
) -> Poses:
    """Bring recordings of one hand into the frame of its root; short gaps are bridged.

    Args: root: names of the root's markers. names: of all markers of the hand; by default the
        root's and those whose names tell a place on a digit.
    Raises: MarkersError: markers are missing, rates differ, or too few frames are complete.
    """
    first = recordings[0]
    if names is None:
        names = [n for n in first.names if n not in root and n in digit_markers(first.names)]
    used = (*(name for name in names if name not in root), *root)
    hands = [named_like(each, used).only(used) for each in recordings]
    rates = {each.rate_hz for each in hands}
    if len(rates) > 1:
        told = " and ".join(f"{rate:g}" for rate in sorted(rates))
        raise MarkersError(f"the recordings have {told} frames a second", "train on one rate")
    shape = root_shape(hands[0], root)
    parts, runs, count = [], [0], 0
    for each in hands:
        found = tracked(into_root(each, shape).positions, each.rate_hz).positions
        whole = np.flatnonzero(~np.isnan(found).any(axis=(1, 2)))
        starts = np.flatnonzero(np.diff(whole) > 1) + 1
        runs += [count + start for start in (*starts.tolist(), len(whole)) if start]
        parts.append(found[whole])
        count += len(whole)
    positions = np.concatenate(parts)
    if len(positions) < LEAST_FRAMES:
        raise MarkersError(
            f"all of {', '.join(used)} are seen at once in {len(positions)} frames; "
            f"at least {LEAST_FRAMES} are needed"
        )
    _check_width(positions)
    sources = tuple(each.source for each in hands)
    rate = hands[0].rate_hz
    speed = speed_of(positions, rate)
    return Poses(used, positions, tuple(sorted(set(runs))), shape, rate, sources, speed)


def _check_width(positions: Floats) -> None:
    """Refuse what is no hand. Raises: MarkersError."""
    ends = positions.max(axis=1) - positions.min(axis=1)
    width = float(np.median(np.linalg.norm(ends, axis=1)))
    if not WIDTH_M[0] <= width <= WIDTH_M[1]:
        raise MarkersError(
            f"the hand is {width:.3g} m wide",
            "name the right unit with --unit, or the hand's markers with --hand",
        )


def split(count: int, share: float = SELECTION_SHARE) -> tuple[NDArray[np.int64], ...]:
    """Rows of the first part, and of the last `share` of so many frames."""
    border = round((1.0 - share) * count)
    return np.arange(border), np.arange(border, count)


def choose(
    poses: Poses,
    count: int,
    algorithm: Algorithm = "regression",
    regression: LocalRegression | None = None,
    told: Callable[[int, int], None] | None = None,
) -> tuple[str, ...]:
    """Return the names of so many markers to record beside the root's, the best ones.

    Database and test sequence of the choice are two parts of the poses, one after the other.
    """
    columns = poses.candidates
    if not 0 < count <= len(columns):
        raise MarkersError(f"{count} of {len(columns)} markers cannot be chosen")
    known, unknown = (poses.positions[rows] for rows in split(len(poses.positions)))
    match algorithm:
        case "components":
            chosen = by_components(poses.positions, columns)[:count]
        case "clusters" | "clusters-printed":
            few = known[representatives(known, CHOICE_POSES)]
            printed = algorithm == "clusters-printed"
            ranked = by_clusters(few, unknown[::4], count, columns, printed=printed, told=told)
            chosen = list(ranked[0].markers)
        case "regression":
            few = known[representatives(known, REGRESSION_POSES)]
            sequence = unknown[:: max(1, len(unknown) // REGRESSION_FRAMES)]
            best = by_regression(few, sequence, count, columns, regression, told)
            chosen = list(best.markers)
    return tuple(poses.names[m] for m in chosen)


def train(
    poses: Poses,
    chosen: Sequence[str],
    hand: Hand,
    regression: LocalRegression | None = None,
    algorithm: str = "by hand",
    told: Told | None = None,
) -> CaptureModel:
    """Fit the hand to all poses, and measure what the chosen markers leave open.

    Raises: MarkersError: a chosen marker is not there.
    """
    how = regression or LocalRegression()
    for name in chosen:
        if name not in poses.names:
            raise MarkersError(f"there is no marker `{name}`; there are: {', '.join(poses.names)}")
    places = digit_markers(poses.names)
    columns = poses.columns(list(places))
    few = poses.positions[representatives(poses.positions, SHAPE_POSES)][:, columns]
    runs = list(zip(poses.runs[:-1], poses.runs[1:], strict=True))
    found = calibrate(few, places, hand, told)
    shape = found.shape
    fit = HandFit(hand, shape)
    targets = shape.into_palm(poses.positions[:, columns])
    q = np.empty((len(targets), len(hand.body.coordinates)))
    usual = np.median(found.postures, axis=0)
    for n, (start, stop) in enumerate(runs):
        reference = np.tile(usual, (stop - start, 1))
        q[start:stop] = fit.solved(targets[start:stop], reference, poses.rate_hz)
        if told:
            told(n + 1, len(runs))
    off = np.linalg.norm(hand.marker_positions(shape, q) - targets, axis=-1)
    return CaptureModel(
        names=poses.names,
        poses=poses.positions,
        angles=q[:, hand.columns],
        root=poses.root,
        chosen=tuple(chosen),
        shape=shape,
        off_m=left_open(poses, chosen, how),
        rate_hz=poses.rate_hz,
        regression=how,
        body=hand.body.name,
        side=hand.side,
        provenance={
            "azee": version("azee"),
            "sources": list(poses.sources),
            "frames": len(poses.positions),
            "algorithm": algorithm,
            "seed": SEED,
            "speed_m_s": poses.speed_m_s,
            "roughness_m": roughness_of(poses.positions),
            "fit_off_m": {name: float(x) for name, x in zip(places, off.mean(axis=0), strict=True)},
        },
    )


def left_open(
    poses: Poses, chosen: Sequence[str], regression: LocalRegression | None = None
) -> Floats:
    """Mean error (M,) of each marker in the last part of the poses, foretold from the first."""
    how = regression or LocalRegression()
    known, unknown = (poses.positions[rows] for rows in split(len(poses.positions)))
    used = poses.columns([*chosen, *poses.root.names])
    trust = np.ones((len(unknown), len(used)))
    flat = known.reshape(len(known), -1)
    made = how.foretell(known[:, used], unknown[:, used], trust, flat)
    off = made.reshape(unknown.shape) - unknown
    return np.asarray(np.linalg.norm(off, axis=-1).mean(axis=0))
