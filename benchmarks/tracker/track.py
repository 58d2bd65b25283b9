"""Run by the tracker's own Python: `track.py FILM OUT.npz`.

Writes what MediaPipe Holistic finds in every frame, in pixels from the upper left: `pose`
(T, 33, 2), `left` and `right` hand of the signer (T, 21, 2), NaN where they are not found, and
`face` (T,), whether it is; `fps` and `size` of the film.
"""

from __future__ import annotations

import sys
from typing import Any

import av
import mediapipe  # type: ignore[import-not-found]
import numpy as np
from numpy.typing import NDArray


def points(found: Any, count: int, width: int, height: int) -> NDArray[np.float64]:
    """Landmarks in pixels, (count, 2)."""
    if found is None:
        return np.full((count, 2), np.nan)
    return np.array([[mark.x * width, mark.y * height] for mark in found.landmark])


def main(film: str, out: str) -> None:
    """Track a film."""
    rows: dict[str, list[Any]] = {"pose": [], "left": [], "right": [], "face": []}
    holistic = mediapipe.solutions.holistic.Holistic(static_image_mode=False, model_complexity=1)
    with holistic, av.open(film) as container:
        stream = container.streams.video[0]
        width, height = stream.width, stream.height
        for frame in container.decode(stream):
            found = holistic.process(frame.to_ndarray(format="rgb24"))
            rows["pose"].append(points(found.pose_landmarks, 33, width, height))
            rows["left"].append(points(found.left_hand_landmarks, 21, width, height))
            rows["right"].append(points(found.right_hand_landmarks, 21, width, height))
            rows["face"].append(found.face_landmarks is not None)
        fps = float(stream.average_rate or 0)
    found_in: dict[str, Any] = {name: np.array(each) for name, each in rows.items()}
    np.savez(out, fps=fps, size=(width, height), **found_in)


if __name__ == "__main__":
    main(*sys.argv[1:])
