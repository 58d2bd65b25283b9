"""Words become letters with times: the four timings, and what a user may change of them."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from azee.spelling.timing.model import DRAWN, shipped_model
from azee.spelling.timing.schedule import (
    TIMINGS,
    NotRecordedError,
    Pace,
    Timing,
    duration_s,
    schedule,
)
from azee.spelling.timing.syllables import starts

WORDS = st.text("ABCDEFGHIJKLMNOPQRSTUVWXYZÇĞÉ", min_size=1, max_size=14)
FORETOLD: tuple[Timing, ...] = ("variable", "normalised", "constant")


@given(WORDS, st.sampled_from(FORETOLD))
def test_every_word_has_a_hold_a_letter_and_a_way_between_letters(
    word: str, timing: Timing
) -> None:
    times = schedule(word, timing)
    assert "".join(t.letter for t in times) == word
    assert all(t.hold_s > 0 for t in times)
    assert all(t.transition_s > 0 for t in times[:-1])
    assert times[-1].transition_s == 0


@given(WORDS)
def test_normalised_is_constant_and_as_long_as_variable(word: str) -> None:
    normalised, constant = schedule(word, "normalised"), schedule(word, "constant")
    assert math.isclose(duration_s(normalised), duration_s(schedule(word)))
    ratios = {round(a.hold_s / b.hold_s, 9) for a, b in zip(normalised, constant, strict=True)}
    assert len(ratios) == 1


@given(WORDS, st.floats(0.2, 5), st.floats(0.2, 5))
def test_speed_divides_all_times_and_the_factor_multiplies_transitions(
    word: str, speed: float, factor: float
) -> None:
    plain, changed = schedule(word), schedule(word, pace=Pace(speed, factor))
    for a, b in zip(plain, changed, strict=True):
        assert math.isclose(b.hold_s, a.hold_s / speed)
        assert math.isclose(b.transition_s, factor * a.transition_s / speed)


@given(WORDS, st.floats(0.5, 3))
def test_syllables_leave_the_length_of_a_word(word: str, factor: float) -> None:
    parted = schedule(word, pace=Pace(syllable_factor=factor))
    assert math.isclose(duration_s(parted), duration_s(schedule(word)))


def test_a_way_between_syllables_grows_against_the_others() -> None:
    assert starts("ELEPHANT") == (1, 3)  # E-LE-PHANT
    plain, parted = schedule("ELEPHANT"), schedule("ELEPHANT", pace=Pace(syllable_factor=1.5))
    ratios = [b.transition_s / a.transition_s for a, b in zip(plain[:-1], parted[:-1], strict=True)]
    assert ratios[0] == pytest.approx(1.5 * ratios[1])
    assert ratios[2] == pytest.approx(ratios[0])
    assert len({round(r, 9) for r in ratios}) == 2


@pytest.mark.parametrize(
    ("word", "parts"),
    [
        ("GUITAR", "GUI-TAR"),
        ("HEAVEN", "HEA-VEN"),
        ("ARREST", "AR-REST"),
        ("PSYCHIATRY", "PSY-CHIA-TRY"),
        ("MOVIE", "MO-VIE"),
        ("THE", "THE"),
        ("PBS", "PBS"),
    ],
)
def test_syllables(word: str, parts: str) -> None:
    bounds = (0, *starts(word), len(word))
    assert "-".join(word[a:b] for a, b in pairwise(bounds)) == parts


def test_the_constant_timing_is_the_published_one() -> None:
    times = schedule("cab", "constant")
    assert times == (("C", 0.243, 0.250), ("A", 0.243, 0.250), ("B", 0.800, 0.0))


def test_motion_gives_the_times_of_the_word_in_the_model() -> None:
    word = shipped_model().recorded("GUITAR")
    assert word is not None
    times = schedule("guitar", "motion")
    assert tuple(t.hold_s for t in times) == word.holds_s
    assert tuple(t.transition_s for t in times[:-1]) == word.transitions_s
    with pytest.raises(NotRecordedError, match="QUOKKA"):
        schedule("quokka", "motion")


def test_the_last_letter_is_held_longest_and_doubles_follow_quickly() -> None:
    times = schedule("arrest")
    assert max(times, key=lambda t: t.hold_s) is times[-1]
    assert times[1].transition_s == min(t.transition_s for t in times[:-1]) < 0.1
    printed = schedule("arrest", transitions="regression")
    assert printed[1].transition_s > 0.15  # the published regression knows no doubles


def test_later_spellings_are_faster_by_what_is_published() -> None:
    def at(spelling: int) -> float:
        return duration_s(schedule("COACHELLA", pace=Pace(spelling=spelling)))

    lengths = [at(n) for n in range(1, 6)]
    assert lengths == sorted(lengths, reverse=True)
    shares = [at(5) / at(1), at(3) / at(1)]
    assert sum(shares) / 2 == pytest.approx(0.80, abs=0.02)


def test_careful_spelling_is_slower() -> None:
    careful = schedule("HEAVEN", model=shipped_model("careful"))
    assert all(a.hold_s > b.hold_s for a, b in zip(careful, schedule("HEAVEN"), strict=True))


def test_the_models_that_ship_say_that_they_are_drawn() -> None:
    assert shipped_model().origin == shipped_model("careful").origin == DRAWN
    assert "not recorded" in DRAWN


@pytest.mark.parametrize("name", ["speed", "transition_factor", "syllable_factor", "spelling"])
def test_a_pace_of_nothing_is_refused(name: str) -> None:
    with pytest.raises(ValueError, match="0"):
        Pace(**{name: 0})


def test_no_letters_have_no_times() -> None:
    assert [schedule("", timing) for timing in TIMINGS] == [()] * 4
