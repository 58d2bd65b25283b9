"""Places of a discourse, named once for a text, and references to them."""

from __future__ import annotations

from pathlib import Path

import pytest
from evaluations import found, problems, program

from azee.score.score import Key, leaves
from azee_grammar.diagnostic import Severity
from azee_solver.constraint import Place
from azee_solver.geometry import (
    NamedPoint,
    Point,
    Scale,
    SigningSpace,
    Site,
    SitePoint,
    Vec,
    VTranslate,
)

RSSP, LSSP = NamedPoint(SigningSpace.RSSP), NamedPoint(SigningSpace.LSSP)
POINT = "key .1 (place @I_TIP(s) {})\n"
BACK = (
    'def back\n    \'refers "pt"\n'
    "    azop 'pt 'nodefault 'sig :bien ^sig\n"
    "def put\n    azop 'sig 'nodefault 'pt ^Mssp ^sig\n"
)


def _point(text: str) -> Point:
    key = next(leaf.score for leaf in leaves(program(text).score()) if isinstance(leaf.score, Key))
    (constraint,) = key.constraints
    assert isinstance(constraint, Place)
    return constraint.point


@pytest.mark.parametrize(
    ("text", "point"),
    [
        ("places 'p ^Rssp\n" + POINT.format("^p"), RSSP),
        (POINT.format("^p") + "places\n    'o ^Lssp\n    'p ^Rssp\n", RSSP),
        ("places('p, ^Rssp)\n" + POINT.format("^p"), RSSP),
        ("places 'p @CH\n" + POINT.format("^p"), SitePoint(Site("CH"))),
        (
            "places 'p ^Rssp 'q vtranslate(^p, scale(^up, .1))\n" + POINT.format("^q"),
            VTranslate(RSSP, Scale(Vec(0.0, 1.0, 0.0), 0.1)),
        ),
        ("places 'Rssp ^Lssp\n" + POINT.format("^Rssp"), LSSP),
        (":f\ndef f\n    " + POINT.format("^p") + "places 'p ^Rssp\n", RSSP),
        (
            ":f\ndef f\n    azop 'p ^Lssp (" + POINT.format("^p").strip() + ")\nplaces 'p ^Rssp\n",
            LSSP,
        ),
        (":f\ndef f\n    azop 'l ^p (key .1 (place @I_TIP(s) ^l))\nplaces 'p ^Rssp\n", RSSP),
        ("let 'p ^Lssp (key .1 (place @I_TIP(s) ^p))\nplaces 'p ^Rssp\n", LSSP),
        ("places 'p g()\n" + POINT.format("^p") + "def g\n    ^Rssp\n", RSSP),
    ],
)
def test_a_place_is_seen_in_the_whole_text(text: str, point: Point) -> None:
    assert found(text) == []
    assert _point(text) == point


@pytest.mark.parametrize(
    ("text", "mistakes"),
    [
        ("places 'a ^Rssp 'a ^Lssp\n", ["duplicate-argument 1:17"]),
        ("places 'a ^Rssp\nplaces 'a ^Lssp\n", ["duplicate-argument 2:8"]),
        ("places\n", ["missing-argument 1:1"]),
        ("places 'a\n", ["missing-value 1:8"]),
        ("places ^a ^Rssp\n", ["expected-argument-name 1:8"]),
        ("places 'a 5\nkey 1 (lookat ^a)\n", ["wrong-type 1:11"]),
        ("places 'a ^b 'b ^Rssp\n", ["unknown-name 1:11"]),
        ("places 'a vtranslate(^Rssp)\n", ["missing-argument 1:11"]),
        ("places 'a ^Rssp\nkey 1 (lookat ^b)\n", ["unknown-name 2:15"]),
        ("seq (list (places 'a ^Rssp))\n", ["unknown-operator 1:12"]),
    ],
)
def test_places_with_mistakes(text: str, mistakes: list[str]) -> None:
    assert found(text) == mistakes


def test_near_places_are_told() -> None:
    (problem,) = problems("places 'cinema ^Rssp\nkey 1 (lookat ^cinama)\n")
    assert problem.help == "did you mean `^cinema`?"


def test_places_are_no_utterance() -> None:
    assert len(program("places 'a ^Rssp\n:bien\n").utterances) == 1


def test_a_place_belongs_to_its_text(tmp_path: Path) -> None:
    library = "places 'p ^Rssp\ndef at-p\n    " + POINT.format("^p")
    (tmp_path / "own.azee").write_text(library)
    assert found("use 'own\n:at-p\n", tmp_path) == []
    assert found("use 'own\nkey 1 (lookat ^p)\n", tmp_path) == ["unknown-name 2:15"]
    (tmp_path / "own.azee").write_text("places 'p 3\ndef at-p\n    :bien\n")
    assert found("use 'own\n:at-p\n", tmp_path) == ["wrong-type 1:11"]


# References -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "mistakes"),
    [
        (":back 'pt ^Lssp\n", ["unintroduced-place 1:11"]),
        ("back(^Lssp)\n", ["unintroduced-place 1:6"]),
        (":back 'pt ^Lssp\n:back 'pt ^Lssp\n", ["unintroduced-place 1:11"]),
        (":put 'sig :bien 'pt ^Lssp\n:back 'pt ^Lssp\n", []),
        (":back 'pt ^Lssp\n:put 'sig :bien 'pt ^Lssp\n", ["unintroduced-place 1:11"]),
        (":put 'sig :bien 'pt ^Rssp\n:back 'pt ^Lssp\n", ["unintroduced-place 2:11"]),
        ("seq (list arbre(^Lssp) back(^Lssp))\n", []),
        ("places 'a ^Lssp\n:put 'sig :bien 'pt ^a\n:back 'pt ^Lssp\n", []),
        ("places 'a ^Lssp\n:back 'pt ^a\n", ["unintroduced-place 2:11"]),
        (":back 'pt ^addressee\n", []),
        (":back 'pt @CH\n", []),
        (":put 'sig :bien 'pt (point 0 0 .1)\n:back 'pt (point 0 0 .1)\n", []),
        (":back 'sig :back('pt = ^Lssp) 'pt ^Lssp\n", ["unintroduced-place 1:24"]),
        ("alias(^Lssp)\n", ["unintroduced-place 1:7"]),
        (":wrapped 'pt ^Lssp\n", []),
    ],
)
def test_a_reference_wants_a_place_that_was_introduced(text: str, mistakes: list[str]) -> None:
    more = (
        "def alias\n    azop 'where 'nodefault back(^where)\n"
        "def wrapped\n    azop 'pt 'nodefault seq(list(:back('pt = ^pt), :bien))\n"
    )
    assert found(text + BACK + more) == mistakes


def test_it_is_a_warning() -> None:
    text = ":back 'pt ^Lssp\n" + BACK
    (problem,) = problems(text)
    assert problem.severity is Severity.WARNING
    assert "`:back` refers to `^Lssp`" in problem.message
    assert program(text).score().duration > 0
