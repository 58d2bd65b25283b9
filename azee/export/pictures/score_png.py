"""The drawing of a score as PNG, with twice the resolution of the SVG."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path

from PIL import Image, ImageDraw

from azee.export.files import replace_file
from azee.export.pictures.score_drawing import score_drawing
from azee.export.pictures.shapes import Line, Rect, Shape, Text, Told
from azee.export.pictures.typeface import typeface
from azee.export.track_rows import Row
from azee.score.score import Score

FINE = 2
LARGEST_PX = 16000
"""Longest side of a picture; larger drawings get a lower resolution."""
BOXES: dict[str, tuple[tuple[str, ...], str]] = {
    "group": (("#ffffff", "#f4f7fb"), "#444444"),
    "leaf": (("#d3d3d3",), "#555555"),
    "hold": (("#eeeeee",), "#555555"),
    "blank": (("#ffffff",), "#888888"),
    "recorded": (("#f3dfc1",), "#8a5a14"),
    "track": (("#d9e5f2",), "#5b7fa6"),
}
"""Fill and outline of each kind; fills of groups alternate."""
INKS = {"grid": "#e3e3e3", "axis": "#222222", "key": "#b03a2e", "mark": "#1f4e86"}
TEXTS: dict[str, tuple[int, str, str]] = {
    "": (12, "#222222", "ls"),
    "caption": (13, "#222222", "ls"),
    "small": (11, "#555555", "ls"),
    "row": (11, "#222222", "rs"),
    "tick": (11, "#222222", "ms"),
    "number": (11, "#b03a2e", "ms"),
}
"""Size, ink and anchor of each kind."""
DASHES = {"key": (2, 3), "blank": (3, 3)}


def write_score_png(score: Score, path: str | Path, rows: Sequence[Row] = ()) -> None:
    """Draw a score, and rows of tracks, into a file.

    Raises: OSError: the file cannot be written.
    """
    data = io.BytesIO()
    score_image(score, rows).save(data, "PNG", optimize=True)
    with replace_file(path) as file:
        file.write(data.getvalue())


def score_image(score: Score, rows: Sequence[Row] = ()) -> Image.Image:
    """Return the drawing as a picture."""
    drawing = score_drawing(score, rows)
    fine = min(FINE, LARGEST_PX / max(drawing.width, drawing.height))
    image = Image.new("RGB", (round(drawing.width * fine), round(drawing.height * fine)), "white")
    pen = _Pen(ImageDraw.Draw(image), fine)
    for shape in drawing.shapes:
        pen.draw(shape)
    return image


class _Pen:
    def __init__(self, draw: ImageDraw.ImageDraw, fine: float) -> None:
        self._draw, self._fine = draw, fine

    def draw(self, shape: Shape) -> None:
        match shape:
            case Rect():
                self._box(shape)
            case Line(kind, x1, y1, x2, y2):
                self._line(x1, y1, x2, y2, INKS[kind], DASHES.get(kind), 2 if kind == "mark" else 1)
            case Text(text, x, y, kind):
                size, ink, anchor = TEXTS[kind]
                font = typeface(size * self._fine)
                line = text.replace("\n", " ")
                at = (x * self._fine, y * self._fine)
                self._draw.text(at, line, fill=ink, font=font, anchor=anchor)
            case Told(_, shapes):
                for inner in shapes:
                    self.draw(inner)

    def _box(self, box: Rect) -> None:
        fills, outline = BOXES[box.kind]
        k = self._fine
        left, top, right, bottom = (
            round(v * k) for v in (box.x, box.y, box.x + box.width, box.y + box.height)
        )
        corners = (left, top, max(right, left + 1), max(bottom, top + 1))
        fill = fills[box.shade % len(fills)]
        edge = None if box.kind in DASHES else outline
        self._draw.rounded_rectangle(corners, box.radius * k, fill=fill, outline=edge)
        if box.kind == "hold":
            self._stripes(box)
        if dash := DASHES.get(box.kind):
            x1, y1, x2, y2 = box.x, box.y, box.x + box.width, box.y + box.height
            for a, b, c, d in (
                (x1, y1, x2, y1),
                (x1, y2, x2, y2),
                (x1, y1, x1, y2),
                (x2, y1, x2, y2),
            ):
                self._line(a, b, c, d, outline, dash, 1)

    def _stripes(self, box: Rect) -> None:
        """Draw slanted lines inside a box, as the SVG does."""
        step = 6.0
        start = box.x - box.height
        for n in range(int((box.width + box.height) / step) + 1):
            x = start + n * step
            low, high = max(x, box.x), min(x + box.height, box.x + box.width)
            if low + 1 < high - 1:
                y = box.y + box.height
                self._line(
                    low + 1, y - (low + 1 - x), high - 1, y - (high - 1 - x), "#bbbbbb", None, 1
                )

    def _line(
        self,
        x1: float,
        y1: float,
        x2: float,
        y2: float,
        ink: str,
        dash: tuple[int, int] | None,
        width: int,
    ) -> None:
        """Draw a line; a dashed one is level or upright."""
        k = self._fine
        if dash is None:
            self._draw.line(
                (x1 * k, y1 * k, x2 * k, y2 * k), fill=ink, width=max(1, round(width * k / 2))
            )
            return
        length, along = max(abs(x2 - x1), abs(y2 - y1)), 0.0
        while along < length:
            a, b = along / length, min(along + dash[0], length) / length
            self._draw.line(
                (
                    (x1 + a * (x2 - x1)) * k,
                    (y1 + a * (y2 - y1)) * k,
                    (x1 + b * (x2 - x1)) * k,
                    (y1 + b * (y2 - y1)) * k,
                ),
                fill=ink,
            )
            along += sum(dash)
