"""The strip under a film: the blocks that are running, a row per level of nesting.

A running block is a chip with its name, filled as far as its time has passed. Siblings at the same
level share their row. Levels beyond the last row follow their outer block in that row.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from azee.clip.clip import Label
from azee.export.pictures.typeface import typeface

Pixels = NDArray[np.uint8]

ROWS = 4
INK, PAPER = (245, 247, 250, 255), (24, 28, 36, 255)
CHIPS = ((58, 82, 120), (44, 98, 96), (104, 76, 112), (110, 88, 52))
"""Colours of the levels."""


class Strip:
    """Draws the strip of one clip, always with the same height."""

    def __init__(self, labels: Sequence[Label], size: tuple[int, int]) -> None:
        """Args: size: of the whole picture, in pixels."""
        self.labels, self.width = tuple(labels), size[0]
        self.line = max(13, round(min(size[0] / 40, size[1] / 26)))
        depth = max((label.depth for label in labels), default=-1)
        self.rows = min(depth + 1, ROWS)
        self.height = self.rows * (self.line + 4) + 6 if self.rows else 0
        self._drawn: tuple[object, Pixels] | None = None

    def running(self, time_s: float) -> list[list[Label]]:
        """Return the labels that run at a time, by row; those of no length if they begin there."""
        rows: list[list[Label]] = [[] for _ in range(self.rows)]
        for label in self.labels:
            if label.start_s <= time_s < max(label.end_s, label.start_s + 1e-3):
                rows[min(label.depth, self.rows - 1)].append(label)
        return rows

    def draw(self, time_s: float) -> Pixels:
        """Return the strip at a time, (height, width, 4) opaque."""
        rows = self.running(time_s)
        key = tuple((id(label), self._filled(label, time_s)) for row in rows for label in row)
        if self._drawn is None or self._drawn[0] != key:
            self._drawn = key, self._picture(rows, time_s)
        return self._drawn[1]

    def _picture(self, rows: Sequence[Sequence[Label]], time_s: float) -> Pixels:
        image = Image.new("RGBA", (self.width, self.height), PAPER)
        pen = ImageDraw.Draw(image)
        font = typeface(round(self.line * 0.72))
        for n, row in enumerate(rows):
            left, top = 8, 4 + n * (self.line + 4)
            room = (self.width - 8) // max(1, len(row))
            gap = min(8, room // 3)
            for label in row:
                inside = (
                    "" if label.depth < self.rows else " › ".join(label.path[self.rows - 1 : -1])
                )
                text = _fitted(
                    f"{inside} › {label.text}" if inside else label.text, font, room - 24
                )
                width = min(room - gap, max(int(font.getlength(text)) + 18, self.line * 2))
                width = max(width, 1)
                colour = CHIPS[n % len(CHIPS)]
                box = (left, top, left + width, top + self.line)
                pen.rounded_rectangle(box, self.line // 4, fill=tuple(c // 2 for c in colour))
                filled = round(width * self._filled(label, time_s) / self.line / 8)
                if filled > 2:
                    pen.rounded_rectangle(
                        (left, top, left + filled, top + self.line), self.line // 4, fill=colour
                    )
                if width > 24:
                    pen.text(
                        (left + 9, top + self.line / 2), text, font=font, fill=INK, anchor="lm"
                    )
                left += width + gap
        return np.asarray(image)

    def _filled(self, label: Label, time_s: float) -> int:
        """Return how far a label's time has passed, in eighths of a line of its chip's width."""
        length = label.end_s - label.start_s
        share = (time_s - label.start_s) / length if length > 0 else 1.0
        return int(share * self.line * 8)


def _fitted(text: str, font: ImageFont.FreeTypeFont, room: float) -> str:
    if font.getlength(text) <= room:
        return text
    while text and font.getlength(f"{text}…") > room:
        text = text[:-1]
    return f"{text}…"
