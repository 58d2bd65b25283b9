"""When the letters of a spelled text are held and passed, by a model of timing."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator, Sequence
from itertools import groupby

from azee.lang.machine import Machine
from azee.lang.native import Group, Native, Occurrence, Operand, Option
from azee.lang.operators.texts import letters_of
from azee.lang.values import Kind, ListValue, NumberValue, Value

TIMINGS = ("variable", "motion", "normalised", "constant")


def _letter_times(
    at: Occurrence, machine: Machine, text: str, timing: str, **factors: float
) -> Value:
    letters = letters_of(text)
    size = 1 + 3 * len(letters)
    machine.spend(len(letters), at.span)
    machine.require_size(size, at.span)
    rows = _rows(at, letters, timing, factors["speed"], factors["transitions"])
    return ListValue(tuple(_pair(hold_s, way_s) for hold_s, way_s in rows), size, 3)


def _rows(
    at: Occurrence, letters: Sequence[str], timing: str, speed: float, transitions: float
) -> Iterator[tuple[float, float]]:
    """Yield a hold and the transition after it for every letter, seconds; none for a space."""
    from azee.spelling.timing.schedule import NotRecordedError, Pace, schedule

    for option, factor in (("speed", speed), ("transitions", transitions)):
        if factor <= 0:
            raise at.fault("number-range", f"`'{option}` is above 0", option)
    for space, run in groupby(letters, key=str.isspace):
        word = "".join(map(_plain, run))
        if space:
            yield from [(0.0, 0.0)] * len(word)
            continue
        try:
            times = schedule(word, timing, Pace(speed, transitions))  # type: ignore[arg-type]
        except NotRecordedError as error:
            remedy = "another timing foretells any word"
            raise at.fault("spelling-times", str(error), "timing", help=remedy) from error
        yield from ((t.hold_s, t.transition_s) for t in times)


def _plain(letter: str) -> str:
    """Return one capital for a letter: without its accents, which the models do not tell apart."""
    return unicodedata.normalize("NFD", letter)[0].upper()[0]


def _pair(hold_s: float, way_s: float) -> ListValue:
    return ListValue((NumberValue(round(hold_s, 4)), NumberValue(round(way_s, 4))), 3, 2)


def _factor(word: str, meaning: str) -> Option:
    return Option(word, meaning, Operand(word, "a number above 0", (Kind.NUMBER,)), 1.0)


OPERATORS = (
    Native(
        "letter-times",
        Group.TEXTS,
        "For every letter of a text that is spelled a list of two: for how long it is held, and "
        "how long the way to the next one takes, seconds; both are 0 for a space. `'variable` is "
        "foretold by the model that ships, `'constant` the same for all letters, `'normalised` "
        "constant in the time of `'variable`, and `'motion` as in the words of the model. "
        "[Timing](../spelling-timing.md) says where the numbers come from.",
        (
            Operand("text", "a text", (Kind.TEXT,)),
            Operand("timing", "which of the four timings", (Kind.SYMBOL,), TIMINGS),
        ),
        (
            _factor("speed", "how many times as fast; by default 1"),
            _factor("transitions", "how many times as long transitions are; by default 1"),
        ),
        result=Kind.LIST,
        example='letter-times "CAB" \'constant',
        function=_letter_times,
        uses_machine=True,
        whole=True,
    ),
)
