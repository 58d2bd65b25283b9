"""Templates match what is the same but for notation, and say what their holes stand for."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from any_programs import programs
from evaluations import place, program
from hypothesis import given, settings
from laws import examples

from azee.lang.template import Template
from azee_grammar.diagnostic import AZeeError
from azee_grammar.format import format_file, one_line
from azee_grammar.source import Source
from azee_grammar.syntax import Utterance

PAGE = Path(__file__).parents[2] / "docs" / "language" / "templates.md"
ROWS = re.findall(
    r"^\| `([^`]+)` \| `([^`]+)` \| (matches|does not match)\b.*\|$",
    PAGE.read_text(encoding="utf-8"),
    re.M,
)


def found(template: str, text: str, *libraries: Path) -> list[tuple[str, dict[str, str]]]:
    """Place of each match with what the holes stand for."""
    loaded = program(text, *libraries)
    return [
        (
            f"{match.expr.span.line}:{match.expr.span.column}",
            {name: one_line(expr) for name, expr in match.bindings.items()},
        )
        for match in Template.read(template).search(loaded)
    ]


def whole(template: str, text: str) -> bool:
    """Whether the template matches the text's utterance as a whole."""
    return any(where == "1:1" for where, _ in found(template, text))


@pytest.mark.parametrize(("template", "text", "verdict"), ROWS)
def test_the_manual_says_what_matches(template: str, text: str, verdict: str) -> None:
    assert whole(template, text) is (verdict == "matches")


def test_all_rows_of_the_manual_are_read() -> None:
    assert len(ROWS) == PAGE.read_text(encoding="utf-8").count("\n| `") > 5


def test_holes_stand_for_arguments_by_name() -> None:
    text = """\
:info-about
    'info
    :tens-units
        'tens .nb-5
        'units .nb-2
    'topic :âge
"""
    assert found(":info-about(:âge, ?info)", text) == [
        ("1:1", {"info": ":tens-units 'tens .nb-5 'units .nb-2"})
    ]


def test_holes_are_told_in_the_order_of_the_template() -> None:
    ((_, bindings),) = found("info-about('info = ?b, 'topic = ?a)", "info-about(:chat, :bien)")
    assert list(bindings.items()) == [("b", ":bien"), ("a", ":chat")]


def test_matches_nest_outer_before_inner_in_rules_and_utterances() -> None:
    text = """\
def f
    azop
        'x
        info-about(:âge, :bien)
        info-about(^x, :chat)
info-about(info-about(:âge, :bien), info-about(:chat, :pays))
"""
    assert [where for where, _ in found("info-about(?a, ?b)", text)] == [
        "4:9",
        "5:9",
        "6:1",
        "6:12",
        "6:37",
    ]


def test_a_hole_used_twice_stands_for_the_same() -> None:
    assert found("list(?x, ?x)", "seq(list(:bien, bien()))") == [("1:5", {"x": ":bien"})]
    assert found("f(?x, ?x)", ":f(bien(), :bien)") == [("1:1", {"x": "bien()"})]
    assert found("list(?x, ?x)", "seq(list(:bien, :chat))") == []
    assert whole("f(?x, g(?x))", ":f(:info-about(:a, 1), :g(info-about('info = 1.0, 'topic = :a)))")
    assert not whole("f(?x, g(?x))", ":f(:info-about(:a, 1), :g(info-about(:b, 1)))")


@pytest.mark.parametrize(
    ("template", "text"),
    [
        ("vec 1 2 ?z", "vec(1, 2, 3)"),
        ("place ?s ?p 'dist ?d", "place(@CH, ^Mssp, 'dist = .1)"),
        ("!palm(?side)", "!palm s"),
        ("@I_TIP(s)", "@I_TIP s"),
        (":nobody(?x)", "nobody(1)"),
        (":nobody('a = ?x, 'b = 2)", ":nobody 'b 2 'a 1"),
        (":add-side-info 'topic ?a 'info ?b", "side-info(:chat, :mignon)"),
        (".Iraq", ".Irak"),
    ],
)
def test_notation_does_not_matter(template: str, text: str) -> None:
    assert whole(template, text)


@pytest.mark.parametrize(
    ("template", "text"),
    [
        ("vec 1 2 ?z", "vec 2 1 3"),
        ("!palm(s)", "!palm(w)"),
        ("!palm(s)", "!palm"),
        ("^up", "^down"),
        ("s", "w"),
        ("'a", "'b"),
        ('"a"', '"b"'),
        ("1", "'1"),
        (":nobody(?x)", "nobody('a = 1)"),
        (":nobody(?x)", ".nobody(1)"),
        (".not-but", ".nicht-sondern"),
        (".not-but(?x)", ".nicht-sondern(:chat)"),
        ("key ?d ?c", "hold ?d ?c"),
        ("eq(1, 1)", ":eq(1, 1)"),
    ],
)
def test_what_says_something_else_does_not_match(template: str, text: str) -> None:
    assert not whole(template, text.replace("?", "^"))


FORWARDING = """\
def base
    azop
        'a 'nodefault
        'b .5
        key(^b, ^a)
"""


@pytest.mark.parametrize(
    ("body", "same"),
    [
        ("azop('x, 'nodefault, 'y, 'nodefault, :base(^x, ^y))", True),
        ("azop('x, 'nodefault, 'y, .5, base('b = ^y, 'a = ^x))", True),
        ("azop('x, 'nodefault, 'y, .7, :base(^x, ^y))", False),
        ("azop('x, 'nodefault, 'y, 'nodefault, :base(^y, ^x))", False),
        ("azop('x, 'nodefault, 'y, 'nodefault, :base(^x))", False),
        ("azop('x, 'nodefault, 'y, 'nodefault, :base(^x, 1))", False),
        ("azop('x, 'nodefault, 'y, 'nodefault, hold(:base(^x, ^y), 1))", False),
    ],
)
def test_a_rule_stands_for_another_only_if_it_does_nothing_else(body: str, same: bool) -> None:
    text = f"{FORWARDING}def other\n    {body}\n:other(look(^fwd), 1)\n"
    places = [where for where, _ in found("base(look(^fwd), ?b)", text)]
    assert ("8:1" in places) is same


def test_a_rule_that_is_handed_over_stands_for_another_with_the_same_arguments() -> None:
    for parameters, same in (
        ("'a, 'nodefault, 'b, .5", True),
        ("'b, .5, 'a, 'nodefault", False),
    ):
        text = f"{FORWARDING}def other\n    azop({parameters}, base(^a, ^b))\nmap(.other, list())\n"
        assert (len(found(".base", text)) == 1) is same


def test_forwarding_goes_on_and_a_circle_of_it_ends() -> None:
    chain = (
        FORWARDING
        + "def c\n    azop('y, 'nodefault, :base(^y))\ndef d\n    azop('z, 'nodefault, c(^z))\n"
    )
    assert found("base(?x)", chain + ":d(look(^up))")[-1] == ("10:1", {"x": "look(^up)"})
    circle = "def e\n    :g\ndef g\n    :e\n:e\n"
    assert ("5:1", {}) in found(":e", circle)


def test_names_mean_what_they_mean_in_the_text(tmp_path: Path) -> None:
    own = "def arbre\n    :chat\n:arbre\n"
    assert found("tree()", own) == []
    assert [where for where, _ in found(":chat", own)] == ["2:5", "3:1"]
    (tmp_path / "mine.azee").write_text("def katze\n    :chat\n", encoding="utf-8")
    used = "use 'mine\nuse 'lsf\n:katze\n"
    assert found(":chat", used, tmp_path) == [("3:1", {})]
    assert found(":chat", used) == []


@pytest.mark.parametrize(
    ("template", "code"),
    [
        ("info-about(?a)", "missing-argument 1:1"),
        ("list(info-about(?a, ?b, ?c))", "too-many-arguments 1:25"),
        (":info-about 'topc ?a 'info ?b", "unknown-argument 1:13"),
        (".info-about(?a)", None),
        ("nobody(?a)", None),
    ],
)
def test_a_template_fits_the_rules_that_are_known(template: str, code: str | None) -> None:
    problems = Template.read(template).problems(program(""))
    assert [place(p) for p in problems] == ([] if code is None else [code])


@pytest.mark.parametrize("text", ["", "key (", ":a\n:b", "? 1"])
def test_a_template_is_one_expression(text: str) -> None:
    with pytest.raises(AZeeError):
        Template.read(text)


@settings(max_examples=examples(0.5))
@given(programs)
def test_every_expression_matches_itself_however_it_is_laid_out(text: str) -> None:
    loaded, again = program(text), program(format_file(Source("a", text), published=True))
    for item, other in zip(loaded.file.items, again.file.items, strict=True):
        if isinstance(item, Utterance) and isinstance(other, Utterance):
            assert Template(item.expr).match(other.expr, loaded.scope) is not None


def test_deep_nesting_needs_no_deep_stack() -> None:
    deep = "neg(" * 190 + "1" + ")" * 190
    assert len(found("neg(?x)", deep)) == 190
    assert whole(f"list({deep}, ?x)", f"list({deep}, {deep})")
    assert whole("list(?x, ?x)", f"list({deep}, {deep})")
