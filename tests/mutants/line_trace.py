"""A plugin of pytest: tells which lines of one module each file of tests runs.

AZEE_TRACED names the module's file, AZEE_LINES the file that the answer is written to: JSON, by the
file of tests its lines, and null for a file whose tests start processes, which are not looked into.
Lines that run as modules are imported belong to every file.

What the code remembers from one file of tests is forgotten before the next, so that each runs
whatever it needs; what a fixture runs belongs to every file that asks for a fixture of its name.
"""

from __future__ import annotations

import functools
import gc
import json
import os
import sys
import threading
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

TRACED, ANSWER = "AZEE_TRACED", "AZEE_LINES"
STARTS = {"subprocess.Popen", "os.fork", "os.forkpty", "os.posix_spawn", "os.exec", "os.system"}
"""Events of Python's audit that start a process."""


class LineTrace:
    """Collects the lines that run, for what is going on now."""

    def __init__(self, module: str, answer: Path) -> None:
        self.module, self.answer = module, answer
        self.now: set[int] = set()
        self.imported: set[int] = set()
        self.of_file: defaultdict[str, set[int]] = defaultdict(set)
        self.of_fixture: defaultdict[str, set[int]] = defaultdict(set)
        self.fixtures: defaultdict[str, set[str]] = defaultdict(set)
        self.starting: set[str] = set()
        self.running = ""
        sys.addaudithook(self._heard)
        threading.settrace(self._call)
        sys.settrace(self._call)

    def _heard(self, event: str, _: tuple[Any, ...]) -> None:
        if event in STARTS and self.running:
            self.starting.add(self.running)

    def _call(self, frame: FrameType, event: str, argument: object) -> Any:
        return self._line if frame.f_code.co_filename == self.module else None

    def _line(self, frame: FrameType, event: str, argument: object) -> Any:
        self.now.add(frame.f_lineno)
        return self._line

    def pytest_collection_finish(self) -> None:
        """What ran so far is run by every import."""
        self.imported = self.now

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """Count what runs for the file of a test."""
        file = item.nodeid.partition("::")[0]
        if file != self.running:
            _forget()
        self.running, self.now = file, self.of_file[file]
        self.fixtures[file].update(getattr(item, "fixturenames", ()))
        sys.settrace(self._call)  # whatever the test before has done to it
        yield

    @pytest.hookimpl(hookwrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any) -> Iterator[None]:
        """Count what runs for a fixture, beside the file that is the first to ask for it."""
        before, self.now = self.now, set()
        yield
        self.of_fixture[fixturedef.argname] |= self.now
        before |= self.now
        self.now = before

    def pytest_unconfigure(self) -> None:
        """Write the answer."""
        sys.settrace(None)
        threading.settrace(None)
        found: dict[str, list[int] | None] = {}
        for file, lines in self.of_file.items():
            asked = [self.of_fixture[name] for name in self.fixtures[file]]
            found[file] = sorted(self.imported.union(lines, *asked))
        found |= dict.fromkeys(self.starting)
        self.answer.write_text(json.dumps(found), encoding="utf-8")


def _forget() -> None:
    """Empty the memories of our functions, of those of tests as well."""
    for thing in gc.get_objects():
        if isinstance(thing, functools._lru_cache_wrapper):
            file = getattr(sys.modules.get(thing.__module__), "__file__", None) or ""
            if "site-packages" not in file and not file.startswith(sys.base_prefix):
                thing.cache_clear()


def pytest_configure(config: pytest.Config) -> None:
    """Begin, where a module is named."""
    if TRACED in os.environ:
        trace = LineTrace(os.environ[TRACED], Path(os.environ[ANSWER]))
        config.pluginmanager.register(trace, "line-trace")
