"""The names that have a meaning in a text: its rules, the body's parts, operators, constants."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from azee.lang.azop import shape_of
from azee.lang.library import CORE, DEFAULT, names_in, shipped_library
from azee.lang.registry import NATIVES
from azee.lang.rule import Rule, is_azop
from azee.lang.scope import AmbiguousRule, Namespace, Scope
from azee.lang.values import Kind
from azee_grammar.library import shipped_names
from azee_grammar.syntax import (
    Application,
    BoneName,
    Expr,
    OperatorName,
    RuleForm,
    RuleName,
    SiteName,
)

_DEEPEST = 20


@dataclass(frozen=True, slots=True)
class Knowledge:
    """The scope of a text, and the libraries that it could use."""

    scope: Scope
    folders: Sequence[Path] = ()
    """Folders in which `use` looks, beside the libraries that ship."""

    @classmethod
    def shipped(cls, folders: Sequence[Path] = ()) -> Knowledge:
        """Return the knowledge of a text that defines and uses nothing."""
        libraries = [shipped_library(DEFAULT).namespace]
        return cls(Scope(Namespace(None), shipped_library(CORE).namespace, libraries), folders)

    def rule(self, name: str) -> Rule | None:
        """Return the rule of a name; if the name is ambiguous, the first."""
        try:
            return self.scope.find(name)
        except AmbiguousRule as several:
            return several.rules[0]

    def rules(self, fits: Callable[[str], bool] = lambda _: True) -> Iterator[Rule]:
        """Yield the rules in scope whose names fit; of a large library only these are read."""
        for name in self.scope.names():
            if fits(name) and (rule := self.rule(name)) is not None:
                yield rule

    def libraries(self) -> tuple[str, ...]:
        """Return the names of libraries that `use` finds."""
        found = dict.fromkeys(shipped_names())
        for folder in self.folders:
            try:
                found |= dict.fromkeys(names_in(folder))
            except OSError:
                continue  # a mistake there is reported in the text that uses the library
        return tuple(found)

    def gives(self, rule: Rule) -> Kind | None:
        """Return the kind of a rule's result if its body shows it, without evaluation."""
        body: Expr | None = rule.definition.body
        for _ in range(_DEEPEST):
            if not isinstance(body, Application):
                return None
            match body.head:
                case OperatorName(name="azop") if is_azop(body):
                    body = shape_of(body).body
                case OperatorName(name="let") if len(body.operands) == 3:
                    last = body.operands[2]
                    body = last if isinstance(last, Application) else None
                case OperatorName(name=name) if name in NATIVES:
                    return NATIVES[name].result
                case RuleName(form=RuleForm.REFER):
                    return Kind.OPERATOR
                case RuleName(form=RuleForm.POSTURE):
                    return Kind.CONSTRAINTS
                case RuleName(name=name) | OperatorName(name=name):
                    inner = self.rule(name)
                    body = inner.definition.body if inner is not None else None
                case BoneName() | SiteName():
                    return None
        return None
