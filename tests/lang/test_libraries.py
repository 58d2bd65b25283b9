"""Where rules are found: the text, its libraries, the core."""

from __future__ import annotations

from pathlib import Path

import pytest
from evaluations import found, problems, program

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
