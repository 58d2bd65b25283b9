"""Mouthing: sounds from SAMPA and from spelling, their shapes, and scores of them."""

from __future__ import annotations

import csv
import re
from fractions import Fraction
from pathlib import Path

import pytest
from evaluations import found, group, problems, times
from hypothesis import given
from hypothesis import strategies as st

from azee.lang.operators.mouthing import CONSONANT_S, VOWEL_S
from azee.score.score import Group, Key, is_mouthing, leaves
from azee_grammar import sounds as sounds_module
from azee_grammar.sounds import (
    LANGUAGES,
    UnknownSoundError,
    sounds_of,
    spelled,
    visemes,
)
from azee_grammar.vocabulary import MORPHS
from azee_solver.constraint import Morph

PAGE = (Path(__file__).parents[2] / "docs" / "language" / "mouthing.md").read_text("utf-8")
BLOCKS = re.findall(r"^```azee\n(.*?)^```$", PAGE, re.M | re.S)
DATA = Path(sounds_module.__file__).parent / "data"


# Sounds -----------------------------------------------------------------------------------------


def plain(sampa: str) -> list[str]:
    return [sound.sampa + ":" * sound.is_long for sound in sounds_of(sampa)]


@pytest.mark.parametrize(
    ("sampa", "expected"),
    [
        ("bo~ZuR", ["b", "o~", "Z", "u", "R"]),
        ("h9y:s", ["h", "9", "y:", "s"]),
        ("E_i", ["E", "i"]),
        ('"ba.na-%na |', ["b", "a", "n", "a", "n", "a"]),
        ("9~a", ["9~", "a"]),
        ("", []),
    ],
)
def test_sampa_is_read_sound_by_sound(sampa: str, expected: list[str]) -> None:
    assert plain(sampa) == expected


@pytest.mark.parametrize(("sampa", "sign"), [("ba*", "*"), (":a", ":"), ("b~", "~"), ("ß", "ß")])
def test_what_is_no_sampa_is_named(sampa: str, sign: str) -> None:
    with pytest.raises(UnknownSoundError) as caught:
        sounds_of(sampa)
    assert caught.value.sign == sign


@given(st.lists(st.tuples(st.sampled_from(sorted(visemes())), st.booleans())))
def test_sounds_that_are_written_apart_read_back(written: list[tuple[str, bool]]) -> None:
    text = " ".join(sound + ":" * long for sound, long in written)
    assert [(s.sampa, s.is_long) for s in sounds_of(text)] == written


@pytest.mark.parametrize(
    ("word", "sampa"),
    [
        ("bonjour", "bo~ZuR"),
        ("maison", "mEzo~"),
        ("oiseau", "wazo"),
        ("chat", "Sa"),
        ("français", "fRa~sE"),
        ("beaucoup", "boku"),
        ("travail", "tRavaj"),
        ("famille", "famij"),
        ("fille", "fij"),
        ("ville", "vil"),
        ("soleil", "sOlEj"),
        ("cinéma", "sinema"),
        ("armoire", "aRmwaR"),
        ("pays", "pei"),
        ("bien", "bje~"),
        ("mignon", "miJo~"),
        ("garçon", "gaRso~"),
        ("manger", "ma~Ze"),
        ("hier", "jER"),
        ("oui", "wi"),
        ("août", "u"),
        ("temps", "ta~"),
        ("parents", "paRa~"),
        ("trois", "tRwa"),
        ("monsieur", "m@sj2"),
        ("grand", "gRa~"),
        ("ÉCOLE", "ekOl"),
        ("l'ami !", "l ami"),
    ],
)
def test_french_spelling_is_read(word: str, sampa: str) -> None:
    assert spelled(word, "fr") == sampa


@pytest.mark.parametrize(
    ("word", "sampa"),
    [
        ("house", "haUz"),
        ("tree", "tri"),
        ("make", "meIk"),
        ("time", "taIm"),
        ("night", "naIt"),
        ("through", "TroU"),
        ("station", "st{S@n"),
        ("church", "tS9tS"),
        ("phone", "foUn"),
        ("yes", "jes"),
        ("cat", "k{t"),
        ("good", "gud"),
    ],
)
def test_english_spelling_is_read(word: str, sampa: str) -> None:
    assert spelled(word, "en") == sampa


@pytest.mark.parametrize(("text", "sign"), [("b5", "5"), ("5", "5"), ("日本", "日"), ("ça ø", "ø")])
def test_what_has_no_spelling_is_named(text: str, sign: str) -> None:
    with pytest.raises(UnknownSoundError) as caught:
        spelled(text, "fr")
    assert caught.value.sign == sign


@given(st.text("abcdefghijklmnopqrstuvwxyzéèêàçïœ' -", max_size=12), st.sampled_from(LANGUAGES))
def test_any_word_is_read_or_a_letter_named(text: str, language: str) -> None:
    named = ""
    try:
        sounds_of(spelled(text, language))
    except UnknownSoundError as error:
        named = error.sign
    assert named in text


@given(st.text("abcdefghijklmnopqrstuvwxyz", max_size=12), st.sampled_from(LANGUAGES))
def test_any_word_of_plain_letters_is_read(text: str, language: str) -> None:
    assert all(sound.sampa in visemes() for sound in sounds_of(spelled(text, language)))


def test_every_spelling_of_the_tables_has_known_sounds_and_is_used() -> None:
    with (DATA / "spellings.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) > 200
    assert {row["language"] for row in rows} == set(LANGUAGES)
    for row in rows:
        sounds_of(row["sounds"])
    keys = [tuple(row.values())[:4] for row in rows]
    assert len(keys) == len(set(keys))


# Shapes -----------------------------------------------------------------------------------------


def test_shapes_are_facial_morphs_within_their_weights() -> None:
    assert len(visemes()) > 50
    for sound, viseme in visemes().items():
        assert viseme.weights, sound
        for name, weight in viseme.weights.items():
            assert MORPHS[name].kind.startswith("facial"), name
            assert 0 < weight <= 1


def test_lips_close_for_labials_only() -> None:
    closed = {sound for sound, viseme in visemes().items() if "AU25" not in viseme.weights}
    assert closed == {"p", "b", "m", "S", "Z", "C"}  # the last three part the lips by AU22_25


def test_the_page_lists_the_table() -> None:
    shown = re.findall(r"^\| `([^`]+)` \| (`AU.*|`tongue.*) \|$", PAGE, re.M)
    with (DATA / "visemes.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(sounds, morphs.replace("`", "")) for sounds, morphs in shown] == [
        (row["sounds"], row["morphs"]) for row in rows
    ]


# Scores -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", BLOCKS)
def test_the_examples_of_the_page_evaluate(text: str) -> None:
    assert len(BLOCKS) > 3
    assert found(text) == []


def test_a_mouthing_is_a_block_for_each_sound_without_gaps() -> None:
    score = group('mouthing "maman"')
    assert times(score) == {
        "m": (0, 0.08),
        "a": (0.08, 0.2),
        "m2": (0.2, 0.28),
        "a~": (0.28, 0.4),
    }
    assert is_mouthing(score)
    assert [call.title for call in score.calls] == ["“maman”"]
    shapes = [leaf.score for leaf in leaves(score)]
    assert all(isinstance(shape, Key) for shape in shapes)
    first = shapes[0]
    assert isinstance(first, Key)
    assert first.constraints == (Morph("AU24", None, 0.6),)


def test_sounds_may_be_given_and_long() -> None:
    given_sounds = group('mouthing "monsieur" \'sampa "m@sj2:"')
    assert given_sounds.duration == 3 * CONSONANT_S + VOWEL_S * (1 + Fraction(3, 2))
    assert times(group("mouthing 'huis 'sampa 'h9ys")).keys() == {"h", "9", "y", "s"}
    assert times(group("mouthing \"yes\" 'language 'en")).keys() == {"j", "e", "s"}


def test_a_mouth_is_stretched_to_what_it_goes_with() -> None:
    both = group('with-mouth(blank(2), mouthing("bonjour"))')
    assert times(both) == {"SIG": (0, 2), "MOUTH": (0, 2)}
    mouth = both.block("MOUTH").score
    assert isinstance(mouth, Group)
    lengths = [block.interval_in_parent.duration for block in mouth.blocks]
    natural = group('mouthing "bonjour"')
    scale = Fraction(2) / natural.duration
    assert lengths == [b.interval_in_parent.duration * scale for b in natural.blocks]
    assert is_mouthing(mouth)


def test_a_rule_may_hand_the_text_on() -> None:
    definitions = "def say\n    azop 'text 'nodefault (mouthing ^text)\n"
    said = group('say("chat")', definitions)
    assert said.blocks == group('mouthing "chat"').blocks
    assert [call.title for call in said.calls] == ["say", "“chat”"]


@pytest.mark.parametrize(
    ("expression", "message", "hint"),
    [
        ('mouthing "b5"', "does not know how `5` sounds", "SAMPA after `'sampa`"),
        ('mouthing "..."', "there is nothing to mouth", "SAMPA after `'sampa`"),
        ('mouthing ""', "there is nothing to mouth", "SAMPA after `'sampa`"),
        ('mouthing "a" \'sampa "a*"', "`*` is no sound of SAMPA", "it knows a A"),
        ('mouthing "a" \'sampa " "', "there is nothing to mouth", "SAMPA after `'sampa`"),
    ],
)
def test_what_cannot_be_mouthed_is_told_with_a_remedy(
    expression: str, message: str, hint: str
) -> None:
    (problem,) = problems(expression)
    assert problem.code == "unknown-sound"
    assert message in problem.message
    assert hint in (problem.help or "")


def test_a_language_that_is_not_known_is_refused() -> None:
    (problem,) = problems("mouthing \"ja\" 'language 'de")
    assert (problem.code, problem.help) == ("unknown-keyword", "it knows `'fr`, `'en`")
