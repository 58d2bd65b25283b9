"""A posture of the last result as a picture, in a file or in the terminal."""

from __future__ import annotations

import io
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from azee.formats import writing
from azee.repl.refusal import Refusal

if TYPE_CHECKING:
    from PIL.Image import Image

    from azee.compilation import Compilation

SIZE = (720, 900)
WIDEST = 72
"""Columns of a picture in the terminal. A row of text shows two of its rows."""


_SECONDS = re.compile(r"(\d+\.?\d*|\.\d+)s?", re.ASCII)


@dataclass(frozen=True, slots=True)
class Wish:
    """The time of the posture, the view, and the file for it, if any."""

    path: Path | None
    time_s: float | None
    view: str

    @classmethod
    def read(cls, argument: str) -> Wish:
        """Read `[FILE.png] [SECONDS] [VIEW]`. Raises: Refusal: the text has another form."""
        from azee.export.pictures.camera import VIEWS

        words = argument.split()
        path = time_s = None
        if words and words[0].lower().endswith(".png"):
            path = Path(words.pop(0)).expanduser()
        if words and (written := _SECONDS.fullmatch(words[0])):
            time_s = float(written[1])
            words.pop(0)
        view = " ".join(words) or "front"
        if view not in VIEWS:
            raise Refusal(f"there is no view `{view}`", f"the views are {', '.join(VIEWS)}")
        return cls(path, time_s, view)

    def at(self, made: Compilation) -> float:
        """Return the time on the score's line; by default that of a key posture in its middle.

        Raises: Refusal: it is after the end.
        """
        if self.time_s is not None:
            last_s = made.clip.duration_s - made.animation.lead_s
            if self.time_s > last_s:
                raise Refusal(
                    f"{self.time_s:g} s is after the end", f"the last posture is at {last_s:.2f} s"
                )
            return self.time_s
        times = made.animation.key_times
        key_s = times[len(times) // 2] if times else made.clip.duration_s / 2
        return key_s - made.animation.lead_s


def drawn(made: Compilation, wish: Wish, columns: int, rows: int) -> str:
    """Draw a posture; return its text for a terminal, empty if it was written to a file.

    Raises: AZeeError: cannot-write.
    """
    if wish.path is None:
        wide = min(columns, WIDEST, rows * 2 * SIZE[0] // SIZE[1])
        return half_blocks(_picture(made, wish, (wide, wide * SIZE[1] // SIZE[0] // 2 * 2)))
    from azee.export.files import replace_file

    data = io.BytesIO()
    _picture(made, wish, SIZE).save(data, "PNG", optimize=True)
    with writing(wish.path), replace_file(wish.path) as file:
        file.write(data.getvalue())
    return ""


def half_blocks(image: Image) -> str:
    """Return a picture as text: each character shows two pixels, one above the other.

    The codes are those of 24-bit colours (ISO 8613-6).
    """
    rows: list[str] = []
    pixels = image.convert("RGB").load()
    assert pixels is not None
    for y in range(0, image.height - 1, 2):
        cells = []
        for x in range(image.width):
            upper, lower = pixels[x, y], pixels[x, y + 1]
            assert isinstance(upper, tuple)
            assert isinstance(lower, tuple)
            ink = ";".join(map(str, upper))
            ground = ";".join(map(str, lower))
            cells.append(f"\033[38;2;{ink};48;2;{ground}m▀")
        rows.append(f"{''.join(cells)}\033[0m\n")
    return "".join(rows)


def _picture(made: Compilation, wish: Wish, size: tuple[int, int]) -> Image:
    import numpy as np

    from azee.export.pictures.picture import picture

    clip = made.clip
    frame = int(np.abs(clip.times - wish.at(made) - made.animation.lead_s).argmin())
    weights = dict(zip(clip.units, clip.unit_weights[frame], strict=True))
    return picture(made.rig, clip.coordinates[frame], wish.view, weights, size, samples=3)
