"""Where rules are found: the text, its libraries, the core."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from evaluations import found, problems, program

from azee.lang.library import names_in
from azee.lang.program import evaluate_expression, load
from azee_grammar.diagnostic import AZeeError
from azee_grammar.files import read_source
from azee_grammar.source import Source
from azee_grammar.syntax import Utterance


def _write(folder: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return folder


def _seconds(text: str, *libraries: Path) -> float:
    return float(program(text, *libraries).score().duration)


def test_a_library_is_a_folder_of_texts(tmp_path: Path) -> None:
    _write(tmp_path, {"mine/a.azee": "def one\n    blank 1\n", "mine/b.az": "def two\n    :one\n"})
    assert _seconds("use 'mine\n:two", tmp_path) == 1


def test_a_text_of_one_azop_defines_the_rule_of_its_name(tmp_path: Path) -> None:
    _write(tmp_path, {"mine/l'été.azee": "azop 'd 3\n    blank ^d\n"})
    assert _seconds("use 'mine\n:l'été", tmp_path) == 3
    _write(tmp_path, {"pause.azee": "azop 'd 3\n    blank ^d\n"})
    loaded = load(read_source(tmp_path / "pause.azee"))
    assert loaded.check() == ()
    assert loaded.utterances == ()


def test_a_library_may_be_one_text(tmp_path: Path) -> None:
    _write(tmp_path, {"mine.azee": "def one\n    blank 1\n:one\n"})
    assert _seconds("use 'mine\n:one", tmp_path) == 1


def test_libraries_are_looked_for_beside_the_text_first(tmp_path: Path) -> None:
    _write(tmp_path / "elsewhere", {"mine/a.azee": "def one\n    blank 1\n"})
    _write(
        tmp_path / "here", {"mine/a.azee": "def one\n    blank 2\n", "t.azee": "use 'mine\n:one"}
    )
    source = read_source(tmp_path / "here" / "t.azee")
    assert load(source, [tmp_path / "elsewhere"]).score().duration == 2


def test_a_library_of_ones_own_hides_the_one_that_ships(tmp_path: Path) -> None:
    _write(tmp_path, {"lsf/a.azee": "def arbre\n    blank 9\n"})
    assert _seconds("use 'lsf\n:arbre", tmp_path) == 9


def test_the_text_wins_over_libraries_and_those_over_the_core(tmp_path: Path) -> None:
    _write(tmp_path, {"mine/a.azee": "def headshake\n    blank 7\n"})
    assert _seconds("use 'mine\n:headshake", tmp_path) == 7
    assert _seconds("use 'mine\ndef headshake\n    blank 8\n:headshake", tmp_path) == 8


def test_using_the_core_changes_nothing(tmp_path: Path) -> None:
    _write(tmp_path, {"mine/a.azee": "def headshake\n    blank 7\n"})
    assert _seconds("use 'core\nuse 'mine\n:headshake", tmp_path) == 7


def test_a_rule_keeps_the_scope_it_was_defined_in(tmp_path: Path) -> None:
    _write(tmp_path, {"mine/a.azee": "def inner\n    blank 1\ndef outer\n    :inner\n"})
    assert _seconds("use 'mine\ndef inner\n    blank 2\n:outer", tmp_path) == 1
    assert _seconds("def headshake\n    blank 9\nnot-but(blank(1), blank(1))") < 3


def test_without_any_use_the_core_and_lsf_are_in_scope(tmp_path: Path) -> None:
    assert found("info-about(:arbre, :bien)") == []
    _write(tmp_path, {"mine/a.azee": "def one\n    blank 1\n"})
    assert found("use 'mine\ninfo-about(:arbre, :one)", tmp_path) == ["unknown-rule 2:12"]
    assert found("use 'mine\nuse 'lsf\ninfo-about(:arbre, :one)", tmp_path) == []


def test_one_name_in_two_libraries_is_ambiguous(tmp_path: Path) -> None:
    _write(tmp_path, {"a/x.azee": "def one\n    blank 1\n", "b/y.azee": "def one\n    blank 2\n"})
    text = "use 'a\nuse 'b\n"
    (problem,) = problems(text + ":one\n", tmp_path)
    assert problem.code == "ambiguous-rule"
    assert [r.span.source.name for r in problem.related] == [
        str(tmp_path / "a" / "x.azee"),
        str(tmp_path / "b" / "y.azee"),
    ]
    assert found(text, tmp_path) == []
    assert found(text + "def one\n    blank 3\n:one\n", tmp_path) == []


def test_libraries_may_use_each_other(tmp_path: Path) -> None:
    _write(
        tmp_path,
        {
            "a/x.azee": "use 'b\ndef one\n    :two\n",
            "b/y.azee": "use 'a\ndef two\n    blank 2\ndef three\n    :one\n",
        },
    )
    assert _seconds("use 'a\n:one", tmp_path) == 2
    assert _seconds("use 'b\n:three", tmp_path) == 2


def test_what_is_wrong_in_a_library_is_reported_with_its_file(tmp_path: Path) -> None:
    _write(tmp_path, {"mine/a.azee": "def one\n    :nope\ndef two\n    (\n"})
    reported = problems("use 'mine\nblank 1\n", tmp_path)
    assert [(p.code, p.span and p.span.source.name) for p in reported] == [
        ("unknown-rule", str(tmp_path / "mine" / "a.azee")),
        (reported[1].code, str(tmp_path / "mine" / "a.azee")),
    ]


def test_a_library_defines_a_name_once(tmp_path: Path) -> None:
    _write(tmp_path, {"mine/a.azee": "def one\n    blank 1\n", "mine/b.azee": "azop blank(1)\n"})
    _write(tmp_path, {"mine/c.azee": "def one\n    blank 1\n"})
    (problem,) = problems("use 'mine\nblank 1\n", tmp_path)
    assert problem.code == "duplicate-definition"
    assert problem.span is not None
    assert problem.span.source.name == str(tmp_path / "mine" / "c.azee")


def test_files_that_some_systems_cannot_tell_apart(tmp_path: Path) -> None:
    _write(tmp_path, {"mine/One.az": "azop blank(1)\n", "mine/one.azee": "azop blank(2)\n"})
    reported = problems("use 'mine\nblank 1\n", tmp_path)
    assert [p.code for p in reported] == ["duplicate-definition"]


@pytest.mark.parametrize("name", ["../mine", "..", "/etc", "mine/../mine", ".hidden", "a\\b"])
def test_no_text_reads_outside_its_folders(name: str, tmp_path: Path) -> None:
    _write(tmp_path, {"mine/a.azee": "def one\n    blank 1\n", ".hidden/a.azee": "blank 1\n"})
    assert found(f"use '{name}\n", tmp_path / "mine", tmp_path) == ["library-not-found 1:5"]


def test_a_library_that_is_not_utf8_is_reported(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "a.azee").write_bytes(b"def \xe2ge\n    blank 1\n")
    assert [p.code for p in problems("use 'mine\nblank 1\n", tmp_path)] == ["not-utf8"]


def test_an_expression_sees_the_rules_of_its_text() -> None:
    assert program("def one\n    blank 1\n").evaluate(":one").score.duration == 1
    assert evaluate_expression("seq(list(:Irak, :Irak))").score.duration == pytest.approx(2.2)
    assert evaluate_expression(":Irak").label == ":Irak"


@pytest.mark.parametrize("text", ["", ":nope", "3", "key 1 (", "blank 1\nblank 2", "hold 'A 1"])
def test_an_expression_with_a_mistake_raises_what_is_wrong(text: str) -> None:
    with pytest.raises(AZeeError):
        evaluate_expression(text)


def test_utterances_play_one_second_apart() -> None:
    loaded = program(":Irak\ndef one\n    blank 1\n:one\nblank 3\n")
    assert [u.label for u in loaded.utterances] == [":Irak", ":one", "blank"]
    assert loaded.score().duration == 7
    assert loaded.score(2) == loaded.utterances[1].score
    assert loaded.utterances[2].span.line == 5


def test_an_editor_reads_the_texts_of_libraries_itself(tmp_path: Path) -> None:
    (tmp_path / "signs.azee").write_text("def a\n    :chat\n", encoding="utf-8")
    main = tmp_path / "main.azee"
    main.write_text("use 'signs\n:b\n", encoding="utf-8")

    def unsaved(path: Path) -> Source:
        return Source(str(path), path.read_text(encoding="utf-8").replace("def a", "def b"))

    source = read_source(main)
    assert [d.code for d in load(source).check()] == ["unknown-rule"]
    assert load(source, read=unsaved).check() == ()


def test_an_utterance_known_to_be_right_is_passed_over() -> None:
    program = load(Source("text", ":chat\n:nobody\n:nothing\n"))
    right, wrong, _ = program.file.items
    assert isinstance(right, Utterance)
    assert isinstance(wrong, Utterance)
    assert program.problems(right) == ()
    assert [d.code for d in program.problems(wrong)] == ["unknown-rule"]
    assert len(program.check(sound={wrong})) == 1


SIBLINGS = {
    "sib/a.azee": "def shared\n    azop\n        'shape 'nodefault\n        apply ^shape\n",
    "sib/b.azee": "def uses\n    key 1 :#shared(.flat-hand)\ndef bien\n    blank 7\n",
    "sib/own.azee": "azop 'd 3\n    seq(list(:bien, blank ^d))\n",
}


def _checked(path: Path) -> list[str]:
    return [d.code for d in load(read_source(path)).check()]


def test_a_file_of_a_folder_library_sees_the_others(tmp_path: Path) -> None:
    _write(tmp_path, SIBLINGS | {"sib/c.azee": "use 'sib\ndef q\n    key 1 :#shared(.fist)\n"})
    for name in ("a", "b", "c", "own"):
        assert _checked(tmp_path / f"sib/{name}.azee") == []
    one = load(read_source(tmp_path / "sib/own.azee"))
    # the library's own `bien` counts in it; `seq` puts .2 s between the two
    assert float(one.evaluate(":own").score.duration) == 7 + 0.2 + 3


def test_a_mistake_in_a_sibling_counts_where_its_rule_is_used(tmp_path: Path) -> None:
    broken = "def shared\n    key 1 :nobody\ndef other\n    key 1 :nothing\ndef c\n    (\n"
    _write(tmp_path, {"sib/a.azee": broken, "sib/b.azee": "def b\n    :shared\n"})
    assert _checked(tmp_path / "sib/b.azee") == []
    with pytest.raises(AZeeError, match="nobody"):
        load(read_source(tmp_path / "sib/b.azee")).evaluate(":b")


def test_a_text_with_utterances_does_not_see_what_lies_beside(tmp_path: Path) -> None:
    _write(tmp_path, SIBLINGS | {"sib/text.azee": ":bien\n:uses\n", "sib/empty.azee": "\n"})
    assert _checked(tmp_path / "sib/text.azee") == ["unknown-rule"]
    assert _checked(tmp_path / "sib/empty.azee") == []


def test_where_use_drops_the_default_library_the_help_says_so(tmp_path: Path) -> None:
    _write(tmp_path, SIBLINGS)
    for text in ("use 'sib\n:arbre", "use 'sib\ndef a\n    :arbre"):
        (found,) = load(Source("<text>", text), [tmp_path]).check()
        assert found.code == "unknown-rule"
        assert found.help == ("`lsf` is out of scope because the text says `use`; add `use 'lsf`")
    assert load(Source("<text>", "use 'sib\nuse 'lsf\n:arbre"), [tmp_path]).check() == ()
    (found,) = load(Source("<text>", "use 'sib\n:arbr"), [tmp_path]).check()
    assert "out of scope" not in (found.help or "")


def test_links_and_pipes_in_a_library_are_told_and_not_read(tmp_path: Path) -> None:
    _write(tmp_path, {"lib/mine/a.azee": "def one\n    blank 1\n", "out/b.azee": "def two\n"})
    library = tmp_path / "lib" / "mine"
    (library / "b.azee").symlink_to(tmp_path / "out" / "b.azee")
    os.mkfifo(library / "pipe.azee")
    (tmp_path / "lib" / "away").symlink_to(tmp_path / "out")
    (tmp_path / "lib" / "round").symlink_to(tmp_path / "lib" / "round")
    (tmp_path / "lib" / "same").symlink_to(library)
    os.mkfifo(tmp_path / "lib" / "wind.azee")
    assert names_in(tmp_path / "lib") == ["mine", "same"]
    found = load(Source("<text>", "use 'mine\n:one"), [tmp_path / "lib"]).check()
    assert [(d.code, d.message.split("` ")[1]) for d in found] == [
        ("cannot-read", "is a link that leads outside its library"),
        ("cannot-read", "is not a plain file"),
    ]
    (found_none,) = load(Source("<text>", "use 'away\n"), [tmp_path / "lib"]).check()
    assert found_none.code == "library-not-found"
    assert "leads outside" in (found_none.help or "")


def test_a_library_of_a_name_that_no_system_takes_is_not_found() -> None:
    (found,) = load(Source("<text>", f"use '{'n' * 300}\n"), [Path()]).check()
    assert found.code == "library-not-found"
    assert load(Source("n" * 300, ":arbre\n")).check() == ()
