"""Pictures of a film with the tracker's landmarks drawn: for looking at what it took for what."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw

from azee.export.pictures.film import encoder

PICTURES = 6
COLOURS = {"pose": "yellow", "left": "red", "right": "blue"}
PEN = 2


def draw(film: Path, tracked: Path, out: Path) -> None:
    """Write some frames side by side, evenly spaced over the film, with what was found in each."""
    av: Any = encoder()
    with np.load(tracked) as data:
        marks = {name: data[name] for name in COLOURS}
    chosen = np.linspace(0, len(marks["pose"]) - 1, PICTURES + 2).round().astype(int)[1:-1]
    pictures = []
    with av.open(str(film)) as container:
        for number, frame in enumerate(container.decode(video=0)):
            if number in chosen:
                picture = Image.fromarray(frame.to_ndarray(format="rgb24"))
                pen = ImageDraw.Draw(picture)
                for name, colour in COLOURS.items():
                    for x, y in marks[name][number]:
                        if np.isfinite(x):
                            pen.ellipse((x - PEN, y - PEN, x + PEN, y + PEN), fill=colour)
                pictures.append(picture)
    width, height = pictures[0].size
    columns = PICTURES // 2
    sheet = Image.new("RGB", (columns * width, 2 * height))
    for n, picture in enumerate(pictures):
        sheet.paste(picture, (n % columns * width, n // columns * height))
    sheet.save(out)
