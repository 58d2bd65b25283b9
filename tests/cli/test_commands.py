"""Subcommands are loaded when they are used, and all can be."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import click
import pytest
from programs import Python

import azee.cli
from azee.cli.commands import NAMES, Commands
from azee.cli.main import run

LOADED = """
import sys
from azee.cli.main import run
run(["check", sys.argv[1]])
print(*sorted(name for name in sys.modules if name.startswith("azee.cli.")))
"""


def test_every_command_has_its_name_and_a_line_of_help() -> None:
    found = dict(Commands())
    assert tuple(found) == NAMES == tuple(sorted(NAMES))
    assert len(Commands()) == len(NAMES)
    for name, command in found.items():
        assert command.name == name
        assert 0 < len(command.get_short_help_str(limit=80)) < 80
        assert not command.get_short_help_str(limit=80).endswith("...")


def test_no_module_with_a_command_is_forgotten() -> None:
    folder = Path(azee.cli.__file__).parent
    commands = set()
    for path in folder.glob("*.py"):
        module = import_module(f"azee.cli.{path.stem}")
        found = getattr(module, path.stem, None)
        if isinstance(found, click.Command):
            commands.add(path.stem)
    assert commands | {"compile"} == set(NAMES)


def test_no_other_command_is_loaded(python: Python, tmp_path: Path) -> None:
    text = tmp_path / "text.azee"
    text.write_text(":chat\n", encoding="utf-8")
    loaded = python("-c", LOADED, str(text), expect=0).stdout.split()
    assert {name.removeprefix("azee.cli.") for name in loaded} & set(NAMES) == {"check"}


def test_a_command_that_is_not_there_is_guessed(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["chek"]) == 2
    assert "No such command 'chek'" in capsys.readouterr().err
