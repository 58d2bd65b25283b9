"""Outputs are whole or not there."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from azee.export.files import replace_file


def _break_off(path: Path, error: type[BaseException]) -> None:
    with replace_file(path) as file:
        file.write(b"half of")
        raise error


def test_writes_a_new_file_and_leaves_nothing_else(tmp_path: Path) -> None:
    with replace_file(tmp_path / "a.bin") as file:
        file.write(b"abc")
        assert not (tmp_path / "a.bin").exists()
    assert (tmp_path / "a.bin").read_bytes() == b"abc"
    assert [p.name for p in tmp_path.iterdir()] == ["a.bin"]


def test_a_failure_keeps_what_was_there(tmp_path: Path) -> None:
    path = tmp_path / "a.bin"
    path.write_bytes(b"before")
    with pytest.raises(RuntimeError):
        _break_off(path, RuntimeError)
    assert path.read_bytes() == b"before"
    assert [p.name for p in tmp_path.iterdir()] == ["a.bin"]


def test_an_interrupt_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        _break_off(tmp_path / "a.bin", KeyboardInterrupt)
    assert list(tmp_path.iterdir()) == []


def test_a_directory_or_a_missing_folder_is_an_os_error(tmp_path: Path) -> None:
    with pytest.raises(IsADirectoryError), replace_file(tmp_path):
        pass
    with pytest.raises(FileNotFoundError), replace_file(tmp_path / "missing" / "a.bin"):
        pass
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(os.name == "nt", reason="POSIX permissions and links")
def test_permissions_and_links_are_those_of_a_plain_open(tmp_path: Path) -> None:
    plain, ours, link = tmp_path / "plain", tmp_path / "ours", tmp_path / "link"
    plain.write_bytes(b"")
    with replace_file(ours):
        pass
    assert ours.stat().st_mode == plain.stat().st_mode
    ours.chmod(0o640)
    link.symlink_to(ours)
    with replace_file(link) as file:
        file.write(b"through the link")
    assert link.is_symlink()
    assert ours.read_bytes() == b"through the link"
    assert ours.stat().st_mode & 0o777 == 0o640
