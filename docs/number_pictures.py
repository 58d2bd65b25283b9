"""Draws pictures/numbers.png: twenty numbers, a still for each of their signs.

python docs/number_pictures.py [OUT.png]
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image

from azee.compilation import perform
from azee.export.pictures.picture import contact_sheet, picture
from azee.lang.program import evaluate_expression
from azee.score.score import Score, leaves
from azee_rig.load import load_rig
from azee_rig.rig import Rig

NUMBERS = (*range(10), 10, 14, 21, 52, 67, 100, 365, 1984, 2024, 250_000)
SIZE = (360, 450)
SIGNER = (52, 36, 308, 276)
"""What is shown of a picture, and how large it is in the end."""
SHOWN = (160, 150)
COLUMNS = 9
BEFORE_END_S = 0.1
"""Each sign is shown so long before it ends."""


def ends(score: Score) -> Iterator[float]:
    """Yield when the signs of a number end: leaves that end together are of one sign."""
    yield from sorted({float(leaf.interval.end) for leaf in leaves(score) if _of_a_sign(leaf.path)})


def _of_a_sign(path: tuple[str, ...]) -> bool:
    """Whether a leaf lasts as long as its sign: it is one, or what a sign keeps."""
    return path[-1] in ("PERM", "TENS", "UNITS") or path[-1].isdigit()


def stills(rig: Rig, number: int) -> Iterator[tuple[str, Image.Image]]:
    """Yield a picture of every sign of a number; the first has the number below it."""
    made = perform(evaluate_expression(f":number({number})").score, rig, fps=30, life=False)
    for n, end in enumerate(ends(made.score)):
        time = made.animation.lead_s + end - BEFORE_END_S
        frame = int(np.abs(made.clip.times - time).argmin())
        drawn = picture(rig, made.clip.coordinates[frame], size=SIZE)
        small = drawn.crop(SIGNER).resize(SHOWN, Image.Resampling.LANCZOS)
        yield f"{number:,}" if n == 0 else "", small


def main(path: Path) -> None:
    """Draw the sheet."""
    rig = load_rig()
    shown = [still for number in NUMBERS for still in stills(rig, number)]
    sheet = contact_sheet(shown, COLUMNS)
    sheet.quantize(128, method=Image.Quantize.MAXCOVERAGE).save(path, optimize=True)


if __name__ == "__main__":
    default = Path(__file__).parent / "pictures" / "numbers.png"
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else default)
