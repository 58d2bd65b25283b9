"""Native operators, declared once for evaluation, messages and the manual."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, Any

from azee.lang.constants import CONSTANTS
from azee.lang.fault import Fault, did_you_mean, fault
from azee.lang.values import Kind, PointValue, SiteValue, SymbolValue, Value
from azee_grammar.source import Span
from azee_solver.constraint import Origin
from azee_solver.geometry import SitePoint

if TYPE_CHECKING:
    from azee.lang.form import Resolve


class Group(Enum):
    """The heading under which the manual lists an operator."""

    LANGUAGE = "Language"
    LISTS = "Lists and numbers"
    TEXTS = "Texts"
    GEOMETRY = "Geometry"
    CONSTRAINTS = "Constraints"
    SCORES = "Scores"


@dataclass(frozen=True, slots=True)
class Operand:
    """An operand of an operator.

    `kinds` are those that are accepted, any where empty. `words` close a symbol to a few words.
    With `rest` it takes all that remain, at least `least`. Where it is `optional` the function has
    a default. `raw` hands the function the value itself instead of its content.
    """

    name: str
    meaning: str
    kinds: tuple[Kind, ...] = ()
    words: tuple[str, ...] = ()
    rest: bool = False
    least: int = 0
    optional: bool = False
    raw: bool = False
    vocabulary: Callable[[str, Span], Fault | None] | None = None
    """Checks a literal symbol before evaluation."""

    def accepts(self, kind: Kind | None) -> bool:
        """Whether a value of that kind is accepted; None means that the kind is not known yet."""
        if kind is None or not self.kinds or kind in self.kinds:
            return True
        return kind is Kind.SITE and Kind.POINT in self.kinds

    def takes_as_is(self, value: Value) -> bool:
        """Whether the value is accepted without a conversion or a further check."""
        return not self.words and (not self.kinds or value.kind in self.kinds)

    def content(self, value: Value, operator: str, role: str, span: Span) -> object:
        """Return the argument of the operator's function for a value.

        `role` is how messages call the operand, such as `first operand`.

        Raises: Fault: `wrong-type` or `unknown-keyword`.
        """
        kinds = self.kinds
        if kinds and value.kind not in kinds:
            if isinstance(value, SiteValue) and Kind.POINT in kinds:
                point = SitePoint(value.content)
                return PointValue(point) if self.raw else point
            if isinstance(value, SymbolValue) and value.content in CONSTANTS:
                raise self.wrong_kind(
                    value.kind, operator, role, span, f"did you mean `^{value.content}`?"
                )
            raise self.wrong_kind(value.kind, operator, role, span)
        if self.words and value.content not in self.words:
            raise unknown_word(str(value.content), self.words, operator, span)
        return value if self.raw else value.content

    def wrong_kind(
        self, kind: Kind, operator: str, role: str, span: Span, hint: str | None = None
    ) -> Fault:
        """Return the fault of an operand of another kind."""
        message = f"`{operator}` wants {self.wanted} as its {role}, not {kind.value}"
        return fault("wrong-type", message, span, label=f"this is {kind.value}", help=hint)

    @property
    def wanted(self) -> str:
        """The accepted kinds in words."""
        if self.words:
            return " or ".join(f"`'{word}`" for word in self.words)
        return " or ".join(kind.value for kind in self.kinds) or "a value"


_ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth")


def role(number: int) -> str:
    """Return how messages call the operand of that number, from 0."""
    return f"{_ORDINALS[number] if number < len(_ORDINALS) else f'{number + 1}th'} operand"


def unknown_word(word: str, known: Sequence[str], operator: str, span: Span) -> Fault:
    """Return the fault of a keyword that an operator does not know."""
    message = f"`{operator}` knows no `'{word}`"
    hint = did_you_mean(word, known, "'")
    listed = ", ".join(f"`'{w}`" for w in known)
    return fault("unknown-keyword", message, span, help=hint or f"it knows {listed}")


@dataclass(frozen=True, slots=True)
class Option:
    """`'word value` after the operands, or `'word` alone where `operand` is None."""

    word: str
    meaning: str
    operand: Operand | None = None
    default: object = None


@dataclass(frozen=True, slots=True)
class Native:
    """A native operator.

    `function(at, …)` takes an `Occurrence`, then the contents of its operands; with `uses_machine`
    the machine comes second. It returns the content of a value of kind `result`, or with `whole`
    the value itself. If `result` is None, the kind depends on the operands. Special forms do not
    evaluate all operands in order; they have `resolve` and `pattern` instead of a function and
    operands.
    """

    name: str
    group: Group
    meaning: str
    operands: tuple[Operand, ...] = ()
    options: tuple[Option, ...] = ()
    result: Kind | None = None
    published: bool = False
    only_name_published: bool = False
    example: str = ""
    function: Callable[..., Any] | None = None
    uses_machine: bool = False
    whole: bool = False
    resolve: Resolve | None = None
    pattern: str = ""

    @property
    def signature(self) -> str:
        """The notation of the operator: `place SITE POINT ['dist NUMBER] ['contact]`."""
        if self.pattern:
            return self.pattern
        parts = [self.name, *(_pattern(o) for o in self.operands)]
        for option in self.options:
            value = f" {option.operand.name.upper()}" if option.operand else ""
            parts.append(f"['{option.word}{value}]")
        return " ".join(parts)


def _pattern(operand: Operand) -> str:
    name = "|".join(f"'{w}" for w in operand.words) if operand.words else operand.name.upper()
    if operand.rest:
        return f"{name} …"
    return f"[{name}]" if operand.optional else name


@dataclass(frozen=True, slots=True, eq=False)
class Occurrence:
    """An operator at its place in a text, for mistakes that its function reports."""

    name: str
    span: Span
    origin: Origin
    spans: tuple[tuple[str, Span], ...] = field(default=())
    """Spans of the operands, each with its declared name, in order of writing."""

    def span_of(self, operand: str, number: int = 0) -> Span:
        """Return the place of an operand, or of the whole application if it is left out."""
        found = [span for name, span in self.spans if name == operand]
        return found[number] if number < len(found) else self.span

    def fault(
        self, code: str, message: str, operand: str | None = None, number: int = 0, **more: str
    ) -> Fault:
        """Return a fault at one of the operands, or at the whole application."""
        span = self.span if operand is None else self.span_of(operand, number)
        return fault(code, message, span, label=more.get("label", ""), help=more.get("help"))
