"""Programs that tests run: this Python, and Node with the scripts of tests/node."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass, replace
from pathlib import Path

NODE_FOLDER = Path(__file__).parent / "node"
WEB_FOLDER = Path(__file__).parents[1] / "azee" / "web"


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


@dataclass(frozen=True)
class Node:
    """Runs the scripts of a folder, which is tests/node."""

    program: str
    chromium: str | None = None
    folder: Path = NODE_FOLDER

    def in_folder(self, folder: Path) -> Node:
        """Return the same program for the scripts of another folder."""
        return replace(self, folder=folder)

    def __call__(self, script: str, *arguments: str | Path) -> str:
        """Return what the script prints; fails with its error output."""
        done = subprocess.run(
            [self.program, script, *map(str, arguments)],
            cwd=self.folder,
            env=os.environ | {"CHROMIUM": self.chromium or ""},
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        assert done.returncode == 0, f"{script}: {done.stdout}\n{done.stderr}"
        return done.stdout
