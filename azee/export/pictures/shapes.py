"""The shapes of a drawing, for any medium. Places are in pixels, y points down."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias


@dataclass(frozen=True, slots=True)
class Rect:
    """A box; `kind` names its style and `shade` alternates with the depth of groups."""

    kind: str
    x: float
    y: float
    width: float
    height: float
    radius: float = 0.0
    shade: int = 0


@dataclass(frozen=True, slots=True)
class Line:
    """A straight line."""

    kind: str
    x1: float
    y1: float
    x2: float
    y2: float


@dataclass(frozen=True, slots=True)
class Text:
    """Text on a baseline at y; it begins, is centred or ends at x, by its style."""

    text: str
    x: float
    y: float
    kind: str = ""


@dataclass(frozen=True, slots=True)
class Told:
    """Shapes with a tooltip."""

    tip: str
    shapes: tuple[Shape, ...]


Shape: TypeAlias = Rect | Line | Text | Told


@dataclass(frozen=True, slots=True)
class Drawing:
    """A whole drawing on white paper; later shapes lie above earlier ones."""

    title: str
    width: float
    height: float
    shapes: tuple[Shape, ...]
