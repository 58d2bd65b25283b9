"""Draws pictures/before-after.webp: texts as another checkout performs them, and as this one does.

    python docs/before_after.py --against DIR

DIR is a checkout of azee at an earlier commit. Both draw each text where the same share of their
own score is over.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from PIL import Image, ImageDraw

from azee.export.files import replace_path
from azee.export.pictures.typeface import typeface

HERE = Path(__file__).parent
ROOT = HERE.parent
PICTURE = HERE / "pictures" / "before-after.webp"
EXAMPLES = ROOT / "examples"
SIZE = 300, 330
COLUMNS = 4
LABEL_PX = 18
TEXTS: dict[str, tuple[str, float]] = {
    "rest": ("key .5 (cstr)", 0.5),
    "nb-6": (":nb-6", 0.5),
    "arbre": (":arbre", 0.5),
    "pays": (":pays", 0.5),
    "chat": (":chat", 0.5),
    "about-ref": (":about-ref('pt = ^Rssp, 'sig = :pays)", 0.6),
    "armoire": (":armoire", 0.5),
    "bien": (":bien", 0.6),
    "cinéma": (":cinéma", 0.5),
    "a nested negation": (":instance-of(:not-but(:chat, :bien), :mignon)", 0.3),
    "person-aged-52": (
        (EXAMPLES / "person-aged-52" / "person-aged-52.azee").read_text("utf-8"),
        0.8,
    ),
    "iraq-there": ((EXAMPLES / "iraq-there" / "iraq-there.azee").read_text("utf-8"), 0.5),
}
"""Texts by label, each with the share of its score at which it is drawn."""
CHILD = """
import sys, pathlib, azee
from azee.cli.main import run
folder, text, share, name, size = sys.argv[1:]
source = pathlib.Path(folder, name + ".azee")
source.write_text(text, encoding="utf-8")
made = azee.compile(source)
labels = made.clip.labels
start, end = (min(l.start_s for l in labels), max(l.end_s for l in labels)) if labels else (0, 1)
at = start + float(share) * (end - start)
sys.exit(run(["render", str(source), "-o", str(source.with_suffix(".png")),
              "--at", f"{at:.3f}", "--size", size]))
"""


def drawn(tree: Path, folder: Path) -> list[Image.Image]:
    """Return the pictures of all texts, drawn by a checkout."""
    folders = (tree, *(tree / part for part in ("rig", "solver", "grammar")))
    env = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, folders))}
    out = []
    for n, (text, share) in enumerate(TEXTS.values()):
        operands = [
            str(folder),
            text,
            str(share),
            f"{tree.name}-{n}",
            f"{2 * SIZE[0]}x{2 * SIZE[1]}",
        ]
        command = [sys.executable, "-c", CHILD, *operands]
        subprocess.run(command, check=True, cwd=folder, env=env, stdout=subprocess.DEVNULL)
        with Image.open(folder / f"{tree.name}-{n}.png") as picture:
            out.append(picture.convert("RGB").resize(SIZE, Image.Resampling.LANCZOS))
    return out


def sheet(before: Sequence[Image.Image], after: Sequence[Image.Image]) -> Image.Image:
    """Return pairs of pictures side by side, a label under each pair."""
    width, height = 2 * SIZE[0] + 12, SIZE[1] + LABEL_PX
    rows = -(-len(TEXTS) // COLUMNS)
    out = Image.new("RGB", (COLUMNS * width, rows * height), "white")
    pen, font = ImageDraw.Draw(out), typeface(13)
    for n, label in enumerate(TEXTS):
        x, y = n % COLUMNS * width, n // COLUMNS * height
        out.paste(before[n], (x, y))
        out.paste(after[n], (x + SIZE[0], y))
        pen.text((x + 4, y + SIZE[1]), f"{label}: before, after", fill="black", font=font)
    return out


def main(argv: Sequence[str] | None = None) -> None:
    """Draw the texts by both checkouts and write the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--against", type=Path, required=True, metavar="DIR")
    other = parser.parse_args(argv).against.resolve()
    with tempfile.TemporaryDirectory() as name:
        pictures = sheet(drawn(other, Path(name)), drawn(ROOT, Path(name)))
    with replace_path(PICTURE) as part:
        pictures.save(part, format="WEBP", quality=80, method=6)


if __name__ == "__main__":
    main()
