"""Expressions that do not evaluate all their operands once and in order, and local names."""

from __future__ import annotations

from dataclasses import dataclass

from azee.lang.code import Code, Names
from azee.lang.fault import Fault, fault
from azee.lang.machine import Machine, operator_value
from azee.lang.procedure import FormalParameter, Procedure
from azee.lang.values import BooleanValue, Kind, Value
from azee_grammar.source import Span


@dataclass(frozen=True, slots=True, eq=False)
class Let(Code):
    """`let 'name value body`."""

    span: Span
    name: str
    value: Code
    body: Code

    @property
    def kind(self) -> Kind | None:
        """The kind of its body."""
        return self.body.kind

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Evaluate the body, in which the name is visible."""
        level = machine.enter(2, self.span)
        value = self.value.evaluate(machine, names)
        result = self.body.evaluate(machine, {**names, self.name: value})
        machine.depth = level
        return result


@dataclass(frozen=True, slots=True, eq=False)
class If(Code):
    """`if condition a b`; only one of the two is evaluated."""

    span: Span
    condition: Code
    then: Code
    otherwise: Code

    @property
    def kind(self) -> Kind | None:
        """The kind of both branches, if it is the same."""
        return self.then.kind if self.then.kind is self.otherwise.kind else None

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Evaluate the branch that the condition selects."""
        level = machine.enter(2, self.span)
        branch = self.then if _truth(self.condition, "if", machine, names) else self.otherwise
        result = branch.evaluate(machine, names)
        machine.depth = level
        return result


@dataclass(frozen=True, slots=True, eq=False)
class Junction(Code):
    """`and`, `or`: evaluated from the left until the result is known."""

    span: Span
    name: str
    codes: tuple[Code, ...]
    stop: bool
    """The value that decides the result: false for `and`, true for `or`."""

    @property
    def kind(self) -> Kind:
        """Always a boolean."""
        return Kind.BOOLEAN

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Evaluate from the left."""
        level = machine.enter(1 + len(self.codes), self.span)
        answer = not self.stop
        for code in self.codes:
            if _truth(code, self.name, machine, names) is self.stop:
                answer = self.stop
                break
        machine.depth = level
        return BooleanValue(answer)


def _truth(code: Code, operator: str, machine: Machine, names: Names) -> bool:
    value = code.evaluate(machine, names)
    if isinstance(value, BooleanValue):
        return value.content
    raise not_a_boolean(value.kind, operator, code.span)


def not_a_boolean(kind: Kind, operator: str, span: Span) -> Fault:
    """Return the fault of a condition that is not a boolean."""
    return fault(
        "wrong-type",
        f"`{operator}` wants a boolean, not {kind.value}",
        span,
        label=f"this is {kind.value}",
        help="`eq`, `lt`, `le`, `and`, `or` and `not` give booleans",
    )


@dataclass(frozen=True, slots=True, eq=False)
class Closure(Code):
    """`azop` inside an expression: an operator that can use the names around it."""

    span: Span
    parameters: tuple[FormalParameter, ...]
    body: Code

    @property
    def kind(self) -> Kind:
        """Always an operator."""
        return Kind.OPERATOR

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Keep the names around it."""
        machine.spend(1, self.span)
        return operator_value(Procedure(None, self.parameters, self.body, names), {})


@dataclass(frozen=True, slots=True, eq=False)
class Guarded(Code):
    """An expression whose value must be of one kind, such as the body of `:#name`."""

    span: Span
    code: Code
    wanted: Kind
    message: str

    @property
    def kind(self) -> Kind:
        """The kind it must have."""
        return self.wanted

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Evaluate it and check the kind."""
        level = machine.enter(1, self.span)
        value = self.code.evaluate(machine, names)
        machine.depth = level
        if value.kind is not self.wanted:
            raise fault("wrong-type", f"{self.message}, not {value.kind.value}", self.span)
        return value
