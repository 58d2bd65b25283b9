"""The whole hand from few markers, in five steps.

1. Bring the markers into the root's frame. (`into_root`)
2. Put swapped markers right, bridge short gaps, fade out what is missing for longer. (`tracked`)
3. Foretell all markers and all joint angles of each frame from the samples near it, and smooth
   their principal components: by regression, or by the nearest pose. (`foretell`)
4. Fit the hand, inside its joints' limits: recorded markers where they were recorded, the others
   as near to where they were foretold as these are sure. (`HandFit`)
5. Measure what every recorded marker is off.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

import numpy as np

from azee.capture.components import principal_components
from azee.capture.hand_fit import HandFit
from azee.capture.markers import Floats, Markers, MarkersError, named_like
from azee.capture.model import CaptureModel
from azee.capture.regression import LocalRegression, nearest_rows
from azee.capture.root_frame import InRoot, into_root
from azee.capture.smoothing import COMPONENT_TAPS, NEAREST_TAPS, cone_filter, taps_at
from azee.capture.tracking import Tracked, roughness_of, speed_of, tracked

Method: TypeAlias = Literal["regression", "nearest"]

SURE_M = 0.001
"""How far a recorded marker may be off its bone without cost."""
LEAST_SEEN = 0.5
"""Share of frames in which the root has to be seen."""
SIZE = 0.15
"""By how much the root's markers may be farther apart than the model's."""
SMOOTHER = 10.0
"""Factor of the cost of rough joints: by 1, noise of a millimetre made fitted markers jump by 6.8
mm within a hundredth of a second, by 10 by 4.4, and errors grow by .006 mm."""
NOISY = 1.5
"""Markers that are rougher than the model's by this factor are noisy: the ridge allows for it."""
FAST = 4.0
"""Recordings that are faster than the model's by this factor have another rate than they say."""


@dataclass(frozen=True, eq=False)
class Reconstruction:
    """A hand in T frames.

    names, foretold: M markers and where they were foretold, (T, M, 3) in the root's frame. fitted:
    (T, m, 3) those on digits on the hand that was fitted, in the root's frame; digits: their names.
    postures: (T, V) of the model's body. known: recorded markers on digits; off_m: (T, k) what each
    is off on the fitted hand, NaN where it was not seen. rate_hz. root: the frame. tracked: what
    was done to the recorded markers, root's included. notes: for whoever uses it.
    """

    names: tuple[str, ...]
    foretold: Floats
    digits: tuple[str, ...]
    fitted: Floats
    postures: Floats
    known: tuple[str, ...]
    off_m: Floats
    rate_hz: float
    root: InRoot
    tracked: Tracked
    notes: tuple[str, ...]

    def report(self) -> dict[str, Any]:
        """Return what markers are off, and what was done to them, as docs/formats.md has it."""
        gaps = self.tracked.gaps[:, : len(self.known)]
        return {
            "frames": len(self.postures),
            "rate_hz": self.rate_hz,
            "root": {
                "off_m": float(self.root.off_m[self.root.measured].mean()),
                "guessed_frames": int((~self.root.measured).sum()),
            },
            "relabelled_frames": int(self.tracked.relabelled.sum()),
            "markers": {
                name: {
                    "mean_off_m": _mean(self.off_m[:, k]),
                    "max_off_m": _most(self.off_m[:, k]),
                    "missing_frames": int(gaps[:, k].sum()),
                }
                for k, name in enumerate(self.known)
            },
        }


def reconstruct(
    markers: Markers,
    model: CaptureModel,
    *,
    method: Method = "regression",
    coupled: bool = False,
    sparse: Sequence[str] | None = None,
) -> Reconstruction:
    """Return the hand of a recording.

    Args: markers: some of the model's, at least the root's. coupled: whether the last joints of
        fingers follow equation 2.1. sparse: markers on digits to use, of those recorded; by default
        those that the model chose.
    Raises: MarkersError: markers are missing, of another hand, or of another rate than they say.
    """
    markers = named_like(markers, model.names)
    wanted = model.chosen if sparse is None else tuple(sparse)
    known = tuple(name for name in wanted if name in markers.names)
    if not known:
        raise MarkersError(
            f"none of the markers {', '.join(wanted)} is there; there are: "
            f"{', '.join(markers.names)}",
            "--label NEW=OLD renames markers",
        )
    missing = [name for name in wanted if name not in markers.names]
    notes = [f"without {', '.join(missing)}, which is not recorded"] if missing else []
    used = (*known, *model.root.names)
    root = into_root(markers.only(used), model.root)
    _check_size(markers, root, model)
    track = tracked(root.positions, markers.rate_hz)
    _check_speed(track, markers.rate_hz, used, model)
    at, angles = foretell(track, used, model, markers.rate_hz, method)
    hand = model.hand(coupled)
    reference = np.tile(hand.limits.idle, (len(at), 1))
    reference[:, hand.columns] = angles
    columns = model.columns(model.digits)
    targets, off = at[:, columns].copy(), model.off_m[columns]
    noise = _noise_m(model, track)
    sure = SURE_M**2 / (SURE_M**2 + 3.0 * noise**2)
    for k, name in enumerate(known):
        m = model.digits.index(name)
        share = track.trust[:, k, None]
        apart = np.where(share > 0.0, track.positions[:, k] - targets[:, m], 0.0)
        if noise:
            apart = cone_filter(apart, taps_at(markers.rate_hz, COMPONENT_TAPS))
        targets[:, m] += sure * share * apart
        off[m] = SURE_M
    shape = model.shape
    postures = HandFit(hand, shape).solved(
        shape.into_palm(targets),
        hand.completed(reference),
        markers.rate_hz,
        off_m=off,
        smooth=SMOOTHER,
    )
    fitted = shape.into_root(hand.marker_positions(shape, postures))
    of_known = [model.digits.index(name) for name in known]
    residual = np.linalg.norm(fitted[:, of_known] - track.positions[:, : len(known)], axis=-1)
    residual[track.gaps[:, : len(known)]] = np.nan
    if track.relabelled.any():
        notes.append(f"markers were swapped in {int(track.relabelled.sum())} frames; put right")
    lacking = int((~root.measured).sum())
    if lacking:
        notes.append(f"the root is not seen whole in {lacking} frames")
    return Reconstruction(
        model.names, at, model.digits, fitted, postures, known, residual, markers.rate_hz, root,
        track, tuple(notes),
    )  # fmt: skip


def foretell(
    track: Tracked,
    used: Sequence[str],
    model: CaptureModel,
    rate_hz: float,
    method: Method = "regression",
) -> tuple[Floats, Floats]:
    """Return all markers (T, M, 3) in the root's frame and the digits' coordinates (T, C).

    By regression, principal components are foretold and smoothed by a cone (Wheatland 2016, section
    3.2.2); by nearest neighbours, the markers themselves (section 3.1.3).
    """
    flat = model.poses.reshape(len(model.poses), -1)
    samples = model.poses[:, model.columns(used)]
    if method == "nearest":
        rows = nearest_rows(samples, track.positions, track.trust)
        taps = taps_at(rate_hz, NEAREST_TAPS)
        at, angles = (cone_filter(of[rows], taps) for of in (flat, model.angles))
    else:
        taps = taps_at(rate_hz, COMPONENT_TAPS)
        values = [flat, model.angles]
        ridge = float(np.hypot(model.regression.ridge_m, _noise_m(model, track)))
        how = replace(model.regression, ridge_m=ridge)
        at, angles = through_components(how, samples, track.positions, track.trust, values, taps)
    return at.reshape(len(at), -1, 3), angles


def through_components(
    how: LocalRegression,
    samples: Floats,
    frames: Floats,
    trust: Floats,
    values: Sequence[Floats],
    taps: int = 1,
    count: int | None = None,
) -> list[Floats]:
    """Foretell several kinds of values (N, D) over their components, smoothed by a cone.

    Args: samples, frames, trust: as of `LocalRegression.foretell`. count: of components; by default
        all.
    """
    every = [principal_components(of, count) for of in values]
    components = [found.of(of) for found, of in zip(every, values, strict=True)]
    made = cone_filter(how.foretell(samples, frames, trust, np.hstack(components)), taps)
    ends = np.cumsum([of.shape[1] for of in components])[:-1]
    parts = np.split(made, ends, axis=1)
    return [found.back(part) for found, part in zip(every, parts, strict=True)]


def _noise_m(model: CaptureModel, track: Tracked) -> float:
    """Return the deviation of noise along an axis, metres; 0 where markers are hardly rougher."""
    usual, rough = float(model.provenance["roughness_m"]), roughness_of(track.positions)
    return 0.0 if rough < NOISY * usual else float((rough**2 - usual**2) ** 0.5)


def _check_size(markers: Markers, root: InRoot, model: CaptureModel) -> None:
    """Refuse a hand of another size. Raises: MarkersError."""
    if root.measured.mean() < LEAST_SEEN:
        raise MarkersError(
            f"the root is seen in {100 * root.measured.mean():.0f} % of the frames only"
        )
    at = markers.only(model.root.names).positions
    i, j = np.triu_indices(len(model.root.points), 1)
    apart = np.nanmedian(np.linalg.norm(at[:, i] - at[:, j], axis=-1), axis=0)
    ratio = float(np.nanmedian(apart / model.root.widths_m))
    if abs(ratio - 1.0) > SIZE:
        raise MarkersError(
            f"the root's markers are {_times(ratio)} times as far apart as the model's",
            "name the unit with --unit, or train a model of this hand with these markers",
        )


def _times(ratio: float) -> str:
    return f"{ratio:.3g}" if ratio < 100.0 else f"{ratio:,.0f}"


def _check_speed(track: Tracked, rate_hz: float, used: Sequence[str], model: CaptureModel) -> None:
    """Refuse a rate that makes fingers too fast. Raises: MarkersError."""
    ours = speed_of(track.positions, rate_hz)
    theirs = float(model.provenance["speed_m_s"])
    if ours > FAST * theirs:
        raise MarkersError(
            f"markers move {ours / theirs:.0f} times as fast as in the recordings of the model",
            f"it says {rate_hz:g} frames a second: name the right rate with --rate",
        )


def _mean(values: Floats) -> float | None:
    known = values[~np.isnan(values)]
    return float(known.mean()) if len(known) else None


def _most(values: Floats) -> float | None:
    known = values[~np.isnan(values)]
    return float(known.max()) if len(known) else None
