"""`sync`: its shape in the text, and its evaluation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from azee.lang.code import BUILDS, Broken, Code, Constant, Names, gathered
from azee.lang.fault import Fault, did_you_mean, fault, together
from azee.lang.machine import HEAVY, Machine
from azee.lang.values import Kind, NumberValue, ScoreValue, SymbolValue, Value
from azee.score.bounds import Placement
from azee.score.error import LayoutError
from azee.score.layout import LONGEST_S, Part, synchronised
from azee.score.moment import Moment, MomentError, parse_moment
from azee.score.score import Score
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.source import Span
from azee_grammar.syntax import Application, Expr, Symbol

if TYPE_CHECKING:
    from azee.lang.resolve import Resolver

PATTERN = "sync 'NAME SCORE 'NAME SCORE 'RULE OPERAND … …"


@dataclass(frozen=True, slots=True)
class SyncRule:
    """How a block is placed: the rule word and what its operands are."""

    word: str
    operands: tuple[str, ...]
    """Each `start` or `end` (a ref), `duration` (a number) or `block` (a name)."""
    meaning: str
    published: bool = False


RULES: Mapping[str, SyncRule] = {
    rule.word: rule
    for rule in (
        SyncRule("start/end", ("start", "end"), "stretched between the two", published=True),
        SyncRule("start", ("start",), "starts there, natural length"),
        SyncRule("end", ("end",), "ends there, natural length"),
        SyncRule("start/dur", ("start", "duration"), "starts there and lasts that many seconds"),
        SyncRule("end/dur", ("end", "duration"), "ends there and lasts that many seconds"),
        SyncRule("with", ("block",), "the bounds of that block"),
    )
}


@dataclass(frozen=True, slots=True, eq=False)
class SyncBlock:
    """A block as written; `rule` is None for the first."""

    name: Symbol
    score: Code
    rule: SyncRule | None
    operands: tuple[Code, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Sync(Code):
    """`sync` with its blocks."""

    span: Span
    blocks: tuple[SyncBlock, ...]
    codes: tuple[Code, ...]
    """All expressions in it, in order of writing."""

    @property
    def kind(self) -> Kind:
        """Always a score."""
        return Kind.SCORE

    def evaluate(self, machine: Machine, names: Names) -> Value:
        """Evaluate scores and operands, then lay the blocks out."""
        level = machine.enter(HEAVY * len(self.blocks), self.span)
        values = gathered(self.codes, machine, names)
        machine.depth = level
        remaining = iter(values)
        parts: list[Part] = []
        faults: list[Fault] = []
        for block in self.blocks:
            score = next(remaining)
            operands = [next(remaining) for _ in block.operands]
            try:
                parts.append(Part(block.name.name, _score(block, score), _placed(block, operands)))
            except Fault as problem:
                faults.append(problem)
                continue
            if block.rule is not None:
                machine.spend(score.size, block.score.span)
        if faults:
            raise together(faults)
        try:
            group = synchronised(parts)
        except LayoutError as problem:
            raise self._fault(problem) from None
        return BUILDS[Kind.SCORE](group, values, machine, self.span)

    def _fault(self, problem: LayoutError) -> Fault:
        """Point at the block at fault: at the ref or the hold that names what is not there."""
        if problem.part is None:
            return fault(problem.code, str(problem), self.span)
        block = self.blocks[problem.part]
        span = block.name.span
        hint = None
        if problem.code == "unknown-block":
            missing = str(problem).partition("`")[2].partition("`")[0]
            span = _where_named(block, missing) or block.score.span
            hint = did_you_mean(missing, problem.known, "'")
            if hint is None and problem.known:
                hint = _listed(problem.known)
        return fault(problem.code, str(problem), span, help=hint)


def _listed(names: Sequence[str]) -> str:
    blocks = ", ".join(f"`{name}`" for name in names)
    return (
        f"the only block here is {blocks}" if len(names) == 1 else f"the blocks here are {blocks}"
    )


def _where_named(block: SyncBlock, name: str) -> Span | None:
    for code in block.operands:
        if name.split("/")[0] in code.span.text:
            return code.span
    return (
        block.operands[0].span if block.operands and "hold" not in block.score.span.text else None
    )


def _score(block: SyncBlock, value: Value) -> Score:
    if isinstance(value, ScoreValue):
        return value.content
    raise _no_score(block, value.kind)


def _no_score(block: SyncBlock, kind: Kind) -> Fault:
    return fault(
        "wrong-type",
        f"the block `{block.name.name}` wants a score, not {kind.value}",
        block.score.span,
        label=f"this is {kind.value}",
        help="`key D CSTR` makes a score of constraints" if kind is Kind.CONSTRAINTS else None,
    )


def _placed(block: SyncBlock, values: Sequence[Value]) -> Placement:
    if block.rule is None:
        return Placement()
    moments: dict[str, Moment] = {}
    length: Fraction | None = None
    faults: list[Fault] = []
    for role, value, code in zip(block.rule.operands, values, block.operands, strict=True):
        try:
            if role == "block":
                return Placement.within(_block_path(value, code.span))
            if role == "duration":
                length = _length(block.rule, value, code.span)
            else:
                moments[role] = moment(value, block.rule.word, code.span)
        except Fault as problem:
            faults.append(problem)
    if faults:
        raise together(faults)
    return Placement(moments.get("start"), moments.get("end"), length)


def moment(value: Value, word: str, span: Span) -> Moment:
    """Return the ref that a value names."""
    if not isinstance(value, SymbolValue):
        message = f"`'{word}` wants a ref such as `'SIG:start`, not {value.kind.value}"
        raise fault("wrong-type", message, span, label=f"this is {value.kind.value}")
    try:
        return parse_moment(value.content)
    except MomentError as problem:
        raise fault("bad-ref", str(problem), span) from None


def _block_path(value: Value, span: Span) -> tuple[str, ...]:
    if not isinstance(value, SymbolValue):
        message = f"`'with` wants the name of a block, not {value.kind.value}"
        raise fault("wrong-type", message, span, label=f"this is {value.kind.value}")
    path = tuple(value.content.split("/"))
    if ":" in value.content or not all(path):
        message = "`'with` wants the name of a block alone"
        raise fault("bad-ref", message, span, help=f"write `'{value.content.partition(':')[0]}`")
    return path


def _length(rule: SyncRule, value: Value, span: Span) -> Fraction:
    if not isinstance(value, NumberValue):
        message = f"`'{rule.word}` wants a number of seconds, not {value.kind.value}"
        raise fault("wrong-type", message, span, label=f"this is {value.kind.value}")
    if value.content < 0:
        raise fault("negative-duration", "a duration cannot be negative", span)
    if value.content > LONGEST_S:
        raise fault("size-limit", "a score lasts at most a day, 86400 s", span)
    return Fraction(repr(value.content))


# The shape in the text ------------------------------------------------------------------------


def resolve_sync(
    resolver: Resolver, expr: Application, operands: tuple[Expr, ...], visible: frozenset[str]
) -> Code:
    """Return the code of a `sync`.

    Reports missing-argument, missing-value, bad-block-name, unknown-sync-rule, duplicate-block,
    too-many-arguments, and refs that name no block.
    """
    reader = _Reader(expr, operands)
    shape = reader.blocks()
    codes = {
        id(operand): resolver.resolve(operand, visible)
        for operand in operands
        if operand is not reader.cut_short
    }
    if reader.problems:
        return resolver.broken(expr.span, *reader.problems)
    blocks = tuple(
        SyncBlock(name, codes[id(score)], rule, tuple(codes[id(o)] for o in given))
        for name, score, rule, given in shape
    )
    problems = _static_problems(blocks)
    if problems:
        return resolver.broken(expr.span, *problems)
    parts = tuple(code for block in blocks for code in (block.score, *block.operands))
    if any(isinstance(code, Broken) for code in parts):
        return Broken(expr.span)
    return resolver.folded(Sync(expr.span, blocks, parts), parts)


class _Reader:
    """Reads the operands of a `sync` from left to right."""

    def __init__(self, expr: Application, operands: tuple[Expr, ...]) -> None:
        self._head = expr.head.span
        self._operands = operands
        self._at = 0
        self.problems: list[Diagnostic] = []
        self.cut_short: Expr | None = None
        """A score whose operands stand beside it instead of belonging to it."""

    def blocks(self) -> list[tuple[Symbol, Expr, SyncRule | None, tuple[Expr, ...]]]:
        """Return name, score, rule and the rule's operands for each block; stop at a mistake."""
        found: list[tuple[Symbol, Expr, SyncRule | None, tuple[Expr, ...]]] = []
        if not self._operands:
            message = "`sync` lacks its blocks"
            hint = f"it is written `{PATTERN}`"
            self.problems.append(Diagnostic("missing-argument", message, self._head, help=hint))
        while self._at < len(self._operands) and not self.problems:
            name = self._name(first=not found)
            score = self._score(name) if name else None
            if name is None or score is None:
                break
            if not found:
                found.append((name, score, None, ()))
                continue
            rule = self._rule(name)
            if rule is None:
                break
            count = len(rule.operands)
            operands = self._operands[self._at : self._at + count]
            if len(operands) < count:
                message = f"the rule `'{rule.word}` of `{name.name}` takes {_counted(rule)}"
                self._problem("missing-argument", message, name)
                break
            self._at += count
            found.append((name, score, rule, operands))
        return found

    def _name(self, first: bool) -> Symbol | None:
        name = self._operands[self._at]
        if not isinstance(name, Symbol):
            message = "the name of a block, such as `'SIG`, is expected here"
            self.problems.append(Diagnostic("bad-block-name", message, name.span))
            return None
        if name.name in RULES:
            message = f"`'{name.name}` is a rule; the name of a block is expected here"
            if not first and self._at == 2:
                message = "the first block of a `sync` takes no rule: the others are placed by it"
            self._problem("bad-block-name", message, name)
            return None
        if ":" in name.name or "/" in name.name:
            message = f"a block cannot be called `{name.name}`: `:` and `/` have a meaning in refs"
            self._problem("bad-block-name", message, name)
            return None
        self._at += 1
        return name

    def _score(self, name: Symbol) -> Expr | None:
        if self._at >= len(self._operands):
            self._problem("missing-value", f"the block `{name.name}` has no score", name)
            return None
        self._at += 1
        return self._operands[self._at - 1]

    def _rule(self, name: Symbol) -> SyncRule | None:
        listed = ", ".join(f"`'{word}`" for word in RULES)
        score = self._operands[self._at - 1]
        if self._at >= len(self._operands):
            message = f"the block `{name.name}` has no rule that says when it stands"
            self._problem("missing-argument", message, name, f"the rules are {listed}")
            return None
        word = self._operands[self._at]
        if isinstance(word, Symbol) and word.name in RULES:
            self._at += 1
            return RULES[word.name]
        if isinstance(word, Symbol):
            message = f"there is no sync rule `'{word.name}`"
            hint = did_you_mean(word.name, tuple(RULES), "'") or f"the rules are {listed}"
        elif isinstance(score, Application) and not score.operands and not score.called:
            self.cut_short = score
            message = f"this does not belong to `{score.span.text}`"
            hint = (
                f"after the name of a block write `{score.span.text}(…)` with commas, or the "
                "operands one level deeper"
            )
        else:
            message = f"the rule of the block `{name.name}` is expected here"
            hint = f"the rules are {listed}"
        self.problems.append(Diagnostic("unknown-sync-rule", message, word.span, help=hint))
        return None

    def _problem(self, code: str, message: str, at: Symbol, hint: str | None = None) -> None:
        self.problems.append(Diagnostic(code, message, at.span, help=hint))


def _counted(rule: SyncRule) -> str:
    words = {"start": "a ref", "end": "a ref", "duration": "a duration", "block": "a block"}
    return " and ".join(words[role] for role in rule.operands)


def _static_problems(blocks: Sequence[SyncBlock]) -> list[Diagnostic]:
    """Return what can be said before the scores are known: names, kinds, literal refs."""
    problems: list[Diagnostic] = []
    names: set[str] = set()
    for block in blocks:
        if block.name.name in names:
            message = f"there are two blocks `{block.name.name}`"
            problems.append(Diagnostic("duplicate-block", message, block.name.span))
        names.add(block.name.name)
    for block in blocks:
        kind = block.score.kind
        if kind is not None and kind is not Kind.SCORE:
            problems += _no_score(block, kind).diagnostics
        problems += _static_rule(block, names)
    return problems


def _static_rule(block: SyncBlock, names: set[str]) -> Sequence[Diagnostic]:
    if block.rule is None or not all(isinstance(code, Constant) for code in block.operands):
        return ()
    values = [code.value for code in block.operands if isinstance(code, Constant)]
    try:
        placement = _placed(block, values)
    except Fault as problem:
        return problem.diagnostics
    problems: list[Diagnostic] = []
    for bound, code in zip((placement.start, placement.end), _refs(block), strict=True):
        if bound is not None and bound.path[0] not in names:
            message = f"there is no block `{bound.path[0]}`"
            hint = did_you_mean(bound.path[0], sorted(names), "'")
            if hint is None:
                hint = _listed(sorted(names))
            problems.append(Diagnostic("unknown-block", message, code.span, help=hint))
    return problems[:1] if block.rule.word == "with" else problems


def _refs(block: SyncBlock) -> tuple[Code, Code]:
    """Return the expressions that give start and end, as far as the rule has them."""
    assert block.rule is not None
    by_role = dict(zip(block.rule.operands, block.operands, strict=True))
    any_code = block.operands[0]
    return by_role.get("start", any_code), by_role.get("end", any_code)
