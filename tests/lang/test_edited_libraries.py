"""A library that ships, and that somebody has edited into a mistake."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from azee.lang import library
from azee.lang.program import load
from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.library import shipped
from azee_grammar.source import Source

Edit = Callable[[str, str, str], None]
SPELLED = ':fingerspelling \'text "ab"'


@pytest.fixture
def edit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Edit:
    """Replace something in a file of a copy of the shipped libraries, which are then used."""
    copy = tmp_path / "rules"
    shutil.copytree(shipped(), copy)
    monkeypatch.setattr(library, "shipped", lambda: copy)
    monkeypatch.setattr(library, "_SHIPPED", {})

    def replace(file: str, old: str, new: str) -> None:
        text = (copy / file).read_text(encoding="utf-8")
        assert old in text
        (copy / file).write_text(text.replace(old, new, 1), encoding="utf-8")

    return replace


def mistakes(text: str) -> tuple[Diagnostic, ...]:
    with pytest.raises(AZeeError) as caught:
        load(Source("t", f"{text}\n")).score()
    return caught.value.diagnostics


@pytest.mark.long
@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("morph 'thumb_bend s 0", "morfh 'thumb_bend s 0"),
        ("'index list(.8, .95)", "'index list(.8, .95"),
    ],
)
def test_a_mistake_in_a_shipped_library_is_told_with_its_place(
    edit: Edit, old: str, new: str
) -> None:
    edit("asl/letters.azee", old, new)
    note = "`'asl` is a library that ships with azee; has its file been changed?"
    told = [d for d in mistakes(SPELLED) if note in d.notes]
    assert [d.span.source.name for d in told if d.span] == ["asl/letters.azee"] * len(told)
    assert told


def test_a_rule_that_is_gone_from_a_shipped_library_is_told(edit: Edit) -> None:
    edit("asl/letters.azee", "def letter-A", "def letter-Aa")
    assert {d.code for d in mistakes(SPELLED)} == {"unknown-rule"}
