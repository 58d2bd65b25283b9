"""What the command says: diagnostics and news to standard error, results to standard output."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from azee_grammar.diagnostic import Diagnostic, Severity

if TYPE_CHECKING:
    from rich.status import Status

DONE, FAULT, USAGE, MISSED, INTERRUPTED = 0, 1, 2, 3, 130
"""Exit codes: done; the input is at fault; wrong use; nothing is wrong, but --strict found a miss
or a search nothing; stopped by Ctrl-C."""


def show(diagnostics: Iterable[Diagnostic]) -> None:
    """Write diagnostics to standard error, in the order of the text, an empty line between."""
    from azee_grammar.render import render

    for diagnostic in diagnostics:
        click.echo(render(diagnostic, colour=_coloured()).rstrip("\n") + "\n", err=True, color=True)


def show_json(document: dict[str, Any]) -> None:
    """Write one JSON object to standard output."""
    click.echo(json.dumps(document, indent=2, ensure_ascii=False))


def as_json(diagnostics: Iterable[Diagnostic]) -> list[dict[str, Any]]:
    """Diagnostics in the machine-readable form of docs/formats.md."""
    from azee_grammar.render import to_json

    return [to_json(diagnostic) for diagnostic in diagnostics]


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    """Whether any of them is more than a warning."""
    return any(d.severity is Severity.ERROR for d in diagnostics)


def news(text: str, *, quiet: bool = False) -> None:
    """Tell what is going on, on standard error."""
    if not quiet:
        click.echo(text, err=True)


PREPARING = "Preparing the solver for this machine, once"


class Progress:
    """Long work in the eyes of who waits for it."""

    def __init__(self, status: Status | None = None, *, quiet: bool = False) -> None:
        self._status, self._quiet = status, quiet

    def now(self, text: str) -> None:
        """Say what is being done, where standard error is a terminal; nothing is left of it."""
        if self._status:
            self._status.update(text)

    @contextmanager
    def preparing(self) -> Iterator[None]:
        """Say how far the solver is compiled, on the first run after installing; else nothing."""
        from azee_rig.machine_code import told_of_compiling

        with told_of_compiling(self._compiling):
            yield

    def _compiling(self, number: int, total: int) -> None:
        if self._status:
            self.now(f"{PREPARING}: part {number} of up to {total} …")
        elif number == 1:
            news(f"{PREPARING} …", quiet=self._quiet)


@contextmanager
def working(text: str, *, quiet: bool = False) -> Iterator[Progress]:
    """Show that long work goes on."""
    if quiet or not sys.stderr.isatty():
        yield Progress(quiet=quiet)
        return
    from rich.console import Console

    with Console(stderr=True).status(text) as status:
        yield Progress(status)


@contextmanager
def bar(text: str, *, quiet: bool = False) -> Iterator[Callable[[int, int], None] | None]:
    """Show how much of long work is done; gives what is to be told of the parts done, and all."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress as Bar

    with Bar(console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(text, total=None)
        yield lambda done, total: shown.update(task, completed=done, total=total)


def _coloured() -> bool:
    return sys.stderr.isatty() and not os.environ.get("NO_COLOR")
