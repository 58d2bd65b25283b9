"""Draws the pictures of tutorial.md: runs its commands in an empty folder and keeps what it shows.

The pictures are made smaller for the page: fewer pixels, and a palette of colours.
"""

from __future__ import annotations

import os
import re
import shlex
import sys
import tempfile
from pathlib import Path

from PIL import Image

from azee.cli.main import run

HERE = Path(__file__).parent
PICTURES = HERE / "pictures"
WIDEST = 1500
COLOURS = (200, 150, 100, 64)
"""Of palettes, of which the first is taken whose file has no more than `MOST_BYTES`."""
MOST_BYTES = 120_000
STEP = re.compile(r"^```(?:azee file=(\S+)[^\n]*|sh)\n(.*?)^```$", re.M | re.S)
SHOWN = re.compile(r"\]\(pictures/(\S+\.png)\)")


def main() -> int:
    """Draw them; returns the first exit code that is not zero."""
    page = (HERE / "tutorial.md").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for file, text in STEP.findall(page):
            if file:
                Path(file).write_text(text, encoding="utf-8", newline="\n")
                continue
            for line in filter(_draws, text.splitlines()):
                print(f"$ {line}", flush=True)
                if code := run(shlex.split(line)[1:]):
                    return code
        for name in SHOWN.findall(page):
            _keep(Path(name), PICTURES / name)
        os.chdir(HERE)
    return 0


def _draws(line: str) -> bool:
    return line.startswith("azee compile") and ".png" in line


def _keep(drawn: Path, kept: Path) -> None:
    image = Image.open(drawn).convert("RGB")
    if image.width > WIDEST:
        image = image.resize((WIDEST, round(image.height * WIDEST / image.width)))
    for colours in COLOURS:
        palette = image.quantize(colours, kmeans=2)
        few = image.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG)
        few.save(kept, optimize=True)
        if kept.stat().st_size <= MOST_BYTES:
            break
    print(f"{kept.name}: {kept.stat().st_size // 1000} kB")


if __name__ == "__main__":
    sys.exit(main())
