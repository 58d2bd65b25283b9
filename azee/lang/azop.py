"""The parts of an `azop`: parameters, defaults, body."""

from __future__ import annotations

from dataclasses import dataclass

from azee.lang.arguments import flattened
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.syntax import Application, Expr, Symbol

NO_DEFAULT = "nodefault"


@dataclass(frozen=True, slots=True)
class AzopShape:
    """Parameters with their default expressions (None where mandatory), and the body."""

    parameters: tuple[tuple[Symbol, Expr | None], ...]
    body: Expr | None
    problems: tuple[Diagnostic, ...]


def shape_of(application: Application) -> AzopShape:
    """Read `azop 'name default … body`.

    The problems are `missing-argument`, `expected-argument-name` and `duplicate-argument`.
    """
    operands = flattened(application)
    problems: list[Diagnostic] = []
    if len(operands) % 2 == 0:
        problems.append(_no_body(application, operands))
        body, pairs = None, operands[: len(operands) - len(operands) % 2]
    else:
        body, pairs = operands[-1], operands[:-1]
    parameters: dict[str, tuple[Symbol, Expr | None]] = {}
    for name, default in zip(pairs[::2], pairs[1::2], strict=True):
        if not isinstance(name, Symbol):
            message = "the name of a parameter, such as `'loc`, is expected here"
            problems.append(Diagnostic("expected-argument-name", message, name.span))
            continue
        if name.name in parameters:
            message = f"there are two parameters `'{name.name}`"
            problems.append(Diagnostic("duplicate-argument", message, name.span))
            continue
        mandatory = isinstance(default, Symbol) and default.name == NO_DEFAULT
        parameters[name.name] = (name, None if mandatory else default)
    return AzopShape(tuple(parameters.values()), body, tuple(problems))


def _no_body(application: Application, operands: tuple[Expr, ...]) -> Diagnostic:
    message = "this `azop` has no body"
    if operands:
        message += ": after its parameters, each with a default, one expression is expected"
    return Diagnostic(
        "missing-argument",
        message,
        application.head.span,
        help="a parameter that must be given has the default `'nodefault`",
    )
