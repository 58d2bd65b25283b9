"""Which letters of ASL an eye trained on people reads in ours: `benchmarks.tracker.letters`.

Draws every letter that stands still from three sides, finds the hand by MediaPipe Hands, and asks a
classifier that has learnt from people's landmarks alone (`read_letters`). Those landmarks do not
ship: `--people FILE.npz` names them. J and Z are told by the path of their finger, in
tests/spelling.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from azee.compilation import perform, score_of
from azee.export.pictures.camera import from_direction
from azee.export.pictures.picture import render
from azee.lang.program import load
from azee_grammar.source import Source
from azee_rig.load import load_rig
from azee_rig.rig import Rig
from benchmarks.ik.elsewhere import NotThere
from benchmarks.tracker.environment import OUT, interpreter

READ = Path(__file__).with_name("read_letters.py")
STILL = "ABCDEFGHIKLMNOPQRSTUVWXY"
SIDES = ((-0.45, 0.1, 1.0), (0.0, 0.1, 1.0), (0.55, 0.1, 1.0))
HALF_M, PIXELS = 0.21, 480
"""The hand takes about as much of the picture as in those that the landmarks were found in."""


def drawn(letter: str, rig: Rig, folder: Path) -> Iterator[Path]:
    """Draw a letter in the middle of its hold from every side."""
    score = score_of(load(Source(letter, f"use 'asl\n:letter-{letter} 'hold .4")), None, None)
    made = perform(score, rig, life=False)
    middle = made.report.lead_s + float(made.score.duration) / 2.0
    q = made.clip.coordinates[int(np.abs(made.clip.times - middle).argmin())]
    frames = rig.chain.frames(q)
    palm = rig.bones["palm_R"].node
    target = frames.positions[palm] + 0.06 * frames.rotations[palm][:, 1]
    vertices = rig.skin(rig.pose(q))
    for number, side in enumerate(SIDES):
        path = folder / f"{letter}{number}.png"
        eye = from_direction(target, np.array(side), HALF_M)
        render(vertices, rig.mesh, eye, (PIXELS, PIXELS)).save(path)
        yield path


def main(arguments: Sequence[str] | None = None) -> int:
    """Print what each letter is read as; 1 if there is no tracker."""
    parser = argparse.ArgumentParser(prog="letters", description=__doc__)
    parser.add_argument("--people", type=Path, required=True, metavar="FILE.npz")
    parser.add_argument("--rig", default="signer")
    options = parser.parse_args(arguments)
    folder = OUT / "letters"
    folder.mkdir(parents=True, exist_ok=True)
    rig = load_rig(options.rig)
    paths = {letter: [*drawn(letter, rig, folder)] for letter in STILL}
    try:
        python = interpreter()
    except NotThere as error:
        print(f"no tracker: {error}", file=sys.stderr)
        return 1
    pictures = [str(path) for each in paths.values() for path in each]
    done = subprocess.run(
        [str(python), str(READ), str(options.people), *pictures],
        capture_output=True,
        text=True,
        check=True,
    )
    told = json.loads(done.stdout)
    right = 0
    for letter, each in paths.items():
        read = [told["letters"][str(path)] or "–" for path in each]
        right += read.count(letter) >= 2
        print(f"{letter}  {' '.join(read)}{'' if read.count(letter) >= 2 else '  not read'}")
    print(f"{right} of {len(paths)} letters in two views of three; of people {told['people']:.0%}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
