"""Resolved expressions: what a syntax tree means once its names are known.

`resolve` makes them; they evaluate themselves. Each is evaluated with a machine, which counts what
is spent, and the names that are visible where it stands.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

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
        """The kind of the value where it is known beforehand."""
        return None

    @abstractmethod
    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Return the value. Raises: Fault."""


@dataclass(frozen=True, slots=True, eq=False)
class Constant(Code):
    """A literal, or an expression of literals that was evaluated once and for all."""

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
    """A parameter or a local name; that it is visible was settled when it was resolved."""

    span: Span
    name: str

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Look it up."""
        return names[self.name]


@dataclass(frozen=True, slots=True, eq=False)
class Broken(Code):
    """Stands where a mistake was reported."""

    span: Span

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Give up without another word."""
        raise Fault


def gathered(codes: Sequence[Code], machine: Machine, names: Names) -> list[Value]:
    """Evaluate all, and only then report what went wrong in any of them."""
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
    """A native operator with its operands.

    `operands` pairs each expression with the declaration it is matched to, in order of writing;
    `rest_at` is the number of the first operand that belongs to the rest, or None. Options follow
    the operands, named in `options`; `flags` holds those without a value.
    """

    span: Span
    native: Native
    at: Occurrence
    codes: tuple[Code, ...]
    declarations: tuple[Operand, ...]
    roles: tuple[str, ...]
    """What messages call each operand."""
    rest_at: int | None
    keywords: Mapping[int, str]
    """Which of `codes` are handed over by name, and under which."""
    settings: Mapping[str, object]
    """Arguments that need no evaluation: flags that are set, and defaults."""
    weight: int

    @property
    def kind(self) -> Kind | None:
        """The declared kind of the result."""
        return self.native.result

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Evaluate the operands, match them with what is declared, apply the function."""
        level = machine.enter(self.weight, self.span)
        values = gathered(self.codes, machine, names)
        positional, keywords = self._contents(values)
        native = self.native
        assert native.function is not None
        if native.uses_machine:
            result = native.function(self.at, machine, *positional, **keywords)
        else:
            result = native.function(self.at, *positional, **keywords)
        machine.depth = level
        if native.whole:
            value: Value = result
            return value
        assert native.result is not None
        return built(native.result, result, values, machine, self.span)

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
        if self.rest_at is not None:
            contents[self.rest_at :] = [tuple(contents[self.rest_at :])]
        return contents, keywords


_ATOMS: Mapping[Kind, Callable[[Any], Value]] = {
    Kind.NUMBER: NumberValue,
    Kind.SYMBOL: SymbolValue,
    Kind.TEXT: TextValue,
    Kind.SIDE: SideValue,
    Kind.BOOLEAN: BooleanValue,
}
_COMPOUNDS: Mapping[Kind, Callable[[Any, int, int], Value]] = {
    Kind.VECTOR: VectorValue,
    Kind.POINT: PointValue,
    Kind.PATH: PathValue,
    Kind.LIST: ListValue,
    Kind.CONSTRAINTS: ConstraintsValue,
    Kind.SCORE: ScoreValue,
}


def built(kind: Kind, content: Any, parts: Sequence[Value], machine: Machine, span: Span) -> Value:
    """Return the value of that kind, as large as its parts and one more."""
    atom = _ATOMS.get(kind)
    if atom is not None:
        return atom(content)
    size, depth = 1, 0
    for part in parts:
        size += part.size
        depth = max(depth, part.depth)
    machine.require_size(size, span)
    machine.require_depth(depth + 1, span)
    return _COMPOUNDS[kind](content, size, depth + 1)
