"""Resolved expressions: syntax trees whose names have been looked up.

`resolve` makes them, and they evaluate themselves. Evaluation takes a machine, which counts the
steps, and the names that are visible at the place of the expression.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from azee.lang.fault import Exhausted, Fault, together
from azee.lang.machine import Machine
from azee.lang.native import Native, Occurrence, Operand
from azee.lang.values import (
    BooleanValue,
    ConstraintsValue,
    Kind,
    ListValue,
    NumberValue,
    PathValue,
    PointValue,
    ScoreValue,
    SideValue,
    SymbolValue,
    TextValue,
    Value,
    VectorValue,
)
from azee_grammar.source import Span

Names = Mapping[str, Value]


class Code(ABC):
    """An expression that can be evaluated."""

    __slots__ = ()

    span: Span

    @property
    def kind(self) -> Kind | None:
        """The kind of the value, if it is known before evaluation."""
        return None

    @abstractmethod
    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Return the value. Raises: Fault."""


@dataclass(frozen=True, slots=True, eq=False)
class Constant(Code):
    """A literal, or an expression of literals that was evaluated once."""

    span: Span
    value: Value

    @property
    def kind(self) -> Kind:
        """The kind of its value."""
        return self.value.kind

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Return the value."""
        return self.value


@dataclass(frozen=True, slots=True, eq=False)
class Variable(Code):
    """A parameter or a local name; resolving has checked that it is visible."""

    span: Span
    name: str

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Look up its value."""
        return names[self.name]


@dataclass(frozen=True, slots=True, eq=False)
class Broken(Code):
    """Stands in the place of a reported mistake."""

    span: Span

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Stop evaluation without a second message."""
        raise Fault


def gathered(codes: Sequence[Code], machine: Machine, names: Names) -> list[Value]:
    """Evaluate all expressions, and only then report the faults of any of them."""
    values: list[Value] = []
    faults: list[Fault] = []
    depth = machine.depth
    for code in codes:
        try:
            values.append(code.evaluate(machine, names))
        except Exhausted:
            raise
        except Fault as problem:
            machine.depth = depth
            faults.append(problem)
    if faults:
        raise together(faults)
    return values


@dataclass(frozen=True, slots=True, eq=False)
class NativeCall(Code):
    """A native operator with its operands, each matched with its declaration.

    Options follow the operands; `keywords` says which of `codes` they are and under which name the
    function takes them, `settings` holds those that need no evaluation.
    """

    span: Span
    native: Native
    at: Occurrence
    codes: tuple[Code, ...]
    declarations: tuple[Operand, ...]
    roles: tuple[str, ...]
    """How messages call each operand."""
    rest_at: int | None
    """The number of the first of the repeated operands, if there are any."""
    keywords: Mapping[int, str]
    settings: Mapping[str, object]
    build: Build | None
    """Makes a value from the function's result; None if the result already is the value."""

    @property
    def kind(self) -> Kind | None:
        """The declared kind of the result."""
        return self.native.result

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Evaluate the operands, match them with the declaration, apply the function."""
        level = machine.enter(1 + len(self.codes), self.span)
        values: list[Value] = []
        contents: list[object] = []
        fits = not self.keywords
        for code, declaration in zip(self.codes, self.declarations, strict=True):
            try:
                value = code.evaluate(machine, names)
            except Exhausted:
                raise
            except Fault as problem:
                machine.depth = level + 1
                rest = self.codes[len(values) + 1 :]
                raise together((problem, *_faults(rest, machine, names))) from None
            values.append(value)
            if declaration.takes_as_is(value):
                contents.append(value if declaration.raw else value.content)
            else:
                fits = False
        keywords = self.settings
        if not fits:
            contents, keywords = self._contents(values)
        if self.rest_at is not None:
            contents[self.rest_at :] = [tuple(contents[self.rest_at :])]
        function = self.native.function
        assert function is not None
        if self.native.uses_machine:
            result = function(self.at, machine, *contents, **keywords)
        else:
            result = function(self.at, *contents, **keywords)
        machine.depth = level
        return result if self.build is None else self.build(result, values, machine, self.span)

    def _contents(self, values: list[Value]) -> tuple[list[object], dict[str, object]]:
        contents: list[object] = []
        keywords: dict[str, object] = dict(self.settings)
        faults: list[Fault] = []
        name = self.native.name
        for i, (value, declaration) in enumerate(zip(values, self.declarations, strict=True)):
            try:
                content = declaration.content(value, name, self.roles[i], self.codes[i].span)
            except Fault as problem:
                faults.append(problem)
                continue
            if i in self.keywords:
                keywords[self.keywords[i]] = content
            else:
                contents.append(content)
        if faults:
            raise together(faults)
        return contents, keywords


def _faults(codes: Sequence[Code], machine: Machine, names: Names) -> Iterator[Fault]:
    """Evaluate expressions only to find their faults."""
    try:
        gathered(codes, machine, names)
    except Exhausted:
        raise
    except Fault as problem:
        yield problem


Build: TypeAlias = Callable[[Any, Sequence[Value], Machine, Span], Value]


def _atom(make: Callable[[Any], Value]) -> Build:
    def build(content: Any, parts: Sequence[Value], machine: Machine, span: Span) -> Value:
        return make(content)

    return build


def _compound(make: Callable[[Any, int, int], Value]) -> Build:
    def build(content: Any, parts: Sequence[Value], machine: Machine, span: Span) -> Value:
        size, depth = 1, 0
        for part in parts:
            size += part.size
            depth = max(depth, part.depth)
        if size > machine.limits.size or depth >= machine.limits.depth:
            machine.require_size(size, span)
            machine.require_depth(depth + 1, span)
        return make(content, size, depth + 1)

    return build


BUILDS: Mapping[Kind, Build] = {
    Kind.NUMBER: _atom(NumberValue),
    Kind.SYMBOL: _atom(SymbolValue),
    Kind.TEXT: _atom(TextValue),
    Kind.SIDE: _atom(SideValue),
    Kind.BOOLEAN: _atom(BooleanValue),
    Kind.VECTOR: _compound(VectorValue),
    Kind.POINT: _compound(PointValue),
    Kind.PATH: _compound(PathValue),
    Kind.LIST: _compound(ListValue),
    Kind.CONSTRAINTS: _compound(ConstraintsValue),
    Kind.SCORE: _compound(ScoreValue),
}
"""How a value of each kind is made; the size of a compound value is that of its parts plus one."""
