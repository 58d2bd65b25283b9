"""What all tests share: Hypothesis' profiles, the body, and the programs that tests run."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, settings

if TYPE_CHECKING:
    from azee_rig.rig import Rig

settings.register_profile(
    "repeatable",
    derandomize=True,
    deadline=None,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile("search", settings.get_profile("repeatable"), derandomize=False)
settings.register_profile("long", settings.get_profile("search"), max_examples=5000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))

NODE_FOLDER = Path(__file__).parent / "node"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what needs Node or a browser by the fixtures it asks for."""
    for item in items:
        for name in {"node", "browser"}.intersection(getattr(item, "fixturenames", ())):
            item.add_marker(name)


@pytest.fixture(scope="session")
def signer() -> Rig:
    """The body that ships."""
    from azee_rig.load import load_rig

    return load_rig("signer")


@dataclass(frozen=True)
class Python:
    """Runs this Python in a process of its own, with the packages that the tests see."""

    folder: Path

    def __call__(
        self, *arguments: str, stdin: str | bytes = b"", expect: int | None = None
    ) -> subprocess.CompletedProcess[str]:
        """Run it in `folder`; with `expect`, fail unless it exits with that code."""
        path = os.pathsep.join(p for p in sys.path if p)
        environment = os.environ | {"PYTHONPATH": path, "PYTHONUTF8": "1", "COLUMNS": "100"}
        data = stdin.encode() if isinstance(stdin, str) else stdin
        done = subprocess.run(
            [sys.executable, *arguments],
            cwd=self.folder,
            input=data,
            env=environment,
            capture_output=True,
            timeout=300,
            check=False,
        )
        result = subprocess.CompletedProcess(
            done.args, done.returncode, done.stdout.decode(), done.stderr.decode()
        )
        if expect is not None:
            shown = f"{arguments}\n{result.stdout}\n{result.stderr}"
            assert result.returncode == expect, f"exit {result.returncode}: {shown}"
        return result


@pytest.fixture
def python(tmp_path: Path) -> Python:
    """Python in a process of its own, in the test's own folder."""
    return Python(tmp_path)


@dataclass(frozen=True)
class Node:
    """Runs the scripts of tests/node."""

    program: str
    chromium: str | None = None

    def __call__(self, script: str, *arguments: str | Path) -> str:
        """Return what the script prints; fails with its error output."""
        done = subprocess.run(
            [self.program, script, *map(str, arguments)],
            cwd=NODE_FOLDER,
            env=os.environ | {"CHROMIUM": self.chromium or ""},
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        assert done.returncode == 0, f"{script}: {done.stdout}\n{done.stderr}"
        return done.stdout


@pytest.fixture(scope="session")
def node() -> Node:
    """Node with the packages of tests/node."""
    return Node(_program(("node",), "Node"))


@pytest.fixture(scope="session")
def browser(node: Node) -> Node:
    """Node that may start a headless Chromium."""
    names = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
    return Node(node.program, chromium=_program(names, "Chromium"))


def _program(names: Sequence[str], title: str) -> str:
    """Path of the first program that exists; else the test is skipped, or fails in CI."""
    found = next(filter(None, map(shutil.which, names)), None)
    if found is None:
        _missing(f"{title} is not installed")
    if not (NODE_FOLDER / "node_modules" / "three").exists():
        _missing("the packages of tests/node are not installed: `make node`")
    assert found is not None
    return found


def _missing(reason: str) -> None:
    if os.environ.get("AZEE_REQUIRE_BROWSER"):
        pytest.fail(reason)
    pytest.skip(reason)
