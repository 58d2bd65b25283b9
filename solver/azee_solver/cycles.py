"""How often a site goes round, or to and fro, on the path that a constraint gives it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from functools import lru_cache

from azee_solver.constraint import Constraint, Transpath
from azee_solver.geometry import (
    Arc,
    Around,
    Circle,
    Moving,
    Path,
    Slide,
    Straight,
    Through,
    Wave,
    Zigzag,
)


@lru_cache(maxsize=4096)
def cycles(constraint: Constraint) -> tuple[float, ...]:
    """Return the cycles of every path that a constraint moves on, from its start to its end.

    A turn of a circle is a cycle, and so is a wave, or two corners of a zigzag.
    """
    whole = (constraint.path,) if isinstance(constraint, Transpath) else ()
    inner = (part.path for part in parts(constraint) if isinstance(part, Moving))
    return tuple(n for path in (*whole, *inner) for n in _of(path))


def _of(path: Path) -> tuple[float, ...]:
    match path:
        case Circle(turns=turns) | Around(turns=turns):
            return (abs(turns),)
        case Wave(waves=waves):
            return (abs(waves),)
        case Zigzag(corners=corners):
            return (corners / 2.0,)
        case Slide(path=inner):
            return _of(inner)
        case Straight() | Arc() | Through():
            return ()


def parts(node: object) -> Iterator[object]:
    """Yield a constraint and what it is made of, outermost first."""
    if isinstance(node, tuple):
        for item in node:
            yield from parts(item)
    elif is_dataclass(node):
        yield node
        for part in fields(node):
            yield from parts(getattr(node, part.name))
