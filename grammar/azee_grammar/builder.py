"""Syntax-tree nodes from what the grammar recognises: one method for each name in azee.lark."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

from azee_grammar.diagnostic import Diagnostic, Related
from azee_grammar.source import Source, Span
from azee_grammar.syntax import (
    Application,
    BoneName,
    Definition,
    Expr,
    Head,
    Hole,
    Named,
    Number,
    OperatorName,
    Parameter,
    RuleForm,
    RuleName,
    SideWord,
    SiteName,
    Symbol,
    Text,
    Use,
    Utterance,
)
from azee_grammar.token import FORMS, Token

Entry: TypeAlias = tuple[Symbol, Text]


class Builder:
    """Makes the nodes of one source. Parts arrive in the order in which they are written."""

    def __init__(self, source: Source, report: Callable[[Diagnostic], None]) -> None:
        self._source = source
        self._report = report

    # Items

    def use(self, parts: list[Token]) -> Use:
        """`use 'library`."""
        keyword, library = parts
        symbol = self.symbol([library])
        return Use(self._span(keyword).to(symbol.span), symbol)

    def definition(self, parts: list[Any]) -> Definition:
        """`def name`, its entries, its body. A broken entry is None, so is a broken body."""
        keyword, name, *entries, body = parts
        span = self._span(keyword).to(self._span(name) if body is None else body.span)
        known = tuple(entry for entry in entries if entry is not None)
        return Definition(span, name.text, self._span(name), known, body)

    def entry(self, parts: list[Token]) -> Entry:
        """`'meaning "text"`."""
        name, text = parts
        return self.symbol([name]), self.text([text])

    def utterance(self, parts: list[Expr]) -> Utterance:
        """Wrap an expression at the margin."""
        (expr,) = parts
        return Utterance(expr.span, expr)

    def broken(self, _parts: list[Token]) -> None:
        """Return the node that takes the place of a line with a mistake."""

    # Applications

    def application(self, parts: list[Any]) -> Application:
        """Apply a head to the operands that follow it."""
        head, *operands = parts
        # Broken lines leave no operand; an item with any broken line is not returned.
        kept = tuple(operand for operand in operands if operand is not None)
        span: Span = head.span
        if kept:
            span = span.to(kept[-1].span)
        return Application(span, head, kept, called=False)

    def bare(self, parts: list[Head]) -> Application:
        """Make an application of a head alone, as an operand."""
        (head,) = parts
        return Application(head.span, head, (), called=False)

    def call(self, parts: list[Any]) -> Application:
        """`head(operands)`: positional operands come before named ones."""
        head, *operands, close = parts
        named: Named | None = None
        for operand in operands:
            if isinstance(operand, Named):
                named = operand
            elif named is not None:
                self._report(_positional_after_named(named, operand))
                break
        span = head.span.to(self._span(close))
        return Application(span, head, tuple(operands), called=True)

    def named(self, parts: list[Any]) -> Named:
        """`'arg = value`."""
        token, value = parts
        name = self.symbol([token])
        return Named(name.span.to(value.span), name, value)

    def inner(self, parts: list[Any]) -> Expr:
        """Return the expression inside parentheses unchanged."""
        expr: Expr = parts[0]
        return expr

    # Words

    def head(self, parts: list[Token]) -> Head:
        """Return the head of an application."""
        (token,) = parts
        span = self._span(token)
        if token.kind in FORMS:
            return RuleName(span, token.text, RuleForm(FORMS[token.kind]))
        if token.kind == "BONE":
            return BoneName(span, token.text)
        if token.kind == "SITE":
            return SiteName(span, token.text)
        return OperatorName(span, token.text)

    def number(self, parts: list[Token]) -> Number:
        """`-.4`."""
        return Number(self._span(parts[0]), parts[0].text)

    def text(self, parts: list[Token]) -> Text:
        """`"text"`."""
        return Text(self._span(parts[0]), parts[0].text)

    def symbol(self, parts: list[Token]) -> Symbol:
        """`'word`."""
        return Symbol(self._span(parts[0]), parts[0].text)

    def parameter(self, parts: list[Token]) -> Parameter:
        """`^name`."""
        return Parameter(self._span(parts[0]), parts[0].text)

    def hole(self, parts: list[Token]) -> Hole:
        """`?name`."""
        return Hole(self._span(parts[0]), parts[0].text)

    def side(self, parts: list[Token]) -> SideWord:
        """`s`, `w`, `L` or `R`."""
        return SideWord(self._span(parts[0]), parts[0].text)

    def _span(self, token: Token) -> Span:
        return Span(self._source, token.start, token.end)


def _positional_after_named(named: Named, operand: Expr) -> Diagnostic:
    return Diagnostic(
        "positional-after-named",
        "an operand without a name stands after one that is named",
        operand.span,
        help="write the operands without names first, in the order of declaration",
        related=(Related(f"`'{named.name.name}` is named", named.span),),
    )
