"""From syntax to code: looks up the operator, rule, parameter, bone or site of every name.

All checks that need no evaluation are made here, also in rules that nobody calls: names, arguments,
the structure of special forms, kinds of operands. Expressions of literals are evaluated once, so
their mistakes are found here as well. Every mistake is reported, and its expression becomes
`Broken`.
"""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from azee.lang.application import RuleCall, RuleReference
from azee.lang.arguments import bound, flattened, given_arguments
from azee.lang.azop import shape_of
from azee.lang.body import BodyPart
from azee.lang.code import Broken, Code, Constant, Variable
from azee.lang.constants import CONSTANTS
from azee.lang.control import Guarded
from azee.lang.fault import Exhausted, Fault, did_you_mean
from azee.lang.machine import Machine
from azee.lang.matching import native_call
from azee.lang.native import Native
from azee.lang.procedure import FormalParameter
from azee.lang.registry import NATIVES
from azee.lang.resolution import Steps, Visible, run
from azee.lang.rule import Rule
from azee.lang.rule_by_name import ambiguous
from azee.lang.scope import AmbiguousRule, Scope
from azee.lang.values import Kind, NumberValue, SideValue, SymbolValue, TextValue
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.source import Span
from azee_grammar.syntax import (
    Application,
    BoneName,
    Expr,
    Hole,
    Number,
    OperatorName,
    Parameter,
    RuleForm,
    RuleName,
    SideWord,
    SiteName,
    Symbol,
    Text,
)
from azee_grammar.vocabulary import bone_names, nearest_site, site_names
from azee_solver.constraint import Origin
from azee_solver.geometry import Side

Atom: TypeAlias = Number | Symbol | Parameter | SideWord | Text | Hole

_ONLY_WHEN_REACHED = frozenset(
    {"division-by-zero", "number-range", "index-range", "negative-duration", "cannot-stretch"}
)
"""Mistakes in values, not in form: an expression that is never evaluated may contain them."""


@dataclass(eq=False)
class Resolving:
    """Data that all resolvers of one program share."""

    machine: Machine = field(default_factory=Machine)
    """Evaluates literals; its steps are a budget for all literals together."""
    spans: dict[Origin, Span] = field(default_factory=dict)
    """The places in the text of the origins that constraints and calls carry."""

    def resolver(self, scope: Scope, rule: str | None, diagnostics: list[Diagnostic]) -> Resolver:
        """Return a resolver for expressions of one rule, or of none."""
        return Resolver(self, scope, rule, diagnostics)


@dataclass(eq=False)
class Resolver:
    """Resolves the expressions of one definition or utterance."""

    shared: Resolving
    scope: Scope
    rule: str | None
    diagnostics: list[Diagnostic]
    _helps: dict[tuple[str, str], str | None] = field(init=False, default_factory=dict)
    """What names without a rule may mean: libraries have thousands to compare with."""

    def report(self, *diagnostics: Diagnostic) -> None:
        """Report a mistake."""
        self.diagnostics.extend(diagnostics)

    def broken(self, span: Span, *diagnostics: Diagnostic) -> Code:
        """Report a mistake and return the code that replaces the expression."""
        self.report(*diagnostics)
        return Broken(span)

    def origin(self, span: Span) -> Origin:
        """Return the origin of a place, as constraints and calls carry it."""
        origin = Origin(span.source.name, span.line, span.column, self.rule)
        self.shared.spans[origin] = span
        return origin

    def resolve(self, expr: Expr, visible: Visible = frozenset()) -> Code:
        """Return the code of an expression, with some visible local names, by default none."""
        return run(self.all((expr,), visible), self._steps)[0]

    def procedure(self, expr: Application) -> tuple[tuple[FormalParameter, ...], Code]:
        """Return the parameters and the body of an `azop` without visible local names."""
        return run(self.azop(expr, frozenset()), self._steps)

    def all(self, exprs: Sequence[Expr], visible: Visible) -> Steps[tuple[Code, ...]]:
        """Resolve several expressions with the same visible names."""
        codes = []
        for expr in exprs:
            codes.append((yield expr, visible))
        return tuple(codes)

    def _steps(self, expr: Expr, visible: Visible) -> Steps[Code]:
        if isinstance(expr, Application):
            return (yield from self._application(expr, visible))
        return self._atom(expr, visible)

    def _atom(self, expr: Atom, visible: Visible) -> Code:
        match expr:
            case Number():
                return Constant(expr.span, NumberValue(expr.value))
            case Symbol():
                return Constant(expr.span, SymbolValue(expr.name))
            case Parameter():
                return self._parameter(expr, visible)
            case SideWord():
                return Constant(expr.span, SideValue(Side(expr.name)))
            case Text():
                return Constant(expr.span, TextValue(expr.text))
            case Hole():
                message = f"the hole `?{expr.name}` stands for anything, in templates only"
                return self.broken(expr.span, Diagnostic("template-hole", message, expr.span))

    def _application(self, expr: Application, visible: Visible) -> Steps[Code]:
        match expr.head:
            case OperatorName(name=name):
                native = NATIVES.get(name)
                if native is not None:
                    return (yield from self._native(native, expr, visible))
                return (yield from self._bare_word(expr, name, visible))
            case RuleName(name=name, form=form):
                return (yield from self._rule(expr, name, form, visible))
            case BoneName(name=name):
                return (yield from self._body_part(expr, name, Kind.BONE, visible))
            case SiteName(name=name):
                return (yield from self._body_part(expr, name, Kind.SITE, visible))

    # Names ----------------------------------------------------------------------------------

    def _parameter(self, expr: Parameter, visible: Visible) -> Code:
        if expr.name in visible:
            return Variable(expr.span, expr.name)
        place = self.scope.places.get(expr.name)
        if place is not None:
            return Constant(expr.span, place.value) if place.value else Broken(expr.span)
        constant = CONSTANTS.get(expr.name)
        if constant is not None:
            return Constant(expr.span, constant.value)
        hint = did_you_mean(expr.name, (*sorted(visible), *self.scope.places, *CONSTANTS), "^")
        if hint is None and expr.name in NATIVES:
            hint = f"`{expr.name}` is an operator: write it without `^`"
        if hint is None and self._defined(expr.name):
            hint = f"`{expr.name}` is a rule: write `:{expr.name}`"
        message = f"nothing here is called `^{expr.name}`"
        return self.broken(expr.span, Diagnostic("unknown-name", message, expr.span, help=hint))

    def _body_part(
        self, expr: Application, name: str, wanted: Kind, visible: Visible
    ) -> Steps[Code]:
        names = bone_names() if wanted is Kind.BONE else site_names()
        operands = yield from self.all(flattened(expr), visible)
        entry = names.get(name)
        if entry is not None:
            return self.folded(BodyPart(expr.span, entry, wanted, operands), operands)
        sigil = "!" if wanted is Kind.BONE else "@"
        code = "unknown-bone" if wanted is Kind.BONE else "unknown-site"
        what = "bone" if wanted is Kind.BONE else "site"
        message = f"AZee has no {what} `{sigil}{name}`"
        hint = _written_apart(name, sigil, names)
        if hint is None and wanted is Kind.SITE:
            found = [f"`@{candidate}`" for candidate in nearest_site(name)]
            hint = f"did you mean {' or '.join(found)}?" if found else None
        elif hint is None:
            hint = did_you_mean(name, tuple(names), sigil)
        span = expr.head.span
        return self.broken(span, Diagnostic(code, message, span, f"no such {what}", help=hint))

    # Rules ----------------------------------------------------------------------------------

    def _rule(self, expr: Application, name: str, form: RuleForm, visible: Visible) -> Steps[Code]:
        rule = self._found(expr, name)
        parameters = rule.parameters if rule else ()
        title = f"`{form.value}{name}`"
        given, problems = given_arguments(
            expr.operands, expr.called, title, [p for p, _ in parameters]
        )
        codes = yield from self.all([argument.value for argument in given], visible)
        if rule is None or rule.definition.body is None:
            return Broken(expr.span)
        arguments, mismatches = bound(
            title, parameters, given, expr.head.span, partial=form is RuleForm.REFER
        )
        if problems or mismatches:
            malformed = any(p.code == "missing-value" for p in problems)
            self.report(*problems)
            self.report(*(m for m in mismatches if not (malformed or _nameless(problems, m))))
            return Broken(expr.span)
        resolved = dict(zip((id(argument.value) for argument in given), codes, strict=True))
        values = {parameter: resolved[id(value)] for parameter, value in arguments.items()}
        if form is RuleForm.REFER:
            return RuleReference(expr.span, rule, values)
        call = RuleCall(expr.span, rule, values, self.origin(expr.head.span))
        if form is RuleForm.POSTURE:
            return Guarded(
                expr.span, call, Kind.CONSTRAINTS, f"{title} must be a posture rule: constraints"
            )
        return call

    def _found(self, expr: Application, name: str) -> Rule | None:
        span = expr.head.span
        try:
            rule = self.scope.find(name)
        except AmbiguousRule as several:
            self.report(ambiguous(f"`:{name}`", several, span))
            return None
        if rule is None:
            message = f"there is no rule `:{name}`"
            sigil = span.text[: len(span.text) - len(span.text.lstrip(":.#"))]
            if (name, sigil) not in self._helps:
                self._helps[name, sigil] = self._rule_help(name, sigil)
            hint = self._helps[name, sigil]
            self.report(Diagnostic("unknown-rule", message, span, "no such rule", help=hint))
        return rule

    def _rule_help(self, name: str, sigil: str = ":") -> str | None:
        """Return what a name without a rule may mean. sigil: what is written before it."""
        known = self.scope.names()
        words = name.split(" ")
        for k in range(len(words) - 1, 0, -1):
            head = " ".join(words[:k])
            if head in known:
                return (
                    f"a name goes on after a space: to apply `:{head}`, write "
                    f"`:{head}({', '.join(words[k:])})`"
                )
        dropped = self.scope.dropped
        if dropped is not None and name in dropped.rules:
            library = dropped.name
            return f"`{library}` is out of scope because the text says `use`; add `use '{library}`"
        hint = did_you_mean(name, known, sigil)
        if hint is None and name in NATIVES:
            return f"`{name}` is an operator: write it without `:`"
        return hint

    def _bare_word(self, expr: Application, name: str, visible: Visible) -> Steps[Code]:
        if expr.called and (self._defined(name) or not self._operator_is_likelier(name)):
            return (yield from self._rule(expr, name, RuleForm.APPLY, visible))
        yield from self.all(flattened(expr), visible)
        span = expr.head.span
        message = f"there is no operator `{name}`"
        hint: str | None
        if name in visible or name in CONSTANTS:
            hint = f"did you mean `^{name}`?"
        elif self._defined(name):
            hint = f"`{name}` is a rule: write `:{name}`"
        elif self.scope.dropped is not None and name in self.scope.dropped.rules:
            hint = self._rule_help(name)
        elif name in bone_names():
            hint = f"`{name}` is a bone: write `!{name}`"
        elif name in site_names():
            hint = f"`{name}` is a site: write `@{name}`"
        else:
            hint = did_you_mean(name, tuple(NATIVES))
        return self.broken(span, Diagnostic("unknown-operator", message, span, help=hint))

    def _defined(self, name: str) -> bool:
        try:
            return self.scope.find(name) is not None
        except AmbiguousRule:
            return True

    def _operator_is_likelier(self, name: str) -> bool:
        return did_you_mean(name, self.scope.names()) is None

    # Operators ------------------------------------------------------------------------------

    def _native(self, native: Native, expr: Application, visible: Visible) -> Steps[Code]:
        if native.resolve is not None:
            return (yield from native.resolve(self, expr, flattened(expr), visible))
        operands = flattened(expr)
        codes = yield from self.all(operands, visible)
        return native_call(self, native, expr, operands, codes)

    def azop(
        self, expr: Application, visible: Visible
    ) -> Steps[tuple[tuple[FormalParameter, ...], Code]]:
        """Resolve the parameters and the body of an `azop`; defaults can use those before them."""
        shape = shape_of(expr)
        self.report(*shape.problems)
        parameters: list[FormalParameter] = []
        for name, default in shape.parameters:
            code = None if default is None else (yield default, visible)
            parameters.append(FormalParameter(name.name, code))
            visible = visible | {name.name}
        if shape.body is None:
            return tuple(parameters), Broken(expr.span)
        body = yield shape.body, visible
        return tuple(parameters), body

    def folded(self, code: Code, parts: Sequence[Code]) -> Code:
        """Evaluate an expression once, now, if all its parts are literals.

        A mistake in form is reported at once, a mistake in a value when the value is used.
        """
        if not all(isinstance(part, Constant) for part in parts):
            return code
        machine = self.shared.machine
        machine.depth = 0
        try:
            return Constant(code.span, code.evaluate(machine, {}))
        except Exhausted:
            return code
        except Fault as problem:
            if any(d.code in _ONLY_WHEN_REACHED for d in problem.diagnostics):
                return code
            return self.broken(code.span, *problem.diagnostics)


def _written_apart(name: str, sigil: str, names: Container[str]) -> str | None:
    """Return the help for `!palm_L` and `@I_TIP_R`, which are written with operands."""
    words = name.split("_")
    for k in range(len(words) - 1, 0, -1):
        head, rest = "_".join(words[:k]), words[k:]
        if head in names and rest[0] in ("L", "R", "s", "w"):
            return f"side and phalanx are operands: write `{sigil}{head}({', '.join(rest)})`"
    return None


def _nameless(problems: Sequence[Diagnostic], mismatch: Diagnostic) -> bool:
    """Whether a missing argument is the one that was given without its name."""
    return mismatch.code == "missing-argument" and any(
        p.code in ("expected-argument-name", "positional-after-named") for p in problems
    )
