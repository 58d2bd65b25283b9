"""Every mistake of evaluation: its code, its place, and what is said about it."""

from __future__ import annotations

from pathlib import Path

import pytest
from evaluations import found, place, problems, program
from mistakes import MISTAKES, Mistake

import azee.lang
import azee.score
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.source import Source, Span
from azee_grammar.syntax import Application, Hole, OperatorName
from azee_solver.geometry import Side


@pytest.mark.parametrize(
    "mistake",
    MISTAKES,
    ids=lambda mistake: mistake.text.replace("\n", "⏎"),
)
def test_a_mistake_is_found_where_it_is(mistake: Mistake) -> None:
    reported = problems(mistake.text)
    assert tuple(place(problem) for problem in reported) == mistake.found
    assert mistake.words in reported[0].message
    assert mistake.help in (reported[0].help or "")


def test_every_mistake_of_evaluation_is_among_them() -> None:
    codes = {entry.partition(" ")[0] for mistake in MISTAKES for entry in mistake.found}
    elsewhere = {"step-limit", "template-hole", "ambiguous-rule", "no-utterance"}
    sources = "\n".join(
        path.read_text(encoding="utf-8")
        for package in (azee.lang, azee.score)
        for path in Path(package.__path__[0]).rglob("*.py")
    )
    assert sorted(code for code in codes if f'"{code}"' not in sources) == []
    for code in elsewhere:
        assert f'"{code}"' in sources


def test_a_hole_is_for_templates_only() -> None:
    loaded = program("")
    span = Span(Source("template", "blank ?x"), 6, 8)
    diagnostics: list[Diagnostic] = []
    hole = Application(span, OperatorName(span, "blank"), (Hole(span, "x"),), called=False)
    loaded.resolving.resolver(loaded.scope, None, diagnostics).resolve(hole)
    assert [place(d) for d in diagnostics] == ["template-hole 1:7"]


def test_one_utterance_does_not_hide_the_mistakes_of_another() -> None:
    text = "blank div(1, 0)\nkey 1 (place 3 ^Mssp)\n:arbr\nblank 1\nblank div(2, 0)\n"
    assert found(text) == [
        "division-by-zero 1:14",
        "wrong-type 2:14",
        "unknown-rule 3:1",
        "division-by-zero 5:14",
    ]


def test_independent_mistakes_of_one_utterance_are_all_reported() -> None:
    text = "let 'z 0 seq(list(blank(div(1, ^z)), blank(neg(1)), key(1, look(^upp))))\n"
    assert found(text) == ["unknown-name 1:65"]
    text = text.replace("^upp", "^up")
    assert found(text) == ["division-by-zero 1:32", "negative-duration 1:44"]


def test_rules_that_nobody_calls_are_checked() -> None:
    text = (
        "def f\n    azop 'x 'nodefault key(1, place(@I_TIP(^x), ^Msp))\n"
        "def g\n    :info-about 'topic :f 'info :nope\n"
        "def h\n    key(1, morph('smil, 1))\n"
    )
    assert found(text) == [
        "unknown-name 2:49",
        "missing-argument 4:24",
        "unknown-rule 4:33",
        "unknown-morph 6:18",
    ]


def test_a_mistake_in_a_rule_is_reported_once_however_often_it_is_called() -> None:
    text = "def f\n    azop 'x 0 blank(div(1, ^x))\n:f\n:f\n:f 'x 2\n"
    assert found(text) == ["division-by-zero 2:28"]


def test_the_rule_call_stack_is_shown_innermost_first() -> None:
    text = "def f\n    azop 'x 0 blank(div(1, ^x))\ndef g\n    :f 'x 0\n\n:g\n"
    (problem,) = problems(text)
    assert [(r.message, r.span.line, r.span.column) for r in problem.related] == [
        ("while evaluating `:f`, called", 4, 5),
        ("while evaluating `:g`, called", 6, 1),
    ]


def test_a_mistake_in_an_argument_is_not_inside_the_rule() -> None:
    (problem,) = problems("tree(vtranslate(^Mssp, scale(^up, div(1, 0))))")
    assert problem.related == ()


def test_a_long_call_stack_is_shortened() -> None:
    (problem,) = problems("def f\n    :f\n:f")
    assert len(problem.related) == 12
    assert "more calls in between are left out" in problem.notes[0]
    assert problem.related[-1].span.line == 3


def test_a_broken_definition_spoils_nothing_else() -> None:
    text = "def f\n    azop 'x ((\n:f 'x 1\n:f\n"
    assert {entry.partition(" ")[2].partition(":")[0] for entry in found(text)} == {"2"}


def test_the_other_dominant_hand_is_checked_when_it_is_asked_for() -> None:
    text = "key 1 (cstr (orient 'nrm !palm(s) 'along ^up) (orient 'nrm !palm(L) 'along ^up))"
    assert found(text) == []
    assert [place(p) for p in program(text).check(Side.LEFT)] == ["orient-conflict 1:48"]


@pytest.mark.parametrize(
    ("text", "utterance", "words"),
    [
        ("", None, "is empty"),
        ("# nothing\n", None, "is empty"),
        ("def f\n    :bien\n", None, "only definitions"),
        (":bien\n", 2, "no utterance 2"),
    ],
)
def test_a_score_needs_an_utterance(text: str, utterance: int | None, words: str) -> None:
    with pytest.raises(AZeeError) as caught:
        program(text).score(utterance)
    (problem,) = caught.value.diagnostics
    assert problem.code == "no-utterance"
    assert words in problem.message


def test_each_ref_of_a_sync_rule_that_names_no_block_is_reported() -> None:
    found = program("sync 'A (blank 1) 'B (blank 1) 'start/end 'X:start 'Y:end").check()
    assert [(d.code, d.message[-3:], str(d.span)) for d in found] == [
        ("unknown-block", "`X`", "text.azee:1:43"),
        ("unknown-block", "`Y`", "text.azee:1:52"),
    ]
    found = program(
        "sync 'A (blank 1) 'A (blank 2) 'start 'A:end 'A (blank 3) 'start 'A:end"
    ).check()
    assert [(d.code, str(d.span)) for d in found] == [
        ("duplicate-block", "text.azee:1:19"),
        ("duplicate-block", "text.azee:1:46"),
    ]


@pytest.mark.parametrize("path", ["'A:start", "'A/", "'/A"])
def test_what_a_block_is_within_is_a_block_and_no_moment(path: str) -> None:
    """Whatever is wrong with the path, a colon or a part without a name."""
    (problem,) = problems(f"sync 'A (key .5 (look ^up)) 'B (key .1 (look ^up)) 'with {path}")
    assert problem.code == "bad-ref"
    assert problem.message == "`'with` wants the name of a block alone"


def test_a_broken_block_brings_no_mistake_about_its_sync() -> None:
    text = "key (sync 'A :arbr 'B (key .1 (look ^up)) 'start 'A:end) (look ^up)"
    assert found(text) == ["unknown-rule 1:14"]


@pytest.mark.parametrize(
    ("bone", "taken"),
    [("!palm", "a side"), ("!head", "no side"), ("!index", "a side, then a phalanx")],
)
def test_too_many_operands_are_told_with_those_that_a_bone_takes(bone: str, taken: str) -> None:
    told = problems(f"key 1 (look dir({bone}(s, 1, 1)))")
    (problem,) = (p for p in told if p.code == "too-many-arguments")
    assert f"`{bone}` takes {taken}" in problem.message
