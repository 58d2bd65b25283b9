"""Scores made of scores: elsewhere, smaller, longer, again, by the hands in turn."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

from azee.lang.hands import kept, names_arm
from azee.lang.machine import HEAVY, Machine
from azee.lang.native import Group, Native, Occurrence, Operand, Option
from azee.lang.operators.scores import GAP_S, duration_of, exact_seconds
from azee.lang.reflection import MIRROR, NoMirrorImage
from azee.lang.relocation import Relocation
from azee.lang.resizing import Resizing
from azee.lang.values import ConstraintsValue, Kind, ScoreValue, Value, VectorValue
from azee.score.articulators import arm_of
from azee.score.bounds import Placement
from azee.score.error import LayoutError
from azee.score.layout import Part, in_sequence, require_measurable, synchronised
from azee.score.moment import Bound, Moment
from azee.score.score import Score
from azee.score.stretch import paced, stretched
from azee_solver.geometry import Side

MOST_TIMES = 1000
"""How often one score is repeated at most."""


def _relocate(at: Occurrence, machine: Machine, content: Value, vector: Value) -> Value:
    machine.spend(content.size, at.span)
    assert isinstance(vector, VectorValue)
    change = Relocation(vector.content)
    if isinstance(content, ScoreValue):
        score = change.score(content.content)
    else:
        assert isinstance(content, ConstraintsValue)
        constraints = tuple(change.constraint(c) for c in content.content)
    size = content.size + change.moved * (1 + vector.size)
    depth = max(content.depth, vector.depth) + 1
    machine.require_size(size, at.span)
    machine.require_depth(depth, at.span)
    if isinstance(content, ScoreValue):
        return ScoreValue(score, size, depth)
    return ConstraintsValue(constraints, size, depth)


def _resize(at: Occurrence, machine: Machine, value: ScoreValue, factor: float) -> Value:
    if factor < 0:
        raise at.fault("number-range", "a score cannot have a negative size", "factor")
    return _resized(at, machine, value, factor)


def _resized(at: Occurrence, machine: Machine, value: ScoreValue, factor: float) -> ScoreValue:
    if factor == 1.0:
        return value
    machine.spend(value.size, at.span)
    change = Resizing.of(value.content, factor)
    size = value.size + change.growth(value.content)
    machine.require_size(size, at.span)
    machine.require_depth(value.depth + 1, at.span)
    return ScoreValue(change.score(value.content), size, value.depth + 1)


def _stretch(
    at: Occurrence,
    machine: Machine,
    value: ScoreValue,
    *,
    to: float | None,
    by: float | None,
) -> Value:
    if (to is None) is (by is None):
        message = "`stretch` wants either the new length, `'to SECONDS`, or `'by FACTOR`"
        raise at.fault("missing-argument", message)
    machine.spend(value.size, at.span)
    try:
        if to is not None:
            score = stretched(value.content, duration_of(at, to, "seconds"))
        else:
            assert by is not None
            score = _paced(at, value.content, by)
        require_measurable(score.duration, None)
    except LayoutError as problem:
        raise at.fault(problem.code, f"this {problem}", "score") from None
    return ScoreValue(score, value.size, value.depth)


def _paced(at: Occurrence, score: Score, factor: float) -> Score:
    if factor <= 0:
        raise at.fault("number-range", "a score is stretched by more than 0", "factor")
    duration_of(at, float(score.duration) * factor, "factor")
    return paced(score, exact_seconds(factor))


def _repeat(
    at: Occurrence,
    machine: Machine,
    value: ScoreValue,
    times: float,
    *,
    gap: float,
    damping: float,
) -> Value:
    count = _times(at, times)
    if not 0 <= damping <= 1:
        raise at.fault("number-range", "damping goes from 0, none, to 1", "damping")
    return _repeated(at, machine, value, count, duration_of(at, gap, "gap"), damping)


def _repeated(
    at: Occurrence,
    machine: Machine,
    value: ScoreValue,
    count: int,
    gap_s: Fraction,
    damping: float = 0.0,
) -> ScoreValue:
    if count == 1:
        return value
    machine.require_size(1 + count * value.size, at.span)
    each = [_resized(at, machine, value, (1.0 - damping) ** k) for k in range(count)]
    return _sequence(at, machine, each, gap_s)


def _sequence(
    at: Occurrence, machine: Machine, values: list[ScoreValue], gap_s: Fraction
) -> ScoreValue:
    size = 1 + sum(value.size for value in values)
    depth = 1 + max(value.depth for value in values)
    machine.spend(HEAVY * len(values), at.span)
    machine.require_size(size, at.span)
    machine.require_depth(depth, at.span)
    try:
        group = in_sequence([value.content for value in values], gap_s)
    except LayoutError as problem:
        raise at.fault(problem.code, str(problem), "score") from None
    return ScoreValue(group, size, depth)


def _alternate(
    at: Occurrence,
    machine: Machine,
    value: ScoreValue,
    times: float,
    *,
    gap: float,
    phase: float | None,
) -> Value:
    count, gap_s = _times(at, times), duration_of(at, gap, "gap")
    machine.require_size(1 + 2 * count * value.size, at.span)
    machine.spend(2 * value.size, at.span)
    if phase is None:
        other = _sized(value, _mirrored(at, value.content)) if count > 1 else value
        turns = [other if turn % 2 else value for turn in range(count)]
        return turns[0] if count == 1 else _sequence(at, machine, turns, gap_s)
    if not 0 <= phase <= 1:
        message = "a phase goes from 0, both hands at once, to 1, a whole repetition later"
        raise at.fault("number-range", message, "phase")
    strong, weak = _hands(at, value)
    cycle_s = value.content.duration + gap_s
    first = _repeated(at, machine, strong, count, gap_s)
    second = _repeated(at, machine, weak, count, gap_s)
    later = Moment(("STRONG",), Bound.START, cycle_s * exact_seconds(phase))
    parts = [
        Part("STRONG", first.content, Placement()),
        Part("WEAK", second.content, Placement(start=later)),
    ]
    depth = 1 + max(first.depth, second.depth)
    machine.require_depth(depth, at.span)
    try:
        return ScoreValue(synchronised(parts), 1 + first.size + second.size, depth)
    except LayoutError as problem:
        raise at.fault(problem.code, str(problem), "score") from None


def _hands(at: Occurrence, value: ScoreValue) -> tuple[ScoreValue, ScoreValue]:
    """Return all but the weak hand, and the weak hand: as it is, or as a mirror image.

    The weak hand of a score that only moves the strong one mirrors it.
    """
    score = value.content
    weak = kept(score, lambda c: arm_of(c) is Side.WEAK)
    if not names_arm(score, Side.WEAK):
        weak = _mirrored(at, kept(score, lambda c: arm_of(c) is Side.STRONG))
    rest = kept(score, lambda c: arm_of(c) is not Side.WEAK)
    return _sized(value, rest), _sized(value, weak)


def _mirrored(at: Occurrence, score: Score) -> Score:
    try:
        return MIRROR.score(score)
    except NoMirrorImage as problem:
        raise at.fault("unknown-morph", str(problem), "score") from None


def _sized(value: ScoreValue, score: Score) -> ScoreValue:
    """Return a score with no more parts than that of a value."""
    return ScoreValue(score, value.size, value.depth)


def _times(at: Occurrence, times: float) -> int:
    if times != int(times) or not 1 <= times <= MOST_TIMES:
        message = f"a score is repeated a whole number of times, from 1 to {MOST_TIMES}"
        raise at.fault("number-range", message, "times")
    return int(times)


def _native(
    name: str,
    meaning: str,
    operands: tuple[Operand, ...],
    function: Callable[..., Any],
    example: str,
    options: tuple[Option, ...] = (),
    result: Kind | None = Kind.SCORE,
) -> Native:
    return Native(
        name,
        Group.SCORES,
        meaning,
        operands,
        options,
        result=result,
        function=function,
        example=example,
        uses_machine=True,
        whole=True,
    )


def _number(name: str, meaning: str) -> Operand:
    return Operand(name, meaning, (Kind.NUMBER,))


_SCORE = Operand("score", "a score", (Kind.SCORE,), raw=True)
_TIMES = _number("times", "how often")
_GAP = Option("gap", "seconds between two", _number("gap", "seconds"), GAP_S)

OPERATORS = (
    _native(
        "relocate",
        "A score, or constraints, elsewhere: points in space that it names are moved by a vector. "
        "Places on the body and the addressee stay.",
        (
            Operand("content", "a score or constraints", (Kind.SCORE, Kind.CONSTRAINTS), raw=True),
            Operand("vector", "in metres of the reference signer", (Kind.VECTOR,), raw=True),
        ),
        _relocate,
        "relocate :bonjour (scale ^left .1)",
        result=None,
    ),
    _native(
        "resize",
        "A score with larger or smaller movements. The points at which it places a site are drawn "
        "towards their middle, or towards those on the body, which stay; arcs, circles, trills "
        "and turns of head, trunk and shoulders become as much larger or smaller.",
        (_SCORE, _number("factor", "1 changes nothing, .5 makes it half as large")),
        _resize,
        "resize :bonjour .5",
    ),
    _native(
        "stretch",
        "A score of another length. All times in it are multiplied, but parts that are `fixed` "
        "keep their lengths.",
        (_SCORE,),
        _stretch,
        "stretch :bonjour 'to 2",
        (
            Option("to", "the new length", _number("seconds", "seconds")),
            Option("by", "how many times as long", _number("factor", "a factor")),
        ),
    ),
    _native(
        "repeat",
        f"A score several times, {GAP_S:g} s apart unless said. With damping each repetition is "
        "smaller than the one before: by a fifth for .2.",
        (_SCORE, _TIMES),
        _repeat,
        "repeat :chat 3 'gap .1 'damping .2",
        (
            _GAP,
            Option(
                "damping", "how much smaller each repetition is", _number("damping", "0 to 1"), 0.0
            ),
        ),
    ),
    _native(
        "alternate",
        "A score by both hands in turn: as it is, then its mirror image, and so on. With a phase "
        "both hands repeat it, the weak hand by that part of a repetition later; it does what the "
        "score says of it, or else the mirror image of what the strong hand does.",
        (_SCORE, _TIMES),
        _alternate,
        "alternate :nb-5 2 'phase .5",
        (
            _GAP,
            Option("phase", "the delay of the weak hand", _number("phase", "0 to 1")),
        ),
    ),
)
