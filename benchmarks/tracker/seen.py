"""What a tracker has seen in a film, in the figures that recordings of people have."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from azee.quality.signing_dynamics import SHOULDERS_M, SigningDynamics, signing_dynamics
from benchmarks.tracker.filmed import FPS, Filmed

Array = NDArray[np.float64]

POSE = (11, 12, 15, 16, 0)
"""Left and right shoulder, left and right wrist, nose, among the tracker's points of a body."""


@dataclass(frozen=True, slots=True)
class Seen:
    """One film through the tracker's eye.

    found: share of the frames in which a hand is in view that it is found in, by side; none where
    it never is in view. face, pose: shares of all frames. apart_cm: median distance of the
    tracker's landmarks of hands from our joints, by side. tracked, own: the figures by the
    tracker's landmarks and by our own joints in the same pictures.
    """

    name: str
    frames: int
    found: dict[str, float | None]
    face: float
    pose: float
    apart_cm: dict[str, float | None]
    tracked: SigningDynamics
    own: SigningDynamics


def seen(name: str, film: Filmed, tracked: Path) -> Seen:
    """Compare what was tracked with what was filmed."""
    with np.load(tracked) as data:
        pose, face = data["pose"], data["face"]
        hands = {"L": data["left"], "R": data["right"]}
    there = ~np.isnan(pose[:, 0, 0])
    width = np.median(np.linalg.norm(film.body[:, 0] - film.body[:, 1], axis=1))
    found: dict[str, float | None] = {}
    apart: dict[str, float | None] = {}
    for side, points in hands.items():
        has, view = ~np.isnan(points[:, 0, 0]), film.in_view(side)
        found[side] = float(has[view].mean()) if view.any() else None
        gaps = np.linalg.norm(points - film.hands[side], axis=2)[has & view]
        apart[side] = float(100.0 * SHOULDERS_M * np.median(gaps) / width) if len(gaps) else None
    return Seen(
        name,
        len(pose),
        found,
        float(face.mean()),
        float(there.mean()),
        apart,
        signing_dynamics(pose[:, POSE], FPS),
        signing_dynamics(film.body, FPS),
    )
