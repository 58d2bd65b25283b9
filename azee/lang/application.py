"""Applying rules: by name, partially, and as values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from azee.lang.arguments import Given, bound
from azee.lang.code import Code, Names, gathered
from azee.lang.fault import Fault, fault
from azee.lang.machine import HEAVY, Machine, operator_value
from azee.lang.procedure import Applicable
from azee.lang.values import Kind, OperatorValue, Value
from azee_grammar.source import Span
from azee_solver.constraint import Origin

if TYPE_CHECKING:
    from azee.lang.rule import Rule


@dataclass(frozen=True, slots=True, eq=False)
class RuleCall(Code):
    """`:name 'argument value`, with all arguments matched."""

    span: Span
    rule: Rule
    arguments: Mapping[str, Code]
    origin: Origin

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Evaluate the arguments, then the rule's body in the scope of the rule."""
        level = machine.enter(HEAVY + len(self.arguments), self.span)
        values = gathered(tuple(self.arguments.values()), machine, names)
        given = dict(zip(self.arguments, values, strict=True))
        result = machine.call(Applicable(self.rule.procedure, {}), given, self.span, self.origin)
        machine.depth = level
        return result


@dataclass(frozen=True, slots=True, eq=False)
class RuleReference(Code):
    """`.name`: the rule itself, with some or none of its arguments."""

    span: Span
    rule: Rule
    arguments: Mapping[str, Code]

    @property
    def kind(self) -> Kind:
        """Always an operator."""
        return Kind.OPERATOR

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Evaluate the given arguments; leave the others open."""
        level = machine.enter(1 + len(self.arguments), self.span)
        values = gathered(tuple(self.arguments.values()), machine, names)
        machine.depth = level
        given = dict(zip(self.arguments, values, strict=True))
        return operator_value(self.rule.procedure, given)


@dataclass(frozen=True, slots=True, eq=False)
class Apply(Code):
    """`apply OPERATOR 'argument value`: the operator is known only at evaluation."""

    span: Span
    operator: Code
    arguments: tuple[Given[Code], ...]
    origin: Origin

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Evaluate operator and arguments, match them, apply."""
        level = machine.enter(HEAVY + len(self.arguments), self.span)
        codes = (self.operator, *(a.value for a in self.arguments))
        operator, *values = gathered(codes, machine, names)
        if not isinstance(operator, OperatorValue):
            raise not_an_operator(operator.kind, "apply", self.operator.span)
        given = [
            Given(value, argument.span, argument.name, argument.name_span)
            for value, argument in zip(values, self.arguments, strict=True)
        ]
        result = applied(machine, operator.content, given, self.span, self.origin)
        machine.depth = level
        return result


def applied(
    machine: Machine,
    operator: Applicable,
    given: list[Given[Value]],
    span: Span,
    origin: Origin,
) -> Value:
    """Apply an operator to arguments, matched with its open parameters."""
    parameters = [(p.name, p.default is None) for p in operator.open_parameters]
    arguments, problems = bound(operator.title, parameters, given, span)
    if problems:
        raise Fault(*problems)
    return machine.call(operator, arguments, span, origin)


def not_an_operator(kind: Kind, name: str, span: Span) -> Fault:
    """Return the fault of something that cannot be applied."""
    return fault(
        "wrong-type",
        f"`{name}` wants an operator, not {kind.value}",
        span,
        label=f"this is {kind.value}",
        help="`.name` hands a rule over without applying it" if kind is Kind.SCORE else None,
    )
