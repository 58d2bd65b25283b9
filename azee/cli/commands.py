"""The subcommands of `azee`, each of which is loaded when somebody uses it.

Loading all of them takes longer than checking a text.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module

import click

NAMES = (
    "batch", "blocks", "capture", "check", "clip", "compile", "corpus", "db", "elan", "export",
    "find", "fmt", "gloss", "lexicon", "lsp", "manifest", "mcp", "play", "pose", "render", "repl",
    "retarget", "rig", "rules", "score", "spell", "studio", "study",
)  # fmt: skip
"""Each is the command of this name in the module of this name."""


class Commands(Mapping[str, click.Command]):
    """All subcommands by name."""

    def __getitem__(self, name: str) -> click.Command:
        """Load a subcommand. Raises: KeyError: there is none of this name."""
        if name not in NAMES:
            raise KeyError(name)
        module = import_module(f"azee.cli.{name}")
        found = getattr(module, "compile_" if name == "compile" else name)
        assert isinstance(found, click.Command)
        return found

    def __iter__(self) -> Iterator[str]:
        """Yield the names."""
        return iter(NAMES)

    def __len__(self) -> int:
        """Return how many there are."""
        return len(NAMES)
