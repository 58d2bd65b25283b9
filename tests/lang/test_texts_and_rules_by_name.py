"""Texts as values, and rules that are found by them."""

from __future__ import annotations

from pathlib import Path

import pytest
from evaluations import content, found, program, value
from hypothesis import given
from hypothesis import strategies as st

from azee.lang.values import Kind, ListValue, NumberValue, OperatorValue, TextValue
from azee.score.score import Group, Key
from azee_grammar.diagnostic import AZeeError

WORDS = st.text(st.characters(exclude_characters='"', exclude_categories=("C", "Z", "M")))


def _elements(expression: str) -> list[object]:
    listed = value(expression)
    assert isinstance(listed, ListValue)
    assert listed.size == 1 + len(listed.content)
    return [element.content for element in listed.content]


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ('letters "BAGDAD"', ["B", "A", "G", "D", "A", "D"]),
        ('letters "âge"', ["â", "g", "e"]),
        ('letters "a\u0302ge"', ["â", "g", "e"]),
        ('letters "q\u0302"', ["q\u0302"]),
        ('letters "a b"', ["a", " ", "b"]),
        ('letters ""', []),
        ("digits 52", [5, 2]),
        ("digits 0", [0]),
        ("digits 101000", [1, 0, 1, 0, 0, 0]),
        ("join (list 1 'a) (list) (list 2)", [1, "a", 2]),
        ("join", []),
        ("part (list 1 2 3) 2 3", [2, 3]),
        ("part (list 1 2 3) 1 1", [1]),
        ("part (list) 1 0", []),
        ("part (list 1 2 3) 4 3", []),
    ],
)
def test_texts_and_numbers_are_taken_apart(expression: str, expected: list[object]) -> None:
    assert _elements(expression) == expected


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ('lower "BAGDAD É"', "bagdad é"),
        ('upper "Bagdad é"', "BAGDAD É"),
        ('unaccented "Çà et là, Orléans"', "Ca et la, Orleans"),
        ('concat "nb-" 5 \'x .5 -1', "nb-5x0.5-1"),
        ('concat "e" "\u0301"', "é"),
        ('eq "âge" "a\u0302ge"', True),
        ('eq "a" "A"', False),
        ("quotient 1984 100", 19),
        ("remainder 1984 100", 84),
        ("quotient -7 2", -4),
        ("remainder -7 2", 1),
    ],
)
def test_texts_and_numbers_are_made(expression: str, expected: object) -> None:
    assert content(expression) == expected


@pytest.mark.parametrize(
    ("code", "expression"),
    [
        ("number-range", "digits -1"),
        ("number-range", "digits .5"),
        ("number-range", "digits 1000000000000000"),
        ("division-by-zero", "quotient 1 0"),
        ("division-by-zero", "remainder 1 0"),
        ("index-range", "part (list 1 2) 0 1"),
        ("index-range", "part (list 1 2) 1 3"),
        ("index-range", "part (list 1 2) 1 1.5"),
        ("wrong-type", "letters 'x"),
        ("wrong-type", "concat (list)"),
    ],
)
def test_texts_and_numbers_with_mistakes(code: str, expression: str) -> None:
    with pytest.raises(AZeeError) as raised:
        value(expression)
    assert [d.code for d in raised.value.diagnostics] == [code]


@given(WORDS)
def test_letters_make_their_text_again(word: str) -> None:
    whole = f'fold (azop \'all "" \'letter "" concat(^all, ^letter)) "" letters("{word}")'
    assert content(f'eq "{word}" ({whole})') is True


@given(st.integers(0, 10**15 - 1))
def test_digits_make_their_number_again(number: int) -> None:
    digits = f"digits({number})"
    assert content(f"fold (azop 'n 0 'd 0 add(mul(10, ^n), ^d)) 0 {digits}") == number


@given(st.integers(-(10**9), 10**9), st.integers(1, 10**6))
def test_quotient_and_remainder_make_the_number_again(number: int, divisor: int) -> None:
    quotient, remainder = (content(f"{word} {number} {divisor}") for word in _DIVISIONS)
    assert isinstance(quotient, float)
    assert isinstance(remainder, float)
    assert quotient * divisor + remainder == number
    assert 0 <= remainder < divisor


_DIVISIONS = ("quotient", "remainder")


def test_texts_cannot_grow_without_end() -> None:
    grow = 'fold (azop \'all "" \'n 0 concat(^all, ^all)) "abcdefgh" range(1, 60)'
    with pytest.raises(AZeeError) as raised:
        value(grow)
    assert [d.code for d in raised.value.diagnostics] == ["step-limit"]


# Kinds ----------------------------------------------------------------------------------------


SAMPLES = {
    "is-number": "1",
    "is-text": '"a"',
    "is-symbol": "'a",
    "is-list": "list()",
    "is-point": "^Mssp",
    "is-constraints": "(look ^fwd)",
    "is-score": ":bien",
    "is-rule": ".nb-5",
}


@pytest.mark.parametrize("word", SAMPLES)
def test_a_value_is_of_one_kind_only(word: str) -> None:
    assert {w: content(f"{word} {text}") for w, text in SAMPLES.items()} == {
        w: w == word for w in SAMPLES
    }


def test_a_site_counts_as_a_point() -> None:
    assert content("is-point @CH") is True
    assert content("is-point !head") is False


def test_an_argument_may_be_a_rule_or_a_score() -> None:
    definitions = (
        "def counted\n    azop 'count 'nodefault\n"
        "        if (is-rule ^count) apply(^count) ^count\n"
    )
    for written in (".nb-5", ":nb-5"):
        score = content(f":counted 'count {written}", definitions)
        assert isinstance(score, Key)
        assert "nb-5" in [call.rule for call in score.calls]


# Rules by name --------------------------------------------------------------------------------


def test_a_text_finds_a_rule() -> None:
    by_text, by_name = value('rule concat("nb-", 5)'), value(".nb-5")
    assert isinstance(by_text, OperatorValue)
    assert isinstance(by_name, OperatorValue)
    assert by_text.content.procedure is by_name.content.procedure
    assert content('has-rule "nb-5"') is True
    assert content('has-rule "nb-55"') is False


def test_every_letter_is_applied() -> None:
    score = content(
        'seq map((azop \'d 0 (apply rule(concat("nb-", ^d)))), digits(52))',
    )
    assert isinstance(score, Group)
    assert [b.score.calls[0].rule for b in score.blocks] == ["nb-5", "nb-2"]


@pytest.mark.parametrize(
    ("text", "mistakes"),
    [
        (':bien\ndef f\n    apply rule("nb-55")\n', ["unknown-rule 3:16"]),
        ('apply rule(concat("nb-", 55))\n', ["unknown-rule 1:12"]),
        ("apply rule('nb-5)\n", ["wrong-type 1:12"]),
        ("apply rule(concat(\"nb-\", 5), 'in, 'core)\n", ["unknown-keyword 1:30"]),
        ('apply rule("nb-5", \'of)\n', ["missing-value 1:20"]),
        ("apply rule(\"nb-5\", 'of, 'core, 1)\n", ["too-many-arguments 1:32"]),
        ('apply rule("nb-5", "nb-4")\n', ["too-many-arguments 1:20"]),
        ("apply rule(\"nb-5\", 'of, 'cor)\n", ["library-not-found 1:25"]),
        ('apply rule("nb-5", \'of, "core")\n', ["wrong-type 1:25"]),
        ("apply rule(\"bien\", 'of, 'core)\n", ["unknown-rule 1:12"]),
        ("apply rule()\n", ["missing-argument 1:7"]),
        ('if has-rule("nb-55") rule("nb-5") :bien\n', []),
        ("if (has-rule 5) :bien :bien\n", ["wrong-type 1:14"]),
    ],
)
def test_names_without_rules(text: str, mistakes: list[str]) -> None:
    assert found(text) == mistakes


def test_near_names_are_told() -> None:
    with pytest.raises(AZeeError) as raised:
        value('rule concat("nb-", 55)')
    assert raised.value.diagnostics[0].help == "did you mean `nb-5`?"


def test_a_rule_may_find_itself_by_name() -> None:
    definitions = (
        "def down\n    azop 'n 'nodefault\n"
        '        if (lt ^n 1) ^n (apply (rule "down") \'n sub(^n, 1))\n'
    )
    assert content(":down 'n 5", definitions) == 0


@pytest.fixture
def libraries(tmp_path: Path) -> Path:
    (tmp_path / "north.azee").write_text(
        "def n-one\n    blank 1\n"
        "def spelt\n    azop 'what 'nodefault 'of 'north apply(rule(^what, 'of, ^of))\n"
        "def called\n    azop 'what 'nodefault apply(rule(^what))\n"
    )
    (tmp_path / "south.azee").write_text("def s-one\n    blank 2\n")
    (tmp_path / "east.azee").write_text("def n-one\n    blank 3\n")
    return tmp_path


@pytest.mark.parametrize(
    ("expression", "seconds"),
    [
        ('apply rule("n-one")', 1),
        ("apply rule(\"n-one\", 'of, 'north)", 1),
        ("apply rule(\"s-one\", 'of, 'south)", 2),
        ('called("n-one")', 1),
        ('spelt("n-one")', 1),
        ('spelt("s-one", \'south)', 2),
    ],
)
def test_rules_that_nothing_else_names_are_found_in_libraries(
    expression: str, seconds: int, libraries: Path
) -> None:
    text = f"use 'north\nuse 'south\n{expression}\n"
    assert program(text, libraries).score().duration == seconds


def test_a_rule_looks_where_it_was_written(libraries: Path) -> None:
    text = "use 'north\nuse 'south\ndef mine\n    blank 9\n{}\n"
    assert program(text.format('apply rule("mine")'), libraries).score().duration == 9
    assert found(text.format('called("s-one")'), libraries)[0].startswith("unknown-rule")
    assert found(text.format('called("mine")'), libraries)[0].startswith("unknown-rule")


def test_a_text_that_names_two_rules(libraries: Path) -> None:
    text = "use 'north\nuse 'east\n"
    assert found(f'{text}apply rule("n-one")\n', libraries) == ["ambiguous-rule 3:12"]
    chosen = program(f"{text}apply rule(\"n-one\", 'of, 'east)\n", libraries)
    assert chosen.score().duration == 3


def test_sizes_and_kinds_of_what_is_made() -> None:
    assert value("digits 7") == ListValue((NumberValue(7.0),), 2, 2)
    assert value('letters "a"') == ListValue((TextValue("a"),), 2, 2)
    assert value('rule "nb-5"').kind is Kind.OPERATOR
