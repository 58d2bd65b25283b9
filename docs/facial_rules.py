"""Draws pictures/facial-rules.png: every facial rule at its apex, as it is performed.

python docs/facial_rules.py [OUT.png]
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image

from azee.compilation import perform
from azee.export.pictures.picture import contact_sheet, picture
from azee.lang.library import shipped_library
from azee.lang.program import evaluate_expression
from azee_rig.load import load_rig
from azee_rig.rig import Rig

FILES = ("core/aspects.azee", "core/attitudes.azee")
SIZE = (640, 720)
FACE = (110, 40, 530, 620)
"""What is shown of a picture, and how large it is in the end."""
SHOWN = (240, 331)
APEX_S = 0.75
"""Half-way through a sign of a second, which begins .25 s after its face."""


def names() -> Iterator[str]:
    """Yield the facial rules in the order of their names."""
    rules = shipped_library("core").namespace.rules.values()
    yield from sorted(r.name for r in rules if r.definition.span.source.name in FILES)


def apex(rig: Rig, name: str) -> Image.Image:
    """Draw a facial rule over a sign that asks nothing."""
    score = evaluate_expression(f":{name}(blank(1))").score
    made = perform(score, rig, fps=30, life=False)
    frame = int(np.abs(made.clip.times - made.animation.lead_s - APEX_S).argmin())
    weights = made.clip.unit_weights[frame]
    units = {unit: float(w) for unit, w in zip(made.clip.units, weights, strict=True)}
    whole = picture(rig, made.clip.coordinates[frame], "face", units, SIZE)
    return whole.crop(FACE).resize(SHOWN, Image.Resampling.LANCZOS)


def main(path: Path) -> None:
    """Draw the sheet."""
    rig = load_rig()
    sheet = contact_sheet([(name, apex(rig, name)) for name in names()], 6)
    sheet.quantize(256, method=Image.Quantize.MAXCOVERAGE).save(path, optimize=True)


if __name__ == "__main__":
    default = Path(__file__).parent / "pictures" / "facial-rules.png"
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else default)
