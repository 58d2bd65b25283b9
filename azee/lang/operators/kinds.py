"""Questions after the kind of a value, so that an argument may be of several kinds."""

from __future__ import annotations

from collections.abc import Callable

from azee.lang.native import Group, Native, Occurrence, Operand
from azee.lang.values import Kind, Value

_VALUE = Operand("value", "a value of any kind", raw=True)


def _is(*kinds: Kind) -> Callable[[Occurrence, Value], bool]:
    return lambda at, value: value.kind in kinds


def _native(word: str, what: str, example: str, *kinds: Kind) -> Native:
    return Native(
        f"is-{word}",
        Group.LANGUAGE,
        f"Whether a value is {what}.",
        (_VALUE,),
        result=Kind.BOOLEAN,
        function=_is(*kinds),
        example=f"is-{word} {example}",
    )


OPERATORS = (
    _native("number", "a number", "52", Kind.NUMBER),
    _native("text", "a text", '"BAGDAD"', Kind.TEXT),
    _native("symbol", "a symbol", "'none", Kind.SYMBOL),
    _native("list", "a list", "(list 1 2)", Kind.LIST),
    _native("point", "a point; a site counts as one", "@CH", Kind.POINT, Kind.SITE),
    _native("constraints", "constraints", "(look ^fwd)", Kind.CONSTRAINTS),
    _native("score", "a score", ":bien", Kind.SCORE),
    _native(
        "rule", "an operator: a rule handed over as `.name`, or an `azop`", ".nb-5", Kind.OPERATOR
    ),
)
