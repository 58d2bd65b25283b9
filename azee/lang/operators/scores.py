"""Scores: what the body does, and when."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from typing import Any

from azee.lang.machine import HEAVY, Machine
from azee.lang.native import Group, Native, Occurrence, Operand, Option, unknown_word
from azee.lang.sync_shape import PATTERN
from azee.lang.synchrony import resolve_sync
from azee.lang.values import Kind, ListValue, ScoreValue, SymbolValue, Value
from azee.score.error import LayoutError
from azee.score.layout import LONGEST_S, held, in_sequence
from azee.score.score import CHANNELS, Blank, Hold, Key, Score
from azee_solver.constraint import Constraint

GAP_S = 0.2
"""Between the elements of a `seq`; ours, nothing is published."""


def exact_seconds(number: float) -> Fraction:
    """Return a number as a time: the fraction that its shortest decimal writes, `.1` is 1/10."""
    return Fraction(repr(number))


def duration_of(at: Occurrence, number: float, operand: str) -> Fraction:
    """Return a number of seconds as a time. Raises: Fault: it is negative, or longer than a day."""
    if number < 0:
        raise at.fault("negative-duration", "a duration cannot be negative", operand)
    if number > LONGEST_S:
        raise at.fault("size-limit", "a score lasts at most a day, 86400 s", operand)
    return exact_seconds(number)


def _key(at: Occurrence, duration: float, constraints: tuple[Constraint, ...]) -> Score:
    return Key(duration_of(at, duration, "duration"), constraints=constraints)


def _blank(at: Occurrence, duration: float) -> Score:
    return Blank(duration_of(at, duration, "duration"))


def _hold(at: Occurrence, what: Value, duration: float, *, only: Value | None) -> Score:
    kept = _channels(at, only)
    duration_s = duration_of(at, duration, "duration")
    if isinstance(what, SymbolValue):
        return Hold(duration_s, block=what.content, channels=kept)
    assert isinstance(what, ScoreValue)
    if isinstance(what.content, Hold):
        raise at.fault("unknown-block", "a hold has no end of its own to be held", "what")
    try:
        return held(what.content, duration_s, kept)
    except LayoutError as problem:
        raise at.fault(problem.code, str(problem)) from None


def _channels(at: Occurrence, only: Value | None) -> tuple[str, ...]:
    if only is None:
        return ("hands",)
    names = only.content if isinstance(only, ListValue) else (only,)
    channels: list[str] = []
    for name in names:
        span = at.span_of("channels")
        if not isinstance(name, SymbolValue):
            message = f"`'only` wants the names of channels, not {name.kind.value}"
            raise at.fault("wrong-type", message, "channels")
        if name.content not in CHANNELS:
            raise unknown_word(name.content, CHANNELS, "'only", span)
        channels.append(name.content)
    return tuple(dict.fromkeys(channels))


def _fixed(at: Occurrence, score: Score) -> Score:
    return replace(score, fixed=True)


def _seq(at: Occurrence, machine: Machine, values: tuple[Value, ...], *, gap: float) -> Score:
    machine.spend(HEAVY * len(values), at.span)
    scores: list[Score] = []
    for i, value in enumerate(values):
        if not isinstance(value, ScoreValue):
            message = f"`seq` wants scores, and element {i + 1} of the list is {value.kind.value}"
            raise at.fault("wrong-type", message, "list")
        scores.append(value.content)
    try:
        return in_sequence(scores, duration_of(at, gap, "gap"))
    except LayoutError as problem:
        raise at.fault(problem.code, str(problem), "list") from None


def _ref(at: Occurrence, block: str, bound: Value, offset: float = 0.0) -> str:
    anchor = bound.content
    if isinstance(bound, SymbolValue):
        if anchor not in ("start", "end"):
            raise unknown_word(str(anchor), ("start", "end"), "ref", at.span_of("bound"))
        word = bound.content
    else:
        assert isinstance(anchor, float)
        word = _written(anchor)
    return f"{block}:{word}:{_written(offset)}" if offset else f"{block}:{word}"


def _written(number: float) -> str:
    return format(Decimal(repr(number)), "f")


def _native(
    name: str,
    meaning: str,
    operands: tuple[Operand, ...],
    function: Callable[..., Any],
    example: str,
    *,
    options: tuple[Option, ...] = (),
    published: bool = False,
    only_name_published: bool = False,
    result: Kind = Kind.SCORE,
    uses_machine: bool = False,
) -> Native:
    return Native(
        name,
        Group.SCORES,
        meaning,
        operands,
        options,
        result=result,
        published=published,
        only_name_published=only_name_published,
        example=example,
        function=function,
        uses_machine=uses_machine,
    )


_DURATION = Operand("duration", "seconds", (Kind.NUMBER,))

OPERATORS = (
    _native(
        "key",
        "The constraints hold for a duration in seconds; zero is legal.",
        (_DURATION, Operand("constraints", "constraints", (Kind.CONSTRAINTS,))),
        _key,
        "key .2 (place @I_TIP(s) ^Mssp)",
        published=True,
    ),
    _native(
        "hold",
        "In a `sync`, `hold 'BLOCK` keeps what a block had reached at its end; `hold SCORE` is a "
        "score and then its end kept. By default the hands are kept.",
        (
            Operand("what", "a block or a score", (Kind.SYMBOL, Kind.SCORE), raw=True),
            _DURATION,
        ),
        _hold,
        "hold (key .2 (place @I_TIP(s) ^Mssp)) .1",
        options=(
            Option(
                "only",
                f"a list of {', '.join(f'`{chr(39)}{c}`' for c in CHANNELS)}",
                Operand("channels", "names of channels", (Kind.LIST, Kind.SYMBOL), raw=True),
            ),
        ),
        only_name_published=True,
    ),
    _native("blank", "Nothing is asked for.", (_DURATION,), _blank, "blank .5"),
    _native(
        "seq",
        f"One score after the other, {GAP_S:g} s apart unless said.",
        (Operand("list", "a list of scores", (Kind.LIST,)),),
        _seq,
        "seq (list (blank 1) (blank 1)) 'gap .1",
        options=(
            Option("gap", "seconds between two", Operand("gap", "seconds", (Kind.NUMBER,)), GAP_S),
        ),
        uses_machine=True,
    ),
    _native(
        "fixed",
        "The score keeps its length when what it stands in is stretched.",
        (Operand("score", "a score", (Kind.SCORE,)),),
        _fixed,
        "fixed (blank .2)",
    ),
    _native(
        "ref",
        "A ref that is computed, for the rules of a `sync`.",
        (
            Operand("block", "a block, such as `'SIG` or `'INFO/SIG`", (Kind.SYMBOL,)),
            Operand(
                "bound", "`'start`, `'end` or a fraction", (Kind.SYMBOL, Kind.NUMBER), raw=True
            ),
            Operand("offset", "seconds", (Kind.NUMBER,), optional=True),
        ),
        _ref,
        "ref 'SIG 'end .1",
        result=Kind.SYMBOL,
    ),
    Native(
        "sync",
        Group.SCORES,
        "Named blocks on one time line. The first has no rule; each later one is followed by a "
        "rule word and its operands.",
        result=Kind.SCORE,
        published=True,
        example="sync 'SIG (blank 1) 'FACE (key 1 (morph 'AU12 .5)) 'start/end 'SIG:start 'SIG:end",
        resolve=resolve_sync,
        pattern=PATTERN,
    ),
)
