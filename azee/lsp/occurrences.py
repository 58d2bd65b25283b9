"""Finds the names in a text, and what each of them names: a rule, an argument, a block."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum

from azee.lang.arguments import flattened, given_arguments
from azee.lang.azop import shape_of
from azee.lang.library import SHIPPED_RESOLVING
from azee.lang.registry import NATIVES
from azee.lang.rule import Rule, is_azop
from azee.lang.scope import AmbiguousRule, Scope
from azee.lang.sync_shape import ShapeReader
from azee_grammar.source import Span
from azee_grammar.syntax import (
    Application,
    Definition,
    Expr,
    File,
    Named,
    OperatorName,
    Parameter,
    RuleName,
    Symbol,
    Utterance,
)

_BLOCK_OF_REF = re.compile(r"([^:/]+)(?=[:/]|$)")


class What(Enum):
    """The kind of thing that a name names."""

    RULE = "rule"
    LOCAL = "name"
    """A parameter of a rule or `azop`, the name of a `let`, or a place of the text."""
    BLOCK = "block"


@dataclass(frozen=True, slots=True)
class Target:
    """The thing that a name names, identified by its name, without sigil, at its declaration."""

    what: What
    name: str
    place: Span
    shipped: bool = False

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Target) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    @property
    def _key(self) -> tuple[What, str, int]:
        return self.what, self.place.source.name, self.place.start


@dataclass(frozen=True, slots=True)
class Occurrence:
    """A name in a text: `span` covers it without its sigil; `sigil` precedes it."""

    span: Span
    target: Target
    sigil: str = ""
    declares: bool = False


@dataclass(slots=True)
class _Walk:
    """Goes through one text."""

    scope: Scope
    found: list[Occurrence] = field(default_factory=list)

    def item(self, node: Definition | Utterance, places: Mapping[str, Target]) -> None:
        if isinstance(node, Utterance):
            self.expr(node.expr, places)
            return
        target = Target(What.RULE, node.name, node.name_span)
        self.found.append(Occurrence(node.name_span, target, declares=True))
        if node.body is not None:
            self.expr(node.body, places)

    def expr(self, node: Expr | Named, visible: Mapping[str, Target]) -> None:
        if isinstance(node, Parameter) and node.name in visible:
            self.found.append(Occurrence(_behind(node.span, 1), visible[node.name], "^"))
        if not isinstance(node, Application):
            return
        name = rule_name(node)
        if name is not None:
            self._rule(node, name, visible)
        elif node.head == OperatorName(node.head.span, "azop"):
            self._azop(node, visible)
        elif node.head == OperatorName(node.head.span, "let"):
            self._let(node, visible)
        else:
            if node.head == OperatorName(node.head.span, "sync"):
                self._sync(node)
            for operand in flattened(node):
                self.expr(operand, visible)

    def _rule(self, node: Application, name: str, visible: Mapping[str, Target]) -> None:
        rule = _found(self.scope, name)
        sigil = node.head.form.value if isinstance(node.head, RuleName) else ""
        parameters: Mapping[str, Target] = {}
        if rule is not None:
            span = _behind(node.head.span, len(sigil))
            self.found.append(Occurrence(span, target_of(rule), sigil))
            parameters = parameters_of(rule)
        given, _ = given_arguments(node.operands, node.called, name, parameters)
        for argument in given:
            parameter = parameters.get(argument.name or "")
            if parameter is not None and argument.name_span is not None:
                self.found.append(Occurrence(_behind(argument.name_span, 1), parameter, "'"))
            self.expr(argument.value, visible)

    def _azop(self, node: Application, visible: Mapping[str, Target]) -> None:
        shape = shape_of(node)
        visible = dict(visible)
        for name, default in shape.parameters:
            if default is not None:
                self.expr(default, visible)
            visible[name.name] = self._declared(name, What.LOCAL)
        if shape.body is not None:
            self.expr(shape.body, visible)

    def _let(self, node: Application, visible: Mapping[str, Target]) -> None:
        operands = flattened(node)
        if len(operands) != 3 or not isinstance(name := operands[0], Symbol):
            for operand in operands:
                self.expr(operand, visible)
            return
        self.expr(operands[1], visible)
        target = self._declared(name, What.LOCAL)
        self.expr(operands[2], {**visible, name.name: target})

    def _sync(self, node: Application) -> None:
        """Find the blocks and the refs to them; the caller walks their scores."""
        blocks = ShapeReader(node, flattened(node)).blocks()
        targets: dict[str, Target] = {}
        for name, *_ in blocks:
            targets.setdefault(name.name, self._declared(name, What.BLOCK))
        for _, _, rule, operands in blocks:
            for role, ref in zip(rule.operands if rule else (), operands, strict=True):
                if role == "duration" or not isinstance(ref, Symbol):
                    continue
                block = _BLOCK_OF_REF.match(ref.name)
                target = targets.get(block[1]) if block else None
                if target is not None and (written := _BLOCK_OF_REF.match(ref.span.text, 1)):
                    start = ref.span.start + 1
                    span = Span(ref.span.source, start, start + len(written[1]))
                    self.found.append(Occurrence(span, target, "'"))

    def place(self, name: str, span: Span) -> Target:
        """Add the place in the text that names a place of the discourse."""
        target = Target(What.LOCAL, name, _behind(span, 1))
        self.found.append(Occurrence(target.place, target, "'", declares=True))
        return target

    def _declared(self, name: Symbol, what: What) -> Target:
        place = _behind(name.span, 1)
        target = Target(what, name.name, place)
        self.found.append(Occurrence(place, target, "'", declares=True))
        return target


def occurrences(file: File, scope: Scope) -> Sequence[Occurrence]:
    """Return all names of rules, parameters, locals and blocks that have a meaning, in order."""
    walk = _Walk(scope)
    places = {name: walk.place(name, found.name_span) for name, found in scope.places.items()}
    for item in file.items:
        if isinstance(item, Definition | Utterance):
            walk.item(item, places)
    return sorted(walk.found, key=lambda found: found.span.start)


def rule_name(node: Application) -> str | None:
    """Return the name of the rule that an application applies or passes, if it does."""
    if isinstance(node.head, RuleName):
        return node.head.name
    if isinstance(node.head, OperatorName) and node.called and node.head.name not in NATIVES:
        return node.head.name
    return None


def target_of(rule: Rule) -> Target:
    """Return a rule as the thing that a name names."""
    shipped = rule.resolving is SHIPPED_RESOLVING
    return Target(What.RULE, rule.name, rule.definition.name_span, shipped)


def parameters_of(rule: Rule) -> Mapping[str, Target]:
    """Return the parameters of a rule."""
    body = rule.definition.body
    if not is_azop(body):
        return {}
    assert isinstance(body, Application)
    names = (name for name, _ in shape_of(body).parameters)
    return {name.name: Target(What.LOCAL, name.name, _behind(name.span, 1)) for name in names}


def _found(scope: Scope, name: str) -> Rule | None:
    try:
        return scope.find(name)
    except AmbiguousRule:
        return None


def _behind(span: Span, sigil: int) -> Span:
    """Return the range of a name after its sigil."""
    return Span(span.source, span.start + sigil, span.end)
