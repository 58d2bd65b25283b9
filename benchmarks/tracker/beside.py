"""Our landmarks beside those that the tracker sees in our film.

`python -m benchmarks.tracker.beside [EXPRESSION]`: a text is filmed, MediaPipe looks for the
person, and its points are compared with those that `azee export landmarks` writes for the same
camera. Distances are centimetres at the signer: pixels by the width of the shoulders.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from azee.compilation import perform
from azee.export.landmarks.layout import BODY, HAND
from azee.export.landmarks.view import Landmarks, View, landmarks
from azee.export.pictures.film import write_film
from azee.lang.program import evaluate_expression
from azee.quality.signing_dynamics import SHOULDERS_M
from azee_rig.load import load_rig
from benchmarks.tracker.environment import OUT, interpreter, track
from benchmarks.tracker.filmed import FPS, LOOK

Floats = NDArray[np.float64]

TEXT = ":bonjour"
ABOVE_HIPS = BODY.index("LEFT_HIP")
"""Points from here on are not in the picture, or stand still."""


def distances(ours: Landmarks, tracked: dict[str, Floats]) -> Iterator[tuple[str, int, float]]:
    """Yield names of points, the frames in which both have them, and median distances in cm."""
    body, _ = ours.component("POSE_LANDMARKS")
    shoulders = body[:, BODY.index("LEFT_SHOULDER")] - body[:, BODY.index("RIGHT_SHOULDER")]
    cm = 100.0 * SHOULDERS_M / float(np.median(np.linalg.norm(shoulders[:, :2], axis=1)))
    parts = (
        ("POSE_LANDMARKS", "pose", BODY[:ABOVE_HIPS], ""),
        ("LEFT_HAND_LANDMARKS", "left", HAND, "left "),
        ("RIGHT_HAND_LANDMARKS", "right", HAND, "right "),
    )
    for component, key, names, side in parts:
        values, confidence = ours.component(component)
        frames = min(len(values), len(tracked[key]))
        for n, name in enumerate(names):
            seen = tracked[key][:frames, n]
            both = np.isfinite(seen).all(axis=1) & (confidence[:frames, n] > 0.0)
            apart = np.linalg.norm(seen - values[:frames, n, :2], axis=1)[both]
            median = float(cm * np.median(apart)) if len(apart) else np.nan
            yield f"{side}{name}", len(apart), median


def main(arguments: Sequence[str] | None = None) -> int:
    """Print a line per point."""
    text = (arguments or [TEXT])[0]
    rig, folder = load_rig(), OUT / "tracker"
    folder.mkdir(parents=True, exist_ok=True)
    clip = perform(evaluate_expression(text).score, rig).clip
    film, found = folder / "beside.mp4", folder / "beside.npz"
    write_film(clip, rig, film, LOOK, fps=FPS)
    track(interpreter(), film, found)
    ours = landmarks(clip, rig, View("front", LOOK.size, FPS))
    with np.load(found) as data:
        tracked = {key: data[key] for key in ("pose", "left", "right")}
    print(f"{text}: {len(ours.values)} frames")
    for name, frames, cm in distances(ours, tracked):
        print(f"{name:<26}{frames:>5} frames {cm:7.1f} cm")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
