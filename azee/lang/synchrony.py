"""`sync`: its structure in the text, and its evaluation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from azee.lang.code import BUILDS, Broken, Code, Constant, Names, gathered
from azee.lang.fault import Fault, did_you_mean, fault, together
from azee.lang.machine import HEAVY, Machine
from azee.lang.resolution import Steps, Visible
from azee.lang.sync_shape import ShapeReader, SyncRule
from azee.lang.values import Kind, NumberValue, ScoreValue, SymbolValue, Value
from azee.score.bounds import Placement
from azee.score.error import LayoutError
from azee.score.layout import LONGEST_S, Part, synchronised
from azee.score.moment import Bound, Moment, MomentError, parse_moment
from azee.score.score import Score
from azee_grammar.diagnostic import Diagnostic
from azee_grammar.source import Span
from azee_grammar.syntax import Application, Expr, Symbol

if TYPE_CHECKING:
    from azee.lang.resolve import Resolver


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
        scores: list[Value] = []
        faults: list[Fault] = []
        for block in self.blocks:
            score = next(remaining)
            operands = [next(remaining) for _ in block.operands]
            scores.append(score)
            try:
                parts.append(Part(block.name.name, _score(block, score), _placed(block, operands)))
            except Fault as problem:
                faults.append(problem)
        if faults:
            raise together(faults)
        try:
            group = synchronised(parts)
        except LayoutError as problem:
            raise self._fault(problem) from None
        for part, score, laid_out in zip(parts, scores, group.blocks, strict=True):
            if laid_out.score is not part.score:
                machine.spend(score.size, self.span)
        return BUILDS[Kind.SCORE](group, scores, machine, self.span)

    def _fault(self, problem: LayoutError) -> Fault:
        """Mark the block at fault, or the ref or the hold that names something missing."""
        if problem.part is None:
            return fault(problem.code, str(problem), self.span)
        block = self.blocks[problem.part]
        if problem.name is None:
            return fault(problem.code, str(problem), block.name.span)
        naming = block.score if problem.bound is None else _ref(block, problem.bound)
        hint = _which(problem.name, problem.known)
        return fault(problem.code, str(problem), naming.span, help=hint)


def _which(name: str, known: Sequence[str]) -> str | None:
    """Return the help for a block that does not exist."""
    hint = did_you_mean(name, known, "'")
    if hint is not None or not known:
        return hint
    blocks = ", ".join(f"`{block}`" for block in known)
    if len(known) == 1:
        return f"the only block here is {blocks}"
    return f"the blocks here are {blocks}"


def _ref(block: SyncBlock, bound: Bound) -> Code:
    """Return the expression that gives a bound."""
    assert block.rule is not None
    by_role = dict(zip(block.rule.operands, block.operands, strict=True))
    return by_role.get(bound.value) or by_role["block"]


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
                moments[role] = _moment(value, block.rule.word, code.span)
        except Fault as problem:
            faults.append(problem)
    if faults:
        raise together(faults)
    return Placement(moments.get("start"), moments.get("end"), length)


def _moment(value: Value, word: str, span: Span) -> Moment:
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


# The structure in the text --------------------------------------------------------------------


def resolve_sync(
    resolver: Resolver, expr: Application, operands: tuple[Expr, ...], visible: Visible
) -> Steps[Code]:
    """Return the code of a `sync`.

    Reports missing-argument, missing-value, bad-block-name, unknown-sync-rule, duplicate-block,
    too-many-arguments, and refs that name no block.
    """
    reader = ShapeReader(expr, operands)
    shape = reader.blocks()
    whole = [operand for operand in operands if operand is not reader.cut_short]
    resolved = yield from resolver.all(whole, visible)
    codes = {id(operand): code for operand, code in zip(whole, resolved, strict=True)}
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


def _static_problems(blocks: Sequence[SyncBlock]) -> list[Diagnostic]:
    """Return the mistakes that are known before the scores: names, kinds, literal refs."""
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
    for bound, moment in ((Bound.START, placement.start), (Bound.END, placement.end)):
        if moment is not None and moment.path[0] not in names:
            name = moment.path[0]
            hint = _which(name, sorted(names))
            span = _ref(block, bound).span
            message = f"there is no block `{name}`"
            problems.append(Diagnostic("unknown-block", message, span, help=hint))
    return problems[:1] if block.rule.word == "with" else problems
