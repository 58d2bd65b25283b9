"""Rules and `azop`s that can be applied."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from azee.lang.code import Code
    from azee.lang.values import Value


@dataclass(frozen=True, slots=True, eq=False)
class FormalParameter:
    """A parameter and its default; without a default it is mandatory."""

    name: str
    default: Code | None


@dataclass(frozen=True, slots=True, eq=False)
class Procedure:
    """A body with parameters, and the names that were visible at its definition.

    `rule` is the name of the production rule, None for an `azop` inside an expression.
    """

    rule: str | None
    parameters: tuple[FormalParameter, ...]
    body: Code
    names: Mapping[str, Value]


@dataclass(frozen=True, slots=True, eq=False)
class Applicable:
    """A procedure as a value, with the arguments that were already given.

    handed_over: whether it was a value, such as `.nb-5`, before it was applied.
    """

    procedure: Procedure
    bound: Mapping[str, Value]
    handed_over: bool = False

    @property
    def title(self) -> str:
        """How messages call it."""
        return f"`:{self.procedure.rule}`" if self.procedure.rule else "this `azop`"

    @property
    def open_parameters(self) -> tuple[FormalParameter, ...]:
        """Parameters that have no argument yet, in order."""
        return tuple(p for p in self.procedure.parameters if p.name not in self.bound)
