"""The one typeface of pictures and films: the same letters on every machine, accents included.

Roboto Regular (Apache License 2.0), with Latin, Greek and Cyrillic; Pillow's own has no accents.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from PIL import ImageFont

FILE = Path(__file__).parent / "data" / "Roboto-Regular.ttf"


@lru_cache(maxsize=16)
def typeface(size_px: float) -> ImageFont.FreeTypeFont:
    """Return the typeface at a size in pixels."""
    return ImageFont.truetype(str(FILE), size_px, layout_engine=ImageFont.Layout.BASIC)


def fitted(text: str, font: ImageFont.FreeTypeFont, room: float) -> str:
    """Return a text, or as many of its words as fit beside `…` in so many pixels.

    A first word that does not fit itself is cut.
    """
    if font.getlength(text) <= room:
        return text
    words = text.split(" ")
    for count in range(len(words) - 1, 0, -1):
        shorter = " ".join(words[:count]).rstrip(" ,") + " …"
        if font.getlength(shorter) <= room:
            return shorter
    short = words[0]
    while short and font.getlength(f"{short}…") > room:
        short = short[:-1]
    return f"{short}…"
