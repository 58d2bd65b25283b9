"""Rules whose names are texts: they are looked up when the text is known."""

from __future__ import annotations

import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass

from azee.lang.code import Code, Names, gathered
from azee.lang.fault import Fault, did_you_mean, fault
from azee.lang.machine import Machine, operator_value
from azee.lang.rule import Rule
from azee.lang.scope import AmbiguousRule, Namespace, Scope
from azee.lang.values import BooleanValue, Kind, SymbolValue, TextValue, Value
from azee_grammar.diagnostic import Diagnostic, Related
from azee_grammar.source import Span


@dataclass(frozen=True, slots=True, eq=False)
class RuleText:
    """A text that names a rule, and the library to look in, if one is given.

    Without a library, the rules are those that are in scope where the text was written. A library
    is one that this text uses, one that the evaluated text uses, or one that ships.
    """

    operator: str
    name: Code
    library: Code | None
    scope: Scope

    @property
    def codes(self) -> tuple[Code, ...]:
        """The expressions of the name and of the library."""
        return (self.name,) if self.library is None else (self.name, self.library)

    def found(self, name: Value, library: Value | None, machine: Machine) -> Rule | None:
        """Return the rule of that name, if there is one. Raises: Fault: a mistake in an operand."""
        if not isinstance(name, TextValue):
            raise self.wrong_kind(name.kind, "a text with the name of a rule", self.name.span)
        wanted = unicodedata.normalize("NFC", name.content)
        if library is not None:
            return self._namespace(library, machine).rules.get(wanted)
        try:
            return self.scope.find(wanted)
        except AmbiguousRule as several:
            raise Fault(ambiguous(f"`{wanted}`", several, self.name.span)) from None

    def known(self, library: Value | None, machine: Machine) -> tuple[str, ...]:
        """Return the names of all rules that could be found."""
        if library is None:
            return self.scope.names()
        return tuple(self._namespace(library, machine).rules)

    def wrong_kind(self, kind: Kind, wanted: str, span: Span) -> Fault:
        """Return the fault of an operand of another kind."""
        message = f"`{self.operator}` wants {wanted}, not {kind.value}"
        return fault("wrong-type", message, span, label=f"this is {kind.value}")

    def _namespace(self, library: Value, machine: Machine) -> Namespace:
        assert self.library is not None
        span = self.library.span
        if not isinstance(library, SymbolValue):
            raise self.wrong_kind(library.kind, "the name of a library after `'of`", span)
        name = library.content
        known: Mapping[str | None, Namespace] = {
            space.name: space
            for space in (self.scope.core, *machine.libraries, *self.scope.libraries)
        }
        found = known.get(name) or self.scope.shipped(name)
        if found is None:
            message = f"no library `'{name}` is in use or ships"
            hint = did_you_mean(name, [n for n in known if n], "'")
            raise fault("library-not-found", message, span, help=hint or f"add `use '{name}`")
        return found


@dataclass(frozen=True, slots=True, eq=False)
class RuleByName(Code):
    """`rule TEXT`: the rule of that name as a value."""

    span: Span
    text: RuleText

    @property
    def kind(self) -> Kind:
        """Always an operator."""
        return Kind.OPERATOR

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Evaluate the text and look its rule up."""
        level = machine.enter(2, self.span)
        name, *of = gathered(self.text.codes, machine, names)
        library = of[0] if of else None
        rule = self.text.found(name, library, machine)
        if rule is None:
            raise self.unknown(str(name.content), library, machine)
        machine.depth = level
        return operator_value(rule.procedure, {})

    def unknown(self, name: str, library: Value | None, machine: Machine) -> Fault:
        """Return the fault of a name that no rule has."""
        where = "" if library is None else f" in `'{library.content}`"
        return fault(
            "unknown-rule",
            f"there is no rule `{name}`{where}",
            self.text.name.span,
            label="no such rule",
            help=did_you_mean(name, self.text.known(library, machine)),
        )


@dataclass(frozen=True, slots=True, eq=False)
class HasRule(Code):
    """`has-rule TEXT`: whether there is a rule of that name."""

    span: Span
    text: RuleText

    @property
    def kind(self) -> Kind:
        """Always a boolean."""
        return Kind.BOOLEAN

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Evaluate the text and look its rule up."""
        level = machine.enter(2, self.span)
        name, *of = gathered(self.text.codes, machine, names)
        found = self.text.found(name, of[0] if of else None, machine)
        machine.depth = level
        return BooleanValue(found is not None)


def ambiguous(title: str, several: AmbiguousRule, span: Span) -> Diagnostic:
    """Return the diagnostic of a name that two libraries in use define."""
    libraries = " and ".join(f"`'{rule.library}`" for rule in several.rules)
    return Diagnostic(
        "ambiguous-rule",
        f"{title} is defined in the libraries {libraries}",
        span,
        help="define a rule of that name in this file to say which is meant",
        related=tuple(
            Related(f"defined in `'{rule.library}`", rule.definition.name_span)
            for rule in several.rules
        ),
    )
