"""Dots and labels on a picture of a body: labels at the sides, with a line to each dot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from azee.export.pictures.camera import Camera, projected
from azee.export.pictures.picture import depth_map, render
from azee.export.pictures.typeface import typeface
from azee_rig.mesh import BodyMesh

Floats = NDArray[np.float64]

INK = (20, 20, 40)
DOT = (214, 32, 40)
LINE = (110, 110, 130)
FONT_PX = 11
MARGIN_PX = 96
"""Width of the columns of labels on both sides."""
NEAR_M = 0.004
"""How far behind the visible surface a point may be and still count as visible."""
UNSEEN = -2.0


@dataclass(frozen=True, eq=False, slots=True)
class Mark:
    """A point of the surface with its label; point and outward normal (3,) in the world."""

    label: str
    point: Floats
    normal: Floats


@dataclass(frozen=True, eq=False, slots=True)
class View:
    """A posed body, vertices (N, 3), through a camera; the picture's size in pixels."""

    vertices: Floats
    mesh: BodyMesh
    camera: Camera
    size: tuple[int, int]

    def shown(self, marks: Sequence[Mark]) -> Floats:
        """Return how directly each point faces the eye, (n,): the cosine, or UNSEEN."""
        width, height = self.size
        points = np.array([mark.point for mark in marks]).reshape(-1, 3)
        normals = np.array([mark.normal for mark in marks]).reshape(-1, 3)
        to_eye = self.camera.eye - points
        distance = np.linalg.norm(to_eye, axis=1)
        facing = (normals * to_eye).sum(axis=1) / distance
        # In front of the skin, so that a dip of the skin does not hide it.
        screen, inverse = projected(points + 0.001 * normals, self.camera, width, height)
        column, row = (np.round(screen[:, k] - 0.5).astype(np.int64) for k in (0, 1))
        inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        nearest = np.full(len(points), np.inf)
        nearest[inside] = depth_map(self.vertices, self.mesh.triangles, self.camera, self.size)[
            row[inside], column[inside]
        ]
        seen = inside & (1.0 / inverse[:, 0] < nearest + NEAR_M)
        return np.where(seen, facing, UNSEEN)

    def drawn(self, marks: Sequence[Mark]) -> Image.Image:
        """Draw the body in pale colours, with dots and labels; a ring marks a hidden point."""
        width, height = self.size
        body = render(self.vertices, self.mesh, self.camera, self.size)
        body = Image.blend(body, Image.new("RGB", self.size, "white"), 0.45)
        image = Image.new("RGB", (width + 2 * MARGIN_PX, height), "white")
        image.paste(body, (MARGIN_PX, 0))
        if not marks:
            return image
        hidden = self.shown(marks) == UNSEEN
        screen, _ = projected(np.array([m.point for m in marks]), self.camera, width, height)
        places = screen[:, :2] + (MARGIN_PX, 0)
        draw = ImageDraw.Draw(image)
        font = typeface(FONT_PX)
        by_side = np.argsort(places[:, 0], kind="stable")
        half = (len(marks) + 1) // 2
        for left, chosen in ((True, by_side[:half]), (False, by_side[half:])):
            rows = _spread(places[chosen, 1], FONT_PX + 2.0, height)
            for i, row in zip(chosen, rows, strict=True):
                x, y = places[i]
                text = marks[i].label
                end = MARGIN_PX - 4 if left else MARGIN_PX + width + 4
                draw.line([(end, row), (x, y)], fill=LINE)
                at = end - 2 - draw.textlength(text, font) if left else end + 2
                draw.text((at, row - FONT_PX / 2 - 2), text, fill=INK, font=font)
                fill = None if hidden[i] else DOT
                draw.ellipse([x - 2.5, y - 2.5, x + 2.5, y + 2.5], fill=fill, outline=DOT)
        return image


def _spread(wanted: Floats, apart: float, height: int) -> Floats:
    """Return rows (n,) near the wanted ones, in their order, apart and within the picture."""
    if not len(wanted):
        return wanted
    order = np.argsort(wanted, kind="stable")
    steps = apart * np.arange(len(wanted))
    # Apart means that rows less their steps do not fall: the nearest such, by pooling neighbours.
    blocks: list[tuple[float, int]] = []
    for value in wanted[order] - steps:
        total, count = float(value), 1
        while blocks and blocks[-1][0] / blocks[-1][1] > total / count:
            before = blocks.pop()
            total, count = total + before[0], count + before[1]
        blocks.append((total, count))
    level = np.concatenate([np.full(count, total / count) for total, count in blocks])
    rows = np.empty(len(wanted))
    rows[order] = np.clip(level, apart, max(apart, height - apart - steps[-1])) + steps
    return rows
