"""Matches the operands of a native operator with its declaration."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from azee.lang.code import BUILDS, Broken, Code, Constant, NativeCall
from azee.lang.fault import Fault
from azee.lang.native import Native, Occurrence, Operand, Option, role, unknown_word
from azee.lang.values import Kind
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.syntax import Application, Expr, Symbol

if TYPE_CHECKING:
    from azee.lang.resolve import Resolver


@dataclass(slots=True)
class _Match:
    """Codes with the declaration that each belongs to, filled in order of writing."""

    codes: list[Code] = field(default_factory=list)
    declarations: list[Operand] = field(default_factory=list)
    roles: list[str] = field(default_factory=list)
    keywords: dict[int, str] = field(default_factory=dict)
    settings: dict[str, object] = field(default_factory=dict)
    problems: list[Diagnostic] = field(default_factory=list)
    filled: int = 0
    """The number of declared operands that have at least one expression."""


def native_call(
    resolver: Resolver,
    native: Native,
    expr: Application,
    operands: Sequence[Expr],
    codes: Sequence[Code],
) -> Code:
    """Return the call of an operator, already evaluated if all its operands are literals.

    Reports too-many-arguments, missing-argument, missing-value, unknown-keyword,
    duplicate-argument, wrong-type, and names that the vocabulary does not have.
    """
    match = _matched(native, operands, codes)
    for code, declaration, what in zip(match.codes, match.declarations, match.roles, strict=True):
        match.problems += _misfit(native, code, declaration, what)
    _require_all(native, expr, match)
    if match.problems:
        return resolver.broken(expr.span, *match.problems)
    occurrence = Occurrence(
        native.name,
        expr.span,
        resolver.origin(expr.head.span),
        tuple((d.name, c.span) for d, c in zip(match.declarations, match.codes, strict=True)),
    )
    result = native.result
    rest = next((i for i, o in enumerate(native.operands) if o.rest), None)
    call = NativeCall(
        expr.span,
        native,
        occurrence,
        tuple(match.codes),
        tuple(match.declarations),
        tuple(match.roles),
        rest,
        match.keywords,
        match.settings,
        None if native.whole or result is None else BUILDS[result],
    )
    if any(isinstance(code, Broken) for code in match.codes):
        return Broken(expr.span)
    return resolver.folded(call, match.codes)


def _matched(native: Native, operands: Sequence[Expr], codes: Sequence[Code]) -> _Match:
    match = _Match()
    for option in native.options:
        match.settings[option.word] = False if option.operand is None else option.default
    given: set[str] = set()
    i = 0
    while i < len(operands):
        expr, code = operands[i], codes[i]
        declaration = _next(native, match.filled)
        if isinstance(expr, Symbol) and native.options and not _takes_symbol(declaration):
            named = next((o for o in native.options if o.word == expr.name), None)
            if named is not None:
                i += _option(named, operands, codes, i, given, match)
                continue
            if declaration is None or declaration.optional:
                words = [o.word for o in native.options]
                problem = unknown_word(expr.name, words, native.name, expr.span)
                match.problems += problem.diagnostics
                break
        if declaration is None:
            match.problems.append(_surplus(native, expr))
            break
        match.codes.append(code)
        match.declarations.append(declaration)
        match.roles.append(role(len(match.codes) - 1 - len(match.keywords)))
        if not declaration.rest or match.filled < len(native.operands) - 1:
            match.filled += 1
        i += 1
    return match


def _next(native: Native, filled: int) -> Operand | None:
    if filled < len(native.operands):
        return native.operands[filled]
    return native.operands[-1] if native.operands and native.operands[-1].rest else None


def _takes_symbol(declaration: Operand | None) -> bool:
    return declaration is not None and (not declaration.kinds or Kind.SYMBOL in declaration.kinds)


def _option(
    option: Option,
    operands: Sequence[Expr],
    codes: Sequence[Code],
    i: int,
    given: set[str],
    match: _Match,
) -> int:
    """Take an option and its value; return how many operands these are."""
    span = operands[i].span
    if option.word in given:
        message = f"`'{option.word}` is given twice"
        match.problems.append(Diagnostic("duplicate-argument", message, span))
    given.add(option.word)
    if option.operand is None:
        match.settings[option.word] = True
        return 1
    if i + 1 >= len(operands):
        message = f"`'{option.word}` has no value: {option.operand.wanted} is expected after it"
        match.problems.append(Diagnostic("missing-value", message, span))
        return 1
    match.settings.pop(option.word, None)
    match.keywords[len(match.codes)] = option.word
    match.codes.append(codes[i + 1])
    match.declarations.append(option.operand)
    match.roles.append(f"`'{option.word}`")
    return 2


def _surplus(native: Native, expr: Expr) -> Diagnostic:
    count = len(native.operands)
    if not count:
        message = f"`{native.name}` takes no operands"
    else:
        message = f"`{native.name}` takes {count} operand{'s' if count > 1 else ''}"
    return Diagnostic(
        "too-many-arguments",
        message,
        expr.span,
        label="this is one too many",
        help=f"it is written `{native.signature}`",
    )


def _misfit(native: Native, code: Code, declaration: Operand, what: str) -> Sequence[Diagnostic]:
    """Return the mistakes of an operand that are known before evaluation."""
    try:
        if isinstance(code, Constant):
            declaration.content(code.value, native.name, what, code.span)
            if declaration.vocabulary is not None and code.kind is Kind.SYMBOL:
                unknown = declaration.vocabulary(str(code.value.content), code.span)
                return unknown.diagnostics if unknown else ()
        elif not declaration.accepts(code.kind):
            assert code.kind is not None
            raise declaration.wrong_kind(code.kind, native.name, what, code.span)
    except Fault as problem:
        return problem.diagnostics
    return ()


def _require_all(native: Native, expr: Application, match: _Match) -> None:
    for declaration in native.operands:
        count = sum(d is declaration for d in match.declarations)
        least = declaration.least if declaration.rest else int(not declaration.optional)
        if count < least:
            if any(p.code == "unknown-keyword" for p in match.problems):
                return
            message = f"`{native.name}` lacks its {declaration.name}"
            if declaration.rest and least > 1:
                message = f"`{native.name}` takes at least {least} operands"
            match.problems.append(
                Diagnostic(
                    "missing-argument",
                    message,
                    expr.head.span,
                    help=f"it is written `{native.signature}`",
                )
            )
            return
