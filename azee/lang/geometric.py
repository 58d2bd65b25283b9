"""Operands that vectors, points and paths share, and how their operators are declared."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from azee.lang.native import Group, Native, Operand, Option
from azee.lang.values import Kind


def number(name: str, meaning: str) -> Operand:
    """Return an operand that is a number."""
    return Operand(name, meaning, (Kind.NUMBER,))


def vector(name: str = "vector", meaning: str = "a vector") -> Operand:
    """Return an operand that is a vector."""
    return Operand(name, meaning, (Kind.VECTOR,))


def point(name: str = "point", meaning: str = "a point") -> Operand:
    """Return an operand that is a point."""
    return Operand(name, meaning, (Kind.POINT,))


BONE = Operand("bone", "such as `!palm(s)`", (Kind.BONE,))


def builds(node: Callable[..., Any]) -> Callable[..., Any]:
    """Return the function of an operator that puts its operands into a node, and no more."""
    return lambda at, *operands: node(*operands)


def geometric(
    name: str,
    meaning: str,
    operands: tuple[Operand, ...],
    result: Kind,
    function: Callable[..., Any],
    example: str,
    *,
    options: tuple[Option, ...] = (),
    uses_machine: bool = False,
    published: bool = False,
    only_name_published: bool = False,
) -> Native:
    """Return an operator of the geometry."""
    return Native(
        name,
        Group.GEOMETRY,
        meaning,
        operands,
        options,
        uses_machine=uses_machine,
        result=result,
        function=function,
        example=example,
        published=published,
        only_name_published=only_name_published,
    )
