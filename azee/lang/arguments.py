"""Matches arguments with parameters, for rules and for operators passed as values."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from azee.lang.fault import did_you_mean
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.source import Span
from azee_grammar.syntax import Application, Expr, Named, OperatorName, Symbol

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Given(Generic[T]):
    """An argument as given; without a name, its position counts."""

    value: T
    span: Span
    name: str | None = None
    name_span: Span | None = None


def given_arguments(
    operands: Sequence[Expr | Named], called: bool, title: str, parameters: Collection[str]
) -> tuple[list[Given[Expr]], list[Diagnostic]]:
    """Read `'argument value` pairs, or the operands of a call.

    `parameters` are the known names of the rule's parameters, for suggestions in messages.
    """
    return _in_call(operands) if called else _in_pairs(operands, title, parameters)


def _in_call(operands: Sequence[Expr | Named]) -> tuple[list[Given[Expr]], list[Diagnostic]]:
    given: list[Given[Expr]] = []
    problems: list[Diagnostic] = []
    named = False
    for operand in operands:
        if isinstance(operand, Named):
            named = True
            value = operand.value
            given.append(Given(value, value.span, operand.name.name, operand.name.span))
        elif named:
            message = "an argument without a name cannot follow one with a name"
            problems.append(Diagnostic("positional-after-named", message, operand.span))
        else:
            given.append(Given(operand, operand.span))
    return given, problems


def _in_pairs(
    operands: Sequence[Expr | Named], title: str, parameters: Collection[str]
) -> tuple[list[Given[Expr]], list[Diagnostic]]:
    given: list[Given[Expr]] = []
    problems: list[Diagnostic] = []
    i = 0
    while i < len(operands):
        name = operands[i]
        astray = _astray(operands, i, parameters)
        if astray:
            problems.append(_open_operator(operands[i - 1], astray))
            i += len(astray)
            continue
        if not isinstance(name, Symbol):
            problems.append(_nameless(name, title, parameters))
            i += 1
            continue
        value = operands[i + 1] if i + 1 < len(operands) else None
        odd = (len(operands) - i) % 2 == 1
        if value is None or (odd and isinstance(value, Symbol) and value.name in parameters):
            message = f"`'{name.name}` has no value"
            problems.append(Diagnostic("missing-value", message, name.span))
            i += 1
            continue
        assert not isinstance(value, Named)
        given.append(Given(value, value.span, name.name, name.span))
        i += 2
    return given, problems


def _astray(
    operands: Sequence[Expr | Named], i: int, parameters: Collection[str]
) -> Sequence[Expr | Named]:
    """Return operands from `i` on that were meant for the operator before them on their line."""
    operator = operands[i - 1] if i else None
    if not isinstance(operator, Application) or operator.operands or operator.called:
        return ()
    if not isinstance(operator.head, OperatorName) or not parameters:
        return ()
    end = i
    while end < len(operands) and operands[end].span.line == operator.span.line:
        operand = operands[end]
        if isinstance(operand, Symbol) and operand.name in parameters:
            break
        end += 1
    return operands[i:end]


def _open_operator(operator: Expr | Named, astray: Sequence[Expr | Named]) -> Diagnostic:
    name = operator.span.text
    texts = [operand.span.text for operand in astray]
    inner = "…" if any("\n" in text for text in texts) else ", ".join(texts)
    return Diagnostic(
        "expected-argument-name",
        f"this stands beside `{name}`, not in it: the rest of the line belongs to the rule",
        astray[0].span.to(astray[-1].span),
        help=f"write `{name}({inner})`, or the operands of `{name}` one a line, deeper than it",
    )


def _nameless(operand: Expr | Named, title: str, parameters: Collection[str]) -> Diagnostic:
    if not parameters:
        message = f"{title} takes no arguments"
        return Diagnostic("too-many-arguments", message, operand.span)
    message = f"{title} takes arguments by name, and this has none"
    first = next(iter(parameters))
    return Diagnostic(
        "expected-argument-name",
        message,
        operand.span,
        help=f"write the argument's name before it, such as `'{first}`, or use a call: `name(…)`",
    )


def bound(
    title: str,
    parameters: Sequence[tuple[str, bool]],
    given: Sequence[Given[T]],
    span: Span,
    *,
    partial: bool = False,
) -> tuple[dict[str, T], list[Diagnostic]]:
    """Match arguments with parameters; each parameter says whether it is mandatory.

    `partial` leaves mandatory ones open, for a rule that is passed as a value. The problems are
    `too-many-arguments`, `unknown-argument`, `duplicate-argument` and `missing-argument`.
    """
    names = [name for name, _ in parameters]
    values: dict[str, T] = {}
    problems: list[Diagnostic] = []
    unknown = False
    for position, argument in enumerate(given):
        name = argument.name
        if name is None:
            if position >= len(names):
                problems.append(_surplus(title, names, argument.span))
                break
            name = names[position]
        elif name not in names:
            unknown = True
            problems.append(_unknown(title, names, name, argument.name_span or argument.span))
            continue
        if name in values:
            message = f"the argument `'{name}` of {title} is given twice"
            where = argument.name_span or argument.span
            problems.append(Diagnostic("duplicate-argument", message, where))
            continue
        values[name] = argument.value
    missing = tuple(name for name, mandatory in parameters if mandatory and name not in values)
    if missing and not partial and not unknown:
        problems.append(missing_argument(title, missing, span))
    return values, problems


def missing_argument(title: str, missing: Sequence[str], span: Span) -> Diagnostic:
    """Return the diagnostic of an application that lacks a mandatory argument."""
    names = " and ".join(f"`'{name}`" for name in missing)
    many = "s" if len(missing) > 1 else ""
    return Diagnostic("missing-argument", f"{title} lacks its argument{many} {names}", span)


def _surplus(title: str, names: Sequence[str], span: Span) -> Diagnostic:
    if not names:
        return Diagnostic("too-many-arguments", f"{title} takes no arguments", span)
    listed = ", ".join(f"`'{name}`" for name in names)
    message = f"{title} takes {len(names)} argument{'s' if len(names) > 1 else ''}: {listed}"
    return Diagnostic("too-many-arguments", message, span)


def _unknown(title: str, names: Sequence[str], name: str, span: Span) -> Diagnostic:
    if not names:
        return Diagnostic("too-many-arguments", f"{title} takes no arguments", span)
    hint = did_you_mean(name, names, "'")
    listed = ", ".join(f"`'{known}`" for known in names)
    message = f"{title} has no argument `'{name}`"
    return Diagnostic("unknown-argument", message, span, help=hint or f"it takes {listed}")


def flattened(application: Application) -> tuple[Expr, ...]:
    """Return the operands of a native operator: `'k = v` in a call equals `'k, v`."""
    flat: list[Expr] = []
    for operand in application.operands:
        if isinstance(operand, Named):
            flat += [operand.name, operand.value]
        else:
            flat.append(operand)
    return tuple(flat)
