"""Run by the tracker's own Python: `read_letters.py PEOPLE.npz PICTURE…`; prints JSON.

A linear discriminant analysis that has learnt only from landmarks of people names the letter of
every picture: `{"people": share of a fifth of their frames, "letters": {PICTURE: LETTER or null}}`.
PEOPLE.npz: `landmarks` (N, 21, 3) of MediaPipe Hands in shares of pictures of 4:3, thumbs of the
hands on the left, and `letter` (N,). The fifth that is told apart is the last of each letter's.
"""

from __future__ import annotations

import json
import sys
from itertools import combinations

import mediapipe  # type: ignore[import-not-found]
import numpy as np
from numpy.typing import NDArray
from PIL import Image
from sklearn.discriminant_analysis import LinearDiscriminantAnalysis

ASPECT = 4.0 / 3.0
TIPS = (4, 8, 12, 16, 20)
TO_THUMB = (5, 6, 7, 8, 9, 10, 11, 12, 14, 16, 18, 20)
MOVING = ("J", "Z")


def features(hands: NDArray[np.float64]) -> NDArray[np.float64]:
    """Landmarks from the wrist on in lengths of the palm, and distances of thumb and tips.

    Args: hands: (N, 21, 2) in units that are equal along both axes. Returns: (N, 62).
    """
    hands = hands - hands[:, :1]
    length = np.linalg.norm(hands[:, 9], axis=-1)
    width = np.linalg.norm(hands[:, 5] - hands[:, 17], axis=-1)
    hands = hands / (length + width)[:, None, None]
    pairs = [*((4, k) for k in TO_THUMB), *combinations(TIPS, 2)]
    apart = [np.linalg.norm(hands[:, i] - hands[:, j], axis=-1) for i, j in pairs]
    return np.concatenate([hands[:, 1:].reshape(len(hands), -1), np.stack(apart, -1)], -1)


def main(people: str, pictures: list[str]) -> None:
    """Name the letters of the pictures."""
    with np.load(people) as data:
        letters = data["letter"]
        still = ~np.isin(letters, MOVING)
        seen, letters = data["landmarks"][still, :, :2].astype(float), letters[still]
    known = features(seen * [ASPECT, 1.0])
    last = np.concatenate(
        [
            rows[-len(rows) // 5 :]
            for x in np.unique(letters)
            for rows in [np.flatnonzero(letters == x)]
        ]
    )
    first = np.setdiff1d(np.arange(len(letters)), last)

    def learnt(rows: NDArray[np.int64]) -> LinearDiscriminantAnalysis:
        model = LinearDiscriminantAnalysis(solver="lsqr", shrinkage="auto")
        return model.fit(known[rows], letters[rows])

    share = float((learnt(first).predict(known[last]) == letters[last]).mean())
    reader = learnt(np.arange(len(letters)))
    named: dict[str, str | None] = {}
    tracker = mediapipe.solutions.hands.Hands(
        static_image_mode=True, max_num_hands=1, min_detection_confidence=0.1
    )
    with tracker:
        for path in pictures:
            with Image.open(path) as picture:
                pixels = np.ascontiguousarray(picture.convert("RGB"))
            found = tracker.process(pixels).multi_hand_landmarks
            if not found:
                named[path] = None
                continue
            marks = np.array([[-m.x, m.y] for m in found[0].landmark])
            named[path] = str(reader.predict(features(marks[None]))[0])
    print(json.dumps({"people": share, "letters": named}))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
