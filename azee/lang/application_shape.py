"""The meaning of an application without its notation: which rule, which operand is which."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from azee.lang.arguments import bound, flattened, given_arguments
from azee.lang.registry import NATIVES
from azee.lang.rule import Rule, is_azop
from azee.lang.scope import AmbiguousRule, Scope
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.syntax import Application, Expr, OperatorName, Parameter, RuleForm, RuleName


@dataclass(frozen=True, slots=True)
class Shape:
    """The head of an application, equal if it means the same, and its operands by name.

    If the head is not a known rule, operands are named by their position, from `0`.
    """

    head: tuple[object, ...]
    operands: dict[str, Expr]
    problems: tuple[Diagnostic, ...] = field(default=(), compare=False)

    @classmethod
    def plain(cls, expr: Application, problems: Sequence[Diagnostic] = ()) -> Shape:
        """Return the shape by syntax alone, without knowledge of rules."""
        operands = {str(i): operand for i, operand in enumerate(flattened(expr))}
        return cls((type(expr.head), expr.head), operands, tuple(problems))

    @classmethod
    def of(cls, expr: Application, scope: Scope) -> Shape:
        """Return the shape, with the names of rules looked up in `scope`.

        `:name`, `:#name` and a called `name()` all apply a rule; `.name` passes it. `problems`
        reports wrong arguments of a known rule.
        """
        name, form = _rule_name(expr)
        if name is None:
            return cls.plain(expr)
        rule = _found(name, scope)
        parameters = rule.parameters if rule else ()
        title = f"`{form.value}{name}`"
        given, problems = given_arguments(
            expr.operands, expr.called, title, [p for p, _ in parameters]
        )
        handed_over = form is RuleForm.REFER
        if rule is None:
            if problems:
                return cls.plain(expr)
            named = {argument.name or str(i): argument.value for i, argument in enumerate(given)}
            return cls(("rule", name, handed_over), named)
        arguments, mismatches = bound(title, parameters, given, expr.head.span, partial=handed_over)
        if problems or mismatches:
            return cls.plain(expr, problems or mismatches)
        target, renamed = _destination(rule, handed_over=handed_over)
        operands = {renamed[own]: value for own, value in arguments.items()}
        return cls(("rule", target, handed_over), operands)


def _rule_name(expr: Application) -> tuple[str | None, RuleForm]:
    """Return the name of the rule that an application applies or passes, if it does."""
    head = expr.head
    if isinstance(head, RuleName):
        return head.name, head.form
    if isinstance(head, OperatorName) and expr.called and head.name not in NATIVES:
        return head.name, RuleForm.APPLY
    return None, RuleForm.APPLY


def _found(name: str, scope: Scope) -> Rule | None:
    try:
        return scope.find(name)
    except AmbiguousRule:
        return None


# Forwarding -----------------------------------------------------------------------------------


def _destination(rule: Rule, *, handed_over: bool) -> tuple[Rule, Mapping[str, str]]:
    """Return the rule that a forwarding rule applies in the end, and the names of its arguments.

    If a rule is passed as a value, whoever applies it uses names and order of the arguments. So it
    equals another rule only if these are the same.
    """
    names = {name: name for name, _ in rule.parameters}
    seen = {rule}
    while (forward := _forward(rule)) is not None and forward[0] not in seen:
        target, renamed = forward
        same = [(name, name) for name, _ in target.parameters]
        if handed_over and [*renamed.items()] != same:
            break
        rule = target
        seen.add(rule)
        names = {first: renamed[last] for first, last in names.items()}
    return rule, names


def _forward(rule: Rule) -> tuple[Rule, Mapping[str, str]] | None:
    """Return the rule that a rule only applies under other names, and the names of its arguments.

    The body of such a rule applies another rule to its own parameters, each once, with the same
    defaults.
    """
    body = rule.definition.body
    if is_azop(body):
        assert isinstance(body, Application)
        operands = flattened(body)
        body = operands[-1] if len(operands) % 2 else None
    if not isinstance(body, Application):
        return None
    name, form = _rule_name(body)
    target = None if name is None or form is RuleForm.REFER else _found(name, rule.scope)
    if target is None:
        return None
    given, problems = given_arguments(
        body.operands, body.called, target.title, [p for p, _ in target.parameters]
    )
    arguments, mismatches = bound(target.title, target.parameters, given, body.head.span)
    if problems or mismatches:
        return None
    own = {parameter.name: parameter.default for parameter in rule.defaults}
    theirs = {parameter.name: parameter.default for parameter in target.defaults}
    renamed: dict[str, str] = {}
    for new, value in arguments.items():
        if not isinstance(value, Parameter) or value.name not in own or value.name in renamed:
            return None
        if own[value.name] not in (None, theirs[new]):
            return None
        renamed[value.name] = new
    if renamed.keys() != own.keys():
        return None
    return target, {name: renamed[name] for name in own}
