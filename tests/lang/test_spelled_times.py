"""When letters of a spelled text happen, as the language has it."""

from __future__ import annotations

import pytest
from evaluations import found as mistakes
from evaluations import value

from azee.lang.operators.spelling import TIMINGS
from azee.lang.program import evaluate_expression
from azee.lang.values import ListValue
from azee.score.score import Key, leaves
from azee.spelling.timing import schedule as schedules
from azee.spelling.timing.schedule import Pace, Timing, schedule


def rows(expression: str) -> list[list[object]]:
    listed = value(expression)
    assert isinstance(listed, ListValue)
    assert listed.size == 1 + sum(row.size for row in listed.content)
    found: list[list[object]] = []
    for row in listed.content:
        assert isinstance(row, ListValue)
        found.append([number.content for number in row.content])
    return found


def test_the_timings_are_those_of_the_models() -> None:
    assert TIMINGS == schedules.TIMINGS


@pytest.mark.parametrize("timing", ["variable", "normalised", "constant"])
def test_letters_have_the_times_of_the_model(timing: Timing) -> None:
    times = schedule("GUITAR", timing, Pace(2.0, 1.5))
    told = rows(f"letter-times \"guitar\" '{timing} 'speed 2 'transitions 1.5")
    assert told == [[round(t.hold_s, 4), round(t.transition_s, 4)] for t in times]


def test_words_have_times_of_their_own_and_spaces_none() -> None:
    cab = rows('letter-times "CAB" \'constant')
    assert rows('letter-times "cab  Çáb" \'constant') == [*cab, [0, 0], [0, 0], *cab]


@pytest.mark.parametrize(
    ("expression", "code"),
    [
        ('letter-times "QUOKKA" \'motion', "spelling-times"),
        ("letter-times \"A\" 'constant 'speed 0", "number-range"),
        ("letter-times \"A\" 'constant 'transitions -1", "number-range"),
        ('letter-times "A" \'slow', "unknown-keyword"),
    ],
)
def test_what_is_wrong_is_told(expression: str, code: str) -> None:
    assert [place.split()[0] for place in mistakes(expression)] == [code]


def test_a_spelled_text_takes_a_timing_a_speed_and_a_factor_for_transitions() -> None:
    text = ":fingerspelling 'text \"guitar\" 'timing 'variable 'speed 2 'transitions 1.5"
    keys = [leaf for leaf in leaves(evaluate_expression(text).score) if isinstance(leaf.score, Key)]
    times = schedule("GUITAR", "variable", Pace(2.0, 1.5))
    starts = [sum(t.hold_s + t.transition_s for t in times[:n]) for n in range(len(times))]
    assert [float(leaf.interval.start) for leaf in keys] == pytest.approx(starts, abs=1e-3)


@pytest.mark.parametrize(("factors", "held_s", "way_s"), [
    ("", 0.243, 0.25), ("'speed 2", 0.1215, 0.125), ("'transitions 2", 0.243, 0.5),
    ("'hold .1 'way .3", 0.1, 0.3),
])  # fmt: skip
def test_without_a_timing_letters_are_even(factors: str, held_s: float, way_s: float) -> None:
    score = evaluate_expression(f':fingerspelling \'text "cab" {factors}').score
    keys = [leaf.interval for leaf in leaves(score) if isinstance(leaf.score, Key)]
    assert [float(i.end) - float(i.start) for i in keys] == pytest.approx([held_s] * 3)
    assert float(keys[1].start) == pytest.approx(held_s + way_s)
