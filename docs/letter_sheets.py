"""Draws pictures/letters-asl.png, -lsf.png and -tid.png: every letter of the manual alphabets.

    python docs/letter_sheets.py [asl|lsf|tid …]

Each is performed by the signer. Letters that stand still are shown from two sides, those that move
at two instants. What a letter misses is told.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image

from azee.compilation import Compilation, perform, score_of
from azee.export.pictures.camera import from_direction
from azee.export.pictures.picture import contact_sheet, render
from azee.lang.library import shipped_library
from azee.lang.program import load
from azee.spelling.text import LANGUAGES, Language
from azee_grammar.source import Source
from azee_rig.load import load_rig

PICTURES = Path(__file__).parent / "pictures"
HOLD_S = 0.4
SIDES = ((-0.35, 0.1, 1.0), (0.45, 0.1, 1.0))
WEAK_ALONE = frozenset("CILOPUV")
"""Letters of TID that the weak hand makes alone."""


def letters(language: Language) -> list[str]:
    """Return the letters of an alphabet in the order of its library."""
    rules = shipped_library(language).namespace.rules
    return [name.removeprefix("letter-") for name in rules if name.startswith("letter-")]


def hands_shown(language: Language, letter: str) -> str:
    """Return the sides of the hands that a letter of a right-handed signer needs."""
    if language != "tid":
        return "R"
    return "L" if letter in WEAK_ALONE else "LR"


def performed(language: Language, letter: str) -> Compilation:
    """Perform a letter."""
    text = f"use '{language}\n:letter-{letter} 'hold {HOLD_S}"
    return perform(score_of(load(Source(letter, text)), None, None), load_rig(), life=False)


def shown(made: Compilation, hands: str) -> list[Image.Image]:
    """Draw the hands at one instant from two sides, or at two instants from the front."""
    length = float(made.score.duration)
    moves = length > HOLD_S + 0.01
    out = []
    for share in (0.15, 0.95) if moves else (0.5,):
        instant = made.report.lead_s + share * length
        q = made.clip.coordinates[int(np.abs(made.clip.times - instant).argmin())]
        frames = made.rig.chain.frames(q)
        palms = [made.rig.bones[f"palm_{side}"].node for side in hands]
        middle = np.mean(
            [frames.positions[n] + 0.06 * frames.rotations[n][:, 1] for n in palms], axis=0
        )
        vertices = made.rig.skin(made.rig.pose(q))
        for side in ((0.0, 0.1, 1.0),) if moves else SIDES:
            eye = from_direction(middle, np.array(side), 0.13 if len(hands) == 1 else 0.16)
            out.append(render(vertices, made.rig.mesh, eye, (150, 150)))
    return out


def _beside(pictures: Sequence[Image.Image]) -> Image.Image:
    row = Image.new("RGB", (450, 150), "white")
    for number, each in enumerate(pictures):
        row.paste(each, (150 * number, 0))
    return row.crop((0, 0, 150 * len(pictures), 150))


def main(languages: Sequence[Language]) -> None:
    """Write the sheets."""
    for language in languages:
        rows = []
        for letter in letters(language):
            made = performed(language, letter)
            for missed in (c for c in made.report.constraints if c.missed):
                print(f"{language} {letter}: {missed.text}: {missed.reason}")
            rows.append((letter, _beside(shown(made, hands_shown(language, letter)))))
        sheet = contact_sheet(rows, 4)
        out = PICTURES / f"letters-{language}.png"
        sheet.quantize(256, method=Image.Quantize.MAXCOVERAGE, kmeans=1).save(out, optimize=True)


if __name__ == "__main__":
    main([name for name in LANGUAGES if not sys.argv[1:] or name in sys.argv[1:]])
