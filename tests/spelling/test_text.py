"""Texts that are spelled: letters of three alphabets, casing, modes, what is left out."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from azee.lang.library import shipped_library
from azee.lang.program import evaluate_expression
from azee.score.score import Key, leaves
from azee.spelling.text import LANGUAGES, Language, spelled
from azee_solver.constraint import Place

ALPHABETS: dict[Language, str] = {
    "asl": "ABCDEFGHIJKLMNOPQRSTUVWXYZ",
    "lsf": "ABCDEFGHIJKLMNOPQRSTUVWXYZ",
    "tid": "ABCÇDEFGĞHIİJKLMNOÖPRSŞTUÜVYZ",
}


def letters(text: str, language: Language, mode: str = "letters") -> list[str]:
    found = spelled(text, language, mode)  # type: ignore[arg-type]
    return ["".join(word.letters) for word in found.words]


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_letter_and_digit_of_an_alphabet_has_a_rule(language: Language) -> None:
    rules = shipped_library(language).namespace.rules
    wanted = {f"letter-{letter}" for letter in ALPHABETS[language]}
    wanted |= {f"digit-{digit}" for digit in range(10)}
    assert wanted <= rules.keys()
    assert {name for name in rules if name.startswith("letter-")} == {
        name for name in wanted if name.startswith("letter-")
    }
    found = spelled(ALPHABETS[language] + "0123456789", language)
    assert found.unknown == ()
    assert found.words[0].letters == (*ALPHABETS[language], *"0123456789")


def test_turkish_case_knows_the_dot() -> None:
    assert letters("ışık İI iı", "tid") == ["IŞIK", "İI", "İI"]
    assert letters("kâğıt", "tid") == ["KAĞIT"]


def test_accents_are_left_out_where_the_alphabet_has_none() -> None:
    assert letters("Éléonore ça", "lsf") == ["ELEONORE", "CA"]


def test_the_thesis_writes_turkish_letters_as_capitals() -> None:
    assert letters("Ggi IOUSC", "tid", "thesis") == ["ĞGİ", "IÖÜŞÇ"]
    assert spelled("A", "tid", "thesis").unknown == ("A",)


def test_words_that_the_library_has_are_signed() -> None:
    found = spelled("bonjour Zoé", "lsf", "words")
    assert [word.sign for word in found.words] == ["bonjour", None]
    assert ":bonjour" in found.expression([[], [(0.1, 0.2)] * 3])


def test_what_the_alphabet_lacks_is_told_once_and_left_out() -> None:
    found = spelled("w-x-q? w", "tid")
    assert found.unknown == ("w", "-", "x", "q", "?")
    assert found.words == ()


@given(st.text(max_size=12))
def test_any_text_gives_an_expression_or_nothing(text: str) -> None:
    found = spelled(text, "asl")
    kept = "".join("".join(word.characters) for word in found.words)
    assert all(
        character in kept or character in found.unknown for character in "".join(text.split())
    )
    if found.words:
        times = [[(0.1, 0.2)] * len(word.characters) for word in found.words]
        assert evaluate_expression(found.expression(times)).score.duration > 0


def test_the_times_are_those_that_are_given() -> None:
    found = spelled("cab", "asl")
    score = evaluate_expression(found.expression([[(0.1, 0.2), (0.3, 0.4), (0.5, 0.0)]])).score
    held = [leaf.interval for leaf in leaves(score) if isinstance(leaf.score, Key)]
    assert [float(i.start) for i in held] == pytest.approx([0.0, 0.3, 1.0])
    assert [float(i.end) for i in held] == pytest.approx([0.1, 0.6, 1.5])


def test_the_second_of_a_double_bounces_and_is_farther_out() -> None:
    score = evaluate_expression(":fingerspelling 'text \"add\" 'language 'asl").score
    keys = [leaf for leaf in leaves(score) if isinstance(leaf.score, Key)]
    assert [float(leaf.interval.duration) == 0.0 for leaf in keys] == [False, False, True, False]
    wrists = [
        constraint.point
        for leaf in keys
        if isinstance(leaf.score, Key)
        for constraint in leaf.score.constraints
        if isinstance(constraint, Place) and constraint.site.name == "WR"
    ]
    assert len(wrists) == 4
    assert wrists[0] == wrists[1]
    assert len(set(wrists)) == 3
