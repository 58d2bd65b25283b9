"""Operators of the language itself: names, decisions, comparisons, applying rules."""

from __future__ import annotations

from typing import TYPE_CHECKING
from unicodedata import normalize

from azee.lang.application import Apply, not_an_operator
from azee.lang.arguments import Given, given_arguments
from azee.lang.code import Broken, Code
from azee.lang.control import Closure, If, Junction, Let, not_a_boolean
from azee.lang.form import Resolve, exactly
from azee.lang.native import Group, Native, Occurrence, Operand
from azee.lang.places import PATTERN as PLACES
from azee.lang.resolution import Steps, Visible
from azee.lang.values import Kind, TextValue, Value
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.syntax import Application, Expr, Symbol
from azee_solver.geometry import Side

if TYPE_CHECKING:
    from azee.lang.resolve import Resolver

_COMPARABLE = frozenset({Kind.NUMBER, Kind.SYMBOL, Kind.TEXT, Kind.SIDE, Kind.BOOLEAN})
_RELATIVE = frozenset({Side.STRONG, Side.WEAK})


def _azop(
    resolver: Resolver, expr: Application, operands: tuple[Expr, ...], visible: Visible
) -> Steps[Code]:
    parameters, body = yield from resolver.azop(expr, visible)
    return Closure(expr.span, parameters, body)


def _let(
    resolver: Resolver, expr: Application, operands: tuple[Expr, ...], visible: Visible
) -> Steps[Code]:
    if not exactly(3, resolver, expr, operands, _LET):
        yield from resolver.all(operands, visible)
        return Broken(expr.span)
    name, value, body = operands
    if not isinstance(name, Symbol):
        message = "`let` wants a name, such as `'x`, first"
        yield from resolver.all(operands[1:], visible)
        return resolver.broken(expr.span, Diagnostic("expected-argument-name", message, name.span))
    code = yield value, visible
    return Let(expr.span, name.name, code, (yield body, visible | {name.name}))


def _if(
    resolver: Resolver, expr: Application, operands: tuple[Expr, ...], visible: Visible
) -> Steps[Code]:
    codes = yield from resolver.all(operands, visible)
    if not exactly(3, resolver, expr, operands, _IF):
        return Broken(expr.span)
    if not _condition(resolver, codes[0], "if"):
        return Broken(expr.span)
    return If(expr.span, *codes)


def _junction(name: str, stop: bool) -> Resolve:
    def resolve(
        resolver: Resolver, expr: Application, operands: tuple[Expr, ...], visible: Visible
    ) -> Steps[Code]:
        codes = yield from resolver.all(operands, visible)
        if not codes:
            message = f"`{name}` lacks its conditions"
            return resolver.broken(
                expr.span, Diagnostic("missing-argument", message, expr.head.span)
            )
        fits = [_condition(resolver, code, name) for code in codes]
        if not all(fits):
            return Broken(expr.span)
        return Junction(expr.span, name, codes, stop)

    return resolve


def _condition(resolver: Resolver, code: Code, operator: str) -> bool:
    """Report a condition that can be no boolean."""
    if code.kind in (None, Kind.BOOLEAN):
        return True
    assert code.kind is not None
    resolver.report(*not_a_boolean(code.kind, operator, code.span).diagnostics)
    return False


def _apply(
    resolver: Resolver, expr: Application, operands: tuple[Expr, ...], visible: Visible
) -> Steps[Code]:
    if not operands:
        message = "`apply` lacks its operator"
        hint = f"it is written `{_APPLY}`"
        return resolver.broken(
            expr.span, Diagnostic("missing-argument", message, expr.head.span, help=hint)
        )
    operator = yield operands[0], visible
    given, problems = given_arguments(expr.operands[1:], expr.called, "`apply`", ("argument",))
    values = yield from resolver.all([argument.value for argument in given], visible)
    codes = tuple(
        Given(code, argument.span, argument.name, argument.name_span)
        for code, argument in zip(values, given, strict=True)
    )
    if operator.kind not in (None, Kind.OPERATOR):
        assert operator.kind is not None
        problems += not_an_operator(operator.kind, "apply", operator.span).diagnostics
    if problems:
        return resolver.broken(expr.span, *problems)
    return Apply(expr.span, operator, codes, resolver.origin(expr.head.span))


def _misplaced(name: str) -> Resolve:
    def resolve(
        resolver: Resolver, expr: Application, operands: tuple[Expr, ...], visible: Visible
    ) -> Steps[Code]:
        yield from resolver.all(operands, visible)
        message = f"`{name}` stands at the beginning of a line of the file, not in an expression"
        local = name in ("def", "places")
        hint = "local names are given with `let 'name value body`" if local else None
        return resolver.broken(
            expr.span, Diagnostic("unknown-operator", message, expr.head.span, help=hint)
        )

    return resolve


def _eq(at: Occurrence, left: Value, right: Value) -> bool:
    if left.kind is not right.kind:
        return False
    if left.kind not in _COMPARABLE:
        message = f"`eq` cannot compare {_plural(left.kind)}"
        raise at.fault("wrong-type", message, "right", label=f"this is {right.kind.value}")
    if isinstance(left.content, Side) and isinstance(right.content, Side):
        _require_same_kind_of_side(at, left.content, right.content)
    if isinstance(left, TextValue) and isinstance(right, TextValue):
        return normalize("NFC", left.content) == normalize("NFC", right.content)
    return left.content == right.content


def _require_same_kind_of_side(at: Occurrence, left: Side, right: Side) -> None:
    if (left in _RELATIVE) is not (right in _RELATIVE):
        raise at.fault(
            "wrong-type",
            f"`{left.value}` and `{right.value}` cannot be compared before the signer's dominant "
            "hand is known",
            "right",
        )


def _plural(kind: Kind) -> str:
    return kind.value if kind is Kind.CONSTRAINTS else f"{kind.value.split()[-1]}s"


def _lt(at: Occurrence, left: float, right: float) -> bool:
    return left < right


def _le(at: Occurrence, left: float, right: float) -> bool:
    return left <= right


def _not(at: Occurrence, value: bool) -> bool:
    return not value


_AZOP = "azop 'PARAMETER DEFAULT … BODY"
_LET = "let 'NAME VALUE BODY"
_IF = "if CONDITION THEN ELSE"
_APPLY = "apply OPERATOR 'ARGUMENT VALUE …"

_ANY = (Operand("left", "a value", raw=True), Operand("right", "a value", raw=True))
_NUMBERS = (
    Operand("left", "a number", (Kind.NUMBER,)),
    Operand("right", "a number", (Kind.NUMBER,)),
)


def _form(
    name: str,
    meaning: str,
    pattern: str,
    resolve: Resolve,
    example: str,
    result: Kind | None = None,
    published: bool = False,
) -> Native:
    return Native(
        name,
        Group.LANGUAGE,
        meaning,
        result=result,
        published=published,
        example=example,
        resolve=resolve,
        pattern=pattern,
    )


OPERATORS = (
    _form(
        "azop",
        "A rule without a name: parameters, each with a default or `'nodefault`, then a body. "
        "Defaults are evaluated at the call and see the parameters before them.",
        _AZOP,
        _azop,
        "azop 'loc ^Mssp (key .2 (place @I_TIP(s) ^loc))",
        Kind.OPERATOR,
        published=True,
    ),
    _form(
        "def",
        "At the beginning of a line: a rule of this file. The name is the rest of the line; "
        'entries such as `\'meaning "…"` and the body stand below.',
        "def NAME",
        _misplaced("def"),
        "",
    ),
    _form(
        "use",
        "At the beginning of a line: the rules of a library are in scope.",
        "use 'LIBRARY",
        _misplaced("use"),
        "",
    ),
    _form(
        "places",
        "At the beginning of a line: names for points in space, which all expressions of the file "
        "can use as `^name`. A point may be described by the names before it.",
        PLACES,
        _misplaced("places"),
        "",
    ),
    _form(
        "let",
        "The body, in which `^name` means the value.",
        _LET,
        _let,
        "let 'd .2 (blank ^d)",
    ),
    _form(
        "if",
        "One of two expressions; the other is not evaluated.",
        _IF,
        _if,
        "if (eq 1 1) (blank .1) (blank .2)",
    ),
    Native(
        "eq",
        Group.LANGUAGE,
        "Whether two numbers, symbols, texts, sides or booleans are equal. Values of different "
        "kinds are not.",
        _ANY,
        result=Kind.BOOLEAN,
        function=_eq,
        example="eq 'a 'a",
    ),
    Native(
        "lt",
        Group.LANGUAGE,
        "Whether the first number is less than the second.",
        _NUMBERS,
        result=Kind.BOOLEAN,
        function=_lt,
        example="lt 1 2",
    ),
    Native(
        "le",
        Group.LANGUAGE,
        "Whether the first number is at most the second.",
        _NUMBERS,
        result=Kind.BOOLEAN,
        function=_le,
        example="le 1 2",
    ),
    _form(
        "and",
        "Whether all conditions hold; evaluated from the left until one does not.",
        "and CONDITION …",
        _junction("and", stop=False),
        "and (lt 1 2) (lt 2 3)",
        Kind.BOOLEAN,
    ),
    _form(
        "or",
        "Whether a condition holds; evaluated from the left until one does.",
        "or CONDITION …",
        _junction("or", stop=True),
        "or (lt 2 1) (lt 2 3)",
        Kind.BOOLEAN,
    ),
    Native(
        "not",
        Group.LANGUAGE,
        "The other boolean.",
        (Operand("condition", "a boolean", (Kind.BOOLEAN,)),),
        result=Kind.BOOLEAN,
        function=_not,
        example="not (lt 1 2)",
    ),
    _form(
        "apply",
        "What an operator gives for arguments: a rule handed over as `.name`, or an `azop`.",
        _APPLY,
        _apply,
        "apply .nb-5",
    ),
)
