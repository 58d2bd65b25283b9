"""The values of AZee expressions: a closed union of frozen values.

Each kind of value is a class with one field, `content`. Compound values store the size and the
depth of their tree, so that sharing cannot hide growth (`let 'x (list ^x ^x)` doubles the size each
time) and code that walks a value stays bounded. code.py compares them with the limits when a value
is built.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, ClassVar, TypeAlias

from azee.score.score import Score
from azee_solver.constraint import Constraint
from azee_solver.geometry import Bone, Path, Point, Side, Site, Vector

if TYPE_CHECKING:
    from azee.lang.procedure import Applicable


class Kind(Enum):
    """The kinds of value; `.value` is the kind's name in messages and in the manual."""

    NUMBER = "a number"
    SYMBOL = "a symbol"
    TEXT = "a text"
    SIDE = "a side"
    BOOLEAN = "a boolean"
    BONE = "a bone"
    SITE = "a site"
    VECTOR = "a vector"
    POINT = "a point"
    PATH = "a path"
    LIST = "a list"
    CONSTRAINTS = "constraints"
    SCORE = "a score"
    OPERATOR = "an operator"


@dataclass(frozen=True, slots=True)
class NumberValue:
    """A finite float64."""

    content: float
    kind: ClassVar[Kind] = Kind.NUMBER
    size: ClassVar[int] = 1
    depth: ClassVar[int] = 1


@dataclass(frozen=True, slots=True)
class SymbolValue:
    """`'word`, without the apostrophe."""

    content: str
    kind: ClassVar[Kind] = Kind.SYMBOL
    size: ClassVar[int] = 1
    depth: ClassVar[int] = 1


@dataclass(frozen=True, slots=True)
class TextValue:
    """`"text"`."""

    content: str
    kind: ClassVar[Kind] = Kind.TEXT
    size: ClassVar[int] = 1
    depth: ClassVar[int] = 1


@dataclass(frozen=True, slots=True)
class SideValue:
    """`s`, `w`, `L` or `R`; strong and weak stay symbolic."""

    content: Side
    kind: ClassVar[Kind] = Kind.SIDE
    size: ClassVar[int] = 1
    depth: ClassVar[int] = 1


@dataclass(frozen=True, slots=True)
class BooleanValue:
    """The result of a comparison."""

    content: bool
    kind: ClassVar[Kind] = Kind.BOOLEAN
    size: ClassVar[int] = 1
    depth: ClassVar[int] = 1


@dataclass(frozen=True, slots=True)
class BoneValue:
    """`!palm s`."""

    content: Bone
    kind: ClassVar[Kind] = Kind.BONE
    size: ClassVar[int] = 1
    depth: ClassVar[int] = 1


@dataclass(frozen=True, slots=True)
class SiteValue:
    """`@I_TIP s`; stands for a point where a point is expected."""

    content: Site
    kind: ClassVar[Kind] = Kind.SITE
    size: ClassVar[int] = 1
    depth: ClassVar[int] = 1


@dataclass(frozen=True, slots=True)
class VectorValue:
    """A symbolic vector."""

    content: Vector
    size: int = 1
    depth: int = 1
    kind: ClassVar[Kind] = Kind.VECTOR


@dataclass(frozen=True, slots=True)
class PointValue:
    """A symbolic point."""

    content: Point
    size: int = 1
    depth: int = 1
    kind: ClassVar[Kind] = Kind.POINT


@dataclass(frozen=True, slots=True)
class PathValue:
    """A symbolic path."""

    content: Path
    size: int = 1
    depth: int = 1
    kind: ClassVar[Kind] = Kind.PATH


@dataclass(frozen=True, slots=True)
class ListValue:
    """Values in order; they may be of different kinds."""

    content: tuple[Value, ...]
    size: int = 1
    depth: int = 1
    kind: ClassVar[Kind] = Kind.LIST


@dataclass(frozen=True, slots=True)
class ConstraintsValue:
    """A constraint set; a single constraint is the set of one."""

    content: tuple[Constraint, ...]
    size: int = 1
    depth: int = 1
    kind: ClassVar[Kind] = Kind.CONSTRAINTS


@dataclass(frozen=True, slots=True)
class ScoreValue:
    """A score with exact times."""

    content: Score
    size: int = 1
    depth: int = 1
    kind: ClassVar[Kind] = Kind.SCORE


@dataclass(frozen=True, slots=True)
class OperatorValue:
    """A rule or an `azop`, possibly with some of its arguments already given."""

    content: Applicable
    size: int = 1
    depth: int = 1
    kind: ClassVar[Kind] = Kind.OPERATOR


Value: TypeAlias = (
    NumberValue
    | SymbolValue
    | TextValue
    | SideValue
    | BooleanValue
    | BoneValue
    | SiteValue
    | VectorValue
    | PointValue
    | PathValue
    | ListValue
    | ConstraintsValue
    | ScoreValue
    | OperatorValue
)

NONE = SymbolValue("none")
"""The value of an optional operand that is left out."""
