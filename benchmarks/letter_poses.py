"""Writes the ASL letter poses that ship, from landmarks of one signer's hand.

    cd azee/spelling/timing/data
    python …/benchmarks/letter_poses.py asl_landmarks.npz > asl_letter_poses.csv

The file has `landmarks` (N, 21, 3) and `letter` (N,), as the repository asl-ai (MIT licence) has
them: MediaPipe's landmarks in the picture, about 400 frames a letter.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from azee.spelling.timing.landmarks import JOINTS, joint_angles

ROUND = ("palm_tilt", "palm_turn")
"""Angles without an end, whose middle is that of their directions."""


def main(path: Path) -> None:
    """Print a table in degrees, a letter a row."""
    with np.load(path) as file:
        angles, letters = joint_angles(file["landmarks"]), file["letter"]
    print("# Medians over the frames of asl-ai (MIT licence); degrees; benchmarks/letter_poses.py")
    print(",".join(("letter", *JOINTS)))
    for letter in sorted(set(letters)):
        rows = angles[letters == letter]
        middle = np.median(rows, axis=0)
        for name in ROUND:
            column = JOINTS.index(name)
            middle[column] = np.angle(np.exp(1j * rows[:, column]).mean())
        print(",".join((letter, *(f"{value:.1f}" for value in np.degrees(middle)))))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
