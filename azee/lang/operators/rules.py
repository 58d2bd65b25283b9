"""Operators that find rules by texts."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from azee.lang.code import Broken, Code, Constant
from azee.lang.fault import Fault
from azee.lang.form import Resolve
from azee.lang.machine import Machine
from azee.lang.native import Group, Native, unknown_word
from azee.lang.resolution import Steps, Visible
from azee.lang.rule_by_name import HasRule, RuleByName, RuleText
from azee.lang.values import Kind
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.source import Span
from azee_grammar.syntax import Application, Expr, Symbol

if TYPE_CHECKING:
    from azee.lang.resolve import Resolver

_OF = "of"
_RULE = f"rule TEXT ['{_OF} 'LIBRARY]"
_HAS_RULE = f"has-rule TEXT ['{_OF} 'LIBRARY]"


def _by_name(pattern: str, code: Callable[[Span, RuleText], Code], *, needed: bool) -> Resolve:
    """Return how an operator whose operand names a rule is resolved.

    A rule that is needed is looked up at once where its name is a literal.
    """
    operator = pattern.partition(" ")[0]

    def resolve(
        resolver: Resolver, expr: Application, operands: tuple[Expr, ...], visible: Visible
    ) -> Steps[Code]:
        codes = yield from resolver.all(operands, visible)
        problem = _misshapen(operator, pattern, expr, operands)
        if problem is not None:
            return resolver.broken(expr.span, problem)
        name, library = codes[0], codes[2] if len(codes) > 1 else None
        text = RuleText(operator, name, library, resolver.scope)
        if name.kind not in (None, Kind.TEXT):
            assert name.kind is not None
            fault = text.wrong_kind(name.kind, "a text with the name of a rule", name.span)
            return resolver.broken(expr.span, *fault.diagnostics)
        if any(isinstance(part, Broken) for part in codes):
            return Broken(expr.span)
        if needed and library is None and isinstance(name, Constant):
            return _checked(resolver, RuleByName(expr.span, text), name)
        return code(expr.span, text)

    return resolve


def _checked(resolver: Resolver, code: RuleByName, name: Constant) -> Code:
    """Report a literal name without a rule. The rule itself is resolved when it is used."""
    machine = Machine()
    try:
        if code.text.found(name.value, None, machine) is None:
            raise code.unknown(str(name.value.content), None, machine)
    except Fault as problem:
        return resolver.broken(code.span, *problem.diagnostics)
    return code


def _misshapen(
    operator: str, pattern: str, expr: Application, operands: tuple[Expr, ...]
) -> Diagnostic | None:
    hint = f"it is written `{pattern}`"
    if not operands:
        message = f"`{operator}` lacks its text"
        return Diagnostic("missing-argument", message, expr.head.span, help=hint)
    if len(operands) == 1:
        return None
    word = operands[1]
    if not isinstance(word, Symbol):
        message = f"`{operator}` takes one text"
        return Diagnostic("too-many-arguments", message, word.span, help=hint)
    if word.name != _OF:
        return unknown_word(word.name, (_OF,), operator, word.span).diagnostics[0]
    if len(operands) == 2:
        message = f"`'{_OF}` has no value: the name of a library is expected after it"
        return Diagnostic("missing-value", message, word.span, help=hint)
    if len(operands) > 3:
        message = f"`{operator}` takes one text"
        return Diagnostic("too-many-arguments", message, operands[3].span, help=hint)
    return None


OPERATORS = (
    Native(
        "rule",
        Group.TEXTS,
        "The rule of that name as a value, as `.name` hands it over; the text may be computed. "
        "Rules are looked up where the expression is written, or in one library: one that the "
        "text uses, or one that ships.",
        result=Kind.OPERATOR,
        example='rule concat("nb-", 5)',
        resolve=_by_name(_RULE, RuleByName, needed=True),
        pattern=_RULE,
    ),
    Native(
        "has-rule",
        Group.TEXTS,
        "Whether `rule` would find a rule of that name.",
        result=Kind.BOOLEAN,
        example='has-rule "nb-5"',
        resolve=_by_name(_HAS_RULE, HasRule, needed=False),
        pattern=_HAS_RULE,
    ),
)
