"""Numbers and lists."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from azee.lang.application import applied
from azee.lang.arguments import Given
from azee.lang.machine import Machine
from azee.lang.native import Group, Native, Occurrence, Operand
from azee.lang.procedure import Applicable
from azee.lang.values import Kind, ListValue, NumberValue, Value


def _number(name: str, meaning: str = "a number") -> Operand:
    return Operand(name, meaning, (Kind.NUMBER,))


_LIST = Operand("list", "a list", (Kind.LIST,))
_OPERATOR = Operand("operator", "a rule such as `.name`, or an `azop`", (Kind.OPERATOR,))


def _finite(at: Occurrence, value: float) -> float:
    if math.isfinite(value):
        return value
    raise at.fault("number-range", "the result is too large for a number")


def _add(at: Occurrence, numbers: tuple[float, ...]) -> float:
    return _finite(at, sum(numbers))


def _mul(at: Occurrence, numbers: tuple[float, ...]) -> float:
    return _finite(at, math.prod(numbers))


def _sub(at: Occurrence, left: float, right: float) -> float:
    return _finite(at, left - right)


def _div(at: Occurrence, left: float, right: float) -> float:
    if right == 0:
        raise at.fault("division-by-zero", "this divides by zero", "divisor")
    return _finite(at, left / right)


def _quotient(at: Occurrence, dividend: float, divisor: float) -> float:
    return _finite(at, _divided(at, dividend, divisor)[0])


def _remainder(at: Occurrence, dividend: float, divisor: float) -> float:
    return _divided(at, dividend, divisor)[1]


def _divided(at: Occurrence, dividend: float, divisor: float) -> tuple[float, float]:
    if divisor == 0:
        raise at.fault("division-by-zero", "this divides by zero", "divisor")
    return divmod(dividend, divisor)


MOST_DIGITS = 15
"""Of a whole number that a float64 has exactly."""


def _digits(at: Occurrence, number: float) -> Value:
    if number != int(number) or not 0 <= number < 10**MOST_DIGITS:
        message = f"`digits` wants a whole number from 0, of {MOST_DIGITS} digits at most"
        raise at.fault("number-range", message, "number")
    digits = tuple(NumberValue(float(digit)) for digit in str(int(number)))
    return ListValue(digits, len(digits) + 1, 2)


def _neg(at: Occurrence, number: float) -> float:
    return -number


def _list(at: Occurrence, values: tuple[Value, ...]) -> tuple[Value, ...]:
    return values


def _nth(at: Occurrence, values: tuple[Value, ...], index: float) -> Value:
    if index != int(index) or not 1 <= index <= len(values):
        have = f"the list has the elements 1 to {len(values)}" if values else "the list is empty"
        raise at.fault("index-range", f"there is no element {index:g}: {have}", "index")
    return values[int(index) - 1]


def _count(at: Occurrence, values: tuple[Value, ...]) -> float:
    return float(len(values))


def _join(at: Occurrence, machine: Machine, lists: tuple[ListValue, ...]) -> Value:
    size = 1 + sum(part.size - 1 for part in lists)
    machine.require_size(size, at.span)
    values = tuple(value for part in lists for value in part.content)
    machine.spend(len(values), at.span)
    return ListValue(values, size, max((part.depth for part in lists), default=1))


def _part(
    at: Occurrence, machine: Machine, values: tuple[Value, ...], first: float, last: float
) -> Value:
    count = len(values)
    for number, name in ((first, "first"), (last, "last")):
        if number != int(number) or not (1 <= number <= count or first > last):
            have = f"the list has the elements 1 to {count}" if count else "the list is empty"
            raise at.fault("index-range", f"there is no element {number:g}: {have}", name)
    chosen = values[int(first) - 1 : int(last)] if first <= last else ()
    machine.spend(len(chosen), at.span)
    return _listed(at, machine, [*chosen])


def _range(at: Occurrence, machine: Machine, first: float, last: float) -> Value:
    count = max(0, math.floor(last - first) + 1)
    machine.require_size(count + 1, at.span)
    machine.spend(count, at.span)
    return ListValue(tuple(NumberValue(first + k) for k in range(count)), count + 1, 2)


def _map(
    at: Occurrence, machine: Machine, operator: Applicable, values: tuple[Value, ...]
) -> Value:
    results: list[Value] = []
    for value in values:
        results.append(_on_element(at, machine, operator, (), value))
    return _listed(at, machine, results)


def _fold(
    at: Occurrence, machine: Machine, operator: Applicable, start: Value, values: tuple[Value, ...]
) -> Value:
    result = start
    for value in values:
        result = _on_element(at, machine, operator, (result,), value)
    return result


def _on_element(
    at: Occurrence,
    machine: Machine,
    operator: Applicable,
    before: tuple[Value, ...],
    element: Value,
) -> Value:
    span = at.span_of("operator")
    level = machine.enter(1, span)
    given = [Given(value, span) for value in (*before, element)]
    result = applied(machine, operator, given, span, at.origin)
    machine.depth = level
    return result


def _listed(at: Occurrence, machine: Machine, values: list[Value]) -> Value:
    size = 1 + sum(v.size for v in values)
    depth = 1 + max((v.depth for v in values), default=0)
    machine.require_size(size, at.span)
    machine.require_depth(depth, at.span)
    return ListValue(tuple(values), size, depth)


def _native(
    name: str,
    meaning: str,
    operands: tuple[Operand, ...],
    result: Kind | None,
    function: Callable[..., Any],
    example: str,
    *,
    uses_machine: bool = False,
    whole: bool = False,
) -> Native:
    return Native(
        name,
        Group.LISTS,
        meaning,
        operands,
        result=result,
        function=function,
        example=example,
        uses_machine=uses_machine,
        whole=whole,
    )


_NUMBERS = Operand("number", "two numbers or more", (Kind.NUMBER,), rest=True, least=2)

OPERATORS = (
    _native("add", "The sum of numbers.", (_NUMBERS,), Kind.NUMBER, _add, "add 1 2"),
    _native(
        "sub",
        "The first number minus the second.",
        (_number("left"), _number("right")),
        Kind.NUMBER,
        _sub,
        "sub 3 1",
    ),
    _native("mul", "The product of numbers.", (_NUMBERS,), Kind.NUMBER, _mul, "mul 2 3"),
    _native(
        "div",
        "The first number divided by the second.",
        (_number("dividend"), _number("divisor")),
        Kind.NUMBER,
        _div,
        "div 1 4",
    ),
    _native(
        "quotient",
        "How often the second number goes into the first: a whole number, rounded down.",
        (_number("dividend"), _number("divisor")),
        Kind.NUMBER,
        _quotient,
        "quotient 1984 100",
    ),
    _native(
        "remainder",
        "What is left of the first number when the second has been taken as often as it goes.",
        (_number("dividend"), _number("divisor")),
        Kind.NUMBER,
        _remainder,
        "remainder 1984 100",
    ),
    _native(
        "digits",
        "The decimal digits of a whole number, the highest first.",
        (_number("number", "a whole number from 0"),),
        Kind.LIST,
        _digits,
        "digits 52",
        whole=True,
    ),
    _native(
        "neg", "A number with the other sign.", (_number("number"),), Kind.NUMBER, _neg, "neg 1"
    ),
    _native(
        "list",
        "A list of values of any kind.",
        (Operand("value", "a value", rest=True, raw=True),),
        Kind.LIST,
        _list,
        "list 1 2 3",
    ),
    _native(
        "nth",
        "An element of a list; the first is number 1.",
        (_LIST, _number("index", "from 1")),
        None,
        _nth,
        "nth (list 'a 'b) 2",
        whole=True,
    ),
    _native(
        "count", "How many elements a list has.", (_LIST,), Kind.NUMBER, _count, "count (list 1 2)"
    ),
    _native(
        "join",
        "One list of the elements of several.",
        (Operand("list", "a list", (Kind.LIST,), rest=True, raw=True),),
        Kind.LIST,
        _join,
        "join (list 1 2) (list 3)",
        uses_machine=True,
        whole=True,
    ),
    _native(
        "part",
        "The elements of a list from one number to another, both included; none if the first "
        "number is the greater.",
        (_LIST, _number("first", "from 1"), _number("last", "from 1")),
        Kind.LIST,
        _part,
        "part (list 'a 'b 'c) 2 3",
        uses_machine=True,
        whole=True,
    ),
    _native(
        "map",
        "The list of what an operator gives for each element. The element goes to the first "
        "parameter that has no argument yet.",
        (_OPERATOR, _LIST),
        Kind.LIST,
        _map,
        "map (azop 'n 0 (mul ^n 2)) (list 1 2)",
        uses_machine=True,
        whole=True,
    ),
    _native(
        "fold",
        "What an operator makes of a start value and the first element, then of that and the "
        "second, and so on.",
        (_OPERATOR, Operand("start", "a value", raw=True), _LIST),
        None,
        _fold,
        "fold (azop 'sum 0 'n 0 (add ^sum ^n)) 0 (list 1 2)",
        uses_machine=True,
        whole=True,
    ),
    _native(
        "range",
        "The numbers from one to another, one apart, both included.",
        (_number("first"), _number("last")),
        Kind.LIST,
        _range,
        "range 1 3",
        uses_machine=True,
        whole=True,
    ),
)
