"""The syntax tree: a closed union of frozen nodes, each with its span.

Equality of nodes ignores spans, so that trees of differently laid-out texts are equal. The tree has
no knowledge of names and numbers of operands. azee.lang decides whether a word is an operator, how
many operands it takes and which `'argument value` pairs belong together.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import TypeAlias

from azee_grammar.source import Span


@dataclass(frozen=True, slots=True)
class _Node:
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Number(_Node):
    """`-.4`, `.5`, `1`: `text` as written (ASCII), from which the value is computed exactly."""

    text: str

    @property
    def value(self) -> float:
        """The nearest float64."""
        return float(self.text)


@dataclass(frozen=True, slots=True)
class Text(_Node):
    """`"text"`, without its quotes."""

    text: str


@dataclass(frozen=True, slots=True)
class Symbol(_Node):
    """`'word`, without its apostrophe, NFC: argument and block names, keywords, refs."""

    name: str


@dataclass(frozen=True, slots=True)
class Parameter(_Node):
    """`^name`: a parameter, a local name or a constant."""

    name: str


@dataclass(frozen=True, slots=True)
class Hole(_Node):
    """`?name`: matches anything; in templates only."""

    name: str


@dataclass(frozen=True, slots=True)
class SideWord(_Node):
    """`s`, `w`, `L` or `R` as a bare word."""

    name: str


class RuleForm(Enum):
    """How a rule is written: `:name` applies it, `.name` passes it, `:#name` is a posture."""

    APPLY = ":"
    REFER = "."
    POSTURE = ":#"


@dataclass(frozen=True, slots=True)
class RuleName(_Node):
    """Head `:name`, `.name` or `:#name`; inner single spaces are part of the name."""

    name: str
    form: RuleForm


@dataclass(frozen=True, slots=True)
class OperatorName(_Node):
    """A bare word at the head: a native operator, or a rule when called as `tree()`."""

    name: str


@dataclass(frozen=True, slots=True)
class BoneName(_Node):
    """Head `!palm`."""

    name: str


@dataclass(frozen=True, slots=True)
class SiteName(_Node):
    """Head `@I_TIP`."""

    name: str


Head: TypeAlias = RuleName | OperatorName | BoneName | SiteName


@dataclass(frozen=True, slots=True)
class Named(_Node):
    """`'arg = value` between the parentheses of a call."""

    name: Symbol
    value: Expr


@dataclass(frozen=True, slots=True)
class Application(_Node):
    """A head and its operands, in either notation.

    `called` distinguishes `palm(s)` from the prefix form. Prefix operands stay a flat sequence,
    symbols included (`'topic :a 'info :b` is four operands); `Named` occurs only where `called`. A
    head alone (`:arbre`, `!head`, `.nb-5`) is an application without operands.
    """

    head: Head
    operands: tuple[Expr | Named, ...]
    called: bool


Expr: TypeAlias = Number | Text | Symbol | Parameter | Hole | SideWord | Application


@dataclass(frozen=True, slots=True)
class Use(_Node):
    """`use 'library`."""

    library: Symbol


@dataclass(frozen=True, slots=True)
class Definition(_Node):
    """`def name`, its `'meaning "…"`-like entries and its body.

    `body` is None if the body has a mistake; the file then has a diagnostic.
    """

    name: str
    name_span: Span = field(compare=False, repr=False)
    entries: tuple[tuple[Symbol, Text], ...]
    body: Expr | None


@dataclass(frozen=True, slots=True)
class Utterance(_Node):
    """An expression at the top of a file."""

    expr: Expr


Item: TypeAlias = Use | Definition | Utterance


@dataclass(frozen=True, slots=True)
class File(_Node):
    """All items of a text, in order."""

    items: tuple[Item, ...]
