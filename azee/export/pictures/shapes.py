"""What a drawing is made of, whatever it is drawn on. Places are in pixels, y runs down."""

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
    """Words on a baseline at y, from x on, or about x or up to x as their style says."""

    text: str
    x: float
    y: float
    kind: str = ""


@dataclass(frozen=True, slots=True)
class Told:
    """Shapes that tell more when they are pointed at."""

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
