"""Reading a file gives a source or exactly one diagnostic."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import pytest

from azee_grammar.diagnostic import AZeeError, Diagnostic
from azee_grammar.files import LARGEST_BYTES, decode, read_source


def problem(path: Path) -> Diagnostic:
    with pytest.raises(AZeeError) as caught:
        read_source(path)
    (diagnostic,) = caught.value.diagnostics
    return diagnostic


def test_a_byte_order_mark_is_dropped_and_line_ends_stay(tmp_path: Path) -> None:
    file = tmp_path / "a.azee"
    file.write_bytes(b"\xef\xbb\xbf:a\r\n:b\n")
    source = read_source(file)
    assert source.text == ":a\r\n:b\n"
    assert source.name == str(file)


def test_a_missing_file(tmp_path: Path) -> None:
    found = problem(tmp_path / "none.azee")
    assert found.code == "cannot-read"
    assert found.message.startswith("there is no file `")


def test_a_directory(tmp_path: Path) -> None:
    found = problem(tmp_path)
    assert found.code == "cannot-read"
    assert found.message.endswith("is a directory")


def test_a_name_that_no_file_can_have() -> None:
    assert problem(Path("a\0b")).code == "cannot-read"


def test_latin_1_text_is_pointed_at(tmp_path: Path) -> None:
    file = tmp_path / "a.azee"
    file.write_bytes(":é\n:b\n:".encode() + ":âge".encode("latin-1")[1:])
    found = problem(file)
    assert found.code == "not-utf8"
    assert found.span is not None
    assert (found.span.line, found.span.column) == (3, 2)
    assert "`â`" in found.label


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_utf_16_is_named(encoding: str) -> None:
    with pytest.raises(AZeeError) as caught:
        decode("\ufeff:âge".encode(encoding), "a.azee")
    assert "UTF-16" in caught.value.diagnostics[0].message


def test_bytes_that_are_no_text() -> None:
    with pytest.raises(AZeeError) as caught:
        decode(b"glTF\x00\x00\xff", "a.azee")
    assert caught.value.diagnostics[0].message == "`a.azee` is not a text file"


def test_a_text_beyond_all_measure() -> None:
    with pytest.raises(AZeeError) as caught:
        decode(b" " * (LARGEST_BYTES + 1), "a.azee")
    assert caught.value.diagnostics[0].code == "size-limit"


def test_standard_input(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"\xef\xbb\xbf:a")))
    source = read_source("-")
    assert (source.name, source.text) == ("<stdin>", ":a")
