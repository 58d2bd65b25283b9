"""Libraries of many files: read when their rules are named, checked once, never out of date."""

from __future__ import annotations

import os
import pickle
from pathlib import Path

import pytest

from azee.cli.main import run
from azee.lang import library_folder
from azee.lang.program import Program, load
from azee_grammar import kept_tree
from azee_grammar.cache import keep, kept
from azee_grammar.kept_tree import parse_kept
from azee_grammar.source import Source


@pytest.fixture(autouse=True)
def _own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("AZEE_CACHE", str(tmp_path / "cache"))
    library_folder.parsed_text.cache_clear()


@pytest.fixture
def lib(tmp_path: Path) -> Path:
    """A library of a hundred rules, a file each; every other names the one before."""
    folder = tmp_path / "many"
    folder.mkdir()
    for i in range(100):
        body = f"    :sign-{i - 1}\n" if i % 2 else "    blank 1\n"
        (folder / f"sign-{i}.azee").write_text(f"def sign-{i}\n{body}", encoding="utf-8")
    return folder


def _program(text: str, lib: Path) -> Program:
    library_folder.parsed_text.cache_clear()
    return load(Source("<test>", f"use '{lib.name}\n{text}"), [lib.parent])


def _codes(text: str, lib: Path) -> list[str]:
    return [found.code for found in _program(text, lib).check()]


def _count_reads(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    reads: list[str] = []

    def counted(source: Source) -> object:
        reads.append(Path(source.name).name)
        return parse_kept(source)

    monkeypatch.setattr(library_folder, "parse_kept", counted)
    return reads


def test_a_text_reads_the_rules_it_names_once_a_library_is_checked(
    lib: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert _codes(":sign-7\n", lib) == []
    reads = _count_reads(monkeypatch)
    assert _codes(":sign-7\n", lib) == []
    assert {name for name in reads if name.startswith("sign")} == {"sign-7.azee", "sign-6.azee"}
    assert float(_program(":sign-7\n", lib).score().duration) == 1


def test_a_mistake_in_a_rule_that_nobody_calls_is_told_every_time(lib: Path) -> None:
    (lib / "bad.azee").write_text("def bad\n    :nothing-like-it\n", encoding="utf-8")
    for _ in range(3):
        assert _codes(":sign-2\n", lib) == ["unknown-rule"]


def test_what_changes_is_checked_again_and_so_is_what_names_it(lib: Path) -> None:
    assert _codes(":sign-3\n", lib) == []
    (lib / "sign-10.azee").unlink()
    assert _codes(":sign-3\n", lib) == ["unknown-rule"]
    (lib / "sign-10.azee").write_text("def sign-10\n    blank 2\n", encoding="utf-8")
    assert _codes(":sign-3\n", lib) == []
    assert float(_program(":sign-11\n", lib).score().duration) == 2
    (lib / "sign-10.azee").write_text(
        "def sign-10\n    azop 'd\n        'nodefault\n        blank ^d\n", encoding="utf-8"
    )
    assert _codes(":sign-3\n", lib) == ["missing-argument"]
    (lib / "sign-10.azee").write_text("def sign-10\n    blank 3\n", encoding="utf-8")
    (lib / "twice.azee").write_text("def sign-10\n    blank 3\n", encoding="utf-8")
    for _ in range(2):
        assert _codes(":sign-3\n", lib) == ["duplicate-definition"]


@pytest.mark.long
@pytest.mark.parametrize(
    "damage", [b"", b"{}", b"\x80\x05", b'{"format":1,"folder":"x","files":3}']
)
def test_a_damaged_cache_is_as_good_as_none(lib: Path, tmp_path: Path, damage: bytes) -> None:
    assert _codes(":sign-7\n", lib) == []
    files = [path for path in (tmp_path / "cache").rglob("*") if path.is_file()]
    assert len(files) > 100
    for path in files:
        path.write_bytes(damage)
    assert _codes(":sign-7\n", lib) == []
    assert _codes(":sign-999\n", lib) == ["unknown-rule"]


def test_a_cache_that_cannot_be_written_changes_nothing(
    lib: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    for value in (str(tmp_path / "file" / "inside"), "off"):
        monkeypatch.setenv("AZEE_CACHE", value)
        assert _codes(":sign-7\n", lib) == []
        assert _codes(":sign-999\n", lib) == ["unknown-rule"]


def test_a_kept_tree_is_the_tree_of_the_text() -> None:
    source = Source("a", 'def one\n    \'meaning "x"\n    key .5 (place @I_TIP(s) @CH)\n')
    first = parse_kept(source)
    again = parse_kept(Source("b", source.text))
    assert again == first
    assert again.file.items[0].span.source.name == "b"


class _Evil:
    def __reduce__(self) -> tuple[object, tuple[str]]:
        return os.system, ("exit 1",)


def test_a_kept_tree_can_hold_nothing_else(tmp_path: Path) -> None:
    source = Source("a", "def one\n    blank 1\n")
    first = parse_kept(source)
    file = f"trees/{kept_tree._key(source)}"
    assert kept(file) is not None
    keep(file, pickle.dumps(_Evil()))
    assert parse_kept(source) == first


def test_a_folder_without_texts_is_no_library(tmp_path: Path) -> None:
    (tmp_path / "lsf").mkdir()
    (tmp_path / "lsf" / "notes.md").write_text("")
    assert [d.code for d in load(Source("<t>", "use 'lsf\n:arbre\n"), [tmp_path]).check()] == []


def test_all_files_of_a_library_are_checked_in_one_go(
    lib: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    files = [str(path) for path in sorted(lib.iterdir())]
    assert run(["check", *files]) == 0
    reads = _count_reads(monkeypatch)
    library_folder.parsed_text.cache_clear()
    assert run(["check", *files]) == 0
    assert len([name for name in reads if name.startswith("sign")]) <= len(files)
    (lib / "sign-4.azee").write_text("def sign-4\n    :sign-999\n", encoding="utf-8")
    assert run(["check", *files]) == 1
    assert "sign-999" in capsys.readouterr().err
