"""`azee play --page` on the command line: what is refused, and how."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from azee.cli.main import run


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "give a TEXT, or --page"),
        (["--export", "page"], "--export is of the page: give --page too"),
        (["--page", "--export", "page"], "give --letters, --azee or --db"),
        (["--page", "-o", "hello.glb", "HELLO"], "a page writes no file"),
        (["--page", "--port", "70000"], "70000"),
        (["--page", "--rig", "nobody"], "there is no rig `nobody`"),
    ],
)
def test_wrong_use_is_told_in_one_message(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["play", *arguments]) == 2
    assert message in capsys.readouterr().err


def test_a_port_that_is_taken_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert run(["play", "--page", "--port", str(port)]) == 2
    assert f"port {port} is taken: `--port 0` takes one that is free" in capsys.readouterr().err


def test_an_export_never_replaces_what_is_none(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    assert run(["play", "--page", "--export", str(tmp_path), "--letters", "asl"]) == 1
    assert "holds something else than an exported player" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]
    nowhere = tmp_path / "none" / "page"
    assert run(["play", "--page", "--export", str(nowhere), "--letters", "asl"]) == 1
    assert "error[cannot-write]: there is no folder" in capsys.readouterr().err
