"""How well a score was met is said in one phrase, and in good grammar."""

from __future__ import annotations

import math

import pytest

import azee
from azee.quality.constraint_results import ConstraintResult
from azee.quality.likeness import Likeness
from azee.quality.motion_report import MotionReport
from azee.quality.outcome import amount, misses, outcome, shortfall
from azee.wording import counted


def result(*, met: bool) -> ConstraintResult:
    return ConstraintResult(
        path=("topic",),
        rule=None,
        kind="place",
        subject="place @EL(s)",
        target="@PA(w)",
        start_s=0.0,
        end_s=1.0,
        residual=0.0 if met else 0.0123,
        unit="m",
        tolerance=0.001,
        met=met,
        reason=None if met else "out of reach by 12.3 mm",
    )


def report(met: int, missed: int) -> MotionReport:
    constraints = (*(result(met=True),) * met, *(result(met=False),) * missed)
    return MotionReport(
        "sticks",
        30,
        "tracks",
        1,
        0,
        1,
        lambda: constraints,
        0.0,
        None,
        (),
        (),
        tuple,
        measure_penetration=tuple,
        measure_likeness=unmeasured,
    )


def unmeasured() -> Likeness:
    raise AssertionError("an outcome needs no likeness")


@pytest.mark.parametrize(
    ("met", "missed", "phrase"),
    [
        (0, 0, "no constraint to meet"),
        (1, 0, "1 constraint is met"),
        (16, 0, "all 16 constraints are met"),
        (0, 1, "1 constraint is out of tolerance"),
        (15, 1, "1 of 16 constraints is out of tolerance"),
        (14, 2, "2 of 16 constraints are out of tolerance"),
        (0, 2, "2 of 2 constraints are out of tolerance"),
    ],
)
def test_the_outcome_is_counted(met: int, missed: int, phrase: str) -> None:
    assert outcome(report(met, missed)) == phrase
    assert len(misses(report(met, missed))) == missed


def test_a_miss_says_by_how_much_and_why() -> None:
    (missed,) = misses(report(1, 1))
    assert missed.text == "place @EL(s) @PA(w)"
    assert shortfall(missed) == "off by 12.3 mm, out of reach by 12.3 mm"


def test_amounts_are_in_millimetres_and_degrees() -> None:
    assert amount(0.0123, "m") == "12.3 mm"
    assert amount(math.radians(1.25), "rad") == "1.2°"
    assert amount(None, "m") == "what cannot be measured"


def test_nouns_are_counted() -> None:
    assert [counted(n, "file") for n in (0, 1, 2)] == ["0 files", "1 file", "2 files"]


CIRCLING = "(moving (circle ^fwd .03 {}) point(-.2, -.1, .35) point(-.2, -.1, .35))"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("key .2 (morph 'AU12 5)", "no face goes so far: weights are from −1 to 1"),
        ("key .2 (trill !palm(s) ^up 'freq 16)", "no 30 frames a second can show 16 oscillations"),
        ("key .2 (trill !palm(s) ^up 'freq 99999)", "can show 99999 oscillations"),
        (f"key .5 (place @I_TIP(s) {CIRCLING.format(100_000)})", "no 30 frames a second can show"),
    ],
)
def test_what_no_body_can_show_is_not_said_to_be_met(text: str, reason: str) -> None:
    made = azee.compile(expression=text)
    assert not made.report.met
    (constraint,) = made.report.constraints
    assert reason in str(constraint.reason)
    assert outcome(made.report) == "1 constraint is out of tolerance"


@pytest.mark.parametrize(
    "text",
    [
        "key .2 (morph 'AU12 -1)",
        "key .2 (trill !palm(s) ^up 'freq 5)",
        f"key 1 (place @I_TIP(s) {CIRCLING.format(1)})",
    ],
)
def test_what_a_body_can_just_show_is_met(text: str) -> None:
    assert azee.compile(expression=text).report.met
