"""Run by the tracker's own Python: `face_marks.py PICTURES.npz OUT.npy`.

Reads `pictures` (N, H, W, 3), RGB, and writes the 468 landmarks of the face that MediaPipe finds
in each, (N, 468, 3): pixels from the upper left, and a depth of the same scale, smaller towards
the camera. NaN where there is no face.
"""

from __future__ import annotations

import sys

import mediapipe  # type: ignore[import-not-found]
import numpy as np

LANDMARKS = 468


def main(pictures: str, out: str) -> None:
    """Look for the face in each picture, without regard to the one before."""
    with np.load(pictures) as data:
        seen = data["pictures"]
    found = np.full((len(seen), LANDMARKS, 3), np.nan)
    _, height, width, _ = seen.shape
    with mediapipe.solutions.face_mesh.FaceMesh(static_image_mode=True) as mesh:
        for marks, picture in zip(found, seen, strict=True):
            faces = mesh.process(picture).multi_face_landmarks
            if faces:
                rows = [(m.x * width, m.y * height, m.z * width) for m in faces[0].landmark]
                marks[:] = rows[:LANDMARKS]
    np.save(out, found)


if __name__ == "__main__":
    main(*sys.argv[1:])
