"""Production rules as defined in a text, with the scope they were defined in."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from azee.lang.azop import shape_of
from azee.lang.code import Broken
from azee.lang.procedure import Procedure
from azee_grammar.diagnostic import Diagnostic, Severity
from azee_grammar.syntax import Application, Definition, Expr, OperatorName

if TYPE_CHECKING:
    from azee.lang.resolve import Resolving
    from azee.lang.scope import Scope

STATUSES: Mapping[str, str] = {
    "published": "its form is printed",
    "read-off": "its form was read off a published picture or film",
    "inferred": "its form follows a description",
    "placeholder": "its form is ours, and nobody's testimony",
    "judged": "signers have judged its form",
}
"""How much of a rule's form is testimony: the first words of the entry `'status`.

After `judged` the entry says by whom and when.
"""


@dataclass(eq=False)
class Rule:
    """A definition and its scope; resolved on first use.

    `library` is the name of the library it ships in, None for a rule of the text itself.
    """

    definition: Definition
    library: str | None
    scope: Scope
    resolving: Resolving
    _diagnostics: list[Diagnostic] = field(default_factory=list)

    @property
    def name(self) -> str:
        """The name with which it is applied."""
        return self.definition.name

    @property
    def title(self) -> str:
        """How messages call it."""
        return f"`:{self.name}`"

    def entry(self, name: str) -> str | None:
        """Return the text of an entry such as `'meaning`."""
        for symbol, text in self.definition.entries:
            if symbol.name == name:
                return text.text
        return None

    @property
    def status(self) -> str | None:
        """One of `STATUSES`, None if the rule states none of them."""
        words = (self.entry("status") or "").split(maxsplit=1)
        return words[0] if words and words[0] in STATUSES else None

    @cached_property
    def parameters(self) -> Sequence[tuple[str, bool]]:
        """Names of the parameters in order, and whether each is mandatory."""
        return [(p.name, p.default is None) for p in self.defaults]

    @cached_property
    def defaults(self) -> tuple[FormalDefault, ...]:
        """Parameters with the text of their defaults."""
        body = self.definition.body
        if not is_azop(body):
            return ()
        assert isinstance(body, Application)
        seen: dict[str, FormalDefault] = {}
        for name, default in shape_of(body).parameters:
            seen.setdefault(name.name, FormalDefault(name.name, default))
        return tuple(seen.values())

    @cached_property
    def procedure(self) -> Procedure:
        """The resolved body. Its mistakes are added to `diagnostics`, as is an unknown status."""
        self._diagnostics += self._unknown_status()
        body = self.definition.body
        if body is None:
            return Procedure(self.name, (), Broken(self.definition.span), {})
        resolver = self.resolving.resolver(self.scope, self.name, self._diagnostics)
        if is_azop(body):
            assert isinstance(body, Application)
            parameters, code = resolver.procedure(body)
            return Procedure(self.name, parameters, code, {})
        return Procedure(self.name, (), resolver.resolve(body), {})

    def _unknown_status(self) -> Iterator[Diagnostic]:
        for symbol, text in self.definition.entries:
            if symbol.name == "status" and self.status is None:
                yield Diagnostic(
                    "unknown-status",
                    f"`{text.text}` is no status of a rule",
                    text.span,
                    help=f"the first word is one of {', '.join(STATUSES)}",
                    severity=Severity.WARNING,
                )

    @property
    def is_resolved(self) -> bool:
        """Whether its body has been resolved, so that `diagnostics` are all there are."""
        return "procedure" in self.__dict__

    @property
    def diagnostics(self) -> Sequence[Diagnostic]:
        """The mistakes in the definition, as far as it has been resolved."""
        return self._diagnostics


@dataclass(frozen=True, slots=True)
class FormalDefault:
    """A parameter as it is written; without a default it is mandatory."""

    name: str
    default: Expr | None


def is_azop(body: Expr | None) -> bool:
    """Whether a body declares parameters."""
    return isinstance(body, Application) and body.head == OperatorName(body.head.span, "azop")
