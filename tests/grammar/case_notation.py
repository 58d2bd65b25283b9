"""The notation of tests/grammar/cases: trees and diagnostics as lines."""

from __future__ import annotations

from azee_grammar.diagnostic import Diagnostic
from azee_grammar.syntax import (
    Application,
    BoneName,
    Definition,
    Expr,
    Head,
    Hole,
    Item,
    Named,
    Number,
    OperatorName,
    Parameter,
    RuleName,
    SideWord,
    SiteName,
    Symbol,
    Text,
    Use,
)


def item(node: Item) -> str:
    if isinstance(node, Use):
        return f"use {expr(node.library)}"
    if isinstance(node, Definition):
        entries = "".join(f"{expr(name)} {expr(text)} " for name, text in node.entries)
        body = "-" if node.body is None else expr(node.body)
        return f"def {_name(node.name)} {{ {entries}}} {body}"
    return expr(node.expr)


def expr(node: Expr | Named) -> str:
    match node:
        case Number(text=text):
            return text
        case Text(text=text):
            return f'"{text}"'
        case Symbol(name=name):
            return f"'{name}"
        case Parameter(name=name):
            return f"^{name}"
        case Hole(name=name):
            return f"?{name}"
        case SideWord(name=name):
            return f"side:{name}"
        case Named(name=name, value=value):
            return f"{expr(name)} = {expr(value)}"
        case Application(head=head, operands=operands, called=called):
            inside = " ".join(expr(operand) for operand in operands)
            if called:
                return f"{_head(head)}({inside})"
            return f"({_head(head)} {inside})" if inside else f"({_head(head)})"


def diagnostic(found: Diagnostic) -> str:
    assert found.span is not None
    return f"error {found.code} {found.span.line}:{found.span.column} `{found.span.text}`"


def _head(head: Head) -> str:
    name = _name(head.name)
    match head:
        case RuleName(form=form):
            return f"{form.value}{name}"
        case BoneName():
            return f"!{name}"
        case SiteName():
            return f"@{name}"
        case OperatorName():
            return name


def _name(name: str) -> str:
    return name.replace(" ", "␣")
