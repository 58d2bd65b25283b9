"""The rules of a library that are read when they are named."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, MutableMapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from azee.lang.rule import Rule


class LazyRules(MutableMapping[str, "Rule"]):
    """Rules by name. A rule whose file was not read is read, with its file, when it is asked for.

    `read` holds the rules of all files that were read so far.
    """

    def __init__(self, files: Mapping[str, str], load: Callable[[str, str], None]) -> None:
        """Take the file of each name, and what reads a file for a name.

        `load(file, name)` adds the rules of the file to `read`, that of the name in any case.
        """
        self._files = files
        self._load = load
        self.read: dict[str, Rule] = {}

    def __getitem__(self, name: str) -> Rule:
        if name not in self.read:
            self._load(self._files[name], name)
        return self.read[name]

    def __setitem__(self, name: str, rule: Rule) -> None:
        self.read[name] = rule

    def __delitem__(self, name: str) -> None:
        del self.read[name]

    def __contains__(self, name: object) -> bool:
        return name in self._files or name in self.read

    def __iter__(self) -> Iterator[str]:
        yield from self._files
        yield from (name for name in self.read if name not in self._files)

    def __len__(self) -> int:
        return len(self._files.keys() | self.read.keys())
