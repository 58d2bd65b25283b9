"""How the leaves of a syntax tree, and the heads of applications, are written."""

from __future__ import annotations

from typing import TypeAlias

from azee_grammar.syntax import (
    BoneName,
    Head,
    Hole,
    Number,
    OperatorName,
    Parameter,
    RuleName,
    SideWord,
    SiteName,
    Symbol,
    Text,
)

Leaf: TypeAlias = Number | Text | Symbol | Parameter | Hole | SideWord


def leaf_text(leaf: Leaf) -> str:
    """Return an expression without operands as text."""
    match leaf:
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
            return name


def head_text(head: Head) -> str:
    """Return what is applied as text, with its mark: `:rule`, `!bone`, `@site`, `operator`."""
    match head:
        case RuleName(name=name, form=form):
            return form.value + name
        case BoneName(name=name):
            return f"!{name}"
        case SiteName(name=name):
            return f"@{name}"
        case OperatorName(name=name):
            return name
