"""Draws the picture of mouthing.md: the signer's mouth at the height of each sound."""

from __future__ import annotations

import csv
import sys
import tempfile
from pathlib import Path

from PIL import Image, ImageDraw

import azee
from azee.cli.main import run
from azee.export.pictures.typeface import typeface
from azee_grammar import sounds

PICTURE = Path(__file__).parents[1] / "pictures" / "mouths.png"
TABLE = Path(sounds.__file__).parent / "data" / "visemes.csv"
SIZE, CROP = 560, (140, 310, 420, 500)
"""Pixels of the face that is drawn, and the part of it that is kept."""
CAPTION, COLUMNS, COLOURS = 30, 4, 256
MOUTH = "key(.5, cstr({}))"


def main() -> int:
    """Draw it; returns the first exit code that is not zero."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    shown: dict[str, str] = {}
    for row in rows:
        shown[row["morphs"]] = f"{shown.get(row['morphs'], '')} {row['sounds']}".strip()
    tiles = [_tile(morphs, names) for morphs, names in shown.items()]
    width, height = tiles[0].size
    lines = -(-len(tiles) // COLUMNS)
    whole = Image.new("RGB", (COLUMNS * width, lines * height), "white")
    for i, tile in enumerate(tiles):
        whole.paste(tile, (i % COLUMNS * width, i // COLUMNS * height))
    whole.quantize(COLOURS, kmeans=2).save(PICTURE, optimize=True)
    print(f"{PICTURE.name}: {PICTURE.stat().st_size // 1000} kB")
    return 0


def _tile(morphs: str, names: str) -> Image.Image:
    """Return the mouth of some morphs, with the sounds that look so below it."""
    words = morphs.split()
    pairs = zip(words[::2], words[1::2], strict=True)
    text = MOUTH.format(", ".join(f"morph('{name}, {weight})" for name, weight in pairs))
    made = azee.compile(expression=text, life=False)
    with tempfile.TemporaryDirectory() as folder:
        clip, face = str(Path(folder) / "a.npz"), Path(folder) / "a.png"
        made.save(clip)
        look = ["--camera", "face", "--at", f"{made.animation.lead_s + 0.25:.3f}"]
        run(["render", clip, *look, "--size", f"{SIZE}x{SIZE}", "--no-captions", "-o", str(face)])
        mouth = Image.open(face).convert("RGB").crop(CROP)
    tile = Image.new("RGB", (mouth.width, mouth.height + CAPTION), "white")
    tile.paste(mouth, (0, 0))
    place = (mouth.width / 2, mouth.height + CAPTION / 2)
    ImageDraw.Draw(tile).text(
        place, names.replace(" ", "  "), fill="black", font=typeface(18), anchor="mm"
    )
    return tile


if __name__ == "__main__":
    sys.exit(main())
